#include "pairs.h"

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
    };
    return cmocka_run_group_tests(tests, one_blas_thread, NULL);
}
