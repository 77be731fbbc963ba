/* The charts that a session begins with: the automatic atlas's, or the input's own UVs. */
#include "edit/session_internal.h"

#include "base/memory.h"
#include "overlap/certificate.h"

#include <math.h>
#include <string.h>

/* UVs of the patch's vertices, from an array by mesh halfedge. */
static void gather_own(const sl_patch *patch, const double *by_halfedge, double *uv)
{
    for (int32_t c = 0; c < 3 * patch->nt; c++) {
        memcpy(uv + 2 * (int64_t)patch->tri[c], by_halfedge + 2 * (int64_t)patch->corner[c], 2 * sizeof *uv);
    }
}

/* The input's UVs, where they are one flip-free layout: finite, equal at the corners of each vertex. */
static sl_status gather_input(const sl_session *s, const sl_patch *patch, const double *input, double *uv, bool *good)
{
    sl_certificate certificate;
    *good = sl_patch_is_disk(patch);
    for (int32_t c = 0; c < 3 * patch->nt && *good; c++) {
        const double *from = input + 2 * (int64_t)sl_input_corner(s->mesh, patch->corner[c]);
        double *to = uv + 2 * (int64_t)patch->tri[c];
        if (!isfinite(from[0]) || !isfinite(from[1]) || fabs(from[0]) > 1e4 || fabs(from[1]) > 1e4) {
            *good = false;
        }
        memcpy(to, from, 2 * sizeof *to);
    }
    for (int32_t c = 0; c < 3 * patch->nt && *good; c++) {
        const double *from = input + 2 * (int64_t)sl_input_corner(s->mesh, patch->corner[c]);
        const double *to = uv + 2 * (int64_t)patch->tri[c];
        *good = from[0] == to[0] && from[1] == to[1];
    }
    if (!*good) {
        return SL_OK;
    }
    const sl_status status = sl_certify_embedding(uv, patch->nt, patch->tri, 0, NULL, &certificate);
    *good = status == SL_OK && certificate.flipped == 0 && certificate.degenerate == 0;
    return status;
}

/* Chart c of the atlas into slot c. */
static sl_status take_chart(sl_session *s, int32_t c, const double *input, const sl_context *context)
{
    const sl_segmentation *seg = s->base->segmentation;
    const sl_chart *chart = &seg->chart[c];
    const int32_t *faces = seg->face + chart->first;
    sl_status status = SL_OK;
    sl_patch *patch = NULL;
    double *uv = NULL;
    bool kept = false;
    sl_edit_slot *slot = &s->slot[c];
    sl_flatten_result flat = chart->flat;
    SL_TRY(sl_patch_extract(s->mesh, s->base->triangulation, faces, chart->count, &patch));
    uv = sl_calloc(patch->nv, 2 * sizeof *uv);
    SL_TRY(uv != NULL ? SL_OK : SL_OUT_OF_MEMORY);
    if (input != NULL) {
        SL_TRY(gather_input(s, patch, input, uv, &kept));
    }
    if (!kept) {
        gather_own(patch, seg->corner_uv, uv);
        if (input != NULL) {
            sl_edit_note(s, "the chart of facet %d: its UVs are no flip-free disk, laid flat anew", faces[0]);
        }
    }
    SL_TRY(sl_edit_chart_create(s, patch, faces, chart->count, uv, chart->mirrored, &flat, context, &slot->chart));
    slot->chart->kept = kept;
    *slot = (sl_edit_slot){.chart = slot->chart,
                           .copy_of = chart->copy_of,
                           .mirrored = chart->mirrored,
                           .kind = chart->kind,
                           .scale = kept ? 1.0 : s->base->pack.scale,
                           .angle = kept ? 0.0 : s->base->placement[c].angle};
    memcpy(slot->offset, s->base->placement[c].offset, sizeof slot->offset);
    if (kept) {
        slot->offset[0] = slot->offset[1] = 0.0;
    }
cleanup:
    sl_patch_free(patch);
    sl_free(uv);
    return status;
}

/* Which corners a copy's corners show. */
static sl_status take_map(sl_session *s, int32_t c)
{
    const sl_segmentation *seg = s->base->segmentation;
    const sl_edit_chart *chart = s->slot[c].chart;
    sl_edit_map *map = sl_calloc(1, sizeof *map);
    int32_t n = 0;
    s->slot[c].map = map;
    if (map == NULL) {
        return SL_OUT_OF_MEMORY;
    }
    map->refs = 1;
    map->count = chart->ncorner;
    map->from = sl_alloc(chart->ncorner, sizeof *map->from);
    if (map->from == NULL) {
        return SL_OUT_OF_MEMORY;
    }
    for (int32_t i = 0; i < chart->nface; i++) {
        for (int32_t h = s->mesh->face_first[chart->face[i]]; h < s->mesh->face_first[chart->face[i] + 1]; h++) {
            map->from[n++] = seg->source[h];
        }
    }
    return SL_OK;
}

sl_status sl_edit_take_charts(sl_session *s, const double *corner_uv, const sl_context *context)
{
    sl_status status = SL_OK;
    const int32_t n = s->base->segmentation->nchart;
    const double *input = s->def.seams == SL_SEAMS_KEEP_UV ? corner_uv : NULL;
    SL_TRY(sl_reserve((void **)&s->slot, &s->slot_room, n, sizeof *s->slot));
    for (int32_t c = 0; c < n; c++) {
        s->slot[c] = (sl_edit_slot){.copy_of = -1};
        s->slots++;
        SL_TRY(take_chart(s, c, input, context));
        if (s->slot[c].copy_of >= 0) {
            SL_TRY(take_map(s, c));
        }
    }
cleanup:
    return status;
}
