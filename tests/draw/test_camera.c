#include "support/test_support.h"

#include "draw/camera.h"
#include "geom/vec3.h"

#include <math.h>
#include <string.h>

enum { POINTS = 60 };

static void random_cloud(test_rng *rng, double *xyz)
{
    const double size[3] = {test_uniform(rng, 0.1, 3.0), test_uniform(rng, 0.1, 3.0), test_uniform(rng, 0.1, 3.0)};
    for (int i = 0; i < 3 * POINTS; i++) {
        xyz[i] = test_uniform(rng, -size[i % 3], size[i % 3]) + 5.0 * (i % 3);
    }
}

static sl_view random_view(test_rng *rng)
{
    sl_view view = sl_view_default();
    view.azimuth = test_uniform(rng, -400.0, 400.0);
    view.elevation = test_uniform(rng, -90.0, 90.0);
    view.fov = test_index(rng, 3) == 0 ? 0.0 : test_uniform(rng, 5.0, 100.0);
    view.margin = test_uniform(rng, 0.0, 0.3);
    view.top = test_uniform(rng, 0.0, 0.15);
    view.bottom = test_uniform(rng, 0.0, 0.15);
    view.up_axis = test_index(rng, 3);
    return view;
}

/* Every point inside the margin; on one axis two opposite sides touch it. */
static void a_frame_holds_all_points_and_touches_two_opposite_sides(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0xca3e4a);
    for (int trial = 0; trial < 300 * test_multiplier(); trial++) {
        double xyz[3 * POINTS];
        random_cloud(&rng, xyz);
        const sl_view view = random_view(&rng);
        const int32_t w = 64 + test_index(&rng, 1000), h = 64 + test_index(&rng, 1000);
        sl_camera camera;
        assert_int_equal(sl_camera_frame(&view, (double)w / h, POINTS, NULL, xyz, &camera), SL_OK);
        double near = INFINITY, far = -INFINITY, lo[2] = {INFINITY, INFINITY}, hi[2] = {-INFINITY, -INFINITY};
        for (int i = 0; i < POINTS; i++) {
            double eye[3], s[2];
            sl_camera_to_eye(&camera, xyz + 3 * i, eye);
            assert_true(eye[2] > camera.near_depth);
            near = fmin(near, eye[2]);
            far = fmax(far, eye[2]);
            sl_camera_project(&camera, w, h, eye, s);
            for (int k = 0; k < 2; k++) {
                lo[k] = fmin(lo[k], s[k] / (k == 0 ? w : h));
                hi[k] = fmax(hi[k], s[k] / (k == 0 ? w : h));
            }
        }
        const double m = view.margin, tol = 1e-9;
        assert_true(lo[0] >= m - tol && hi[0] <= 1.0 - m + tol);
        assert_true(lo[1] >= m + view.top - tol && hi[1] <= 1.0 - m - view.bottom + tol);
        const bool wide = fabs(lo[0] - m) < tol && fabs(hi[0] - 1.0 + m) < tol;
        const bool high = fabs(lo[1] - m - view.top) < tol && fabs(hi[1] - 1.0 + m + view.bottom) < tol;
        const bool close = fabs(near - 0.1 * (far - near)) < tol * far; /* as near as it may come */
        assert_true(wide || high || (close && view.fov > 0.0));
    }
}

static void axes_are_orthonormal_and_up_is_up(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0xa8e5);
    for (int trial = 0; trial < 200; trial++) {
        const double p[3] = {0.3, -0.2, 0.9};
        const sl_view view = random_view(&rng);
        sl_camera c;
        assert_int_equal(sl_camera_frame(&view, 1.3, 1, NULL, p, &c), SL_OK);
        double cross[3];
        sl_vec3_cross(c.right, c.up, cross);
        for (int k = 0; k < 3; k++) {
            assert_true(test_near(cross[k], -c.forward[k], 1e-12));
        }
        assert_true(test_near(sl_vec3_norm(c.right), 1.0, 1e-12) && test_near(sl_vec3_norm(c.up), 1.0, 1e-12));
        assert_true(c.up[view.up_axis] >= -1e-12);
        assert_true(test_near(c.right[view.up_axis], 0.0, 1e-12));
    }
}

/* The eye's side of the scene, by the words of the header. */
static void azimuth_and_elevation_mean_what_they_say(void **state)
{
    (void)state;
    static const struct {
        double azimuth, elevation;
        int32_t up_axis;
        double towards[3];
    } cases[] = {{0, 0, 1, {0, 0, 1}},  {90, 0, 1, {1, 0, 0}}, {0, 90, 1, {0, 1, 0}}, {0, 0, 2, {0, -1, 0}},
                 {90, 0, 2, {1, 0, 0}}, {0, 90, 2, {0, 0, 1}}, {0, 0, 0, {0, 1, 0}},  {90, 0, 0, {0, 0, 1}}};
    for (size_t i = 0; i < SL_COUNTOF(cases); i++) {
        const double p[3] = {0, 0, 0};
        sl_view view = sl_view_default();
        view.azimuth = cases[i].azimuth;
        view.elevation = cases[i].elevation;
        view.up_axis = cases[i].up_axis;
        sl_camera c;
        assert_int_equal(sl_camera_frame(&view, 1.0, 1, NULL, p, &c), SL_OK);
        for (int k = 0; k < 3; k++) {
            assert_true(test_near(c.forward[k], -cases[i].towards[k], 1e-12));
        }
    }
}

static void rays_run_through_what_they_project_to(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0x4a45);
    for (int trial = 0; trial < 300 * test_multiplier(); trial++) {
        double xyz[3 * POINTS], eye[3], s[2], o[3], d[3];
        random_cloud(&rng, xyz);
        const sl_view view = random_view(&rng);
        sl_camera camera;
        assert_int_equal(sl_camera_frame(&view, 1.5, POINTS, NULL, xyz, &camera), SL_OK);
        sl_camera_to_eye(&camera, xyz, eye);
        sl_camera_project(&camera, 300, 200, eye, s);
        sl_camera_ray(&camera, 300, 200, s[0], s[1], o, d);
        for (int k = 0; k < 3; k++) {
            assert_true(test_near(o[k] + eye[2] * d[k], eye[k], 1e-9));
        }
    }
}

static void a_plan_shows_exactly_its_window(void **state)
{
    (void)state;
    const sl_camera c = sl_camera_plan(-0.25, 0.125, 2.5, 1.6);
    const double low[3] = {-0.25, 0.125, 0.0}, high[3] = {-0.25 + 2.5 * 1.6, 2.625, 0.0};
    double eye[3], s[2];
    sl_camera_to_eye(&c, low, eye);
    sl_camera_project(&c, 1600, 1000, eye, s);
    assert_true(test_near(s[0], 0.0, 1e-9) && test_near(s[1], 1000.0, 1e-9));
    sl_camera_to_eye(&c, high, eye);
    sl_camera_project(&c, 1600, 1000, eye, s);
    assert_true(test_near(s[0], 1600.0, 1e-9) && test_near(s[1], 0.0, 1e-9));
}

static void nothing_and_not_a_number_frame_the_unit_box(void **state)
{
    (void)state;
    const double xyz[9] = {(double)NAN, 1, 2, 3, (double)INFINITY, 1, 2, 2, (double)NAN};
    const sl_view view = sl_view_default();
    sl_camera none, bad;
    assert_int_equal(sl_camera_frame(&view, 1.0, 0, NULL, NULL, &none), SL_OK);
    assert_int_equal(sl_camera_frame(&view, 1.0, 3, NULL, xyz, &bad), SL_OK);
    for (int k = 0; k < 3; k++) {
        assert_true(isfinite(none.eye[k]) && test_near(none.eye[k], bad.eye[k], 0.0));
    }
}

static void options_out_of_range_are_refused(void **state)
{
    (void)state;
    const double p[3] = {0, 0, 0};
    sl_camera c;
    for (int i = 0; i < 11; i++) {
        sl_view view = sl_view_default();
        double aspect = 1.0;
        switch (i) {
        case 0:
            view.azimuth = (double)NAN;
            break;
        case 1:
            view.elevation = 91.0;
            break;
        case 2:
            view.fov = -1.0;
            break;
        case 3:
            view.fov = 121.0;
            break;
        case 4:
            view.margin = 0.5;
            break;
        case 5:
            view.up_axis = 3;
            break;
        case 6:
            aspect = 0.0;
            break;
        case 7:
            view.top = 0.41;
            break;
        case 8:
            view.bottom = -0.1;
            break;
        case 9:
            view.margin = view.top = view.bottom = 0.24;
            break;
        default:
            aspect = (double)NAN;
            break;
        }
        assert_int_equal(sl_camera_frame(&view, aspect, 1, NULL, p, &c), SL_BAD_INPUT);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_frame_holds_all_points_and_touches_two_opposite_sides),
        cmocka_unit_test(axes_are_orthonormal_and_up_is_up),
        cmocka_unit_test(azimuth_and_elevation_mean_what_they_say),
        cmocka_unit_test(rays_run_through_what_they_project_to),
        cmocka_unit_test(a_plan_shows_exactly_its_window),
        cmocka_unit_test(nothing_and_not_a_number_frame_the_unit_box),
        cmocka_unit_test(options_out_of_range_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
