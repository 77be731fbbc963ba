#include "edit/script.h"

#include <jansson.h>
#include <stdio.h>
#include <string.h>

#include "base/file.h"
#include "base/memory.h"
#include "edit/session_internal.h"

enum { LONGEST_LINE = 1 << 26 };

void sl_script_clear(sl_script *script)
{
    for (int32_t i = 0; i < script->count; i++) {
        sl_action_clear(&script->action[i]);
    }
    sl_free(script->action);
    sl_free(script->line);
    *script = (sl_script){.vertices = -1, .facets = -1};
}

static sl_status header_number(const json_t *object, const char *key, int32_t *out, sl_diag *diag)
{
    const json_t *value = json_object_get(object, key);
    if (value == NULL) {
        return SL_OK;
    }
    if (!json_is_integer(value) || json_integer_value(value) < 0 || json_integer_value(value) > INT32_MAX) {
        sl_diag_reason(diag, "\"%s\" is no number of elements", key);
        return SL_BAD_INPUT;
    }
    *out = (int32_t)json_integer_value(value);
    return SL_OK;
}

/* The first line: what this is, which version, of which mesh. */
static sl_status parse_header(const char *text, int64_t size, sl_script *out, sl_diag *diag)
{
    sl_status status = SL_OK;
    json_t *object = json_loadb(text, (size_t)size, JSON_REJECT_DUPLICATES, NULL);
    const char *word = json_string_value(json_object_get(object, "seamlab"));
    const json_t *version = json_object_get(object, "version");
    if (word == NULL || strcmp(word, "session") != 0 || !json_is_integer(version)) {
        sl_diag_reason(diag, "the first line must be {\"seamlab\":\"session\",\"version\":%d}", SL_SCRIPT_VERSION);
        SL_TRY(SL_BAD_INPUT);
    }
    if (json_integer_value(version) != SL_SCRIPT_VERSION) {
        sl_diag_reason(diag, "version %lld of session scripts is not known, only %d",
                       (long long)json_integer_value(version), SL_SCRIPT_VERSION);
        SL_TRY(SL_BAD_INPUT);
    }
    const char *mesh = json_string_value(json_object_get(object, "mesh"));
    if (mesh != NULL) {
        snprintf(out->mesh, sizeof out->mesh, "%s", mesh);
    }
    SL_TRY(header_number(object, "vertices", &out->vertices, diag));
    SL_TRY(header_number(object, "facets", &out->facets, diag));
cleanup:
    json_decref(object);
    return status;
}

static sl_status push_action(sl_script *out, int64_t *rooms, const sl_action *action, int64_t line)
{
    sl_status status = SL_OK;
    SL_TRY(sl_reserve((void **)&out->action, &rooms[0], (int64_t)out->count + 1, sizeof *out->action));
    SL_TRY(sl_reserve((void **)&out->line, &rooms[1], (int64_t)out->count + 1, sizeof *out->line));
    out->action[out->count] = *action;
    out->line[out->count++] = line;
cleanup:
    return status;
}

/* One line of actions; opens stand first, and a script without one gets the default. */
static sl_status parse_line(const char *text, int64_t size, int64_t line, sl_script *out, int64_t *rooms, sl_diag *diag)
{
    sl_status status = SL_OK;
    sl_action action = {0};
    SL_TRY(sl_action_parse(text, size, &action, diag));
    if (action.kind == SL_ACTION_OPEN && out->count > 0) {
        sl_diag_reason(diag, "open can only be the first action");
        SL_TRY(SL_BAD_INPUT);
    }
    if (action.kind != SL_ACTION_OPEN && out->count == 0) {
        const sl_action open = sl_action_default(SL_ACTION_OPEN);
        SL_TRY(push_action(out, rooms, &open, 0));
    }
    SL_TRY(push_action(out, rooms, &action, line));
    action = (sl_action){0};
cleanup:
    sl_action_clear(&action);
    return status;
}

static bool says_nothing(const char *text, int64_t size)
{
    while (size > 0 && (*text == ' ' || *text == '\t' || *text == '\r')) {
        text++;
        size--;
    }
    return size == 0 || *text == '#';
}

static sl_status parse_lines(const char *text, int64_t size, bool tolerant, sl_script *out, sl_diag *diag)
{
    sl_status status = SL_OK;
    int64_t rooms[2] = {0, 0}, line = 0;
    bool headed = false;
    for (const char *at = text, *end = text + size; at < end;) {
        const char *stop = memchr(at, '\n', (size_t)(end - at));
        const int64_t n = stop != NULL ? stop - at : end - at;
        line++;
        if (diag != NULL) {
            diag->line = line;
        }
        if (stop == NULL && tolerant) {
            out->cut_off = true;
            break;
        }
        if (n > LONGEST_LINE) {
            sl_diag_reason(diag, "the line is too long");
            SL_TRY(SL_BAD_INPUT);
        }
        if (!says_nothing(at, n)) {
            SL_TRY(headed ? parse_line(at, n, line, out, rooms, diag) : parse_header(at, n, out, diag));
            headed = true;
        }
        at = stop != NULL ? stop + 1 : end;
    }
    if (!headed) {
        sl_diag_reason(diag, "no line says that this is a session");
        SL_TRY(SL_BAD_INPUT);
    }
    if (out->count == 0) {
        const sl_action open = sl_action_default(SL_ACTION_OPEN);
        SL_TRY(push_action(out, rooms, &open, 0));
    }
    if (diag != NULL) {
        diag->line = 0;
    }
cleanup:
    return status;
}

sl_status sl_script_parse(const char *name, const char *text, int64_t size, bool tolerant, sl_script *out,
                          sl_diag *diag)
{
    *out = (sl_script){.vertices = -1, .facets = -1};
    if (diag != NULL) {
        snprintf(diag->file, sizeof diag->file, "%s", name);
    }
    const sl_status status = parse_lines(text, size, tolerant, out, diag);
    if (status != SL_OK) {
        sl_script_clear(out);
    }
    return status;
}

sl_status sl_script_read(const char *path, bool tolerant, sl_script *out, sl_diag *diag)
{
    char *data = NULL;
    int64_t size = 0;
    *out = (sl_script){.vertices = -1, .facets = -1};
    sl_status status = sl_file_read(path, &data, &size, diag);
    if (status == SL_OK) {
        status = sl_script_parse(path, data, size, tolerant, out, diag);
    }
    sl_free(data);
    return status;
}

static sl_status check_mesh(const sl_script *script, const sl_polygons *polygons, sl_diag *diag)
{
    if ((script->vertices >= 0 && script->vertices != polygons->nv) ||
        (script->facets >= 0 && script->facets != polygons->nf)) {
        sl_diag_reason(diag, "the script is of a mesh of %d vertices and %d facets; this one has %d and %d",
                       script->vertices, script->facets, polygons->nv, polygons->nf);
        return SL_BAD_INPUT;
    }
    return SL_OK;
}

static void set_line(sl_diag *diag, int64_t line)
{
    if (diag != NULL) {
        diag->line = line;
    }
}

sl_status sl_script_run(const sl_script *script, int32_t count, const sl_polygons *polygons, const double *corner_uv,
                        const sl_atlas_def *def, sl_script_step_fn *step, void *user, const sl_context *context,
                        sl_session **out, sl_diag *diag)
{
    sl_status status = SL_OK;
    sl_session *s = NULL;
    const int32_t n = count < 0 || count > script->count ? script->count : count;
    *out = NULL;
    SL_TRY(check_mesh(script, polygons, diag));
    set_line(diag, script->line[0]);
    SL_TRY(sl_session_create(polygons, corner_uv, &script->action[0], def, context, &s, diag));
    for (int32_t i = 0; i < n; i++) {
        set_line(diag, script->line[i]);
        if (i > 0) {
            SL_TRY(sl_session_apply(s, &script->action[i], context, diag));
        }
        if (step != NULL && !step(user, s, script, i)) {
            SL_TRY(SL_CANCELLED);
        }
    }
    set_line(diag, 0);
    *out = s;
    s = NULL;
cleanup:
    sl_session_free(s);
    return status;
}

/* Texts in a header: what JSON would have to escape is left out. */
static void plain_text(const char *from, char *to, size_t size)
{
    size_t n = 0;
    for (; *from != '\0' && n + 1 < size; from++) {
        if ((unsigned char)*from >= 0x20 && *from != '"' && *from != '\\') {
            to[n++] = *from;
        }
    }
    to[n] = '\0';
}

sl_status sl_session_log_to(sl_session *s, const char *path, const char *mesh_name, sl_diag *diag)
{
    sl_status status = SL_OK;
    sl_writer *writer = NULL;
    char name[200];
    plain_text(mesh_name, name, sizeof name);
    SL_TRY(sl_writer_create(path, &writer, diag));
    sl_writer_format(writer, "{\"seamlab\":\"session\",\"version\":%d,\"mesh\":\"%s\",\"vertices\":%d,\"facets\":%d}\n",
                     SL_SCRIPT_VERSION, name, s->base->repair.vertices, s->mesh->nf);
    for (int32_t i = 0; i < s->lines; i++) {
        sl_writer_text(writer, s->line[i]);
        sl_writer_text(writer, "\n");
    }
    status = sl_writer_commit(writer, diag);
    writer = NULL;
    SL_TRY(status);
    FILE *log = fopen(path, "ab");
    if (log == NULL) {
        sl_diag_reason(diag, "the session's log cannot be opened");
        SL_TRY(SL_IO);
    }
    if (s->log != NULL) {
        fclose(s->log);
    }
    s->log = log;
cleanup:
    sl_writer_abandon(writer);
    return status;
}
