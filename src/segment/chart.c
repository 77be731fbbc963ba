/* One chart of the recursion: flattened, or split. */
#include "segment/share_internal.h"

#include "base/memory.h"

void sl_chart_job_clear(sl_chart_job *job)
{
    sl_free(job->face);
    sl_free(job->corner_uv);
    sl_free(job->part);
    sl_cut_list_clear(&job->joined);
    sl_cut_list_clear(&job->seam);
    sl_copy_list_clear(&job->copies);
    for (int32_t k = 0; k < job->nfinished; k++) {
        sl_chart_job_clear(&job->finished[k]);
    }
    sl_free(job->finished);
    *job = (sl_chart_job){0};
}

/* Turns halfedges of the piece into halfedges of the mesh. */
static void to_parent(const sl_piece *piece, const sl_mesh *parent, sl_cut_list *list)
{
    for (int32_t k = 0; k < list->count; k++) {
        list->halfedge[k] = sl_piece_halfedge(piece, parent, list->halfedge[k]);
    }
}

/* A single facet glued to itself is unglued everywhere. */
static sl_status unglue(sl_mesh *mesh, sl_cut_list *list)
{
    list->halfedge = sl_alloc(mesh->nh, sizeof *list->halfedge);
    if (list->halfedge == NULL) {
        return SL_OUT_OF_MEMORY;
    }
    for (int32_t h = 0; h < mesh->nh; h++) {
        if (mesh->twin[h] >= 0) {
            list->halfedge[list->count++] = h;
            sl_mesh_cut_edge(mesh, h);
        }
    }
    return SL_OK;
}

static bool is_disk(const sl_topology *t)
{
    return t->genus == 0 && t->loops == 1;
}

/* Cuts that may make a disk of the piece without splitting it. */
static sl_status open_up(const sl_recursion *r, sl_piece *piece, sl_chart_job *job)
{
    sl_status status = SL_OK;
    if (is_disk(&job->topology)) {
        return SL_OK;
    }
    if (piece->mesh->nf == 1) {
        SL_TRY(unglue(piece->mesh, &job->joined));
    } else if (r->def->join && job->topology.genus == 0 && job->topology.loops > 1) {
        SL_TRY(sl_join_loops(piece->mesh, piece->weight, &job->joined));
    }
    if (job->joined.count > 0) {
        SL_TRY(sl_piece_topology(piece, &job->topology));
    }
cleanup:
    return status;
}

/* Tries to make a valid chart of the piece as a whole. Where that fails the piece is as before; the job still holds
 * what was cut and the map, for a chart that must stay as it is in the end. */
static sl_status try_whole(const sl_recursion *r, sl_piece *piece, sl_chart_job *job)
{
    sl_status status = SL_OK;
    SL_TRY(sl_piece_topology(piece, &job->topology));
    SL_TRY(open_up(r, piece, job));
    job->corner_uv = sl_calloc(2 * (int64_t)piece->mesh->nh, sizeof *job->corner_uv);
    if (job->corner_uv == NULL) {
        SL_TRY(SL_OUT_OF_MEMORY);
    }
    SL_TRY(sl_flatten_piece(piece, &r->def->flatten, r->context, job->corner_uv, &job->flat));
    job->done = job->flat.verdict == SL_CHART_VALID || piece->mesh->nf == 1;
    if (!job->done) {
        sl_sew_list(piece->mesh, &job->joined);
    }
cleanup:
    return status;
}

/* Connected components of the sides are numbered by first facet. */
sl_status sl_label_parts(sl_piece *piece, const int32_t *side, sl_chart_job *job)
{
    sl_mesh *m = piece->mesh;
    job->part = sl_alloc(m->nf, sizeof *job->part);
    job->seam.halfedge = sl_alloc(m->nh, sizeof *job->seam.halfedge);
    if (job->part == NULL || job->seam.halfedge == NULL) {
        return SL_OUT_OF_MEMORY;
    }
    for (int32_t h = 0; h < m->nh; h++) {
        if (m->twin[h] >= 0 && side[m->face[h]] != side[m->face[m->twin[h]]]) {
            job->seam.halfedge[job->seam.count++] = h;
            sl_mesh_cut_edge(m, h);
        }
    }
    return sl_mesh_components(m, job->part, &job->nparts);
}

/* partner[f] = facet of the piece that the mesh pairs with facet f, -1 = none here. NULL without pairing. */
static sl_status local_partners(const sl_recursion *r, const sl_piece *piece, int32_t **partner)
{
    *partner = NULL;
    if (r->partner == NULL) {
        return SL_OK;
    }
    const int32_t n = piece->mesh->nf;
    *partner = sl_alloc(n, sizeof **partner);
    if (*partner == NULL) {
        return SL_OUT_OF_MEMORY;
    }
    for (int32_t f = 0; f < n; f++) {
        const int32_t g = r->partner[piece->face[f]];
        (*partner)[f] = g < 0 ? -1 : sl_find_sorted(piece->face, n, g);
    }
    return SL_OK;
}

static sl_status split_piece(const sl_recursion *r, sl_piece *piece, const int32_t *partner, sl_chart_job *job)
{
    sl_status status = SL_OK;
    sl_choice choice = {0};
    sl_segment_def def = *r->def;
    def.vsa_regions = job->depth > 0 ? 2 : def.vsa_regions; /* many proxies once, then as any other cut */
    def.clusters = job->depth > 0 ? 2 : def.clusters;
    SL_TRY(sl_choose_cut(piece, partner, &def, r->context, &choice));
    if (!choice.found) { /* nothing can be cut: the chart stays as it is, and says so */
        job->done = job->capped = true;
        goto cleanup;
    }
    SL_TRY(sl_label_parts(piece, choice.side, job));
    job->split = (sl_split){.depth = job->depth,
                            .facets = job->count,
                            .vector = choice.vector,
                            .lambda = choice.lambda,
                            .candidates = choice.candidates,
                            .parts = job->nparts,
                            .length = choice.length,
                            .smoothed = choice.smoothed,
                            .because = job->flat.verdict};
    if (r->share && r->def->test_halves && job->nparts == 2) {
        SL_TRY(sl_share_halves(piece, job));
    }
cleanup:
    sl_choice_clear(&choice);
    return status;
}

/* Cuts along an axis of symmetry, or near the plane of a near one: a whole component before anything else, a part of
 * one when it has to be split. */
static sl_status split_by_symmetry(const sl_recursion *r, sl_piece *piece, const int32_t *partner, sl_chart_job *job,
                                   bool *taken)
{
    sl_status status = SL_OK;
    *taken = false;
    if (!r->share || !r->may_split || r->def->test_halves) {
        return SL_OK;
    }
    SL_TRY(sl_cut_axis(r, piece, partner, job, taken));
    if (!*taken && job->depth == 0 && r->def->symmetry == SL_SYMMETRY_USE_NEAR) {
        SL_TRY(sl_cut_near_plane(r, piece, partner, job, taken));
    }
cleanup:
    return status;
}

/* What is copied, in numbers of the mesh. */
static void copies_to_parent(const sl_piece *piece, const sl_mesh *parent, sl_copy_list *copies)
{
    for (int32_t k = 0; k < copies->count; k++) {
        copies->corner[k] = sl_piece_halfedge(piece, parent, copies->corner[k]);
        copies->from[k] = sl_piece_halfedge(piece, parent, copies->from[k]);
    }
}

void sl_chart_job_run(const sl_recursion *r, sl_chart_job *job)
{
    sl_status status = SL_OK;
    sl_piece *piece = NULL;
    int32_t *partner = NULL;
    bool split = false;
    SL_TRY(sl_piece_create(r->mesh, r->triangulation, job->face, job->count, &piece));
    piece->place = r->place;
    SL_TRY(sl_piece_weigh(piece, r->mesh, r->def->edge_weight));
    SL_TRY(local_partners(r, piece, &partner));
    if (job->depth == 0) {
        SL_TRY(split_by_symmetry(r, piece, partner, job, &split));
    }
    if (!split && r->def->cutter != NULL && r->may_split && job->whole && piece->mesh->nf > 1) {
        SL_TRY(sl_cut_piece(r, piece, job, &split));
    }
    if (!split) {
        SL_TRY(try_whole(r, piece, job));
    }
    if (!split && !job->done && job->depth > 0) {
        SL_TRY(split_by_symmetry(r, piece, partner, job, &split));
    }
    if (!split && !job->done && !r->may_split) {
        job->done = job->capped = true;
    }
    if (!split && !job->done) {
        SL_TRY(split_piece(r, piece, partner, job));
    }
    to_parent(piece, r->mesh, &job->joined);
    to_parent(piece, r->mesh, &job->seam);
    copies_to_parent(piece, r->mesh, &job->copies);
cleanup:
    sl_free(partner);
    sl_piece_free(piece);
    job->status = status;
}
