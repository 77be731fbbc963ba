/* Where charts lie on the page, and what follows them there: copies and pins. */
#include "edit/session_internal.h"

#include "base/memory.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const double degree = 0.017453292519943295; /* pi / 180 */

static int ascending(const void *a, const void *b)
{
    const int32_t x = *(const int32_t *)a, y = *(const int32_t *)b;
    return (x > y) - (x < y);
}

static bool has_face(const sl_edit_chart *chart, int32_t f)
{
    return bsearch(&f, chart->face, (size_t)chart->nface, sizeof f, ascending) != NULL;
}

int32_t sl_edit_corner_place(const sl_session *s, const sl_edit_chart *chart, int32_t h)
{
    const int32_t f = s->mesh->face[h];
    int32_t at = 0;
    if (!has_face(chart, f)) {
        return -1;
    }
    for (int32_t i = 0; chart->face[i] != f; i++) {
        at += sl_degree(s->mesh, chart->face[i]);
    }
    return at + (h - s->mesh->face_first[f]);
}

double sl_edit_density(const sl_edit_slot *slot)
{
    const sl_distortion *d = &slot->chart->flat.distortion;
    return slot->chart->kept && d->area_3d > 0.0 && d->area_uv > 0.0 ? slot->scale * sqrt(d->area_uv / d->area_3d)
                                                                     : slot->scale;
}

void sl_edit_align(const sl_session *s, sl_edit_slot *slot, int32_t reference)
{
    const sl_mesh *mesh = s->mesh;
    const sl_edit_chart *chart = slot->chart;
    double p[2] = {0}, q[2] = {0}, dot = 0.0, cross = 0.0, n = 0.0;
    for (int pass = 0; pass < 2; pass++) {
        const double *own = chart->uv;
        for (int32_t i = 0; i < chart->nface; i++) {
            const int32_t f = chart->face[i];
            for (int32_t h = mesh->face_first[f]; h < mesh->face_first[f + 1]; h++, own += 2) {
                const double *page = s->corner_uv + 2 * (int64_t)h;
                if (reference >= 0 && s->face_chart[f] != reference) {
                    continue;
                }
                if (pass == 0) {
                    n += 1.0;
                    for (int k = 0; k < 2; k++) {
                        p[k] += page[k];
                        q[k] += own[k];
                    }
                } else {
                    const double a[2] = {own[0] - q[0], own[1] - q[1]}, b[2] = {page[0] - p[0], page[1] - p[1]};
                    dot += a[0] * b[0] + a[1] * b[1];
                    cross += a[0] * b[1] - a[1] * b[0];
                }
            }
        }
        for (int k = 0; k < 2 && pass == 0 && n > 0.0; k++) {
            p[k] /= n;
            q[k] /= n;
        }
    }
    slot->angle = dot != 0.0 || cross != 0.0 ? atan2(cross, dot) : 0.0;
    const double c = slot->scale * cos(slot->angle), z = slot->scale * sin(slot->angle);
    slot->offset[0] = p[0] - (c * q[0] - z * q[1]);
    slot->offset[1] = p[1] - (z * q[0] + c * q[1]);
}

sl_status sl_edit_apply_pins(const sl_session *s, sl_edit_slot *slot, sl_diag *diag)
{
    const double *target[2] = {NULL, NULL}, *own[2] = {NULL, NULL};
    int pins = 0;
    for (int32_t i = 0; i < s->wishes->count; i++) {
        const sl_edit_wish *w = s->wishes->wish[i];
        const int32_t at = w->kind == SL_ACTION_PIN ? sl_edit_corner_place(s, slot->chart, w->corner[0]) : -1;
        if (at >= 0) {
            if (pins == 2) {
                sl_diag_reason(diag, "a chart can have two pins at most");
                return SL_INFEASIBLE;
            }
            target[pins] = w->uv;
            own[pins++] = slot->chart->uv + 2 * (int64_t)at;
        }
    }
    if (pins == 2) {
        const double t[2] = {target[1][0] - target[0][0], target[1][1] - target[0][1]};
        const double q[2] = {own[1][0] - own[0][0], own[1][1] - own[0][1]};
        const double square = q[0] * q[0] + q[1] * q[1], wish = t[0] * t[0] + t[1] * t[1];
        if (!(square > 0.0 && wish > 0.0)) {
            sl_diag_reason(diag, "two pins of a chart cannot have one place");
            return SL_INFEASIBLE;
        }
        slot->scale = sqrt(wish / square);
        slot->angle = atan2(q[0] * t[1] - q[1] * t[0], q[0] * t[0] + q[1] * t[1]);
    }
    if (pins > 0) {
        const double c = slot->scale * cos(slot->angle), z = slot->scale * sin(slot->angle);
        slot->offset[0] = target[0][0] - (c * own[0][0] - z * own[0][1]);
        slot->offset[1] = target[0][1] - (z * own[0][0] + c * own[0][1]);
    }
    return SL_OK;
}

/* A copy's chart from the one it shows: the same numbers, corner by corner. */
sl_status sl_edit_follow(sl_session *s, const sl_edit_slot *shown, sl_edit_slot *copy, const sl_context *context)
{
    sl_status status = SL_OK;
    const sl_mesh *mesh = s->mesh;
    sl_edit_chart *old = copy->chart, *chart = NULL;
    sl_patch *patch = NULL;
    double *uv = NULL;
    int32_t at = 0;
    SL_TRY(sl_patch_extract(mesh, s->base->triangulation, old->face, old->nface, &patch));
    uv = sl_calloc(patch->nv, 2 * sizeof *uv);
    SL_TRY(uv != NULL ? SL_OK : SL_OUT_OF_MEMORY);
    for (int32_t i = 0; i < shown->chart->nface; i++) {
        s->face_mark[shown->chart->face[i]] = at;
        at += sl_degree(mesh, shown->chart->face[i]);
    }
    for (int32_t i = 0, k = 0; i < old->nface; i++) {
        for (int32_t h = mesh->face_first[old->face[i]]; h < mesh->face_first[old->face[i] + 1]; h++) {
            const int32_t from = copy->map->from[k++];
            s->corner_mark[h] = s->face_mark[mesh->face[from]] + (from - mesh->face_first[mesh->face[from]]);
        }
    }
    for (int32_t c = 0; c < 3 * patch->nt; c++) {
        memcpy(uv + 2 * (int64_t)patch->tri[c], shown->chart->uv + 2 * (int64_t)s->corner_mark[patch->corner[c]],
               2 * sizeof *uv);
    }
    for (int32_t i = 0; i < shown->chart->nface; i++) {
        s->face_mark[shown->chart->face[i]] = -1;
    }
    for (int32_t i = 0; i < old->nface; i++) {
        for (int32_t h = mesh->face_first[old->face[i]]; h < mesh->face_first[old->face[i] + 1]; h++) {
            s->corner_mark[h] = -1;
        }
    }
    SL_TRY(sl_edit_chart_create(s, patch, old->face, old->nface, uv, copy->mirrored, &shown->chart->flat, context,
                                &chart));
    sl_edit_chart_release(old);
    chart->kept = shown->chart->kept;
    copy->chart = chart;
    copy->scale = shown->scale;
    copy->angle = shown->angle;
    memcpy(copy->offset, shown->offset, sizeof copy->offset);
cleanup:
    sl_patch_free(patch);
    sl_free(uv);
    return status;
}

/* All copies of a slot take its chart and its place. */
static sl_status lead_copies(sl_session *s, int32_t index, const sl_context *context)
{
    sl_status status = SL_OK;
    for (int32_t i = 0; i < s->slots; i++) {
        if (s->slot[i].chart != NULL && s->slot[i].copy_of == index) {
            sl_edit_slot copy = sl_edit_slot_share(&s->slot[i]);
            status = sl_edit_follow(s, &s->slot[index], &copy, context);
            if (status != SL_OK) {
                sl_edit_slot_clear(&copy);
                return status;
            }
            SL_TRY(sl_change_set_slot(s, i, &copy));
        }
    }
cleanup:
    return status;
}

/* The mirror image of a mirrored copy's chart, turned the right way round, in the same box of the page. */
static sl_status stand_alone(sl_session *s, int32_t index)
{
    sl_edit_slot slot = sl_edit_slot_share(&s->slot[index]);
    sl_edit_map_release(slot.map);
    slot.map = NULL;
    slot.copy_of = -1;
    if (slot.mirrored) {
        const sl_edit_chart *old = slot.chart;
        sl_edit_chart *chart = sl_alloc(1, sizeof *chart);
        if (chart == NULL) {
            sl_edit_slot_clear(&slot);
            return SL_OUT_OF_MEMORY;
        }
        *chart = *old;
        chart->refs = 1;
        chart->face = sl_copy(old->face, old->nface, sizeof *old->face);
        chart->uv = sl_copy(old->uv, old->ncorner, 2 * sizeof *old->uv);
        chart->red = sl_copy(old->red, old->nface, 1);
        chart->stretch = sl_copy(old->stretch, old->nface, sizeof *old->stretch);
        slot.chart = chart;
        sl_edit_chart_release(s->slot[index].chart); /* the share taken above */
        if (chart->face == NULL || chart->uv == NULL || chart->red == NULL || chart->stretch == NULL) {
            sl_edit_slot_clear(&slot);
            return SL_OUT_OF_MEMORY;
        }
        double low = INFINITY, high = -INFINITY;
        const double c = slot.scale * cos(slot.angle), z = slot.scale * sin(slot.angle);
        for (int32_t i = 0; i < chart->ncorner; i++) {
            double *uv = chart->uv + 2 * (int64_t)i;
            const double x = c * uv[0] - z * uv[1] + slot.offset[0];
            low = fmin(low, x);
            high = fmax(high, x);
            uv[0] = -uv[0];
        }
        slot.angle = -slot.angle;
        slot.offset[0] = low + high - slot.offset[0];
        slot.mirrored = false;
    }
    return sl_change_set_slot(s, index, &slot);
}

sl_status sl_edit_unshare(sl_session *s, int32_t slot)
{
    sl_status status = SL_OK;
    for (int32_t i = 0; i < s->slots; i++) {
        if (s->slot[i].chart != NULL && s->slot[i].copy_of >= 0 && (i == slot || s->slot[i].copy_of == slot)) {
            const int32_t of = s->slot[i].copy_of;
            SL_TRY(stand_alone(s, i));
            sl_edit_note(s, "chart %d shares its texture with chart %d no more, and lies over it until it is moved", i,
                         of);
        }
    }
cleanup:
    return status;
}

sl_status sl_edit_resolve(sl_session *s, int32_t index, const sl_context *context, sl_diag *diag)
{
    sl_status status = SL_OK;
    const sl_edit_chart *old = s->slot[index].chart;
    sl_edit_wish **list = sl_alloc(s->wishes->count, sizeof *list);
    sl_edit_slot slot = {.copy_of = -1, .scale = sl_edit_density(&s->slot[index])};
    int32_t count = 0;
    SL_TRY(list != NULL ? SL_OK : SL_OUT_OF_MEMORY);
    for (int32_t i = 0; i < s->wishes->count; i++) {
        sl_edit_wish *w = s->wishes->wish[i];
        if (w->kind != SL_ACTION_PIN && s->face_chart[s->mesh->face[w->corner[0]]] == index) {
            list[count++] = w;
        }
    }
    SL_TRY(sl_edit_solve(s, old->face, old->nface, count, list, context, &slot.chart, diag));
    sl_edit_align(s, &slot, -1);
    SL_TRY(sl_edit_apply_pins(s, &slot, diag));
    status = sl_change_set_slot(s, index, &slot);
    slot = (sl_edit_slot){.copy_of = -1};
    SL_TRY(status);
    SL_TRY(lead_copies(s, index, context));
cleanup:
    sl_free(list);
    sl_edit_slot_clear(&slot);
    return status;
}

/* The slot that is moved where a facet's chart is: the one it shows. SL_INFEASIBLE where pins hold it. */
static sl_status find_movable(const sl_session *s, int32_t facet, int32_t *index, sl_diag *diag)
{
    if (facet < 0 || facet >= s->mesh->nf) {
        sl_diag_reason(diag, "there is no facet %d", facet);
        return SL_BAD_INPUT;
    }
    *index = s->face_chart[facet];
    *index = s->slot[*index].copy_of >= 0 ? s->slot[*index].copy_of : *index;
    for (int32_t i = 0; i < s->wishes->count; i++) {
        const sl_edit_wish *w = s->wishes->wish[i];
        if (w->kind == SL_ACTION_PIN && has_face(s->slot[*index].chart, s->mesh->face[w->corner[0]])) {
            sl_diag_reason(diag, "the chart is held by pin %d", w->id);
            sl_diag_hint(diag, "drop the pin first");
            return SL_INFEASIBLE;
        }
    }
    return SL_OK;
}

sl_status sl_edit_move_slot(sl_session *s, int32_t index, const sl_edit_slot *place)
{
    sl_status status = SL_OK;
    for (int32_t i = 0; i < s->slots; i++) {
        if (s->slot[i].chart != NULL && (i == index || s->slot[i].copy_of == index)) {
            sl_edit_slot slot = sl_edit_slot_share(&s->slot[i]);
            slot.scale = place->scale;
            slot.angle = place->angle;
            memcpy(slot.offset, place->offset, sizeof slot.offset);
            SL_TRY(sl_change_set_slot(s, i, &slot));
        }
    }
cleanup:
    return status;
}

/* Box of a slot's chart on the page. */
static void find_box(const sl_session *s, int32_t index, double low[2], double high[2])
{
    const sl_edit_chart *chart = s->slot[index].chart;
    low[0] = low[1] = INFINITY;
    high[0] = high[1] = -INFINITY;
    for (int32_t i = 0; i < chart->nface; i++) {
        for (int32_t h = s->mesh->face_first[chart->face[i]]; h < s->mesh->face_first[chart->face[i] + 1]; h++) {
            for (int k = 0; k < 2; k++) {
                low[k] = fmin(low[k], s->corner_uv[2 * (int64_t)h + k]);
                high[k] = fmax(high[k], s->corner_uv[2 * (int64_t)h + k]);
            }
        }
    }
}

/* Turns by `angle` and scales by `factor` about the centre of the box, then moves. */
static sl_status transform(sl_session *s, const sl_action *a, double angle, double factor, const double by[2],
                           sl_diag *diag)
{
    sl_status status = SL_OK;
    int32_t index = -1;
    double low[2], high[2];
    SL_TRY(find_movable(s, a->facet, &index, diag));
    find_box(s, index, low, high);
    const double x = 0.5 * (low[0] + high[0]), y = 0.5 * (low[1] + high[1]);
    sl_edit_slot place = s->slot[index]; /* borrowed: only numbers are changed */
    const double c = factor * cos(angle), z = factor * sin(angle);
    const double dx = place.offset[0] - x, dy = place.offset[1] - y;
    place.angle = remainder(place.angle + angle, 2.0 * acos(-1.0));
    place.scale *= factor;
    place.offset[0] = x + (c * dx - z * dy) + by[0];
    place.offset[1] = y + (z * dx + c * dy) + by[1];
    if (!isfinite(place.scale) || !(place.scale > 0.0) || !(fabs(place.offset[0]) + fabs(place.offset[1]) < 1e5)) {
        sl_diag_reason(diag, "the chart would be too far away, too large or too small");
        SL_TRY(SL_INFEASIBLE);
    }
    SL_TRY(sl_edit_move_slot(s, index, &place));
cleanup:
    return status;
}

sl_status sl_do_move(sl_session *s, const sl_action *a, const sl_context *context, sl_diag *diag)
{
    (void)context;
    return transform(s, a, 0.0, 1.0, a->uv, diag);
}

sl_status sl_do_rotate(sl_session *s, const sl_action *a, const sl_context *context, sl_diag *diag)
{
    (void)context;
    return transform(s, a, a->number * degree, 1.0, (const double[2]){0.0, 0.0}, diag);
}

sl_status sl_do_scale(sl_session *s, const sl_action *a, const sl_context *context, sl_diag *diag)
{
    (void)context;
    return transform(s, a, 0.0, a->number, (const double[2]){0.0, 0.0}, diag);
}
