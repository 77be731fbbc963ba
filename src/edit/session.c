/* A session's life: opened, changed action by action, gone back in, closed. */
#include "edit/session_internal.h"

#include "base/memory.h"

#include <math.h>
#include <string.h>

static sl_atlas_def session_def(const sl_atlas_def *def, const sl_action *open, const double *corner_uv)
{
    sl_atlas_def d = def != NULL ? *def : sl_atlas_default();
    d.segment.flatten.max_stretch = open->number;
    d.segment.symmetry = open->on ? d.segment.symmetry : SL_SYMMETRY_USE_OFF;
    d.pack.resolution = open->resolution;
    d.pack.margin = open->margin;
    if (strcmp(open->name, "uv") == 0) {
        d.seams = SL_SEAMS_KEEP_UV;
        d.seam_input = (sl_seam_input){.corner_uv = corner_uv};
    }
    return d;
}

static sl_status allocate_arrays(sl_session *s)
{
    const int32_t nf = s->mesh->nf, nh = s->mesh->nh;
    s->scar = sl_calloc(nh, 1);
    s->corner_uv = sl_calloc(nh, 2 * sizeof *s->corner_uv);
    s->face_chart = sl_alloc(nf, sizeof *s->face_chart);
    s->red = sl_calloc(nf, 1);
    s->stretch = sl_calloc(nf, sizeof *s->stretch);
    s->face_mark = sl_alloc(nf, sizeof *s->face_mark);
    s->corner_mark = sl_alloc(nh, sizeof *s->corner_mark);
    s->wishes = sl_calloc(1, sizeof *s->wishes);
    if (s->scar == NULL || s->corner_uv == NULL || s->face_chart == NULL || s->red == NULL || s->stretch == NULL ||
        s->face_mark == NULL || s->corner_mark == NULL || s->wishes == NULL) {
        return SL_OUT_OF_MEMORY;
    }
    s->wishes->refs = 1;
    s->wishes->wish = sl_alloc(0, sizeof(sl_edit_wish *));
    for (int32_t f = 0; f < nf; f++) {
        s->face_mark[f] = -1;
    }
    for (int32_t h = 0; h < nh; h++) {
        s->corner_mark[h] = -1;
    }
    return s->wishes->wish != NULL ? SL_OK : SL_OUT_OF_MEMORY;
}

static sl_status keep_line(sl_session *s, char *line)
{
    const sl_status status = sl_reserve((void **)&s->line, &s->line_room, (int64_t)s->lines + 1, sizeof *s->line);
    if (status == SL_OK) {
        s->line[s->lines++] = line;
    } else {
        sl_free(line);
    }
    return status;
}

sl_status sl_session_create(const sl_polygons *polygons, const double *corner_uv, const sl_action *open,
                            const sl_atlas_def *def, const sl_context *context, sl_session **out, sl_diag *diag)
{
    sl_status status = SL_OK;
    sl_session *s = sl_calloc(1, sizeof *s);
    char *line = NULL;
    *out = NULL;
    SL_TRY(s != NULL ? SL_OK : SL_OUT_OF_MEMORY);
    s->next_id = 1;
    s->def = session_def(def, open, corner_uv);
    if (s->def.seams == SL_SEAMS_KEEP_UV && corner_uv == NULL) {
        sl_diag_reason(diag, "the mesh has no UVs to begin with");
        sl_diag_hint(diag, "begin with \"start\":\"automatic\"");
        SL_TRY(SL_BAD_INPUT);
    }
    SL_TRY(sl_action_copy(open, &s->open));
    SL_TRY(sl_unwrap(polygons, &s->def, context, &s->base, diag));
    s->mesh = s->base->mesh;
    SL_TRY(allocate_arrays(s));
    SL_TRY(sl_edit_take_charts(s, corner_uv, context));
    SL_TRY(sl_edit_derive_all(s));
    line = sl_action_format(open);
    SL_TRY(line != NULL ? SL_OK : SL_OUT_OF_MEMORY);
    SL_TRY(keep_line(s, line));
    s->def.seam_input = (sl_seam_input){0}; /* was borrowed */
    *out = s;
    s = NULL;
cleanup:
    sl_session_free(s);
    return status;
}

void sl_session_free(sl_session *s)
{
    if (s == NULL) {
        return;
    }
    if (s->changing) {
        sl_change_clear(&s->open_change);
    }
    for (int32_t i = 0; i < s->entries; i++) {
        sl_change_clear(&s->history[i]);
    }
    for (int32_t i = 0; i < s->slots; i++) {
        sl_edit_slot_clear(&s->slot[i]);
    }
    for (int32_t i = 0; i < s->lines; i++) {
        sl_free(s->line[i]);
    }
    sl_edit_grip_release(s);
    sl_edit_wishes_release(s->wishes);
    sl_action_clear(&s->open);
    sl_atlas_free(s->base);
    void *arrays[] = {s->scar,    s->slot, s->corner_uv, s->face_chart, s->red,       s->stretch,
                      s->history, s->line, s->changed,   s->note,       s->face_mark, s->corner_mark};
    for (size_t i = 0; i < SL_COUNTOF(arrays); i++) {
        sl_free(arrays[i]);
    }
    if (s->log != NULL) {
        fclose(s->log);
    }
    sl_free(s);
}

/* What each kind of action is done by; NULL: not a change of the atlas. */
static sl_edit_do *doer(sl_action_kind kind)
{
    static sl_edit_do *const table[SL_ACTION_KINDS] = {
        [SL_ACTION_DELETE_SEAM] = sl_do_delete_seam,
        [SL_ACTION_CUT_PATH] = sl_do_cut_path,
        [SL_ACTION_CUT_LOOP] = sl_do_cut_loop,
        [SL_ACTION_CUT_EDGES] = sl_do_cut_edges,
        [SL_ACTION_SEW] = sl_do_sew,
        [SL_ACTION_UNSEW] = sl_do_unsew,
        [SL_ACTION_CUT_CHART] = sl_do_cut_chart,
        [SL_ACTION_MERGE] = sl_do_merge,
        [SL_ACTION_ANGLE] = sl_do_wish,
        [SL_ACTION_STRAIGHTEN] = sl_do_wish,
        [SL_ACTION_STRAIGHTEN_BORDER] = sl_do_wish,
        [SL_ACTION_RECTANGLE] = sl_do_wish,
        [SL_ACTION_RIGHT] = sl_do_wish,
        [SL_ACTION_DROP] = sl_do_drop,
        [SL_ACTION_PIN] = sl_do_wish,
        [SL_ACTION_MOVE] = sl_do_move,
        [SL_ACTION_ROTATE] = sl_do_rotate,
        [SL_ACTION_SCALE] = sl_do_scale,
        [SL_ACTION_SYMMETRY] = sl_do_symmetry,
        [SL_ACTION_PACK] = sl_do_pack,
    };
    return (unsigned)kind < SL_ACTION_KINDS ? table[kind] : NULL;
}

/* Begins a change, does it, shows it; on failure all is as before. */
static sl_status perform(sl_session *s, const sl_action *a, const sl_context *context, sl_diag *diag)
{
    bool shown = false;
    sl_change_begin(s);
    sl_status status = doer(a->kind)(s, a, context, diag);
    if (status == SL_OK) {
        shown = true;
        status = sl_change_show(s);
    }
    if (status != SL_OK) {
        const sl_status back = sl_change_roll_back(s, shown);
        s->notes = 0;
        return back != SL_OK ? back : status;
    }
    return SL_OK;
}

static void forget_redo(sl_session *s)
{
    while (s->entries > s->cursor) {
        sl_change_clear(&s->history[--s->entries]);
    }
}

/* One line to the log, at once: a process that is killed afterwards has left it whole. */
static sl_status write_log(sl_session *s, const char *line, sl_diag *diag)
{
    if (s->log == NULL) {
        return SL_OK;
    }
    if (fprintf(s->log, "%s\n", line) < 0 || fflush(s->log) != 0) {
        clearerr(s->log);
        sl_diag_reason(diag, "the session's log could not be written");
        return SL_IO;
    }
    return SL_OK;
}

/* Room for one more of everything that recording an action takes, so that nothing fails once the log has its line. */
static sl_status make_room(sl_session *s, const sl_action *a, char **line, char **copy)
{
    sl_status status = SL_OK;
    *copy = NULL;
    *line = sl_action_format(a);
    SL_TRY(*line != NULL ? SL_OK : SL_OUT_OF_MEMORY);
    *copy = sl_copy(*line, (int64_t)strlen(*line) + 1, 1);
    SL_TRY(*copy != NULL ? SL_OK : SL_OUT_OF_MEMORY);
    SL_TRY(sl_reserve((void **)&s->history, &s->history_room, (int64_t)s->entries + 1, sizeof *s->history));
    SL_TRY(sl_reserve((void **)&s->line, &s->line_room, (int64_t)s->lines + 1, sizeof *s->line));
cleanup:
    return status;
}

/* The change under way becomes the last entry of the history. line and copy are taken over. */
static void record(sl_session *s, const sl_action *a, char *line, char *copy)
{
    forget_redo(s);
    s->line[s->lines++] = line;
    s->open_change.line = copy;
    if (a->kind == SL_ACTION_CHECKPOINT) {
        memcpy(s->open_change.checkpoint, a->name, sizeof s->open_change.checkpoint);
    }
    s->history[s->entries++] = s->open_change;
    s->cursor = s->entries;
    s->open_change = (sl_change){0};
    s->changing = false;
}

static sl_status apply_change(sl_session *s, const sl_action *a, const sl_context *context, sl_diag *diag)
{
    sl_status status = SL_OK;
    char *line = NULL, *copy = NULL;
    SL_TRY(make_room(s, a, &line, &copy));
    if (a->kind == SL_ACTION_CHECKPOINT) {
        sl_change_begin(s);
    } else {
        SL_TRY(perform(s, a, context, diag));
    }
    status = write_log(s, line, diag);
    if (status != SL_OK) {
        const sl_status back = sl_change_roll_back(s, true);
        SL_TRY(back != SL_OK ? back : status);
    }
    record(s, a, line, copy);
    return SL_OK;
cleanup:
    sl_free(line);
    sl_free(copy);
    return status;
}

/* Where undo or redo leads to, as a number of entries done. */
static sl_status find_cursor(const sl_session *s, const sl_action *a, int32_t *cursor, sl_diag *diag)
{
    int32_t to = s->cursor;
    if (a->kind == SL_ACTION_REDO) {
        to = s->entries - s->cursor >= a->steps ? s->cursor + a->steps : -1;
    } else if (a->name[0] == '\0') {
        to = s->cursor >= a->steps ? s->cursor - a->steps : -1;
    } else {
        while (to > 0 && strcmp(s->history[to - 1].checkpoint, a->name) != 0) {
            to--;
        }
        if (to == 0 || to == s->cursor) {
            sl_diag_reason(diag,
                           to == 0 ? "there is no checkpoint \"%s\" to go back to"
                                   : "the state is that of checkpoint \"%s\" already",
                           a->name);
            return SL_INFEASIBLE;
        }
    }
    if (to < 0) {
        sl_diag_reason(diag, "there is nothing to %s", a->kind == SL_ACTION_UNDO ? "undo" : "redo");
        return SL_INFEASIBLE;
    }
    *cursor = to;
    return SL_OK;
}

static sl_status move_cursor(sl_session *s, int32_t to)
{
    sl_status status = SL_OK;
    while (s->cursor > to && status == SL_OK) {
        status = sl_change_undo(s, &s->history[--s->cursor]);
    }
    while (s->cursor < to && status == SL_OK) {
        status = sl_change_redo(s, &s->history[s->cursor++]);
    }
    return status;
}

static sl_status apply_cursor(sl_session *s, const sl_action *a, sl_diag *diag)
{
    sl_status status = SL_OK;
    const int32_t before = s->cursor;
    int32_t to = before;
    char *line = NULL, *copy = NULL;
    SL_TRY(find_cursor(s, a, &to, diag));
    SL_TRY(make_room(s, a, &line, &copy));
    s->notes = 0;
    SL_TRY(move_cursor(s, to));
    status = write_log(s, line, diag);
    if (status != SL_OK) {
        const sl_status back = move_cursor(s, before);
        SL_TRY(back != SL_OK ? back : status);
    }
    s->line[s->lines++] = line;
    line = NULL;
cleanup:
    sl_free(line);
    sl_free(copy);
    return status;
}

sl_status sl_session_apply(sl_session *s, const sl_action *action, const sl_context *context, sl_diag *diag)
{
    sl_session_cancel_drag(s);
    s->changes = 0;
    if (action->kind == SL_ACTION_UNDO || action->kind == SL_ACTION_REDO) {
        return apply_cursor(s, action, diag);
    }
    if (doer(action->kind) == NULL && action->kind != SL_ACTION_CHECKPOINT) {
        sl_diag_reason(diag, "a session is opened once, at its beginning");
        return SL_BAD_INPUT;
    }
    return apply_change(s, action, context, diag);
}

sl_status sl_session_drag(sl_session *s, const sl_action *action, const sl_context *context, sl_diag *diag)
{
    sl_status status = SL_OK;
    sl_change last = {0};
    const bool again = s->dragging;
    if (doer(action->kind) == NULL) {
        sl_diag_reason(diag, "%s cannot be dragged", sl_action_name(action->kind));
        return SL_BAD_INPUT;
    }
    s->changes = 0;
    if (again) { /* what was shown last is kept for the case that this one is refused */
        last = s->open_change;
        s->open_change = (sl_change){0};
        s->changing = false;
        SL_TRY(sl_change_undo(s, &last));
    }
    s->quick = true;
    status = perform(s, action, context, diag);
    s->quick = false;
    s->dragging = status == SL_OK;
    if (status != SL_OK && again) {
        const sl_status back = sl_change_redo(s, &last);
        s->open_change = last;
        s->changing = s->dragging = true;
        return back != SL_OK ? back : status;
    }
cleanup:
    sl_change_clear(&last);
    return status;
}

void sl_session_cancel_drag(sl_session *s)
{
    sl_edit_grip_release(s);
    if (s->dragging) {
        const sl_status status = sl_change_roll_back(s, true);
        (void)status; /* nothing is allocated that the drag has not allocated before */
        s->dragging = false;
    }
}

sl_status sl_session_release(sl_session *s, const sl_action *action, const sl_context *context, sl_diag *diag)
{
    return sl_session_apply(s, action, context, diag);
}

bool sl_session_dragging(const sl_session *s)
{
    return s->dragging;
}

int32_t sl_session_history(const sl_session *s, int32_t *cursor)
{
    *cursor = s->cursor;
    return s->entries;
}

const char *sl_session_history_line(const sl_session *s, int32_t index)
{
    return s->history[index].line;
}

int32_t sl_session_lines(const sl_session *s)
{
    return s->lines;
}

const char *sl_session_line(const sl_session *s, int32_t index)
{
    return s->line[index];
}
