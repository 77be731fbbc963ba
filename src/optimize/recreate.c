/* Ruin and recreate: a seam is sewn although the targets are then missed, what they lack is cut elsewhere, and the
 * outcome stays where it costs less.
 *
 * Source: Schrimpf, Schneider, Stamm-Wilbrandt, Dueck 2000, "Record breaking optimization results using the ruin and
 * recreate principle". Deviations: only what is better is accepted; ruins in the order of what they promise. */
#include "optimize/optimize_internal.h"

#include "base/memory.h"

#include <math.h>
#include <stdlib.h>

/* Attempts = triangles of work over those of the piece. */
static const double COARSE_WORK = 4000.0, FINE_WORK = 240000.0;
static const double FINE = 0.1; /* coarseness of the targets below which seams are many and greed costs most */
enum { MOST_RUINS = 48, MOST_LOOKS = 192 }; /* attempts; windows looked at */
static const double LEAST_SAVING = 0.1;     /* of a ruin */
static const double GAP = 0.05;             /* over the surface's unit, between banks that are still no hindrance */
static const double SLACK = 0.5;            /* of what a ruin saves: cuts may cost more by that, sewing wins it back */
static const double LEAST_GAIN = 0.01;      /* in price */

/* Ruins of which nothing came, by the edges at their ends; and what is tried: windows whose charts lie in each other
 * are sewn with borders that are held, once the others are exhausted. */
typedef struct memory {
    int32_t ends[MOST_LOOKS][2];
    int32_t count;
    bool held;
    bool progress; /* since the memory was empty */
} memory;

static bool was_tried(const memory *m, const sl_opt_trial *t)
{
    for (int32_t k = 0; k < m->count; k++) {
        if (m->ends[k][0] == t->edge[0] && m->ends[k][1] == t->edge[t->nedge - 1]) {
            return true;
        }
    }
    return false;
}

static double saving(const sl_opt_state *state, const sl_opt_trial *t)
{
    double cost = 0.0;
    for (int32_t k = 0; k < t->nedge; k++) {
        cost += state->surface->cost[t->edge[k]];
    }
    return state->def->seam_cost * cost / state->surface->unit + (t->old[1] >= 0 ? state->def->chart_cost : 0.0);
}

static int by_rank(const void *x, const void *y)
{
    const sl_opt_trial *a = x, *b = y;
    if (a->rank != b->rank) {
        return a->rank < b->rank ? 1 : -1;
    }
    if (a->edge[0] != b->edge[0]) {
        return a->edge[0] < b->edge[0] ? -1 : 1;
    }
    return (a->nedge > b->nedge) - (a->nedge < b->nedge);
}

/* The window that promises most and was not tried yet: its place in *list (owned); -1 = none. */
static sl_status find_ruin(const sl_opt_state *state, const memory *tried, sl_opt_trial **list, int64_t *count,
                           int64_t *best)
{
    sl_status status = SL_OK;
    *best = -1;
    SL_TRY(sl_opt_windows(state, list, count));
    for (int64_t k = 0; k < *count; k++) {
        sl_opt_trial *t = &(*list)[k];
        double motion[4];
        const double gap = sl_opt_align(state, t, motion) / state->surface->unit;
        t->rank = saving(state, t) / (gap + GAP);
        if (saving(state, t) >= LEAST_SAVING && !was_tried(tried, t) &&
            (*best < 0 || by_rank(t, &(*list)[*best]) < 0)) {
            *best = k;
        }
    }
cleanup:
    return status;
}

/* Sews the window, targets met or not; *ruined = false where it has no embedding, or is one for later. */
static sl_status ruin(sl_opt_state *state, bool held, sl_opt_trial *t, bool *ruined)
{
    sl_status status = SL_OK;
    bool interlocks = false;
    *ruined = false;
    SL_TRY(sl_opt_interlocks(state, t, &interlocks));
    if (interlocks != held) {
        goto cleanup;
    }
    SL_TRY(sl_opt_trial_make(state, t));
    if (!t->valid || t->nto != 1) {
        goto cleanup;
    }
    SL_TRY(sl_opt_solve(state, t->to[0].patch, held ? SL_OPT_HELD : SL_OPT_WARM, t->to[0].uv, ruined));
    if (*ruined) {
        sl_opt_measure(state->surface, t->to[0].patch, t->to[0].uv, &t->to[0].sums, NULL);
        SL_TRY(sl_opt_apply(state, t));
        state->info.sewings++;
    }
cleanup:
    return status;
}

/* Cuts what is missing for at most `slack` above `price`, sews and straightens; *better = that costs less. */
static sl_status repair(sl_opt_state *state, double price, double slack, bool *better)
{
    sl_status status = SL_OK;
    sl_opt_total total;
    state->most_price = price + slack;
    status = sl_opt_cut(state);
    state->most_price = HUGE_VAL;
    SL_TRY(status);
    sl_opt_totals(state, &total);
    *better = sl_opt_within(state, &total);
    if (*better) {
        SL_TRY(sl_opt_sew(state));
        const double since = sl_opt_clock();
        SL_TRY(sl_opt_straighten(state));
        (void)sl_opt_book(state, SL_OPTIMIZE_STRAIGHTEN, since);
        sl_opt_totals(state, &total);
        *better = sl_opt_within(state, &total) && sl_opt_price(state) <= price - LEAST_GAIN;
    }
cleanup:
    return status;
}

/* The state as it was, but for the work done since; and its stamps stay unlike any other. */
static void put_back(sl_opt_state *state, sl_opt_state *before)
{
    before->next_stamp = state->next_stamp;
    before->info.trials = state->info.trials;
    for (int k = 0; k < SL_OPTIMIZE_STAGES; k++) {
        before->info.seconds[k] = state->info.seconds[k];
    }
    sl_opt_state_clear(state);
    *state = *before;
    *before = (sl_opt_state){0};
}

/* One window, ruined and repaired, or all as it was. */
static sl_status attempt(sl_opt_state *state, bool held, sl_opt_trial *t, bool *ruined, bool *better)
{
    sl_status status = SL_OK;
    sl_opt_state before = {0};
    const double price = sl_opt_price(state), slack = SLACK * saving(state, t);
    SL_TRY(sl_opt_state_copy(state, &before));
    SL_TRY(ruin(state, held, t, ruined));
    if (*ruined) {
        SL_TRY(repair(state, price, slack, better));
        if (!*better) {
            put_back(state, &before);
        }
    }
cleanup:
    sl_opt_state_clear(&before);
    return status;
}

/* The next window; *found = false where none is left. */
static sl_status try_next(sl_opt_state *state, memory *m, bool *found, bool *ruined)
{
    sl_status status = SL_OK;
    sl_opt_trial *list = NULL;
    int64_t count = 0, best = -1;
    bool better = false;
    *found = *ruined = false;
    SL_TRY(find_ruin(state, m, &list, &count, &best));
    *found = best >= 0;
    if (*found) {
        sl_opt_trial *t = &list[best];
        m->ends[m->count][0] = t->edge[0];
        m->ends[m->count++][1] = t->edge[t->nedge - 1];
        SL_TRY(attempt(state, m->held, t, ruined, &better));
        m->progress = m->progress || better;
    }
cleanup:
    for (int64_t k = 0; k < count; k++) {
        sl_opt_trial_clear(&list[k]);
    }
    sl_free(list);
    return status;
}

static int32_t attempts(const sl_opt_state *state)
{
    const double work = sl_opt_coarseness(state->def) < FINE ? FINE_WORK : COARSE_WORK;
    return (int32_t)fmin(state->def->effort * work / state->surface->patch->nt, MOST_RUINS);
}

/* Is there something to win, and leave to do it? */
static bool may_go_on(const sl_opt_state *state)
{
    sl_opt_total total;
    sl_opt_totals(state, &total);
    return sl_opt_within(state, &total) && state->info.cuts < state->def->max_cuts &&
           state->info.sewings < state->def->max_sewings;
}

sl_status sl_opt_recreate(sl_opt_state *state)
{
    sl_status status = SL_OK;
    memory m = {.count = 0};
    const int32_t most = attempts(state);
    int32_t n = 0;
    for (int32_t looks = 0; looks < MOST_LOOKS && n < most && may_go_on(state); looks++) {
        bool found = false, ruined = false;
        SL_TRY(sl_report_progress(state->context, "optimise", (double)n / most));
        SL_TRY(try_next(state, &m, &found, &ruined));
        n += ruined;
        if (!found) {
            if (m.held && !m.progress) {
                break;
            }
            m = (memory){.held = !m.progress}; /* from the first again, or on to those that are held */
        }
    }
cleanup:
    return status;
}
