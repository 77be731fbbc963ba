#define _POSIX_C_SOURCE 200809L
#include "cli/cli.h"

#include "atlas/sidecar.h"

#include <cblas.h>
#include <errno.h>
#include <signal.h>
#include <stdarg.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <sys/stat.h>
#include <unistd.h>

#ifdef __GLIBC__
#include <malloc.h>
enum { KEPT_BYTES = 64 << 20 };
#endif

/* The one mutable global of the program: a signal handler can reach nothing else. */
static atomic_bool interrupted;

static void on_interrupt(int number)
{
    if (interrupted) { /* the second Ctrl-C does not wait for the computation to notice the first */
        signal(number, SIG_DFL);
        raise(number);
    }
    interrupted = true;
}

static bool on_progress(void *user, const char *stage, double fraction)
{
    cli_run *run = user;
    const int32_t shown = (int32_t)(fraction * 100.0);
    if (run->bar && shown != run->bar_shown) {
        char cells[31];
        for (int k = 0; k < 30; k++) {
            cells[k] = k < shown * 30 / 100 ? '#' : '.';
        }
        cells[30] = '\0';
        fprintf(stderr, "\r%-12.12s [%s] %3d %%", stage, cells, (int)shown);
        run->bar_shown = shown;
    }
    return !interrupted;
}

static bool is_interrupted(void *user)
{
    (void)user;
    return interrupted;
}

void cli_common_options(cli_run *run, cli_option *options)
{
    options[0] =
        (cli_option){"threads",     0,   CLI_INT,
                     &run->threads, 0,   1024,
                     NULL,          "N", "worker threads, 0 = one per processor (default); the result is the same"};
    options[1] = (cli_option){"quiet", 'q', CLI_FLAG, &run->quiet, 0, 0, NULL, NULL, "only errors on stderr"};
    options[2] = (cli_option){"json", 0, CLI_FLAG, &run->json, 0, 0, NULL, NULL, "machine-readable output on stdout"};
}

static void clear_bar(cli_run *run)
{
    if (run->bar_shown >= 0) {
        fprintf(stderr, "\r%*s\r", 60, "");
        run->bar_shown = -1;
    }
}

int cli_begin(cli_run *run)
{
    const char *term = getenv("TERM"), *no_color = getenv("NO_COLOR");
    struct sigaction action = {.sa_handler = on_interrupt};
    sigemptyset(&action.sa_mask);
    sigaction(SIGINT, &action, NULL);
    sigaction(SIGTERM, &action, NULL);
#ifdef __GLIBC__ /* solves come and go by the thousand: their memory is not given back in between */
    mallopt(M_TRIM_THRESHOLD, KEPT_BYTES);
    mallopt(M_MMAP_THRESHOLD, KEPT_BYTES / 2);
#endif
    openblas_set_num_threads(1); /* our own workers do the sharing: same bytes for any number of them */
    run->bar = !run->quiet && isatty(STDERR_FILENO) && term != NULL && strcmp(term, "dumb") != 0 &&
               (no_color == NULL || no_color[0] == '\0');
    run->bar_shown = -1;
    const int32_t threads = run->threads > 0 ? run->threads : sl_processor_count();
    const sl_status status = sl_thread_pool_create(threads, &run->pool);
    if (status != SL_OK) {
        return cli_fail(run, status, NULL);
    }
    run->context = (sl_context){.executor = sl_thread_pool_executor(run->pool),
                                .progress = on_progress,
                                .progress_user = run,
                                .cancelled = is_interrupted};
    return -1;
}

int cli_end(cli_run *run, int code)
{
    clear_bar(run);
    sl_thread_pool_free(run->pool);
    run->pool = NULL;
    if (fflush(stdout) != 0 || ferror(stdout)) {
        fprintf(stderr, "seamlab %s: writing to standard output failed: %s\n", run->verb, strerror(errno));
        return code == CLI_DONE ? CLI_INTERNAL : code;
    }
    return code;
}

static int exit_code(sl_status status)
{
    switch (status) {
    case SL_OK:
        return CLI_DONE;
    case SL_BAD_INPUT:
        return CLI_BAD_INPUT;
    case SL_UNSUPPORTED:
        return CLI_USAGE;
    case SL_INFEASIBLE:
    case SL_NOT_POSITIVE_DEFINITE:
    case SL_SINGULAR:
        return CLI_INFEASIBLE;
    case SL_OUT_OF_MEMORY:
    case SL_LIMIT:
        return CLI_LIMIT;
    case SL_CHECK_FAILED:
        return CLI_CHECK_FAILED;
    case SL_CANCELLED:
        return CLI_INTERRUPTED;
    case SL_IO:
    case SL_INTERNAL:
        return CLI_INTERNAL;
    }
    return CLI_INTERNAL;
}

int cli_fail(cli_run *run, sl_status status, const sl_diag *diag)
{
    char text[1024] = "";
    if (status == SL_OK) {
        return CLI_DONE;
    }
    clear_bar(run);
    if (diag != NULL && diag->reason[0] != '\0') {
        sl_diag_format(diag, text, sizeof text);
    }
    /* Other limits give reasons of their own. */
    const char *name = status == SL_LIMIT
                           ? "more memory would be needed than --memory-limit allows; raise it, or ask for "
                             "fewer --vectors"
                           : sl_status_name(status);
    fprintf(stderr, "seamlab %s: %s\n", run->verb, text[0] != '\0' ? text : name);
    return exit_code(status);
}

int cli_check_output(const char *verb, const char *output, bool needed)
{
    if (output == NULL) {
        return needed ? cli_usage(verb, "-o OUT is missing") : -1;
    }
    return sl_meshfile_can_hold_uv(output) ? -1
                                           : cli_usage(verb, "the output's format cannot hold UVs; use .obj or .ply");
}

void cli_note(cli_run *run, const char *format, ...)
{
    if (run->quiet) {
        return;
    }
    clear_bar(run);
    va_list args;
    va_start(args, format);
    vfprintf(stderr, format, args);
    va_end(args);
    fputc('\n', stderr);
}

int cli_read_mesh(cli_run *run, const char *path, sl_meshfile **out)
{
    sl_diag diag = sl_diag_none();
    const sl_status status = sl_meshfile_read(path, out, &diag);
    const int code = cli_fail(run, status, &diag);
    return status == SL_IO || status == SL_UNSUPPORTED ? CLI_BAD_INPUT : code;
}

const sl_sharing_table *cli_read_sharing(cli_run *run, const char *path, int32_t nf, sl_sharing_table *table)
{
    char sidecar[4096];
    sl_diag diag = sl_diag_none();
    sl_sidecar_path(path, sidecar, sizeof sidecar);
    const sl_status status = sl_sidecar_read(sidecar, nf, table, &diag);
    if (status != SL_OK && status != SL_IO) {
        cli_note(run, "note: the sidecar is not used: %s", diag.reason);
    }
    return status == SL_OK ? table : NULL;
}

bool cli_join_path(const char *folder, const char *name, char *path, size_t size)
{
    const size_t n = strlen(folder);
    const int length = snprintf(path, size, "%s%s%s", folder, n > 0 && folder[n - 1] == '/' ? "" : "/", name);
    return length > 0 && (size_t)length < size;
}

bool cli_make_folder(cli_run *run, const char *folder)
{
    if (mkdir(folder, 0777) == 0 || errno == EEXIST) {
        return true;
    }
    fprintf(stderr, "seamlab %s: cannot make the folder %s: %s\n", run->verb, folder, strerror(errno));
    return false;
}

bool cli_has_extension(const char *path, const char *extension)
{
    const size_t n = strlen(path), m = strlen(extension);
    return n >= m && strcasecmp(path + n - m, extension) == 0;
}
