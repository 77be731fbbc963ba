/* What the statements about blocks of the half share; internal to the room.
 * Layer: theorem. */
#ifndef SL_THEOREM_BLOCKS_INTERNAL_H
#define SL_THEOREM_BLOCKS_INTERNAL_H

#include "theorem/theorem_internal.h"

/* One component of the half. */
typedef struct sl_block {
    int32_t component;
    int32_t *pair, count; /* its pairs, ascending; borrowed */
    const sl_pairs *pairs;
    sl_pairs own; /* where the block is not the whole half */
} sl_block;

/* What the statements share for one graph. */
typedef struct sl_blocks_work {
    const sl_theorem_graph *graph;
    const sl_half *half;
    const sl_solution *solution;
    const sl_theorem_def *def;
    sl_theorem_result *result;
    int32_t *pair, *place; /* pairs by component, and where each stands in its component */
    uint8_t *side;         /* nodes */
    double *vector;        /* nodes */
    sl_theorem_verdict half_verdict, whole_verdict, crossed_verdict;
    bool any_half, any_whole, any_crossed;
} sl_blocks_work;

static inline void sl_worsen(sl_theorem_verdict *verdict, sl_theorem_verdict by)
{
    *verdict = by > *verdict ? by : *verdict;
}

/* Signs read from a vector: how many are within the bound, and whether two beyond it differ. */
typedef struct sl_sign_count {
    int32_t undecided;
    bool mixed;
} sl_sign_count;

sl_sign_count sl_count_signs(const double *value, int32_t count, double bound);

/* lowest.c: statements 4 and 5 for a balanced block. */
SL_NODISCARD sl_status sl_state_half(sl_blocks_work *w, const sl_block *b);
SL_NODISCARD sl_status sl_state_whole(sl_blocks_work *w, const sl_block *b);

#endif
