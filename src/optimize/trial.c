/* Trials: what would come of cutting or sewing some edges. */
#include "optimize/optimize_internal.h"

#include "base/memory.h"
#include "param/stretch.h"

#include <math.h>
#include <string.h>

static const double SKETCH_HOPE = 1.03; /* share of the budgets beyond which a sewing is refused half solved */

void sl_opt_trial_clear(sl_opt_trial *trial)
{
    for (int32_t k = 0; trial->to != NULL && k < trial->nto; k++) {
        sl_opt_chart_clear(&trial->to[k]);
    }
    sl_free(trial->to);
    sl_free(trial->edge);
    *trial = (sl_opt_trial){0};
}

/* Work for taking a trial's triangles apart. */
typedef struct making {
    uint8_t *cut;   /* 3 nt: flags as they would be */
    int32_t *local; /* nt: -1 */
    int32_t *list;  /* triangles, component by component */
    int32_t *first; /* of components */
    int32_t count, ncomponents;
} making;

static void making_clear(making *m)
{
    sl_free(m->cut);
    sl_free(m->local);
    sl_free(m->list);
    sl_free(m->first);
}

static sl_status making_init(const sl_opt_state *state, const sl_opt_trial *trial, making *m)
{
    const sl_patch *whole = state->surface->patch;
    int64_t count = 0;
    for (int j = 0; j < 2; j++) {
        count += trial->old[j] >= 0 ? state->chart[trial->old[j]].patch->nt : 0;
    }
    *m = (making){.cut = sl_copy(state->cut, 3 * (int64_t)whole->nt, sizeof *m->cut),
                  .local = sl_alloc(whole->nt, sizeof *m->local),
                  .list = sl_alloc(count, sizeof *m->list),
                  .first = sl_alloc(count + 1, sizeof *m->first),
                  .count = (int32_t)count};
    if (m->cut == NULL || m->local == NULL || m->list == NULL || m->first == NULL) {
        making_clear(m);
        return SL_OUT_OF_MEMORY;
    }
    memset(m->local, 0xff, (size_t)whole->nt * sizeof *m->local);
    for (int32_t k = 0; k < trial->nedge; k++) {
        m->cut[trial->edge[k]] = m->cut[whole->twin[trial->edge[k]]] = trial->sew || k < trial->nback ? 0 : 1;
    }
    return SL_OK;
}

/* Breadth-first from the lowest triangle of each component. local: 0 while a triangle waits, -1 after. */
static void find_components(const sl_opt_state *state, const sl_opt_trial *trial, making *m)
{
    const sl_patch *whole = state->surface->patch;
    int32_t n = 0;
    for (int j = 0; j < 2; j++) {
        const sl_patch *p = trial->old[j] >= 0 ? state->chart[trial->old[j]].patch : NULL;
        for (int32_t t = 0; p != NULL && t < p->nt; t++) {
            m->local[p->facet[t]] = 0;
        }
    }
    for (int j = 0; j < 2; j++) {
        const sl_patch *p = trial->old[j] >= 0 ? state->chart[trial->old[j]].patch : NULL;
        for (int32_t k = 0; p != NULL && k < p->nt; k++) {
            if (m->local[p->facet[k]] < 0) {
                continue;
            }
            m->first[m->ncomponents++] = n;
            m->local[p->facet[k]] = -1;
            m->list[n++] = p->facet[k];
            for (int32_t at = n - 1; at < n; at++) {
                for (int32_t c = 3 * m->list[at]; c < 3 * m->list[at] + 3; c++) {
                    const int32_t g = whole->twin[c] >= 0 && m->cut[c] == 0 ? whole->twin[c] / 3 : -1;
                    if (g >= 0 && m->local[g] == 0) {
                        m->local[g] = -1;
                        m->list[n++] = g;
                    }
                }
            }
        }
    }
    m->first[m->ncomponents] = n;
}

/* The map that the state's charts have there. */
static void take_map(const sl_opt_state *state, sl_opt_chart *chart)
{
    const sl_patch *p = chart->patch;
    for (int32_t c = 0; c < 3 * p->nt; c++) {
        memcpy(chart->uv + 2 * (int64_t)p->tri[c], state->uv + 2 * (int64_t)p->corner[c], 2 * sizeof *chart->uv);
    }
}

static sl_status make_chart(const sl_opt_state *state, const sl_opt_trial *trial, const making *m, int32_t k,
                            sl_opt_chart *chart)
{
    sl_status status = sl_opt_extract(state->surface, m->cut, m->list + m->first[k], m->first[k + 1] - m->first[k],
                                      m->local, &chart->patch);
    if (status != SL_OK) {
        return status;
    }
    const sl_patch *p = chart->patch;
    chart->uv = sl_calloc(2 * (int64_t)p->nv, sizeof *chart->uv);
    if (chart->uv == NULL) {
        return SL_OUT_OF_MEMORY;
    }
    if (trial->sew) {
        return sl_opt_close_banks(state, trial, p, chart->uv);
    }
    take_map(state, chart);
    return SL_OK;
}

sl_status sl_opt_trial_make(const sl_opt_state *state, sl_opt_trial *trial)
{
    sl_status status = SL_OK;
    making m = {0};
    trial->length = trial->cost = 0.0;
    for (int32_t k = 0; k < trial->nedge; k++) {
        trial->length += state->surface->length[trial->edge[k]] / state->surface->unit;
        trial->cost += state->surface->cost[trial->edge[k]] / state->surface->unit;
    }
    SL_TRY(making_init(state, trial, &m));
    find_components(state, trial, &m);
    trial->to = sl_calloc(m.ncomponents, sizeof *trial->to);
    SL_TRY(trial->to == NULL ? SL_OUT_OF_MEMORY : SL_OK);
    trial->nto = m.ncomponents;
    trial->valid = true;
    for (int32_t k = 0; k < m.ncomponents; k++) {
        SL_TRY(make_chart(state, trial, &m, k, &trial->to[k]));
        trial->valid = trial->valid && sl_patch_is_disk(trial->to[k].patch);
    }
cleanup:
    making_clear(&m);
    return status;
}

static void sum_loss(const sl_opt_state *state, sl_opt_trial *trial)
{
    trial->loss = 0.0;
    for (int32_t k = 0; k < trial->nto; k++) {
        sl_opt_measure(state->surface, trial->to[k].patch, trial->to[k].uv, &trial->to[k].sums, NULL);
        trial->loss += sl_opt_loss(state, &trial->to[k].sums);
    }
}

sl_status sl_opt_trial_probe(const sl_opt_state *state, int32_t steps, sl_opt_trial *trial)
{
    sl_status status = SL_OK;
    sl_stretch_def def = sl_stretch_default();
    def.w = state->w;
    def.max_iterations = steps;
    for (int32_t k = 0; k < trial->nto && trial->valid; k++) {
        status = sl_stretch_minimise(trial->to[k].patch, &def, &state->quiet, trial->to[k].uv, NULL);
        if (status == SL_BAD_INPUT || status == SL_SINGULAR || status == SL_NOT_POSITIVE_DEFINITE) {
            trial->valid = false;
            status = SL_OK;
        }
        SL_TRY(status);
    }
    sum_loss(state, trial);
cleanup:
    return status;
}

/* Two charts brought together that cross each other before anything has moved will hardly come apart. */
static sl_status drop_crossing(sl_opt_trial *trial)
{
    sl_certificate certificate = {0};
    if (!trial->sew || trial->old[1] < 0 || trial->nto != 1 || !trial->valid) {
        return SL_OK;
    }
    const sl_status status = sl_opt_certify(trial->to[0].patch, trial->to[0].uv, &certificate);
    trial->dropped = certificate.border_crossings > 0 && certificate.flipped + certificate.degenerate == 0;
    trial->valid = !trial->dropped;
    return status;
}

sl_status sl_opt_trial_settle(const sl_opt_state *state, sl_opt_effort effort, sl_opt_trial *trial)
{
    sl_status status = SL_OK;
    trial->valid = trial->nto > 0;
    for (int32_t k = 0; k < trial->nto; k++) {
        trial->valid = trial->valid && sl_patch_is_disk(trial->to[k].patch);
        if (effort == SL_OPT_WARM_ONLY) {
            take_map(state, &trial->to[k]);
        }
    }
    for (int32_t k = 0; k < trial->nto && trial->valid; k++) {
        SL_TRY(sl_opt_solve(state, trial->to[k].patch, effort, trial->to[k].uv, &trial->valid));
    }
    trial->settled = trial->valid;
    if (trial->valid) {
        sum_loss(state, trial);
    }
cleanup:
    return status;
}

/* Is the trial worth more steps? The larger share may still fall, by another weight of the energy, too. */
static bool has_hope(const sl_opt_state *state, const sl_opt_trial *trial, double slack)
{
    double largest, mean;
    sl_opt_shares(state, trial, &largest, &mean);
    return mean <= slack;
}

sl_status sl_opt_trial_sew(const sl_opt_state *state, sl_opt_trial *trial)
{
    sl_status status = SL_OK;
    sl_stretch_workspace *workspace = NULL;
    SL_TRY(drop_crossing(trial));
    if (!trial->valid || trial->nto != 1) {
        trial->valid = false;
        return SL_OK;
    }
    SL_TRY(sl_stretch_workspace_create(&workspace));
    SL_TRY(sl_opt_sketch(state, &trial->to[0], workspace, &trial->valid));
    if (trial->valid) {
        sum_loss(state, trial);
        if (has_hope(state, trial, SKETCH_HOPE)) {
            SL_TRY(sl_opt_finish(state, &trial->to[0], workspace, &trial->valid));
            sum_loss(state, trial);
        }
    }
    trial->settled = trial->valid;
cleanup:
    sl_stretch_workspace_free(workspace);
    return status;
}
