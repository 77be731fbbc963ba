/* g1, g2, g3 and their gradients, targets and weights. */
#include "param/abf_internal.h"

#include "param/abf_charts.h"

#define PI TEST_PI

static const int32_t corner[] = {2, 3, 7, 10, 13}; /* valence 5, cut 2 + 3: no hidden symmetry */
static const int32_t first_whole[] = {0, 5}, first_split[] = {0, 2, 5};
static const double theta_whole[] = {2.0 * PI}, theta_split[] = {PI, PI};
static const sl_sectors whole = {1, first_whole, corner, theta_whole};
static const sl_sectors split = {2, first_split, corner, theta_split};

/* Sec. 4.2: "g2^1 and g2^2 => g2": the halves add up to the whole, for any angles. */
static void g2_of_half_sectors_sums_to_g2_of_vertex(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0x5eed);
    for (int trial = 0; trial < 100 * test_multiplier(); trial++) {
        double alpha[15], g_whole[1], g_split[2];
        for (int c = 0; c < 15; c++) {
            alpha[c] = test_uniform(&rng, 0.05, 3.0);
        }
        sl_abf_eval_g2(&whole, alpha, g_whole);
        sl_abf_eval_g2(&split, alpha, g_split);
        assert_true(test_near(g_split[0] + g_split[1], g_whole[0], 64 * 0x1p-52));
    }
}

/* Independent oracle: without it, a wrong sign of theta passes the property above. */
static void g2_vanishes_when_each_half_is_flat(void **state)
{
    (void)state;
    const double alpha[15] = {[2] = 1.1, [3] = PI - 1.1, [7] = 0.4, [10] = 0.9, [13] = PI - 1.3};
    double g[2];
    sl_abf_eval_g2(&split, alpha, g);
    assert_true(test_near(g[0], 0.0, 8 * 0x1p-52) && test_near(g[1], 0.0, 8 * 0x1p-52));
}

static void random_angles(const sl_patch *patch, test_rng *rng, double *alpha)
{
    for (int32_t c = 0; c < 3 * patch->nt; c++) {
        alpha[c] = test_uniform(rng, 0.2, 2.6);
    }
}

static void g1_is_the_excess_of_the_angle_sum(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0x61);
    sl_patch *patch = chart_grid(4, 3, 0.2, chart_bumps, 1.0, 0x61);
    double alpha[3 * 24], g1[24];
    random_angles(patch, &rng, alpha);
    for (int32_t t = 0; t < patch->nt; t++) {
        const double share = test_uniform(&rng, 0.2, 0.5), excess = test_uniform(&rng, -0.7, 0.9);
        alpha[3 * t + 1] = share * PI;
        alpha[3 * t + 2] = PI - alpha[3 * t] - alpha[3 * t + 1] + excess;
        g1[t] = excess;
    }
    double computed[24];
    sl_abf_eval_g1(patch, alpha, computed);
    assert_true(chart_max_diff(computed, g1, patch->nt) <= 16 * TEST_EPS);
    sl_patch_free(patch);
}

/* Lengths around a hub by the law of sines, triangle after triangle, found by their vertices: the last spoke is
 * exp(-g3) or exp(g3) times the first, by the direction of travel. */
static double spoke_ratio(const sl_patch *patch, int32_t hub, const double *alpha)
{
    int32_t at = -1, start = -1;
    double length = 1.0;
    while (at < 0 || at != start) {
        bool found = false;
        for (int32_t c = 0; c < 3 * patch->nt && !found; c++) {
            const int32_t next = patch->tri[sl_corner_next(c)], prev = patch->tri[sl_corner_prev(c)];
            if (patch->tri[c] == hub && (at < 0 || next == at)) {
                start = at < 0 ? next : start;
                length *= sin(alpha[sl_corner_next(c)]) / sin(alpha[sl_corner_prev(c)]);
                at = prev;
                found = true;
            }
        }
        assert_true(found);
    }
    return length;
}

static void g3_is_the_gap_a_wheel_leaves(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0x63);
    sl_patch *patch = chart_grid(5, 4, 0.2, chart_bumps, 1.0, 0x63);
    double *alpha = malloc(3 * (size_t)patch->nt * sizeof *alpha), g3[12], product[12], ratio[12];
    random_angles(patch, &rng, alpha);
    sl_abf_eval_g3(patch, SL_ABF_LOG, alpha, g3);
    sl_abf_eval_g3(patch, SL_ABF_PRODUCT, alpha, product);
    sl_abf_eval_g3(patch, SL_ABF_RATIO, alpha, ratio);
    int32_t i = 0;
    for (int32_t v = 0; v < patch->nv; v++) {
        if (patch->border[v] == 0) {
            assert_true(test_near(exp(g3[i]), spoke_ratio(patch, v, alpha), 1e-13 * exp(fabs(g3[i]))));
            assert_true(test_near(ratio[i] + 1.0, spoke_ratio(patch, v, alpha), 1e-13 * (ratio[i] + 1.0)));
            assert_true(fabs(g3[i]) > 1e-3 && (product[i] > 0) == (g3[i] > 0));
            i++;
        }
    }
    assert_int_equal(i, 12);
    free(alpha);
    sl_patch_free(patch);
}

/* Angles measured in a flat drawing satisfy everything. */
static void constraints_vanish_for_the_angles_of_a_flat_mesh(void **state)
{
    (void)state;
    for (uint64_t seed = 1; seed <= 8; seed++) {
        sl_patch *patch = chart_grid(6, 5, 0.3, chart_plane, 0.2, seed);
        const int32_t n = chart_interior(patch);
        double *alpha = malloc(3 * (size_t)patch->nt * sizeof *alpha), *g = calloc(4 * (size_t)patch->nt, sizeof *g);
        double *zero = calloc(4 * (size_t)patch->nt, sizeof *zero);
        sl_sector_table table;
        assert_int_equal(sl_sectors_interior(patch, &table), SL_OK);
        sl_corner_angles(patch, alpha);
        sl_abf_eval_g1(patch, alpha, g);
        sl_abf_eval_g2(&table.view, alpha, &g[patch->nt]);
        sl_abf_eval_g3(patch, SL_ABF_LOG, alpha, &g[patch->nt + n]);
        sl_abf_eval_g3(patch, SL_ABF_PRODUCT, alpha, &g[patch->nt + 2 * n]);
        assert_true(chart_max_diff(g, zero, patch->nt + 3 * n) <= 1e-13);
        sl_sectors_clear(&table);
        free(alpha);
        free(g);
        free(zero);
        sl_patch_free(patch);
    }
}

/* The Jacobian's rows against central differences of the residuals. */
static void check_gradients(sl_abf_wheel wheel, double tolerance)
{
    test_rng rng = test_rng_seed(0x6d);
    sl_patch *patch = chart_grid(4, 4, 0.2, chart_bumps, 1.5, 0x6d);
    const int32_t nc = 3 * patch->nt;
    sl_sector_table table;
    sl_abf_system system;
    assert_int_equal(sl_sectors_interior(patch, &table), SL_OK);
    assert_int_equal(sl_abf_system_init(&system, patch, &table.view, 0, &(int32_t){0}), SL_OK);
    const size_t n = (size_t)system.nrows;
    double *alpha = malloc((size_t)nc * sizeof *alpha), *plus = malloc(n * sizeof *plus),
           *minus = malloc(n * sizeof *minus);
    double *unit = calloc(n, sizeof *unit), *row = malloc((size_t)nc * sizeof *row);
    for (int32_t c = 0; c < nc; c++) {
        alpha[c] = test_uniform(&rng, 0.4, 1.7);
    }
    sl_abf_system_linearise(&system, wheel, alpha);
    for (size_t r = 0; r < n; r++) {
        memset(row, 0, (size_t)nc * sizeof *row);
        unit[r] = 1.0;
        sl_abf_system_apply_transposed(&system, unit, row);
        unit[r] = 0.0;
        for (int32_t c = 0; c < nc; c++) {
            const double h = 1e-5, a = alpha[c];
            for (int side = 0; side < 2; side++) {
                double *g = side == 0 ? plus : minus;
                alpha[c] = side == 0 ? a + h : a - h;
                sl_abf_eval_g2(&table.view, alpha, g);
                sl_abf_eval_g3(patch, wheel, alpha, &g[system.nsectors]);
            }
            alpha[c] = a;
            assert_true(test_near(row[c], (plus[r] - minus[r]) / (2.0 * h), tolerance));
        }
    }
    sl_abf_system_clear(&system);
    sl_sectors_clear(&table);
    free(alpha);
    free(plus);
    free(minus);
    free(unit);
    free(row);
    sl_patch_free(patch);
}

static void gradients_of_g2_and_log_g3_match_finite_differences(void **state)
{
    (void)state;
    check_gradients(SL_ABF_LOG, 1e-8);
}

static void gradients_of_product_g3_match_finite_differences(void **state)
{
    (void)state;
    check_gradients(SL_ABF_PRODUCT, 1e-9);
}

static void gradients_of_ratio_g3_match_finite_differences(void **state)
{
    (void)state;
    check_gradients(SL_ABF_RATIO, 1e-7);
}

/* Law of cosines: another route to the angle. */
static void corner_angles_match_the_law_of_cosines(void **state)
{
    (void)state;
    sl_patch *patch = chart_hexagon(3, 0.25, chart_cap, 1.2, 0xca);
    double beta[3 * 54];
    sl_corner_angles(patch, beta);
    for (int32_t c = 0; c < 3 * patch->nt; c++) {
        const double *x = &patch->xyz[3 * patch->tri[c]], *y = &patch->xyz[3 * patch->tri[sl_corner_next(c)]];
        const double *z = &patch->xyz[3 * patch->tri[sl_corner_prev(c)]];
        double a = 0.0, b = 0.0, opposite = 0.0;
        for (int k = 0; k < 3; k++) {
            a += (x[k] - y[k]) * (x[k] - y[k]);
            b += (x[k] - z[k]) * (x[k] - z[k]);
            opposite += (y[k] - z[k]) * (y[k] - z[k]);
        }
        assert_true(test_near(cos(beta[c]), (a + b - opposite) / (2.0 * sqrt(a * b)), 1e-14));
    }
    sl_patch_free(patch);
}

static void degenerate_triangles_get_angles_that_sum_to_pi(void **state)
{
    (void)state;
    const double xyz[] = {0.3, 0.1, 0.7, 0.5, 0.4, 0.9, 0.7, 0.7, 1.1, 0.3, 0.1, 0.7, 0.3, 0.1, 0.7};
    const int32_t tri[] = {0, 1, 2, /* on a line, 1 in the middle */ 0, 3, 1, /* one edge of no length */ 0,
                           4, 3 /* a point */};
    static const double expected[9] = {0.0, PI, 0.0, PI / 2, PI / 2, 0.0, PI / 3, PI / 3, PI / 3};
    for (int32_t t = 0; t < 3; t++) {
        sl_patch *patch = chart_make(5, xyz, 1, &tri[3 * t]);
        double beta[3], sum = 0.0;
        sl_corner_angles(patch, beta);
        for (int k = 0; k < 3; k++) { /* the patch numbers its vertices anew, the corners keep their order */
            assert_true(test_near(beta[k], expected[3 * t + k], 1e-7));
            sum += beta[k];
        }
        assert_true(test_near(sum, PI, 1e-15));
        sl_patch_free(patch);
    }
}

static void targets_fill_the_turn_around_interior_vertices(void **state)
{
    (void)state;
    sl_patch *patch = chart_hexagon(3, 0.2, chart_cone, 1.7, 0x7a);
    const int32_t nc = 3 * patch->nt;
    double beta[3 * 54], phi[3 * 54], w[3 * 54];
    sl_abf_def def = sl_abf_default();
    sl_corner_angles(patch, beta);
    sl_abf_targets(patch, &def, phi, w);
    for (int32_t v = 0; v < patch->nv; v++) {
        double sum = 0.0, measured = 0.0;
        for (int32_t c = 0; c < nc; c++) {
            sum += patch->tri[c] == v ? phi[c] : 0.0;
            measured += patch->tri[c] == v ? beta[c] : 0.0;
        }
        assert_true(test_near(sum, patch->border[v] != 0 ? measured : 2.0 * PI, 1e-14));
    }
    for (int32_t c = 0; c < nc; c++) {
        assert_true(test_near_rel(w[c], pow(phi[c], -2.0), 4 * TEST_EPS));
        const int32_t other = patch->twin[sl_corner_prev(c)]; /* neighbours at one vertex keep their ratio */
        if (other >= 0) {
            assert_true(test_near(phi[c] / phi[other], beta[c] / beta[other], 1e-13));
        }
    }
    def.energy = SL_ABF_UNWEIGHTED;
    sl_abf_targets(patch, &def, phi, w);
    for (int32_t c = 0; c < nc; c++) {
        assert_true(w[c] == 1.0);
    }
    sl_patch_free(patch);
}

static void targets_clamp_small_angles(void **state)
{
    (void)state;
    const double xyz[] = {0.1, 0.2, 0.3, 1.1, 0.2, 0.3, 0.6, 0.2001, 0.3};
    const int32_t tri[] = {0, 1, 2};
    sl_patch *patch = chart_make(3, xyz, 1, tri);
    sl_abf_def def = sl_abf_default();
    double phi[3], w[3];
    sl_abf_targets(patch, &def, phi, w);
    assert_true(phi[0] == def.min_angle && phi[1] == def.min_angle);
    assert_true(test_near(phi[2], PI - 2.0 * atan(0.0002), 1e-9));
    def.min_angle = 0.25;
    sl_abf_targets(patch, &def, phi, w);
    assert_true(phi[0] == 0.25 && test_near(w[0], 16.0, 1e-13));
    sl_patch_free(patch);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(g2_of_half_sectors_sums_to_g2_of_vertex),
        cmocka_unit_test(g2_vanishes_when_each_half_is_flat),
        cmocka_unit_test(g1_is_the_excess_of_the_angle_sum),
        cmocka_unit_test(g3_is_the_gap_a_wheel_leaves),
        cmocka_unit_test(constraints_vanish_for_the_angles_of_a_flat_mesh),
        cmocka_unit_test(gradients_of_g2_and_log_g3_match_finite_differences),
        cmocka_unit_test(gradients_of_product_g3_match_finite_differences),
        cmocka_unit_test(gradients_of_ratio_g3_match_finite_differences),
        cmocka_unit_test(corner_angles_match_the_law_of_cosines),
        cmocka_unit_test(degenerate_triangles_get_angles_that_sum_to_pi),
        cmocka_unit_test(targets_fill_the_turn_around_interior_vertices),
        cmocka_unit_test(targets_clamp_small_angles),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
