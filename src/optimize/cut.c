/* Greedy cutting: the candidate of the best gain for its price, until the targets are met. */
#include "optimize/optimize_internal.h"

#include "base/memory.h"

#include <math.h>
#include <string.h>

enum { PROBES = 4 };               /* on whole charts at a time */
static const int32_t SMALL = 1000; /* triangles */
static const int32_t PROBE_STEPS = 4;
static const double LEAST_GAIN = 4e-3; /* of a whole budget: below it nothing is gained */
/* Of any cut, in seam length over sqrt(area): else seams are made an edge at a time. The first at these targets and
 * coarser ones, down to the last at finer ones, which short cuts reach best. */
static const double CUT_PRICE = 0.1, LEAST_CUT_PRICE = 0.02;
static const double BLOCKED_FACTOR = 3.0; /* at coarse targets, of what a free cut is worth, and once more: then one
                                           * with a held border is tried */
static const int BALANCE_EVERY = 3;       /* cuts */
static const double LEAST_SHARE =
    0.01;                        /* of what is missing, or of a budget: a cut that gains less is none to go on by */
static const double WORSE = 1.2; /* times its loss, at most, that a stuck chart's halves may have */
static const int32_t MOST_BISECTED = 12; /* stuck charts a search */

/* The candidates of all charts, those of a chart until it changes. */
typedef struct pool {
    sl_opt_trial *trial;
    int32_t *stamp; /* of the chart that each is for */
    int64_t count, capacity, stamp_capacity;
    int32_t *parted; /* stamps of the charts whose parting was tried */
    int64_t nparted, parted_capacity;
} pool;

static void pool_clear(pool *p)
{
    for (int64_t k = 0; k < p->count; k++) {
        sl_opt_trial_clear(&p->trial[k]);
    }
    sl_free(p->trial);
    sl_free(p->stamp);
    sl_free(p->parted);
}

static void drop(pool *p, int64_t k)
{
    sl_opt_trial_clear(&p->trial[k]);
    p->count--;
    memmove(p->trial + k, p->trial + k + 1, (size_t)(p->count - k) * sizeof *p->trial);
    memmove(p->stamp + k, p->stamp + k + 1, (size_t)(p->count - k) * sizeof *p->stamp);
}

static int32_t chart_of_stamp(const sl_opt_state *state, int32_t stamp)
{
    for (int32_t c = 0; c < state->nchart; c++) {
        if (state->chart[c].stamp == stamp) {
            return c;
        }
    }
    return -1;
}

static bool is_known(const pool *p, int32_t stamp)
{
    for (int64_t k = 0; k < p->count; k++) {
        if (p->stamp[k] == stamp) {
            return true;
        }
    }
    return false;
}

static sl_status add_candidates(const sl_opt_state *state, int32_t c, pool *p)
{
    sl_status status = SL_OK;
    sl_opt_trial *list = NULL;
    int32_t count = 0;
    SL_TRY(sl_opt_candidates(state, c, &list, &count));
    SL_TRY(sl_reserve((void **)&p->trial, &p->capacity, p->count + count + 1, sizeof *p->trial));
    SL_TRY(sl_reserve((void **)&p->stamp, &p->stamp_capacity, p->count + count + 1, sizeof *p->stamp));
    for (int32_t k = 0; k < count; k++) {
        if (list[k].nedge > 0) {
            p->stamp[p->count] = state->chart[c].stamp;
            p->trial[p->count++] = list[k];
            list[k] = (sl_opt_trial){0};
        }
    }
cleanup:
    for (int32_t k = 0; list != NULL && k < count; k++) {
        sl_opt_trial_clear(&list[k]);
    }
    sl_free(list);
    return status;
}

typedef struct probing {
    const sl_opt_state *state;
    sl_opt_trial **trial;
} probing;

static void guess_range(void *user, int64_t begin, int64_t end, int32_t chunk)
{
    (void)chunk;
    const probing *p = user;
    for (int64_t k = begin; k < end; k++) {
        p->trial[k]->status = sl_opt_trial_guess(p->state, p->trial[k]);
    }
}

static void probe_range(void *user, int64_t begin, int64_t end, int32_t chunk)
{
    (void)chunk;
    const probing *p = user;
    for (int64_t k = begin; k < end; k++) {
        sl_opt_trial *trial = p->trial[k];
        trial->probed = true;
        trial->status = sl_opt_trial_make(p->state, trial);
        if (trial->status == SL_OK) {
            trial->status = sl_opt_trial_probe(p->state, PROBE_STEPS, trial);
        }
    }
}

/* Runs the trials side by side. */
static sl_status run_trials(const sl_opt_state *state, sl_opt_trial **list, int64_t count, sl_chunk_fn *range)
{
    sl_status status = SL_OK;
    probing all = {state, list};
    sl_parallel_for(state->context, count, 1, range, &all);
    for (int64_t k = 0; k < count; k++) {
        SL_TRY(list[k]->status);
    }
cleanup:
    return status;
}

/* Candidates of charts that are gone go; charts that are new get theirs. */
static sl_status refresh(sl_opt_state *state, pool *p)
{
    sl_status status = SL_OK;
    for (int64_t k = p->count; k-- > 0;) {
        const int32_t c = chart_of_stamp(state, p->stamp[k]);
        if (c < 0) {
            drop(p, k);
        } else {
            p->trial[k].old[0] = c;
        }
    }
    const int64_t first = p->count;
    for (int32_t c = 0; c < state->nchart; c++) {
        if (!is_known(p, state->chart[c].stamp)) {
            SL_TRY(add_candidates(state, c, p));
        }
    }
    state->info.trials += (int32_t)(p->count - first);
    sl_opt_trial **fresh = sl_alloc(p->count - first, sizeof *fresh);
    SL_TRY(fresh == NULL ? SL_OUT_OF_MEMORY : SL_OK);
    for (int64_t k = first; k < p->count; k++) {
        fresh[k - first] = &p->trial[k];
    }
    int64_t small = 0; /* whole charts that cost no more than surroundings */
    for (int64_t k = 0; k < p->count - first; k++) {
        sl_opt_trial *trial = fresh[k];
        if (state->chart[trial->old[0]].patch->nt < SMALL) {
            fresh[k] = fresh[small];
            fresh[small++] = trial;
        }
    }
    status = run_trials(state, fresh, small, probe_range);
    status = status == SL_OK ? run_trials(state, fresh + small, p->count - first - small, guess_range) : status;
    sl_free(fresh);
cleanup:
    return status;
}

/* How much loss there is to lose before the targets are met; at least what one budget's hundredth weighs. */
static double need(const sl_opt_state *state)
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

static double score(const sl_opt_state *state, const sl_opt_trial *trial, double wanted)
{
    const double gain = sl_opt_loss(state, &state->chart[trial->old[0]].sums) - trial->loss;
    const double price = state->def->seam_cost * trial->cost + state->def->chart_cost * (trial->nto - 1);
    if (!trial->valid || !(gain > LEAST_GAIN)) {
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
static int64_t find_best(const sl_opt_state *state, const pool *p, double wanted, bool guessed)
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
static sl_status probe_best(const sl_opt_state *state, pool *p, double wanted, int32_t *count)
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
    return run_trials(state, list, n, probe_range);
}

/* A chart that a dart did not help may be held back by its own border: once for each, parting it is a candidate. */
static sl_status add_parting(const sl_opt_state *state, int32_t c, pool *p)
{
    sl_status status = SL_OK;
    const int32_t stamp = state->chart[c].stamp;
    for (int64_t k = 0; k < p->nparted; k++) {
        if (p->parted[k] == stamp) {
            return SL_OK;
        }
    }
    SL_TRY(sl_reserve((void **)&p->parted, &p->parted_capacity, p->nparted + 1, sizeof *p->parted));
    SL_TRY(sl_reserve((void **)&p->trial, &p->capacity, p->count + 1, sizeof *p->trial));
    SL_TRY(sl_reserve((void **)&p->stamp, &p->stamp_capacity, p->count + 1, sizeof *p->stamp));
    p->parted[p->nparted++] = p->stamp[p->count] = stamp;
    SL_TRY(sl_opt_part(state, c, &p->trial[p->count++]));
    p->trial[p->count - 1].probed = true;
cleanup:
    return status;
}

/* Of the cuts that overlap when let go, the one that promised most, if that is far more than `score`; -1 = none. */
static int64_t find_blocked(const sl_optimize_def *def, const pool *p, double score)
{
    int64_t best = -1;
    double most = (1.0 + BLOCKED_FACTOR * sl_opt_coarseness(def)) * score;
    for (int64_t k = 0; k < p->count; k++) {
        if (p->trial[k].blocked && p->trial[k].promise > most) {
            best = k;
            most = p->trial[k].promise;
        }
    }
    return best;
}

/* Solves a candidate to its end, its border held if that was needed and is worth it. */
static sl_status settle(sl_opt_state *state, pool *p, int64_t k, double wanted)
{
    sl_status status = SL_OK;
    sl_opt_trial *trial = &p->trial[k];
    const bool blocked = trial->blocked;
    if (!blocked) {
        trial->promise = score(state, trial, wanted);
    }
    trial->valid = true;
    SL_TRY(sl_opt_trial_settle(state, blocked, trial));
    trial->blocked = !blocked && !trial->valid;
    if (!(score(state, trial, wanted) > 0.0)) {
        SL_TRY(add_parting(state, trial->old[0], p));
    }
cleanup:
    return status;
}

/* The best candidate, solved to the end; *taken = -1 = none is left. */
static sl_status choose(sl_opt_state *state, pool *p, int64_t *taken)
{
    sl_status status = SL_OK;
    const double wanted = need(state);
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

/* Of what is missing, the share that the chosen candidate must gain at least. */
static bool gains_enough(const sl_opt_state *state, const pool *p, int64_t k)
{
    const double gain = sl_opt_loss(state, &state->chart[p->trial[k].old[0]].sums) - p->trial[k].loss;
    return gain >= LEAST_SHARE * fmin(need(state), 1.0);
}

/* Where one chart makes most of the loss and no candidate of its own gains anything: the bisection of it that loses
 * least. Its halves have borders of their own, and more room. *taken stays as it is where there is none. */
static sl_status bisect_stuck(sl_opt_state *state, pool *p, int64_t *taken)
{
    sl_status status = SL_OK;
    int32_t worst = -1;
    double most = 0.0, sum = 0.0, least = HUGE_VAL;
    for (int32_t c = 0; c < state->nchart; c++) {
        const double loss = sl_opt_loss(state, &state->chart[c].sums);
        sum += loss;
        worst = loss > most ? c : worst;
        most = fmax(most, loss);
    }
    for (int64_t k = 0; k < p->count && most > 0.5 * sum; k++) {
        sl_opt_trial *trial = &p->trial[k];
        if (trial->old[0] != worst || trial->nto < 2 || !trial->valid) {
            continue;
        }
        if (!trial->probed) { /* only guessed at: its charts are not made yet */
            SL_TRY(run_trials(state, &trial, 1, probe_range));
        }
        if (!trial->settled) {
            SL_TRY(sl_opt_trial_settle(state, false, trial));
            if (!trial->valid) {
                trial->valid = true;
                SL_TRY(sl_opt_trial_settle(state, true, trial));
            }
        }
        if (trial->settled && trial->loss < fmin(least, WORSE * most)) {
            least = trial->loss;
            *taken = k;
        }
    }
cleanup:
    return status;
}

sl_status sl_opt_cut(sl_opt_state *state)
{
    sl_status status = SL_OK;
    pool p = {0};
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
        sl_opt_weigh(state);
        double since = sl_opt_clock();
        SL_TRY(refresh(state, &p));
        since = sl_opt_book(state, SL_OPTIMIZE_GUESS, since);
        SL_TRY(choose(state, &p, &taken));
        if ((taken < 0 || !gains_enough(state, &p, taken)) && bisected < MOST_BISECTED) {
            bisected++;
            SL_TRY(bisect_stuck(state, &p, &taken));
        }
        (void)sl_opt_book(state, SL_OPTIMIZE_CUT, since);
        if (taken < 0) {
            break;
        }
        SL_TRY(sl_opt_apply(state, &p.trial[taken]));
        drop(&p, taken);
        state->info.cuts++;
    }
cleanup:
    pool_clear(&p);
    return status;
}
