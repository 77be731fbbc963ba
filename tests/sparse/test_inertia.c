#include "matrices.h"

#include "sparse/cholesky.h"

#include <cblas.h>
#include <lapacke.h>

static int one_blas_thread(void **state)
{
    (void)state;
    openblas_set_num_threads(1);
    return 0;
}

static double *eigenvalues_of(const sl_csc *A)
{
    const int32_t n = A->ncols;
    double *D = dense_symmetric(A, NULL), *lambda = sl_alloc(n, sizeof *lambda);
    int found = 0, *support = sl_alloc(2 * (int64_t)n, sizeof *support);
    assert_true(lambda != NULL && support != NULL);
    assert_int_equal(
        LAPACKE_dsyevr(LAPACK_COL_MAJOR, 'N', 'A', 'L', n, D, n, 0, 0, 0, 0, 0.0, &found, lambda, NULL, 1, support), 0);
    assert_int_equal(found, n);
    sl_free(D);
    sl_free(support);
    return lambda;
}

static double distance(const double *lambda, int32_t n, double sigma, int32_t *below)
{
    double nearest = INFINITY;
    *below = 0;
    for (int32_t k = 0; k < n; k++) {
        nearest = fmin(nearest, fabs(lambda[k] - sigma));
        *below += lambda[k] < sigma;
    }
    return nearest;
}

static void counts_agree_with_dsyevr_wherever_the_bound_vouches_for_them(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0x1e47);
    int32_t vouched = 0, asked = 0;
    for (int trial = 0; trial < 4 * MATRIX_KINDS * test_multiplier(); trial++) {
        sl_csc *A = random_spd((matrix_kind)(trial % MATRIX_KINDS), 1 + test_index(&rng, 220), 0.3, &rng);
        const int32_t n = A->ncols;
        double *lambda = eigenvalues_of(A);
        sl_cholesky *F = NULL;
        assert_int_equal(sl_cholesky_analyze(A, NULL, &F), SL_OK);
        for (int k = 0; k < 10; k++) {
            const double near = lambda[test_index(&rng, n)];
            const double sigma = k < 5 ? test_uniform(&rng, lambda[0] - 0.1, lambda[n - 1] + 0.1)
                                       : near + test_uniform(&rng, -1.0, 1.0) * pow(10.0, -2.0 * k + 4.0);
            int32_t below;
            const double apart = distance(lambda, n, sigma, &below);
            sl_inertia_info info;
            assert_int_equal(sl_inertia(F, A, sigma, NULL, &info), SL_OK);
            assert_int_equal(info.negative + info.zero + info.positive, n);
            asked++;
            if (info.backward_error + 1e-13 * lambda[n - 1] < apart) {
                assert_int_equal(info.negative, below);
                assert_int_equal(info.zero, 0);
                vouched++;
            }
        }
        sl_free(lambda);
        sl_cholesky_free(F);
        sl_csc_free(A);
    }
    assert_true(vouched > asked * 3 / 4);
}

static void a_shift_among_a_thousand_unknowns_counts_the_ones_below(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0x1000);
    sl_csc *A = random_spd(MATRIX_GRID, 32 * 32, 0.01, &rng);
    double *lambda = eigenvalues_of(A);
    sl_cholesky *F = NULL;
    assert_int_equal(sl_cholesky_analyze(A, NULL, &F), SL_OK);
    for (int32_t k = 0; k < 1000; k += 37) {
        const double sigma = 0.5 * (lambda[k] + lambda[k + 1]);
        sl_inertia_info info;
        assert_int_equal(sl_inertia(F, A, sigma, NULL, &info), SL_OK);
        if (info.backward_error < 0.4 * (lambda[k + 1] - lambda[k])) {
            assert_int_equal(info.negative, k + 1);
        } else {
            assert_true(k > 100); /* deep inside the spectrum pivots may grow; not at its lower end */
        }
    }
    sl_free(lambda);
    sl_cholesky_free(F);
    sl_csc_free(A);
}

/* ||A - sigma I + E||: A is 2 x 2, its L and D known in closed form. */
static void growth_and_bounds_are_those_of_a_known_factor(void **state)
{
    (void)state;
    int64_t colptr[] = {0, 2, 3};
    int32_t row[] = {0, 1, 1};
    double val[] = {0.51, 2.3, 0.7};
    const sl_csc A = {2, 2, colptr, row, val};
    sl_cholesky_def def = sl_cholesky_default();
    sl_cholesky *F = NULL;
    sl_inertia_info info;
    def.ordering = SL_ORDER_NATURAL;
    assert_int_equal(sl_cholesky_analyze(&A, &def, &F), SL_OK);
    assert_int_equal(sl_inertia(F, &A, 0.5, NULL, &info), SL_OK);
    const double d1 = 0.51 - 0.5, l = 2.3 / d1, d2 = 0.2 - l * 2.3;
    assert_int_equal(info.negative, 1);
    assert_int_equal(info.positive, 1);
    assert_true(test_near_rel(info.max_l, l, 1e-12));
    assert_true(test_near_rel(info.max_d, -d2, 1e-12));
    assert_true(test_near_rel(info.max_a, 2.3, 1e-12));
    assert_true(test_near_rel(info.growth, -d2 / 2.3, 1e-12));
    const double row_sum = 2.3 + l * 2.3 - d2; /* second row of |L| |D| |L'| */
    assert_true(info.backward_error > 2.0 * TEST_EPS / 2.0 * row_sum);
    assert_true(info.backward_error < 10.0 * TEST_EPS * row_sum);
    sl_cholesky_free(F);
}

static void a_zero_pivot_is_told_and_vouches_for_nothing(void **state)
{
    (void)state;
    int64_t colptr[] = {0, 2, 3};
    int32_t row[] = {0, 1, 1}, bad = -1;
    double val[] = {0.75, 2.3, 0.7};
    const sl_csc A = {2, 2, colptr, row, val};
    sl_cholesky_def def = sl_cholesky_default();
    sl_cholesky *F = NULL;
    sl_inertia_info info;
    def.ordering = SL_ORDER_NATURAL;
    def.kind = SL_FACTOR_LDLT;
    assert_int_equal(sl_cholesky_analyze(&A, &def, &F), SL_OK);
    assert_int_equal(sl_inertia(F, &A, 0.75, NULL, &info), SL_OK);
    assert_int_equal(info.zero, 1);
    assert_true(info.backward_error > 1.0);
    assert_int_equal(sl_cholesky_factor_shifted(F, &A, 0.75, NULL, &bad), SL_SINGULAR);
    assert_int_equal(bad, 0);
    sl_cholesky_free(F);
}

static void empty_matrices_have_no_pivots(void **state)
{
    (void)state;
    int64_t colptr[] = {0};
    const sl_csc A = {0, 0, colptr, NULL, NULL};
    sl_cholesky *F = NULL;
    sl_inertia_info info;
    assert_int_equal(sl_cholesky_analyze(&A, NULL, &F), SL_OK);
    assert_int_equal(sl_inertia(F, &A, 0.3, NULL, &info), SL_OK);
    assert_int_equal(info.negative + info.zero + info.positive, 0);
    sl_cholesky_free(F);
}

static void values_and_shifts_not_finite_are_bad_input(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0xf1);
    sl_csc *A = random_spd(MATRIX_TREE, 90, 0.3, &rng), *other = random_spd(MATRIX_TREE, 90, 0.3, &rng);
    sl_cholesky *F = NULL;
    sl_inertia_info info;
    assert_int_equal(sl_cholesky_analyze(A, NULL, &F), SL_OK);
    assert_int_equal(sl_inertia(F, A, NAN, NULL, &info), SL_BAD_INPUT);
    assert_int_equal(sl_cholesky_factor_shifted(F, A, INFINITY, NULL, NULL), SL_BAD_INPUT);
    assert_int_equal(sl_inertia(F, other, 0.1, NULL, &info), SL_BAD_INPUT);
    A->val[A->colptr[90] / 3] = NAN;
    assert_int_equal(sl_inertia(F, A, 0.1, NULL, &info), SL_BAD_INPUT);
    sl_cholesky_free(F);
    sl_csc_free(A);
    sl_csc_free(other);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(counts_agree_with_dsyevr_wherever_the_bound_vouches_for_them),
        cmocka_unit_test(a_shift_among_a_thousand_unknowns_counts_the_ones_below),
        cmocka_unit_test(growth_and_bounds_are_those_of_a_known_factor),
        cmocka_unit_test(a_zero_pivot_is_told_and_vouches_for_nothing),
        cmocka_unit_test(empty_matrices_have_no_pivots),
        cmocka_unit_test(values_and_shifts_not_finite_are_bad_input),
    };
    return cmocka_run_group_tests(tests, one_blas_thread, NULL);
}
