/* From a session to an atlas that can be written. */
#include "edit/session_internal.h"

#include "atlas/sidecar.h"
#include "base/file.h"
#include "base/memory.h"
#include "meshio/meshfile.h"

#include <math.h>
#include <string.h>

static sl_status copy_triangulation(const sl_triangulation *from, int32_t nf, sl_triangulation **out)
{
    sl_triangulation *t = sl_calloc(1, sizeof *t);
    *out = t;
    if (t == NULL) {
        return SL_OUT_OF_MEMORY;
    }
    t->nt = from->nt;
    t->first = sl_copy(from->first, (int64_t)nf + 1, sizeof *t->first);
    t->corner = sl_copy(from->corner, from->nt, 3 * sizeof *t->corner);
    return t->first != NULL && t->corner != NULL ? SL_OK : SL_OUT_OF_MEMORY;
}

static sl_status copy_repair(const sl_repair_report *from, sl_repair_report *out)
{
    *out = *from;
    out->reversed = sl_copy(from->reversed, from->reversed_faces, sizeof(int32_t));
    out->duplicate = sl_copy(from->duplicate, from->duplicate_faces, sizeof(int32_t));
    out->degenerate = sl_copy(from->degenerate, from->degenerate_faces, sizeof(int32_t));
    out->bowtie = sl_copy(from->bowtie, from->bowtie_vertices, sizeof(int32_t));
    out->nonmanifold = sl_copy(from->nonmanifold, from->nonmanifold_edges, 2 * sizeof(int32_t));
    return out->reversed != NULL && out->duplicate != NULL && out->degenerate != NULL && out->bowtie != NULL &&
                   out->nonmanifold != NULL
               ? SL_OK
               : SL_OUT_OF_MEMORY;
}

/* Charts in order of their first facets: number[slot], slot_of[number]. Returns how many. */
static int32_t number_charts(const sl_session *s, int32_t *number, int32_t *slot_of)
{
    int32_t n = 0;
    for (int32_t i = 0; i < s->slots; i++) {
        number[i] = -1;
    }
    for (int32_t f = 0; f < s->mesh->nf; f++) {
        if (number[s->face_chart[f]] < 0) {
            slot_of[n] = s->face_chart[f];
            number[s->face_chart[f]] = n++;
        }
    }
    return n;
}

static sl_flatten_verdict judge(const sl_session *s, const sl_edit_chart *chart)
{
    if (!chart->flat.certificate.embedded) {
        return SL_CHART_OVERLAPS;
    }
    return chart->nface == 1 || chart->flat.distortion.l2 <= s->def.segment.flatten.max_stretch ? SL_CHART_VALID
                                                                                                : SL_CHART_STRETCHED;
}

/* One chart and its UVs, in units of the page's common scale. */
static sl_status fill_chart(const sl_session *s, const int32_t *number, int32_t c, int32_t index, double page_scale,
                            sl_atlas *atlas)
{
    sl_segmentation *seg = atlas->segmentation;
    const sl_edit_slot *slot = &s->slot[index];
    const sl_edit_chart *chart = slot->chart;
    const double unit = slot->scale / page_scale;
    sl_chart *out = &seg->chart[c];
    int32_t k = 0;
    out->first = c > 0 ? seg->chart[c - 1].first + seg->chart[c - 1].count : 0;
    out->count = chart->nface;
    out->flat = chart->flat;
    out->flat.verdict = judge(s, chart);
    out->copy_of = slot->copy_of >= 0 ? number[slot->copy_of] : -1;
    out->mirrored = slot->mirrored;
    out->kind = slot->kind;
    for (int32_t i = 0; i < chart->nface; i++) {
        const int32_t f = chart->face[i];
        seg->face[out->first + i] = f;
        seg->face_chart[f] = c;
        for (int64_t h = s->mesh->face_first[f]; h < s->mesh->face_first[f + 1]; h++, k++) {
            seg->corner_uv[2 * h] = unit * chart->uv[2 * (int64_t)k];
            seg->corner_uv[2 * h + 1] = unit * chart->uv[2 * (int64_t)k + 1];
            if (slot->map != NULL) {
                seg->source[h] = slot->map->from[k];
            }
        }
    }
    atlas->placement[c].angle = slot->angle;
    memcpy(atlas->placement[c].offset, slot->offset, sizeof slot->offset);
    return sl_mesh_topology(atlas->mesh, chart->face, chart->nface, &out->topology);
}

/* What copies save, by area. */
static void measure_sharing(const sl_session *s, sl_segmentation *seg)
{
    double copies = 0.0, all = 0.0;
    seg->sharing = s->base->segmentation->sharing;
    seg->sharing.copies = 0;
    for (int32_t c = 0; c < seg->nchart; c++) {
        const bool copy = seg->chart[c].copy_of >= 0;
        seg->sharing.copies += copy;
        for (int32_t i = seg->chart[c].first; i < seg->chart[c].first + seg->chart[c].count; i++) {
            const double area = sl_mesh_face_area(s->mesh, seg->face[i]);
            all += area;
            copies += copy ? area : 0.0;
        }
    }
    seg->sharing.area = all > 0.0 ? copies / all : 0.0;
}

static sl_status allocate_segmentation(const sl_session *s, sl_segmentation **out)
{
    const sl_segmentation *base = s->base->segmentation;
    sl_segmentation *seg = sl_calloc(1, sizeof *seg);
    *out = seg;
    if (seg == NULL) {
        return SL_OUT_OF_MEMORY;
    }
    seg->chart = sl_calloc(s->slots, sizeof *seg->chart);
    seg->face = sl_alloc(s->mesh->nf, sizeof *seg->face);
    seg->face_chart = sl_alloc(s->mesh->nf, sizeof *seg->face_chart);
    seg->corner_uv = sl_calloc(s->mesh->nh, 2 * sizeof *seg->corner_uv);
    seg->source = sl_alloc(s->mesh->nh, sizeof *seg->source);
    seg->split = sl_copy(base->split, base->nsplit, sizeof *base->split);
    if (seg->chart == NULL || seg->face == NULL || seg->face_chart == NULL || seg->corner_uv == NULL ||
        seg->source == NULL || seg->split == NULL) {
        return SL_OUT_OF_MEMORY;
    }
    seg->nsplit = base->nsplit;
    seg->merges = base->merges;
    seg->paired = base->paired;
    seg->paired_fraction = base->paired_fraction;
    for (int32_t h = 0; h < s->mesh->nh; h++) {
        seg->source[h] = -1;
    }
    return SL_OK;
}

/* One warning a chart that is not what one would like. */
static sl_status warn(const sl_session *s, sl_atlas *atlas)
{
    const sl_segmentation *seg = atlas->segmentation;
    atlas->warning = sl_calloc(seg->nchart, sizeof *atlas->warning);
    if (atlas->warning == NULL) {
        return SL_OUT_OF_MEMORY;
    }
    for (int32_t c = 0; c < seg->nchart; c++) {
        sl_warning *w = &atlas->warning[atlas->nwarning];
        if (seg->chart[c].flat.verdict == SL_CHART_VALID) {
            continue;
        }
        w->chart = c;
        if (seg->chart[c].flat.verdict == SL_CHART_STRETCHED) {
            snprintf(w->text, sizeof w->text, "chart %d (%d facets): stretch L2 %.4g is above the bound %.4g", c,
                     seg->chart[c].count, seg->chart[c].flat.distortion.l2, s->def.segment.flatten.max_stretch);
        } else {
            snprintf(w->text, sizeof w->text, "chart %d (%d facets) overlaps itself", c, seg->chart[c].count);
        }
        atlas->nwarning++;
    }
    return SL_OK;
}

sl_status sl_session_export(const sl_session *s, const sl_context *context, sl_atlas **out, sl_diag *diag)
{
    sl_status status = SL_OK;
    sl_atlas *atlas = sl_calloc(1, sizeof *atlas);
    int32_t *number = sl_alloc(s->slots, sizeof *number), *slot_of = sl_alloc(s->slots, sizeof *slot_of);
    *out = NULL;
    SL_TRY(atlas != NULL && number != NULL && slot_of != NULL ? SL_OK : SL_OUT_OF_MEMORY);
    SL_TRY(sl_mesh_copy(s->mesh, &atlas->mesh));
    SL_TRY(copy_triangulation(s->base->triangulation, s->mesh->nf, &atlas->triangulation));
    SL_TRY(copy_repair(&s->base->repair, &atlas->repair));
    SL_TRY(allocate_segmentation(s, &atlas->segmentation));
    atlas->corner_uv = sl_alloc(s->mesh->nh, 2 * sizeof *atlas->corner_uv);
    atlas->input_corner_uv = sl_alloc(s->mesh->nh, 2 * sizeof *atlas->input_corner_uv);
    atlas->placement = sl_calloc(s->slots, sizeof *atlas->placement);
    SL_TRY(atlas->corner_uv != NULL && atlas->input_corner_uv != NULL && atlas->placement != NULL ? SL_OK
                                                                                                  : SL_OUT_OF_MEMORY);
    atlas->pack = s->base->pack;
    atlas->segmentation->nchart = number_charts(s, number, slot_of);
    for (int32_t c = 0; c < atlas->segmentation->nchart; c++) {
        SL_TRY(fill_chart(s, number, c, slot_of[c], s->base->pack.scale, atlas));
    }
    measure_sharing(s, atlas->segmentation);
    if (atlas->segmentation->sharing.copies == 0) {
        sl_free(atlas->segmentation->source);
        atlas->segmentation->source = NULL;
    }
    SL_TRY(warn(s, atlas));
    status = sl_atlas_settle(atlas, &s->def, context);
    if (status == SL_BAD_INPUT) {
        sl_diag_reason(diag, "a chart lies too far from the page to be judged");
    }
    SL_TRY(status);
    *out = atlas;
    atlas = NULL;
cleanup:
    sl_atlas_free(atlas);
    sl_free(number);
    sl_free(slot_of);
    return status;
}

/* The sidecar is renamed into place after the mesh: neither is ever half there. */
static sl_status write_files(const sl_session *s, const sl_atlas *atlas, const sl_meshfile *file, const char *path,
                             sl_diag *diag)
{
    char side[4096], *text = NULL;
    sl_writer *sidecar = NULL;
    sl_status status = SL_OK;
    const bool to_stdout = strcmp(path, "-") == 0;
    if (!to_stdout) {
        sl_sidecar_path(path, side, sizeof side);
        SL_TRY(sl_sidecar_text(atlas, &s->def, &text));
        SL_TRY(sl_writer_create(side, &sidecar, diag));
        sl_writer_text(sidecar, text);
    }
    SL_TRY(sl_meshfile_write(path, file, atlas->input_corner_uv, diag));
    if (!to_stdout) {
        status = sl_writer_commit(sidecar, diag);
        sidecar = NULL;
    }
cleanup:
    sl_writer_abandon(sidecar);
    sl_free(text);
    return status;
}

sl_status sl_session_save(const sl_session *s, const struct sl_meshfile *file, const char *path, bool allow_overlap,
                          const sl_context *context, sl_atlas_check *check, sl_diag *diag)
{
    sl_status status = SL_OK;
    sl_atlas *atlas = NULL;
    SL_TRY(sl_session_export(s, context, &atlas, diag));
    if (check != NULL) {
        *check = atlas->check;
    }
    if (!atlas->check.passed && !(allow_overlap && atlas->check.unlike == 0 && atlas->check.flipped == 0)) {
        sl_diag_reason(diag, "%d charts may overlap themselves, %lld texels are hit twice, %d triangles are flipped",
                       atlas->check.uncertified_charts, (long long)atlas->check.overlapping_texels,
                       atlas->check.flipped);
        sl_diag_hint(diag, "pack the charts, sew or bend what is red, or allow overlaps");
        SL_TRY(SL_CHECK_FAILED);
    }
    SL_TRY(write_files(s, atlas, file, path, diag));
cleanup:
    sl_atlas_free(atlas);
    return status;
}
