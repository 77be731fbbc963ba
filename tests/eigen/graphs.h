/* Graphs whose Laplacian spectra are known, or rich in multiplicities. */
#ifndef SL_TEST_EIGEN_GRAPHS_H
#define SL_TEST_EIGEN_GRAPHS_H

#include "base/memory.h"
#include "sparse/csc.h"
#include "support/test_support.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

typedef struct graph {
    int32_t n;
    int64_t count;
    int32_t (*edge)[2];
} graph;

static inline graph graph_create(int32_t n, int64_t room)
{
    graph g = {n, 0, sl_alloc(room, sizeof *g.edge)};
    assert_non_null(g.edge);
    return g;
}

static inline void graph_join(graph *g, int32_t a, int32_t b)
{
    g->edge[g->count][0] = a;
    g->edge[g->count++][1] = b;
}

/* Laplacian D - A of a graph with the edges' weights (NULL = 1); frees the graph. */
static inline sl_csc *graph_laplacian(graph *g, const double *weight)
{
    const int64_t count = 3 * g->count + g->n;
    int32_t *row = sl_alloc(count, sizeof *row), *col = sl_alloc(count, sizeof *col);
    double *val = sl_alloc(count, sizeof *val);
    assert_true(row && col && val);
    int64_t k = 0;
    for (int32_t i = 0; i < g->n; i++, k++) {
        row[k] = col[k] = i;
        val[k] = 0.0;
    }
    for (int64_t e = 0; e < g->count; e++) {
        const int32_t a = g->edge[e][0], b = g->edge[e][1];
        const double w = weight != NULL ? weight[e] : 1.0;
        const int32_t rows[3] = {a, b, a > b ? a : b}, cols[3] = {a, b, a > b ? b : a};
        const double vals[3] = {w, w, -w};
        for (int t = 0; t < 3; t++, k++) {
            row[k] = rows[t];
            col[k] = cols[t];
            val[k] = vals[t];
        }
    }
    sl_csc *A = NULL;
    assert_int_equal(sl_csc_from_triplets(g->n, g->n, k, row, col, val, &A), SL_OK);
    sl_free(row);
    sl_free(col);
    sl_free(val);
    sl_free(g->edge);
    return A;
}

static inline sl_csc *path_laplacian(int32_t n, bool closed)
{
    graph g = graph_create(n, n);
    for (int32_t i = 1; i < n; i++) {
        graph_join(&g, i - 1, i);
    }
    if (closed) {
        graph_join(&g, n - 1, 0);
    }
    return graph_laplacian(&g, NULL);
}

static inline sl_csc *grid_laplacian(int32_t w, int32_t h, bool closed)
{
    graph g = graph_create(w * h, 2 * (int64_t)w * h);
    for (int32_t y = 0; y < h; y++) {
        for (int32_t x = 0; x < w; x++) {
            if (closed || x + 1 < w) {
                graph_join(&g, y * w + x, y * w + (x + 1) % w);
            }
            if (closed || y + 1 < h) {
                graph_join(&g, y * w + x, (y + 1) % h * w + x);
            }
        }
    }
    return graph_laplacian(&g, NULL);
}

static inline int compare_doubles(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

/* 2 - 2 cos(pi k / n), k = 0 .. n - 1 (path) or 2 - 2 cos(2 pi k / n) (cycle); the caller frees. */
static inline double *path_spectrum(int32_t n, bool closed)
{
    double *lambda = sl_alloc(n, sizeof *lambda);
    assert_non_null(lambda);
    for (int32_t k = 0; k < n; k++) {
        const double s = sin((closed ? TEST_PI : TEST_PI / 2.0) * k / n);
        lambda[k] = 4.0 * s * s;
    }
    qsort(lambda, (size_t)n, sizeof *lambda, compare_doubles);
    return lambda;
}

/* Sums of the two paths' or cycles' values; the caller frees. */
static inline double *grid_spectrum(int32_t w, int32_t h, bool closed)
{
    double *a = path_spectrum(w, closed), *b = path_spectrum(h, closed), *lambda = sl_alloc((int64_t)w * h, sizeof *a);
    assert_non_null(lambda);
    for (int32_t k = 0; k < w * h; k++) {
        lambda[k] = a[k % w] + b[k / w];
    }
    qsort(lambda, (size_t)w * (size_t)h, sizeof *lambda, compare_doubles);
    sl_free(a);
    sl_free(b);
    return lambda;
}

/* Quads of a cube's surface, side x side a face; joined across edges. Found by matching positions of edges' midpoints.
 */
typedef struct facet_edge {
    int64_t key;
    int32_t facet;
} facet_edge;

static inline int compare_facet_edges(const void *va, const void *vb)
{
    const facet_edge *a = va, *b = vb;
    return a->key != b->key ? (a->key > b->key) - (a->key < b->key) : a->facet - b->facet;
}

/* Dual graph of facets given the keys of their edges (equal keys twice = a shared edge); sorts the edges. */
static inline sl_csc *dual_laplacian(int32_t facets, facet_edge *edges, int32_t count)
{
    graph g = graph_create(facets, count);
    qsort(edges, (size_t)count, sizeof *edges, compare_facet_edges);
    for (int32_t k = 1; k < count; k++) {
        if (edges[k].key == edges[k - 1].key) {
            graph_join(&g, edges[k - 1].facet, edges[k].facet);
        }
    }
    return graph_laplacian(&g, NULL);
}

static inline sl_csc *cube_facet_laplacian(int32_t side)
{
    const int32_t facets = 6 * side * side, span = 4 * side + 4;
    facet_edge *edges = sl_alloc(4 * (int64_t)facets, sizeof *edges);
    assert_non_null(edges);
    for (int32_t f = 0; f < facets; f++) {
        const int32_t face = f / (side * side), x = f % side, y = f / side % side;
        for (int32_t e = 0; e < 4; e++) {
            const int32_t u = 2 * x + 1 + (e == 0 ? -1 : e == 1 ? 1 : 0);
            const int32_t v = 2 * y + 1 + (e == 2 ? -1 : e == 3 ? 1 : 0);
            int64_t p[3];
            p[face / 2] = face % 2 == 0 ? 0 : 2 * side;
            p[(face / 2 + 1) % 3] = u;
            p[(face / 2 + 2) % 3] = v;
            edges[4 * f + e] = (facet_edge){(p[0] * span + p[1]) * span + p[2], f};
        }
    }
    sl_csc *A = dual_laplacian(facets, edges, 4 * facets);
    sl_free(edges);
    return A;
}

/* Facets of an icosahedron split 4-to-1 `levels` times: vertices are named by the edges that bore them. */
static inline sl_csc *icosphere_facet_laplacian(int32_t levels)
{
    static const int32_t ico[20][3] = {{0, 1, 2},  {0, 2, 3},  {0, 3, 4},  {0, 4, 5},   {0, 5, 1},
                                       {1, 6, 2},  {2, 6, 7},  {2, 7, 3},  {3, 7, 8},   {3, 8, 4},
                                       {4, 8, 9},  {4, 9, 5},  {5, 9, 10}, {5, 10, 1},  {1, 10, 6},
                                       {11, 7, 6}, {11, 8, 7}, {11, 9, 8}, {11, 10, 9}, {11, 6, 10}};
    int32_t facets = 20, vertices = 12;
    int32_t *corner = sl_copy(ico, 60, sizeof *corner);
    assert_non_null(corner);
    for (int32_t level = 0; level <= levels; level++) {
        facet_edge *edges = sl_alloc(3 * (int64_t)facets, sizeof *edges);
        int32_t *middle = sl_alloc(3 * (int64_t)facets, sizeof *middle), *finer = NULL;
        assert_true(edges && middle);
        for (int32_t c = 0; c < 3 * facets; c++) {
            const int32_t a = corner[c], b = corner[c / 3 * 3 + (c + 1) % 3];
            edges[c] = (facet_edge){(int64_t)(a < b ? a : b) << 32 | (a < b ? b : a), level == levels ? c / 3 : c};
        }
        if (level == levels) {
            sl_csc *A = dual_laplacian(facets, edges, 3 * facets);
            sl_free(edges);
            sl_free(middle);
            sl_free(corner);
            return A;
        }
        qsort(edges, 3 * (size_t)facets, sizeof *edges, compare_facet_edges);
        for (int32_t k = 0; k < 3 * facets; k++) {
            middle[edges[k].facet] = k > 0 && edges[k].key == edges[k - 1].key ? vertices - 1 : vertices++;
        }
        finer = sl_alloc(12 * (int64_t)facets, sizeof *finer);
        assert_non_null(finer);
        for (int32_t f = 0; f < facets; f++) {
            const int32_t *v = corner + 3 * f, *m = middle + 3 * f;
            const int32_t split[12] = {v[0], m[0], m[2], v[1], m[1], m[0], v[2], m[2], m[1], m[0], m[1], m[2]};
            memcpy(finer + 12 * f, split, sizeof split);
        }
        sl_free(corner);
        corner = finer;
        facets *= 4;
        sl_free(edges);
        sl_free(middle);
    }
    return NULL;
}

#endif
