/* Pieces cut as a whole by the caller's cutter, in place of the recursion. */
#include "segment/segment_internal.h"

#include "base/memory.h"
#include "param/distortion.h"

#include <string.h>

/* One cut piece on its way to finished charts. */
typedef struct cut_piece {
    const sl_recursion *recursion;
    sl_piece *piece;
    double *corner_uv;
    sl_cut_list cuts; /* halfedges of the piece, one an edge */
    int32_t *part, nparts;
} cut_piece;

static void cut_piece_clear(cut_piece *c)
{
    sl_free(c->corner_uv);
    sl_cut_list_clear(&c->cuts);
    sl_free(c->part);
}

/* Lists what the cutter cut: `before` = twins of the piece as it was. */
static sl_status list_cuts(cut_piece *c, const int32_t *before)
{
    const sl_mesh *m = c->piece->mesh;
    c->cuts.halfedge = sl_alloc(m->nh, sizeof *c->cuts.halfedge);
    if (c->cuts.halfedge == NULL) {
        return SL_OUT_OF_MEMORY;
    }
    for (int32_t h = 0; h < m->nh; h++) {
        if (before[h] > h && m->twin[h] < 0) {
            c->cuts.halfedge[c->cuts.count++] = h;
        }
    }
    return SL_OK;
}

static void take_uv(const cut_piece *c, sl_chart_job *job)
{
    const sl_mesh *m = c->piece->mesh;
    double *uv = job->corner_uv;
    for (int32_t k = 0; k < job->count; k++) {
        const int32_t f = job->face[k];
        memcpy(uv, c->corner_uv + 2 * (int64_t)m->face_first[f], 2 * (size_t)sl_degree(m, f) * sizeof *uv);
        uv += 2 * sl_degree(m, f);
    }
}

/* Proves the chart embedded and measures it. job->face: facets of the piece. */
static sl_status judge(const cut_piece *c, sl_chart_job *job)
{
    sl_status status = SL_OK;
    const sl_flatten_def *def = &c->recursion->def->flatten;
    sl_flatten_result *flat = &job->flat;
    sl_patch *patch = NULL;
    int32_t *border = NULL, nb = 0;
    double *uv = NULL;
    SL_TRY(sl_mesh_topology(c->piece->mesh, job->face, job->count, &job->topology));
    SL_TRY(sl_patch_extract(c->piece->mesh, c->piece->triangulation, job->face, job->count, &patch));
    uv = sl_alloc(2 * (int64_t)patch->nv, sizeof *uv);
    SL_TRY(uv == NULL ? SL_OUT_OF_MEMORY : SL_OK);
    for (int32_t k = 0; k < 3 * patch->nt; k++) {
        memcpy(uv + 2 * (int64_t)patch->tri[k], c->corner_uv + 2 * (int64_t)patch->corner[k], 2 * sizeof *uv);
    }
    SL_TRY(sl_patch_border_pairs(patch, &border, &nb));
    SL_TRY(sl_certify_embedding(uv, patch->nt, patch->tri, nb, border, &flat->certificate));
    SL_TRY(sl_distortion_measure_indexed(patch->nt, patch->tri, patch->xyz, uv, &flat->distortion));
    flat->method = SL_FLATTEN_OPTIMISED;
    flat->stretch_minimised = true;
    const bool embedded = sl_patch_is_disk(patch) && flat->certificate.embedded;
    flat->verdict = !embedded                                          ? SL_CHART_OVERLAPS
                    : !(flat->distortion.l2 <= def->max_stretch)       ? SL_CHART_STRETCHED
                    : !(flat->distortion.angle_mean <= def->max_angle) ? SL_CHART_SHEARED
                                                                       : SL_CHART_VALID;
cleanup:
    sl_patch_free(patch);
    sl_free(border);
    sl_free(uv);
    return status;
}

/* The charts as jobs that are done, still in numbers of the piece. *valid = all of them are. */
static sl_status make_charts(const cut_piece *c, sl_chart_job *job, bool *valid)
{
    sl_status status = SL_OK;
    const sl_mesh *m = c->piece->mesh;
    job->finished = sl_calloc(c->nparts, sizeof *job->finished);
    SL_TRY(job->finished == NULL ? SL_OUT_OF_MEMORY : SL_OK);
    job->nfinished = c->nparts;
    *valid = true;
    for (int32_t p = 0; p < c->nparts && *valid; p++) {
        sl_chart_job *chart = &job->finished[p];
        int32_t corners = 0;
        *chart = (sl_chart_job){.depth = job->depth, .done = true, .settled = true};
        for (int32_t f = 0; f < m->nf; f++) {
            chart->count += c->part[f] == p;
            corners += c->part[f] == p ? sl_degree(m, f) : 0;
        }
        chart->face = sl_alloc(chart->count, sizeof *chart->face);
        chart->corner_uv = sl_alloc(corners, 2 * sizeof *chart->corner_uv);
        chart->joined.halfedge = sl_alloc(c->cuts.count, sizeof *chart->joined.halfedge);
        if (chart->face == NULL || chart->corner_uv == NULL || chart->joined.halfedge == NULL) {
            SL_TRY(SL_OUT_OF_MEMORY);
        }
        for (int32_t f = 0, k = 0; f < m->nf; f++) {
            if (c->part[f] == p) {
                chart->face[k++] = f;
            }
        }
        take_uv(c, chart);
        SL_TRY(judge(c, chart));
        *valid = chart->flat.verdict == SL_CHART_VALID;
    }
cleanup:
    return status;
}

/* Cuts within a chart go to the chart, those between charts to the job. All numbers become the mesh's. */
static sl_status hand_over(const cut_piece *c, sl_chart_job *job)
{
    const sl_piece *piece = c->piece;
    job->seam.halfedge = sl_alloc(c->cuts.count, sizeof *job->seam.halfedge);
    if (job->seam.halfedge == NULL) {
        return SL_OUT_OF_MEMORY;
    }
    double length = 0.0;
    for (int32_t k = 0; k < c->cuts.count; k++) {
        const int32_t h = c->cuts.halfedge[k];
        const int32_t a = c->part[piece->mesh->face[h]], b = c->part[piece->mesh->face[piece->mesh->sew[h]]];
        sl_cut_list *list = a == b ? &job->finished[a].joined : &job->seam;
        list->halfedge[list->count++] = a == b ? sl_piece_halfedge(piece, c->recursion->mesh, h) : h;
        length += sl_mesh_edge_length(piece->mesh, h);
    }
    for (int32_t p = 0; p < c->nparts; p++) {
        for (int32_t k = 0; k < job->finished[p].count; k++) {
            job->finished[p].face[k] = piece->face[job->finished[p].face[k]];
        }
    }
    job->nparts = c->nparts;
    job->split = (sl_split){.depth = job->depth,
                            .facets = job->count,
                            .vector = -1,
                            .parts = c->nparts,
                            .length = length,
                            .optimised = true,
                            .because = SL_CHART_VALID};
    return SL_OK;
}

static void put_back(cut_piece *c, sl_chart_job *job)
{
    sl_sew_list(c->piece->mesh, &c->cuts);
    for (int32_t p = 0; p < job->nfinished; p++) {
        sl_chart_job_clear(&job->finished[p]);
    }
    sl_free(job->finished);
    job->finished = NULL;
    job->nfinished = 0;
}

sl_status sl_cut_piece(const sl_recursion *r, sl_piece *piece, sl_chart_job *job, bool *taken)
{
    sl_status status = SL_OK;
    const sl_cutter *cutter = r->def->cutter;
    cut_piece c = {.recursion = r, .piece = piece};
    bool done = false;
    *taken = false;
    int32_t *before = sl_copy(piece->mesh->twin, piece->mesh->nh, sizeof *before);
    c.corner_uv = sl_calloc(2 * (int64_t)piece->mesh->nh, sizeof *c.corner_uv);
    c.part = sl_alloc(piece->mesh->nf, sizeof *c.part);
    SL_TRY(before == NULL || c.corner_uv == NULL || c.part == NULL ? SL_OUT_OF_MEMORY : SL_OK);
    sl_segment_def def = *r->def;
    def.edge_weight = piece->weight;
    SL_TRY(cutter->cut(cutter->user, piece->mesh, piece->triangulation, &def, r->context, c.corner_uv, &done));
    SL_TRY(list_cuts(&c, before));
    if (done) {
        SL_TRY(sl_mesh_components(piece->mesh, c.part, &c.nparts));
        SL_TRY(make_charts(&c, job, taken));
    }
    if (*taken) {
        SL_TRY(hand_over(&c, job));
    } else {
        put_back(&c, job);
    }
cleanup:
    sl_free(before);
    cut_piece_clear(&c);
    return status;
}
