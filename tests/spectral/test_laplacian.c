/* The Laplacian against its definition, entry by entry. */
#include "base/memory.h"
#include "spectral/shapes.h"
#include "spectral/spectrum.h"

enum { MAX_NODES = 40 };

/* A random multigraph with parallel edges and loops, and its dense adjacency (loops left out). */
static sl_graph random_multigraph(test_rng *rng, int32_t n, int32_t edges, double *A)
{
    int32_t *a = malloc((size_t)edges * sizeof *a), *b = malloc((size_t)edges * sizeof *b);
    sl_graph g = {n, sl_calloc(n + 1, sizeof *g.first), sl_alloc(2 * edges, sizeof *g.adj), NULL};
    memset(A, 0, (size_t)(n * n) * sizeof *A);
    for (int32_t e = 0; e < edges; e++) {
        a[e] = test_index(rng, n);
        b[e] = test_index(rng, 3) == 0 && e > 0 ? b[e - 1] : test_index(rng, n);
        g.first[a[e] + 1]++;
        g.first[b[e] + 1]++;
        A[a[e] * n + b[e]] += a[e] != b[e];
        A[b[e] * n + a[e]] += a[e] != b[e];
    }
    int32_t fill[MAX_NODES];
    for (int32_t i = 0; i < n; i++) {
        g.first[i + 1] += g.first[i];
        fill[i] = g.first[i];
    }
    for (int32_t e = 0; e < edges; e++) {
        g.adj[fill[a[e]]++] = b[e];
        g.adj[fill[b[e]]++] = a[e];
    }
    free(a);
    free(b);
    return g;
}

static void laplacian_is_degrees_minus_adjacency_of_any_multigraph(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0x1a91ac1a);
    for (int trial = 0; trial < 200 * test_multiplier(); trial++) {
        const int32_t n = 1 + test_index(&rng, MAX_NODES), edges = test_index(&rng, 3 * n);
        double A[MAX_NODES * MAX_NODES], dense[MAX_NODES * MAX_NODES] = {0};
        sl_graph g = random_multigraph(&rng, n, edges, A);
        sl_csc *L = NULL;
        assert_int_equal(sl_laplacian_create(&g, &L), SL_OK);
        assert_int_equal(sl_csc_check(L, true), SL_OK);
        for (int32_t j = 0; j < n; j++) {
            for (int64_t p = L->colptr[j]; p < L->colptr[j + 1]; p++) {
                dense[L->row[p] * n + j] = dense[j * n + L->row[p]] = L->val[p];
            }
        }
        for (int32_t i = 0; i < n; i++) {
            double degree = 0.0;
            for (int32_t j = 0; j < n; j++) {
                degree += A[i * n + j];
                assert_true(i == j || dense[i * n + j] == -A[i * n + j]);
            }
            assert_true(dense[i * n + i] == degree);
        }
        sl_csc_free(L);
        sl_graph_clear(&g);
    }
}

static void facets_that_share_two_edges_count_twice(void **state)
{
    (void)state;
    const double xyz[] = {0.1,  0.2, 0.0, 2.3, -0.1, 0.4, 3.1, 1.2, 0.1, 2.2, 2.4,
                          -0.3, 0.4, 2.1, 0.2, -1.2, 1.1, 0.3, 0.9, 1.3, 0.5};
    const int32_t index[] = {0, 1, 2, 6, 5, 2, 3, 4, 5, 6}, first[] = {0, 5, 10}; /* vertex 6 has two edges only */
    const sl_polygons polygons = {7, 2, xyz, first, index};
    sl_diag diag = sl_diag_none();
    sl_mesh *mesh = NULL;
    assert_int_equal(sl_mesh_build(&polygons, &mesh, NULL, &diag), SL_OK);
    sl_facet_graph *graph = test_whole_graph(mesh, NULL);
    sl_csc *L = NULL;
    assert_int_equal(sl_laplacian_create(&graph->graph, &L), SL_OK);
    assert_int_equal(L->colptr[2], 3);
    assert_true(L->val[0] == 2.0 && L->val[1] == -2.0 && L->val[2] == 2.0);
    sl_csc_free(L);
    sl_facet_graph_free(graph);
    sl_mesh_free(mesh);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(laplacian_is_degrees_minus_adjacency_of_any_multigraph),
        cmocka_unit_test(facets_that_share_two_edges_count_twice),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
