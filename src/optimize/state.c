/* The state of the search and what it is worth. */
#include "optimize/optimize_internal.h"

#include "base/memory.h"

#include <math.h>
#include <string.h>
#include <time.h>

static const double COARSE_STRETCH = 1.05, COARSE_ANGLE = 1.2; /* targets for which a surface's detail matters little */
static const double MET_WEIGHT = 0.15;                         /* of a target that is met, against one that is not */

sl_status sl_opt_state_init(const sl_opt_surface *surface, const sl_optimize_def *def, const sl_context *context,
                            sl_opt_state *out)
{
    const int64_t nt = surface->patch->nt;
    *out = (sl_opt_state){.surface = surface,
                          .def = def,
                          .context = context,
                          .quiet = sl_quiet_context(context),
                          .most_price = HUGE_VAL,
                          .room = HUGE_VAL};
    out->cut = sl_calloc(3 * nt, sizeof *out->cut);
    out->keep = sl_calloc(3 * nt, sizeof *out->keep);
    out->uv = sl_calloc(6 * nt, sizeof *out->uv);
    out->chart_of = sl_alloc(nt, sizeof *out->chart_of);
    if (out->cut == NULL || out->keep == NULL || out->uv == NULL || out->chart_of == NULL) {
        sl_opt_state_clear(out);
        return SL_OUT_OF_MEMORY;
    }
    memset(out->chart_of, 0xff, (size_t)nt * sizeof *out->chart_of);
    return SL_OK;
}

double sl_opt_clock(void)
{
    return (double)clock() / CLOCKS_PER_SEC;
}

double sl_opt_book(sl_opt_state *state, sl_optimize_stage stage, double since)
{
    const double now = sl_opt_clock();
    state->info.seconds[stage] += now - since;
    return now;
}

void sl_opt_add_info(const sl_optimize_info *from, sl_optimize_info *to)
{
    to->cuts += from->cuts;
    to->sewings += from->sewings;
    to->straightened += from->straightened;
    to->trials += from->trials;
    for (int k = 0; k < SL_OPTIMIZE_STAGES; k++) {
        to->seconds[k] += from->seconds[k];
    }
}

double sl_opt_coarseness(const sl_optimize_def *def)
{
    const double least =
        fmin((def->target_stretch - 1.0) / (COARSE_STRETCH - 1.0), (def->target_angle - 1.0) / (COARSE_ANGLE - 1.0));
    return fmin(least, 1.0);
}

void sl_opt_state_clear(sl_opt_state *state)
{
    for (int64_t c = 0; c < state->nchart; c++) {
        sl_opt_chart_clear(&state->chart[c]);
    }
    sl_free(state->chart);
    sl_free(state->cut);
    sl_free(state->keep);
    sl_free(state->uv);
    sl_free(state->chart_of);
    *state = (sl_opt_state){0};
}

sl_status sl_opt_state_copy(const sl_opt_state *state, sl_opt_state *out)
{
    const int64_t nt = state->surface->patch->nt;
    sl_status status = SL_OK;
    *out = *state;
    out->cut = sl_copy(state->cut, 3 * nt, sizeof *out->cut);
    out->keep = sl_copy(state->keep, 3 * nt, sizeof *out->keep);
    out->uv = sl_copy(state->uv, 6 * nt, sizeof *out->uv);
    out->chart_of = sl_copy(state->chart_of, nt, sizeof *out->chart_of);
    out->chart = sl_calloc(state->nchart, sizeof *out->chart);
    out->capacity = state->nchart;
    out->nchart = 0;
    if (out->cut == NULL || out->keep == NULL || out->uv == NULL || out->chart_of == NULL || out->chart == NULL) {
        SL_TRY(SL_OUT_OF_MEMORY);
    }
    while (out->nchart < state->nchart) {
        const int64_t c = out->nchart++;
        SL_TRY(sl_opt_chart_copy(&state->chart[c], &out->chart[c]));
    }
cleanup:
    if (status != SL_OK) {
        sl_opt_state_clear(out);
    }
    return status;
}

void sl_opt_totals(const sl_opt_state *state, sl_opt_total *out)
{
    const sl_opt_surface *s = state->surface;
    double stretch = 0.0, shear = 0.0, length = 0.0;
    *out = (sl_opt_total){.worst = 1.0, .charts_within = true};
    for (int64_t c = 0; c < state->nchart; c++) {
        const sl_opt_sums *sums = &state->chart[c].sums;
        stretch += sl_opt_stretch(sums);
        shear += sums->shear;
        out->worst = sums->space > 0.0 ? fmax(out->worst, 1.0 + sl_opt_stretch(sums) / sums->space) : out->worst;
    }
    for (int64_t c = 0; c < state->nchart; c++) {
        out->charts_within = out->charts_within && sl_opt_chart_within(state, &state->chart[c].sums);
    }
    for (int32_t c = 0; c < 3 * s->patch->nt; c++) {
        length += state->cut[c] != 0 && s->patch->twin[c] > c ? s->length[c] : 0.0;
    }
    out->stretch = 1.0 + stretch / s->total;
    out->angle = 1.0 + shear / s->total;
    out->length = length / s->unit;
}

bool sl_opt_within(const sl_opt_state *state, const sl_opt_total *total)
{
    const sl_optimize_def *def = state->def;
    return total->stretch <= def->target_stretch && total->angle <= def->target_angle && total->charts_within;
}

bool sl_opt_chart_within(const sl_opt_state *state, const sl_opt_sums *sums)
{
    const sl_optimize_def *def = state->def;
    return !(sums->space > 0.0) || (1.0 + sl_opt_stretch(sums) / sums->space <= def->max_stretch &&
                                    1.0 + sums->shear / sums->space <= def->max_angle);
}

void sl_opt_shares(const sl_opt_state *state, const sl_opt_trial *t, double *largest, double *mean)
{
    const sl_optimize_def *def = state->def;
    sl_opt_total total;
    *largest = *mean = HUGE_VAL;
    if (t != NULL && !t->valid) {
        return;
    }
    sl_opt_totals(state, &total);
    double q = total.stretch - 1.0, r = total.angle - 1.0;
    for (int j = 0; t != NULL && j < 2; j++) {
        if (t->old[j] >= 0) {
            q -= sl_opt_stretch(&state->chart[t->old[j]].sums) / state->surface->total;
            r -= state->chart[t->old[j]].sums.shear / state->surface->total;
        }
    }
    for (int32_t k = 0; t != NULL && k < t->nto; k++) {
        const sl_opt_sums *sums = &t->to[k].sums;
        q += sl_opt_stretch(sums) / state->surface->total;
        r += sums->shear / state->surface->total;
        if (!sl_opt_chart_within(state, sums)) {
            return;
        }
    }
    q /= fmax(def->target_stretch - 1.0, 1e-9);
    r /= fmax(def->target_angle - 1.0, 1e-9);
    *largest = fmax(q, r);
    *mean = sqrt(fmax(q, 0.0) * fmax(r, 0.0));
}

/* A loss of 1 is a whole budget: a target that is met weighs less, but something, since energy trades one for the
 * other. */
void sl_opt_weigh(sl_opt_state *state)
{
    const sl_optimize_def *def = state->def;
    const double budget[2] = {fmax(def->target_stretch - 1.0, 1e-6), fmax(def->target_angle - 1.0, 1e-6)};
    sl_opt_total total;
    sl_opt_totals(state, &total);
    const bool met[2] = {total.stretch <= def->target_stretch, total.angle <= def->target_angle};
    for (int k = 0; k < 2; k++) {
        state->cost[k] = (met[k] && !met[1 - k] ? MET_WEIGHT : 1.0) / budget[k];
    }
}

double sl_opt_loss(const sl_opt_state *state, const sl_opt_sums *sums)
{
    return (state->cost[0] * sl_opt_stretch(sums) + state->cost[1] * sums->shear) / state->surface->total;
}

/* Moves chart c of the state to place `to` (below it). */
static void renumber(sl_opt_state *state, int64_t from, int64_t to)
{
    state->chart[to] = state->chart[from];
    state->chart[from] = (sl_opt_chart){0};
    for (int32_t t = 0; t < state->chart[to].patch->nt; t++) {
        state->chart_of[state->chart[to].patch->facet[t]] = (int32_t)to;
    }
}

/* Puts a chart in place c and writes its corners' UVs. */
static void place(sl_opt_state *state, int64_t c, sl_opt_chart *chart)
{
    state->chart[c] = *chart;
    *chart = (sl_opt_chart){0};
    const sl_opt_chart *now = &state->chart[c];
    for (int32_t k = 0; k < 3 * now->patch->nt; k++) {
        memcpy(state->uv + 2 * (int64_t)now->patch->corner[k], now->uv + 2 * (int64_t)now->patch->tri[k],
               2 * sizeof *state->uv);
    }
    for (int32_t t = 0; t < now->patch->nt; t++) {
        state->chart_of[now->patch->facet[t]] = (int32_t)c;
    }
    state->chart[c].stamp = state->next_stamp++;
}

sl_status sl_opt_apply(sl_opt_state *state, sl_opt_trial *trial)
{
    const int32_t *twin = state->surface->patch->twin;
    const sl_status status =
        sl_reserve((void **)&state->chart, &state->capacity, state->nchart + trial->nto, sizeof *state->chart);
    if (status != SL_OK) {
        return status;
    }
    for (int32_t k = 0; k < trial->nedge; k++) {
        state->cut[trial->edge[k]] = state->cut[twin[trial->edge[k]]] = trial->sew || k < trial->nback ? 0 : 1;
    }
    int32_t k = 0;
    for (int32_t j = 0; j < 2; j++) {
        if (trial->old[j] < 0) {
            continue;
        }
        sl_opt_chart_clear(&state->chart[trial->old[j]]);
        if (k < trial->nto) {
            place(state, trial->old[j], &trial->to[k++]);
        }
    }
    for (; k < trial->nto; k++) {
        place(state, state->nchart++, &trial->to[k]);
    }
    for (int64_t c = state->nchart; c-- > 0;) { /* holes are filled from the end */
        if (state->chart[c].patch == NULL) {
            state->nchart--;
            if (c < state->nchart) {
                renumber(state, state->nchart, c);
            }
        }
    }
    sl_opt_trial_clear(trial);
    return SL_OK;
}
