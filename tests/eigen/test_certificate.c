#include "pairs.h"

/* How many of the exact values lie below sigma. */
static int32_t values_below(const double *exact, int32_t n, double sigma)
{
    int32_t count = 0;
    while (count < n && exact[count] < sigma) {
        count++;
    }
    return count;
}

/* Solves with and without the constant vector deflated: certified, by counts that all known values confirm, and with
 * every copy of every value. Frees A and exact. */
static void expect_certified(sl_csc *A, double *exact, int32_t count, int32_t block)
{
    const int32_t n = A->ncols;
    double *ones = constant_vector(n);
    for (int deflate = 0; deflate < 2; deflate++) {
        sl_lanczos_def def = sl_lanczos_default();
        def.count = count;
        def.block = block;
        def.null_space = ones;
        def.null_count = deflate;
        pairs p = pairs_of(A, &def);
        assert_sound(A, &p, def.tolerance);
        assert_true(p.info.certified);
        assert_int_equal(p.info.count, values_below(exact, n, p.info.sigma));
        assert_true(p.info.count >= p.count);
        assert_true(p.info.sigma > p.lambda[p.count - 1]);
        if (p.info.cluster_cut) {
            assert_int_equal(p.info.count_below, values_below(exact, n, p.info.sigma_below));
            assert_true(p.info.count_below < p.count);
        }
        for (int32_t k = 0; k < p.count; k++) {
            assert_true(test_near(p.lambda[k], exact[k], 1e-12 * norm1(A)));
        }
        pairs_clear(&p);
    }
    sl_free(ones);
    sl_free(exact);
    sl_csc_free(A);
}

static void closed_spectra_are_certified(void **state)
{
    (void)state;
    expect_certified(path_laplacian(700, false), path_spectrum(700, false), 30, 0);
    expect_certified(path_laplacian(701, true), path_spectrum(701, true), 30, 0); /* ends between two copies */
    expect_certified(grid_laplacian(31, 31, false), grid_spectrum(31, 31, false), 30, 0);
    expect_certified(grid_laplacian(17, 23, false), grid_spectrum(17, 23, false), 12, 0);
}

/* Multiplicities up to 12: whatever the block, whatever value the wanted set ends in. */
static void a_torus_is_certified_for_any_block_and_count(void **state)
{
    (void)state;
    for (int32_t block = 0; block <= 16; block = block == 0 ? 4 : 2 * block) {
        expect_certified(grid_laplacian(24, 24, true), grid_spectrum(24, 24, true), 30, block);
    }
    for (int32_t count = 2; count <= 38; count += 3) {
        expect_certified(grid_laplacian(24, 24, true), grid_spectrum(24, 24, true), count, 4);
    }
}

static double *star_spectrum(int32_t n, bool complete)
{
    double *lambda = sl_alloc(n, sizeof *lambda);
    assert_non_null(lambda);
    for (int32_t k = 0; k < n; k++) {
        lambda[k] = k == 0 ? 0.0 : k == n - 1 || complete ? n : 1.0;
    }
    return lambda;
}

static void clusters_larger_than_the_block_take_two_counts(void **state)
{
    (void)state;
    const int32_t sizes[] = {150, 280};
    for (size_t z = 0; z < SL_COUNTOF(sizes); z++) {
        const int32_t n = sizes[z];
        graph star = graph_create(n, n), complete = graph_create(n, (int64_t)n * n);
        for (int32_t i = 1; i < n; i++) {
            graph_join(&star, 0, i);
            for (int32_t j = 0; j < i; j++) {
                graph_join(&complete, j, i);
            }
        }
        sl_csc *A = graph_laplacian(&star, NULL);
        sl_lanczos_def def = sl_lanczos_default();
        def.count = 12;
        pairs p = pairs_of(A, &def);
        assert_true(p.info.certified);
        assert_int_equal(p.info.cluster_cut, n > 200);
        assert_int_equal(p.info.count, n - 1);
        assert_int_equal(p.info.count_below, n > 200 ? 1 : 0);
        pairs_clear(&p);
        expect_certified(A, star_spectrum(n, false), 12, 0);
        A = graph_laplacian(&complete, NULL);
        expect_certified(A, star_spectrum(n, true), 12, 0); /* half way to n elimination breaks down: sigma moves */
    }
}

/* n cycles alike: every value has n copies and more. */
static void disconnected_graphs_are_certified(void **state)
{
    (void)state;
    for (int32_t copies = 2; copies <= 11; copies += 3) {
        const int32_t length = 61;
        graph g = graph_create(copies * length, copies * length);
        double *cycle = path_spectrum(length, true), *exact = sl_alloc(g.n, sizeof *exact);
        assert_non_null(exact);
        for (int32_t i = 0; i < g.n; i++) {
            const int32_t first = i / length * length;
            graph_join(&g, i, first + (i - first + 1) % length);
            exact[i] = cycle[i / copies];
        }
        sl_free(cycle);
        expect_certified(graph_laplacian(&g, NULL), exact, 30, 0);
    }
}

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

/* A ring of `fold` equal random pieces, each joined to the next: eigenvalues come in pairs at least. */
static sl_csc *folded_laplacian(test_rng *rng, int32_t fold, int32_t piece)
{
    graph g = graph_create(fold * piece, 4 * (int64_t)fold * piece);
    for (int32_t i = 1; i < piece; i++) {
        const int32_t a = test_index(rng, i), b = test_index(rng, i);
        for (int32_t k = 0; k < fold; k++) {
            graph_join(&g, k * piece + a, k * piece + i);
            if (i % 3 == 0) {
                graph_join(&g, k * piece + b, (k + 1) % fold * piece + i);
            }
        }
    }
    return graph_laplacian(&g, NULL);
}

static void symmetric_shapes_are_certified(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0xf01d);
    for (int32_t fold = 3; fold <= 8; fold++) {
        sl_csc *A = folded_laplacian(&rng, fold, 420 / fold);
        expect_certified(A, dense_spectrum(A), 15 + test_index(&rng, 15), 0);
    }
    sl_csc *cube = cube_facet_laplacian(9), *sphere = icosphere_facet_laplacian(2);
    expect_certified(cube, dense_spectrum(cube), 30, 0);
    expect_certified(sphere, dense_spectrum(sphere), 30, 0);
}

static void no_certificate_is_claimed_where_none_was_asked_for(void **state)
{
    (void)state;
    for (int32_t side = 9; side <= 29; side += 20) {
        sl_csc *A = grid_laplacian(side, side + 1, false);
        sl_lanczos_def def = sl_lanczos_default();
        def.count = 9;
        def.certify = false;
        pairs p = pairs_of(A, &def);
        assert_sound(A, &p, def.tolerance);
        assert_false(p.info.certified);
        assert_int_equal(p.info.counts, 0);
        pairs_clear(&p);
        sl_csc_free(A);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(closed_spectra_are_certified),
        cmocka_unit_test(a_torus_is_certified_for_any_block_and_count),
        cmocka_unit_test(clusters_larger_than_the_block_take_two_counts),
        cmocka_unit_test(disconnected_graphs_are_certified),
        cmocka_unit_test(symmetric_shapes_are_certified),
        cmocka_unit_test(no_certificate_is_claimed_where_none_was_asked_for),
    };
    return cmocka_run_group_tests(tests, one_blas_thread, NULL);
}
