#include "base/context.h"
#include "support/test_support.h"

#include <math.h>
#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>

static const int32_t worker_counts[] = {1, 2, 5, 16};

enum { ITEMS = 30011, CHUNK = 257, CHUNKS = (ITEMS + CHUNK - 1) / CHUNK };

typedef struct record {
    atomic_int visits[ITEMS];
    int64_t begin[CHUNKS], end[CHUNKS];
    double partial[CHUNKS];
    const sl_context *context; /* for nested runs */
} record;

static record shared;

static void visit(void *user, int64_t begin, int64_t end, int32_t chunk)
{
    record *r = user;
    r->begin[chunk] = begin;
    r->end[chunk] = end;
    r->partial[chunk] = 0.0;
    for (int64_t k = begin; k < end; k++) {
        atomic_fetch_add(&r->visits[k], 1);
        r->partial[chunk] += sin((double)k) / (1.0 + (double)k);
    }
}

static double run_and_sum(const sl_context *context)
{
    memset(&shared, 0, sizeof shared);
    sl_parallel_for(context, ITEMS, CHUNK, visit, &shared);
    double sum = 0.0;
    for (int32_t c = 0; c < CHUNKS; c++) {
        assert_int_equal(shared.begin[c], (int64_t)c * CHUNK);
        assert_int_equal(shared.end[c], c + 1 < CHUNKS ? ((int64_t)c + 1) * CHUNK : ITEMS);
        sum += shared.partial[c];
    }
    for (int32_t k = 0; k < ITEMS; k++) {
        assert_int_equal(atomic_load(&shared.visits[k]), 1);
    }
    return sum;
}

static void every_index_is_visited_once_and_sums_have_the_same_bytes(void **state)
{
    (void)state;
    const double serial = run_and_sum(NULL);
    const sl_context no_executor = {0};
    const double none = run_and_sum(&no_executor);
    assert_memory_equal(&serial, &none, sizeof serial);
    for (size_t w = 0; w < SL_COUNTOF(worker_counts); w++) {
        sl_thread_pool *pool;
        assert_int_equal(sl_thread_pool_create(worker_counts[w], &pool), SL_OK);
        const sl_context context = {.executor = sl_thread_pool_executor(pool)};
        assert_int_equal(context.executor->workers, worker_counts[w]);
        for (int repeat = 0; repeat < 20; repeat++) {
            const double sum = run_and_sum(&context);
            assert_memory_equal(&serial, &sum, sizeof serial);
        }
        sl_thread_pool_free(pool);
    }
}

static void add_range(void *user, int64_t begin, int64_t end, int32_t chunk)
{
    (void)chunk;
    atomic_fetch_add((atomic_llong *)user, (end - begin) * (end + begin - 1) / 2);
}

typedef struct outer_job {
    const sl_context *context;
    atomic_llong sum;
} outer_job;

static void run_inner(void *user, int64_t begin, int64_t end, int32_t chunk)
{
    (void)chunk;
    outer_job *job = user;
    for (int64_t k = begin; k < end; k++) {
        sl_parallel_for(job->context, 100 + k, 7, add_range, &job->sum);
    }
}

static void runs_inside_a_task_finish_and_lose_nothing(void **state)
{
    (void)state;
    long long expected = 0;
    for (int64_t k = 0; k < 90; k++) {
        expected += (100 + k) * (99 + k) / 2;
    }
    for (size_t w = 0; w < SL_COUNTOF(worker_counts); w++) {
        sl_thread_pool *pool;
        assert_int_equal(sl_thread_pool_create(worker_counts[w], &pool), SL_OK);
        const sl_context context = {.executor = sl_thread_pool_executor(pool)};
        for (int repeat = 0; repeat < 10; repeat++) {
            outer_job job = {.context = &context};
            sl_parallel_for(&context, 90, 4, run_inner, &job);
            assert_true(atomic_load(&job.sum) == expected);
        }
        sl_thread_pool_free(pool);
    }
}

static void many_short_runs_and_empty_ones_end(void **state)
{
    (void)state;
    sl_thread_pool *pool;
    assert_int_equal(sl_thread_pool_create(5, &pool), SL_OK);
    const sl_context context = {.executor = sl_thread_pool_executor(pool)};
    atomic_llong sum = 0;
    for (int64_t n = 0; n < 1500; n++) {
        sl_parallel_for(&context, n % 13, 2, add_range, &sum);
    }
    long long expected = 0;
    for (int64_t n = 0; n < 1500; n++) {
        expected += (n % 13) * (n % 13 - 1) / 2;
    }
    assert_true(atomic_load(&sum) == expected);
    sl_thread_pool_free(pool);
}

static void a_pool_that_never_worked_can_be_freed(void **state)
{
    (void)state;
    sl_thread_pool *pool;
    assert_int_equal(sl_thread_pool_create(16, &pool), SL_OK);
    sl_thread_pool_free(pool);
    sl_thread_pool_free(NULL);
    assert_true(sl_processor_count() >= 1);
}

static void chunk_counts_round_up(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(7);
    assert_int_equal(sl_chunk_count(0, 17), 0);
    for (int trial = 0; trial < 2000; trial++) {
        const int64_t size = 1 + test_index(&rng, 1000), count = test_index(&rng, 1000000);
        const int64_t chunks = sl_chunk_count(count, size);
        assert_true(chunks * size >= count && (chunks - 1) * size < count);
    }
}

typedef struct progress_log {
    int calls;
    double last;
    char stage[16];
} progress_log;

static bool stop_at_half(void *user, const char *stage, double fraction)
{
    progress_log *log = user;
    log->calls++;
    log->last = fraction;
    strncpy(log->stage, stage, sizeof log->stage - 1);
    return fraction < 0.5;
}

static void progress_reaches_the_caller_and_can_cancel(void **state)
{
    (void)state;
    progress_log log = {0};
    const sl_context context = {.progress = stop_at_half, .progress_user = &log};
    const sl_context silent = {0};
    assert_int_equal(sl_report_progress(NULL, "cut", 0.9), SL_OK);
    assert_int_equal(sl_report_progress(&silent, "cut", 0.9), SL_OK);
    assert_int_equal(sl_report_progress(&context, "cut", 0.375), SL_OK);
    assert_int_equal(sl_report_progress(&context, "flatten", 0.625), SL_CANCELLED);
    assert_int_equal(log.calls, 2);
    assert_true(test_near(log.last, 0.625, 0.0));
    assert_string_equal(log.stage, "flatten");
}

static bool is_set(void *user)
{
    return *(const bool *)user;
}

static void a_quiet_context_can_be_cancelled_and_reports_nothing(void **state)
{
    (void)state;
    bool stop = false;
    progress_log log = {0};
    const sl_executor executor = {.workers = 1};
    const sl_context context = {&executor, stop_at_half, &log, is_set, &stop};
    const sl_context quiet = sl_quiet_context(&context), none = sl_quiet_context(NULL);
    assert_true(quiet.executor == &executor && none.executor == NULL);
    assert_int_equal(sl_report_progress(&quiet, "cut", 0.9), SL_OK);
    assert_int_equal(sl_report_progress(&none, "cut", 0.9), SL_OK);
    assert_int_equal(log.calls, 0);
    stop = true;
    assert_int_equal(sl_report_progress(&quiet, "cut", 0.1), SL_CANCELLED);
    assert_int_equal(sl_report_progress(&context, "cut", 0.1), SL_CANCELLED);
    assert_int_equal(sl_report_progress(&none, "cut", 0.1), SL_OK);
    assert_int_equal(log.calls, 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_index_is_visited_once_and_sums_have_the_same_bytes),
        cmocka_unit_test(runs_inside_a_task_finish_and_lose_nothing),
        cmocka_unit_test(many_short_runs_and_empty_ones_end),
        cmocka_unit_test(a_pool_that_never_worked_can_be_freed),
        cmocka_unit_test(chunk_counts_round_up),
        cmocka_unit_test(progress_reaches_the_caller_and_can_cancel),
        cmocka_unit_test(a_quiet_context_can_be_cancelled_and_reports_nothing),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
