#include "matrices.h"

#include "sparse/cholesky.h"

#include <cblas.h>
#include <lapacke.h>

enum { LARGEST = 32 };

static int one_blas_thread(void **state)
{
    (void)state;
    openblas_set_num_threads(1);
    return 0;
}

static sl_cholesky *analysis_of(const sl_csc *A, sl_factor_kind kind, int32_t patch)
{
    sl_cholesky_def def = sl_cholesky_default();
    def.kind = kind;
    def.patch = patch;
    def.ordering = SL_ORDER_NESTED_DISSECTION;
    sl_cholesky *F = NULL;
    assert_int_equal(sl_cholesky_analyze(A, &def, &F), SL_OK);
    assert_permutation(sl_cholesky_permutation(F), A->ncols);
    return F;
}

static double *block_work(const sl_cholesky *F, int32_t w)
{
    double *work = sl_alloc(sl_cholesky_block_work_size(F, w), sizeof *work);
    assert_non_null(work);
    return work;
}

/* A with its diagonal lowered: indefinite, but with no small leading minors (a shift at random). */
static sl_csc *random_matrix(int32_t trial, test_rng *rng)
{
    return random_spd((matrix_kind)(trial % MATRIX_KINDS), 1 + test_index(rng, 260), 0.3, rng);
}

static void assert_close(const double *x, const double *y, int64_t count, double tol)
{
    const double scale = 1.0 + max_abs(y, count);
    for (int64_t i = 0; i < count; i++) {
        assert_true(test_near(x[i], y[i], tol * scale));
    }
}

/* B := inv(M) B by LAPACK, M dense symmetric n x n (overwritten), B row by row (n x w). */
static void solve_dense(double *M, int32_t n, double *B, int32_t w)
{
    int32_t *pivot = sl_alloc(n, sizeof *pivot);
    assert_non_null(pivot);
    if (n > 0) {
        assert_int_equal(LAPACKE_dgesv(LAPACK_ROW_MAJOR, n, w, M, n, pivot, B, w), 0);
    }
    sl_free(pivot);
}

static void permuting_in_and_out_gives_back_the_block(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0x1e40);
    sl_csc *A = random_spd(MATRIX_GRID, 300, 0.3, &rng);
    sl_cholesky *F = analysis_of(A, SL_FACTOR_LLT, 20);
    const int32_t n = A->ncols, *perm = sl_cholesky_permutation(F);
    for (int32_t w = 1; w <= LARGEST; w++) {
        double *X = random_doubles((int64_t)n * w, &rng), *Y = random_doubles((int64_t)n * w, &rng);
        double *back = random_doubles((int64_t)n * w, &rng);
        sl_cholesky_permute_in(F, X, w, Y);
        for (int32_t k = 0; k < n; k++) {
            for (int32_t c = 0; c < w; c++) {
                assert_true(Y[k * w + c] == X[c * n + perm[k]]);
            }
        }
        sl_cholesky_permute_out(F, Y, w, back);
        assert_memory_equal(back, X, (size_t)n * (size_t)w * sizeof *X);
        sl_free(X);
        sl_free(Y);
        sl_free(back);
    }
    sl_cholesky_free(F);
    sl_csc_free(A);
}

static void shifted_blocks_are_solved_as_lapack_solves_them(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0xb10c);
    for (int trial = 0; trial < 8 * MATRIX_KINDS * test_multiplier(); trial++) {
        sl_csc *A = random_matrix(trial, &rng);
        const int32_t n = A->ncols, w = 1 + test_index(&rng, LARGEST);
        const double sigma = test_uniform(&rng, -3.0, 0.25);
        sl_cholesky *F = analysis_of(A, trial % 2 == 0 ? SL_FACTOR_LLT : SL_FACTOR_LDLT, test_index(&rng, 60));
        double *D = dense_symmetric(A, sl_cholesky_permutation(F)), *work = block_work(F, w);
        double *X = random_doubles((int64_t)n * w, &rng), *Y = sl_copy(X, (int64_t)n * w, sizeof *Y);
        assert_non_null(Y);
        for (int32_t i = 0; i < n; i++) {
            D[(int64_t)i * n + i] -= sigma;
        }
        assert_int_equal(sl_cholesky_factor_shifted(F, A, sigma, NULL, NULL), SL_OK);
        sl_cholesky_forward_part(F, SL_PART_ALL, X, w, work, NULL);
        sl_cholesky_backward_part(F, SL_PART_ALL, X, w, work, NULL);
        solve_dense(D, n, Y, w);
        assert_close(X, Y, (int64_t)n * w, 1e-11);
        sl_free(D);
        sl_free(work);
        sl_free(X);
        sl_free(Y);
        sl_cholesky_free(F);
        sl_csc_free(A);
    }
}

/* The top of forward's bottom part is X_t - A_tb inv(A_bb) X_b; backward's bottom part from X_b = 0 extends X_t by
 * -inv(A_bb) A_bt X_t. */
static void check_split(const sl_cholesky *F, const double *D, int32_t n, int32_t w, test_rng *rng)
{
    const int32_t nb = sl_cholesky_top_first(F), nt = n - nb;
    double *X = random_doubles((int64_t)n * w, rng), *work = block_work(F, w);
    double *Z = sl_copy(X, (int64_t)n * w, sizeof *Z), *M = sl_alloc((int64_t)nb * nb, sizeof *M);
    assert_true(Z != NULL && M != NULL);
    for (int32_t j = 0; j < nb; j++) {
        memcpy(M + (int64_t)j * nb, D + (int64_t)j * n, (size_t)nb * sizeof *M);
    }
    solve_dense(M, nb, Z, w); /* the bottom rows of Z */
    for (int32_t t = nb; t < n; t++) {
        for (int32_t c = 0; c < w; c++) {
            for (int32_t b = 0; b < nb; b++) {
                Z[(int64_t)t * w + c] -= D[(int64_t)t * n + b] * Z[(int64_t)b * w + c];
            }
        }
    }
    sl_cholesky_forward_part(F, SL_PART_BOTTOM, X, w, work, NULL);
    assert_close(X + (int64_t)nb * w, Z + (int64_t)nb * w, (int64_t)nt * w, 1e-11);
    for (int32_t b = 0; b < nb; b++) {
        for (int32_t c = 0; c < w; c++) {
            X[(int64_t)b * w + c] = Z[(int64_t)b * w + c] = 0.0;
            for (int32_t t = nb; t < n; t++) {
                Z[(int64_t)b * w + c] -= D[(int64_t)t * n + b] * Z[(int64_t)t * w + c];
            }
        }
    }
    for (int32_t j = 0; j < nb; j++) {
        memcpy(M + (int64_t)j * nb, D + (int64_t)j * n, (size_t)nb * sizeof *M);
    }
    solve_dense(M, nb, Z, w);
    sl_cholesky_backward_part(F, SL_PART_BOTTOM, X, w, work, NULL);
    assert_close(X, Z, (int64_t)n * w, 1e-11);
    sl_free(X);
    sl_free(Z);
    sl_free(M);
    sl_free(work);
}

/* Both parts, the top one by itself on its own rows, are the whole. */
static void check_parts_make_the_whole(const sl_cholesky *F, int32_t n, int32_t w, test_rng *rng)
{
    const int32_t nb = sl_cholesky_top_first(F);
    double *X = random_doubles((int64_t)n * w, rng), *Y = sl_copy(X, (int64_t)n * w, sizeof *Y);
    double *work = block_work(F, w), *top = sl_alloc((int64_t)(n - nb) * w, sizeof *top);
    assert_true(Y != NULL && top != NULL);
    const size_t top_bytes = (size_t)(n - nb) * (size_t)w * sizeof *top;
    sl_cholesky_forward_part(F, SL_PART_BOTTOM, X, w, work, NULL);
    memcpy(top, X + (int64_t)nb * w, top_bytes);
    sl_cholesky_forward_part(F, SL_PART_TOP, top, w, work, NULL);
    memcpy(X + (int64_t)nb * w, top, top_bytes);
    sl_cholesky_forward_part(F, SL_PART_ALL, Y, w, work, NULL);
    assert_close(X, Y, (int64_t)n * w, 1e-12);
    sl_cholesky_backward_part(F, SL_PART_TOP, top, w, work, NULL);
    memcpy(X + (int64_t)nb * w, top, top_bytes);
    sl_cholesky_backward_part(F, SL_PART_BOTTOM, X, w, work, NULL);
    sl_cholesky_backward_part(F, SL_PART_ALL, Y, w, work, NULL);
    assert_close(X, Y, (int64_t)n * w, 1e-12);
    sl_free(X);
    sl_free(Y);
    sl_free(top);
    sl_free(work);
}

static void bottom_and_top_are_a_block_elimination(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0x70b);
    int32_t split = 0;
    for (int trial = 0; trial < 6 * MATRIX_KINDS * test_multiplier(); trial++) {
        sl_csc *A = random_matrix(trial, &rng);
        const int32_t n = A->ncols, w = 1 + test_index(&rng, LARGEST);
        const double sigma = test_uniform(&rng, -1.0, 0.25);
        sl_cholesky *F = analysis_of(A, trial / MATRIX_KINDS % 2 == 0 ? SL_FACTOR_LLT : SL_FACTOR_LDLT, 25);
        assert_int_equal(sl_cholesky_factor_shifted(F, A, sigma, NULL, NULL), SL_OK);
        double *D = dense_symmetric(A, sl_cholesky_permutation(F));
        for (int32_t i = 0; i < n; i++) {
            D[(int64_t)i * n + i] -= sigma;
        }
        split += sl_cholesky_top_first(F) > 0 && sl_cholesky_top_first(F) < n;
        check_split(F, D, n, w, &rng);
        check_parts_make_the_whole(F, n, w, &rng);
        sl_free(D);
        sl_cholesky_free(F);
        sl_csc_free(A);
    }
    assert_true(split >= MATRIX_KINDS);
}

/* Bottom columns fall into parts of at most `patch` that no entry of A joins. */
static void bottom_parts_are_small_and_apart(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0x9a7c);
    const int32_t patches[] = {0, 1, 10, 60, 100000};
    for (int trial = 0; trial < (int)SL_COUNTOF(patches); trial++) {
        sl_csc *A = random_spd(MATRIX_GRID, 40 * 40, 0.3, &rng);
        sl_cholesky *F = analysis_of(A, SL_FACTOR_LLT, patches[trial]);
        const int32_t n = A->ncols, nb = sl_cholesky_top_first(F);
        int32_t *place = sl_alloc(n, sizeof *place), *root = sl_alloc(n, sizeof *root);
        int32_t *size = sl_calloc(n, sizeof *size);
        assert_true(place != NULL && root != NULL && size != NULL);
        for (int32_t k = 0; k < n; k++) {
            place[sl_cholesky_permutation(F)[k]] = root[k] = k;
        }
        for (int32_t sweep = 0; sweep < n; sweep++) { /* smallest label of each part */
            bool changed = false;
            for (int32_t j = 0; j < n; j++) {
                for (int64_t p = A->colptr[j]; p < A->colptr[j + 1]; p++) {
                    const int32_t a = place[j], b = place[A->row[p]];
                    if (a < nb && b < nb && root[a] != root[b]) {
                        root[a] = root[b] = root[a] < root[b] ? root[a] : root[b];
                        changed = true;
                    }
                }
            }
            if (!changed) {
                break;
            }
        }
        for (int32_t k = 0; k < nb; k++) {
            assert_true(++size[root[k]] <= patches[trial]);
        }
        assert_true(patches[trial] == 0 ? nb == 0 : patches[trial] < 60 || nb > n / 3);
        sl_free(place);
        sl_free(root);
        sl_free(size);
        sl_cholesky_free(F);
        sl_csc_free(A);
    }
}

static void indefinite_systems_are_solved_by_signed_factors(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0x1d1);
    for (int trial = 0; trial < 4 * MATRIX_KINDS * test_multiplier(); trial++) {
        sl_csc *A = random_matrix(trial, &rng);
        const int32_t n = A->ncols, w = 1 + test_index(&rng, 9);
        const double sigma = test_uniform(&rng, 0.5, 6.0);
        sl_cholesky *F = analysis_of(A, SL_FACTOR_LDLT, 30);
        sl_inertia_info info;
        assert_int_equal(sl_inertia(F, A, sigma, NULL, &info), SL_OK);
        assert_int_equal(sl_cholesky_factor_shifted(F, A, sigma, NULL, NULL), SL_OK);
        double *X = random_doubles((int64_t)n * w, &rng), *B = sl_copy(X, (int64_t)n * w, sizeof *B);
        double *R = sl_alloc((int64_t)n * w, sizeof *R), *work = sl_alloc(sl_cholesky_work_size(F, w), sizeof *work);
        assert_true(B != NULL && R != NULL && work != NULL);
        sl_cholesky_solve(F, X, w, work);
        sl_csc_multiply_symmetric(A, X, w, R);
        /* (A - sigma I + E) X = B, E as sl_inertia bounds it: thrice, for each of the two triangular solves. */
        const double scale = 3.0 * info.backward_error * sqrt(n) * max_abs(X, (int64_t)n * w);
        for (int64_t i = 0; i < (int64_t)n * w; i++) {
            assert_true(test_near(R[i] - sigma * X[i], B[i], scale + 1e-13));
        }
        sl_free(X);
        sl_free(B);
        sl_free(R);
        sl_free(work);
        sl_cholesky_free(F);
        sl_csc_free(A);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(permuting_in_and_out_gives_back_the_block),
        cmocka_unit_test(shifted_blocks_are_solved_as_lapack_solves_them),
        cmocka_unit_test(bottom_and_top_are_a_block_elimination),
        cmocka_unit_test(bottom_parts_are_small_and_apart),
        cmocka_unit_test(indefinite_systems_are_solved_by_signed_factors),
    };
    return cmocka_run_group_tests(tests, one_blas_thread, NULL);
}
