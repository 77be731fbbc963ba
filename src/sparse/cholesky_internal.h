/* What analysis, factorisation and solves share; internal to the room.
 * Layer: sparse. */
#ifndef SL_SPARSE_CHOLESKY_INTERNAL_H
#define SL_SPARSE_CHOLESKY_INTERNAL_H

#include "sparse/cholesky.h"

/* Right-hand sides are solved for in groups of this many: their rows fill a cache line. */
#define SL_SOLVE_WIDTH 8

/* Supernode s owns columns first[s] .. first[s + 1] - 1 of L. Its panel is column-major: one row for each of these
 * columns, then one for each of below[below_first[s]] .. below[below_first[s + 1] - 1], ascending. Supernodes are in
 * postorder. */
struct sl_cholesky {
    int32_t n;
    int64_t pattern_nnz;   /* of A's lower triangle */
    uint64_t pattern_hash; /* so that values are not put into another pattern */
    double pivot_rtol;
    int32_t *perm; /* n: row k of P A P' is row perm[k] of A */

    int32_t supernodes;
    int32_t *first;       /* supernodes + 1 */
    int32_t *parent;      /* supernodes: -1 for roots */
    int64_t *below_first; /* supernodes + 1 */
    int32_t *below;
    int64_t *panel; /* supernodes + 1: where a panel begins in L */
    double *L;
    int64_t *target;   /* pattern_nnz: where an entry of A belongs in L */
    int32_t max_below; /* rows below the widest update matrix */

    double *updates;   /* stack of update matrices, room for the deepest */
    int32_t *relative; /* max_below: a child's rows in its parent's numbering */
    int32_t *local;    /* n: a row's number in the supernode at hand */
    int32_t *child;    /* supernodes: last child, -1 = leaf */
    int32_t *sibling;  /* supernodes: next child of the same parent */
};

/* FNV-1a over the pointers and rows of A. */
static inline uint64_t sl_pattern_hash(const sl_csc *A)
{
    uint64_t hash = 0xcbf29ce484222325u;
    for (int32_t j = 0; j < A->ncols; j++) {
        hash = (hash ^ (uint64_t)A->colptr[j + 1]) * 0x100000001b3u;
        for (int64_t p = A->colptr[j]; p < A->colptr[j + 1]; p++) {
            hash = (hash ^ (uint64_t)A->row[p]) * 0x100000001b3u;
        }
    }
    return hash;
}

static inline int32_t sl_supernode_width(const sl_cholesky *F, int32_t s)
{
    return F->first[s + 1] - F->first[s];
}

static inline int32_t sl_supernode_below(const sl_cholesky *F, int32_t s)
{
    return (int32_t)(F->below_first[s + 1] - F->below_first[s]);
}

#endif
