#include "matrices.h"

#include "sparse/cholesky.h"

#include <cblas.h>
#include <lapacke.h>

static const sl_ordering orderings[] = {SL_ORDER_AUTO, SL_ORDER_NATURAL, SL_ORDER_CAMD, SL_ORDER_NESTED_DISSECTION};

static int one_blas_thread(void **state)
{
    (void)state;
    openblas_set_num_threads(1);
    return 0;
}

static sl_cholesky *factor_of(const sl_csc *A, const sl_cholesky_def *def)
{
    sl_cholesky *F = NULL;
    assert_int_equal(sl_cholesky_analyze(A, def, &F), SL_OK);
    assert_int_equal(sl_cholesky_factor(F, A, NULL), SL_OK);
    return F;
}

static void solve(const sl_cholesky *F, double *X, int32_t nrhs)
{
    double *work = sl_alloc(sl_cholesky_work_size(F, nrhs), sizeof *work);
    assert_non_null(work);
    sl_cholesky_solve(F, X, nrhs, work);
    sl_free(work);
}

/* max |A X - B| <= tol (||A|| ||X|| + ||B||), entrywise maxima. */
static void assert_solves(const sl_csc *A, const double *X, const double *B, int32_t nrhs, double tol)
{
    const int64_t size = (int64_t)A->ncols * nrhs;
    double *Y = sl_alloc(size, sizeof *Y);
    assert_non_null(Y);
    sl_csc_multiply_symmetric(A, X, nrhs, Y);
    const double scale = max_abs(A->val, A->colptr[A->ncols]) * max_abs(X, size) + max_abs(B, size);
    for (int64_t i = 0; i < size; i++) {
        assert_true(test_near(Y[i], B[i], tol * scale));
    }
    sl_free(Y);
}

/* Diagonally dominant by 0.3 at least: the inverse's norm is below 4. */
static void compare_with_dposv(const sl_csc *A, const sl_cholesky_def *def, int32_t nrhs, test_rng *rng)
{
    const int32_t n = A->ncols;
    double *D = dense_symmetric(A, NULL), *X = random_doubles((int64_t)n * nrhs, rng);
    double *B = sl_copy(X, (int64_t)n * nrhs, sizeof *B), *Y = sl_copy(X, (int64_t)n * nrhs, sizeof *Y);
    assert_true(B && Y);
    sl_cholesky *F = factor_of(A, def);
    assert_permutation(sl_cholesky_permutation(F), n);
    solve(F, X, nrhs);
    if (n > 0) {
        assert_int_equal(LAPACKE_dposv(LAPACK_COL_MAJOR, 'L', n, nrhs, D, n, Y, n), 0);
    }
    for (int64_t i = 0; i < (int64_t)n * nrhs; i++) {
        assert_true(test_near(X[i], Y[i], 1e-12));
    }
    assert_solves(A, X, B, nrhs, 200 * TEST_EPS);
    sl_cholesky_free(F);
    sl_free(D);
    sl_free(X);
    sl_free(B);
    sl_free(Y);
}

static void solutions_agree_with_lapack(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0xc401);
    const int32_t sizes[] = {0, 1, 2, 3, 17, 90, 400};
    for (int kind = 0; kind < MATRIX_KINDS; kind++) {
        for (size_t z = 0; z < SL_COUNTOF(sizes); z++) {
            for (size_t o = 0; o < SL_COUNTOF(orderings); o++) {
                sl_csc *A = random_spd((matrix_kind)kind, sizes[z], 0.3, &rng);
                double *xyz = random_doubles(3 * (int64_t)A->ncols, &rng);
                sl_cholesky_def def = sl_cholesky_default();
                def.ordering = orderings[o];
                def.xyz = test_index(&rng, 2) == 0 ? xyz : NULL;
                compare_with_dposv(A, &def, test_index(&rng, 20), &rng);
                sl_free(xyz);
                sl_csc_free(A);
            }
        }
    }
}

static void default_definition_may_be_null(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0xdef);
    sl_csc *A = random_spd(MATRIX_RANDOM, 60, 0.3, &rng);
    compare_with_dposv(A, NULL, 2, &rng);
    sl_csc_free(A);
}

/* Panels wide enough for every BLAS path. */
static void residuals_of_a_large_grid_are_at_rounding(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0x1a49e);
    sl_csc *A = random_spd(MATRIX_GRID, 110 * 110, 1e-3, &rng);
    const int32_t n = A->ncols, nrhs = 11;
    double *B = random_doubles((int64_t)n * nrhs, &rng), *X = sl_copy(B, (int64_t)n * nrhs, sizeof *X);
    assert_non_null(X);
    sl_cholesky_def def = sl_cholesky_default();
    def.ordering = SL_ORDER_NESTED_DISSECTION;
    sl_cholesky *F = factor_of(A, &def);
    solve(F, X, nrhs);
    assert_solves(A, X, B, nrhs, 100 * TEST_EPS);
    memcpy(X, B, (size_t)n * sizeof *X);
    solve(F, X, 1);
    assert_solves(A, X, B, 1, 100 * TEST_EPS);
    sl_cholesky_free(F);
    sl_free(B);
    sl_free(X);
    sl_csc_free(A);
}

/* Neither the path (2 n entries in L) nor the tree may be padded into one wide panel. */
static void padding_of_chains_stays_small(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0x9ad);
    for (int kind = MATRIX_PATH; kind <= MATRIX_TREE; kind++) {
        sl_csc *A = random_spd((matrix_kind)kind, 2000, 0.3, &rng);
        sl_cholesky *F = factor_of(A, NULL);
        assert_true(sl_cholesky_nnz(F) >= 2 * 2000 - 1);
        assert_true(sl_cholesky_nnz(F) < 12 * 2000);
        sl_cholesky_free(F);
        sl_csc_free(A);
    }
}

static void an_inherited_permutation_is_used(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0x1e4e);
    sl_csc *A = random_spd(MATRIX_GRID, 40 * 40, 0.3, &rng);
    int32_t *perm = sl_alloc(A->ncols, sizeof *perm);
    assert_non_null(perm);
    sl_cholesky_def def = sl_cholesky_default();
    sl_cholesky *own = factor_of(A, &def);
    memcpy(perm, sl_cholesky_permutation(own), (size_t)A->ncols * sizeof *perm);
    def.ordering = SL_ORDER_NATURAL; /* would fill ten times as much */
    def.perm = perm;
    sl_cholesky *heir = factor_of(A, &def);
    assert_int_equal(sl_cholesky_nnz(heir), sl_cholesky_nnz(own));
    compare_with_dposv(A, &def, 3, &rng);
    sl_cholesky_free(own);
    sl_cholesky_free(heir);
    sl_free(perm);
    sl_csc_free(A);
}

static void refactoring_gives_the_bytes_of_a_fresh_factor(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0x4efac);
    for (int kind = 0; kind < MATRIX_KINDS; kind++) {
        sl_csc *A = random_spd((matrix_kind)kind, 150, 0.3, &rng);
        const int32_t n = A->ncols;
        sl_cholesky *F = factor_of(A, NULL);
        for (int32_t j = 0; j < n; j++) {
            for (int64_t p = A->colptr[j]; p < A->colptr[j + 1]; p++) {
                A->val[p] *= A->row[p] == j ? test_uniform(&rng, 1.0, 3.0) : test_uniform(&rng, 0.1, 1.0);
            }
        }
        assert_int_equal(sl_cholesky_factor(F, A, NULL), SL_OK);
        sl_cholesky *fresh = factor_of(A, NULL);
        double *X = random_doubles(2 * (int64_t)n, &rng), *Y = sl_copy(X, 2 * (int64_t)n, sizeof *Y);
        assert_non_null(Y);
        solve(F, X, 2);
        solve(fresh, Y, 2);
        assert_memory_equal(X, Y, 2 * (size_t)n * sizeof *X);
        sl_free(X);
        sl_free(Y);
        sl_cholesky_free(F);
        sl_cholesky_free(fresh);
        sl_csc_free(A);
    }
}

/* First bad pivot of the permuted matrix by LAPACK, as a column of A; -1 when there is none. */
static int32_t bad_column_by_dpotrf(const sl_csc *A, const int32_t *perm)
{
    double *D = dense_symmetric(A, perm);
    const int info = LAPACKE_dpotrf(LAPACK_COL_MAJOR, 'L', A->ncols, D, A->ncols);
    sl_free(D);
    return info > 0 ? perm[info - 1] : -1;
}

static void a_bad_pivot_names_the_column_of_the_matrix(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0xbad);
    for (int trial = 0; trial < 4 * MATRIX_KINDS * test_multiplier(); trial++) {
        sl_csc *A = random_spd((matrix_kind)(trial % MATRIX_KINDS), 20 + test_index(&rng, 200), 0.3, &rng);
        sl_cholesky *F = factor_of(A, NULL);
        const int32_t culprit = test_index(&rng, A->ncols);
        const double good = A->val[A->colptr[culprit]];
        int32_t bad = -7;
        A->val[A->colptr[culprit]] = -0.5 * good;
        assert_int_equal(sl_cholesky_factor(F, A, &bad), SL_NOT_POSITIVE_DEFINITE);
        assert_int_equal(bad, bad_column_by_dpotrf(A, sl_cholesky_permutation(F)));
        assert_int_equal(sl_cholesky_factor(F, A, NULL), SL_NOT_POSITIVE_DEFINITE);
        A->val[A->colptr[culprit]] = good; /* the factor is as good as new */
        assert_int_equal(sl_cholesky_factor(F, A, &bad), SL_OK);
        double *B = random_doubles(A->ncols, &rng), *X = sl_copy(B, A->ncols, sizeof *X);
        assert_non_null(X);
        solve(F, X, 1);
        assert_solves(A, X, B, 1, 200 * TEST_EPS);
        sl_free(B);
        sl_free(X);
        sl_cholesky_free(F);
        sl_csc_free(A);
    }
}

static void pivots_at_or_below_the_relative_bound_are_rejected(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0x71f);
    sl_csc *A = random_spd(MATRIX_DIAGONAL, 30, 1.0, &rng);
    sl_cholesky_def def = sl_cholesky_default();
    int32_t bad = -1;
    A->val[11] = 1e-9 * max_abs(A->val, 30);
    def.pivot_rtol = 0.99e-9;
    sl_cholesky *F = NULL;
    assert_int_equal(sl_cholesky_analyze(A, &def, &F), SL_OK);
    assert_int_equal(sl_cholesky_factor(F, A, &bad), SL_OK);
    sl_cholesky_free(F);
    def.pivot_rtol = 1.01e-9;
    assert_int_equal(sl_cholesky_analyze(A, &def, &F), SL_OK);
    assert_int_equal(sl_cholesky_factor(F, A, &bad), SL_NOT_POSITIVE_DEFINITE);
    assert_int_equal(bad, 11);
    sl_cholesky_free(F);
    sl_csc_free(A);
}

static void values_not_finite_or_of_another_pattern_are_bad_input(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0x1f);
    sl_csc *A = random_spd(MATRIX_GRID, 100, 0.3, &rng);
    sl_cholesky *F = factor_of(A, NULL);
    const int64_t last = A->colptr[A->ncols] - 1;
    const double bad[] = {NAN, INFINITY, -INFINITY};
    for (int64_t p = 0; p <= last; p++) { /* each lane of the vectors they are looked at in, and the rest */
        const double good = A->val[p];
        for (size_t k = 0; k < SL_COUNTOF(bad); k++) {
            A->val[p] = bad[k];
            assert_int_equal(sl_cholesky_factor(F, A, NULL), SL_BAD_INPUT);
        }
        A->val[p] = good;
    }
    for (int32_t j = 0; j < A->ncols; j++) { /* a row moved up or down where there is room */
        for (int64_t p = A->colptr[j] + 1; p < A->colptr[j + 1]; p++) {
            const int32_t row = A->row[p];
            A->row[p] = row > A->row[p - 1] + 1 ? row - 1 : row + 1;
            assert_int_equal(sl_cholesky_factor(F, A, NULL), SL_BAD_INPUT);
            A->row[p] = row;
        }
    }
    const double first = A->val[0];
    A->val[0] = 1.5e308; /* finite, but not less sigma */
    assert_int_equal(sl_cholesky_factor_shifted(F, A, -1.5e308, NULL, NULL), SL_BAD_INPUT);
    A->val[0] = first;
    sl_csc *other = random_spd(MATRIX_GRID, 100, 0.3, &rng); /* another shuffle: as many entries elsewhere */
    assert_int_equal(other->colptr[100], A->colptr[100]);
    assert_int_equal(sl_cholesky_factor(F, other, NULL), SL_BAD_INPUT);
    assert_int_equal(sl_cholesky_factor(F, A, NULL), SL_OK);
    sl_cholesky_free(F);
    sl_csc_free(A);
    sl_csc_free(other);
}

/* Matrices of one entry d, shifted by sigma, and the status that each deserves. */
static void the_smallest_matrices_have_the_statuses_of_large_ones(void **state)
{
    (void)state;
    static const struct {
        double d, sigma;
        sl_factor_kind kind;
        sl_status status;
    } one[] = {{2.75, 0.0, SL_FACTOR_LLT, SL_OK},
               {2.75, 3.25, SL_FACTOR_LLT, SL_NOT_POSITIVE_DEFINITE},
               {-2.75, 0.0, SL_FACTOR_LLT, SL_NOT_POSITIVE_DEFINITE},
               {0.0, 0.0, SL_FACTOR_LLT, SL_NOT_POSITIVE_DEFINITE},
               {-2.75, 0.5, SL_FACTOR_LDLT, SL_OK},
               {2.75, 2.75, SL_FACTOR_LDLT, SL_SINGULAR},
               {NAN, 0.0, SL_FACTOR_LLT, SL_BAD_INPUT},
               {INFINITY, 0.0, SL_FACTOR_LDLT, SL_BAD_INPUT},
               {2.75, NAN, SL_FACTOR_LDLT, SL_BAD_INPUT},
               {2.75, -INFINITY, SL_FACTOR_LLT, SL_BAD_INPUT}};
    for (size_t k = 0; k < SL_COUNTOF(one); k++) {
        int64_t colptr[] = {0, 1};
        int32_t row[] = {0}, bad = -1;
        double val[] = {one[k].d}, X[] = {0.375, -1.5, 9.25}; /* three sides */
        const sl_csc A = {1, 1, colptr, row, val};
        sl_cholesky_def def = sl_cholesky_default();
        sl_cholesky *F = NULL;
        def.kind = one[k].kind;
        assert_int_equal(sl_cholesky_analyze(&A, &def, &F), SL_OK);
        assert_int_equal(sl_cholesky_nnz(F), 1);
        assert_int_equal(sl_cholesky_factor_shifted(F, &A, one[k].sigma, NULL, &bad), one[k].status);
        const bool pivot = one[k].status == SL_NOT_POSITIVE_DEFINITE || one[k].status == SL_SINGULAR;
        assert_int_equal(bad, pivot ? 0 : -1);
        if (one[k].status == SL_OK) {
            solve(F, X, 3);
            assert_true(test_near(X[2], 9.25 / (one[k].d - one[k].sigma), 8 * TEST_EPS));
        }
        sl_cholesky_free(F);
    }
    int64_t colptr[] = {0};
    double nothing[] = {0.5};
    const sl_csc empty = {0, 0, colptr, NULL, NULL};
    sl_cholesky *F = NULL;
    int64_t kept = -1;
    assert_int_equal(sl_cholesky_analyze(&empty, NULL, &F), SL_OK);
    assert_int_equal(sl_cholesky_nnz(F), 0);
    assert_true(sl_cholesky_factor_bytes(F, &kept) >= 0 && kept == 0);
    assert_int_equal(sl_cholesky_factor(F, &empty, NULL), SL_OK);
    solve(F, nothing, 5);
    assert_true(test_near(nothing[0], 0.5, 0.0));
    sl_cholesky_free(F);
}

static void bad_patterns_and_permutations_are_bad_input(void **state)
{
    (void)state;
    int64_t colptr[] = {0, 2, 3, 4};
    int32_t row[] = {0, 2, 1, 2};
    double val[] = {2.5, -0.7, 1.5, 3.1}, X[3] = {0.1, 0.9, 0.4};
    sl_csc A = {3, 3, colptr, row, val};
    const int32_t twice[] = {0, 1, 1}, beyond[] = {0, 3, 1}, negative[] = {0, -1, 1};
    const int32_t *perms[] = {twice, beyond, negative};
    sl_cholesky_def def = sl_cholesky_default();
    for (size_t k = 0; k < SL_COUNTOF(perms); k++) {
        sl_cholesky *F = (sl_cholesky *)&def;
        def.perm = perms[k];
        assert_int_equal(sl_cholesky_analyze(&A, &def, &F), SL_BAD_INPUT);
        assert_null(F);
    }
    sl_cholesky *F = (sl_cholesky *)&def;
    row[1] = 0; /* unsorted */
    assert_int_equal(sl_cholesky_analyze(&A, NULL, &F), SL_BAD_INPUT);
    assert_null(F);
    row[1] = 2;
    row[2] = 0; /* above the diagonal */
    assert_int_equal(sl_cholesky_analyze(&A, NULL, &F), SL_BAD_INPUT);
    row[2] = 1;
    A.nrows = 4;
    assert_int_equal(sl_cholesky_solve_once(&A, NULL, X, 1), SL_BAD_INPUT);
    A.nrows = 3;
    val[2] = -1.5;
    assert_int_equal(sl_cholesky_solve_once(&A, NULL, X, 1), SL_NOT_POSITIVE_DEFINITE);
    val[2] = 1.5;
    assert_int_equal(sl_cholesky_solve_once(&A, NULL, X, 1), SL_OK);
    const double det = 2.5 * 3.1 - 0.7 * 0.7; /* rows 0 and 2 by Cramer's rule */
    assert_true(test_near(X[0], (0.1 * 3.1 + 0.7 * 0.4) / det, 8 * TEST_EPS));
    assert_true(test_near(X[1], 0.9 / 1.5, 8 * TEST_EPS));
    assert_true(test_near(X[2], (0.1 * 0.7 + 2.5 * 0.4) / det, 8 * TEST_EPS));
    sl_cholesky_free(NULL);
}

typedef struct shared_solve {
    const sl_cholesky *F;
    double *X, *work;
    int64_t n, work_size;
} shared_solve;

static void solve_one(void *user, int64_t begin, int64_t end, int32_t chunk)
{
    const shared_solve *job = user;
    sl_cholesky_solve(job->F, job->X + begin * job->n, (int32_t)(end - begin), job->work + chunk * job->work_size);
}

static void two_threads_solve_with_one_factor(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0x7472);
    enum { CHUNKS = 6, SIDES = 5 };
    sl_csc *A = random_spd(MATRIX_GRID, 50 * 50, 0.3, &rng);
    sl_cholesky *F = factor_of(A, NULL);
    const int64_t n = A->ncols, size = n * CHUNKS * SIDES;
    double *X = random_doubles(size, &rng), *Y = sl_copy(X, size, sizeof *Y);
    shared_solve job = {F, X, NULL, n, sl_cholesky_work_size(F, SIDES)};
    job.work = sl_alloc(CHUNKS * job.work_size, sizeof *job.work);
    assert_true(Y != NULL && job.work != NULL);
    sl_thread_pool *pool = NULL;
    assert_int_equal(sl_thread_pool_create(2, &pool), SL_OK);
    const sl_context context = {.executor = sl_thread_pool_executor(pool)};
    sl_parallel_for(&context, CHUNKS * SIDES, SIDES, solve_one, &job);
    job.X = Y;
    sl_parallel_for(NULL, CHUNKS * SIDES, SIDES, solve_one, &job);
    assert_memory_equal(X, Y, (size_t)size * sizeof *X);
    sl_thread_pool_free(pool);
    sl_free(job.work);
    sl_free(X);
    sl_free(Y);
    sl_cholesky_free(F);
    sl_csc_free(A);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(solutions_agree_with_lapack),
        cmocka_unit_test(default_definition_may_be_null),
        cmocka_unit_test(residuals_of_a_large_grid_are_at_rounding),
        cmocka_unit_test(padding_of_chains_stays_small),
        cmocka_unit_test(an_inherited_permutation_is_used),
        cmocka_unit_test(refactoring_gives_the_bytes_of_a_fresh_factor),
        cmocka_unit_test(a_bad_pivot_names_the_column_of_the_matrix),
        cmocka_unit_test(pivots_at_or_below_the_relative_bound_are_rejected),
        cmocka_unit_test(values_not_finite_or_of_another_pattern_are_bad_input),
        cmocka_unit_test(the_smallest_matrices_have_the_statuses_of_large_ones),
        cmocka_unit_test(bad_patterns_and_permutations_are_bad_input),
        cmocka_unit_test(two_threads_solve_with_one_factor),
    };
    return cmocka_run_group_tests(tests, one_blas_thread, NULL);
}
