/* Seams that go: deleted whole, zipped, or between two charts. */
#include "edit/session_internal.h"

#include "base/memory.h"

sl_status sl_edit_take_side(const sl_session *s, const int32_t *name, int32_t *h, sl_diag *diag)
{
    const sl_mesh *mesh = s->mesh;
    *h = sl_session_find_side(s, name[0], name[1], name[2]);
    if (*h < 0) {
        sl_diag_reason(diag, "facet %d has no edge from vertex %d to vertex %d", name[2], name[0], name[1]);
        return SL_BAD_INPUT;
    }
    if (sl_opposite(mesh, *h) < 0) {
        sl_diag_reason(diag, "the edge from vertex %d to vertex %d is at the border of the surface", name[0], name[1]);
        return SL_BAD_INPUT;
    }
    if (mesh->input_vertex[mesh->origin[*h]] != name[0]) {
        *h = sl_opposite(mesh, *h); /* the way there is along the other side */
    }
    return SL_OK;
}

static sl_status require_seam(const sl_session *s, int32_t h, sl_diag *diag)
{
    if (s->mesh->sew[h] < 0) {
        sl_diag_reason(diag, "the edge from vertex %d to vertex %d is no seam",
                       s->mesh->input_vertex[s->mesh->origin[h]], s->mesh->input_vertex[sl_target(s->mesh, h)]);
        return SL_BAD_INPUT;
    }
    return SL_OK;
}

static sl_status sew_edges(sl_session *s, const int32_t *edge, int32_t count)
{
    sl_status status = SL_OK;
    for (int32_t i = 0; i < count && status == SL_OK; i++) {
        status = sl_change_set_edge(s, edge[i], false);
    }
    return status;
}

sl_status sl_do_delete_seam(sl_session *s, const sl_action *a, const sl_context *context, sl_diag *diag)
{
    sl_status status = SL_OK;
    int32_t *arc = NULL, count = 0, h = -1;
    SL_TRY(sl_edit_take_side(s, a->item, &h, diag));
    SL_TRY(require_seam(s, h, diag));
    SL_TRY(sl_session_arc(s, h, &arc, &count));
    SL_TRY(sew_edges(s, arc, count));
    SL_TRY(sl_edit_regroup(s, context, diag));
cleanup:
    sl_free(arc);
    return status;
}

/* How many edges of the arc from h on are sewn: up to vertex a->to, by length, or all. 0 = `to` is not on it. */
static int32_t zip_extent(const sl_session *s, const sl_action *a, int32_t h)
{
    const sl_mesh *mesh = s->mesh;
    const double limit = a->number * mesh->scale;
    double length = 0.0;
    int32_t count = 0;
    for (int32_t g = h; g >= 0;) {
        const double edge = sl_mesh_edge_length(mesh, g);
        if (a->number > 0.0 && count > 0 && length + 0.5 * edge > limit) { /* the half that is longer decides */
            break;
        }
        length += edge;
        count++;
        if (a->to >= 0 && mesh->input_vertex[sl_target(mesh, g)] == a->to) {
            return count;
        }
        g = sl_edit_arc_next(mesh, g);
        if (g == h) {
            break;
        }
    }
    return a->to >= 0 ? 0 : count;
}

sl_status sl_do_sew(sl_session *s, const sl_action *a, const sl_context *context, sl_diag *diag)
{
    sl_status status = SL_OK;
    int32_t h = -1, *list = NULL;
    SL_TRY(sl_edit_take_side(s, a->item, &h, diag));
    SL_TRY(require_seam(s, h, diag));
    const int32_t count = zip_extent(s, a, h);
    if (count == 0) {
        sl_diag_reason(diag, "vertex %d is not on the seam ahead", a->to);
        SL_TRY(SL_BAD_INPUT);
    }
    list = sl_alloc(count, sizeof *list);
    SL_TRY(list != NULL ? SL_OK : SL_OUT_OF_MEMORY);
    for (int32_t i = 0; i < count; i++, h = i < count ? sl_edit_arc_next(s->mesh, h) : h) {
        list[i] = h;
    }
    SL_TRY(sew_edges(s, list, count));
    SL_TRY(sl_edit_regroup(s, context, diag));
cleanup:
    sl_free(list);
    return status;
}

/* Length of an arc of seam in the normalised mesh. */
static double arc_length(const sl_mesh *mesh, const int32_t *arc, int32_t count)
{
    double length = 0.0;
    for (int32_t i = 0; i < count; i++) {
        length += sl_mesh_edge_length(mesh, arc[i]);
    }
    return length;
}

/* The longest arc of seam between two charts; *best owned by the caller, NULL = there is none. */
static sl_status longest_arc(sl_session *s, int32_t a, int32_t b, int32_t **best, int32_t *best_count)
{
    const sl_mesh *mesh = s->mesh;
    const sl_edit_chart *chart = s->slot[a].chart;
    sl_status status = SL_OK;
    double most = -1.0;
    *best = NULL;
    for (int32_t i = 0; i < chart->nface; i++) {
        for (int32_t h = mesh->face_first[chart->face[i]]; h < mesh->face_first[chart->face[i] + 1]; h++) {
            if (mesh->sew[h] < 0 || s->face_chart[mesh->face[mesh->sew[h]]] != b || s->corner_mark[h] >= 0) {
                continue;
            }
            int32_t *arc = NULL, count = 0;
            SL_TRY(sl_session_arc(s, h, &arc, &count));
            for (int32_t k = 0; k < count; k++) {
                s->corner_mark[arc[k]] = 1;
            }
            const double length = arc_length(mesh, arc, count);
            if (length > most) {
                sl_free(*best);
                *best = arc;
                *best_count = count;
                most = length;
            } else {
                sl_free(arc);
            }
        }
    }
cleanup:
    for (int32_t i = 0; i < chart->nface; i++) {
        for (int32_t h = mesh->face_first[chart->face[i]]; h < mesh->face_first[chart->face[i] + 1]; h++) {
            s->corner_mark[h] = -1;
        }
    }
    return status;
}

sl_status sl_do_merge(sl_session *s, const sl_action *a, const sl_context *context, sl_diag *diag)
{
    sl_status status = SL_OK;
    int32_t *arc = NULL, count = 0;
    for (int k = 0; k < 2; k++) {
        if (a->item[k] >= s->mesh->nf) {
            sl_diag_reason(diag, "there is no facet %d", a->item[k]);
            return SL_BAD_INPUT;
        }
    }
    const int32_t x = s->face_chart[a->item[0]], y = s->face_chart[a->item[1]];
    if (x == y) {
        sl_diag_reason(diag, "both facets are in one chart already");
        return SL_BAD_INPUT;
    }
    SL_TRY(longest_arc(s, x, y, &arc, &count));
    if (arc == NULL) {
        sl_diag_reason(diag, "the charts have no seam in common");
        SL_TRY(SL_BAD_INPUT);
    }
    SL_TRY(sew_edges(s, arc, count));
    SL_TRY(sl_edit_regroup(s, context, diag));
cleanup:
    sl_free(arc);
    return status;
}
