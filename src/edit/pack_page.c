/* All charts anew onto the page. */
#include "edit/session_internal.h"

#include "base/memory.h"

#include <string.h>

/* What the packer takes: charts that are no copies. */
typedef struct packing {
    int32_t count;
    int32_t *slot;
    double *unit; /* own uv times this = one density for all */
    sl_pack_chart *chart;
    sl_placement *placement;
    double *uv;
    int32_t *tri;
} packing;

static void packing_clear(packing *p)
{
    void *arrays[] = {p->slot, p->unit, p->chart, p->placement, p->uv, p->tri};
    for (size_t i = 0; i < SL_COUNTOF(arrays); i++) {
        sl_free(arrays[i]);
    }
}

/* Appends the chart of a slot: its corners as points, its triangles by their place among these. */
static void add_chart(const sl_session *s, int32_t index, packing *p, int64_t *points, int64_t *triangles)
{
    const sl_triangulation *t = s->base->triangulation;
    const sl_edit_slot *slot = &s->slot[index];
    const sl_edit_chart *chart = slot->chart;
    sl_pack_chart *out = &p->chart[p->count];
    p->slot[p->count] = index;
    p->unit[p->count] = sl_edit_density(slot) > 0.0 ? slot->scale / sl_edit_density(slot) : 1.0;
    out->uv = p->uv + 2 * *points;
    out->tri = p->tri + 3 * *triangles;
    for (int32_t i = 0; i < 2 * chart->ncorner; i++) {
        p->uv[2 * *points + i] = p->unit[p->count] * chart->uv[i];
    }
    for (int32_t i = 0; i < chart->nface; i++) {
        const int32_t f = chart->face[i];
        for (int32_t k = 3 * t->first[f]; k < 3 * t->first[f + 1]; k++) {
            p->tri[3 * (*triangles + out->nt) + (k - 3 * t->first[f])] =
                out->nv + t->corner[k] - s->mesh->face_first[f];
        }
        out->nt += t->first[f + 1] - t->first[f];
        out->nv += sl_degree(s->mesh, f);
    }
    *points += out->nv;
    *triangles += out->nt;
    p->count++;
}

static sl_status packing_init(const sl_session *s, packing *p)
{
    int64_t points = 0, triangles = 0;
    p->slot = sl_alloc(s->slots, sizeof *p->slot);
    p->unit = sl_alloc(s->slots, sizeof *p->unit);
    p->chart = sl_calloc(s->slots, sizeof *p->chart);
    p->placement = sl_calloc(s->slots, sizeof *p->placement);
    p->uv = sl_alloc(s->mesh->nh, 2 * sizeof *p->uv);
    p->tri = sl_alloc(s->base->triangulation->nt, 3 * sizeof *p->tri);
    if (p->slot == NULL || p->unit == NULL || p->chart == NULL || p->placement == NULL || p->uv == NULL ||
        p->tri == NULL) {
        return SL_OUT_OF_MEMORY;
    }
    for (int32_t i = 0; i < s->slots; i++) {
        if (s->slot[i].chart != NULL && s->slot[i].copy_of < 0) {
            add_chart(s, i, p, &points, &triangles);
        }
    }
    return SL_OK;
}

static sl_status drop_pins(sl_session *s)
{
    for (int32_t i = s->wishes->count - 1; i >= 0; i--) {
        const sl_edit_wish *w = s->wishes->wish[i];
        if (w->kind == SL_ACTION_PIN) {
            sl_edit_wishes *list = NULL;
            sl_edit_note(s, "pin %d is given up: packing moves all charts", w->id);
            const sl_status status = sl_edit_wishes_edit(s->wishes, i, NULL, &list);
            if (status != SL_OK) {
                return status;
            }
            sl_change_set_wishes(s, list);
        }
    }
    return SL_OK;
}

sl_status sl_do_pack(sl_session *s, const sl_action *a, const sl_context *context, sl_diag *diag)
{
    sl_status status = SL_OK;
    packing p = {0};
    sl_pack_info info;
    sl_pack_def def = s->def.pack;
    def.resolution = a->resolution;
    def.margin = a->margin;
    SL_TRY(packing_init(s, &p));
    status = sl_pack(p.count, p.chart, &def, context, p.placement, &info);
    if (status == SL_INFEASIBLE) {
        sl_diag_reason(diag, "%d charts and their margins do not fit into %d x %d texels", p.count, def.resolution,
                       def.resolution);
    }
    SL_TRY(status);
    SL_TRY(drop_pins(s));
    for (int32_t k = 0; k < p.count; k++) {
        const sl_placement *at = &p.placement[k];
        for (int32_t i = 0; i < s->slots; i++) {
            if (s->slot[i].chart == NULL || (i != p.slot[k] && s->slot[i].copy_of != p.slot[k])) {
                continue;
            }
            sl_edit_slot slot = sl_edit_slot_share(&s->slot[i]);
            slot.scale = info.scale * p.unit[k];
            slot.angle = at->angle;
            memcpy(slot.offset, at->offset, sizeof slot.offset);
            SL_TRY(sl_change_set_slot(s, i, &slot));
        }
    }
cleanup:
    packing_clear(&p);
    return status;
}
