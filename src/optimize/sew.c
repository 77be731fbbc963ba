/* Sewing: windows of seams are closed again, the cheapest in distortion first, while the targets stay met. */
#include "optimize/optimize_internal.h"

#include "base/memory.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { BATCH = 6 };                   /* windows solved at a time, whatever the number of threads */
static const double HOPE = 0.97;      /* geometric mean of the shares of both budgets below which a balance is tried */
static const double LEAST_GAP = 1e-4; /* of the surface's unit: gaps below it are as good as none */
static const double GAP_CHANGE = 0.2;
static const int32_t TRIALS_A_ROUND = 40; /* without success, then sewing ends */

/* A window that was refused, by the edges at its ends. */
typedef struct refusal {
    int32_t ends[2];
    double gap;   /* between its banks then */
    double share; /* of the budgets that it would have cost: the mean; HUGE_VAL = no valid chart came of it */
    double length;
} refusal;

typedef struct sewing {
    sl_opt_state *state;
    sl_opt_trial *list;
    int64_t count;
    refusal *refused;
    int64_t nrefused, capacity;
    double room; /* what is left of the budgets, the mean */
} sewing;

static void clear_windows(sewing *s)
{
    for (int64_t k = 0; k < s->count; k++) {
        sl_opt_trial_clear(&s->list[k]);
    }
    sl_free(s->list);
    s->list = NULL;
    s->count = 0;
}

/* Does the window begin, or end, with the edge? */
static bool ends_at(const sl_opt_trial *t, int32_t edge)
{
    return t->edge[0] == edge || t->edge[t->nedge - 1] == edge;
}

static bool has_edge(const sl_opt_trial *t, int32_t edge)
{
    for (int32_t k = 0; k < t->nedge; k++) {
        if (t->edge[k] == edge) {
            return true;
        }
    }
    return false;
}

/* A window cannot do better than it did while the charts only grew, nor one that contains it; and a part of one that
 * cost too much by far costs too much still. Where nothing valid came of it, other charts may have other borders. */
static bool is_vain(const refusal *r, const sl_opt_trial *t, double gap, double room)
{
    const bool same = t->edge[0] == r->ends[0] && t->edge[t->nedge - 1] == r->ends[1];
    if (r->share == HUGE_VAL) {
        return same && fabs(gap - r->gap) <= GAP_CHANGE * r->gap;
    }
    if (same || (t->length >= r->length && has_edge(t, r->ends[0]) && has_edge(t, r->ends[1]))) {
        return true;
    }
    const double part = t->length / r->length;
    return (ends_at(t, r->ends[0]) || ends_at(t, r->ends[1])) && part < 1.0 && r->share * part * part * part > room;
}

static bool was_refused(const sewing *s, const sl_opt_trial *t)
{
    double motion[4];
    const double gap = sl_opt_align(s->state, t, motion);
    for (int64_t k = 0; k < s->nrefused; k++) {
        if (is_vain(&s->refused[k], t, gap, s->room)) {
            return true;
        }
    }
    return false;
}

/* share: what the window would cost of the budgets. */
static sl_status refuse(sewing *s, const sl_opt_trial *t, double share)
{
    double motion[4];
    const sl_status status = sl_reserve((void **)&s->refused, &s->capacity, s->nrefused + 1, sizeof *s->refused);
    if (status == SL_OK) {
        s->refused[s->nrefused++] = (refusal){.ends = {t->edge[0], t->edge[t->nedge - 1]},
                                              .gap = sl_opt_align(s->state, t, motion),
                                              .share = share,
                                              .length = t->length};
    }
    return status;
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

static sl_status list_windows(sewing *s)
{
    clear_windows(s);
    const sl_status status = sl_opt_windows(s->state, &s->list, &s->count);
    if (status != SL_OK) {
        return status;
    }
    const double unit = s->state->surface->unit;
    for (int64_t k = 0; k < s->count; k++) {
        double motion[4];
        const double gap = sl_opt_align(s->state, &s->list[k], motion) / unit;
        for (int32_t e = 0; e < s->list[k].nedge; e++) {
            s->list[k].length += s->state->surface->length[s->list[k].edge[e]] / unit;
        }
        s->list[k].rank = saving(s->state, &s->list[k]) / (gap + LEAST_GAP);
    }
    if (s->count > 1) {
        qsort(s->list, (size_t)s->count, sizeof *s->list, by_rank);
    }
    return SL_OK;
}

static void settle_range(void *user, int64_t begin, int64_t end, int32_t chunk)
{
    (void)chunk;
    const sewing *s = ((sewing **)user)[0];
    sl_opt_trial **batch = ((sl_opt_trial ***)user)[1];
    for (int64_t k = begin; k < end; k++) {
        sl_opt_trial *t = batch[k];
        t->status = sl_opt_interlocks(s->state, t, &t->dropped);
        if (t->status == SL_OK && !t->dropped) {
            t->status = sl_opt_trial_make(s->state, t);
        }
        if (t->status == SL_OK && t->valid) {
            t->status = sl_opt_trial_sew(s->state, t);
        }
    }
}

/* Geometric mean of the shares of the budgets as they are. */
static double share_used(const sl_opt_state *state)
{
    double largest, mean;
    sl_opt_shares(state, NULL, &largest, &mean);
    return mean;
}

/* What comes of one window tells about others that begin or end with it: they wait. */
static bool shares_end(sl_opt_trial *const *batch, int32_t n, const sl_opt_trial *t)
{
    for (int32_t k = 0; k < n; k++) {
        if (t->old[1] < 0 && (ends_at(t, batch[k]->edge[0]) || ends_at(t, batch[k]->edge[batch[k]->nedge - 1]))) {
            return true;
        }
    }
    return false;
}

/* Applies the trial; where only another weight of the energy could keep the targets met, tries that, and puts all back
 * if it does not. */
static sl_status accept(sewing *s, sl_opt_trial *t, double largest, bool *accepted)
{
    sl_status status = SL_OK;
    sl_opt_state before = {0};
    *accepted = true;
    if (largest <= 1.0) {
        return sl_opt_apply(s->state, t);
    }
    SL_TRY(sl_opt_state_copy(s->state, &before));
    SL_TRY(sl_opt_apply(s->state, t));
    SL_TRY(sl_opt_balance(s->state));
    sl_opt_total total;
    sl_opt_totals(s->state, &total);
    *accepted = sl_opt_within(s->state, &total);
    if (!*accepted) {
        before.next_stamp = s->state->next_stamp;
        before.info = s->state->info;
        const sl_opt_state swap = *s->state;
        *s->state = before;
        before = swap;
    }
cleanup:
    sl_opt_state_clear(&before);
    return status;
}

/* Solves the next *count windows of the list (*tried of them; others cross as they lie) and takes the best that keeps
 * the targets; *progress = something was sewn. */
static sl_status try_batch(sewing *s, int32_t *count, int32_t *tried, bool *progress)
{
    sl_status status = SL_OK;
    sl_opt_trial *batch[BATCH];
    int32_t n = 0;
    *progress = false;
    s->room = fmax(HOPE - share_used(s->state), 0.0);
    for (int64_t k = 0; k < s->count && n < BATCH; k++) {
        sl_opt_trial *t = &s->list[k];
        if (t->nedge > 0 && !was_refused(s, t) && !shares_end(batch, n, t)) { /* one that was put back is empty */
            batch[n++] = t;
        }
    }
    void *user[2] = {s, batch};
    sl_parallel_for(s->state->context, n, 1, settle_range, user);
    *count = n;
    *tried = 0;
    const double used = share_used(s->state);
    double largest[BATCH], mean[BATCH], worth[BATCH];
    for (int32_t k = 0; k < n; k++) {
        SL_TRY(batch[k]->status);
        *tried += !batch[k]->dropped;
        sl_opt_shares(s->state, batch[k], &largest[k], &mean[k]);
        const bool hope = largest[k] <= 1.0 || mean[k] <= HOPE;
        worth[k] = hope ? saving(s->state, batch[k]) / (0.05 + mean[k]) : 0.0;
        if (!hope) {
            SL_TRY(refuse(s, batch[k], mean[k] < HUGE_VAL ? fmax(mean[k] - used, 0.0) : HUGE_VAL));
        }
    }
    while (!*progress) {
        int32_t best = -1;
        for (int32_t k = 0; k < n; k++) {
            best = worth[k] > 0.0 && (best < 0 || worth[k] > worth[best]) ? k : best;
        }
        if (best < 0) {
            break;
        }
        worth[best] = 0.0;
        SL_TRY(refuse(s, batch[best], fmax(mean[best] - used, 0.0))); /* accept empties the trial */
        SL_TRY(accept(s, batch[best], largest[best], progress));
        s->nrefused -= *progress;
    }
    s->state->info.trials += *tried;
    s->state->info.sewings += *progress;
cleanup:
    return status;
}

sl_status sl_opt_sew(sl_opt_state *state)
{
    sl_status status = SL_OK;
    sewing s = {.state = state};
    const double since = sl_opt_clock(), balanced = state->info.seconds[SL_OPTIMIZE_BALANCE];
    int32_t idle = 0;
    sl_opt_weigh(state);
    SL_TRY(list_windows(&s));
    while (idle < TRIALS_A_ROUND && state->info.sewings < state->def->max_sewings) {
        int32_t count = 0, tried = 0;
        bool progress;
        SL_TRY(try_batch(&s, &count, &tried, &progress));
        if (count == 0) {
            break;
        }
        idle = progress ? 0 : idle + tried;
        if (progress) {
            SL_TRY(list_windows(&s));
        }
    }
cleanup:
    (void)sl_opt_book(state, SL_OPTIMIZE_SEW, since + state->info.seconds[SL_OPTIMIZE_BALANCE] - balanced);
    clear_windows(&s);
    sl_free(s.refused);
    return status;
}
