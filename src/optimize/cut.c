/* Greedy cutting: the candidate of the best gain for its price, until the targets are met. */
#include "optimize/cut_internal.h"

#include <math.h>

static const int BALANCE_EVERY = 3; /* cuts */
/* Of what is missing, or of a budget: a cut that gains less is none to go on by. */
static const double LEAST_SHARE = 0.01;
static const int32_t MOST_BISECTED = 12; /* worst charts, gain or not */

/* Of what is missing, the share that the chosen candidate must gain at least. */
static bool gains_enough(const sl_opt_state *state, const sl_opt_pool *p, int64_t k)
{
    const double gain = sl_opt_loss(state, &state->chart[p->trial[k].old[0]].sums) - p->trial[k].loss;
    return gain >= LEAST_SHARE * fmin(sl_opt_need(state), 1.0);
}

sl_status sl_opt_cut(sl_opt_state *state)
{
    sl_status status = SL_OK;
    sl_opt_pool p = {0};
    int32_t bisected = 0;
    for (int32_t k = 0; state->info.cuts < state->def->max_cuts; k++) {
        sl_opt_total total;
        int64_t taken;
        sl_opt_totals(state, &total);
        if (k % BALANCE_EVERY == 0 || sl_opt_within(state, &total)) {
            SL_TRY(sl_opt_balance(state));
            sl_opt_totals(state, &total);
        }
        if (sl_opt_within(state, &total)) {
            break;
        }
        state->room = state->most_price < HUGE_VAL ? state->most_price - sl_opt_price(state) : HUGE_VAL;
        if (!(state->room > 0.0)) {
            break;
        }
        sl_opt_weigh(state);
        double since = sl_opt_clock();
        SL_TRY(sl_opt_pool_refresh(state, &p));
        since = sl_opt_book(state, SL_OPTIMIZE_GUESS, since);
        SL_TRY(sl_opt_choose(state, &p, &taken));
        if ((taken < 0 || !gains_enough(state, &p, taken)) && bisected < MOST_BISECTED) {
            bisected++;
            SL_TRY(sl_opt_bisect_worst(state, &p, &taken));
        }
        (void)sl_opt_book(state, SL_OPTIMIZE_CUT, since);
        if (taken < 0) {
            break;
        }
        SL_TRY(sl_opt_apply(state, &p.trial[taken]));
        sl_opt_pool_drop(&p, taken);
        state->info.cuts++;
    }
cleanup:
    sl_opt_pool_clear(&p);
    return status;
}
