/* Elimination trees and the counts that follow from them; internal to the room. Nothing here allocates.
 * Layer: sparse. */
#ifndef SL_SPARSE_ELIMINATION_H
#define SL_SPARSE_ELIMINATION_H

#include "sparse/csc.h"

/* Half of a symmetric pattern without the diagonal, by rows of P A P': upper: row k lists columns i < k;
 * lower: column k lists rows i > k. */
typedef struct sl_half {
    int64_t *first; /* n + 1 */
    int32_t *index; /* nnz(A) - n */
} sl_half;

/* Fills half from A (lower triangle) under the inverse permutation place: place[row of A] = row of P A P'. next: n. */
void sl_half_upper(const sl_csc *A, const int32_t *place, int64_t *next, sl_half *half);
void sl_half_lower(const sl_csc *A, const int32_t *place, int64_t *next, sl_half *half);

/* parent[k] = first row below k in column k of L, -1 for roots. ancestor: n, workspace. Source: Liu 1986. */
void sl_elimination_tree(int32_t n, const sl_half *upper, int32_t *parent, int32_t *ancestor);

/* post[k] = k-th node of a postorder of the forest, children in ascending order. work: 3 n. */
void sl_postorder(int32_t n, const int32_t *parent, int32_t *post, int32_t *work);

/* count[k] = entries of column k of L, diagonal included. Nodes must be in postorder. work: 4 n.
 * Source: Gilbert, Ng, Peyton 1994, Fig. 3. */
void sl_column_counts(int32_t n, const sl_half *lower, const int32_t *parent, int32_t *count, int32_t *work);

#endif
