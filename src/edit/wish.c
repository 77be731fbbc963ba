/* Constraints: made, replaced, dropped. */
#include "edit/session_internal.h"

#include "base/memory.h"

#include <string.h>

/* The border between two corners, walked with the chart on its left. *corner owned by the caller. */
static sl_status walk_border(const sl_session *s, int32_t from, int32_t to, int32_t **corner, int32_t *count,
                             sl_diag *diag)
{
    const sl_mesh *mesh = s->mesh;
    sl_status status = SL_OK;
    int64_t room = 0;
    int32_t start = from, end[2], fan[2];
    sl_edit_fan(mesh, to, end);
    do { /* clockwise to the border */
        start = mesh->twin[start] >= 0 ? sl_next(mesh, mesh->twin[start]) : start;
    } while (mesh->twin[start] >= 0 && start != from);
    sl_edit_fan(mesh, start, fan);
    if (mesh->twin[start] >= 0 || fan[0] == end[0]) {
        sl_diag_reason(diag, "the ends must be two vertices of the chart's border");
        return SL_BAD_INPUT;
    }
    int32_t h = start;
    do {
        SL_TRY(sl_reserve((void **)corner, &room, (int64_t)*count + 1, sizeof **corner));
        (*corner)[(*count)++] = h;
        sl_edit_fan(mesh, h, fan);
        if (fan[0] == end[0]) {
            return SL_OK;
        }
        h = sl_edit_border_next(mesh, h);
    } while (h != start);
    sl_diag_reason(diag, "the ends are not on one border");
    status = SL_BAD_INPUT;
cleanup:
    return status;
}

/* Where a corner of a copy has its constraints: at the corner it shows. */
static int32_t shown_corner(const sl_session *s, int32_t h)
{
    const sl_edit_slot *slot = &s->slot[s->face_chart[s->mesh->face[h]]];
    return slot->map != NULL ? slot->map->from[sl_edit_corner_place(s, slot->chart, h)] : h;
}

static sl_status find_corners(const sl_session *s, const sl_action *a, int32_t **corner, int32_t *count, sl_diag *diag)
{
    sl_status status = SL_OK;
    int32_t *list = sl_alloc(a->count / 2, sizeof *list);
    SL_TRY(list != NULL ? SL_OK : SL_OUT_OF_MEMORY);
    for (int32_t i = 0; i < a->count / 2; i++) {
        const int32_t h = sl_session_find_corner(s, a->item[2 * i], a->item[2 * i + 1]);
        if (h < 0) {
            sl_diag_reason(diag, "facet %d has no vertex %d", a->item[2 * i + 1], a->item[2 * i]);
            SL_TRY(SL_BAD_INPUT);
        }
        list[i] = shown_corner(s, h);
        if (s->face_chart[s->mesh->face[list[i]]] != s->face_chart[s->mesh->face[list[0]]]) {
            sl_diag_reason(diag, "the vertices are not all in one chart (facets %d and %d)", a->item[1],
                           a->item[2 * i + 1]);
            SL_TRY(SL_BAD_INPUT);
        }
    }
    if (a->kind == SL_ACTION_STRAIGHTEN_BORDER) {
        SL_TRY(walk_border(s, list[0], list[1], corner, count, diag));
    } else {
        *corner = list;
        *count = a->count / 2;
        list = NULL;
    }
cleanup:
    sl_free(list);
    return status;
}

/* Borders that were named by their ends are kept as the paths they are. */
static sl_status make_wish(sl_session *s, const sl_action *a, sl_edit_wish **out, sl_diag *diag)
{
    sl_status status = SL_OK;
    sl_edit_wish *w = sl_calloc(1, sizeof *w);
    SL_TRY(w != NULL ? SL_OK : SL_OUT_OF_MEMORY);
    *w = (sl_edit_wish){.refs = 1,
                        .id = s->next_id,
                        .kind = a->kind == SL_ACTION_STRAIGHTEN_BORDER ? SL_ACTION_STRAIGHTEN : a->kind,
                        .degrees = a->number};
    memcpy(w->uv, a->uv, sizeof w->uv);
    SL_TRY(find_corners(s, a, &w->corner, &w->count, diag));
    w->fan = sl_alloc(w->count, 2 * sizeof *w->fan);
    SL_TRY(w->fan != NULL ? SL_OK : SL_OUT_OF_MEMORY);
    for (int32_t k = 0; k < w->count; k++) {
        sl_edit_fan(s->mesh, w->corner[k], w->fan + 2 * (int64_t)k);
    }
    *out = w;
    return SL_OK;
cleanup:
    sl_edit_wish_release(w);
    return status;
}

/* An angle or pin at a vertex takes the place of the one that is there. */
static int32_t find_replaced(const sl_session *s, const sl_edit_wish *w)
{
    for (int32_t i = 0; i < s->wishes->count; i++) {
        const sl_edit_wish *old = s->wishes->wish[i];
        int32_t fan[2];
        sl_edit_fan(s->mesh, old->corner[0], fan);
        if (old->kind == w->kind && (w->kind == SL_ACTION_ANGLE || w->kind == SL_ACTION_PIN) && fan[0] == w->fan[0]) {
            return i;
        }
    }
    return -1;
}

/* The chart goes to its pins. */
static sl_status move_to_pins(sl_session *s, int32_t index, sl_diag *diag)
{
    sl_edit_slot place = s->slot[index]; /* borrowed: only numbers change */
    const sl_status status = sl_edit_apply_pins(s, &place, diag);
    return status == SL_OK ? sl_edit_move_slot(s, index, &place) : status;
}

sl_status sl_do_wish(sl_session *s, const sl_action *a, const sl_context *context, sl_diag *diag)
{
    sl_status status = SL_OK;
    sl_edit_wish *w = NULL;
    sl_edit_wishes *list = NULL;
    SL_TRY(make_wish(s, a, &w, diag));
    const int32_t slot = s->face_chart[s->mesh->face[w->corner[0]]], replaced = find_replaced(s, w);
    if (replaced >= 0) {
        w->id = s->wishes->wish[replaced]->id;
    } else {
        s->next_id++;
    }
    SL_TRY(sl_edit_wishes_edit(s->wishes, replaced, w, &list));
    sl_change_set_wishes(s, list);
    if (a->kind == SL_ACTION_PIN) {
        SL_TRY(move_to_pins(s, slot, diag));
    } else {
        SL_TRY(sl_edit_resolve(s, slot, context, diag));
    }
cleanup:
    return status;
}

sl_status sl_do_drop(sl_session *s, const sl_action *a, const sl_context *context, sl_diag *diag)
{
    sl_status status = SL_OK;
    sl_edit_wishes *list = NULL;
    int32_t i = 0;
    while (i < s->wishes->count && s->wishes->wish[i]->id != a->id) {
        i++;
    }
    if (i == s->wishes->count) {
        sl_diag_reason(diag, "there is no constraint %d", a->id);
        return SL_BAD_INPUT;
    }
    const int32_t slot = s->face_chart[s->mesh->face[s->wishes->wish[i]->corner[0]]];
    const bool pin = s->wishes->wish[i]->kind == SL_ACTION_PIN;
    SL_TRY(sl_edit_wishes_edit(s->wishes, i, NULL, &list));
    sl_change_set_wishes(s, list);
    if (!pin) {
        SL_TRY(sl_edit_resolve(s, slot, context, diag));
    }
cleanup:
    return status;
}
