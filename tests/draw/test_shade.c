#include "draw_support.h"

#include "draw/shade.h"

#include <string.h>

enum { W = 40, H = 30 };

/* Oracle: the mean over a fine grid of the box. */
static void the_checkerboard_is_the_mean_over_its_box(void **state)
{
    (void)state;
    enum { N = 200 };
    test_rng rng = test_rng_seed(0xc4ec);
    for (int trial = 0; trial < 60 * test_multiplier(); trial++) {
        const double uv[2] = {test_uniform(&rng, -9, 9), test_uniform(&rng, -9, 9)};
        const double width[2] = {test_uniform(&rng, 0.01, 5), test_uniform(&rng, 0.01, 5)};
        double light = 0.0;
        for (int i = 0; i < N * N; i++) {
            const double u = uv[0] + ((i % N + 0.5) / N - 0.5) * width[0],
                         v = uv[1] + ((i / N + 0.5) / N - 0.5) * width[1];
            light += fmod(floor(u) + floor(v) + 64.0, 2.0) == 0.0 ? 1.0 : 0.0;
        }
        assert_true(test_near(sl_checkerboard(uv, width), light / (N * N), 3.0 / N));
    }
}

static void a_distant_checkerboard_is_even_grey(void **state)
{
    (void)state;
    const double uv[2] = {0.37, -5.12}, wide[2] = {4000.3, 3011.9}, none[2] = {0.0, 0.0};
    assert_true(test_near(sl_checkerboard(uv, wide), 0.5, 1e-3));
    assert_true(test_near(sl_checkerboard(uv, none), 1.0, 1e-6)); /* squares 0 and -6 */
}

/* One large triangle that fills the picture. */
typedef struct plate {
    double xyz[9], uv[6], value[3];
    float map[6], rgb[3], samples[3 * W * H];
    uint8_t flag;
    int32_t tri[3];
    sl_camera camera;
    sl_screen *screen;
    uint64_t *zid;
} plate;

static void set_plate(plate *p, double fov)
{
    *p = (plate){.xyz = {-40, -30, 0.5, 50, -35, -1, 3, 60, 2},
                 .uv = {0.1, 0.2, 3.3, 0.4, 1.2, 4.1},
                 .value = {-1.5, 2.5, 0.7},
                 .map = {0, 0, 0, 1, 1, 1},
                 .rgb = {0.2f, 0.5f, 0.8f},
                 .tri = {0, 1, 2}};
    sl_view view = sl_view_default();
    view.fov = fov;
    const double aim[6] = {-1, -1, 0, 1, 1, 0};
    assert_int_equal(sl_camera_frame(&view, (double)W / H, 2, NULL, aim, &p->camera), SL_OK);
    assert_int_equal(sl_screen_create(&p->camera, W, H, 3, p->xyz, 1, p->tri, 16, NULL, &p->screen), SL_OK);
    p->zid = draw_all(p->screen);
}

static void clear_plate(plate *p)
{
    sl_free(p->zid);
    sl_screen_free(p->screen);
}

static void shade(plate *p, const sl_material *material, const sl_light_rig *rig, const float background[3])
{
    const sl_visibility window = {0, 0, W, H, p->zid};
    sl_shade(p->screen, &window, material, rig, NULL, background, 2, p->samples);
}

static sl_material plain(const plate *p)
{
    static const int32_t corner[3] = {0, 1, 2}, facet[1] = {0};
    sl_material m = sl_material_default();
    m.corner = corner;
    m.facet = facet;
    m.facet_rgb = p->rgb;
    m.lit = false;
    return m;
}

static const float backdrop[3] = {0.25f, 0.5f, 0.75f};

/* Values are affine over the triangle: the value of the point the ray meets, by solving for the point in the scene. */
static void values_are_interpolated_in_the_scene_not_on_the_picture(void **state)
{
    (void)state;
    static const double fov[] = {0.0, 70.0};
    for (size_t f = 0; f < SL_COUNTOF(fov); f++) {
        static plate p;
        set_plate(&p, fov[f]);
        sl_material m = plain(&p);
        m.value = p.value;
        m.map_rgb = p.map;
        m.map_count = 2;
        m.value_lo = -2.0;
        m.value_hi = 3.0;
        shade(&p, &m, NULL, backdrop);
        for (int i = 0; i < W * H; i++) {
            if (p.zid[i] == SL_NOTHING) {
                assert_memory_equal(p.samples + 3 * i, backdrop, sizeof backdrop);
                continue;
            }
            /* point on the plane, then the areas of the three sub-triangles by the largest projection */
            double o[3], d[3], e[3][3], n[3], point[3];
            sl_camera_ray(&p.camera, W, H, i % W + 0.5, i / W + 0.5, o, d);
            for (int k = 0; k < 3; k++) {
                sl_camera_to_eye(&p.camera, p.xyz + 3 * k, e[k]);
            }
            for (int k = 0; k < 3; k++) {
                const int a = (k + 1) % 3, b = (k + 2) % 3;
                n[k] = (e[1][a] - e[0][a]) * (e[2][b] - e[0][b]) - (e[1][b] - e[0][b]) * (e[2][a] - e[0][a]);
            }
            const double above = n[0] * (e[0][0] - o[0]) + n[1] * (e[0][1] - o[1]) + n[2] * (e[0][2] - o[2]);
            const double t = above / (n[0] * d[0] + n[1] * d[1] + n[2] * d[2]);
            for (int k = 0; k < 3; k++) {
                point[k] = o[k] + t * d[k];
            }
            const int a = fabs(n[0]) > fabs(n[1]) && fabs(n[0]) > fabs(n[2]) ? 1 : fabs(n[1]) > fabs(n[2]) ? 2 : 0;
            const int b = (a + 1) % 3, axis[2] = {a, b};
            double area[3];
            for (int k = 0; k < 3; k++) {
                const double *u = e[(k + 1) % 3], *v = e[(k + 2) % 3];
                area[k] = (u[axis[0]] - point[axis[0]]) * (v[axis[1]] - point[axis[1]]) -
                          (u[axis[1]] - point[axis[1]]) * (v[axis[0]] - point[axis[0]]);
            }
            const double sum = area[0] + area[1] + area[2];
            const double value = (area[0] * p.value[0] + area[1] * p.value[1] + area[2] * p.value[2]) / sum;
            assert_true(test_near((double)p.samples[3 * i], fmin(fmax((value + 2.0) / 5.0, 0.0), 1.0), 1e-5));
        }
        clear_plate(&p);
    }
}

static void flags_override_colours_and_checks_darken_them(void **state)
{
    (void)state;
    static plate p;
    set_plate(&p, 30.0);
    sl_material m = plain(&p);
    m.uv = p.uv;
    m.checks = 70.0;
    m.check_shade = 0.5f;
    shade(&p, &m, NULL, backdrop);
    double least = 1.0, most = 0.0;
    for (int i = 0; i < W * H; i++) {
        if (p.zid[i] != SL_NOTHING) {
            const double factor = (double)(p.samples[3 * i + 1] / p.rgb[1]);
            least = fmin(least, factor);
            most = fmax(most, factor);
        }
    }
    assert_true(least >= 0.5 - 1e-6 && least < 0.55 && most <= 1.0 + 1e-6 && most > 0.95);
    m.uv = NULL;
    p.flag = 1;
    m.flag = &p.flag;
    shade(&p, &m, NULL, backdrop);
    for (int i = 0; i < W * H; i++) {
        if (p.zid[i] != SL_NOTHING) {
            assert_memory_equal(p.samples + 3 * i, m.flag_rgb, sizeof m.flag_rgb);
        }
    }
    clear_plate(&p);
}

static void no_input_makes_a_sample_that_is_not_a_number(void **state)
{
    (void)state;
    static plate p;
    set_plate(&p, 45.0);
    const sl_light light = {{0.0, 0.6, 0.8}, {1, 1, 1}, true, true};
    const sl_light_rig_def def = {.lights = 1, .light = &light, .up = {0, 1, 0}, .map_side = 64};
    sl_light_rig *rig = NULL;
    assert_int_equal(sl_light_rig_create(&def, 3, p.xyz, 1, p.tri, NULL, &rig), SL_OK);
    const double nan = (double)NAN, inf = (double)INFINITY;
    const double uvs[][6] = {
        {nan, 0, 1, 0, 0, 1}, {inf, 0, 1, 0, 0, 1}, {1e300, 0, -1e300, 0, 0, 1}, {0, 0, 0, 0, 0, 0}};
    const double values[][3] = {{nan, 1, 2}, {inf, -inf, 0}, {1e308, -1e308, 1e308}, {0, 0, 0}};
    const float normals[][9] = {
        {0}, {NAN, 0, 1, 0, 1, 0, 1, 0, 0}, {INFINITY, 0, 1, 0, 1, 0, 1, 0, 0}, {1e-38f, 0, 0, 0, 0, 0, 0, 0, 0}};
    for (int i = 0; i < 64; i++) {
        sl_material m = plain(&p);
        m.lit = true;
        m.uv = uvs[i % 4];
        m.value = values[i / 4 % 4];
        m.map_rgb = p.map;
        m.map_count = 2;
        m.contour = 0.0;
        m.normal = normals[i / 16];
        shade(&p, &m, rig, backdrop);
        for (int k = 0; k < 3 * W * H; k++) {
            assert_true(isfinite(p.samples[k]) && p.samples[k] >= 0.0f && p.samples[k] <= 1.0f);
        }
    }
    sl_light_rig_free(rig);
    clear_plate(&p);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_checkerboard_is_the_mean_over_its_box),
        cmocka_unit_test(a_distant_checkerboard_is_even_grey),
        cmocka_unit_test(values_are_interpolated_in_the_scene_not_on_the_picture),
        cmocka_unit_test(flags_override_colours_and_checks_darken_them),
        cmocka_unit_test(no_input_makes_a_sample_that_is_not_a_number),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
