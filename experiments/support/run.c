#include "support/run.h"

#include <cblas.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

/* All processors, or as many threads as SEAMLAB_THREADS says (1 to 64). */
static int32_t thread_count(void)
{
    const char *text = getenv("SEAMLAB_THREADS");
    const long wanted = text != NULL ? strtol(text, NULL, 10) : 0;
    return wanted >= 1 && wanted <= 64 ? (int32_t)wanted : sl_processor_count();
}

/* NAME=FILE: a name of letters, digits, '.', '_', '-', and a file that can be opened. */
static bool take_added(exp_run *run, const char *program, const char *text)
{
    static const char allowed[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789._-";
    const char *equals = text != NULL ? strchr(text, '=') : NULL;
    const size_t length = equals != NULL ? (size_t)(equals - text) : 0;
    if (length == 0 || strspn(text, allowed) != length || equals[1] == '\0') {
        fprintf(stderr, "%s: --add wants NAME=FILE, NAME of letters, digits and ._-\n", program);
        return false;
    }
    if (run->added == EXP_MAX_ADDED || length >= sizeof run->add[0].name || strlen(equals + 1) >= EXP_PATH) {
        fprintf(stderr, "%s: --add %s: too many, or too long\n", program, text);
        return false;
    }
    FILE *file = fopen(equals + 1, "rb");
    if (file == NULL || fgetc(file) == EOF) { /* a folder opens, but cannot be read */
        fprintf(stderr, "%s: --add %s: the file cannot be read\n", program, text);
        if (file != NULL) {
            fclose(file);
        }
        return false;
    }
    fclose(file);
    exp_added *added = &run->add[run->added++];
    snprintf(added->name, sizeof added->name, "%.*s", (int)length, text);
    snprintf(added->path, sizeof added->path, "%s", equals + 1);
    return true;
}

bool exp_begin(exp_run *run, int argc, char **argv)
{
    *run = (exp_run){.diag = sl_diag_none()};
    for (int a = 1; a < argc; a++) {
        if (strcmp(argv[a], "--quick") == 0) {
            run->quick = true;
        } else if (strcmp(argv[a], "--add") == 0) {
            if (!take_added(run, argv[0], argv[++a])) { /* argv ends with NULL */
                return false;
            }
        } else if (run->out == NULL) {
            run->out = argv[a];
        } else if (run->corpus == NULL) {
            run->corpus = argv[a];
        } else {
            run->out = NULL;
            break;
        }
    }
    if (run->out == NULL || run->out[0] == '-') {
        fprintf(stderr, "usage: %s [--quick] OUTDIR [CORPUS_FOLDER] [--add NAME=FILE]...\n", argv[0]);
        return false;
    }
    openblas_set_num_threads(1);
    if (sl_thread_pool_create(thread_count(), &run->pool) != SL_OK) {
        fprintf(stderr, "%s: no threads\n", argv[0]);
        return false;
    }
    run->context = (sl_context){.executor = sl_thread_pool_executor(run->pool)};
    return true;
}

int exp_end(exp_run *run, sl_status status, int32_t violated)
{
    if (status != SL_OK) {
        char text[1024];
        sl_diag_format(&run->diag, text, sizeof text);
        fprintf(stderr, "%s: %s\n", sl_status_name(status), text);
    }
    sl_thread_pool_free(run->pool);
    run->pool = NULL;
    return status != SL_OK || violated > 0;
}

sl_status exp_path(const exp_run *run, const char *name, char path[EXP_PATH])
{
    const int length = snprintf(path, EXP_PATH, "%s/%s", run->out, name);
    return length > 0 && length < EXP_PATH ? SL_OK : SL_IO;
}

double exp_cpu_seconds(void)
{
    return (double)clock() / CLOCKS_PER_SEC;
}
