/* Eigenpairs of facet graphs against the dense solver, residuals, components. */
#include "base/memory.h"
#include "spectral/shapes.h"
#include "spectral/spectrum.h"

/* y = (D - A) x straight from the adjacency. */
static void multiply(const sl_graph *g, const double *x, double *y)
{
    for (int32_t i = 0; i < g->n; i++) {
        y[i] = 0.0;
        for (int32_t p = g->first[i]; p < g->first[i + 1]; p++) {
            y[i] += x[i] - x[g->adj[p]];
        }
    }
}

static double largest_residual(const sl_graph *g, const sl_spectrum *s)
{
    double worst = 0.0, *y = malloc((size_t)g->n * sizeof *y);
    for (int32_t k = 0; k < s->count; k++) {
        const double *v = s->vectors + (int64_t)k * g->n;
        double sum = 0.0;
        multiply(g, v, y);
        for (int32_t i = 0; i < g->n; i++) {
            sum += (y[i] - s->lambda[k] * v[i]) * (y[i] - s->lambda[k] * v[i]);
        }
        worst = fmax(worst, sqrt(sum));
    }
    free(y);
    return worst;
}

static void check_against_dense(const sl_facet_graph *graph, int32_t count)
{
    const int32_t n = graph->graph.n;
    double *A = calloc((size_t)(n * n), sizeof *A), *V = malloc((size_t)(n * n) * sizeof *V);
    double *lambda = malloc((size_t)n * sizeof *lambda);
    for (int32_t i = 0; i < n; i++) {
        for (int32_t p = graph->graph.first[i]; p < graph->graph.first[i + 1]; p++) {
            A[i * n + i] += 1.0;
            A[i * n + graph->graph.adj[p]] -= 1.0;
        }
    }
    assert_int_equal(sl_dense_eigen(n, A, lambda, V), SL_OK);
    sl_spectrum *s = NULL;
    assert_int_equal(sl_spectrum_compute(graph, count, NULL, &s), SL_OK);
    assert_int_equal(s->n, n);
    assert_int_equal(s->count, count < n ? count : n);
    for (int32_t k = 0; k < s->count; k++) {
        assert_true(test_near(s->lambda[k], lambda[k], 1e-9));
    }
    assert_true(largest_residual(&graph->graph, s) < 1e-6);
    sl_spectrum_free(s);
    free(A);
    free(V);
    free(lambda);
}

static void smallest_eigenvalues_agree_with_the_dense_solver(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0xe19e);
    for (int trial = 0; trial < 12 * test_multiplier(); trial++) {
        const test_facets kind = (test_facets)test_index(&rng, 3);
        sl_mesh *mesh = trial % 3 == 0   ? test_patch_mesh(&rng, 5 + test_index(&rng, 6), 9, kind, NULL)
                        : trial % 3 == 1 ? test_torus_mesh(&rng, 8 + test_index(&rng, 6), 7, 0.4, kind)
                                         : test_spiky_mesh(&rng, 4, 5, 0.8, kind);
        sl_facet_graph *graph = test_whole_graph(mesh, NULL);
        check_against_dense(graph, 2 + test_index(&rng, 29));
        sl_facet_graph_free(graph);
        sl_mesh_free(mesh);
    }
}

static void count_is_clipped_to_the_number_of_nodes(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0xc119);
    sl_mesh *mesh = test_patch_mesh(&rng, 2, 3, TEST_QUADS, NULL);
    sl_facet_graph *graph = test_whole_graph(mesh, NULL);
    check_against_dense(graph, 30);
    sl_facet_graph_free(graph);
    sl_mesh_free(mesh);
}

/* Cells dropped in two full rows leave three strips of different widths. */
static void every_component_has_its_own_null_vector(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0xc0);
    uint8_t drop[14 * 6] = {0};
    for (int32_t j = 0; j < 6; j++) {
        drop[3 * 6 + j] = drop[8 * 6 + j] = 1;
    }
    sl_mesh *mesh = test_patch_mesh(&rng, 14, 6, TEST_TRIANGLES, drop);
    sl_facet_graph *graph = test_whole_graph(mesh, NULL);
    for (int32_t count = 2; count <= 12; count += 5) { /* fewer than the components, then more */
        sl_spectrum *s = NULL;
        assert_int_equal(sl_spectrum_compute(graph, count, NULL, &s), SL_OK);
        for (int32_t k = 0; k < count; k++) {
            assert_true(k < 3 ? fabs(s->lambda[k]) < 1e-9 : s->lambda[k] > 1e-3);
        }
        assert_true(largest_residual(&graph->graph, s) < 1e-6);
        sl_spectrum_free(s);
    }
    sl_facet_graph_free(graph);
    sl_mesh_free(mesh);
}

/* Values to a part in 100,000 (errors are squares of the vectors'), sides equal where vectors are not small. */
static void signs_are_those_of_the_precise_spectrum(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0x519);
    sl_mesh *mesh = test_spiky_mesh(&rng, 4, 5, 0.8, TEST_TRIANGLES);
    sl_facet_graph *graph = test_whole_graph(mesh, NULL);
    sl_spectrum *precise = NULL, *rough = NULL;
    assert_int_equal(sl_spectrum_compute(graph, 15, NULL, &precise), SL_OK);
    assert_int_equal(sl_spectrum_compute_signs(graph, 15, NULL, &rough), SL_OK);
    assert_true(rough->info.converged && rough->info.max_relative <= 2e-3);
    for (int32_t k = 1; k < 15; k++) {
        const double gap =
            k < 14 ? fmin(precise->lambda[k + 1] - precise->lambda[k], precise->lambda[k] - precise->lambda[k - 1])
                   : 0.0;
        assert_true(test_near(rough->lambda[k] / precise->lambda[k], 1.0, 1e-5));
        for (int32_t i = 0; i < precise->n && gap > 0.05 * precise->lambda[k]; i++) {
            const double a = precise->vectors[(int64_t)k * precise->n + i];
            const double b = rough->vectors[(int64_t)k * precise->n + i];
            assert_true(fabs(a) < 0.1 / sqrt(precise->n) || a * b > 0.0);
        }
    }
    sl_spectrum_free(precise);
    sl_spectrum_free(rough);
    sl_facet_graph_free(graph);
    sl_mesh_free(mesh);
}

/* What is asked for by name is what the definition asks for. */
static void the_definition_sets_count_mode_and_tolerance(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0xdef);
    sl_mesh *mesh = test_torus_mesh(&rng, 40, 30, 0.4, TEST_TRIANGLES);
    sl_facet_graph *graph = test_whole_graph(mesh, NULL);
    for (int exponent = 5; exponent <= 13; exponent += 4) {
        sl_spectrum_def def = sl_spectrum_default();
        sl_spectrum *s = NULL;
        assert_int_equal(def.count, 30);
        def.count = 12;
        def.tolerance = pow(10.0, -exponent);
        assert_int_equal(sl_spectrum_solve(graph, &def, NULL, &s), SL_OK);
        assert_int_equal(s->count, 12);
        assert_true(s->info.converged && s->info.certified && s->info.max_residual <= def.tolerance);
        assert_true(largest_residual(&graph->graph, s) <= 6.5 * def.tolerance); /* ||L||_1 = 6, and our rounding */
        sl_spectrum_free(s);
        def.mode = SL_LANCZOS_SIGNS;
        assert_int_equal(sl_spectrum_solve(graph, &def, NULL, &s), SL_OK);
        assert_true(s->info.converged && s->info.max_relative <= 2e-3);
        sl_spectrum_free(s);
    }
    sl_spectrum_def def = sl_spectrum_default();
    sl_spectrum *s = (sl_spectrum *)&rng;
    def.tolerance = 1e-15;
    assert_int_equal(sl_spectrum_solve(graph, &def, NULL, &s), SL_BAD_INPUT);
    assert_null(s);
    def = sl_spectrum_default();
    def.count = -1;
    assert_int_equal(sl_spectrum_solve(graph, &def, NULL, &s), SL_BAD_INPUT);
    sl_facet_graph_free(graph);
    sl_mesh_free(mesh);
}

/* Bands against one run over all of them. */
static void bands_give_the_pairs_of_a_single_run(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0xba4d);
    sl_mesh *mesh = test_spiky_mesh(&rng, 7, 5, 0.8, TEST_TRIANGLES);
    sl_facet_graph *graph = test_whole_graph(mesh, NULL);
    sl_spectrum_def def = sl_spectrum_default();
    sl_spectrum *whole = NULL, *bands = NULL;
    def.count = 170;
    assert_int_equal(sl_spectrum_solve(graph, &def, NULL, &whole), SL_OK);
    assert_int_equal(whole->bands.bands, 0);
    def.bands = true;
    assert_int_equal(sl_spectrum_solve(graph, &def, NULL, &bands), SL_OK);
    assert_true(bands->bands.bands > 2 && bands->info.converged && bands->info.certified);
    assert_int_equal(bands->count, whole->count);
    for (int32_t k = 0; k < bands->count; k++) {
        assert_true(test_near(bands->lambda[k], whole->lambda[k], 1e-9));
    }
    assert_true(largest_residual(&graph->graph, bands) < 1e-6);
    sl_spectrum_free(whole);
    sl_spectrum_free(bands);
    sl_facet_graph_free(graph);
    sl_mesh_free(mesh);
}

/* The estimate is refused one byte below itself; what is estimated does not depend on the limit. */
static void a_memory_limit_is_kept_or_refused(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0x11317);
    sl_mesh *mesh = test_torus_mesh(&rng, 50, 40, 0.4, TEST_TRIANGLES);
    sl_facet_graph *graph = test_whole_graph(mesh, NULL);
    sl_spectrum_def def = sl_spectrum_default();
    sl_spectrum *s = NULL;
    assert_int_equal(sl_spectrum_solve(graph, &def, NULL, &s), SL_OK);
    const int64_t needed = s->memory;
    assert_true(needed > 8 * 30 * (int64_t)graph->graph.n);
    sl_spectrum_free(s);
    def.memory_limit = needed;
    assert_int_equal(sl_spectrum_solve(graph, &def, NULL, &s), SL_OK);
    assert_true(s->memory == needed);
    sl_spectrum_free(s);
    const int64_t too_little[] = {needed - 1, needed / 3, 1};
    for (size_t k = 0; k < SL_COUNTOF(too_little); k++) {
        def.memory_limit = too_little[k];
        s = (sl_spectrum *)&rng;
        assert_int_equal(sl_spectrum_solve(graph, &def, NULL, &s), SL_LIMIT);
        assert_null(s);
    }
    sl_facet_graph_free(graph);
    sl_mesh_free(mesh);
}

/* A half of a mesh solved with the whole's order of elimination. */
static void a_part_inherits_the_order_of_the_whole(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0x1e4e);
    sl_mesh *mesh = test_torus_mesh(&rng, 50, 40, 0.4, TEST_TRIANGLES);
    sl_facet_graph *graph = test_whole_graph(mesh, NULL), *half = NULL;
    sl_spectrum *whole = NULL, *fresh = NULL, *inherited = NULL;
    assert_int_equal(sl_spectrum_compute(graph, 5, NULL, &whole), SL_OK);
    int32_t *place = malloc((size_t)mesh->nf * sizeof *place), *face = malloc((size_t)mesh->nf * sizeof *face);
    int32_t *rank = malloc((size_t)mesh->nf * sizeof *rank), count = 0;
    for (int32_t k = 0; k < whole->n; k++) {
        place[whole->perm[k]] = k;
    }
    for (int32_t f = mesh->nf / 3; f < mesh->nf; f++) {
        rank[count] = place[graph->node[f]];
        face[count++] = f;
    }
    assert_int_equal(sl_facet_graph_create(mesh, face, count, NULL, &half), SL_OK);
    sl_spectrum_def def = sl_spectrum_default();
    def.count = 12;
    assert_int_equal(sl_spectrum_solve(half, &def, NULL, &fresh), SL_OK);
    def.rank = rank;
    assert_int_equal(sl_spectrum_solve(half, &def, NULL, &inherited), SL_OK);
    for (int32_t k = 0; k < 12; k++) {
        assert_true(test_near(inherited->lambda[k], fresh->lambda[k], 1e-9));
    }
    for (int32_t k = 1; k < half->graph.n; k++) {
        assert_true(rank[inherited->perm[k - 1]] < rank[inherited->perm[k]]);
    }
    assert_true(largest_residual(&half->graph, inherited) < 1e-6);
    sl_spectrum_free(inherited);
    rank[7] = -1;
    assert_int_equal(sl_spectrum_solve(half, &def, NULL, &inherited), SL_BAD_INPUT);
    assert_null(inherited);
    sl_spectrum_free(whole);
    sl_spectrum_free(fresh);
    sl_facet_graph_free(half);
    sl_facet_graph_free(graph);
    sl_mesh_free(mesh);
    free(place);
    free(face);
    free(rank);
}

static bool cancel(void *user, const char *stage, double fraction)
{
    (void)user;
    (void)stage;
    (void)fraction;
    return false;
}

static void a_cancelled_spectrum_is_not_delivered(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0xca);
    sl_mesh *mesh = test_torus_mesh(&rng, 60, 40, 0.4, TEST_TRIANGLES); /* past the size that is solved densely */
    sl_facet_graph *graph = test_whole_graph(mesh, NULL);
    sl_spectrum *s = (sl_spectrum *)&rng;
    const sl_context context = {.progress = cancel};
    assert_int_equal(sl_spectrum_compute(graph, 30, &context, &s), SL_CANCELLED);
    assert_null(s);
    sl_spectrum_free(s);
    sl_facet_graph_free(graph);
    sl_mesh_free(mesh);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(smallest_eigenvalues_agree_with_the_dense_solver),
        cmocka_unit_test(count_is_clipped_to_the_number_of_nodes),
        cmocka_unit_test(every_component_has_its_own_null_vector),
        cmocka_unit_test(signs_are_those_of_the_precise_spectrum),
        cmocka_unit_test(the_definition_sets_count_mode_and_tolerance),
        cmocka_unit_test(bands_give_the_pairs_of_a_single_run),
        cmocka_unit_test(a_memory_limit_is_kept_or_refused),
        cmocka_unit_test(a_part_inherits_the_order_of_the_whole),
        cmocka_unit_test(a_cancelled_spectrum_is_not_delivered),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
