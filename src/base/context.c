#include "base/context.h"

sl_status sl_report_progress(const sl_context *context, const char *stage, double fraction)
{
    if (context == NULL) {
        return SL_OK;
    }
    if (context->cancelled != NULL && context->cancelled(context->cancelled_user)) {
        return SL_CANCELLED;
    }
    const bool go_on = context->progress == NULL || context->progress(context->progress_user, stage, fraction);
    return go_on ? SL_OK : SL_CANCELLED;
}

sl_context sl_quiet_context(const sl_context *context)
{
    sl_context quiet = {0};
    if (context != NULL) {
        quiet = *context;
        quiet.progress = NULL;
        quiet.progress_user = NULL;
    }
    return quiet;
}

int32_t sl_chunk_count(int64_t count, int64_t chunk_size)
{
    SL_ASSERT(count >= 0 && chunk_size > 0);
    const int64_t chunks = count / chunk_size + (count % chunk_size != 0);
    SL_ASSERT(chunks <= INT32_MAX);
    return (int32_t)chunks;
}

typedef struct chunk_job {
    sl_chunk_fn *fn;
    void *user;
    int64_t count, chunk_size;
} chunk_job;

static void run_chunk(void *user, int32_t t)
{
    const chunk_job *job = user;
    const int64_t begin = (int64_t)t * job->chunk_size;
    const int64_t left = job->count - begin;
    job->fn(job->user, begin, begin + (left < job->chunk_size ? left : job->chunk_size), t);
}

void sl_parallel_for(const sl_context *context, int64_t count, int64_t chunk_size, sl_chunk_fn *fn, void *user)
{
    chunk_job job = {fn, user, count, chunk_size};
    const int32_t chunks = sl_chunk_count(count, chunk_size);
    const sl_executor *executor = context != NULL ? context->executor : NULL;
    if (executor == NULL || executor->workers <= 1 || chunks <= 1) {
        for (int32_t t = 0; t < chunks; t++) {
            run_chunk(&job, t);
        }
        return;
    }
    executor->run(executor->pool, chunks, run_chunk, &job);
}
