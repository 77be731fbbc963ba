/* The ABF++ solver against dense Newton steps and the conditions of a constrained minimum. */
#include "param/abf.h"
#include "param/abf_sectors.h"

#include <lapacke.h>

#include "param/abf_charts.h"
#include "param/abf_internal.h"

#define PI TEST_PI

static sl_abf *make_solver(const sl_patch *patch, const sl_abf_def *def)
{
    sl_abf *solver = NULL;
    assert_int_equal(sl_abf_create(patch, def, &solver), SL_OK);
    return solver;
}

static sl_abf *solve(const sl_patch *patch, const sl_abf_def *def)
{
    sl_abf *solver = make_solver(patch, def);
    assert_int_equal(sl_abf_step(solver, def->max_iterations, NULL), SL_OK);
    return solver;
}

/* All constraints of a patch (g1, g2, g3 one after the other) and their number. */
static int32_t constraints(const sl_patch *patch, const sl_abf_def *def, const sl_sectors *sectors, const double *alpha,
                           double *g)
{
    sl_abf_eval_g1(patch, alpha, g);
    sl_abf_eval_g2(sectors, alpha, &g[patch->nt]);
    sl_abf_eval_g3(patch, def->wheel, alpha, &g[patch->nt + sectors->count]);
    return patch->nt + sectors->count + chart_interior(patch);
}

/* Dense Jacobian of all constraints by central differences: column-major ng x nc. Fourth order. */
static double *difference_jacobian(const sl_patch *patch, const sl_abf_def *def, const sl_sectors *sectors,
                                   const double *alpha, int32_t *ng)
{
    static const double offset[4] = {-2.0, -1.0, 1.0, 2.0}, weight[4] = {1.0 / 12, -8.0 / 12, 8.0 / 12, -1.0 / 12};
    const int32_t nc = 3 * patch->nt;
    const size_t n = (size_t)(patch->nt + sectors->count + chart_interior(patch));
    double *J = calloc(n * (size_t)nc, sizeof *J), *x = malloc((size_t)nc * sizeof *x), *g = malloc(n * sizeof *g);
    memcpy(x, alpha, (size_t)nc * sizeof *x);
    for (int32_t c = 0; c < nc; c++) {
        const double h = 2e-3 * alpha[c];
        for (int k = 0; k < 4; k++) {
            x[c] = alpha[c] + offset[k] * h;
            *ng = constraints(patch, def, sectors, x, g);
            for (size_t r = 0; r < n; r++) {
                J[(size_t)c * n + r] += weight[k] * g[r] / h;
            }
        }
        x[c] = alpha[c];
    }
    free(x);
    free(g);
    return J;
}

/* Solves the full system [Lambda J'; J 0] [dalpha; lambda_new] = [-2 w (alpha - phi); -g] densely: one step from alpha,
 * whatever the old multipliers. out: nc + ng. */
static double *dense_step(const sl_patch *patch, const sl_abf_def *def, const sl_sectors *sectors, const double *alpha,
                          int32_t *total)
{
    const int32_t nc = 3 * patch->nt;
    int32_t ng;
    double *J = difference_jacobian(patch, def, sectors, alpha, &ng);
    const size_t n = (size_t)(nc + ng);
    double *K = calloc(n * n, sizeof *K), *rhs = calloc(n, sizeof *rhs);
    double *phi = malloc((size_t)nc * sizeof *phi), *w = malloc((size_t)nc * sizeof *w);
    lapack_int *pivot = malloc(n * sizeof *pivot);
    sl_abf_targets(patch, def, phi, w);
    for (size_t c = 0; c < (size_t)nc; c++) {
        K[c * n + c] = 2.0 * w[c];
        rhs[c] = -2.0 * w[c] * (alpha[c] - phi[c]);
        for (size_t r = 0; r < (size_t)ng; r++) {
            K[c * n + (size_t)nc + r] = K[((size_t)nc + r) * n + c] = J[c * (size_t)ng + r];
        }
    }
    constraints(patch, def, sectors, alpha, &rhs[nc]);
    for (size_t r = (size_t)nc; r < n; r++) {
        rhs[r] = -rhs[r];
    }
    assert_int_equal(LAPACKE_dgesv(LAPACK_COL_MAJOR, (lapack_int)n, 1, K, (lapack_int)n, pivot, rhs, (lapack_int)n), 0);
    free(J);
    free(K);
    free(phi);
    free(w);
    free(pivot);
    *total = (int32_t)n;
    return rhs;
}

/* Gradient of the Lagrangian E + lambda' g at x, by the Jacobian by differences. */
static void lagrangian_gradient(const sl_patch *patch, const sl_abf_def *def, const sl_sectors *sectors,
                                const sl_abf_view *view, const double *x, double *gradient)
{
    int32_t ng;
    double *J = difference_jacobian(patch, def, sectors, x, &ng);
    for (int32_t c = 0; c < 3 * patch->nt; c++) {
        gradient[c] = 2.0 * view->w[c] * (x[c] - view->phi[c]);
        for (int32_t r = 0; r < ng; r++) {
            const double lambda = r < patch->nt ? view->lambda1[r] : view->lambda2[r - patch->nt];
            gradient[c] += lambda * J[(size_t)c * (size_t)ng + (size_t)r];
        }
    }
    free(J);
}

/* The exact Newton step, densely: the Hessian of the Lagrangian by differences of its gradient. Owned: nc + ng. */
static double *dense_exact_step(const sl_patch *patch, const sl_abf_def *def, const sl_sectors *sectors,
                                const sl_abf *solver, int32_t *total)
{
    const sl_abf_view view = sl_abf_view_of(solver);
    const int32_t nc = 3 * patch->nt;
    int32_t ng;
    double *x = malloc((size_t)nc * sizeof *x), *side[2];
    memcpy(x, sl_abf_angles(solver), (size_t)nc * sizeof *x);
    double *J = difference_jacobian(patch, def, sectors, x, &ng);
    const size_t n = (size_t)(nc + ng);
    double *K = calloc(n * n, sizeof *K), *rhs = calloc(n, sizeof *rhs);
    lapack_int *pivot = malloc(n * sizeof *pivot);
    side[0] = malloc((size_t)nc * sizeof(double));
    side[1] = malloc((size_t)nc * sizeof(double));
    for (size_t c = 0; c < (size_t)nc; c++) {
        const double h = 1e-4, a = x[c];
        for (int k = 0; k < 2; k++) {
            x[c] = k == 0 ? a - h : a + h;
            lagrangian_gradient(patch, def, sectors, &view, x, side[k]);
        }
        x[c] = a;
        for (size_t i = 0; i < (size_t)nc; i++) {
            K[c * n + i] = (side[1][i] - side[0][i]) / (2.0 * h);
        }
        for (size_t r = 0; r < (size_t)ng; r++) {
            K[c * n + (size_t)nc + r] = K[((size_t)nc + r) * n + c] = J[c * (size_t)ng + r];
        }
    }
    lagrangian_gradient(patch, def, sectors, &view, x, rhs);
    constraints(patch, def, sectors, x, &rhs[nc]);
    for (size_t r = 0; r < n; r++) {
        rhs[r] = -rhs[r];
    }
    assert_int_equal(LAPACKE_dgesv(LAPACK_COL_MAJOR, (lapack_int)n, 1, K, (lapack_int)n, pivot, rhs, (lapack_int)n), 0);
    free(J);
    free(K);
    free(x);
    free(side[0]);
    free(side[1]);
    free(pivot);
    *total = (int32_t)n;
    return rhs;
}

/* Takes a few steps, then compares one with the dense exact one; the product form leaves out a term of the order of g3.
 * The step without curvature is far off, so that the comparison means something. */
static void check_exact_step(sl_abf_wheel wheel, sl_abf_energy energy, int32_t warm_up, double tolerance)
{
    sl_patch *patch = chart_grid(4, 4, 0.15, chart_bumps, 1.6, 0xe0 + (uint64_t)warm_up);
    sl_sector_table table = make_sectors(patch, true);
    sl_abf_def def = sl_abf_default();
    def.wheel = wheel;
    def.energy = energy;
    def.newton = SL_ABF_EXACT;
    def.sectors = &table.view;
    def.gradient_tolerance = 0.0; /* steps are taken whatever the state */
    sl_abf *solver = make_solver(patch, &def);
    assert_int_equal(sl_abf_step(solver, warm_up, NULL), SL_OK);
    const int32_t nc = 3 * patch->nt;
    int32_t total, unused;
    double *before = malloc((size_t)nc * sizeof *before);
    memcpy(before, sl_abf_angles(solver), (size_t)nc * sizeof *before);
    const sl_abf_view view = sl_abf_view_of(solver);
    double *old2 = malloc((size_t)view.system->nrows * sizeof *old2);
    memcpy(old2, view.lambda2, (size_t)view.system->nrows * sizeof *old2);
    double *dense = dense_exact_step(patch, &def, &table.view, solver, &total);
    double *dropped = dense_step(patch, &def, &table.view, before, &unused);
    assert_int_equal(sl_abf_step(solver, 1, NULL), SL_OK);
    assert_true(sl_abf_info_of(solver)->step == 1.0 && sl_abf_info_of(solver)->fallbacks == 0);
    double *taken = malloc((size_t)nc * sizeof *taken), size = 0.0;
    for (int32_t c = 0; c < nc; c++) {
        taken[c] = sl_abf_angles(solver)[c] - before[c];
        size = fmax(size, fabs(taken[c]));
    }
    assert_true(chart_max_diff(taken, dense, nc) <= tolerance * size);
    assert_true(chart_max_diff(dropped, dense, nc) >= 0.03 * size);
    for (int32_t r = 0; r < view.system->nrows; r++) {
        const double expected = dense[nc + patch->nt + r];
        assert_true(test_near(view.lambda2[r] - old2[r], expected, 10.0 * tolerance * (size + fabs(expected))));
    }
    sl_abf_free(solver);
    sl_sectors_clear(&table);
    free(before);
    free(old2);
    free(dense);
    free(dropped);
    free(taken);
    sl_patch_free(patch);
}

static void exact_newton_steps_match_a_dense_solve_with_the_hessian_by_differences(void **state)
{
    (void)state;
    check_exact_step(SL_ABF_LOG, SL_ABF_WEIGHTED, 1, 1e-6);
    check_exact_step(SL_ABF_LOG, SL_ABF_UNWEIGHTED, 2, 1e-6);
    check_exact_step(SL_ABF_RATIO, SL_ABF_WEIGHTED, 1, 1e-6);
    check_exact_step(SL_ABF_RATIO, SL_ABF_UNWEIGHTED, 2, 1e-6);
    check_exact_step(SL_ABF_PRODUCT, SL_ABF_WEIGHTED, 2, 5e-4);
    check_exact_step(SL_ABF_PRODUCT, SL_ABF_UNWEIGHTED, 2, 1e-4);
}

/* Near the solution each step squares the gradient with the curvature, and divides it by a constant without. */
static void exact_newton_converges_quadratically_in_every_form(void **state)
{
    (void)state;
    for (int form = 0; form < 6; form++) {
        sl_patch *patch = chart_hexagon(5, 0.2, chart_cap, PI / 2, 0x9a + (uint64_t)form);
        sl_abf_def def = sl_abf_default();
        def.wheel = (sl_abf_wheel)(form % 3);
        def.energy = form < 3 ? SL_ABF_WEIGHTED : SL_ABF_UNWEIGHTED;
        def.gradient_tolerance = 1e-11;
        sl_abf *dropped = solve(patch, &def);
        def.newton = SL_ABF_EXACT;
        sl_abf *exact = solve(patch, &def);
        assert_true(sl_abf_info_of(exact)->converged && !sl_abf_info_of(exact)->floor);
        assert_true(sl_abf_info_of(exact)->iterations <= 7);
        assert_true(sl_abf_info_of(dropped)->iterations > sl_abf_info_of(exact)->iterations);
        if (sl_abf_info_of(dropped)->converged) {
            assert_true(chart_max_diff(sl_abf_angles(exact), sl_abf_angles(dropped), 3 * patch->nt) <= 1e-9);
        }
        sl_abf_free(dropped);
        sl_abf_free(exact);
        sl_patch_free(patch);
    }
}

/* Every step of the solver is the dense one, as long as it is not damped. */
static void check_steps(sl_patch *patch, const sl_abf_def *base, bool constrained)
{
    sl_sector_table table = make_sectors(patch, constrained);
    sl_abf_def def = *base;
    def.sectors = &table.view;
    sl_abf *solver = make_solver(patch, &def);
    const int32_t nc = 3 * patch->nt;
    double *before = malloc((size_t)nc * sizeof *before);
    for (int step = 0; step < 3; step++) {
        int32_t total;
        memcpy(before, sl_abf_angles(solver), (size_t)nc * sizeof *before);
        double *dense = dense_step(patch, &def, &table.view, before, &total);
        assert_int_equal(sl_abf_step(solver, 1, NULL), SL_OK);
        const sl_abf_info *info = sl_abf_info_of(solver);
        if (info->step < 1.0) {
            free(dense);
            break;
        }
        const double *after = sl_abf_angles(solver);
        for (int32_t c = 0; c < nc; c++) {
            assert_true(test_near(after[c] - before[c], dense[c], 1e-7));
        }
        const sl_abf_view view = sl_abf_view_of(solver);
        for (int32_t t = 0; t < patch->nt; t++) {
            assert_true(test_near(view.lambda1[t], dense[nc + t], 1e-5 * (1.0 + fabs(dense[nc + t]))));
        }
        for (int32_t r = 0; r < total - nc - patch->nt; r++) {
            const double expected = dense[nc + patch->nt + r];
            assert_true(test_near(view.lambda2[r], expected, 1e-5 * (1.0 + fabs(expected))));
        }
        free(dense);
    }
    assert_true(sl_abf_info_of(solver)->iterations >= 1);
    sl_abf_free(solver);
    sl_sectors_clear(&table);
    free(before);
    sl_patch_free(patch);
}

static void newton_steps_match_a_dense_solve_of_the_full_system(void **state)
{
    (void)state;
    sl_abf_def def = sl_abf_default();
    check_steps(chart_grid(4, 4, 0.15, chart_bumps, 1.0, 11), &def, false);
    check_steps(chart_hexagon(2, 0.15, chart_cap, 1.3, 12), &def, false);
    def.energy = SL_ABF_UNWEIGHTED;
    check_steps(chart_hexagon(2, 0.15, chart_cap, 1.0, 13), &def, false);
    def.wheel = SL_ABF_PRODUCT;
    check_steps(chart_grid(4, 3, 0.15, chart_bumps, 1.0, 14), &def, false);
    def.wheel = SL_ABF_RATIO;
    check_steps(chart_grid(4, 3, 0.15, chart_bumps, 1.0, 15), &def, false);
}

static void newton_steps_with_split_and_border_sectors_match_a_dense_solve(void **state)
{
    (void)state;
    const sl_abf_def def = sl_abf_default();
    check_steps(chart_hexagon(2, 0.1, chart_cap, 0.8, 21), &def, true);
    check_steps(chart_grid(4, 4, 0.1, chart_bumps, 0.6, 22), &def, true);
}

/* Largest entry of 2 w (alpha - phi) + J' lambda with a Jacobian by differences, and of g. */
static void check_optimal(const sl_patch *patch, const sl_abf_def *def, const sl_sectors *sectors, const sl_abf *solver)
{
    const sl_abf_view view = sl_abf_view_of(solver);
    const double *alpha = sl_abf_angles(solver);
    int32_t ng;
    double *J = difference_jacobian(patch, def, sectors, alpha, &ng);
    double *g = malloc((size_t)ng * sizeof *g);
    constraints(patch, def, sectors, alpha, g);
    for (int32_t c = 0; c < 3 * patch->nt; c++) {
        double gradient = 2.0 * view.w[c] * (alpha[c] - view.phi[c]);
        for (int32_t r = 0; r < ng; r++) {
            const double lambda = r < patch->nt ? view.lambda1[r] : view.lambda2[r - patch->nt];
            gradient += lambda * J[(size_t)c * (size_t)ng + (size_t)r];
        }
        assert_true(test_near(gradient, view.gradient[c], 2e-7));
        assert_true(fabs(gradient) <= def->accept_gradient);
        assert_true(alpha[c] > 0.0 && alpha[c] < PI);
    }
    for (int32_t r = 0; r < ng; r++) {
        assert_true(fabs(g[r]) <= def->constraint_tolerance);
    }
    free(J);
    free(g);
}

static void converged_angles_satisfy_the_conditions_of_a_minimum(void **state)
{
    (void)state;
    for (uint64_t seed = 1; seed <= 6; seed++) {
        sl_patch *patches[] = {chart_grid(5, 4, 0.2, chart_bumps, 1.2, seed),
                               chart_hexagon(3, 0.15, chart_cap, PI / 2, seed),
                               chart_hexagon(2, 0.15, chart_cone, 1.5, seed)};
        for (size_t i = 0; i < SL_COUNTOF(patches); i++) {
            sl_sector_table table = make_sectors(patches[i], seed % 2 == 0 && i == 0);
            sl_abf_def def = sl_abf_default();
            def.energy = seed % 3 == 0 ? SL_ABF_UNWEIGHTED : SL_ABF_WEIGHTED;
            def.sectors = &table.view;
            sl_abf *solver = solve(patches[i], &def);
            assert_true(sl_abf_info_of(solver)->converged);
            assert_true(sl_abf_info_of(solver)->iterations >= 2);
            check_optimal(patches[i], &def, &table.view, solver);
            sl_abf_free(solver);
            sl_sectors_clear(&table);
            sl_patch_free(patches[i]);
        }
    }
}

/* With the gradient of E + lambda' g differenced as a scalar, away from the solution: energy, multipliers, all at once.
 */
static void gradient_of_the_lagrangian_matches_finite_differences(void **state)
{
    (void)state;
    for (int form = 0; form < 3; form++) {
        sl_patch *patch = chart_hexagon(2, 0.2, chart_cap, 1.4, 0x1a);
        sl_sector_table table = make_sectors(patch, true);
        sl_abf_def def = sl_abf_default();
        def.wheel = (sl_abf_wheel)form;
        def.sectors = &table.view;
        sl_abf *solver = make_solver(patch, &def);
        assert_int_equal(sl_abf_step(solver, 1, NULL), SL_OK);
        const sl_abf_view view = sl_abf_view_of(solver);
        const int32_t nc = 3 * patch->nt;
        double *x = malloc((size_t)nc * sizeof *x), *g = malloc(2 * (size_t)nc * sizeof *g), largest = 0.0;
        memcpy(x, sl_abf_angles(solver), (size_t)nc * sizeof *x);
        for (int32_t c = 0; c < nc; c++) {
            const double h = 1e-5, a = x[c];
            double value[2] = {0.0, 0.0};
            for (int side = 0; side < 2; side++) {
                x[c] = side == 0 ? a - h : a + h;
                const int32_t ng = constraints(patch, &def, &table.view, x, g);
                value[side] = view.w[c] * (x[c] - view.phi[c]) * (x[c] - view.phi[c]);
                for (int32_t r = 0; r < ng; r++) {
                    value[side] += g[r] * (r < patch->nt ? view.lambda1[r] : view.lambda2[r - patch->nt]);
                }
            }
            x[c] = a;
            assert_true(test_near(view.gradient[c], (value[1] - value[0]) / (2.0 * h), 1e-7));
            largest = fmax(largest, fabs(view.gradient[c]));
        }
        assert_true(largest > 1e-4);
        assert_true(test_near(sl_abf_info_of(solver)->gradient, largest, 0.0));
        sl_abf_free(solver);
        sl_sectors_clear(&table);
        free(x);
        free(g);
        sl_patch_free(patch);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(newton_steps_match_a_dense_solve_of_the_full_system),
        cmocka_unit_test(newton_steps_with_split_and_border_sectors_match_a_dense_solve),
        cmocka_unit_test(converged_angles_satisfy_the_conditions_of_a_minimum),
        cmocka_unit_test(gradient_of_the_lagrangian_matches_finite_differences),
        cmocka_unit_test(exact_newton_steps_match_a_dense_solve_with_the_hessian_by_differences),
        cmocka_unit_test(exact_newton_converges_quadratically_in_every_form),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
