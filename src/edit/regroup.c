/* After edges were cut or sewn: which charts there are now. */
#include "edit/session_internal.h"

#include "base/memory.h"

#include <stdlib.h>
#include <string.h>

/* The charts that edges changed in, and the parts that their facets make now. */
typedef struct regrouping {
    int32_t *old, olds;   /* slots touched, ascending */
    uint8_t *touched;     /* slots: 1 = in old */
    uint8_t *taken;       /* slots: 1 = a part has this slot now */
    int32_t *face, faces; /* grouped by part, ascending in each */
    int32_t *first;       /* parts + 1 */
    int32_t parts;
    double *area;       /* parts */
    int32_t *reference; /* parts: the slot that most of it was in */
    int32_t *order;     /* parts, largest first */
    int32_t *place;     /* parts: the slot it gets */
} regrouping;

static void regrouping_clear(regrouping *r)
{
    void *arrays[] = {r->old, r->touched, r->taken, r->face, r->first, r->area, r->reference, r->order, r->place};
    for (size_t i = 0; i < SL_COUNTOF(arrays); i++) {
        sl_free(arrays[i]);
    }
}

static int ascending(const void *a, const void *b)
{
    const int32_t x = *(const int32_t *)a, y = *(const int32_t *)b;
    return (x > y) - (x < y);
}

static sl_status find_touched(const sl_session *s, regrouping *r)
{
    const sl_change *c = &s->open_change;
    r->touched = sl_calloc((int64_t)s->slots + 1, 1);
    r->taken = sl_calloc((int64_t)s->slots + 1, 1);
    r->old = sl_alloc(s->slots, sizeof *r->old);
    if (r->touched == NULL || r->taken == NULL || r->old == NULL) {
        return SL_OUT_OF_MEMORY;
    }
    for (int64_t i = 0; i < c->edges; i++) {
        const int32_t h = c->edge[i].halfedge;
        r->touched[s->face_chart[s->mesh->face[h]]] = 1;
        r->touched[s->face_chart[s->mesh->face[sl_opposite(s->mesh, h)]]] = 1;
    }
    for (int32_t i = 0; i < s->slots; i++) {
        if (r->touched[i] != 0) {
            r->old[r->olds++] = i;
            r->faces += s->slot[i].chart->nface;
        }
    }
    return SL_OK;
}

/* Facets reached from `seed` over twins: appended to r->face, marked. */
static void flood(const sl_session *s, regrouping *r, int32_t seed, int32_t *filled)
{
    const sl_mesh *mesh = s->mesh;
    int32_t head = *filled;
    r->face[(*filled)++] = seed;
    s->face_mark[seed] = r->parts;
    for (; head < *filled; head++) {
        const int32_t f = r->face[head];
        for (int32_t h = mesh->face_first[f]; h < mesh->face_first[f + 1]; h++) {
            const int32_t g = mesh->twin[h] >= 0 ? mesh->face[mesh->twin[h]] : -1;
            if (g >= 0 && s->face_mark[g] < 0) {
                s->face_mark[g] = r->parts;
                r->face[(*filled)++] = g;
            }
        }
    }
}

/* The parts; face_mark of their facets is left set to the part's number. */
static sl_status find_parts(const sl_session *s, regrouping *r)
{
    int32_t filled = 0;
    r->face = sl_alloc(r->faces, sizeof *r->face);
    r->first = sl_alloc((int64_t)r->faces + 1, sizeof *r->first);
    if (r->face == NULL || r->first == NULL) {
        return SL_OUT_OF_MEMORY;
    }
    for (int32_t i = 0; i < r->olds; i++) {
        const sl_edit_chart *chart = s->slot[r->old[i]].chart;
        for (int32_t k = 0; k < chart->nface; k++) {
            if (s->face_mark[chart->face[k]] < 0) {
                r->first[r->parts] = filled;
                flood(s, r, chart->face[k], &filled);
                r->parts++;
            }
        }
    }
    r->first[r->parts] = filled;
    SL_ASSERT(filled == r->faces);
    for (int32_t p = 0; p < r->parts; p++) {
        qsort(r->face + r->first[p], (size_t)(r->first[p + 1] - r->first[p]), sizeof *r->face, ascending);
    }
    return SL_OK;
}

/* The slot that most of a part's area was in. */
static int32_t find_reference(const sl_session *s, const regrouping *r, int32_t p, double *share)
{
    int32_t best = -1;
    for (int32_t i = r->first[p]; i < r->first[p + 1]; i++) {
        const int32_t slot = s->face_chart[r->face[i]];
        share[slot] += sl_mesh_face_area(s->mesh, r->face[i]);
    }
    for (int32_t i = r->first[p]; i < r->first[p + 1]; i++) {
        const int32_t slot = s->face_chart[r->face[i]];
        if (best < 0 || share[slot] > share[best] || (share[slot] == share[best] && slot < best)) {
            best = slot;
        }
    }
    for (int32_t i = r->first[p]; i < r->first[p + 1]; i++) {
        share[s->face_chart[r->face[i]]] = 0.0;
    }
    return best;
}

/* Larger parts first; each takes the slot most of it was in, the others empty ones. */
static sl_status find_places(const sl_session *s, regrouping *r)
{
    sl_status status = SL_OK;
    double *share = sl_calloc((int64_t)s->slots + 1, sizeof *share);
    r->area = sl_calloc(r->parts, sizeof *r->area);
    r->reference = sl_alloc(r->parts, sizeof *r->reference);
    r->order = sl_alloc(r->parts, sizeof *r->order);
    r->place = sl_alloc(r->parts, sizeof *r->place);
    if (share == NULL || r->area == NULL || r->reference == NULL || r->order == NULL || r->place == NULL) {
        SL_TRY(SL_OUT_OF_MEMORY);
    }
    for (int32_t p = 0; p < r->parts; p++) {
        for (int32_t i = r->first[p]; i < r->first[p + 1]; i++) {
            r->area[p] += sl_mesh_face_area(s->mesh, r->face[i]);
        }
        r->reference[p] = find_reference(s, r, p, share);
        int32_t k = p;
        for (; k > 0 && r->area[r->order[k - 1]] < r->area[p]; k--) {
            r->order[k] = r->order[k - 1];
        }
        r->order[k] = p;
    }
    for (int32_t k = 0; k < r->parts; k++) {
        const int32_t p = r->order[k], slot = r->reference[p];
        r->place[p] = r->taken[slot] == 0 ? slot : -1;
        r->taken[slot] = 1;
    }
cleanup:
    sl_free(share);
    return status;
}

/* Can a wish live on in one of the parts? Which one; -1 = no, and why. */
static int32_t find_part_of_wish(const sl_session *s, const sl_edit_wish *w, const char **why)
{
    const int32_t part = s->face_mark[s->mesh->face[w->corner[0]]];
    const bool about_fan = w->kind == SL_ACTION_ANGLE || w->kind == SL_ACTION_RECTANGLE || w->kind == SL_ACTION_RIGHT;
    for (int32_t k = 0; k < w->count; k++) {
        int32_t fan[2];
        if (s->face_mark[s->mesh->face[w->corner[k]]] != part) {
            *why = "its vertices are in different charts now";
            return -1;
        }
        sl_edit_fan(s->mesh, w->corner[k], fan);
        if (about_fan && memcmp(fan, w->fan + 2 * (int64_t)k, sizeof fan) != 0) {
            *why = "other facets meet at its vertex now";
            return -1;
        }
    }
    return part;
}

/* Wishes of one part, in order; those that do not go with the ones before are dropped (entry of `dropped` set to 1). */
static sl_status sift_wishes(sl_session *s, const regrouping *r, int32_t part, sl_edit_wish **list, int32_t *index,
                             int32_t *count, uint8_t *dropped)
{
    sl_status status = SL_OK;
    sl_patch *patch = NULL;
    sl_sector_table table = {0};
    int32_t kept = 0;
    SL_TRY(sl_patch_extract(s->mesh, s->base->triangulation, r->face + r->first[part],
                            r->first[part + 1] - r->first[part], &patch));
    if (sl_patch_is_disk(patch)) {
        status = sl_edit_compile(s, patch, *count, list, &table, NULL);
        for (int32_t k = 0; k < *count && status != SL_OK && status != SL_OUT_OF_MEMORY; k++) {
            sl_diag diag = sl_diag_none();
            list[kept] = list[k];
            const sl_status alone = sl_edit_compile(s, patch, kept + 1, list, &table, &diag);
            sl_sectors_clear(&table);
            if (alone == SL_OUT_OF_MEMORY) {
                status = alone;
                goto cleanup;
            }
            if (alone == SL_OK) {
                kept++;
            } else {
                dropped[index[k]] = 1;
                sl_edit_note(s, "constraint %d is given up: %.120s", list[k]->id, diag.reason);
            }
        }
        *count = status == SL_OK ? *count : kept;
        status = status == SL_OUT_OF_MEMORY ? status : SL_OK;
    }
cleanup:
    sl_patch_free(patch);
    sl_sectors_clear(&table);
    return status;
}

/* Solves a part and puts it in its slot. list: room for all wishes; mine, index: scratch as long. */
static sl_status place_part(sl_session *s, const regrouping *r, int32_t p, int32_t nwish, sl_edit_wish **list,
                            const sl_context *context, sl_diag *diag)
{
    const sl_edit_slot *reference = &s->slot[r->reference[p]];
    sl_edit_slot slot = {.copy_of = -1, .scale = sl_edit_density(reference)};
    const sl_status status =
        sl_edit_solve(s, r->face + r->first[p], r->first[p + 1] - r->first[p], nwish, list, context, &slot.chart, diag);
    if (status != SL_OK) {
        return status;
    }
    sl_edit_align(s, &slot, r->reference[p]);
    const sl_status pinned = sl_edit_apply_pins(s, &slot, diag);
    if (pinned != SL_OK) {
        sl_edit_slot_clear(&slot);
        return pinned;
    }
    return sl_change_set_slot(s, r->place[p], &slot);
}

/* Wishes of part p into list, their numbers in s->wishes into index; pins beyond two are dropped. */
static int32_t gather_wishes(sl_session *s, const int32_t *part_of, int32_t p, sl_edit_wish **list, int32_t *index,
                             uint8_t *dropped)
{
    int32_t n = 0, pins = 0;
    for (int32_t i = 0; i < s->wishes->count; i++) {
        sl_edit_wish *w = s->wishes->wish[i];
        if (part_of[i] != p || dropped[i] != 0) {
            continue;
        }
        if (w->kind != SL_ACTION_PIN) {
            index[n] = i;
            list[n++] = w;
        } else if (++pins > 2) {
            dropped[i] = 1;
            sl_edit_note(s, "pin %d is given up: a chart has two at most", w->id);
        }
    }
    return n;
}

/* Takes the wishes out that were dropped. */
static sl_status drop_wishes(sl_session *s, const uint8_t *dropped)
{
    for (int32_t i = s->wishes->count - 1; i >= 0; i--) {
        if (dropped[i] != 0) {
            sl_edit_wishes *list = NULL;
            const sl_status status = sl_edit_wishes_edit(s->wishes, i, NULL, &list);
            if (status != SL_OK) {
                return status;
            }
            sl_change_set_wishes(s, list);
        }
    }
    return SL_OK;
}

/* Solves all parts: wishes first, so that what is dropped is known before anything is placed. */
static sl_status solve_parts(sl_session *s, const regrouping *r, const sl_context *context, sl_diag *diag)
{
    sl_status status = SL_OK;
    const int32_t n = s->wishes->count;
    int32_t *part_of = sl_alloc(n, sizeof *part_of), *index = sl_alloc(n, sizeof *index);
    sl_edit_wish **list = sl_alloc(n, sizeof *list);
    uint8_t *dropped = sl_calloc(n, 1);
    SL_TRY(part_of != NULL && index != NULL && list != NULL && dropped != NULL ? SL_OK : SL_OUT_OF_MEMORY);
    for (int32_t i = 0; i < n; i++) {
        const sl_edit_wish *w = s->wishes->wish[i];
        const char *why = "";
        part_of[i] = -1;
        if (r->touched[s->face_chart[s->mesh->face[w->corner[0]]]] != 0) {
            part_of[i] = find_part_of_wish(s, w, &why);
            dropped[i] = part_of[i] < 0;
        }
        if (dropped[i] != 0) {
            sl_edit_note(s, "constraint %d is given up: %s", w->id, why);
        }
    }
    for (int32_t k = 0; k < r->faces; k++) {
        s->face_mark[r->face[k]] = -1; /* solving uses the marks */
    }
    for (int32_t p = 0; p < r->parts; p++) {
        int32_t count = gather_wishes(s, part_of, p, list, index, dropped);
        if (count > 0) {
            SL_TRY(sift_wishes(s, r, p, list, index, &count, dropped));
        }
    }
    SL_TRY(drop_wishes(s, dropped));
    memset(dropped, 0, (size_t)n);
    for (int32_t k = 0; k < r->parts; k++) {
        const int32_t p = r->order[k];
        int32_t count = 0;
        for (int32_t i = 0; i < s->wishes->count; i++) {
            const int32_t f = s->mesh->face[s->wishes->wish[i]->corner[0]];
            if (s->wishes->wish[i]->kind != SL_ACTION_PIN &&
                bsearch(&f, r->face + r->first[p], (size_t)(r->first[p + 1] - r->first[p]), sizeof f, ascending) !=
                    NULL) {
                list[count++] = s->wishes->wish[i];
            }
        }
        SL_TRY(place_part(s, r, p, count, list, context, diag));
    }
cleanup:
    sl_free(part_of);
    sl_free(index);
    sl_free(list);
    sl_free(dropped);
    return status;
}

/* Slots of their own for parts that have none yet; those that nobody took are emptied. Placing a part needs its
 * reference's scale, so the slots are emptied last. */
static void settle_places(const sl_session *s, regrouping *r)
{
    int32_t next = 0;
    for (int32_t k = 0; k < r->parts; k++) {
        const int32_t p = r->order[k];
        if (r->place[p] >= 0) {
            continue;
        }
        while (next < s->slots && (s->slot[next].chart != NULL && !(r->touched[next] != 0 && r->taken[next] == 0))) {
            next++;
        }
        r->place[p] = next++;
        if (r->place[p] < s->slots) {
            r->taken[r->place[p]] = 1;
        }
    }
}

sl_status sl_edit_regroup(sl_session *s, const sl_context *context, sl_diag *diag)
{
    sl_status status = SL_OK;
    regrouping r = {0};
    SL_TRY(find_touched(s, &r));
    for (int32_t i = 0; i < r.olds; i++) {
        SL_TRY(sl_edit_unshare(s, r.old[i]));
    }
    SL_TRY(find_parts(s, &r));
    SL_TRY(find_places(s, &r));
    settle_places(s, &r);
    SL_TRY(solve_parts(s, &r, context, diag));
    for (int32_t i = 0; i < r.olds; i++) {
        if (r.taken[r.old[i]] == 0) {
            sl_edit_slot empty = {.copy_of = -1};
            SL_TRY(sl_change_set_slot(s, r.old[i], &empty));
        }
    }
cleanup:
    for (int32_t k = 0; r.face != NULL && k < r.faces; k++) {
        s->face_mark[r.face[k]] = -1;
    }
    regrouping_clear(&r);
    return status;
}
