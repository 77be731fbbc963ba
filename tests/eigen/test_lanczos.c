#include "graphs.h"

#include "eigen/lanczos.h"

#include <cblas.h>

static int one_blas_thread(void **state)
{
    (void)state;
    openblas_set_num_threads(1);
    return 0;
}

typedef struct pairs {
    int32_t n, count;
    double *lambda, *vectors, *residual;
    sl_lanczos_info info;
} pairs;

static pairs pairs_of(const sl_csc *A, const sl_lanczos_def *def)
{
    const int32_t n = A->ncols, count = def->count < n ? def->count : n;
    pairs p = {.n = n, .count = count};
    p.lambda = sl_alloc(count, sizeof *p.lambda);
    p.vectors = sl_alloc((int64_t)n * count, sizeof *p.vectors);
    p.residual = sl_alloc(count, sizeof *p.residual);
    assert_true(p.lambda && p.vectors && p.residual);
    assert_int_equal(sl_lanczos_solve(A, def, NULL, p.lambda, p.vectors, p.residual, &p.info), SL_OK);
    return p;
}

static void pairs_clear(pairs *p)
{
    sl_free(p->lambda);
    sl_free(p->vectors);
    sl_free(p->residual);
}

static double norm1(const sl_csc *A)
{
    double *sum = sl_calloc(A->ncols, sizeof *sum), norm = 0.0;
    assert_non_null(sum);
    for (int32_t j = 0; j < A->ncols; j++) {
        for (int64_t p = A->colptr[j]; p < A->colptr[j + 1]; p++) {
            sum[j] += fabs(A->val[p]);
            sum[A->row[p]] += A->row[p] != j ? fabs(A->val[p]) : 0.0;
        }
    }
    for (int32_t j = 0; j < A->ncols; j++) {
        norm = fmax(norm, sum[j]);
    }
    sl_free(sum);
    return norm;
}

static void assert_sign_rule(const double *x, int32_t n)
{
    double largest = 0.0;
    for (int32_t i = 0; i < n; i++) {
        largest = fmax(largest, fabs(x[i]));
    }
    int32_t first = 0;
    while (fabs(x[first]) < (1.0 - 1e-8) * largest) {
        first++;
    }
    assert_true(x[first] > 0.0);
}

/* Orthonormal, ascending, of the residuals reported and within the tolerance. */
static void assert_sound(const sl_csc *A, const pairs *p, double tolerance)
{
    const int32_t n = p->n;
    const double norm = norm1(A);
    double *Y = sl_alloc(n, sizeof *Y), worst = 0.0;
    assert_non_null(Y);
    for (int32_t k = 0; k < p->count; k++) {
        const double *x = p->vectors + (int64_t)n * k;
        for (int32_t j = 0; j <= k; j++) {
            double dot = 0.0;
            for (int32_t i = 0; i < n; i++) {
                dot += x[i] * p->vectors[(int64_t)n * j + i];
            }
            assert_true(test_near(dot, j == k ? 1.0 : 0.0, 1e-12));
        }
        double squares = 0.0;
        sl_csc_multiply_symmetric(A, x, 1, Y);
        for (int32_t i = 0; i < n; i++) {
            squares += (Y[i] - p->lambda[k] * x[i]) * (Y[i] - p->lambda[k] * x[i]);
        }
        const double residual = sqrt(squares) / (norm > 0.0 ? norm : 1.0);
        assert_true(residual <= tolerance);
        assert_true(test_near(p->residual[k], residual, 1e-14));
        assert_true(k == 0 || p->lambda[k] >= p->lambda[k - 1]);
        assert_sign_rule(x, n);
        worst = fmax(worst, residual);
    }
    assert_true(p->info.converged);
    assert_int_equal(p->info.converged_count, p->count);
    assert_true(test_near(p->info.max_residual, worst, 1e-14));
    sl_free(Y);
}

static double *constant_vector(int32_t n)
{
    double *x = sl_alloc(n, sizeof *x);
    assert_non_null(x);
    for (int32_t i = 0; i < n; i++) {
        x[i] = 1.0 / sqrt(n);
    }
    return x;
}

/* Solves with and without a null space and compares with all values known; frees A and exact. block 0 = default. */
static void expect_spectrum(sl_csc *A, double *exact, int32_t count, int32_t block)
{
    double *ones = constant_vector(A->ncols);
    for (int deflate = 0; deflate < 2; deflate++) {
        sl_lanczos_def def = sl_lanczos_default();
        def.count = count;
        def.block = block;
        def.null_space = deflate ? ones : NULL;
        def.null_count = deflate;
        pairs p = pairs_of(A, &def);
        assert_sound(A, &p, def.tolerance);
        for (int32_t k = 0; k < p.count; k++) {
            assert_true(test_near(p.lambda[k], exact[k], 1e-10));
        }
        pairs_clear(&p);
    }
    sl_free(ones);
    sl_free(exact);
    sl_csc_free(A);
}

static void paths_and_cycles_have_their_closed_spectra(void **state)
{
    (void)state;
    const int32_t sizes[] = {1, 2, 3, 7, 150, 333, 1500};
    for (size_t k = 0; k < SL_COUNTOF(sizes); k++) {
        expect_spectrum(path_laplacian(sizes[k], false), path_spectrum(sizes[k], false), 12, 0);
        if (sizes[k] > 2) {
            expect_spectrum(path_laplacian(sizes[k], true), path_spectrum(sizes[k], true), 13, 0);
        }
    }
}

static void grids_have_their_closed_spectra(void **state)
{
    (void)state;
    expect_spectrum(grid_laplacian(23, 41, false), grid_spectrum(23, 41, false), 30, 0);
    expect_spectrum(grid_laplacian(30, 30, false), grid_spectrum(30, 30, false), 25, 0); /* pairs of equal values */
    expect_spectrum(grid_laplacian(9, 13, false), grid_spectrum(9, 13, false), 117, 0);  /* dense: all of them */
}

static void a_square_torus_keeps_all_copies_of_each_value(void **state)
{
    (void)state;
    for (int32_t block = 0; block <= 16; block = block == 0 ? 1 : 2 * block) {
        expect_spectrum(grid_laplacian(24, 24, true), grid_spectrum(24, 24, true), 30, block);
    }
}

/* 21 values: 1 + 4 + 4 + 4 + 8 ends a multiplicity of the 20 x 20 torus; all others up to 30 end inside one. */
static void the_wanted_set_may_end_inside_a_multiplicity(void **state)
{
    (void)state;
    for (int32_t count = 17; count <= 24; count++) {
        expect_spectrum(grid_laplacian(20, 20, true), grid_spectrum(20, 20, true), count, 0);
    }
}

static double *star_spectrum(int32_t n)
{
    double *lambda = sl_alloc(n, sizeof *lambda);
    assert_non_null(lambda);
    for (int32_t k = 0; k < n; k++) {
        lambda[k] = k == 0 ? 0.0 : k == n - 1 ? n : 1.0;
    }
    return lambda;
}

static void stars_and_complete_graphs_have_one_value_for_nearly_all(void **state)
{
    (void)state;
    const int32_t sizes[] = {4, 150, 260};
    for (size_t z = 0; z < SL_COUNTOF(sizes); z++) {
        const int32_t n = sizes[z];
        graph star = graph_create(n, n), complete = graph_create(n, (int64_t)n * n);
        for (int32_t i = 1; i < n; i++) {
            graph_join(&star, 0, i);
            for (int32_t j = 0; j < i; j++) {
                graph_join(&complete, j, i);
            }
        }
        expect_spectrum(graph_laplacian(&star, NULL), star_spectrum(n), 15, 0);
        double *lambda = star_spectrum(n);
        for (int32_t k = 1; k < n; k++) {
            lambda[k] = n;
        }
        expect_spectrum(graph_laplacian(&complete, NULL), lambda, 15, 0);
    }
}

/* Seventeen cycles and three lone nodes: twenty zeros, more than two blocks of eight. */
static void a_disconnected_graph_has_a_zero_for_each_part(void **state)
{
    (void)state;
    graph g = graph_create(17 * 40 + 3, 17 * 40);
    double *lambda = sl_calloc(g.n, sizeof *lambda), *cycle = path_spectrum(40, true);
    assert_non_null(lambda);
    for (int32_t c = 0; c < 17; c++) {
        for (int32_t i = 0; i < 40; i++) {
            graph_join(&g, 40 * c + i, 40 * c + (i + 1) % 40);
            lambda[40 * c + i] = cycle[i];
        }
    }
    sl_free(cycle);
    qsort(lambda, (size_t)g.n, sizeof *lambda, compare_doubles);
    expect_spectrum(graph_laplacian(&g, NULL), lambda, 35, 0);
}

static void a_matrix_of_zeros_has_zeros_only(void **state)
{
    (void)state;
    for (int32_t n = 0; n <= 300; n += 150) {
        graph g = graph_create(n, 1);
        sl_csc *A = graph_laplacian(&g, NULL);
        sl_lanczos_def def = sl_lanczos_default();
        def.count = 5;
        pairs p = pairs_of(A, &def);
        assert_sound(A, &p, def.tolerance);
        for (int32_t k = 0; k < p.count; k++) {
            assert_true(p.lambda[k] == 0.0);
        }
        pairs_clear(&p);
        sl_csc_free(A);
    }
}

/* All values by LAPACK, for graphs without a closed form. */
static double *dense_spectrum(const sl_csc *A)
{
    const int64_t n = A->ncols;
    double *D = sl_calloc(n * n, sizeof *D), *V = sl_alloc(n * n, sizeof *V), *lambda = sl_alloc(n, sizeof *lambda);
    assert_true(D && V && lambda);
    for (int32_t j = 0; j < n; j++) {
        for (int64_t p = A->colptr[j]; p < A->colptr[j + 1]; p++) {
            D[j * n + A->row[p]] = A->val[p];
        }
    }
    assert_int_equal(sl_dense_eigen(A->ncols, D, lambda, V), SL_OK);
    sl_free(D);
    sl_free(V);
    return lambda;
}

static void facet_graphs_of_symmetric_solids_agree_with_lapack(void **state)
{
    (void)state;
    for (int32_t side = 7; side <= 10; side += 3) {
        sl_csc *cube = cube_facet_laplacian(side);
        for (int32_t j = 0; j < cube->ncols; j++) {
            assert_true(cube->val[cube->colptr[j]] == 4.0); /* every facet has four neighbours */
        }
        double *exact = dense_spectrum(cube);
        assert_true(test_near(exact[3], exact[1], 1e-12)); /* the cube's group: threefold */
        expect_spectrum(cube, exact, 30, 0);
    }
    sl_csc *sphere = icosphere_facet_laplacian(2);
    assert_int_equal(sphere->ncols, 320);
    expect_spectrum(sphere, dense_spectrum(sphere), 25, 0);
    sphere = icosphere_facet_laplacian(3);
    assert_int_equal(sphere->ncols, 1280);
    double *exact = dense_spectrum(sphere);
    assert_true(test_near(exact[3], exact[1], 1e-12) && test_near(exact[8], exact[4], 1e-12)); /* 3 and 5 copies */
    expect_spectrum(sphere, exact, 30, 0);
}

static void random_weighted_graphs_agree_with_lapack(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0xe16e);
    for (int trial = 0; trial < 8 * test_multiplier(); trial++) {
        const int32_t n = 210 + test_index(&rng, 200);
        graph g = graph_create(n, 2 * (int64_t)n);
        double *weight = sl_alloc(2 * (int64_t)n, sizeof *weight);
        assert_non_null(weight);
        for (int32_t i = 1; i < n; i++) { /* a long thin graph with short cuts: small values close together */
            graph_join(&g, i - 1 - test_index(&rng, i < 5 ? i : 5), i);
            if (test_index(&rng, 9) == 0) {
                graph_join(&g, test_index(&rng, i), i);
            }
        }
        for (int64_t e = 0; e < g.count; e++) {
            weight[e] = exp(test_uniform(&rng, -3.0, 3.0));
        }
        sl_csc *A = graph_laplacian(&g, weight);
        expect_spectrum(A, dense_spectrum(A), 2 + test_index(&rng, 25), test_index(&rng, 10));
        sl_free(weight);
    }
}

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
        const sl_context context = {NULL, lose_patience, &p};
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
        cmocka_unit_test(paths_and_cycles_have_their_closed_spectra),
        cmocka_unit_test(grids_have_their_closed_spectra),
        cmocka_unit_test(a_square_torus_keeps_all_copies_of_each_value),
        cmocka_unit_test(the_wanted_set_may_end_inside_a_multiplicity),
        cmocka_unit_test(stars_and_complete_graphs_have_one_value_for_nearly_all),
        cmocka_unit_test(a_disconnected_graph_has_a_zero_for_each_part),
        cmocka_unit_test(a_matrix_of_zeros_has_zeros_only),
        cmocka_unit_test(facet_graphs_of_symmetric_solids_agree_with_lapack),
        cmocka_unit_test(random_weighted_graphs_agree_with_lapack),
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
