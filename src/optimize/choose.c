/* The choice among candidate cuts: the best gain for its price, once it is solved to its end. */
#include "optimize/cut_internal.h"

#include <math.h>

enum { PROBES = 4 };                   /* on whole charts at a time */
static const double LEAST_GAIN = 4e-3; /* of a whole budget: below it nothing is gained */
/* Of any cut, in seam length over sqrt(area): else seams are made an edge at a time. The first at the default targets
 * and coarser ones, down to the last at finer ones, which short cuts reach best. */
static const double CUT_PRICE = 0.1, LEAST_CUT_PRICE = 0.02;
/* A cut that overlaps when its border is let go is solved with one that is held only if it promised this many times
 * what the best free cut is worth; as many at the default targets and coarser ones, down to once at the finest. */
static const double BLOCKED_RATIO = 4.0;
static const double WORSE = 1.2; /* times its loss, at most, that the halves of the worst chart may have */

double sl_opt_need(const sl_opt_state *state)
{
    sl_opt_total total;
    double loss = 0.0;
    sl_opt_totals(state, &total);
    for (int64_t c = 0; c < state->nchart; c++) {
        loss += sl_opt_loss(state, &state->chart[c].sums);
    }
    const double spare =
        state->cost[0] * (state->def->target_stretch - 1.0) + state->cost[1] * (state->def->target_angle - 1.0);
    return loss > spare ? loss - spare : HUGE_VAL;
}

static double cut_price(const sl_optimize_def *def)
{
    return fmax(CUT_PRICE * sl_opt_coarseness(def), LEAST_CUT_PRICE);
}

/* What a cut adds to the price of the atlas: its seams and its charts. */
static double price_of(const sl_opt_state *state, const sl_opt_trial *trial)
{
    return state->def->seam_cost * trial->cost + state->def->chart_cost * (trial->nto - 1);
}

static double score(const sl_opt_state *state, const sl_opt_trial *trial, double wanted)
{
    const double gain = sl_opt_loss(state, &state->chart[trial->old[0]].sums) - trial->loss;
    const double price = price_of(state, trial);
    if (!trial->valid || !(gain > LEAST_GAIN) || price > state->room) {
        return 0.0;
    }
    return fmin(gain, wanted) / (cut_price(state->def) + price);
}

/* Are the atlas's targets met, and only some charts beyond what one may be? */
static bool only_charts_missed(const sl_opt_state *state)
{
    sl_opt_total total;
    sl_opt_totals(state, &total);
    return total.stretch <= state->def->target_stretch && total.angle <= state->def->target_angle;
}

/* The candidate of the best score, of all or of those that are only guessed at; -1 = none is worth anything. */
static int64_t find_best(const sl_opt_state *state, const sl_opt_pool *p, double wanted, bool guessed)
{
    int64_t best = -1;
    double most = 0.0;
    const bool focus = only_charts_missed(state);
    for (int64_t k = 0; k < p->count; k++) {
        const bool counts = !focus || !sl_opt_chart_within(state, &state->chart[p->trial[k].old[0]].sums);
        const double s = !counts || (guessed && p->trial[k].probed) ? 0.0 : score(state, &p->trial[k], wanted);
        best = s > most ? k : best;
        most = fmax(s, most);
    }
    return best;
}

/* The best of those that are only guessed at, on their whole charts. *count = how many there were. */
static sl_status probe_best(const sl_opt_state *state, sl_opt_pool *p, double wanted, int32_t *count)
{
    sl_opt_trial *list[PROBES];
    int32_t n = 0;
    for (; n < PROBES; n++) {
        int64_t best = find_best(state, p, wanted, true);
        for (int64_t k = 0; k < p->count && best < 0; k++) { /* guesses may be wrong */
            best = p->trial[k].probed ? -1 : k;
        }
        if (best < 0) {
            break;
        }
        list[n] = &p->trial[best];
        list[n]->probed = true;
    }
    *count = n;
    return sl_opt_probe_all(state, list, n);
}

/* Of the cuts that overlap when let go, the one that promised most, if that is far more than `score`; -1 = none. */
static int64_t find_blocked(const sl_optimize_def *def, const sl_opt_pool *p, double score)
{
    int64_t best = -1;
    double most = (1.0 + (BLOCKED_RATIO - 1.0) * sl_opt_coarseness(def)) * score;
    for (int64_t k = 0; k < p->count; k++) {
        if (p->trial[k].blocked && p->trial[k].promise > most) {
            best = k;
            most = p->trial[k].promise;
        }
    }
    return best;
}

/* Solves a candidate to its end: with its border let go; where that overlapped, when asked again, with one that stays
 * simple. A dart is then laid flat from nothing, since its chart would be locked where the border touches; parts keep
 * the map they have, since each has a border of its own. */
static sl_status settle(sl_opt_state *state, sl_opt_pool *p, int64_t k, double wanted)
{
    sl_status status = SL_OK;
    sl_opt_trial *trial = &p->trial[k];
    const bool blocked = trial->blocked;
    const sl_opt_effort held = trial->nto > 1 ? SL_OPT_WARM_ONLY : SL_OPT_SIMPLE;
    if (!blocked) {
        trial->promise = score(state, trial, wanted);
    }
    SL_TRY(sl_opt_trial_settle(state, blocked ? held : SL_OPT_WARM, trial));
    trial->blocked = !blocked && !trial->valid;
    if (!(score(state, trial, wanted) > 0.0)) {
        SL_TRY(sl_opt_pool_add_parting(state, trial->old[0], p));
    }
cleanup:
    return status;
}

sl_status sl_opt_choose(sl_opt_state *state, sl_opt_pool *p, int64_t *taken)
{
    sl_status status = SL_OK;
    const double wanted = sl_opt_need(state);
    *taken = -1;
    while (*taken < 0) {
        const int64_t best = find_best(state, p, wanted, false);
        if (best >= 0 && p->trial[best].probed && !p->trial[best].settled) {
            SL_TRY(settle(state, p, best, wanted)); /* it may be worth less than the probe promised, or overlap */
            continue;
        }
        if (best < 0 || !p->trial[best].probed) {
            int32_t count;
            SL_TRY(probe_best(state, p, wanted, &count));
            if (count > 0) {
                continue;
            }
        }
        const int64_t blocked = find_blocked(state->def, p, best < 0 ? 0.0 : score(state, &p->trial[best], wanted));
        if (blocked >= 0) {
            SL_TRY(settle(state, p, blocked, wanted));
        } else if (best < 0) {
            break;
        } else {
            *taken = best;
        }
    }
cleanup:
    return status;
}

/* The chart of the largest loss, if it makes most of all and there is anything to gain; else -1. */
static int32_t worst_chart(const sl_opt_state *state, double *loss)
{
    int32_t worst = -1;
    double sum = 0.0;
    *loss = 0.0;
    for (int32_t c = 0; c < state->nchart; c++) {
        const double own = sl_opt_loss(state, &state->chart[c].sums);
        sum += own;
        worst = own > *loss ? c : worst;
        *loss = fmax(own, *loss);
    }
    return *loss > fmax(0.5 * sum, LEAST_GAIN) ? worst : -1;
}

sl_status sl_opt_bisect_worst(sl_opt_state *state, sl_opt_pool *p, int64_t *taken)
{
    sl_status status = SL_OK;
    double loss;
    const int32_t worst = worst_chart(state, &loss);
    double least = WORSE * loss;
    for (int64_t k = 0; k < p->count; k++) {
        sl_opt_trial *trial = &p->trial[k];
        if (trial->old[0] != worst || trial->nto < 2 || !trial->valid || price_of(state, trial) > state->room) {
            continue;
        }
        if (!trial->probed) { /* only guessed at: its charts are not made yet */
            SL_TRY(sl_opt_probe_all(state, &trial, 1));
        }
        if (!trial->settled) {
            SL_TRY(sl_opt_trial_settle(state, SL_OPT_WARM, trial));
        }
        if (!trial->settled) { /* from nothing, since held halves gained too little to be chosen */
            SL_TRY(sl_opt_trial_settle(state, SL_OPT_SIMPLE, trial));
        }
        if (trial->settled && trial->loss < least) {
            least = trial->loss;
            *taken = k;
        }
    }
cleanup:
    return status;
}
