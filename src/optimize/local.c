/* What a cut would gain, by its surroundings alone: the triangles near it are solved with the rim held. */
#include "optimize/optimize_internal.h"

#include "base/memory.h"

#include <math.h>
#include <string.h>

static const double REACH = 0.12; /* from the cut, over sqrt(area of the surface) */
static const int32_t STEPS = 3;
static const double DART_GROWTH = 2.0, MOST_GROWTH = 2.2, SPLIT_GROWTH = 1.4;

/* The surroundings of a cut in its chart, and work of the surface's size that is clean before and after. */
typedef struct surroundings {
    int32_t *list;  /* triangles of the surface */
    int32_t *local; /* nt of the surface, -1 */
    uint8_t *cut;   /* 3 nt of the surface: flags as they would be */
    int32_t count;
    sl_patch *patch;
    double *uv;     /* patch->nv x 2 */
    uint8_t *fixed; /* patch->nv */
} surroundings;

static void surroundings_clear(surroundings *s)
{
    sl_free(s->list);
    sl_free(s->local);
    sl_free(s->cut);
    sl_patch_free(s->patch);
    sl_free(s->uv);
    sl_free(s->fixed);
}

static double distance2(const double *a, const double *b)
{
    const double x = a[0] - b[0], y = a[1] - b[1], z = a[2] - b[2];
    return x * x + y * y + z * z;
}

/* Triangles within reach: breadth-first from the cut; a triangle is as far as its first corner from the point of the
 * cut that its way began at. origin: of a listed triangle. */
static void gather(const sl_opt_state *state, const sl_opt_trial *trial, int32_t *origin, surroundings *s)
{
    const sl_patch *p = state->surface->patch;
    const double reach = REACH * state->surface->unit, limit = reach * reach;
    for (int32_t k = 0; k < trial->nedge; k++) {
        const int32_t side[2] = {trial->edge[k], p->twin[trial->edge[k]]};
        for (int j = 0; j < 2; j++) {
            if (s->local[side[j] / 3] < 0) {
                s->local[side[j] / 3] = 0;
                origin[s->count] = p->tri[side[j]];
                s->list[s->count++] = side[j] / 3;
            }
        }
    }
    for (int32_t n = 0; n < s->count; n++) {
        for (int32_t c = 3 * s->list[n]; c < 3 * s->list[n] + 3; c++) {
            const int32_t g = p->twin[c] >= 0 && state->cut[c] == 0 ? p->twin[c] / 3 : -1;
            if (g >= 0 && s->local[g] < 0 &&
                distance2(p->xyz + 3 * (int64_t)p->tri[3 * g], p->xyz + 3 * (int64_t)origin[n]) <= limit) {
                s->local[g] = 0;
                origin[s->count] = origin[n];
                s->list[s->count++] = g;
            }
        }
    }
    for (int32_t n = 0; n < s->count; n++) {
        s->local[s->list[n]] = -1;
    }
}

/* Vertices on the rim stay where they are. */
static void hold_rim(const sl_opt_state *state, surroundings *s)
{
    const sl_patch *whole = state->surface->patch, *p = s->patch;
    for (int32_t c = 0; c < 3 * p->nt; c++) {
        const int32_t h = p->corner[c];
        memcpy(s->uv + 2 * (int64_t)p->tri[c], state->uv + 2 * (int64_t)h, 2 * sizeof *s->uv);
        if (p->twin[c] < 0 && whole->twin[h] >= 0 && s->cut[h] == 0) {
            s->fixed[p->tri[c]] = s->fixed[p->tri[sl_corner_next(c)]] = 1;
        }
    }
}

static sl_status init(const sl_opt_state *state, const sl_opt_trial *trial, surroundings *s)
{
    sl_status status = SL_OK;
    const sl_patch *whole = state->surface->patch;
    const int64_t nt = whole->nt;
    int32_t *origin = sl_alloc(nt, sizeof *origin);
    s->list = sl_alloc(nt, sizeof *s->list);
    s->local = sl_alloc(nt, sizeof *s->local);
    s->cut = sl_copy(state->cut, 3 * nt, sizeof *s->cut);
    SL_TRY(origin == NULL || s->list == NULL || s->local == NULL || s->cut == NULL ? SL_OUT_OF_MEMORY : SL_OK);
    memset(s->local, 0xff, (size_t)nt * sizeof *s->local);
    for (int32_t k = 0; k < trial->nedge; k++) {
        s->cut[trial->edge[k]] = s->cut[whole->twin[trial->edge[k]]] = 1;
    }
    gather(state, trial, origin, s);
    SL_TRY(sl_opt_extract(state->surface, s->cut, s->list, s->count, s->local, &s->patch));
    s->uv = sl_alloc(2 * (int64_t)s->patch->nv, sizeof *s->uv);
    s->fixed = sl_calloc(s->patch->nv, sizeof *s->fixed);
    SL_TRY(s->uv == NULL || s->fixed == NULL ? SL_OUT_OF_MEMORY : SL_OK);
    hold_rim(state, s);
cleanup:
    sl_free(origin);
    return status;
}

/* What the rest of the chart adds to the gain: over 500 cuts of four meshes. */
static double growth(const sl_opt_trial *trial)
{
    return trial->nto > 1 ? SPLIT_GROWTH : fmin(1.0 + DART_GROWTH * trial->length, MOST_GROWTH);
}

sl_status sl_opt_trial_guess(const sl_opt_state *state, sl_opt_trial *trial)
{
    sl_status status = SL_OK;
    surroundings s = {0};
    sl_opt_sums before, after;
    sl_opt_sums sums = state->chart[trial->old[0]].sums;
    sl_stretch_def def = sl_stretch_default();
    trial->length = trial->cost = 0.0;
    for (int32_t k = 0; k < trial->nedge; k++) {
        trial->length += state->surface->length[trial->edge[k]] / state->surface->unit;
        trial->cost += state->surface->cost[trial->edge[k]] / state->surface->unit;
    }
    SL_TRY(init(state, trial, &s));
    sl_opt_measure(state->surface, s.patch, s.uv, &before, NULL);
    def.w = state->w;
    def.max_iterations = STEPS;
    def.fixed = s.fixed;
    status = sl_stretch_minimise(s.patch, &def, &state->quiet, s.uv, NULL);
    trial->valid = status == SL_OK;
    status = status == SL_BAD_INPUT || status == SL_SINGULAR || status == SL_NOT_POSITIVE_DEFINITE ? SL_OK : status;
    sl_opt_measure(state->surface, s.patch, s.uv, &after, NULL);
    sums.plane += after.plane - before.plane;
    sums.inverse += after.inverse - before.inverse;
    sums.shear += after.shear - before.shear;
    const double loss = sl_opt_loss(state, &state->chart[trial->old[0]].sums);
    trial->loss = loss - growth(trial) * (loss - sl_opt_loss(state, &sums));
cleanup:
    surroundings_clear(&s);
    return status;
}
