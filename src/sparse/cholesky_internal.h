/* What analysis, factorisation and solves share; internal to the room.
 * Layer: sparse. */
#ifndef SL_SPARSE_CHOLESKY_INTERNAL_H
#define SL_SPARSE_CHOLESKY_INTERNAL_H

#include "sparse/cholesky.h"
#include "sparse/kernels.h"

/* Right-hand sides are solved for in groups of this many: their rows fill two cache lines, and L comes from memory once
 * for both. */
#define SL_SOLVE_WIDTH 16

/* Memory of one walk over the fronts. */
typedef struct sl_front_space {
    double *updates; /* stacks of update matrices */
    double *spare;   /* of the kernels */
} sl_front_space;

/* Supernode s owns columns first[s] .. first[s + 1] - 1 of L. Its panel (laid out as kernels.h says) has one row for
 * each of these columns, then one for each of below[below_first[s]] .. below[below_first[s + 1] - 1], ascending.
 * Supernodes are numbered from the leaves up: first those of the bottom part, then those of the top, either in
 * postorder; walk lists them in a postorder of the whole tree. */
struct sl_cholesky {
    int32_t n;
    int32_t block;         /* of so many columns; supernodes and the rows below them are made of whole ones */
    int64_t pattern_nnz;   /* of A's lower triangle */
    uint64_t pattern_hash; /* so that values are not put into another pattern */
    double pivot_rtol;
    sl_factor_kind kind;
    const sl_kernels *kernels;
    int32_t *perm;  /* n: row k of P A P' is row perm[k] of A */
    int32_t *place; /* n: its inverse */

    int32_t supernodes;
    int32_t bottom;       /* supernodes of the bottom part */
    int32_t *first;       /* supernodes + 1 */
    int32_t *parent;      /* supernodes: -1 for roots */
    int32_t *walk;        /* supernodes */
    int64_t *below_first; /* supernodes + 1 */
    int32_t *below;       /* -1 - k for the k-th row outside of the supernode's task */
    int32_t *relative;    /* like below: the same rows as numbers within the panel of the parent; none of a root's */
    int64_t *panel;       /* supernodes + 1: where a panel begins in L */
    double *L;            /* NULL before the first factorisation */
    int8_t *sign;         /* n: signs of D, NULL for LL' or before the first factorisation */
    sl_front_space space; /* of sl_cholesky_reserve; updates == NULL: none */

    /* Entries of A by supernode: those of s are entry_first[s] .. entry_first[s + 1] - 1, entry_from[e] their place in
     * A, entry_to[e] their place in the panel. Those in the panel's first column come first. */
    int64_t *entry_first; /* supernodes + 1 */
    int32_t *entry_from;
    int32_t *entry_to;

    int32_t max_width;  /* columns of the widest supernode */
    int32_t max_below;  /* rows of the largest update matrix */
    int64_t max_panel;  /* doubles of the largest panel */
    int64_t max_update; /* doubles of the stack of update matrices at its highest */
    int32_t *child;     /* supernodes: last child in the walk, -1 = leaf */
    int32_t *sibling;   /* supernodes: next child of the same parent, backwards in the walk */
    bool *odd;          /* supernodes: at odd depth in the tree */

    /* Task t: the subtree walk[task_begin[t]] .. walk[task_end[t] - 1], the root last. Its columns touch no other
     * task's; outside[outside_first[t]] .. are the rows below its root, where its updates of the crown go. */
    int32_t task_count;
    int32_t *task; /* supernodes: -1 = crown */
    int32_t *task_begin, *task_end;
    int64_t *outside_first; /* task_count + 1 */
    int32_t *outside;
};

/* Of the pointers and rows of A; what it is may change from one build to the next. */
uint64_t sl_pattern_hash(const sl_csc *A);

static inline int32_t sl_supernode_width(const sl_cholesky *F, int32_t s)
{
    return F->first[s + 1] - F->first[s];
}

static inline int32_t sl_supernode_below(const sl_cholesky *F, int32_t s)
{
    return (int32_t)(F->below_first[s + 1] - F->below_first[s]);
}

#endif
