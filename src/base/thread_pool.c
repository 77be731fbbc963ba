/* POSIX threads behind sl_executor: workers take task numbers from one counter. */
#define _POSIX_C_SOURCE 200809L
#include "base/context.h"
#include "base/memory.h"

#include <pthread.h>
#include <stdatomic.h>
#include <unistd.h>

struct sl_thread_pool {
    sl_executor executor;
    pthread_t *threads;
    int32_t started; /* threads running, workers - 1 */
    pthread_mutex_t lock;
    pthread_cond_t wake, done;
    uint64_t round; /* counts run() calls; a change wakes the workers */
    bool stop;
    int32_t busy; /* workers still inside the current round */
    void (*task)(void *, int32_t);
    void *task_user;
    int32_t task_count;
    atomic_int next;
};

static _Thread_local bool inside_task; /* nested run() calls are serial: no deadlock, no oversubscription */

static void take_tasks(sl_thread_pool *pool)
{
    inside_task = true;
    for (int32_t t = atomic_fetch_add(&pool->next, 1); t < pool->task_count; t = atomic_fetch_add(&pool->next, 1)) {
        pool->task(pool->task_user, t);
    }
    inside_task = false;
}

static void *worker_main(void *user)
{
    sl_thread_pool *pool = user;
    uint64_t seen = 0;
    pthread_mutex_lock(&pool->lock);
    for (;;) {
        while (!pool->stop && pool->round == seen) {
            pthread_cond_wait(&pool->wake, &pool->lock);
        }
        if (pool->stop) {
            break;
        }
        seen = pool->round;
        pthread_mutex_unlock(&pool->lock);
        take_tasks(pool);
        pthread_mutex_lock(&pool->lock);
        if (--pool->busy == 0) {
            pthread_cond_signal(&pool->done);
        }
    }
    pthread_mutex_unlock(&pool->lock);
    return NULL;
}

static void pool_run(void *self, int32_t count, void (*task)(void *, int32_t), void *task_user)
{
    sl_thread_pool *pool = self;
    if (inside_task || pool->started == 0 || count <= 1) {
        for (int32_t t = 0; t < count; t++) {
            task(task_user, t);
        }
        return;
    }
    pthread_mutex_lock(&pool->lock);
    pool->task = task;
    pool->task_user = task_user;
    pool->task_count = count;
    atomic_store(&pool->next, 0);
    pool->busy = pool->started;
    pool->round++;
    pthread_cond_broadcast(&pool->wake);
    pthread_mutex_unlock(&pool->lock);
    take_tasks(pool);
    pthread_mutex_lock(&pool->lock);
    while (pool->busy > 0) {
        pthread_cond_wait(&pool->done, &pool->lock);
    }
    pthread_mutex_unlock(&pool->lock);
}

sl_status sl_thread_pool_create(int32_t workers, sl_thread_pool **out)
{
    SL_ASSERT(workers >= 1);
    *out = NULL;
    sl_thread_pool *pool = sl_calloc(1, sizeof *pool);
    if (pool == NULL) {
        return SL_OUT_OF_MEMORY;
    }
    pool->executor = (sl_executor){pool_run, pool, workers};
    pthread_mutex_init(&pool->lock, NULL);
    pthread_cond_init(&pool->wake, NULL);
    pthread_cond_init(&pool->done, NULL);
    pool->threads = sl_alloc(workers, sizeof *pool->threads);
    if (pool->threads == NULL) {
        sl_thread_pool_free(pool);
        return SL_OUT_OF_MEMORY;
    }
    while (pool->started < workers - 1) {
        if (pthread_create(&pool->threads[pool->started], NULL, worker_main, pool) != 0) {
            sl_thread_pool_free(pool);
            return SL_OUT_OF_MEMORY;
        }
        pool->started++;
    }
    *out = pool;
    return SL_OK;
}

const sl_executor *sl_thread_pool_executor(const sl_thread_pool *pool)
{
    return &pool->executor;
}

void sl_thread_pool_free(sl_thread_pool *pool)
{
    if (pool == NULL) {
        return;
    }
    pthread_mutex_lock(&pool->lock);
    pool->stop = true;
    pthread_cond_broadcast(&pool->wake);
    pthread_mutex_unlock(&pool->lock);
    for (int32_t k = 0; k < pool->started; k++) {
        pthread_join(pool->threads[k], NULL);
    }
    pthread_cond_destroy(&pool->done);
    pthread_cond_destroy(&pool->wake);
    pthread_mutex_destroy(&pool->lock);
    sl_free(pool->threads);
    sl_free(pool);
}

int32_t sl_processor_count(void)
{
    const long n = sysconf(_SC_NPROCESSORS_ONLN);
    return n >= 1 ? (int32_t)n : 1;
}
