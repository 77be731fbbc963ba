/* Distortion against known linear maps and a plain eigenvalue computation of its own. */
#include "param/distortion.h"

#include "geom/vec3.h"
#include "param/stretch_charts.h"

/* A random rotation of the plane of triangles into space: two orthonormal vectors. */
static void random_frame(test_rng *rng, double x[3], double y[3])
{
    double z[3], a[3], b[3];
    for (int k = 0; k < 3; k++) {
        a[k] = test_uniform(rng, -1.0, 1.0);
        b[k] = test_uniform(rng, -1.0, 1.0);
    }
    sl_vec3_cross(a, b, z);
    sl_vec3_cross(z, a, y);
    for (int k = 0; k < 3; k++) {
        x[k] = a[k] / sl_vec3_norm(a);
        y[k] /= sl_vec3_norm(a) * sl_vec3_norm(z);
    }
}

/* nt random triangles of a plane in space and their images under [a b; c d]. */
static void linear_soup(test_rng *rng, int32_t nt, const double J[4], double *xyz, double *uv)
{
    double x[3], y[3];
    random_frame(rng, x, y);
    for (int32_t c = 0; c < 3 * nt; c++) {
        const double p = test_uniform(rng, -0.3, 0.3) + 2.0 * (c % 3 == 1),
                     q = test_uniform(rng, -0.3, 0.3) + 2.0 * (c % 3 == 2);
        for (int k = 0; k < 3; k++) {
            xyz[3 * c + k] = 0.3 + p * x[k] + q * y[k];
        }
        uv[2 * c] = J[0] * p + J[1] * q + 1.7;
        uv[2 * c + 1] = J[2] * p + J[3] * q - 0.4;
    }
}

/* J = R(a) diag(s1, s2) R(b). */
static void known_map(double s1, double s2, double a, double b, double J[4])
{
    J[0] = cos(a) * s1 * cos(b) - sin(a) * s2 * sin(b);
    J[1] = -cos(a) * s1 * sin(b) - sin(a) * s2 * cos(b);
    J[2] = sin(a) * s1 * cos(b) + cos(a) * s2 * sin(b);
    J[3] = -sin(a) * s1 * sin(b) + cos(a) * s2 * cos(b);
}

enum { SOUP = 17 };

static void distortion_of_a_linear_map_is_that_of_its_singular_values(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0xd157);
    for (int trial = 0; trial < 200 * test_multiplier(); trial++) {
        const double s2 = test_uniform(&rng, 0.05, 2.0), s1 = s2 * test_uniform(&rng, 1.0, 30.0);
        double J[4], xyz[9 * SOUP], uv[6 * SOUP];
        known_map(s1, s2, test_uniform(&rng, 0.0, 7.0), test_uniform(&rng, 0.0, 7.0), J);
        linear_soup(&rng, SOUP, J, xyz, uv);
        sl_distortion d;
        assert_int_equal(sl_distortion_measure(SOUP, xyz, uv, 1, &d), SL_OK);
        const double tol = 1e-11, mean = sqrt(s1 * s2); /* the common scale makes s1 s2 one */
        assert_true(test_near_rel(d.l2, sqrt((mean * mean / (s1 * s1) + mean * mean / (s2 * s2)) / 2.0), tol));
        assert_true(test_near_rel(d.linf, mean / s2, tol));
        assert_true(test_near_rel(d.angle_mean, s1 / s2, tol) && test_near_rel(d.angle_p95, s1 / s2, tol));
        assert_true(test_near_rel(d.angle_max, s1 / s2, tol));
        assert_true(test_near_rel(d.area_mean, 1.0, tol) && test_near_rel(d.area_max, 1.0, tol));
        assert_true(test_near_rel(d.area_uv, s1 * s2 * d.area_3d, tol));
        assert_int_equal(d.flipped, 0);
        assert_int_equal(d.degenerate, 0);
        assert_int_equal(d.measured, SOUP);
    }
}

/* Two pieces of areas 3 : 1 mapped with s = (2, 1) and (1/2, 1/2): every column by hand. */
static void distortion_of_two_pieces_is_weighted_by_their_area(void **state)
{
    (void)state;
    const double xyz[18] = {0, 0, 1, 3, 0, 1, 0, 2, 1, 5, 0, 1, 6, 0, 1, 5, 2, 1};
    const double uv[12] = {0, 0, 6, 0, 0, 2, 7, 7, 7.5, 7, 7, 8};
    const double area[2] = {3.0, 1.0}, uv_area = 6.0 + 0.25, ratio = uv_area / 4.0;
    sl_distortion d;
    assert_int_equal(sl_distortion_measure(2, xyz, uv, 1, &d), SL_OK);
    const double first = (1.0 / 4.0 + 1.0) / 2.0, second = 4.0;
    assert_true(test_near_rel(d.l2, sqrt((area[0] * first + area[1] * second) / 4.0 * ratio), 1e-14));
    assert_true(test_near_rel(d.linf, 2.0 * sqrt(ratio), 1e-14));
    assert_true(test_near_rel(d.angle_mean, (3.0 * 2.0 + 1.0) / 4.0, 1e-14));
    assert_true(test_near_rel(d.angle_p95, 2.0, 1e-14) && test_near_rel(d.angle_max, 2.0, 1e-14));
    const double change[2] = {2.0 / ratio, ratio / 0.25};
    assert_true(test_near_rel(d.area_mean, (3.0 * change[0] + change[1]) / 4.0, 1e-14));
    assert_true(test_near_rel(d.area_max, change[1], 1e-14));
    assert_true(test_near_rel(d.area_3d, 4.0, 1e-14) && test_near_rel(d.area_uv, uv_area, 1e-14));
}

static void p95_leaves_out_the_worst_twentieth_of_the_area(void **state)
{
    (void)state;
    double xyz[9 * 20], uv[6 * 20];
    for (int t = 0; t < 20; t++) { /* equal areas; s1 / s2 = 1 + t, in shuffled order */
        const int s = 7 * t % 20;
        memcpy(&xyz[9 * t], (double[]){s, 0, 0, s + 1.0, 0, 0, s, 1, 0}, 9 * sizeof *xyz);
        memcpy(&uv[6 * t], (double[]){0, 0, 1.0 + s, 0, 0, 1}, 6 * sizeof *uv);
    }
    sl_distortion d;
    assert_int_equal(sl_distortion_measure(20, xyz, uv, 1, &d), SL_OK);
    assert_true(test_near(d.angle_p95, 19.0, 1e-12) && test_near(d.angle_max, 20.0, 1e-12));
}

static void distortion_ignores_scale_position_and_rotation_of_either_side(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0x5ca1e);
    sl_patch *patch = chart_hexagon(4, 0.2, chart_bumps, 2.5, 0xb);
    double *uv = malloc(2 * (size_t)patch->nv * sizeof *uv);
    for (int32_t i = 0; i < patch->nv; i++) {
        uv[2 * i] = patch->xyz[3 * i] + 0.4 * patch->xyz[3 * i + 1];
        uv[2 * i + 1] = patch->xyz[3 * i + 1];
    }
    sl_distortion a, b;
    assert_int_equal(sl_distortion_measure_indexed(patch->nt, patch->tri, patch->xyz, uv, &a), SL_OK);
    chart_move(patch, 37.5, (double[]){3.0, -1.0, 2.0});
    const double angle = test_uniform(&rng, 0.0, 6.0);
    for (int32_t i = 0; i < patch->nv; i++) {
        const double u = uv[2 * i], v = uv[2 * i + 1];
        uv[2 * i] = 0.013 * (cos(angle) * u - sin(angle) * v) + 5.0;
        uv[2 * i + 1] = 0.013 * (sin(angle) * u + cos(angle) * v) - 2.0;
    }
    assert_int_equal(sl_distortion_measure_indexed(patch->nt, patch->tri, patch->xyz, uv, &b), SL_OK);
    assert_true(a.l2 > 1.01 && a.angle_mean > 1.01 && a.area_max > 1.01);
    assert_true(test_near_rel(a.l2, b.l2, 1e-11) && test_near_rel(a.linf, b.linf, 1e-10));
    assert_true(test_near_rel(a.angle_mean, b.angle_mean, 1e-11) && test_near_rel(a.angle_max, b.angle_max, 1e-10));
    assert_true(test_near_rel(a.area_mean, b.area_mean, 1e-11) && test_near_rel(a.area_max, b.area_max, 1e-10));
    free(uv);
    sl_patch_free(patch);
}

static void soup_and_indexed_triangles_measure_the_same(void **state)
{
    (void)state;
    sl_patch *patch = chart_grid(7, 5, 0.3, chart_bumps, 0.7, 0x1d);
    double *uv = malloc(2 * (size_t)patch->nv * sizeof *uv), *corner_xyz = malloc(9 * (size_t)patch->nt * sizeof *uv);
    double *corner_uv = malloc(6 * (size_t)patch->nt * sizeof *uv);
    for (int32_t i = 0; i < patch->nv; i++) {
        uv[2 * i] = patch->xyz[3 * i] + patch->xyz[3 * i + 2];
        uv[2 * i + 1] = patch->xyz[3 * i + 1];
    }
    for (int32_t c = 0; c < 3 * patch->nt; c++) {
        memcpy(&corner_xyz[3 * c], &patch->xyz[3 * patch->tri[c]], 3 * sizeof *uv);
        memcpy(&corner_uv[2 * c], &uv[2 * patch->tri[c]], 2 * sizeof *uv);
    }
    sl_distortion a, b;
    assert_int_equal(sl_distortion_measure_indexed(patch->nt, patch->tri, patch->xyz, uv, &a), SL_OK);
    assert_int_equal(sl_distortion_measure(patch->nt, corner_xyz, corner_uv, 1, &b), SL_OK);
    assert_memory_equal(&a.l2, &b.l2, sizeof a.l2);
    assert_memory_equal(&a.angle_mean, &b.angle_mean, sizeof a.angle_mean);
    assert_int_equal(a.measured, b.measured);
    free(uv);
    free(corner_xyz);
    free(corner_uv);
    sl_patch_free(patch);
}

/* The sign says which way round is right; a mirrored chart has the same stretch. */
static void flips_are_counted_against_the_sign(void **state)
{
    (void)state;
    const double xyz[18] = {0, 0, 0, 1, 0, 0, 0.2, 0.9, 0, 2, 0, 0.3, 3, 0, 0, 2, 1.5, 0};
    const double uv[12] = {0, 0, 1, 0.1, 0, 1, 2, 0, 2, 1.2, 3, 0};
    sl_distortion plus, minus;
    assert_int_equal(sl_distortion_measure(2, xyz, uv, 1, &plus), SL_OK);
    assert_int_equal(sl_distortion_measure(2, xyz, uv, -1, &minus), SL_OK);
    assert_int_equal(plus.flipped, 1);
    assert_int_equal(minus.flipped, 1);
    assert_int_equal(sl_distortion_measure(1, xyz, uv, -1, &minus), SL_OK);
    assert_int_equal(minus.flipped, 1);
    assert_int_equal(sl_distortion_measure(1, xyz + 9, uv + 6, -1, &minus), SL_OK);
    assert_int_equal(minus.flipped, 0);
    assert_int_equal(sl_distortion_measure(1, xyz + 9, uv + 6, 1, &plus), SL_OK);
    assert_true(plus.l2 == minus.l2 && plus.area_uv > 0.0);
}

static void collapsed_and_non_finite_triangles_are_infinite_not_nan(void **state)
{
    (void)state;
    const double xyz[18] = {0, 0, 0, 1, 0, 0, 0.2, 0.9, 0, 2, 0, 0.3, 3, 0, 0, 2, 1.5, 0};
    double uv[12] = {0, 0, 1, 0.1, 0, 1, 2, 1, 2.5, 1.5, 3, 2};
    sl_distortion d;
    for (int what = 0; what < 3; what++) {
        uv[7] = what == 1 ? NAN : 1.0;
        uv[8] = what == 2 ? INFINITY : 2.5;
        assert_int_equal(sl_distortion_measure(2, xyz, uv, 1, &d), SL_OK);
        assert_int_equal(d.degenerate, 1);
        assert_int_equal(d.flipped, 0);
        assert_true(isinf(d.l2) && isinf(d.linf) && isinf(d.angle_max) && isinf(d.area_max));
        assert_true(isinf(d.angle_mean) && isinf(d.area_mean) && isfinite(d.area_uv));
    }
    const double all_zero[12] = {0};
    assert_int_equal(sl_distortion_measure(2, xyz, all_zero, 1, &d), SL_OK);
    assert_int_equal(d.degenerate, 2);
    assert_true(isinf(d.l2) && isinf(d.area_mean));
}

/* Slivers have no shape: they may flip, and that is all that is said of them. */
static void slivers_in_space_count_for_flips_only(void **state)
{
    (void)state;
    const double xyz[18] = {0, 0, 0, 1, 0, 0, 0.2, 0.9, 0, 2, 0, 0, 3, 0, 0, 2.5, 0.9e-5, 0};
    const double uv[12] = {0, 0, 1, 0, 0.2, 0.9, 2, 0, 2, 7, 3, 0};
    sl_distortion d;
    assert_int_equal(sl_distortion_measure(2, xyz, uv, 1, &d), SL_OK);
    assert_int_equal(d.flipped, 1);
    assert_int_equal(d.measured, 1);
    assert_true(test_near(d.l2, 1.0, 1e-14) && test_near(d.area_3d, 0.45, 1e-14));
    double wider[18];
    memcpy(wider, xyz, sizeof xyz);
    wider[16] = 1.1e-5;
    assert_int_equal(sl_distortion_measure(2, wider, uv, 1, &d), SL_OK);
    assert_int_equal(d.measured, 2);
    assert_int_equal(sl_distortion_measure(1, xyz + 9, uv + 6, 1, &d), SL_OK);
    assert_int_equal(d.measured, 0);
    assert_true(d.l2 == 1.0 && d.angle_mean == 1.0 && d.area_mean == 1.0);
    assert_int_equal(sl_distortion_measure(0, NULL, NULL, 1, &d), SL_OK);
    assert_int_equal(d.measured, 0);
}

/* 2 area <= 1e-7 longest^2 in UV, on either side of the limit. */
static void uv_triangles_are_degenerate_below_1e_7(void **state)
{
    (void)state;
    const double xyz[9] = {0, 0, 0, 1, 0, 0, 0.2, 0.9, 0};
    sl_distortion d;
    assert_int_equal(sl_distortion_measure(1, xyz, (double[]){0, 0, 2, 0, 1, 1.9e-7}, 1, &d), SL_OK);
    assert_int_equal(d.degenerate, 1);
    assert_true(isfinite(d.l2));
    assert_int_equal(sl_distortion_measure(1, xyz, (double[]){0, 0, 2, 0, 1, 2.1e-7}, 1, &d), SL_OK);
    assert_int_equal(d.degenerate, 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(distortion_of_a_linear_map_is_that_of_its_singular_values),
        cmocka_unit_test(distortion_of_two_pieces_is_weighted_by_their_area),
        cmocka_unit_test(p95_leaves_out_the_worst_twentieth_of_the_area),
        cmocka_unit_test(distortion_ignores_scale_position_and_rotation_of_either_side),
        cmocka_unit_test(soup_and_indexed_triangles_measure_the_same),
        cmocka_unit_test(flips_are_counted_against_the_sign),
        cmocka_unit_test(collapsed_and_non_finite_triangles_are_infinite_not_nan),
        cmocka_unit_test(slivers_in_space_count_for_flips_only),
        cmocka_unit_test(uv_triangles_are_degenerate_below_1e_7),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
