/* L and its two blocks under a mirror. */
#include "base/memory.h"
#include "spectral/spectrum.h"
#include "theorem/theorem_internal.h"

#include <math.h>

/* Triplets of a lower triangle. */
typedef struct triplets {
    int32_t *row, *col;
    double *val;
    int64_t count;
} triplets;

static sl_status triplets_create(int64_t room, triplets *t)
{
    *t = (triplets){sl_alloc(room, sizeof *t->row), sl_alloc(room, sizeof *t->col), sl_alloc(room, sizeof *t->val), 0};
    return t->row != NULL && t->col != NULL && t->val != NULL ? SL_OK : SL_OUT_OF_MEMORY;
}

static void triplets_clear(triplets *t)
{
    sl_free(t->row);
    sl_free(t->col);
    sl_free(t->val);
}

/* An entry of a symmetric matrix met from its row i: the upper triangle is skipped, its twin is met from row j. */
static void put(triplets *t, int32_t i, int32_t j, double value)
{
    if (i >= j) {
        t->row[t->count] = i;
        t->col[t->count] = j;
        t->val[t->count++] = value;
    }
}

sl_status sl_matrix_whole(const sl_theorem_graph *graph, sl_csc **out)
{
    return sl_laplacian_create(&graph->graph, out);
}

/* T = D' - A' + A'' from the rows of half 1. */
sl_status sl_matrix_antisymmetric(const sl_theorem_graph *graph, sl_csc **out)
{
    const sl_graph *g = &graph->graph;
    const int32_t n = graph->pairs;
    triplets t = {0};
    sl_status status = SL_OK;
    *out = NULL;
    SL_TRY(triplets_create((int64_t)n + g->first[n], &t));
    for (int32_t i = 0; i < n; i++) {
        put(&t, i, i, (double)(g->first[i + 1] - g->first[i]));
        for (int32_t p = g->first[i]; p < g->first[i + 1]; p++) {
            const int32_t j = g->adj[p];
            if (j < 2 * n) {
                put(&t, i, j < n ? j : j - n, j < n ? -1.0 : 1.0);
            }
        }
    }
    SL_TRY(sl_csc_from_triplets(n, n, t.count, t.row, t.col, t.val, out));
cleanup:
    triplets_clear(&t);
    return status;
}

/* S: D' - A' - A'' on the pairs, -sqrt 2 B between pairs and fixed nodes, D - C on the fixed nodes. */
sl_status sl_matrix_symmetric(const sl_theorem_graph *graph, sl_csc **out)
{
    const sl_graph *g = &graph->graph;
    const int32_t n = graph->pairs, order = n + graph->fixed;
    triplets t = {0};
    sl_status status = SL_OK;
    *out = NULL;
    SL_TRY(triplets_create((int64_t)order + g->first[g->n], &t));
    for (int32_t i = 0; i < order; i++) {
        const int32_t node = i < n ? i : i + n;
        put(&t, i, i, (double)(g->first[node + 1] - g->first[node]));
        for (int32_t p = g->first[node]; p < g->first[node + 1]; p++) {
            const int32_t j = g->adj[p];
            if (i >= n && j >= n && j < 2 * n) {
                continue; /* the spoke to half 2 is the image of that to half 1 */
            }
            const bool spoke = (i >= n) != (j >= 2 * n);
            put(&t, i, j < n ? j : j - n, spoke ? -sqrt(2.0) : -1.0);
        }
    }
    SL_TRY(sl_csc_from_triplets(order, order, t.count, t.row, t.col, t.val, out));
cleanup:
    triplets_clear(&t);
    return status;
}

sl_status sl_matrix_block(const sl_csc *antisymmetric, const int32_t *pair, int32_t count, const int32_t *place,
                          sl_csc **out)
{
    int64_t entries = 0;
    *out = NULL;
    for (int32_t k = 0; k < count; k++) {
        entries += antisymmetric->colptr[pair[k] + 1] - antisymmetric->colptr[pair[k]];
    }
    sl_csc *A = NULL;
    const sl_status status = sl_csc_create(count, count, entries, &A);
    if (status != SL_OK) {
        return status;
    }
    int64_t at = 0;
    for (int32_t k = 0; k < count; k++) { /* ascending pairs keep the rows sorted; a block has no entries outside */
        A->colptr[k] = at;
        for (int64_t p = antisymmetric->colptr[pair[k]]; p < antisymmetric->colptr[pair[k] + 1]; p++) {
            A->row[at] = place[antisymmetric->row[p]];
            A->val[at++] = antisymmetric->val[p];
        }
    }
    A->colptr[count] = at;
    *out = A;
    return SL_OK;
}
