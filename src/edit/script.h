/* A session's script: a file of actions, one a line, that a session writes as its log and that replays it.
 * Layer: edit. */
#ifndef SL_EDIT_SCRIPT_H
#define SL_EDIT_SCRIPT_H

#include "edit/session.h"

#define SL_SCRIPT_VERSION 1

/* The first line of a script: {"seamlab":"session","version":1,"mesh":"cow.obj","vertices":2904,"facets":5804}; all
 * but the first two fields may be missing. Then actions, the first of which may be `open` (otherwise it is as if its
 * defaults stood there). Empty lines and lines that begin with # count as lines and say nothing. */
typedef struct sl_script {
    char mesh[256];           /* "" = not said */
    int32_t vertices, facets; /* -1 = not said */
    int32_t count;
    sl_action *action; /* owned; action[0] is the open */
    int64_t *line;     /* 1-based line of each; 0 = none */
    bool cut_off;      /* the last line had no end and was left out */
} sl_script;

/* tolerant: a last line without an end (a log that was cut off) is left out and cut_off says so; otherwise it counts
 * as a line. SL_BAD_INPUT with the line, what is wrong and (element) -1; SL_OUT_OF_MEMORY. Nothing is kept then. name
 * stands for the file in diag. */
SL_NODISCARD sl_status sl_script_parse(const char *name, const char *text, int64_t size, bool tolerant, sl_script *out,
                                       sl_diag *diag);
SL_NODISCARD sl_status sl_script_read(const char *path, bool tolerant, sl_script *out, sl_diag *diag);
void sl_script_clear(sl_script *script);

/* Called after each action, with the session as it is then; false stops there (SL_CANCELLED). */
typedef bool sl_script_step_fn(void *user, const sl_session *session, const sl_script *script, int32_t index);

/* Opens a session on the mesh and applies the first `count` actions (-1 = all). Does the script belong to the mesh?
 * SL_BAD_INPUT if not. What fails has the line in diag. step: nullable. *out is NULL on failure. Statuses as of
 * sl_session_create and sl_session_apply. */
SL_NODISCARD sl_status sl_script_run(const sl_script *script, int32_t count, const sl_polygons *polygons,
                                     const double *corner_uv, const sl_atlas_def *def, sl_script_step_fn *step,
                                     void *user, const sl_context *context, sl_session **out, sl_diag *diag);

#endif
