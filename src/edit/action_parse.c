/* From a line of JSON to an action. */
#include "edit/action_internal.h"

#include <jansson.h>
#include <math.h>
#include <string.h>

#include "base/memory.h"

static const double index_max = 2147483647.0;

/* One element number into the list. */
static sl_status push_number(const json_t *j, const char *key, sl_action *a, int64_t *room, sl_diag *diag)
{
    if (!json_is_integer(j) || json_integer_value(j) < 0 || (double)json_integer_value(j) > index_max) {
        sl_diag_reason(diag, "\"%s\" holds something that is not the number of an element", key);
        return SL_BAD_INPUT;
    }
    if (a->count >= SL_MAX_ITEMS) {
        sl_diag_reason(diag, "\"%s\" is too long", key);
        return SL_BAD_INPUT;
    }
    const sl_status status = sl_reserve((void **)&a->item, room, (int64_t)a->count + 1, sizeof *a->item);
    if (status == SL_OK) {
        a->item[a->count++] = (int32_t)json_integer_value(j);
    }
    return status;
}

static sl_status bad_shape(const sl_field *f, const char *what, sl_diag *diag)
{
    sl_diag_reason(diag, "\"%s\" must be %s", f->key, what);
    return SL_BAD_INPUT;
}

static sl_status parse_items(const json_t *value, const sl_field *f, sl_action *a, sl_diag *diag)
{
    sl_status status = SL_OK;
    int64_t room = 0;
    const size_t n = json_array_size(value);
    if (!json_is_array(value) || (f->kind == FIELD_NUMBERS && n != (size_t)f->width) || n < (size_t)f->least) {
        sl_diag_reason(diag, "\"%s\" must be a list of %s%d %s", f->key, f->kind == FIELD_NUMBERS ? "" : "at least ",
                       f->kind == FIELD_NUMBERS ? f->width : f->least,
                       f->kind == FIELD_TUPLES ? "lists of numbers" : "element numbers");
        return SL_BAD_INPUT;
    }
    for (size_t i = 0; i < n; i++) {
        const json_t *entry = json_array_get(value, i);
        if (f->kind != FIELD_TUPLES) {
            SL_TRY(push_number(entry, f->key, a, &room, diag));
            continue;
        }
        if (!json_is_array(entry) || json_array_size(entry) != (size_t)f->width) {
            sl_diag_reason(diag, "each entry of \"%s\" must hold %d numbers", f->key, f->width);
            return SL_BAD_INPUT;
        }
        for (int32_t k = 0; k < f->width; k++) {
            SL_TRY(push_number(json_array_get(entry, (size_t)k), f->key, a, &room, diag));
        }
    }
cleanup:
    return status;
}

static sl_status parse_real(const json_t *value, const sl_field *f, double *out, sl_diag *diag)
{
    const double x = json_is_number(value) ? json_number_value(value) : NAN;
    if (!(x >= f->lo && x <= f->hi)) {
        sl_diag_reason(diag, "\"%s\" must be a number from %g to %g", f->key, f->lo, f->hi);
        return SL_BAD_INPUT;
    }
    *out = x;
    return SL_OK;
}

static sl_status parse_text(const json_t *value, const sl_field *f, char *out, sl_diag *diag)
{
    const char *text = json_string_value(value);
    const size_t n = text != NULL ? strlen(text) : 0;
    if (text == NULL || n == 0 || n >= SL_ACTION_NAME || n != json_string_length(value)) {
        sl_diag_reason(diag, "\"%s\" must be a text of 1 to %d bytes", f->key, SL_ACTION_NAME - 1);
        return SL_BAD_INPUT;
    }
    for (size_t i = 0; i < n; i++) {
        if ((unsigned char)text[i] < 0x20 || text[i] == '"' || text[i] == '\\') {
            return bad_shape(f, "a text without control characters, quotes and backslashes", diag);
        }
    }
    memcpy(out, text, n + 1);
    return SL_OK;
}

static sl_status parse_field(const json_t *value, const sl_field *f, sl_action *a, sl_diag *diag)
{
    char *target = (char *)a + f->at;
    switch (f->kind) {
    case FIELD_NUMBERS:
    case FIELD_LIST:
    case FIELD_TUPLES:
        return parse_items(value, f, a, diag);
    case FIELD_INT:
        if (!json_is_integer(value) || (double)json_integer_value(value) < f->lo ||
            (double)json_integer_value(value) > f->hi) {
            sl_diag_reason(diag, "\"%s\" must be a whole number from %.0f to %.0f", f->key, f->lo, f->hi);
            return SL_BAD_INPUT;
        }
        *(int32_t *)(void *)target = (int32_t)json_integer_value(value);
        return SL_OK;
    case FIELD_REAL:
        return parse_real(value, f, (double *)(void *)target, diag);
    case FIELD_PLACE:
        if (!json_is_array(value) || json_array_size(value) != 2) {
            return bad_shape(f, "a list of two numbers", diag);
        }
        for (size_t k = 0; k < 2; k++) {
            const sl_status status = parse_real(json_array_get(value, k), f, (double *)(void *)target + k, diag);
            if (status != SL_OK) {
                return status;
            }
        }
        return SL_OK;
    case FIELD_BOOL:
        if (!json_is_boolean(value)) {
            return bad_shape(f, "true or false", diag);
        }
        *(bool *)(void *)target = json_is_true(value);
        return SL_OK;
    case FIELD_TEXT:
        return parse_text(value, f, target, diag);
    }
    return SL_INTERNAL;
}

/* Fields that exclude or demand one another. */
static sl_status check_together(const sl_action *a, sl_diag *diag)
{
    if (a->kind == SL_ACTION_OPEN && strcmp(a->name, "automatic") != 0 && strcmp(a->name, "uv") != 0) {
        sl_diag_reason(diag, "\"start\" must be \"automatic\" or \"uv\"");
        return SL_BAD_INPUT;
    }
    if ((a->kind == SL_ACTION_SEW || a->kind == SL_ACTION_UNSEW) && a->to >= 0 && a->number > 0.0) {
        sl_diag_reason(diag, "\"to\" and \"length\" exclude one another");
        return SL_BAD_INPUT;
    }
    if (a->kind == SL_ACTION_SYMMETRY && a->on != (a->count == 4)) {
        sl_diag_reason(diag, "symmetry needs two \"corners\" to be turned on, and none to be turned off");
        return SL_BAD_INPUT;
    }
    if (a->kind == SL_ACTION_STRAIGHTEN_BORDER && a->count != 4) {
        sl_diag_reason(diag, "a border to be straightened has two \"ends\"");
        return SL_BAD_INPUT;
    }
    if (a->kind == SL_ACTION_UNDO && a->name[0] != '\0' && a->steps != 1) {
        sl_diag_reason(diag, "\"steps\" and \"to\" exclude one another");
        return SL_BAD_INPUT;
    }
    return SL_OK;
}

static sl_status find_form(const json_t *object, sl_action_kind *kind, sl_diag *diag)
{
    const char *name = json_string_value(json_object_get(object, "do"));
    if (name == NULL) {
        sl_diag_reason(diag, "no \"do\" says what is to be done");
        return SL_BAD_INPUT;
    }
    for (int k = 0; k < SL_ACTION_KINDS; k++) {
        if (strcmp(sl_action_forms()[k].name, name) == 0) {
            *kind = (sl_action_kind)k;
            return SL_OK;
        }
    }
    sl_diag_reason(diag, "there is no action \"%.64s\"", name);
    return SL_BAD_INPUT;
}

static const sl_field *find_field(const sl_form *f, const char *key)
{
    for (int i = 0; i < SL_MAX_FIELDS && f->field[i].key != NULL; i++) {
        if (strcmp(f->field[i].key, key) == 0) {
            return &f->field[i];
        }
    }
    return NULL;
}

static sl_status parse_object(json_t *object, sl_action *a, sl_diag *diag)
{
    sl_status status = SL_OK;
    sl_action_kind kind = SL_ACTION_OPEN;
    const char *key;
    json_t *value;
    SL_TRY(find_form(object, &kind, diag));
    *a = sl_action_default(kind);
    const sl_form *f = &sl_action_forms()[kind];
    json_object_foreach(object, key, value)
    {
        const sl_field *at = find_field(f, key);
        if (at == NULL && strcmp(key, "do") != 0) {
            sl_diag_reason(diag, "%s has no \"%.64s\"", f->name, key);
            SL_TRY(SL_BAD_INPUT);
        }
        if (at != NULL) {
            SL_TRY(parse_field(value, at, a, diag));
        }
    }
    for (int i = 0; i < SL_MAX_FIELDS && f->field[i].key != NULL; i++) {
        if (!f->field[i].optional && json_object_get(object, f->field[i].key) == NULL) {
            sl_diag_reason(diag, "%s needs \"%s\"", f->name, f->field[i].key);
            SL_TRY(SL_BAD_INPUT);
        }
    }
    SL_TRY(check_together(a, diag));
cleanup:
    return status;
}

sl_status sl_action_parse(const char *text, int64_t size, sl_action *out, sl_diag *diag)
{
    json_error_t error;
    sl_action action = {0};
    sl_status status = SL_OK;
    *out = (sl_action){0};
    json_t *object = json_loadb(text, (size_t)size, JSON_REJECT_DUPLICATES, &error);
    if (object == NULL) {
        sl_diag_reason(diag, "not JSON: %.120s (column %d)", error.text, error.column);
        return SL_BAD_INPUT;
    }
    if (!json_is_object(object)) {
        sl_diag_reason(diag, "a line holds one {...}");
        SL_TRY(SL_BAD_INPUT);
    }
    SL_TRY(parse_object(object, &action, diag));
    *out = action;
    action.item = NULL;
cleanup:
    sl_free(action.item);
    json_decref(object);
    return status;
}
