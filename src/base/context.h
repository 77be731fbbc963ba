/* What long computations borrow from their caller: workers, and a way to report progress and be cancelled.
 * Layer: base. */
#ifndef SL_BASE_CONTEXT_H
#define SL_BASE_CONTEXT_H

#include "base/status.h"

/* Work on the indices [begin, end) of chunk `chunk`. Called from any thread; the chunks do not depend on how many. */
typedef void sl_chunk_fn(void *user, int64_t begin, int64_t end, int32_t chunk);

/* A borrowed pool of workers. run() calls task(task_user, t) once for each t in [0, count) and returns when all are
 * done. Nested run() calls from inside a task run serially. */
typedef struct sl_executor {
    void (*run)(void *pool, int32_t count, void (*task)(void *task_user, int32_t t), void *task_user);
    void *pool;
    int32_t workers;
} sl_executor;

/* Returns false to cancel. stage is a short fixed text; fraction in [0, 1]. Only called from the calling thread. */
typedef bool sl_progress_fn(void *user, const char *stage, double fraction);

/* Returns true once the computation shall end. Called from any thread, often: it should only look at a flag. */
typedef bool sl_cancelled_fn(void *user);

/* Nullable wherever it is taken: NULL = serial, no progress. */
typedef struct sl_context {
    const sl_executor *executor; /* NULL = serial */
    sl_progress_fn *progress;    /* NULL = never reported */
    void *progress_user;
    sl_cancelled_fn *cancelled; /* NULL = by progress alone: then what runs side by side is waited for */
    void *cancelled_user;
} sl_context;

/* SL_CANCELLED when one of the caller's functions says so, else SL_OK. context may be NULL. */
SL_NODISCARD sl_status sl_report_progress(const sl_context *context, const char *stage, double fraction);

/* The context for work that runs on other threads: the same but for progress. context may be NULL. */
sl_context sl_quiet_context(const sl_context *context);

/* Splits [0, count) into chunks of chunk_size (the last may be shorter) and calls fn for each, in any order and on any
 * worker. Chunk borders depend on count and chunk_size alone, so a reduction per chunk, summed in chunk order, gives
 * the same bytes for any number of workers. */
void sl_parallel_for(const sl_context *context, int64_t count, int64_t chunk_size, sl_chunk_fn *fn, void *user);

/* How many chunks sl_parallel_for makes. */
int32_t sl_chunk_count(int64_t count, int64_t chunk_size);

/* A pool of POSIX threads. workers >= 1; with 1 no thread is started and everything runs serially. */
typedef struct sl_thread_pool sl_thread_pool;

SL_NODISCARD sl_status sl_thread_pool_create(int32_t workers, sl_thread_pool **out);

/* The executor of a pool; borrowed, valid until the pool is freed. One caller at a time. */
const sl_executor *sl_thread_pool_executor(const sl_thread_pool *pool);

void sl_thread_pool_free(sl_thread_pool *pool); /* NULL is a no-op */

/* Online processors, at least 1. */
int32_t sl_processor_count(void);

#endif
