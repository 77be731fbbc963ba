/* A change of the state, kept so that it can be taken back and done again. */
#include "edit/session_internal.h"

#include "base/memory.h"

#include <stdarg.h>
#include <string.h>

static uint8_t edge_bits(const sl_session *s, int32_t h)
{
    return (uint8_t)((s->mesh->sew[h] >= 0 ? SL_EDGE_CUT : 0) | (s->scar[h] != 0 ? SL_EDGE_SCAR : 0));
}

static void set_edge_bits(sl_session *s, int32_t h, uint8_t bits)
{
    const int32_t other = sl_opposite(s->mesh, h);
    if ((bits & SL_EDGE_CUT) != 0) {
        sl_mesh_cut_edge(s->mesh, h);
    } else {
        sl_mesh_sew_edge(s->mesh, h);
    }
    s->scar[h] = s->scar[other] = (bits & SL_EDGE_SCAR) != 0;
}

sl_status sl_change_set_edge(sl_session *s, int32_t halfedge, bool cut)
{
    sl_change *c = &s->open_change;
    const int32_t other = sl_opposite(s->mesh, halfedge);
    const uint8_t before = other >= 0 ? edge_bits(s, halfedge) : 0;
    if (other < 0 || ((before & SL_EDGE_CUT) != 0) == cut) {
        return SL_OK;
    }
    const sl_status status = sl_reserve((void **)&c->edge, &c->edge_room, c->edges + 1, sizeof *c->edge);
    if (status != SL_OK) {
        return status;
    }
    const uint8_t after = cut ? SL_EDGE_CUT : SL_EDGE_SCAR;
    c->edge[c->edges++] = (sl_edge_change){halfedge < other ? halfedge : other, before, after};
    set_edge_bits(s, halfedge, after);
    return SL_OK;
}

static sl_slot_change *find_slot_change(sl_change *c, int32_t index)
{
    for (int64_t i = 0; i < c->slots; i++) {
        if (c->slot[i].slot == index) {
            return &c->slot[i];
        }
    }
    return NULL;
}

int32_t sl_edit_empty_slot(const sl_session *s)
{
    int32_t i = 0;
    while (i < s->slots && s->slot[i].chart != NULL) {
        i++;
    }
    return i;
}

sl_status sl_change_set_slot(sl_session *s, int32_t index, sl_edit_slot *slot)
{
    sl_status status = SL_OK;
    sl_change *c = &s->open_change;
    SL_TRY(sl_reserve((void **)&s->slot, &s->slot_room, (int64_t)index + 1, sizeof *s->slot));
    SL_TRY(sl_reserve((void **)&c->slot, &c->slot_room, c->slots + 1, sizeof *c->slot));
    if (index == s->slots) {
        s->slot[s->slots++] = (sl_edit_slot){.copy_of = -1};
    }
    sl_slot_change *change = find_slot_change(c, index);
    if (change == NULL) {
        change = &c->slot[c->slots++];
        *change = (sl_slot_change){.slot = index, .before = sl_edit_slot_share(&s->slot[index])};
    }
    sl_edit_slot_clear(&change->after);
    change->after = sl_edit_slot_share(slot);
    sl_edit_slot_clear(&s->slot[index]);
    s->slot[index] = *slot;
    return SL_OK;
cleanup:
    sl_edit_slot_clear(slot);
    return status;
}

static sl_edit_wishes *share_wishes(sl_edit_wishes *wishes)
{
    if (wishes != NULL) {
        wishes->refs++;
    }
    return wishes;
}

void sl_change_set_wishes(sl_session *s, sl_edit_wishes *wishes)
{
    sl_edit_wishes_release(s->wishes);
    s->wishes = wishes;
    sl_edit_wishes_release(s->open_change.wishes_after);
    s->open_change.wishes_after = share_wishes(wishes);
}

void sl_change_begin(sl_session *s)
{
    SL_ASSERT(!s->changing);
    s->changing = true;
    s->open_change = (sl_change){.wishes_before = share_wishes(s->wishes),
                                 .wishes_after = share_wishes(s->wishes),
                                 .id_before = s->next_id,
                                 .id_after = s->next_id};
    s->notes = 0;
}

void sl_change_clear(sl_change *change)
{
    for (int64_t i = 0; i < change->slots; i++) {
        sl_edit_slot_clear(&change->slot[i].before);
        sl_edit_slot_clear(&change->slot[i].after);
    }
    sl_edit_wishes_release(change->wishes_before);
    sl_edit_wishes_release(change->wishes_after);
    sl_free(change->slot);
    sl_free(change->edge);
    sl_free(change->line);
    *change = (sl_change){0};
}

static void put_slot(sl_session *s, int32_t index, const sl_edit_slot *slot)
{
    const sl_edit_slot shared = sl_edit_slot_share(slot);
    sl_edit_slot_clear(&s->slot[index]);
    s->slot[index] = shared;
}

static void put_wishes(sl_session *s, sl_edit_wishes *wishes)
{
    share_wishes(wishes);
    sl_edit_wishes_release(s->wishes);
    s->wishes = wishes;
}

static void take_back(sl_session *s, const sl_change *change)
{
    for (int64_t i = change->edges - 1; i >= 0; i--) {
        set_edge_bits(s, change->edge[i].halfedge, change->edge[i].before);
    }
    for (int64_t i = change->slots - 1; i >= 0; i--) {
        put_slot(s, change->slot[i].slot, &change->slot[i].before);
    }
    put_wishes(s, change->wishes_before);
    s->next_id = change->id_before;
}

/* Page UVs and the like of one slot. work: 2 a corner of the chart. */
static void derive_slot(sl_session *s, int32_t index, double *work)
{
    const sl_edit_slot *slot = &s->slot[index];
    const sl_edit_chart *chart = slot->chart;
    const double *from = work;
    sl_edit_slot_place(slot, work);
    for (int32_t i = 0; i < chart->nface; i++) {
        const int32_t f = chart->face[i], degree = sl_degree(s->mesh, f);
        memcpy(s->corner_uv + 2 * (int64_t)s->mesh->face_first[f], from, 2 * (size_t)degree * sizeof *from);
        from += 2 * degree;
        s->face_chart[f] = index;
        s->red[f] = chart->red[i];
        s->stretch[f] = chart->stretch[i];
    }
}

/* Refreshes what is derived from slots; also remembers them as changed. */
static sl_status derive_changed(sl_session *s, const sl_change *change)
{
    sl_status status = SL_OK;
    int64_t most = 0;
    double *work = NULL;
    for (int64_t i = 0; i < change->slots; i++) {
        const sl_edit_chart *chart = s->slot[change->slot[i].slot].chart;
        most = chart != NULL && chart->ncorner > most ? chart->ncorner : most;
    }
    work = sl_alloc(most, 2 * sizeof *work);
    SL_TRY(work != NULL ? SL_OK : SL_OUT_OF_MEMORY);
    SL_TRY(sl_reserve((void **)&s->changed, &s->changed_room, s->changes + change->slots, sizeof *s->changed));
    for (int64_t i = 0; i < change->slots; i++) {
        s->changed[s->changes++] = change->slot[i].slot;
        if (s->slot[change->slot[i].slot].chart != NULL) {
            derive_slot(s, change->slot[i].slot, work);
        }
    }
    s->revision++;
cleanup:
    sl_free(work);
    return status;
}

sl_status sl_edit_derive_all(sl_session *s)
{
    sl_status status = SL_OK;
    double *work = sl_alloc(s->mesh->nh, 2 * sizeof *work);
    SL_TRY(work != NULL ? SL_OK : SL_OUT_OF_MEMORY);
    for (int32_t i = 0; i < s->slots; i++) {
        if (s->slot[i].chart != NULL) {
            derive_slot(s, i, work);
        }
    }
cleanup:
    sl_free(work);
    return status;
}

sl_status sl_change_show(sl_session *s)
{
    s->open_change.id_after = s->next_id;
    return derive_changed(s, &s->open_change);
}

sl_status sl_change_roll_back(sl_session *s, bool shown)
{
    SL_ASSERT(s->changing);
    take_back(s, &s->open_change);
    const sl_status status = shown ? derive_changed(s, &s->open_change) : SL_OK;
    sl_change_clear(&s->open_change);
    s->changing = false;
    return status;
}

sl_status sl_change_undo(sl_session *s, const sl_change *change)
{
    take_back(s, change);
    return derive_changed(s, change);
}

sl_status sl_change_redo(sl_session *s, const sl_change *change)
{
    for (int64_t i = 0; i < change->edges; i++) {
        set_edge_bits(s, change->edge[i].halfedge, change->edge[i].after);
    }
    for (int64_t i = 0; i < change->slots; i++) {
        put_slot(s, change->slot[i].slot, &change->slot[i].after);
    }
    put_wishes(s, change->wishes_after);
    s->next_id = change->id_after;
    return derive_changed(s, change);
}

void sl_edit_note(sl_session *s, const char *format, ...)
{
    if (sl_reserve((void **)&s->note, &s->note_room, (int64_t)s->notes + 1, sizeof *s->note) != SL_OK) {
        return; /* what is said is not what is done */
    }
    va_list args;
    va_start(args, format);
    vsnprintf(s->note[s->notes++], sizeof *s->note, format, args);
    va_end(args);
}
