#include "draw_support.h"

#include "base/context.h"

#include <string.h>

enum { W = 80, H = 60 };

static sl_camera camera_at_origin(double near_depth)
{
    return (sl_camera){.centre = {0.5, 0.5},
                       .right = {1, 0, 0},
                       .up = {0, 1, 0},
                       .forward = {0, 0, -1},
                       .focal = 1.0,
                       .near_depth = near_depth,
                       .perspective = true};
}

/* A floor far below, in front, behind and under the eye: clipped, it must fill everything below the horizon and nothing
 * above; without clipping the projection turns over. */
static void a_plane_through_the_eye_is_clipped_at_the_near_plane(void **state)
{
    (void)state;
    const double xyz[12] = {-900, -1, 800, 700, -1, 950, 850, -1, -990, -940, -1, -870};
    const int32_t tri[6] = {0, 1, 2, 0, 2, 3};
    const sl_camera camera = camera_at_origin(0.01);
    sl_screen *screen = NULL;
    assert_int_equal(sl_screen_create(&camera, W, H, 4, xyz, 2, tri, 16, NULL, &screen), SL_OK);
    assert_true(screen->pieces >= 2);
    uint64_t *zid = draw_all(screen);
    for (int i = 0; i < W * H; i++) {
        const double y = i / W + 0.5;
        if (y > H / 2 + 1.0) { /* the far edge stands a tenth of a sample under the horizon */
            assert_true(zid[i] != SL_NOTHING);
        } else if (y < H / 2) {
            assert_true(zid[i] == SL_NOTHING);
        }
    }
    sl_free(zid);
    sl_screen_free(screen);
}

/* Two triangles share an edge that runs through the near plane and far out of the picture: no crack, no overlap. */
static void clipping_opens_no_crack(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0xc4ac);
    for (int trial = 0; trial < 200 * test_multiplier(); trial++) {
        double xyz[12];
        for (int k = 0; k < 12;
             k++) { /* a plane z = -1 + tilt, wider than any guard band when tilted through the eye */
            xyz[k] = test_uniform(&rng, -1.0, 1.0);
        }
        const double far = pow(10.0, test_uniform(&rng, 0.0, 5.0));
        const double corner[4][2] = {{-far, -far}, {far, -far}, {far, far}, {-far, far}};
        const double slope = test_uniform(&rng, -3.0, 3.0), tilt = test_uniform(&rng, -3.0, 3.0);
        for (int v = 0; v < 4; v++) {
            xyz[3 * v] = corner[v][0] * test_uniform(&rng, 0.5, 1.0);
            xyz[3 * v + 1] = corner[v][1] * test_uniform(&rng, 0.5, 1.0);
            xyz[3 * v + 2] = -1.0 + slope * xyz[3 * v] + tilt * xyz[3 * v + 1];
        }
        const int32_t tri[2][3] = {{0, 1, 2}, {0, 2, 3}};
        const sl_camera camera = camera_at_origin(0.05);
        int32_t count[W * H] = {0};
        for (int t = 0; t < 2; t++) {
            sl_screen *screen = NULL;
            assert_int_equal(sl_screen_create(&camera, W, H, 4, xyz, 1, tri[t], 16, NULL, &screen), SL_OK);
            uint64_t *zid = draw_all(screen);
            for (int i = 0; i < W * H; i++) {
                count[i] += zid[i] != SL_NOTHING ? 1 : 0;
            }
            sl_free(zid);
            sl_screen_free(screen);
        }
        for (int i = 0; i < W * H; i++) {
            /* The plane seen at this sample: z from the ray, by hand. */
            double o[3], d[3];
            sl_camera_ray(&camera, W, H, i % W + 0.5, i / W + 0.5, o, d);
            /* eye z = -scene z: -z = -1 + slope x + tilt y with x = z d0, y = z d1 */
            const double z = 1.0 / (1.0 + slope * d[0] + tilt * d[1]);
            const double x = z * d[0], y = z * d[1];
            const bool inner = fabs(x) < 0.3 * far && fabs(y) < 0.3 * far && z > 0.06;
            assert_true(count[i] <= 1);
            if (inner) {
                assert_int_equal(count[i], 1);
            }
        }
    }
}

/* A wall that leans through the near plane: drawn where the ray meets it behind that plane, nowhere before. */
static void nothing_before_the_near_plane_is_drawn(void **state)
{
    (void)state;
    const double near_depth = 1.7, slope = 0.9; /* eye z = 1.5 + slope x */
    double xyz[9] = {-1.4, -40, 0, 30, -3, 0, -1.2, 50, 0};
    for (int v = 0; v < 3; v++) {
        xyz[3 * v + 2] = -(1.5 + slope * xyz[3 * v]);
    }
    const int32_t tri[3] = {0, 1, 2};
    const sl_camera camera = camera_at_origin(near_depth);
    sl_screen *screen = NULL;
    assert_int_equal(sl_screen_create(&camera, W, H, 3, xyz, 1, tri, 16, NULL, &screen), SL_OK);
    uint64_t *zid = draw_all(screen);
    int shown = 0, cut = 0;
    for (int i = 0; i < W * H; i++) {
        double o[3], d[3];
        sl_camera_ray(&camera, W, H, i % W + 0.5, i / W + 0.5, o, d);
        const double z = 1.5 / (1.0 - slope * d[0]);
        if (z > 1.02 * near_depth && z < 5.0) {
            assert_true(zid[i] != SL_NOTHING);
            shown++;
        } else if (z < 0.98 * near_depth) {
            assert_true(zid[i] == SL_NOTHING);
            cut++;
        }
    }
    assert_true(shown > 500 && cut > 500);
    sl_free(zid);
    sl_screen_free(screen);
}

static void the_plane_of_a_triangle_gives_the_key_of_its_samples(void **state)
{
    (void)state;
    enum { NT = 30 };
    test_rng rng = test_rng_seed(0x91a);
    double xyz[9 * NT];
    int32_t tri[3 * NT];
    for (int trial = 0; trial < 20 * test_multiplier(); trial++) {
        random_soup(&rng, NT, 0.7, xyz, tri);
        const sl_camera camera = random_camera(&rng, 3 * NT, xyz, (double)W / H);
        sl_screen *screen = NULL;
        assert_int_equal(sl_screen_create(&camera, W, H, 3 * NT, xyz, NT, tri, 16, NULL, &screen), SL_OK);
        for (int32_t t = 0; t < NT; t++) {
            double plane[3];
            if (!sl_screen_plane(screen, t, plane)) {
                continue;
            }
            double scale = 1.0 + fabs(plane[0]) + W * fabs(plane[1]) + H * fabs(plane[2]);
            for (int k = 0; k < 3; k++) {
                const double *eye = screen->eye + 9 * t + 3 * k;
                double s[2];
                sl_camera_project(&camera, W, H, eye, s);
                const double key = plane[0] + plane[1] * s[0] + plane[2] * s[1];
                assert_true(test_near(key, sl_screen_key(screen, eye[2]), 1e-9 * scale));
            }
        }
        sl_screen_free(screen);
    }
}

static void points_that_are_not_finite_are_left_out(void **state)
{
    (void)state;
    const double xyz[18] = {2, 3, 0, 50, 5, 0, 20, 44, 0, (double)NAN, 1, 0, 5, (double)INFINITY, 0, 1e200, 3, 0};
    const int32_t tri[12] = {0, 1, 3, 4, 0, 1, 5, 1, 2, 0, 1, 2};
    const sl_camera plan = sl_camera_plan(0.0, 0.0, H, (double)W / H);
    sl_screen *screen = NULL;
    assert_int_equal(sl_screen_create(&plan, W, H, 6, xyz, 4, tri, 16, NULL, &screen), SL_OK);
    assert_int_equal(screen->pieces, 1);
    assert_int_equal(screen->piece[0].triangle, 3);
    assert_true(isfinite(screen->key_offset) && isfinite(screen->key_scale));
    sl_screen_free(screen);
}

static void an_empty_scene_draws_nothing(void **state)
{
    (void)state;
    const sl_camera plan = sl_camera_plan(0.0, 0.0, 1.0, 1.0);
    sl_screen *screen = NULL;
    assert_int_equal(sl_screen_create(&plan, 1, 1, 0, NULL, 0, NULL, 1, NULL, &screen), SL_OK);
    uint64_t *zid = draw_all(screen);
    assert_true(zid[0] == SL_NOTHING);
    sl_free(zid);
    sl_screen_free(screen);
    sl_screen_free(NULL);
}

static void sides_out_of_range_are_refused(void **state)
{
    (void)state;
    const sl_camera plan = sl_camera_plan(0.0, 0.0, 1.0, 1.0);
    static const int32_t bad[][3] = {{0, 5, 1}, {5, 0, 1}, {SL_SCREEN_MAX_SIDE + 1, 5, 1}, {5, 5, 0}};
    for (size_t i = 0; i < SL_COUNTOF(bad); i++) {
        sl_screen *screen = NULL;
        assert_int_equal(sl_screen_create(&plan, bad[i][0], bad[i][1], 0, NULL, 0, NULL, bad[i][2], NULL, &screen),
                         SL_BAD_INPUT);
        assert_null(screen);
    }
}

static void pieces_are_the_same_for_any_number_of_threads(void **state)
{
    (void)state;
    enum { NT = 30000 };
    test_rng rng = test_rng_seed(0x7d);
    double *xyz = sl_alloc(9 * NT, sizeof *xyz);
    int32_t *tri = sl_alloc(3 * NT, sizeof *tri);
    assert_non_null(xyz);
    assert_non_null(tri);
    random_soup(&rng, NT, 0.05, xyz, tri);
    const sl_camera camera = random_camera(&rng, 3 * NT, xyz, (double)W / H);
    sl_screen *first = NULL;
    assert_int_equal(sl_screen_create(&camera, W, H, 3 * NT, xyz, NT, tri, 16, NULL, &first), SL_OK);
    for (int32_t workers = 2; workers <= 5; workers += 3) {
        sl_thread_pool *pool = NULL;
        assert_int_equal(sl_thread_pool_create(workers, &pool), SL_OK);
        const sl_context context = {.executor = sl_thread_pool_executor(pool)};
        sl_screen *screen = NULL;
        assert_int_equal(sl_screen_create(&camera, W, H, 3 * NT, xyz, NT, tri, 16, &context, &screen), SL_OK);
        assert_int_equal(screen->pieces, first->pieces);
        uint64_t *a = draw_all(first), *b = draw_all(screen);
        assert_memory_equal(a, b, W * H * sizeof *a);
        sl_free(a);
        sl_free(b);
        sl_screen_free(screen);
        sl_thread_pool_free(pool);
    }
    sl_screen_free(first);
    sl_free(xyz);
    sl_free(tri);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_plane_through_the_eye_is_clipped_at_the_near_plane),
        cmocka_unit_test(clipping_opens_no_crack),
        cmocka_unit_test(nothing_before_the_near_plane_is_drawn),
        cmocka_unit_test(the_plane_of_a_triangle_gives_the_key_of_its_samples),
        cmocka_unit_test(points_that_are_not_finite_are_left_out),
        cmocka_unit_test(an_empty_scene_draws_nothing),
        cmocka_unit_test(sides_out_of_range_are_refused),
        cmocka_unit_test(pieces_are_the_same_for_any_number_of_threads),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
