/* The optimiser as a cutter of the segmentation: one piece in, its seams and UVs out. */
#include "optimize/optimize_internal.h"

#include "base/memory.h"

#include <math.h>
#include <string.h>

static const int ROUNDS = 3; /* of cutting and sewing */

sl_optimize_def sl_optimize_default(void)
{
    return (sl_optimize_def){.target_stretch = 1.05,
                             .target_angle = 1.2,
                             .max_stretch = 1.5,
                             .chart_cost = 0.3,
                             .seam_cost = 1.0,
                             .start_stretch = 2.5,
                             .protect = SL_PROTECT_AXIS,
                             .max_cuts = 400};
}

/* What the pieces report to, each in its own place. */
typedef struct optimizer {
    const sl_optimize_def *def;
    sl_optimize_info *info;
} optimizer;

/* The scale at which a chart adds least to the atlas's L2: I and a agree. */
static double best_scale(const sl_opt_sums *sums)
{
    return sums->plane > 0.0 && sums->inverse > 0.0 ? pow(sums->inverse / sums->plane, 0.25) : 1.0;
}

static void write_back(const sl_opt_state *state, sl_mesh *mesh, double *corner_uv)
{
    const sl_patch *p = state->surface->patch;
    for (int32_t c = 0; c < 3 * p->nt; c++) {
        if (state->cut[c] != 0) {
            sl_mesh_cut_edge(mesh, p->corner[c]);
        }
        const sl_opt_chart *chart = &state->chart[state->chart_of[c / 3]];
        const double scale = best_scale(&chart->sums);
        for (int k = 0; k < 2; k++) {
            corner_uv[2 * (int64_t)p->corner[c] + k] = scale * state->uv[2 * (int64_t)c + k];
        }
    }
}

static double price(const sl_opt_state *state)
{
    double sum = 0.0;
    const sl_patch *p = state->surface->patch;
    for (int32_t c = 0; c < 3 * p->nt; c++) {
        sum += state->cut[c] != 0 && p->twin[c] > c ? state->surface->cost[c] : 0.0;
    }
    return state->def->seam_cost * sum / state->surface->unit + state->def->chart_cost * (double)state->nchart;
}

static sl_status search(sl_opt_state *state)
{
    sl_status status = SL_OK;
    double best = HUGE_VAL;
    for (int k = 0; k < ROUNDS; k++) {
        SL_TRY(sl_report_progress(state->context, "optimise", (double)k / ROUNDS));
        SL_TRY(sl_opt_cut(state));
        SL_TRY(sl_opt_sew(state));
        const double now = price(state);
        if (!(now < best)) {
            break;
        }
        best = now;
    }
cleanup:
    return status;
}

static sl_status cut_piece(void *user, sl_mesh *piece, const sl_triangulation *triangulation, const sl_segment_def *def,
                           const sl_context *context, double *corner_uv, bool *done)
{
    sl_status status = SL_OK;
    const optimizer *o = user;
    sl_opt_surface surface = {0};
    sl_opt_state state = {0};
    *done = false;
    SL_TRY(sl_opt_surface_init(piece, triangulation, NULL, &surface));
    if (!(surface.total > 0.0)) {
        goto cleanup; /* nothing but degenerate facets */
    }
    SL_TRY(sl_opt_state_init(&surface, o->def, context, &state));
    SL_TRY(sl_opt_start(&state, def, triangulation, done));
    if (*done) {
        SL_TRY(search(&state));
        write_back(&state, piece, corner_uv);
    }
cleanup:
    sl_opt_state_clear(&state);
    sl_opt_surface_clear(&surface);
    return status;
}

sl_status sl_optimize_segment(sl_mesh *mesh, const sl_triangulation *triangulation, const sl_segment_def *segment,
                              const sl_optimize_def *def, const sl_context *context, sl_segmentation **out,
                              sl_optimize_info *info)
{
    optimizer o = {.def = def, .info = info};
    const sl_cutter cutter = {cut_piece, &o};
    sl_segment_def with = *segment;
    with.cutter = &cutter;
    with.sew = false;
    with.flatten.max_stretch = def->max_stretch;
    return sl_segment(mesh, triangulation, &with, context, out);
}
