/* A figure of a generated model before and after its user edited it: the same session, log and table around what
 * differs. Layer: experiments. */
#ifndef SL_EXPERIMENTS_EDITED_H
#define SL_EXPERIMENTS_EDITED_H

#include "support/pictures.h"
#include "support/session.h"

struct sl_generated;

/* What the editing rules work on; all borrowed. */
typedef struct exp_editing {
    exp_run *run;
    exp_claims *claims;
    const struct sl_generated *generated;
    sl_session *session;
    sl_view view;
    sl_picture picture;
    exp_state before, after; /* after: once all is packed anew */
} exp_editing;

typedef sl_status exp_editing_fn(exp_editing *e);

/* A picture with its caption (HTML); all borrowed. */
typedef struct exp_plate {
    const char *file, *alt, *caption;
} exp_plate;

typedef struct exp_edited {
    const char *model; /* a generator's name, also the mesh of its claims */
    int32_t width, height;
    exp_editing_fn *edit;          /* what the user does, between opening and packing */
    exp_editing_fn *finish;        /* after packing: more pictures, measurements; nullable */
    exp_plate before, after, more; /* more: drawn by finish, file NULL = none */
    const char *row;               /* the edited state's name in the table */
} exp_edited;

/* Opens a session without sewing or symmetry, draws, edits, packs, draws, replays the log (exp_session_finish),
 * measures "red facets", and shows pictures and table. Statuses of the session, the pictures and the callbacks. */
SL_NODISCARD sl_status exp_edited_show(exp_run *run, exp_page *page, exp_claims *claims, const exp_edited *figure);

#endif
