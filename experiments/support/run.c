#include "support/run.h"

#include <cblas.h>
#include <stdio.h>
#include <string.h>
#include <time.h>

bool exp_begin(exp_run *run, int argc, char **argv)
{
    *run = (exp_run){.diag = sl_diag_none()};
    for (int a = 1; a < argc; a++) {
        if (strcmp(argv[a], "--quick") == 0) {
            run->quick = true;
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
        fprintf(stderr, "usage: %s [--quick] OUTDIR [CORPUS_FOLDER]\n", argv[0]);
        return false;
    }
    openblas_set_num_threads(1);
    if (sl_thread_pool_create(sl_processor_count(), &run->pool) != SL_OK) {
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
