/* From an action to its line of JSON. */
#include "edit/action_internal.h"

#include <stdio.h>
#include <string.h>

#include "base/memory.h"
#include "base/text.h"

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

static void put_items(buffer *b, const sl_field *f, const sl_action *a)
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
static bool is_default(const sl_field *f, const sl_action *a)
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

static void put_field(buffer *b, const sl_field *f, const sl_action *a)
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
    const sl_form *f = &sl_action_forms()[action->kind];
    put(&b, "{\"do\":\"");
    put(&b, f->name);
    put(&b, "\"");
    for (int i = 0; i < SL_MAX_FIELDS && f->field[i].key != NULL; i++) {
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
