#include "draw_support.h"

#include "draw/canvas.h"
#include "draw/mask.h"

#include <string.h>

enum { W = 64, H = 48 };

static double distance_to_segment(double x, double y, const double a[2], const double b[2])
{
    const double dx = b[0] - a[0], dy = b[1] - a[1], l2 = dx * dx + dy * dy;
    const double t = l2 > 0.0 ? fmin(fmax(((x - a[0]) * dx + (y - a[1]) * dy) / l2, 0.0), 1.0) : 0.0;
    return hypot(x - a[0] - t * dx, y - a[1] - t * dy);
}

/* Oracle: the formula at every sample, no bounding of rows and columns. */
static void a_segment_covers_by_distance_in_any_window(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0x5e6);
    for (int trial = 0; trial < 300 * test_multiplier(); trial++) {
        float coverage[W * H];
        sl_mask mask = {test_index(&rng, 40) - 20, test_index(&rng, 40) - 20, W, H, coverage};
        const double a[2] = {test_uniform(&rng, -40, 100), test_uniform(&rng, -40, 90)};
        const bool dot = trial % 5 == 0, level = trial % 5 == 1;
        const double b[2] = {dot ? a[0] : test_uniform(&rng, -40, 100),
                             dot || level ? a[1] : test_uniform(&rng, -40, 90)};
        const double width = test_uniform(&rng, 0.2, 9.0);
        sl_mask_clear(&mask);
        sl_mask_segment(&mask, a, b, width);
        for (int i = 0; i < W * H; i++) {
            const double d = distance_to_segment(mask.x0 + i % W + 0.5, mask.y0 + i / W + 0.5, a, b);
            const double want = fmin(width, 1.0) * fmin(fmax(0.5 * fmax(width, 1.0) + 0.5 - d, 0.0), 1.0);
            assert_true(test_near((double)coverage[i], want, 1e-5));
        }
    }
}

static void overlapping_strokes_do_not_add_up(void **state)
{
    (void)state;
    float one[W * H], two[W * H];
    sl_mask a = {0, 0, W, H, one}, b = {0, 0, W, H, two};
    const double p[2] = {5.2, 7.9}, q[2] = {50.1, 33.3};
    sl_mask_clear(&a);
    sl_mask_clear(&b);
    sl_mask_segment(&a, p, q, 3.3);
    sl_mask_segment(&b, p, q, 3.3);
    sl_mask_segment(&b, q, p, 3.3);
    for (int i = 0; i < W * H; i++) {
        assert_true(test_near((double)one[i], (double)two[i], 1e-6));
    }
}

static void a_rectangle_covers_by_area(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0x4ec7);
    for (int trial = 0; trial < 100; trial++) {
        float coverage[W * H];
        sl_mask mask = {0, 0, W, H, coverage};
        const double x0 = test_uniform(&rng, 0, W - 1), x1 = test_uniform(&rng, x0, W);
        const double y0 = test_uniform(&rng, 0, H - 1), y1 = test_uniform(&rng, y0, H);
        double sum = 0.0;
        sl_mask_clear(&mask);
        sl_mask_rectangle(&mask, x0, y0, x1, y1);
        for (int i = 0; i < W * H; i++) {
            sum += (double)coverage[i];
        }
        assert_true(test_near(sum, (x1 - x0) * (y1 - y0), 1e-3));
    }
}

static void positions_that_are_not_finite_draw_nothing(void **state)
{
    (void)state;
    float coverage[W * H];
    sl_mask mask = {0, 0, W, H, coverage};
    const double good[2] = {10, 10}, nan[2] = {(double)NAN, 3}, inf[2] = {3, -(double)INFINITY}, huge[2] = {1e300, 2};
    sl_mask_clear(&mask);
    sl_mask_segment(&mask, good, nan, 3);
    sl_mask_segment(&mask, inf, good, 3);
    sl_mask_segment(&mask, huge, good, 3);
    sl_mask_segment(&mask, good, good, (double)NAN);
    sl_mask_rectangle(&mask, (double)NAN, 0, 5, 5);
    for (int i = 0; i < W * H; i++) {
        assert_true(coverage[i] == 0.0f);
    }
}

/* A cube seen from a corner: its 9 front edges are drawn, the 3 behind are not. */
static void a_cube_shows_nine_edges_and_hides_three(void **state)
{
    (void)state;
    enum { S = 200 };
    static const int32_t tri[36] = {0, 2, 3, 0, 3, 1, 4, 5, 7, 4, 7, 6, 0, 1, 5, 0, 5, 4,
                                    2, 6, 7, 2, 7, 3, 0, 4, 6, 0, 6, 2, 1, 3, 7, 1, 7, 5};
    double xyz[24];
    for (int v = 0; v < 8; v++) {
        for (int k = 0; k < 3; k++) {
            xyz[3 * v + k] = ((v >> k & 1) != 0 ? 0.5 : -0.5) * (1.0 + 0.1 * k);
        }
    }
    static const double fov[] = {0.0, 40.0};
    for (size_t f = 0; f < SL_COUNTOF(fov); f++) {
        sl_view view = sl_view_default();
        view.fov = fov[f];
        sl_camera camera;
        sl_screen *screen = NULL;
        assert_int_equal(sl_camera_frame(&view, 1.0, 8, NULL, xyz, &camera), SL_OK);
        assert_int_equal(sl_screen_create(&camera, S, S, 8, xyz, 12, tri, 32, NULL, &screen), SL_OK);
        uint64_t *zid = draw_all(screen);
        const sl_visibility visible = {0, 0, S, S, zid};
        float *coverage = sl_alloc(S * S, sizeof *coverage);
        assert_non_null(coverage);
        sl_mask mask = {0, 0, S, S, coverage};
        /* The corner farthest from the eye (azimuth 35, elevation 20: towards +x +y +z) is 0; its edges are hidden. */
        int shown = 0, hidden = 0;
        for (int a = 0; a < 8; a++) {
            for (int k = 0; k < 3; k++) {
                const int b = a ^ 1 << k;
                if (b < a) {
                    continue;
                }
                const double *ea = screen->eye + 3 * a, *eb = screen->eye + 3 * b;
                double pa[2], pb[2], drawn = 0.0;
                sl_camera_project(&camera, S, S, ea, pa);
                sl_camera_project(&camera, S, S, eb, pb);
                sl_mask_clear(&mask);
                sl_mask_visible_segment(&mask, screen, &visible, ea, eb, 2.0);
                for (int i = 0; i < S * S; i++) {
                    drawn += (double)coverage[i];
                }
                const double whole = 2.0 * hypot(pa[0] - pb[0], pa[1] - pb[1]);
                if (a == 0) {
                    assert_true(drawn < 0.08 * whole); /* its ends meet visible edges */
                    hidden++;
                } else {
                    assert_true(drawn > 0.95 * whole);
                    shown++;
                }
            }
        }
        assert_int_equal(shown, 9);
        assert_int_equal(hidden, 3);
        sl_free(coverage);
        sl_free(zid);
        sl_screen_free(screen);
    }
}

/* Cosine between the outward normal of the unit sphere at p and the direction to the eye. */
static double facing(const sl_camera *camera, const double *p)
{
    double cosine = 0.0, length2 = 0.0;
    for (int k = 0; k < 3; k++) {
        const double to_eye = camera->eye[k] - p[k];
        cosine += to_eye * p[k];
        length2 += to_eye * to_eye;
    }
    return cosine / sqrt(length2);
}

/* A fine triangulated sphere: every edge on the near side is drawn nearly whole up to steep slopes, every edge on the
 * far side not at all. */
static void edges_of_a_sphere_show_on_the_near_side_only(void **state)
{
    (void)state;
    enum { S = 300, RINGS = 20, SIDES = 32, NV = RINGS * SIDES, NT = 2 * (RINGS - 1) * SIDES };
    static double xyz[3 * NV];
    static int32_t tri[3 * NT];
    int32_t nt = 0;
    for (int v = 0; v < NV; v++) {
        const double polar = TEST_PI * (v / SIDES + 0.5) / RINGS, turn = 2.0 * TEST_PI * (v % SIDES) / SIDES;
        xyz[3 * v] = sin(polar) * cos(turn);
        xyz[3 * v + 1] = cos(polar);
        xyz[3 * v + 2] = sin(polar) * sin(turn);
    }
    for (int r = 0; r + 1 < RINGS; r++) {
        for (int s = 0; s < SIDES; s++) {
            const int32_t a = r * SIDES + s, b = r * SIDES + (s + 1) % SIDES, c = a + SIDES, d = b + SIDES;
            const int32_t two[6] = {a, b, d, a, d, c};
            memcpy(tri + 3 * nt, two, sizeof two);
            nt += 2;
        }
    }
    const sl_view view = sl_view_default();
    sl_camera camera;
    sl_screen *screen = NULL;
    assert_int_equal(sl_camera_frame(&view, 1.0, NV, NULL, xyz, &camera), SL_OK);
    assert_int_equal(sl_screen_create(&camera, S, S, NV, xyz, NT, tri, 32, NULL, &screen), SL_OK);
    uint64_t *zid = draw_all(screen);
    const sl_visibility visible = {0, 0, S, S, zid};
    float *coverage = sl_alloc(S * S, sizeof *coverage);
    assert_non_null(coverage);
    sl_mask mask = {0, 0, S, S, coverage};
    int near = 0, far = 0;
    for (int v = SIDES; v < NV - SIDES; v++) {
        const int b = v / SIDES * SIDES + (v + 1) % SIDES;
        const double *ea = screen->eye + 3 * v, *eb = screen->eye + 3 * b;
        const double one = facing(&camera, xyz + 3 * v), other = facing(&camera, xyz + 3 * b);
        if (fabs(one) < 0.25 || fabs(other) < 0.25) {
            continue; /* about the silhouette either is right */
        }
        double pa[2], pb[2], drawn = 0.0;
        sl_camera_project(&camera, S, S, ea, pa);
        sl_camera_project(&camera, S, S, eb, pb);
        sl_mask_clear(&mask);
        sl_mask_visible_segment(&mask, screen, &visible, ea, eb, 2.0);
        for (int i = 0; i < S * S; i++) {
            drawn += (double)coverage[i];
        }
        const double whole = 2.0 * hypot(pa[0] - pb[0], pa[1] - pb[1]);
        if (one > 0.0) {

            assert_true(drawn > 0.97 * whole);
            near++;
        } else {
            assert_true(drawn == 0.0);
            far++;
        }
    }
    assert_true(near > 100 && far > 100);
    sl_free(coverage);
    sl_free(zid);
    sl_screen_free(screen);
}

static void a_segment_through_the_eye_is_cut_at_the_near_plane(void **state)
{
    (void)state;
    const sl_camera camera = {.centre = {0.5, 0.5},
                              .right = {1, 0, 0},
                              .up = {0, 1, 0},
                              .forward = {0, 0, -1},
                              .focal = 1.0,
                              .near_depth = 0.1,
                              .perspective = true};
    const double behind[3] = {0.4, 0.2, -3.0}, ahead[3] = {0.1, -0.1, 2.0}, back[3] = {1.0, 1.0, -1.0};
    float coverage[W * H];
    uint64_t zid[W * H];
    sl_mask mask = {0, 0, W, H, coverage};
    const sl_visibility visible = {0, 0, W, H, zid};
    sl_screen *screen = NULL;
    assert_int_equal(sl_screen_create(&camera, W, H, 0, NULL, 0, NULL, 16, NULL, &screen), SL_OK);
    memset(zid, 0xff, sizeof zid);
    sl_mask_clear(&mask);
    sl_mask_visible_segment(&mask, screen, &visible, back, behind, 2.0);
    for (int i = 0; i < W * H; i++) {
        assert_true(coverage[i] == 0.0f);
    }
    sl_mask_visible_segment(&mask, screen, &visible, behind, ahead, 2.0);
    double s[2];
    sl_camera_project(&camera, W, H, ahead, s);
    assert_true(coverage[(int)s[1] * W + (int)s[0]] > 0.5f);
    for (int i = 0; i < W * H; i++) {
        assert_true(isfinite(coverage[i]));
    }
    sl_screen_free(screen);
}

static void blending_mixes_linear_light_and_reducing_averages(void **state)
{
    (void)state;
    const float black[3] = {0, 0, 0}, colour[3] = {0.9f, 0.4f, 0.1f};
    sl_canvas *canvas = NULL;
    assert_int_equal(sl_canvas_create(0, 4, black, &canvas), SL_BAD_INPUT);
    assert_null(canvas);
    assert_int_equal(sl_canvas_create(5, 4, black, &canvas), SL_OK);
    float coverage[9] = {0.5f, 1, 0, 0, 0, 0.25f, 1, 1, 1}; /* window 3 x 3 hanging over the corner */
    const sl_mask mask = {-1, -1, 3, 3, coverage};
    sl_canvas_blend(canvas, &mask, colour, 0.5f);
    assert_true(test_near((double)canvas->rgb[0], 0.0, 0.0));
    assert_true(test_near((double)canvas->rgb[3], 0.9 * 0.125, 1e-6));
    assert_true(test_near((double)canvas->rgb[15], 0.45, 1e-6) && test_near((double)canvas->rgb[18 + 1], 0.2, 1e-6));
    test_rng rng = test_rng_seed(0xa7e);
    float samples[3 * 15 * 6];
    for (int i = 0; i < 3 * 15 * 6; i++) {
        samples[i] = (float)test_uniform(&rng, 0, 1);
    }
    sl_canvas_reduce(canvas, 1, 2, 3, samples);
    for (int x = 0; x < 5; x++) {
        for (int y = 0; y < 2; y++) {
            for (int k = 0; k < 3; k++) {
                double sum = 0.0;
                for (int i = 0; i < 9; i++) {
                    sum += (double)samples[3 * ((3 * y + i / 3) * 15 + 3 * x + i % 3) + k];
                }
                assert_true(test_near((double)canvas->rgb[3 * ((1 + y) * 5 + x) + k], sum / 9.0, 1e-6));
            }
        }
    }
    sl_canvas_free(canvas);
    sl_canvas_free(NULL);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_segment_covers_by_distance_in_any_window),
        cmocka_unit_test(overlapping_strokes_do_not_add_up),
        cmocka_unit_test(a_rectangle_covers_by_area),
        cmocka_unit_test(positions_that_are_not_finite_draw_nothing),
        cmocka_unit_test(a_cube_shows_nine_edges_and_hides_three),
        cmocka_unit_test(edges_of_a_sphere_show_on_the_near_side_only),
        cmocka_unit_test(a_segment_through_the_eye_is_cut_at_the_near_plane),
        cmocka_unit_test(blending_mixes_linear_light_and_reducing_averages),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
