/* The first charts: the recursion's own spectral cuts, as few as will do. */
#include "optimize/optimize_internal.h"

#include "base/memory.h"

#include <math.h>
#include <string.h>

static sl_segment_def start_def(const sl_opt_state *state, const sl_segment_def *segment)
{
    sl_segment_def def = *segment;
    def.cutter = NULL;
    def.symmetry = SL_SYMMETRY_USE_OFF;
    def.test_halves = false;
    def.sew = false;
    def.join = true;
    def.flatten = sl_flatten_default();
    def.flatten.max_stretch = state->def->start_stretch;
    def.flatten.max_angle = INFINITY;
    return def;
}

/* Flags of the edges that are cut in `mesh` and were not in the surface's. */
static void take_seams(sl_opt_state *state, const sl_mesh *mesh, const sl_segmentation *seg)
{
    const sl_patch *p = state->surface->patch;
    const bool protect = state->def->protect == SL_PROTECT_FIRST;
    for (int32_t c = 0; c < 3 * p->nt; c++) {
        const int32_t h = p->corner[c], to = p->corner[sl_corner_next(c)];
        state->cut[c] = to == sl_next(mesh, h) && p->twin[c] >= 0 && mesh->twin[h] < 0;
        state->keep[c] = protect && state->cut[c] != 0 && seg->cut_after[h] == 0;
    }
}

/* The charts of the segmentation become charts of the state. */
static sl_status take_charts(sl_opt_state *state, const sl_segmentation *seg, bool *started)
{
    sl_status status = SL_OK;
    const sl_patch *p = state->surface->patch;
    int32_t *local = sl_alloc(p->nt, sizeof *local), *list = sl_alloc(p->nt, sizeof *list);
    int32_t *first = sl_calloc((int64_t)seg->nchart + 1, sizeof *first);
    SL_TRY(local == NULL || list == NULL || first == NULL ? SL_OUT_OF_MEMORY : SL_OK);
    memset(local, 0xff, (size_t)p->nt * sizeof *local);
    for (int32_t t = 0; t < p->nt; t++) {
        first[seg->face_chart[p->facet[t]]]++;
    }
    for (int32_t c = 0; c < seg->nchart; c++) {
        first[c + 1] += first[c];
    }
    for (int32_t t = p->nt; t-- > 0;) {
        list[--first[seg->face_chart[p->facet[t]]]] = t;
    }
    SL_TRY(sl_reserve((void **)&state->chart, &state->capacity, seg->nchart, sizeof *state->chart));
    for (int32_t c = 0; c < seg->nchart; c++) {
        sl_opt_chart *chart = &state->chart[state->nchart++];
        *chart = (sl_opt_chart){.stamp = state->next_stamp++};
        SL_TRY(
            sl_opt_extract(state->surface, state->cut, list + first[c], first[c + 1] - first[c], local, &chart->patch));
        chart->uv = sl_calloc(2 * (int64_t)chart->patch->nv, sizeof *chart->uv);
        SL_TRY(chart->uv == NULL ? SL_OUT_OF_MEMORY : SL_OK);
        *started = *started && sl_patch_is_disk(chart->patch);
        for (int32_t t = 0; t < chart->patch->nt; t++) {
            state->chart_of[chart->patch->facet[t]] = c;
        }
    }
cleanup:
    sl_free(local);
    sl_free(list);
    sl_free(first);
    return status;
}

/* Lays the charts flat, from the segmentation's UVs where they serve. */
static sl_status solve_charts(sl_opt_state *state, const sl_segmentation *seg, bool *started)
{
    sl_status status = SL_OK;
    const sl_patch *p = state->surface->patch;
    for (int32_t c = 0; c < state->nchart && *started; c++) {
        sl_opt_chart *chart = &state->chart[c];
        for (int32_t k = 0; k < 3 * chart->patch->nt; k++) {
            const int32_t h = p->corner[chart->patch->corner[k]];
            memcpy(chart->uv + 2 * (int64_t)chart->patch->tri[k], seg->corner_uv + 2 * (int64_t)h,
                   2 * sizeof *chart->uv);
        }
        SL_TRY(sl_opt_solve(state, chart->patch, SL_OPT_HELD, chart->uv, started));
        sl_opt_measure(state->surface, chart->patch, chart->uv, &chart->sums, NULL);
        for (int32_t k = 0; k < 3 * chart->patch->nt; k++) {
            memcpy(state->uv + 2 * (int64_t)chart->patch->corner[k], chart->uv + 2 * (int64_t)chart->patch->tri[k],
                   2 * sizeof *state->uv);
        }
    }
cleanup:
    return status;
}

sl_status sl_opt_take(sl_opt_state *state, const sl_mesh *mesh, const sl_segmentation *seg, bool *started)
{
    sl_status status = SL_OK;
    *started = true;
    take_seams(state, mesh, seg);
    SL_TRY(take_charts(state, seg, started));
    SL_TRY(solve_charts(state, seg, started));
cleanup:
    return status;
}

sl_status sl_opt_start(sl_opt_state *state, const sl_segment_def *segment, const sl_triangulation *triangulation,
                       bool *started)
{
    sl_status status = SL_OK;
    const double since = sl_opt_clock();
    sl_mesh *mesh = NULL;
    sl_segmentation *seg = NULL;
    const sl_segment_def def = start_def(state, segment);
    *started = true;
    SL_TRY(sl_mesh_copy(state->surface->mesh, &mesh));
    SL_TRY(sl_segment(mesh, triangulation, &def, state->context, &seg));
    SL_TRY(sl_opt_take(state, mesh, seg, started));
cleanup:
    (void)sl_opt_book(state, SL_OPTIMIZE_START, since);
    sl_mesh_free(mesh);
    sl_segmentation_free(seg);
    return status;
}
