/* The optimiser as a cutter of the segmentation: one piece in, its seams and UVs out. */
#include "optimize/optimize_internal.h"

#include "base/memory.h"

#include <math.h>
#include <stdatomic.h>
#include <string.h>

static const int ROUNDS = 3;          /* of cutting and sewing */
static const double MAIN_SHARE = 0.4; /* of a mesh's area: smaller pieces lie in the gaps of others as they are */

sl_optimize_def sl_optimize_default(void)
{
    return (sl_optimize_def){.target_stretch = 1.05,
                             .target_angle = 1.2,
                             .max_stretch = 1.5,
                             .max_angle = 1.75,
                             .chart_cost = 0.3,
                             .seam_cost = 1.0,
                             .empty_cost = 1.0,
                             .start_stretch = 2.5,
                             .protect = SL_PROTECT_AXIS,
                             .weights = sl_seam_cost_default(),
                             .effort = 1.0,
                             .max_cuts = 400,
                             .max_sewings = 100000};
}

/* What the pieces report to, side by side: sums of whole numbers do not depend on the order. */
typedef struct optimizer {
    const sl_optimize_def *def;
    double area; /* of the mesh, as it was read */
    atomic_int pieces, missed, direct, cuts, sewings, straightened, trials;
    atomic_llong microseconds[SL_OPTIMIZE_STAGES];
} optimizer;

static void write_back(const sl_opt_state *state, sl_mesh *mesh, double *corner_uv)
{
    const sl_patch *p = state->surface->patch;
    for (int32_t c = 0; c < 3 * p->nt; c++) {
        if (state->cut[c] != 0) {
            sl_mesh_cut_edge(mesh, p->corner[c]);
        }
        const sl_opt_chart *chart = &state->chart[state->chart_of[c / 3]];
        const double scale = sl_opt_best_scale(&chart->sums);
        for (int k = 0; k < 2; k++) {
            corner_uv[2 * (int64_t)p->corner[c] + k] = scale * state->uv[2 * (int64_t)c + k];
        }
    }
}

double sl_opt_price(const sl_opt_state *state)
{
    double sum = 0.0;
    const sl_patch *p = state->surface->patch;
    for (int32_t c = 0; c < 3 * p->nt; c++) {
        sum += state->cut[c] != 0 && p->twin[c] > c ? state->surface->cost[c] : 0.0;
    }
    return state->def->seam_cost * sum / state->surface->unit + state->def->chart_cost * (double)state->nchart;
}

sl_status sl_opt_search(sl_opt_state *state)
{
    sl_status status = SL_OK;
    double best = HUGE_VAL;
    for (int k = 0; k < ROUNDS; k++) {
        SL_TRY(sl_report_progress(state->context, "optimise", (double)k / ROUNDS));
        const int32_t cuts = state->info.cuts;
        SL_TRY(sl_opt_cut(state));
        if (k > 0 && state->info.cuts == cuts) {
            break; /* sewing came to its end with these charts */
        }
        SL_TRY(sl_opt_sew(state));
        const double since = sl_opt_clock();
        SL_TRY(sl_opt_straighten(state));
        (void)sl_opt_book(state, SL_OPTIMIZE_STRAIGHTEN, since);
        const double now = sl_opt_price(state);
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
    optimizer *o = user;
    sl_opt_surface surface = {0};
    sl_opt_state state = {0};
    *done = false;
    SL_TRY(sl_opt_surface_init(piece, triangulation, def->edge_weight, &surface));
    if (!(surface.total > 0.0)) {
        goto cleanup; /* nothing but degenerate facets */
    }
    SL_TRY(sl_opt_state_init(&surface, o->def, context, &state));
    SL_TRY(sl_opt_piece(&state, def, triangulation, done));
    if (*done && surface.total / (piece->scale * piece->scale) >= MAIN_SHARE * o->area) {
        SL_TRY(sl_opt_compact(&state));
    }
    if (*done) {
        sl_opt_total total;
        sl_opt_totals(&state, &total);
        o->missed += !sl_opt_within(&state, &total);
        write_back(&state, piece, corner_uv);
    }
    o->pieces++;
    o->direct += state.info.direct;
    o->cuts += state.info.cuts;
    o->sewings += state.info.sewings;
    o->straightened += state.info.straightened;
    o->trials += state.info.trials;
    for (int k = 0; k < SL_OPTIMIZE_STAGES; k++) {
        o->microseconds[k] += llround(1e6 * state.info.seconds[k]);
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
    optimizer o = {.def = def};
    const sl_cutter cutter = {cut_piece, &o};
    sl_segment_def with = *segment;
    double *weight = NULL;
    for (int32_t f = 0; f < mesh->nf; f++) {
        o.area += sl_mesh_face_area(mesh, f) / (mesh->scale * mesh->scale);
    }
    sl_status status = sl_opt_weights(mesh, &def->weights, segment->pairing, context, &weight);
    if (status != SL_OK) {
        *out = NULL;
        return status;
    }
    with.cutter = &cutter;
    with.edge_weight = weight;
    with.sew = false;
    with.flatten.max_stretch = def->max_stretch;
    with.flatten.max_angle = def->max_angle;
    status = sl_segment(mesh, triangulation, &with, context, out);
    sl_free(weight);
    if (status == SL_OK && info != NULL) {
        *info = (sl_optimize_info){.pieces = o.pieces,
                                   .failed = o.pieces,
                                   .missed = o.missed,
                                   .direct = o.direct,
                                   .cuts = o.cuts,
                                   .sewings = o.sewings,
                                   .straightened = o.straightened,
                                   .trials = o.trials};
        for (int k = 0; k < SL_OPTIMIZE_STAGES; k++) {
            info->seconds[k] = 1e-6 * (double)o.microseconds[k];
        }
        for (int32_t k = 0; k < (*out)->nsplit; k++) {
            info->failed -= (*out)->split[k].optimised;
        }
    }
    return status;
}
