#include "edit/action.h"

#include <jansson.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/memory.h"
#include "base/text.h"

/* What a field of a line holds, and in which field of the struct it goes. */
typedef enum field_kind {
    FIELD_NUMBERS, /* item: count numbers side by side: [v, w, f] */
    FIELD_LIST,    /* item: a list of numbers */
    FIELD_TUPLES,  /* item: a list of [..] of `width` numbers each */
    FIELD_INT,
    FIELD_REAL,
    FIELD_PLACE, /* two reals */
    FIELD_BOOL,
    FIELD_TEXT
} field_kind;

typedef struct field {
    const char *key;
    field_kind kind;
    int32_t width, least; /* of NUMBERS and TUPLES; least numbers or tuples of LIST and TUPLES */
    size_t at;            /* in sl_action */
    double lo, hi;        /* of INT and REAL */
    bool optional;
} field;

enum { MAX_FIELDS = 5, MAX_ITEMS = 1 << 26 };

typedef struct form {
    const char *name;
    field field[MAX_FIELDS];
} form;

#define AT(member) offsetof(sl_action, member)

#define INDEX_MAX 2147483647.0 /* in initialisers */
#define LENGTH_MAX 1e300

/* Field lists end with a key of NULL. */
static const form *forms(void)
{
    static const form table[SL_ACTION_KINDS] = {
        [SL_ACTION_OPEN] = {"open",
                            {{"start", FIELD_TEXT, 0, 0, AT(name), 0, 0, true},
                             {"symmetry", FIELD_BOOL, 0, 0, AT(on), 0, 0, true},
                             {"stretch", FIELD_REAL, 0, 0, AT(number), 1.0, 1e9, true},
                             {"resolution", FIELD_INT, 0, 0, AT(resolution), 16, 65536, true},
                             {"margin", FIELD_REAL, 0, 0, AT(margin), 0, 1024, true}}},
        [SL_ACTION_DELETE_SEAM] = {"delete-seam", {{"at", FIELD_NUMBERS, 3, 0, 0, 0, 0, false}}},
        [SL_ACTION_CUT_PATH] = {"cut-path", {{"vertices", FIELD_LIST, 1, 2, 0, 0, 0, false}}},
        [SL_ACTION_CUT_LOOP] = {"cut-loop", {{"at", FIELD_NUMBERS, 3, 0, 0, 0, 0, false}}},
        [SL_ACTION_CUT_EDGES] = {"cut-edges", {{"edges", FIELD_TUPLES, 2, 1, 0, 0, 0, false}}},
        [SL_ACTION_SEW] = {"sew",
                           {{"at", FIELD_NUMBERS, 3, 0, 0, 0, 0, false},
                            {"to", FIELD_INT, 0, 0, AT(to), 0, INDEX_MAX, true},
                            {"length", FIELD_REAL, 0, 0, AT(number), 0, LENGTH_MAX, true}}},
        [SL_ACTION_UNSEW] = {"unsew",
                             {{"at", FIELD_NUMBERS, 3, 0, 0, 0, 0, false},
                              {"to", FIELD_INT, 0, 0, AT(to), 0, INDEX_MAX, true},
                              {"length", FIELD_REAL, 0, 0, AT(number), 0, LENGTH_MAX, true}}},
        [SL_ACTION_CUT_CHART] = {"cut-chart", {{"facet", FIELD_INT, 0, 0, AT(facet), 0, INDEX_MAX, false}}},
        [SL_ACTION_MERGE] = {"merge", {{"facets", FIELD_NUMBERS, 2, 0, 0, 0, 0, false}}},
        [SL_ACTION_ANGLE] = {"angle",
                             {{"corner", FIELD_NUMBERS, 2, 0, 0, 0, 0, false},
                              {"degrees", FIELD_REAL, 0, 0, AT(number), 0, 36000, false}}},
        [SL_ACTION_STRAIGHTEN] = {"straighten", {{"path", FIELD_TUPLES, 2, 2, 0, 0, 0, false}}},
        [SL_ACTION_STRAIGHTEN_BORDER] = {"straighten-border", {{"ends", FIELD_TUPLES, 2, 2, 0, 0, 0, false}}},
        [SL_ACTION_RECTANGLE] = {"rectangle", {{"corners", FIELD_TUPLES, 2, 3, 0, 0, 0, false}}},
        [SL_ACTION_RIGHT] = {"right", {{"corner", FIELD_NUMBERS, 2, 0, 0, 0, 0, false}}},
        [SL_ACTION_DROP] = {"drop", {{"constraint", FIELD_INT, 0, 0, AT(id), 1, INDEX_MAX, false}}},
        [SL_ACTION_PIN] = {"pin",
                           {{"corner", FIELD_NUMBERS, 2, 0, 0, 0, 0, false},
                            {"uv", FIELD_PLACE, 0, 0, AT(uv), -1e4, 1e4, false}}},
        [SL_ACTION_MOVE] = {"move",
                            {{"facet", FIELD_INT, 0, 0, AT(facet), 0, INDEX_MAX, false},
                             {"by", FIELD_PLACE, 0, 0, AT(uv), -1e4, 1e4, false}}},
        [SL_ACTION_ROTATE] = {"rotate",
                              {{"facet", FIELD_INT, 0, 0, AT(facet), 0, INDEX_MAX, false},
                               {"degrees", FIELD_REAL, 0, 0, AT(number), -36000, 36000, false}}},
        [SL_ACTION_SCALE] = {"scale",
                             {{"facet", FIELD_INT, 0, 0, AT(facet), 0, INDEX_MAX, false},
                              {"factor", FIELD_REAL, 0, 0, AT(number), 1e-3, 1e3, false}}},
        [SL_ACTION_SYMMETRY] = {"symmetry",
                                {{"facet", FIELD_INT, 0, 0, AT(facet), 0, INDEX_MAX, false},
                                 {"on", FIELD_BOOL, 0, 0, AT(on), 0, 0, false},
                                 {"corners", FIELD_TUPLES, 2, 2, 0, 0, 0, true},
                                 {"mirrored", FIELD_BOOL, 0, 0, AT(mirrored), 0, 0, true}}},
        [SL_ACTION_PACK] = {"pack",
                            {{"resolution", FIELD_INT, 0, 0, AT(resolution), 16, 65536, true},
                             {"margin", FIELD_REAL, 0, 0, AT(margin), 0, 1024, true}}},
        [SL_ACTION_UNDO] = {"undo",
                            {{"steps", FIELD_INT, 0, 0, AT(steps), 1, INDEX_MAX, true},
                             {"to", FIELD_TEXT, 0, 0, AT(name), 0, 0, true}}},
        [SL_ACTION_REDO] = {"redo", {{"steps", FIELD_INT, 0, 0, AT(steps), 1, INDEX_MAX, true}}},
        [SL_ACTION_CHECKPOINT] = {"checkpoint", {{"name", FIELD_TEXT, 0, 0, AT(name), 0, 0, false}}},
    };
    return table;
}

sl_action sl_action_default(sl_action_kind kind)
{
    sl_action a = {.kind = kind, .facet = -1, .to = -1, .steps = 1, .resolution = 2048, .margin = 4.0};
    a.on = a.mirrored = true;
    if (kind == SL_ACTION_OPEN) {
        a.number = 1.5;
        snprintf(a.name, sizeof a.name, "automatic");
    }
    return a;
}

const char *sl_action_name(sl_action_kind kind)
{
    return (unsigned)kind < SL_ACTION_KINDS ? forms()[kind].name : "unknown";
}

sl_status sl_action_set_items(sl_action *action, int32_t count, const int32_t *item)
{
    int32_t *copy = sl_copy(item, count, sizeof *item);
    if (copy == NULL) {
        return SL_OUT_OF_MEMORY;
    }
    sl_free(action->item);
    action->item = copy;
    action->count = count;
    return SL_OK;
}

sl_status sl_action_copy(const sl_action *from, sl_action *out)
{
    *out = *from;
    out->item = NULL;
    out->count = 0;
    return from->item != NULL ? sl_action_set_items(out, from->count, from->item) : SL_OK;
}

void sl_action_clear(sl_action *action)
{
    sl_free(action->item);
    *action = (sl_action){0};
}

/* One element number into the list. */
static sl_status push_number(const json_t *j, const char *key, sl_action *a, int64_t *room, sl_diag *diag)
{
    if (!json_is_integer(j) || json_integer_value(j) < 0 || (double)json_integer_value(j) > INDEX_MAX) {
        sl_diag_reason(diag, "\"%s\" holds something that is not the number of an element", key);
        return SL_BAD_INPUT;
    }
    if (a->count >= MAX_ITEMS) {
        sl_diag_reason(diag, "\"%s\" is too long", key);
        return SL_BAD_INPUT;
    }
    const sl_status status = sl_reserve((void **)&a->item, room, (int64_t)a->count + 1, sizeof *a->item);
    if (status == SL_OK) {
        a->item[a->count++] = (int32_t)json_integer_value(j);
    }
    return status;
}

static sl_status bad_shape(const field *f, const char *what, sl_diag *diag)
{
    sl_diag_reason(diag, "\"%s\" must be %s", f->key, what);
    return SL_BAD_INPUT;
}

static sl_status parse_items(const json_t *value, const field *f, sl_action *a, sl_diag *diag)
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

static sl_status parse_real(const json_t *value, const field *f, double *out, sl_diag *diag)
{
    const double x = json_is_number(value) ? json_number_value(value) : NAN;
    if (!(x >= f->lo && x <= f->hi)) {
        sl_diag_reason(diag, "\"%s\" must be a number from %g to %g", f->key, f->lo, f->hi);
        return SL_BAD_INPUT;
    }
    *out = x;
    return SL_OK;
}

static sl_status parse_text(const json_t *value, const field *f, char *out, sl_diag *diag)
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

static sl_status parse_field(const json_t *value, const field *f, sl_action *a, sl_diag *diag)
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
        if (strcmp(forms()[k].name, name) == 0) {
            *kind = (sl_action_kind)k;
            return SL_OK;
        }
    }
    sl_diag_reason(diag, "there is no action \"%.64s\"", name);
    return SL_BAD_INPUT;
}

static const field *find_field(const form *f, const char *key)
{
    for (int i = 0; i < MAX_FIELDS && f->field[i].key != NULL; i++) {
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
    const form *f = &forms()[kind];
    json_object_foreach(object, key, value)
    {
        const field *at = find_field(f, key);
        if (at == NULL && strcmp(key, "do") != 0) {
            sl_diag_reason(diag, "%s has no \"%.64s\"", f->name, key);
            SL_TRY(SL_BAD_INPUT);
        }
        if (at != NULL) {
            SL_TRY(parse_field(value, at, a, diag));
        }
    }
    for (int i = 0; i < MAX_FIELDS && f->field[i].key != NULL; i++) {
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

/* Text that grows; what did not fit is remembered. */
typedef struct buffer {
    char *text;
    int64_t size, room;
    bool failed;
} buffer;

static void put(buffer *b, const char *text)
{
    const int64_t n = (int64_t)strlen(text);
    if (b->failed || sl_reserve((void **)&b->text, &b->room, b->size + n + 1, 1) != SL_OK) {
        b->failed = true;
        return;
    }
    memcpy(b->text + b->size, text, (size_t)n + 1);
    b->size += n;
}

static void put_int(buffer *b, int32_t value)
{
    char text[16];
    snprintf(text, sizeof text, "%d", value);
    put(b, text);
}

static void put_real(buffer *b, double value)
{
    char text[SL_DOUBLE_TEXT];
    sl_format_double(value, text);
    put(b, text);
}

static void put_items(buffer *b, const field *f, const sl_action *a)
{
    put(b, "[");
    for (int32_t i = 0; i < a->count; i++) {
        const bool opens = f->kind == FIELD_TUPLES && i % f->width == 0;
        const bool closes = f->kind == FIELD_TUPLES && i % f->width == f->width - 1;
        put(b, i > 0 ? "," : "");
        put(b, opens ? "[" : "");
        put_int(b, a->item[i]);
        put(b, closes ? "]" : "");
    }
    put(b, "]");
}

/* Does a field stand at its default, so that the line need not say it? */
static bool is_default(const field *f, const sl_action *a)
{
    const sl_action d = sl_action_default(a->kind);
    const char *x = (const char *)a + f->at, *y = (const char *)&d + f->at;
    switch (f->kind) {
    case FIELD_NUMBERS:
    case FIELD_LIST:
    case FIELD_TUPLES:
        return a->count == 0;
    case FIELD_INT:
        return memcmp(x, y, sizeof(int32_t)) == 0;
    case FIELD_REAL:
        return memcmp(x, y, sizeof(double)) == 0;
    case FIELD_PLACE:
        return memcmp(x, y, 2 * sizeof(double)) == 0;
    case FIELD_BOOL:
        return *(const bool *)(const void *)x == *(const bool *)(const void *)y;
    case FIELD_TEXT:
        return strcmp(x, y) == 0;
    }
    return false;
}

static void put_field(buffer *b, const field *f, const sl_action *a)
{
    const char *source = (const char *)a + f->at;
    put(b, ",\"");
    put(b, f->key);
    put(b, "\":");
    switch (f->kind) {
    case FIELD_NUMBERS:
    case FIELD_LIST:
    case FIELD_TUPLES:
        put_items(b, f, a);
        break;
    case FIELD_INT:
        put_int(b, *(const int32_t *)(const void *)source);
        break;
    case FIELD_REAL:
        put_real(b, *(const double *)(const void *)source);
        break;
    case FIELD_PLACE:
        put(b, "[");
        put_real(b, ((const double *)(const void *)source)[0]);
        put(b, ",");
        put_real(b, ((const double *)(const void *)source)[1]);
        put(b, "]");
        break;
    case FIELD_BOOL:
        put(b, *(const bool *)(const void *)source ? "true" : "false");
        break;
    case FIELD_TEXT:
        put(b, "\"");
        put(b, source);
        put(b, "\"");
        break;
    }
}

char *sl_action_format(const sl_action *action)
{
    buffer b = {0};
    const form *f = &forms()[action->kind];
    put(&b, "{\"do\":\"");
    put(&b, f->name);
    put(&b, "\"");
    for (int i = 0; i < MAX_FIELDS && f->field[i].key != NULL; i++) {
        if (!f->field[i].optional || !is_default(&f->field[i], action)) {
            put_field(&b, &f->field[i], action);
        }
    }
    put(&b, "}");
    if (b.failed) {
        sl_free(b.text);
        return NULL;
    }
    return b.text;
}
