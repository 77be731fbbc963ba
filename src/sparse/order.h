/* Fill-reducing orderings of symmetric matrices.
 * Layer: sparse. */
#ifndef SL_SPARSE_ORDER_H
#define SL_SPARSE_ORDER_H

#include "base/context.h"
#include "sparse/csc.h"

typedef enum sl_ordering {
    SL_ORDER_AUTO, /* nested dissection when points are given, CAMD of the whole otherwise */
    SL_ORDER_NATURAL,
    SL_ORDER_CAMD,             /* constrained approximate minimum degree of the whole */
    SL_ORDER_NESTED_DISSECTION /* separators from coordinates (or from the graph when there are none), CAMD in the
                                  leaves */
} sl_ordering;

/* perm[k] = row of A eliminated k-th; length n. A: lower triangle (pattern only). xyz: n x 3, a point per unknown, or
 * NULL. SL_BAD_INPUT, SL_OUT_OF_MEMORY. Deterministic. O(n log n + nnz) for nested dissection. Source: George 1973;
 * Miller, Teng, Thurston, Vavasis 1997 for geometric separators. */
SL_NODISCARD sl_status sl_order(const sl_csc *A, sl_ordering ordering, const double *xyz, int32_t *perm);

/* The same by workers (nullable): the same bytes for any number of them. */
SL_NODISCARD sl_status sl_order_with(const sl_csc *A, sl_ordering ordering, const double *xyz,
                                     const sl_context *context, int32_t *perm);

/* The ordering of a part of a larger problem, cut down from the whole's: perm[k] = the part's unknown eliminated k-th.
 * parent_perm: length parent_n; subset[i]: the parent's unknown that the part's unknown i is, each at most once;
 * perm: length count. SL_BAD_INPUT (no permutation, subset out of range or repeated), SL_OUT_OF_MEMORY. O(parent_n). */
SL_NODISCARD sl_status sl_order_inherit(int32_t parent_n, const int32_t *parent_perm, int32_t count,
                                        const int32_t *subset, int32_t *perm);

/* perm[k] = the unknown of k-th smallest rank (ranks >= 0, equal ones by number): the ordering of a part, where the
 * whole gave each of its unknowns the place it has in its own. No O(parent_n) in it, so the parts of a recursion may do
 * it each for itself. SL_BAD_INPUT (a rank below 0), SL_OUT_OF_MEMORY. O(count). */
SL_NODISCARD sl_status sl_order_by_rank(int32_t count, const int32_t *rank, int32_t *perm);

#endif
