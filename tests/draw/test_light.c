#include "draw_support.h"

#include "draw/ground.h"
#include "draw/light.h"

#include <string.h>

/* A square table of side 2 at height 1 over the plane y = 0 with one far small vertex that sets the scene's size. */
static const double table[15] = {-1, 1, -1, 1, 1, -1, 1, 1, 1, -1, 1, 1, 0, -1.5, 0};
static const int32_t top[6] = {0, 1, 2, 0, 2, 3};
static const double up[3] = {0, 1, 0};

static sl_light_rig *make_rig(const double direction[3], bool shadow)
{
    const sl_light light = {{direction[0], direction[1], direction[2]}, {0.5f, 0.6f, 0.7f}, shadow, shadow};
    const sl_light_rig_def def = {.lights = 1, .light = &light, .up = {0, 1, 0}, .map_side = 256};
    sl_light_rig *rig = NULL;
    assert_int_equal(sl_light_rig_create(&def, 5, table, 2, top, NULL, &rig), SL_OK);
    return rig;
}

/* Oracle: the ray from the point to the light against the square, by hand. */
static void points_under_a_table_are_in_its_shadow(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0x54ad0);
    int dark = 0, bright = 0;
    for (int trial = 0; trial < 20; trial++) {
        double d[3] = {test_uniform(&rng, -0.7, 0.7), 1.0, test_uniform(&rng, -0.7, 0.7)};
        const double length = sqrt(d[0] * d[0] + 1.0 + d[2] * d[2]);
        for (int k = 0; k < 3; k++) {
            d[k] /= length;
        }
        sl_light_rig *rig = make_rig(d, true);
        for (int i = 0; i < 500; i++) {
            const double p[3] = {test_uniform(&rng, -2, 2), test_uniform(&rng, -1, 0.8), test_uniform(&rng, -2, 2)};
            const double t = (1.0 - p[1]) / d[1], x = fabs(p[0] + t * d[0]), z = fabs(p[2] + t * d[2]);
            const double off = fmax(x, z) - 1.0; /* < 0: blocked */
            float rgb[3];
            sl_light_rig_shine(rig, p, up, up, rgb);
            if (off < -0.1) {
                assert_true(test_near((double)rgb[1], 0.0, 1e-6));
                dark++;
            } else if (off > 0.1) {
                assert_true(test_near((double)rgb[1], 0.6 * d[1], 1e-5));
                bright++;
            }
        }
        sl_light_rig_free(rig);
    }
    assert_true(dark > 500 && bright > 500);
}

static void a_lit_surface_does_not_shadow_itself(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0xac4e);
    for (int trial = 0; trial < 20; trial++) {
        double d[3] = {test_uniform(&rng, -3, 3), 1.0, test_uniform(&rng, -3, 3)};
        const double length = sqrt(d[0] * d[0] + 1.0 + d[2] * d[2]);
        for (int k = 0; k < 3; k++) {
            d[k] /= length;
        }
        sl_light_rig *rig = make_rig(d, true);
        for (int i = 0; i < 200; i++) {
            const double p[3] = {test_uniform(&rng, -1, 1), 1.0, test_uniform(&rng, -1, 1)};
            float rgb[3];
            sl_light_rig_shine(rig, p, up, up, rgb);
            assert_true(test_near((double)rgb[0], 0.5 * d[1], 1e-5));
        }
        sl_light_rig_free(rig);
    }
}

static void without_shadow_light_follows_the_cosine(void **state)
{
    (void)state;
    const double d[3] = {0.48, 0.6, 0.64}, p[3] = {0, 0, 0}, away[3] = {-0.48, -0.6, -0.64};
    sl_light_rig *rig = make_rig(d, false);
    float rgb[3];
    sl_light_rig_shine(rig, p, up, up, rgb);
    assert_true(test_near((double)rgb[2], 0.7 * 0.6, 1e-6));
    sl_light_rig_shine(rig, p, d, d, rgb);
    assert_true(test_near((double)rgb[2], 0.7, 1e-6));
    sl_light_rig_shine(rig, p, away, away, rgb);
    assert_true(test_near((double)rgb[2], 0.0, 1e-6));
    sl_light_rig_free(rig);
}

static void the_ground_is_dark_under_the_table_and_bright_far_away(void **state)
{
    (void)state;
    enum { LIGHTS = 32 };
    sl_light light[LIGHTS];
    for (int i = 0; i < LIGHTS; i++) {
        const double h = (i + 0.5) / LIGHTS, r = sqrt(1.0 - h * h), a = 2.4 * i;
        light[i] = (sl_light){{r * cos(a), h, r * sin(a)}, {0.1f, 0.1f, 0.1f}, true, true};
    }
    const sl_light_rig_def def = {.lights = LIGHTS, .light = light, .up = {0, 1, 0}, .map_side = 128};
    sl_light_rig *rig = NULL;
    sl_ground *ground = NULL, *again = NULL;
    sl_thread_pool *pool = NULL;
    assert_int_equal(sl_thread_pool_create(3, &pool), SL_OK);
    const sl_context context = {.executor = sl_thread_pool_executor(pool)};
    assert_int_equal(sl_light_rig_create(&def, 5, table, 2, top, NULL, &rig), SL_OK);
    const double floor[3] = {0.2, 0.3, -0.1}, down[3] = {0, -1, 0};
    assert_int_equal(sl_ground_create(rig, floor, 1.0, NULL, &ground), SL_OK);
    assert_int_equal(sl_ground_create(rig, floor, 1.0, &context, &again), SL_OK);
    const double over[3] = {0.05, 5, 0.02}, edge[3] = {1.3, 5, 0}, far[3] = {4.0, 5, 0.3}, gone[3] = {900, 5, 2};
    const float a = sl_ground_seen(ground, over, down), b = sl_ground_seen(ground, edge, down);
    const float c = sl_ground_seen(ground, far, down);
    assert_true(a < 0.45f && a < b - 0.1f && b < c - 0.1f && c > 0.9f && c <= 1.0f);
    assert_true(sl_ground_seen(ground, gone, down) == 1.0f && sl_ground_seen(ground, over, up) == 1.0f);
    const double below[3] = {0, -2, 0};
    assert_true(sl_ground_seen(ground, below, down) == 1.0f);
    for (int i = 0; i < 200; i++) {
        const double p[3] = {-3.0 + 0.03 * i, 4.0, 0.011 * i};
        assert_true(sl_ground_seen(ground, p, down) == sl_ground_seen(again, p, down));
    }
    sl_ground_free(ground);
    sl_ground_free(again);
    sl_ground_free(NULL);
    sl_light_rig_free(rig);
    sl_light_rig_free(NULL);
    sl_thread_pool_free(pool);
}

static void map_sides_out_of_range_are_refused(void **state)
{
    (void)state;
    for (int32_t side = 15; side <= 4097; side += 4097 - 15) {
        const sl_light_rig_def def = {.map_side = side, .up = {0, 1, 0}};
        sl_light_rig *rig = NULL;
        assert_int_equal(sl_light_rig_create(&def, 5, table, 2, top, NULL, &rig), SL_BAD_INPUT);
        assert_null(rig);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(points_under_a_table_are_in_its_shadow),
        cmocka_unit_test(a_lit_surface_does_not_shadow_itself),
        cmocka_unit_test(without_shadow_light_follows_the_cosine),
        cmocka_unit_test(the_ground_is_dark_under_the_table_and_bright_far_away),
        cmocka_unit_test(map_sides_out_of_range_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
