#include "view/message.h"

#include <jansson.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

static const char *const kind_name[SL_MESSAGE_KINDS] = {"look",    "seen",   "at",   "arc",  "do",   "drag",
                                                        "release", "let-go", "goto", "show", "save", "stop"};
static const char *const pane_name[SL_PANES] = {"3d", "uv"};
static const char *const shown_name[SL_SHOWN_KINDS] = {"checker", "charts", "stretch", "plain", "texture"};

static sl_status wrong(sl_diag *diag, const char *what)
{
    sl_diag_reason(diag, "message: %s", what);
    return SL_BAD_INPUT;
}

/* Position of a member's text among names. */
static bool word_of(const json_t *object, const char *key, const char *const *names, int32_t count, int32_t *out)
{
    const char *text = json_string_value(json_object_get(object, key));
    for (int32_t k = 0; text != NULL && k < count; k++) {
        if (strcmp(text, names[k]) == 0) {
            *out = k;
            return true;
        }
    }
    return false;
}

static bool number_of(const json_t *object, const char *key, double lo, double hi, double *out)
{
    const json_t *value = json_object_get(object, key);
    if (!json_is_number(value)) {
        return false;
    }
    *out = json_number_value(value);
    return isfinite(*out) && *out >= lo && *out <= hi;
}

static bool whole_of(const json_t *object, const char *key, int32_t lo, int32_t hi, int32_t *out)
{
    const json_t *value = json_object_get(object, key);
    if (!json_is_integer(value) || json_integer_value(value) < lo || json_integer_value(value) > hi) {
        return false;
    }
    *out = (int32_t)json_integer_value(value);
    return true;
}

static bool side_of(const json_t *object, int32_t side[3])
{
    const json_t *array = json_object_get(object, "at");
    for (size_t k = 0; k < 3; k++) {
        const json_t *value = json_array_get(array, k);
        if (!json_is_integer(value) || json_integer_value(value) < 0 || json_integer_value(value) > INT32_MAX) {
            return false;
        }
        side[k] = (int32_t)json_integer_value(value);
    }
    return json_array_size(array) == 3;
}

static sl_status parse_look(const json_t *object, sl_message *out, sl_diag *diag)
{
    sl_look *look = &out->look;
    const bool space = out->pane == SL_PANE_3D;
    if (!whole_of(object, "w", 16, 4096, &look->width) || !whole_of(object, "h", 16, 4096, &look->height)) {
        return wrong(diag, "a pane needs w and h from 16 to 4096");
    }
    if (!number_of(object, "zoom", 1e-3, 1e6, &look->zoom) || !number_of(object, "x", -1e6, 1e6, &look->x) ||
        !number_of(object, "y", -1e6, 1e6, &look->y)) {
        return wrong(diag, "zoom, x and y are numbers");
    }
    if (space && (!number_of(object, "azimuth", -1e6, 1e6, &look->azimuth) ||
                  !number_of(object, "elevation", -90.0, 90.0, &look->elevation))) {
        return wrong(diag, "azimuth and elevation are degrees");
    }
    look->still = json_is_true(json_object_get(object, "still"));
    return SL_OK;
}

/* The action's line goes through the parser that reads scripts: one way to say it. */
static sl_status parse_line(const json_t *object, sl_message *out, sl_diag *diag)
{
    char *line = json_dumps(json_object_get(object, "line"), JSON_COMPACT | JSON_REAL_PRECISION(17));
    if (line == NULL) {
        return wrong(diag, "the line of an action is missing");
    }
    const sl_status status = sl_action_parse(line, (int64_t)strlen(line), &out->action, diag);
    free(line);
    return status;
}

static sl_status parse_fields(const json_t *object, sl_message *out, sl_diag *diag)
{
    int32_t index = 0;
    const bool paned = out->kind == SL_MESSAGE_LOOK || out->kind == SL_MESSAGE_SEEN || out->kind == SL_MESSAGE_AT;
    if (paned && !word_of(object, "pane", pane_name, SL_PANES, &index)) {
        return wrong(diag, "pane is 3d or uv");
    }
    out->pane = (sl_pane)index;
    switch (out->kind) {
    case SL_MESSAGE_LOOK:
        return parse_look(object, out, diag);
    case SL_MESSAGE_AT:
        return whole_of(object, "x", -1, 4096, &out->x) && whole_of(object, "y", -1, 4096, &out->y)
                   ? SL_OK
                   : wrong(diag, "x and y are pixels");
    case SL_MESSAGE_ARC:
        return side_of(object, out->side) ? SL_OK : wrong(diag, "at names an edge: [vertex, vertex, facet]");
    case SL_MESSAGE_DO:
    case SL_MESSAGE_DRAG:
    case SL_MESSAGE_RELEASE:
        return parse_line(object, out, diag);
    case SL_MESSAGE_GOTO:
        return whole_of(object, "step", 0, INT32_MAX, &out->step) ? SL_OK : wrong(diag, "step is a number");
    case SL_MESSAGE_SHOW:
        if (!word_of(object, "what", shown_name, SL_SHOWN_KINDS, &index)) {
            return wrong(diag, "what to show is checker, charts, stretch, plain or texture");
        }
        out->shown = (sl_shown)index;
        return SL_OK;
    case SL_MESSAGE_SAVE:
        out->overlap = json_is_true(json_object_get(object, "overlap"));
        return SL_OK;
    case SL_MESSAGE_SEEN:
    case SL_MESSAGE_LET_GO:
    case SL_MESSAGE_STOP:
    case SL_MESSAGE_KINDS:
        break;
    }
    return SL_OK;
}

sl_status sl_message_parse(const char *text, int64_t size, sl_message *out, sl_diag *diag)
{
    json_error_t error;
    int32_t kind = 0;
    *out = (sl_message){0};
    if (size > SL_MESSAGE_LONGEST) {
        return wrong(diag, "too long");
    }
    json_t *object = json_loadb(text, (size_t)size, JSON_REJECT_DUPLICATES, &error);
    sl_status status = SL_OK;
    if (!json_is_object(object)) {
        status = wrong(diag, "no JSON object");
    } else if (!word_of(object, "t", kind_name, SL_MESSAGE_KINDS, &kind)) {
        status = wrong(diag, "t names no kind of message");
    } else {
        out->kind = (sl_message_kind)kind;
        status = parse_fields(object, out, diag);
    }
    json_decref(object);
    if (status != SL_OK) {
        sl_message_clear(out);
    }
    return status;
}

void sl_message_clear(sl_message *message)
{
    sl_action_clear(&message->action);
    *message = (sl_message){0};
}
