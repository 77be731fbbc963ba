/* Cutting: the candidates of all charts, and the choice among them.
 * Layer: optimize (private). */
#ifndef SL_OPTIMIZE_CUT_INTERNAL_H
#define SL_OPTIMIZE_CUT_INTERNAL_H

#include "optimize/optimize_internal.h"

/* The candidates of all charts, those of a chart until it changes. */
typedef struct sl_opt_pool {
    sl_opt_trial *trial;
    int32_t *stamp; /* of the chart that each is for */
    int64_t count, capacity, stamp_capacity;
    int32_t next_stamp; /* charts with lower ones have their candidates */
    int32_t *parted;    /* stamps of the charts whose parting was tried */
    int64_t nparted, parted_capacity;
} sl_opt_pool;

void sl_opt_pool_clear(sl_opt_pool *pool);
void sl_opt_pool_drop(sl_opt_pool *pool, int64_t k);

/* Candidates of charts that are gone go; charts that are new get theirs, guessed at or, small ones, probed. */
SL_NODISCARD sl_status sl_opt_pool_refresh(sl_opt_state *state, sl_opt_pool *pool);

/* A chart that a dart did not help may be held back by its own border: once for each, parting it is a candidate. */
SL_NODISCARD sl_status sl_opt_pool_add_parting(const sl_opt_state *state, int32_t c, sl_opt_pool *pool);

/* Makes the trials' charts and ranks them by a few steps, side by side. */
SL_NODISCARD sl_status sl_opt_probe_all(const sl_opt_state *state, sl_opt_trial **list, int64_t count);

/* How much loss there is to lose before the targets are met. A target that is met lets what it leaves, at its small
 * weight, count against what the other one misses; HUGE_VAL where that is more, or where only single charts are beyond
 * what one may be: any gain counts whole then. */
double sl_opt_need(const sl_opt_state *state);

/* The best candidate, solved to the end; *taken = -1 = none is left that gains anything. */
SL_NODISCARD sl_status sl_opt_choose(sl_opt_state *state, sl_opt_pool *pool, int64_t *taken);

/* Where one chart makes most of the loss: the bisection of it that loses least, gain or not. Its halves have borders of
 * their own, and more room. *taken stays as it is where there is none. */
SL_NODISCARD sl_status sl_opt_bisect_worst(sl_opt_state *state, sl_opt_pool *pool, int64_t *taken);

#endif
