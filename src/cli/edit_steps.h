/* What `edit` and `replay` share: a script run on a mesh, step by step.
 * Layer: cli. */
#ifndef SL_CLI_EDIT_STEPS_H
#define SL_CLI_EDIT_STEPS_H

#include "cli/cli.h"
#include "edit/script.h"

typedef struct cli_steps {
    cli_run *run;
    const char *pictures; /* folder for a picture after each action; NULL = none */
    bool table;           /* a line a step on stdout */
    int32_t count;        /* actions to apply, -1 = all */
    /* results */
    int code; /* of drawing, CLI_DONE where all is well */
} cli_steps;

/* Reads mesh and script and applies the actions. Everything that goes wrong is said on stderr. Returns the exit code;
 * *file and *session are NULL unless it is 0. */
int cli_steps_run(cli_steps *steps, const char *mesh, const char *script, bool tolerant, sl_meshfile **file,
                  sl_session **session);

/* Writes the atlas and says what it is. */
int cli_steps_save(cli_run *run, const sl_session *session, const sl_meshfile *file, const char *output,
                   bool allow_overlap);

#endif
