/* Random graphs in compressed rows, for the tests of this folder. */
#ifndef SL_TEST_RANDOM_GRAPH_H
#define SL_TEST_RANDOM_GRAPH_H

#include "base/memory.h"
#include "graph/csr.h"
#include "support/test_support.h"

typedef struct test_edge {
    int32_t a, b;
    double weight;
} test_edge;

/* The graph with these edges, each in both rows (a loop twice in its own). */
static inline sl_graph test_graph_from_edges(int32_t n, const test_edge *edge, int32_t edges)
{
    sl_graph g = {n, sl_calloc((int64_t)n + 2, sizeof(int32_t)), sl_alloc(2 * (int64_t)edges, sizeof(int32_t)),
                  sl_alloc(2 * (int64_t)edges, sizeof(double))};
    assert_true(g.first != NULL && g.adj != NULL && g.weight != NULL);
    for (int32_t e = 0; e < edges; e++) {
        g.first[edge[e].a + 2 <= n ? edge[e].a + 2 : n + 1]++;
        g.first[edge[e].b + 2 <= n ? edge[e].b + 2 : n + 1]++;
    }
    for (int32_t i = 0; i < n; i++) {
        g.first[i + 2] += g.first[i + 1];
    }
    for (int32_t e = 0; e < edges; e++) {
        const int32_t at_a = g.first[edge[e].a + 1]++;
        g.adj[at_a] = edge[e].b;
        g.weight[at_a] = edge[e].weight;
        const int32_t at_b = g.first[edge[e].b + 1]++;
        g.adj[at_b] = edge[e].a;
        g.weight[at_b] = edge[e].weight;
    }
    return g;
}

/* Uniform random ends: parallel edges and loops occur. Weights: whole numbers in [0, whole) or, if that is 0, uniform
 * in [0.01, 3). */
static inline void test_random_edges(test_rng *rng, int32_t n, int32_t whole, test_edge *edge, int32_t edges)
{
    for (int32_t e = 0; e < edges; e++) {
        edge[e].a = test_index(rng, n);
        edge[e].b = test_index(rng, n);
        edge[e].weight = whole > 0 ? test_index(rng, whole) : test_uniform(rng, 0.01, 3.0);
    }
}

#endif
