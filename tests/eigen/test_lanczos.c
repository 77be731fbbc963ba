#include "pairs.h"

static void small_bases_converge_by_restarts(void **state)
{
    (void)state;
    sl_csc *A = grid_laplacian(40, 57, false);
    double *exact = grid_spectrum(40, 57, false);
    sl_lanczos_def def = sl_lanczos_default();
    def.count = 20;
    def.block = 4;
    def.max_basis = 36;
    def.tolerance = 1e-11;
    pairs p = pairs_of(A, &def);
    assert_sound(A, &p, def.tolerance);
    assert_true(p.info.restarts >= 2);
    for (int32_t k = 0; k < 20; k++) {
        assert_true(test_near(p.lambda[k], exact[k], 1e-12));
    }
    pairs_clear(&p);
    sl_free(exact);
    sl_csc_free(A);
}

/* lambda and vectors are those of the matrix within their span: X'AX = diag(lambda). */
static void assert_ritz_pairs(const sl_csc *A, const sl_lanczos *solver, int32_t count)
{
    const int32_t n = A->ncols;
    double *X = sl_alloc((int64_t)n * count, sizeof *X), *Y = sl_alloc((int64_t)n * count, sizeof *Y);
    double *lambda = sl_alloc(count, sizeof *lambda);
    assert_true(X && Y && lambda);
    sl_lanczos_result(solver, lambda, X, NULL);
    sl_csc_multiply_symmetric(A, X, count, Y);
    for (int32_t k = 0; k < count * count; k++) {
        double dot = 0.0;
        for (int32_t i = 0; i < n; i++) {
            dot += X[(int64_t)n * (k / count) + i] * Y[(int64_t)n * (k % count) + i];
        }
        assert_true(test_near(dot, k / count == k % count ? lambda[k / count] : 0.0, 1e-13));
    }
    sl_free(X);
    sl_free(Y);
    sl_free(lambda);
}

static void not_converging_is_an_outcome(void **state)
{
    (void)state;
    sl_csc *A = grid_laplacian(60, 57, false);
    sl_lanczos_def def = sl_lanczos_default();
    sl_lanczos *solver = NULL;
    def.count = 25;
    def.block = 2;
    def.max_basis = 45;
    def.tolerance = 1e-13;
    assert_int_equal(sl_lanczos_create(A, &def, NULL, &solver), SL_OK);
    assert_int_equal(sl_lanczos_step(solver, 1), SL_OK);
    const sl_lanczos_info first = *sl_lanczos_info_of(solver);
    assert_false(first.converged);
    assert_int_equal(first.restarts, 1);
    assert_true(first.max_residual > def.tolerance && first.converged_count < 25);
    assert_ritz_pairs(A, solver, 25);
    assert_int_equal(sl_lanczos_step(solver, 3), SL_OK);
    const sl_lanczos_info *later = sl_lanczos_info_of(solver);
    assert_int_equal(later->restarts, 4);
    assert_true(later->solves > first.solves);
    assert_true(later->max_residual < 0.5 * first.max_residual);
    sl_lanczos_free(solver);
    sl_csc_free(A);
}

static void stepping_gives_the_bytes_of_solving(void **state)
{
    (void)state;
    enum { COUNT = 30 };
    sl_csc *A = cube_facet_laplacian(12);
    const int32_t n = A->ncols;
    sl_lanczos_def def = sl_lanczos_default();
    def.count = COUNT;
    def.max_basis = 60;
    pairs p = pairs_of(A, &def), q = pairs_of(A, &def);
    assert_memory_equal(p.vectors, q.vectors, (size_t)n * COUNT * sizeof *p.vectors);
    sl_lanczos *solver = NULL;
    assert_int_equal(sl_lanczos_create(A, &def, NULL, &solver), SL_OK);
    for (int k = 0; k < 60 && !sl_lanczos_info_of(solver)->converged; k++) {
        assert_int_equal(sl_lanczos_step(solver, 1), SL_OK);
    }
    sl_lanczos_result(solver, q.lambda, q.vectors, NULL);
    assert_memory_equal(p.lambda, q.lambda, COUNT * sizeof *p.lambda);
    assert_memory_equal(p.vectors, q.vectors, (size_t)n * COUNT * sizeof *p.vectors);
    def.seed = 2; /* another start, the same values */
    pairs r = pairs_of(A, &def);
    assert_memory_not_equal(p.vectors, r.vectors, (size_t)n * COUNT * sizeof *p.vectors);
    for (int32_t k = 0; k < COUNT; k++) {
        assert_true(test_near(p.lambda[k], r.lambda[k], 1e-11));
    }
    sl_lanczos_free(solver);
    pairs_clear(&p);
    pairs_clear(&q);
    pairs_clear(&r);
    sl_csc_free(A);
}

static void a_wider_null_space_is_deflated_and_delivered(void **state)
{
    (void)state;
    graph g = graph_create(600, 600); /* two cycles */
    for (int32_t i = 0; i < 600; i++) {
        graph_join(&g, i, i < 250 ? (i + 1) % 250 : 250 + (i - 250 + 1) % 350);
    }
    sl_csc *A = graph_laplacian(&g, NULL);
    double *N = sl_calloc(1200, sizeof *N), *a = path_spectrum(250, true), *b = path_spectrum(350, true);
    assert_non_null(N);
    for (int32_t i = 0; i < 600; i++) {
        N[i < 250 ? i : 600 + i] = 1.0 / sqrt(i < 250 ? 250.0 : 350.0);
    }
    for (int32_t count = 1; count <= 6; count++) {
        sl_lanczos_def def = sl_lanczos_default();
        def.count = count;
        def.null_space = N;
        def.null_count = 2;
        pairs p = pairs_of(A, &def);
        assert_sound(A, &p, def.tolerance);
        const double exact[6] = {0.0, 0.0, b[1], b[2], a[1], a[2]};
        for (int32_t k = 0; k < count; k++) {
            assert_true(test_near(p.lambda[k], exact[k], 1e-12));
        }
        assert_memory_equal(p.vectors, N, 600 * sizeof *N);
        pairs_clear(&p);
    }
    sl_free(N);
    sl_free(a);
    sl_free(b);
    sl_csc_free(A);
}

typedef struct patience {
    int32_t calls, limit;
} patience;

static bool lose_patience(void *user, const char *stage, double fraction)
{
    patience *p = user;
    assert_non_null(stage);
    assert_true(fraction >= 0.0 && fraction <= 1.0);
    return ++p->calls < p->limit;
}

static void progress_may_cancel_at_any_call(void **state)
{
    (void)state;
    sl_csc *A = grid_laplacian(20, 31, false);
    double lambda[10], *vectors = sl_alloc(10 * (int64_t)A->ncols, sizeof *vectors);
    assert_non_null(vectors);
    sl_lanczos_def def = sl_lanczos_default();
    def.count = 10;
    sl_status status = SL_CANCELLED;
    int32_t limit = 1;
    for (; limit < 1000 && status == SL_CANCELLED; limit++) {
        patience p = {0, limit};
        const sl_context context = {.progress = lose_patience, .progress_user = &p};
        status = sl_lanczos_solve(A, &def, &context, lambda, vectors, NULL, NULL);
    }
    assert_int_equal(status, SL_OK);
    assert_true(limit > 5);
    sl_free(vectors);
    sl_csc_free(A);
}

static void unusable_input_is_refused(void **state)
{
    (void)state;
    sl_csc *A = grid_laplacian(20, 21, false);
    const int32_t n = A->ncols;
    double *N = constant_vector(n);
    sl_lanczos *solver = (sl_lanczos *)N;
    const sl_lanczos_def good = sl_lanczos_default();
    sl_lanczos_def bad[] = {good, good, good, good, good, good, good};
    bad[0].count = -1;
    bad[1].tolerance = 0.0;
    bad[2].tolerance = NAN;
    bad[3].null_count = 1; /* and no null space */
    bad[4].block = -1;
    bad[5].max_basis = -1;
    bad[6].max_restarts = -1;
    for (size_t k = 0; k < SL_COUNTOF(bad); k++) {
        assert_int_equal(sl_lanczos_create(A, &bad[k], NULL, &solver), SL_BAD_INPUT);
        assert_null(solver);
    }
    sl_lanczos_def def = good;
    def.null_space = N;
    def.null_count = 1;
    N[3] *= 1.001; /* neither of length 1 nor mapped to 0 */
    assert_int_equal(sl_lanczos_create(A, &def, NULL, &solver), SL_BAD_INPUT);
    N[3] = N[4];
    A->val[7] = NAN;
    assert_int_equal(sl_lanczos_create(A, &def, NULL, &solver), SL_BAD_INPUT);
    sl_lanczos_free(NULL);
    sl_free(N);
    sl_csc_free(A);
}

static void a_negative_eigenvalue_is_reported(void **state)
{
    (void)state;
    sl_csc *A = grid_laplacian(20, 21, false);
    sl_lanczos *solver = NULL;
    A->val[A->colptr[77]] -= 0.4;
    assert_int_equal(sl_lanczos_create(A, NULL, NULL, &solver), SL_NOT_POSITIVE_DEFINITE);
    assert_null(solver);
    sl_csc_free(A);
}

static void dense_pairs_rebuild_the_matrix(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0xde45e);
    assert_int_equal(sl_dense_eigen(0, NULL, NULL, NULL), SL_OK);
    for (int32_t n = 1; n <= 40; n += 13) {
        double *A = sl_alloc(n * n, sizeof *A), *V = sl_alloc(n * n, sizeof *V), *lambda = sl_alloc(n, sizeof *lambda);
        assert_true(A && V && lambda);
        for (int32_t j = 0; j < n; j++) {
            for (int32_t i = j; i < n; i++) {
                A[j * n + i] = A[i * n + j] = test_uniform(&rng, -1.0, 1.0);
            }
        }
        double *D = sl_copy(A, n * n, sizeof *D);
        assert_non_null(D);
        assert_int_equal(sl_dense_eigen(n, D, lambda, V), SL_OK);
        for (int32_t j = 0; j < n; j++) {
            assert_true(j == 0 || lambda[j] >= lambda[j - 1]);
            for (int32_t i = 0; i < n; i++) {
                double sum = 0.0;
                for (int32_t k = 0; k < n; k++) {
                    sum += V[k * n + i] * lambda[k] * V[k * n + j];
                }
                assert_true(test_near(sum, A[j * n + i], 1e-13 * n));
            }
        }
        sl_free(A);
        sl_free(D);
        sl_free(V);
        sl_free(lambda);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(small_bases_converge_by_restarts),
        cmocka_unit_test(not_converging_is_an_outcome),
        cmocka_unit_test(stepping_gives_the_bytes_of_solving),
        cmocka_unit_test(a_wider_null_space_is_deflated_and_delivered),
        cmocka_unit_test(progress_may_cancel_at_any_call),
        cmocka_unit_test(unusable_input_is_refused),
        cmocka_unit_test(a_negative_eigenvalue_is_reported),
        cmocka_unit_test(dense_pairs_rebuild_the_matrix),
    };
    return cmocka_run_group_tests(tests, one_blas_thread, NULL);
}
