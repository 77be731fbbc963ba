/* Sharing turned on and off by hand: a chart's mirror image is cut like it and takes its UVs. */
#include "edit/session_internal.h"

#include "base/memory.h"

#include <math.h>
#include <string.h>

static const double same_length = 1e-3; /* relative: what no distortion shows */

/* A walk over a chart and what corresponds to it at the same time. */
typedef struct twin_walk {
    const sl_session *s;
    sl_edit_chart *chart;
    bool mirrored;
    int32_t *image; /* corners of the chart in its order: mesh halfedges, -1 = not yet */
    int32_t *first; /* facets of the chart: their first corner */
    int32_t *queue, filled;
    uint8_t *hit; /* nf: 1 = image of a facet */
    sl_diag *diag;
} twin_walk;

static int32_t image_next(const twin_walk *w, int32_t h)
{
    return w->mirrored ? sl_prev(w->s->mesh, h) : sl_next(w->s->mesh, h);
}

/* The edge that corresponds to that of a corner whose image is `image`. */
static int32_t image_edge(const twin_walk *w, int32_t image)
{
    return w->mirrored ? sl_prev(w->s->mesh, image) : image;
}

static sl_status unlike(const twin_walk *w, int32_t f, int32_t g)
{
    sl_diag_reason(w->diag, "facet %d does not correspond to facet %d", g, f);
    sl_diag_hint(w->diag, "the corners given must lie alike in parts that are connected alike");
    return SL_INFEASIBLE;
}

/* Corner h of the chart goes to corner g; the rest of the facet follows. */
static sl_status match_facet(twin_walk *w, int32_t h, int32_t g)
{
    const sl_mesh *mesh = w->s->mesh;
    const int32_t f = mesh->face[h], to = mesh->face[g], place = w->s->face_mark[f];
    const int32_t at = w->first[place] + (h - mesh->face_first[f]);
    if (w->image[at] >= 0) {
        return w->image[at] == g ? SL_OK : unlike(w, f, to);
    }
    if (sl_degree(mesh, f) != sl_degree(mesh, to) || w->s->face_mark[to] >= 0 || w->hit[to] != 0) {
        return unlike(w, f, to);
    }
    w->hit[to] = 1;
    for (int32_t k = 0, c = h, d = g; k < sl_degree(mesh, f); k++, c = sl_next(mesh, c), d = image_next(w, d)) {
        w->image[w->first[place] + (c - mesh->face_first[f])] = d;
    }
    w->queue[w->filled++] = f;
    return SL_OK;
}

static sl_status walk_chart(twin_walk *w, int32_t h, int32_t g)
{
    const sl_mesh *mesh = w->s->mesh;
    sl_status status = SL_OK;
    SL_TRY(match_facet(w, h, g));
    for (int32_t head = 0; head < w->filled; head++) {
        const int32_t f = w->queue[head];
        for (int32_t c = mesh->face_first[f]; c < mesh->face_first[f + 1]; c++) {
            const int32_t image = w->image[w->first[w->s->face_mark[f]] + (c - mesh->face_first[f])];
            if (mesh->twin[c] < 0) {
                continue;
            }
            const int32_t over = sl_opposite(mesh, image_edge(w, image));
            if (over < 0) {
                SL_TRY(unlike(w, f, mesh->face[image]));
            }
            SL_TRY(match_facet(w, mesh->twin[c], w->mirrored ? sl_next(mesh, over) : over));
        }
    }
cleanup:
    return status;
}

/* Edges inside the image are sewn as they are in the chart, its border is cut. */
static sl_status cut_alike(sl_session *s, const twin_walk *w)
{
    const sl_mesh *mesh = s->mesh;
    sl_status status = SL_OK;
    for (int32_t i = 0; i < w->chart->nface; i++) {
        const int32_t f = w->chart->face[i];
        for (int32_t c = mesh->face_first[f]; c < mesh->face_first[f + 1]; c++) {
            const int32_t edge = image_edge(w, w->image[w->first[i] + (c - mesh->face_first[f])]);
            if (mesh->twin[c] < 0) {
                SL_TRY(sl_change_set_edge(s, edge, true));
            }
        }
    }
    for (int32_t i = 0; i < w->chart->nface; i++) {
        const int32_t f = w->chart->face[i];
        for (int32_t c = mesh->face_first[f]; c < mesh->face_first[f + 1]; c++) {
            const int32_t edge = image_edge(w, w->image[w->first[i] + (c - mesh->face_first[f])]);
            if (mesh->twin[c] >= 0) {
                SL_TRY(sl_change_set_edge(s, edge, false));
            }
        }
    }
cleanup:
    return status;
}

/* How alike the edges are in space. */
static sl_symmetry_kind compare_lengths(const twin_walk *w)
{
    const sl_mesh *mesh = w->s->mesh;
    for (int32_t i = 0; i < w->chart->nface; i++) {
        const int32_t f = w->chart->face[i];
        for (int32_t c = mesh->face_first[f]; c < mesh->face_first[f + 1]; c++) {
            const int32_t edge = image_edge(w, w->image[w->first[i] + (c - mesh->face_first[f])]);
            const double x = sl_mesh_edge_length(mesh, c), y = sl_mesh_edge_length(mesh, edge);
            if (fabs(x - y) > same_length * fmax(x, y)) {
                return SL_SYMMETRY_NEAR;
            }
        }
    }
    return SL_SYMMETRY_EXACT;
}

/* The slot that has facet f now, while a change is under way. */
static int32_t slot_of_face(const sl_session *s, int32_t f)
{
    for (int64_t i = 0; i < s->open_change.slots; i++) {
        const int32_t slot = s->open_change.slot[i].slot;
        const sl_edit_chart *chart = s->slot[slot].chart;
        for (int32_t k = 0; chart != NULL && k < chart->nface; k++) {
            if (chart->face[k] == f) {
                return slot;
            }
        }
    }
    return s->face_chart[f];
}

/* Constraints on the image have no meaning any more. */
static sl_status drop_wishes_of(sl_session *s, const uint8_t *hit)
{
    for (int32_t i = s->wishes->count - 1; i >= 0; i--) {
        const sl_edit_wish *w = s->wishes->wish[i];
        if (hit[s->mesh->face[w->corner[0]]] != 0) {
            sl_edit_wishes *list = NULL;
            sl_edit_note(s, "constraint %d is given up: its chart is a copy now", w->id);
            const sl_status status = sl_edit_wishes_edit(s->wishes, i, NULL, &list);
            if (status != SL_OK) {
                return status;
            }
            sl_change_set_wishes(s, list);
        }
    }
    return SL_OK;
}

/* The image's chart becomes a copy. */
static sl_status make_copy(sl_session *s, const twin_walk *w, int32_t h, int32_t g, const sl_context *context)
{
    sl_status status = SL_OK;
    const int32_t from = slot_of_face(s, s->mesh->face[h]), to = slot_of_face(s, s->mesh->face[g]);
    const sl_edit_chart *image = s->slot[to].chart;
    sl_edit_slot slot = {.copy_of = -1};
    int32_t *back = NULL, n = 0;
    if (image->nface != w->chart->nface) {
        sl_diag_reason(w->diag, "what corresponds to the chart cannot be cut out alike");
        return SL_INFEASIBLE;
    }
    SL_TRY(sl_edit_unshare(s, to));
    slot = sl_edit_slot_share(&s->slot[to]);
    slot.map = sl_calloc(1, sizeof *slot.map);
    back = sl_alloc(s->mesh->nh, sizeof *back);
    SL_TRY(slot.map != NULL && back != NULL ? SL_OK : SL_OUT_OF_MEMORY);
    slot.map->refs = 1;
    slot.map->count = slot.chart->ncorner;
    slot.map->from = sl_alloc(slot.chart->ncorner, sizeof *slot.map->from);
    SL_TRY(slot.map->from != NULL ? SL_OK : SL_OUT_OF_MEMORY);
    for (int32_t i = 0; i < w->chart->nface; i++) {
        const int32_t f = w->chart->face[i];
        for (int32_t c = s->mesh->face_first[f]; c < s->mesh->face_first[f + 1]; c++) {
            back[w->image[w->first[i] + (c - s->mesh->face_first[f])]] = c;
        }
    }
    for (int32_t i = 0; i < slot.chart->nface; i++) {
        for (int32_t c = s->mesh->face_first[slot.chart->face[i]]; c < s->mesh->face_first[slot.chart->face[i] + 1];
             c++) {
            slot.map->from[n++] = back[c];
        }
    }
    slot.copy_of = from;
    slot.mirrored = w->mirrored;
    slot.kind = compare_lengths(w);
    SL_TRY(sl_edit_follow(s, &s->slot[from], &slot, context));
    status = sl_change_set_slot(s, to, &slot);
    slot = (sl_edit_slot){.copy_of = -1};
cleanup:
    sl_edit_slot_clear(&slot);
    sl_free(back);
    return status;
}

/* Finds the image of the chart of corner h, which goes to corner g. */
static sl_status find_image(sl_session *s, twin_walk *w, int32_t h, int32_t g)
{
    const sl_edit_chart *chart = w->chart;
    w->image = sl_alloc(chart->ncorner, sizeof *w->image);
    w->first = sl_alloc(chart->nface, sizeof *w->first);
    w->queue = sl_alloc(chart->nface, sizeof *w->queue);
    w->hit = sl_calloc(s->mesh->nf, 1);
    if (w->image == NULL || w->first == NULL || w->queue == NULL || w->hit == NULL) {
        return SL_OUT_OF_MEMORY;
    }
    for (int32_t i = 0; i < chart->ncorner; i++) {
        w->image[i] = -1;
    }
    for (int32_t i = 0, n = 0; i < chart->nface; n += sl_degree(s->mesh, chart->face[i]), i++) {
        w->first[i] = n;
        s->face_mark[chart->face[i]] = i;
    }
    const sl_status status = walk_chart(w, h, g);
    for (int32_t i = 0; i < chart->nface; i++) {
        s->face_mark[chart->face[i]] = -1;
    }
    return status;
}

static sl_status turn_on(sl_session *s, const sl_action *a, const sl_context *context, sl_diag *diag)
{
    sl_status status = SL_OK;
    const int32_t h = sl_session_find_corner(s, a->item[0], a->item[1]);
    const int32_t g = sl_session_find_corner(s, a->item[2], a->item[3]);
    twin_walk w = {.s = s, .mirrored = a->mirrored, .diag = diag};
    if (h < 0 || g < 0 || s->face_chart[s->mesh->face[h]] != s->face_chart[a->facet]) {
        sl_diag_reason(diag, "the first corner must be one of the chart of facet %d, the second one of its image",
                       a->facet);
        return SL_BAD_INPUT;
    }
    w.chart = s->slot[s->face_chart[a->facet]].chart;
    w.chart = s->slot[s->face_chart[a->facet]].copy_of < 0 ? w.chart : NULL;
    if (w.chart == NULL) {
        sl_diag_reason(diag, "the chart of facet %d is itself a copy", a->facet);
        return SL_BAD_INPUT;
    }
    SL_TRY(find_image(s, &w, h, g));
    SL_TRY(drop_wishes_of(s, w.hit));
    SL_TRY(cut_alike(s, &w));
    if (s->open_change.edges > 0) {
        w.chart->refs++; /* regrouping may lay the chart itself out anew */
        status = sl_edit_regroup(s, context, diag);
        if (status == SL_OK) {
            status = make_copy(s, &w, h, g, context);
        }
        sl_edit_chart_release(w.chart);
    } else {
        status = make_copy(s, &w, h, g, context);
    }
cleanup:
    sl_free(w.image);
    sl_free(w.first);
    sl_free(w.queue);
    sl_free(w.hit);
    return status;
}

sl_status sl_do_symmetry(sl_session *s, const sl_action *a, const sl_context *context, sl_diag *diag)
{
    if (a->facet < 0 || a->facet >= s->mesh->nf) {
        sl_diag_reason(diag, "there is no facet %d", a->facet);
        return SL_BAD_INPUT;
    }
    if (a->on) {
        return turn_on(s, a, context, diag);
    }
    const sl_status status = sl_edit_unshare(s, s->face_chart[a->facet]);
    if (status == SL_OK && s->open_change.slots == 0) {
        sl_diag_reason(diag, "the chart of facet %d shares its UVs with no other", a->facet);
        return SL_BAD_INPUT;
    }
    return status;
}
