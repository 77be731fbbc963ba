#include "sparse/order.h"

#include "base/memory.h"
#include "sparse/dissection.h"

#include <math.h>
#include <string.h>
#include <suitesparse/camd.h>

/* Both triangles of A's pattern without the diagonal. */
static sl_status adjacency_of(const sl_csc *A, sl_adjacency *graph)
{
    const int32_t n = A->ncols;
    int64_t *next = NULL;
    sl_status status = SL_OK;
    *graph = (sl_adjacency){.n = n};
    graph->first = sl_calloc((int64_t)n + 1, sizeof *graph->first);
    graph->adj = sl_alloc(2 * (A->colptr[n] - n), sizeof *graph->adj);
    if (graph->first == NULL || graph->adj == NULL) {
        status = SL_OUT_OF_MEMORY;
        goto cleanup;
    }
    for (int32_t j = 0; j < n; j++) {
        for (int64_t p = A->colptr[j] + 1; p < A->colptr[j + 1]; p++) {
            graph->first[j + 1]++;
            graph->first[A->row[p] + 1]++;
        }
    }
    for (int32_t i = 0; i < n; i++) {
        graph->first[i + 1] += graph->first[i];
    }
    next = sl_copy(graph->first, n, sizeof *next);
    if (next == NULL) {
        status = SL_OUT_OF_MEMORY;
        goto cleanup;
    }
    for (int32_t j = 0; j < n; j++) {
        for (int64_t p = A->colptr[j] + 1; p < A->colptr[j + 1]; p++) {
            graph->adj[next[j]++] = A->row[p];
            graph->adj[next[A->row[p]]++] = j;
        }
    }
cleanup:
    sl_free(next);
    return status;
}

/* piece: CAMD eliminates smaller numbers first; NULL = no constraint. */
static sl_status order_by_camd(const sl_adjacency *graph, const int32_t *piece, int32_t *perm)
{
    const int32_t n = graph->n;
    if (graph->first[n] > INT32_MAX) {
        return SL_OUT_OF_MEMORY; /* CAMD's indices are ints */
    }
    int32_t *first = sl_alloc((int64_t)n + 1, sizeof *first);
    if (first == NULL) {
        return SL_OUT_OF_MEMORY;
    }
    for (int32_t i = 0; i <= n; i++) {
        first[i] = (int32_t)graph->first[i];
    }
    const int outcome = camd_order(n, first, graph->adj, perm, NULL, NULL, piece);
    sl_free(first);
    return outcome == CAMD_OUT_OF_MEMORY ? SL_OUT_OF_MEMORY : outcome >= CAMD_OK ? SL_OK : SL_INTERNAL;
}

static bool all_finite(const double *x, int64_t count)
{
    for (int64_t k = 0; k < count; k++) {
        if (!isfinite(x[k])) {
            return false;
        }
    }
    return true;
}

static sl_status order_by_dissection(const sl_adjacency *graph, const double *xyz, const sl_context *context,
                                     int32_t *perm)
{
    int32_t *piece = sl_alloc(graph->n, sizeof *piece);
    sl_status status = piece != NULL ? SL_OK : SL_OUT_OF_MEMORY;
    SL_TRY(status);
    bool complete;
    SL_TRY(sl_dissect(graph, xyz, context, piece, perm));
    SL_TRY(sl_order_leaves(graph, piece, context, perm, &complete));
    if (!complete) {
        SL_TRY(order_by_camd(graph, piece, perm));
    }
cleanup:
    sl_free(piece);
    return status;
}

sl_status sl_order_with(const sl_csc *A, sl_ordering ordering, const double *xyz, const sl_context *context,
                        int32_t *perm)
{
    sl_adjacency graph = {0};
    sl_status status = SL_OK;
    SL_TRY(sl_csc_check_pattern(A, true));
    if (xyz != NULL && !all_finite(xyz, 3 * (int64_t)A->ncols)) {
        status = SL_BAD_INPUT;
        goto cleanup;
    }
    if (ordering == SL_ORDER_NATURAL || A->ncols == 0) {
        for (int32_t k = 0; k < A->ncols; k++) {
            perm[k] = k;
        }
        goto cleanup;
    }
    SL_TRY(adjacency_of(A, &graph));
    const bool whole = ordering == SL_ORDER_CAMD || (ordering == SL_ORDER_AUTO && xyz == NULL);
    SL_TRY(whole ? order_by_camd(&graph, NULL, perm) : order_by_dissection(&graph, xyz, context, perm));
cleanup:
    sl_adjacency_clear(&graph);
    return status;
}

sl_status sl_order(const sl_csc *A, sl_ordering ordering, const double *xyz, int32_t *perm)
{
    return sl_order_with(A, ordering, xyz, NULL, perm);
}

sl_status sl_order_inherit(int32_t parent_n, const int32_t *parent_perm, int32_t count, const int32_t *subset,
                           int32_t *perm)
{
    sl_status status = SL_OK;
    int32_t placed = 0, *child = NULL; /* an unknown of the parent in the child's numbering, -1 = not in it */
    SL_TRY(parent_n >= 0 && count >= 0 && count <= parent_n ? SL_OK : SL_BAD_INPUT);
    child = sl_alloc(parent_n, sizeof *child);
    SL_TRY(child != NULL ? SL_OK : SL_OUT_OF_MEMORY);
    memset(child, -1, (size_t)parent_n * sizeof *child);
    for (int32_t i = 0; i < count; i++) {
        SL_TRY(subset[i] >= 0 && subset[i] < parent_n && child[subset[i]] == -1 ? SL_OK : SL_BAD_INPUT);
        child[subset[i]] = i;
    }
    for (int32_t k = 0; k < parent_n; k++) {
        SL_TRY(parent_perm[k] >= 0 && parent_perm[k] < parent_n ? SL_OK : SL_BAD_INPUT);
        if (child[parent_perm[k]] != -1) {
            perm[placed++] = child[parent_perm[k]];
            child[parent_perm[k]] = -1; /* once */
        }
    }
    SL_TRY(placed == count ? SL_OK : SL_BAD_INPUT);
cleanup:
    sl_free(child);
    return status;
}

/* Digits of the radix sort by rank. */
enum { DIGIT_BITS = 11, DIGITS = 3, BUCKETS = 1 << DIGIT_BITS };

/* Stable counting sort of `from` by one digit of the ranks. */
static void sort_by_digit(int32_t count, const int32_t *rank, int digit, const int32_t *from, int32_t *to)
{
    int32_t next[BUCKETS] = {0}, sum = 0;
    for (int32_t k = 0; k < count; k++) {
        next[rank[k] >> digit * DIGIT_BITS & (BUCKETS - 1)]++;
    }
    for (int32_t b = 0; b < BUCKETS; b++) {
        const int32_t size = next[b];
        next[b] = sum;
        sum += size;
    }
    for (int32_t k = 0; k < count; k++) {
        to[next[rank[from[k]] >> digit * DIGIT_BITS & (BUCKETS - 1)]++] = from[k];
    }
}

sl_status sl_order_by_rank(int32_t count, const int32_t *rank, int32_t *perm)
{
    int32_t *spare = sl_alloc(count, sizeof *spare);
    sl_status status = SL_OK;
    SL_TRY(spare != NULL ? SL_OK : SL_OUT_OF_MEMORY);
    for (int32_t k = 0; k < count; k++) {
        SL_TRY(rank[k] >= 0 ? SL_OK : SL_BAD_INPUT);
        spare[k] = k;
    }
    sort_by_digit(count, rank, 0, spare, perm);
    sort_by_digit(count, rank, 1, perm, spare);
    sort_by_digit(count, rank, DIGITS - 1, spare, perm);
cleanup:
    sl_free(spare);
    return status;
}
