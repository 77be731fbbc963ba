/* What the lines of all actions hold, field by field.
 * Layer: edit (private). */
#ifndef SL_EDIT_ACTION_INTERNAL_H
#define SL_EDIT_ACTION_INTERNAL_H

#include "edit/action.h"

/* What a field of a line holds, and in which field of the struct it goes. */
typedef enum sl_field_kind {
    FIELD_NUMBERS, /* item: count numbers side by side: [v, w, f] */
    FIELD_LIST,    /* item: a list of numbers */
    FIELD_TUPLES,  /* item: a list of [..] of `width` numbers each */
    FIELD_INT,
    FIELD_REAL,
    FIELD_PLACE, /* two reals */
    FIELD_BOOL,
    FIELD_TEXT
} sl_field_kind;

typedef struct sl_field {
    const char *key;
    sl_field_kind kind;
    int32_t width, least; /* of NUMBERS and TUPLES; least numbers or tuples of LIST and TUPLES */
    size_t at;            /* in sl_action */
    double lo, hi;        /* of INT and REAL */
    bool optional;
} sl_field;

enum { SL_MAX_FIELDS = 5, SL_MAX_ITEMS = 1 << 26 };

typedef struct sl_form {
    const char *name;
    sl_field field[SL_MAX_FIELDS];
} sl_form;

/* A form a kind; lists of fields end with a key of NULL. */
const sl_form *sl_action_forms(void);

#endif
