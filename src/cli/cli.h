/* What every verb shares: exit codes, threads, progress and interruption, error messages.
 * Layer: cli. */
#ifndef SL_CLI_CLI_H
#define SL_CLI_CLI_H

#include "atlas/measure.h"
#include "base/context.h"
#include "cli/options.h"
#include "meshio/meshfile.h"

/* The program's exit codes (README). */
enum {
    CLI_DONE = 0,
    CLI_INTERNAL = 1, /* a bug of ours, or the system refused to write */
    CLI_USAGE = 2,    /* wrong options, or an output format that cannot hold UVs */
    CLI_BAD_INPUT = 3,
    CLI_INFEASIBLE = 4,   /* infeasible, did not converge, or a warning under --strict */
    CLI_CHECK_FAILED = 5, /* the result failed its own check and was not written */
    CLI_LIMIT = 6,        /* memory or a limit given */
    CLI_INTERRUPTED = 130
};

typedef struct cli_run {
    int32_t threads; /* --threads: 0 = one per processor */
    bool quiet, json, strict;
    const char *verb;
    sl_thread_pool *pool;
    sl_context context;
    bool bar;          /* a progress bar is shown */
    int32_t bar_shown; /* its last state, to draw only what changes; -1 = none */
} cli_run;

/* The options every verb has; targets lie in *run. */
#define CLI_COMMON_OPTIONS 3
void cli_common_options(cli_run *run, cli_option *options);

/* Starts the workers, catches Ctrl-C, decides on a progress bar. Returns -1 to go on, otherwise the exit code. */
int cli_begin(cli_run *run);

/* Stops the workers, removes the bar, passes the exit code on. */
int cli_end(cli_run *run, int code);

/* Explains a failed status on stderr and gives its exit code; SL_OK gives 0. */
int cli_fail(cli_run *run, sl_status status, const sl_diag *diag);

/* -1, or the exit code where a mesh with UVs cannot be written to output, which is said on stderr: a format that cannot
 * hold them, or no name (NULL) where one is needed. */
int cli_check_output(const char *verb, const char *output, bool needed);

/* A line on stderr unless --quiet. */
void cli_note(cli_run *run, const char *format, ...) SL_PRINTF(2, 3);

/* Reads a mesh; what goes wrong is said on stderr. 0, or the exit code: every trouble with reading is bad input. */
int cli_read_mesh(cli_run *run, const char *path, sl_meshfile **out);

/* What the sidecar beside the file says of shared charts, for the verbs that read atlases: table, to be cleared, or
 * NULL without one or where it is of another mesh (which is said on stderr). */
const sl_sharing_table *cli_read_sharing(cli_run *run, const char *path, int32_t nf, sl_sharing_table *table);

/* Joins folder and name into path; SL_IO-like failure (too long) gives false. */
bool cli_join_path(const char *folder, const char *name, char *path, size_t size);

/* Makes a folder unless it stands already. false: it cannot be made (said on stderr). */
bool cli_make_folder(cli_run *run, const char *folder);

/* The verbs, one file each: argv[2 ..] are theirs. */
int cli_abf(int argc, char **argv);
int cli_check(int argc, char **argv);
int cli_compare(int argc, char **argv);
int cli_demo(int argc, char **argv);
int cli_edit(int argc, char **argv);
int cli_measure(int argc, char **argv);
int cli_overlap(int argc, char **argv);
int cli_pack(int argc, char **argv);
int cli_render(int argc, char **argv);
int cli_front(int argc, char **argv);
int cli_view(int argc, char **argv);
int cli_replay(int argc, char **argv);
int cli_segment(int argc, char **argv);
int cli_spectrum(int argc, char **argv);
int cli_theorem(int argc, char **argv);
int cli_unwrap(int argc, char **argv);

/* Does a file name end in this, whatever its case? */
bool cli_has_extension(const char *path, const char *extension);

#endif
