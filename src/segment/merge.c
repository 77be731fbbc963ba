/* One merge of two charts. */
#include "segment/sew_internal.h"

#include "base/memory.h"

/* The sorted union of two charts' facets. */
static sl_status unite_facets(const sl_chart_job *a, const sl_chart_job *b, sl_chart_job *job)
{
    job->face = sl_alloc((int64_t)a->count + b->count, sizeof *job->face);
    if (job->face == NULL) {
        return SL_OUT_OF_MEMORY;
    }
    int32_t i = 0, j = 0;
    while (i < a->count || j < b->count) {
        const bool from_a = j == b->count || (i < a->count && a->face[i] < b->face[j]);
        job->face[job->count++] = from_a ? a->face[i++] : b->face[j++];
    }
    return SL_OK;
}

/* A merge in the making. */
typedef struct merge {
    sl_piece *piece;
    uint8_t *in_a;    /* facets of the piece */
    uint8_t *sewable; /* halfedges of the piece that may be sewn */
    double *lean;     /* nh: factors that tell arcs of equal length apart */
    int32_t *arc;     /* halfedges of the longest common arc, on a's side, in order */
    int32_t narc;
} merge;

static void merge_clear(merge *m)
{
    sl_piece_free(m->piece);
    sl_free(m->in_a);
    sl_free(m->sewable);
    sl_free(m->lean);
    sl_free(m->arc);
}

/* Does a's border halfedge h lie on a seam with b that may be sewn? */
static bool is_common(const merge *m, int32_t h)
{
    const sl_mesh *mesh = m->piece->mesh;
    return m->sewable[h] && mesh->sew[h] >= 0 && m->in_a[mesh->face[h]] && !m->in_a[mesh->face[mesh->sew[h]]];
}

/* The common halfedge after h on the same arc, -1 = the arc ends: both borders must run on together. */
static int32_t next_on_arc(const merge *m, int32_t h)
{
    const sl_mesh *mesh = m->piece->mesh;
    const int32_t n = sl_next_on_border(mesh, h);
    return is_common(m, n) && sl_next_on_border(mesh, mesh->sew[n]) == mesh->sew[h] ? n : -1;
}

/* Follows the arc from h; writes it where arc is not NULL. Returns its length; a closed arc ends before it repeats. */
static double follow_arc(const merge *m, int32_t h, int32_t *arc, int32_t *count, uint8_t *seen)
{
    double length = 0.0;
    *count = 0;
    for (int32_t k = h; k >= 0; k = next_on_arc(m, k)) {
        if (k == h && *count > 0) {
            break;
        }
        if (arc != NULL) {
            arc[*count] = k;
        }
        seen[k] = 1;
        (*count)++;
        length += sl_mesh_edge_length(m->piece->mesh, k) * m->lean[k];
    }
    return length;
}

/* Marks the halfedges that are not the first of their arc. */
static void mark_followers(const merge *m, uint8_t *follows)
{
    for (int32_t h = 0; h < m->piece->mesh->nh; h++) {
        if (is_common(m, h)) {
            const int32_t n = next_on_arc(m, h);
            if (n >= 0) {
                follows[n] = 1;
            }
        }
    }
}

static sl_status find_longest_arc(merge *m)
{
    sl_status status = SL_OK;
    const int32_t nh = m->piece->mesh->nh;
    uint8_t *follows = sl_calloc(nh, sizeof *follows), *seen = sl_calloc(nh, sizeof *seen);
    m->arc = sl_alloc(nh, sizeof *m->arc);
    if (follows == NULL || seen == NULL || m->arc == NULL) {
        SL_TRY(SL_OUT_OF_MEMORY);
    }
    mark_followers(m, follows);
    double best = -1.0;
    int32_t start = -1, count = 0;
    for (int32_t pass = 0; pass < 2; pass++) { /* open arcs from their first edge, then closed ones from any */
        for (int32_t h = 0; h < nh; h++) {
            if (is_common(m, h) && !seen[h] && (pass == 1 || !follows[h])) {
                const double length = follow_arc(m, h, NULL, &count, seen);
                start = length > best ? h : start;
                best = length > best ? length : best;
            }
        }
    }
    if (start >= 0) {
        (void)follow_arc(m, start, m->arc, &m->narc, seen);
    }
cleanup:
    sl_free(follows);
    sl_free(seen);
    return status;
}

static sl_status merge_create(const sl_sewing *s, const sl_chart_job *a, const sl_chart_job *job, merge *m)
{
    sl_status status = SL_OK;
    SL_TRY(sl_piece_create(s->work, s->triangulation, job->face, job->count, &m->piece));
    const sl_mesh *mesh = m->piece->mesh;
    m->in_a = sl_alloc(mesh->nf, sizeof *m->in_a);
    m->sewable = sl_alloc(mesh->nh, sizeof *m->sewable);
    if (m->in_a == NULL || m->sewable == NULL) {
        SL_TRY(SL_OUT_OF_MEMORY);
    }
    for (int32_t f = 0; f < mesh->nf; f++) {
        m->in_a[f] = sl_find_sorted(a->face, a->count, m->piece->face[f]) >= 0;
    }
    for (int32_t h = 0; h < mesh->nh; h++) {
        m->sewable[h] = s->sewable[sl_piece_halfedge(m->piece, s->work, h)];
    }
    SL_TRY(sl_lean_weights(mesh, NULL, &m->lean));
    SL_TRY(find_longest_arc(m));
cleanup:
    return status;
}

/* Sews the arc, and then darts from their tips on: where the border turns back along the other side of its own seam,
 * closing the edge keeps a disk a disk. The last edge stays open. Adds what was sewn to list. */
static void sew_arc(merge *m, bool zip, sl_cut_list *list)
{
    sl_mesh *mesh = m->piece->mesh;
    for (int32_t k = 0; k < m->narc; k++) {
        list->halfedge[list->count++] = m->arc[k];
        sl_mesh_sew_edge(mesh, m->arc[k]);
    }
    for (int32_t h = 0; zip && h < mesh->nh; h++) {
        int32_t k = h;
        while (k >= 0 && mesh->twin[k] < 0 && mesh->sew[k] >= 0 && m->sewable[k] &&
               sl_next_on_border(mesh, k) == mesh->sew[k] && sl_next_on_border(mesh, mesh->sew[k]) != k) {
            int32_t before = sl_prev(mesh, k); /* the border halfedge that leads to k */
            while (mesh->twin[before] >= 0) {
                before = sl_prev(mesh, mesh->twin[before]);
            }
            list->halfedge[list->count++] = k;
            sl_mesh_sew_edge(mesh, k);
            k = before;
        }
    }
}

static sl_status try_merge(const sl_sewing *s, merge *m, bool zip, sl_chart_job *job)
{
    sl_status status = SL_OK;
    sew_arc(m, zip, &job->joined);
    SL_TRY(sl_piece_topology(m->piece, &job->topology));
    if (job->topology.genus == 0 && job->topology.loops == 1) {
        SL_TRY(sl_flatten_piece(m->piece, &s->flatten, s->context, job->corner_uv, &job->flat));
        job->done = job->flat.verdict == SL_CHART_VALID;
    }
cleanup:
    return status;
}

void sl_merge_charts(const sl_sewing *sewing, const sl_chart_job *a, const sl_chart_job *b, sl_chart_job *job)
{
    sl_status status = SL_OK;
    merge m = {0};
    SL_TRY(unite_facets(a, b, job));
    SL_TRY(merge_create(sewing, a, job, &m));
    job->corner_uv = sl_calloc(2 * (int64_t)m.piece->mesh->nh, sizeof *job->corner_uv);
    job->joined.halfedge = sl_alloc(m.piece->mesh->nh, sizeof *job->joined.halfedge);
    if (job->corner_uv == NULL || job->joined.halfedge == NULL) {
        SL_TRY(SL_OUT_OF_MEMORY);
    }
    if (m.narc == 0) {
        goto cleanup;
    }
    SL_TRY(try_merge(sewing, &m, true, job));
    if (!job->done && job->joined.count > m.narc) { /* perhaps only the darts were too much */
        for (int32_t k = 0; k < job->joined.count; k++) {
            sl_mesh_cut_edge(m.piece->mesh, job->joined.halfedge[k]);
        }
        job->joined.count = 0;
        SL_TRY(try_merge(sewing, &m, false, job));
    }
    job->depth = a->depth < b->depth ? a->depth : b->depth;
    for (int32_t k = 0; k < job->joined.count; k++) {
        job->joined.halfedge[k] = sl_piece_halfedge(m.piece, sewing->work, job->joined.halfedge[k]);
    }
cleanup:
    merge_clear(&m);
    job->status = status;
}
