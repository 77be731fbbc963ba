/* How well the two sides of a cut would flatten: a quick conformal map of each. */
#include "segment/segment_internal.h"

#include "base/memory.h"
#include "param/lscm.h"

#include <math.h>

#define FLIP_PENALTY 4.0     /* times the share of flipped triangles, added to log L2 */
#define OVERLAP_PENALTY 0.3  /* added to log L2 where the border crosses itself */
#define TOPOLOGY_PENALTY 8.0 /* log L2 of a side that no cut between its loops makes a disk ... */
#define HANDLE_PENALTY 4.0   /* ... and for each of its handles */
#define WORST_LOG_L2 20.0    /* a collapsed map counts as this */

/* log L2 of the conformal map of a disk, with the penalties. */
static sl_status disk_cost(const sl_patch *patch, const sl_context *context, double *cost)
{
    sl_status status = SL_OK;
    int32_t *border = NULL, nb = 0;
    sl_distortion d;
    sl_certificate certificate;
    *cost = WORST_LOG_L2;
    double *uv = sl_alloc(2 * (int64_t)patch->nv, sizeof *uv);
    if (uv == NULL) {
        SL_TRY(SL_OUT_OF_MEMORY);
    }
    status = sl_lscm(patch, context, uv);
    if (status == SL_SINGULAR) { /* no map: as bad as a collapsed one */
        status = SL_OK;
        goto cleanup;
    }
    SL_TRY(status);
    for (int32_t k = 0; k < 2 * patch->nv; k++) {
        if (!isfinite(uv[k])) {
            goto cleanup;
        }
    }
    SL_TRY(sl_distortion_measure_indexed(patch->nt, patch->tri, patch->xyz, uv, &d));
    SL_TRY(sl_patch_border_pairs(patch, &border, &nb));
    SL_TRY(sl_certify_embedding(uv, patch->nt, patch->tri, nb, border, &certificate));
    const double log_l2 = d.l2 > 0.0 ? log(d.l2) : 0.0;
    *cost = fmin(isfinite(log_l2) ? log_l2 : WORST_LOG_L2, WORST_LOG_L2);
    *cost += FLIP_PENALTY * (certificate.flipped + certificate.degenerate) / (double)patch->nt;
    *cost += certificate.border_crossings > 0 ? OVERLAP_PENALTY : 0.0;
cleanup:
    sl_free(border);
    sl_free(uv);
    return status;
}

static sl_status side_cost(sl_piece *half, const sl_context *context, double *cost)
{
    sl_status status = SL_OK;
    sl_topology topology;
    sl_cut_list joined = {0};
    sl_patch *patch = NULL;
    SL_TRY(sl_piece_topology(half, &topology));
    *cost = TOPOLOGY_PENALTY + HANDLE_PENALTY * topology.genus;
    if (topology.genus == 0 && topology.loops > 1) {
        SL_TRY(sl_join_loops(half->mesh, half->weight, &joined));
    }
    if (topology.genus == 0 && topology.loops >= 1) {
        SL_TRY(sl_piece_patch(half, &patch));
        if (sl_patch_is_disk(patch)) {
            SL_TRY(disk_cost(patch, context, cost));
        }
    }
cleanup:
    sl_patch_free(patch);
    sl_cut_list_clear(&joined);
    return status;
}

/**
 * Score of a cut by looking one step ahead.
 *
 *     sum over both sides of area * (log L2 + penalties) / sum of areas
 *
 * L2 is Sander's stretch of the side's LSCM map, its loops joined by shortest paths first. Sides that cannot be made a
 * disk so, flips and borders that cross themselves are penalised.
 *
 * @param[in]  piece
 * @param[in]  side     a facet each, both values present, both sides connected
 * @param[in]  context  nullable
 * @param[out] score    smaller is better
 *
 * SL_OUT_OF_MEMORY, SL_CANCELLED. Two LSCM solves.
 */
sl_status sl_lookahead_score(const sl_piece *piece, const uint8_t *side, const sl_context *context, double *score)
{
    sl_status status = SL_OK;
    const int32_t n = piece->mesh->nf;
    sl_piece *half = NULL;
    double weighted = 0.0, total = 0.0;
    int32_t *face = sl_alloc(n, sizeof *face);
    if (face == NULL) {
        SL_TRY(SL_OUT_OF_MEMORY);
    }
    for (uint8_t which = 0; which < 2; which++) {
        int32_t count = 0;
        double area = 0.0, cost = 0.0;
        for (int32_t f = 0; f < n; f++) {
            if (side[f] == which) {
                face[count++] = f;
                area += sl_mesh_face_area(piece->mesh, f);
            }
        }
        SL_TRY(sl_piece_create(piece->mesh, piece->triangulation, face, count, &half));
        SL_TRY(sl_piece_weigh(half, piece->mesh, piece->weight));
        SL_TRY(side_cost(half, context, &cost));
        weighted += area * cost;
        total += area;
        sl_piece_free(half);
        half = NULL;
    }
    *score = total > 0.0 ? weighted / total : 0.0;
cleanup:
    sl_piece_free(half);
    sl_free(face);
    return status;
}
