/* The combinatorial Laplacian of a graph as a sparse matrix. */
#include "spectral/spectrum.h"

#include "base/memory.h"

#include <stdlib.h>

static int ascending(const void *a, const void *b)
{
    const int32_t x = *(const int32_t *)a, y = *(const int32_t *)b;
    return (x > y) - (x < y);
}

/* Rows j + 1 .. of column j with their multiplicity, after the diagonal's place. Returns the entries written. */
static int64_t write_column(const sl_graph *graph, int32_t j, int32_t *sorted, int32_t *row, double *val)
{
    const int32_t degree = graph->first[j + 1] - graph->first[j];
    int32_t below = 0, off_diagonal = 0;
    for (int32_t p = graph->first[j]; p < graph->first[j + 1]; p++) {
        off_diagonal += graph->adj[p] != j ? 1 : 0;
        if (graph->adj[p] > j) {
            sorted[below++] = graph->adj[p];
        }
    }
    SL_ASSERT(off_diagonal <= degree);
    qsort(sorted, (size_t)below, sizeof *sorted, ascending);
    int64_t n = 0;
    row[n] = j;
    val[n++] = (double)off_diagonal;
    for (int32_t k = 0; k < below; k++) {
        if (k > 0 && sorted[k] == sorted[k - 1]) {
            val[n - 1] -= 1.0;
        } else {
            row[n] = sorted[k];
            val[n++] = -1.0;
        }
    }
    return n;
}

/**
 * Laplacian D - A of a graph.
 *
 * @param[in]  graph  weights are ignored: the paper's graph is unweighted
 * @param[out] out    n x n, lower triangle with a full diagonal, owned by the caller; NULL on failure
 *
 * SL_OUT_OF_MEMORY. O(edges log degree). Loops do not count.
 * Source: Sec. 3.3.  Deviations: the sign (the paper's L = A - D is negative semidefinite).
 */
sl_status sl_laplacian_create(const sl_graph *graph, sl_csc **out)
{
    sl_status status = SL_OK;
    sl_csc *A = NULL;
    int32_t *sorted = NULL;
    *out = NULL;
    const int64_t entries = graph->first[graph->n];
    SL_TRY(sl_csc_create(graph->n, graph->n, (int64_t)graph->n + entries, &A));
    sorted = sl_alloc(entries, sizeof *sorted);
    if (sorted == NULL) {
        SL_TRY(SL_OUT_OF_MEMORY);
    }
    int64_t nnz = 0;
    for (int32_t j = 0; j < graph->n; j++) {
        A->colptr[j] = nnz;
        nnz += write_column(graph, j, sorted, A->row + nnz, A->val + nnz);
    }
    A->colptr[graph->n] = nnz;
    *out = A;
    A = NULL;
cleanup:
    sl_free(sorted);
    sl_csc_free(A);
    return status;
}
