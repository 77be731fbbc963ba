/* Subtrees of the elimination tree that can be worked on side by side. */
#include "sparse/tasks.h"

#include "base/memory.h"

#include <string.h>

/* A subtree is a task when its work is at most one part in most_tasks of all, and at least one in least_share of that;
 * what remains (the separators near the root and a few crumbs) is the crown. */
static const double most_tasks = 24.0;
static const double least_share = 32.0;

/* Trees with less work than this (about 10k unknowns of a surface mesh) are all crown. */
static const double least_work = 4e6;

/* Multiplications of a front, and what it costs to go there at all. */
static double work_of(const sl_cholesky *F, int32_t s)
{
    const double width = sl_supernode_width(F, s), below = sl_supernode_below(F, s);
    return 400.0 + 20.0 * width * (width + below) + width * (width + below) * (width + below);
}

/* work[s] = that of the subtree of s. Returns the sum. */
static double subtree_work(const sl_cholesky *F, double *work)
{
    double sum = 0.0;
    memset(work, 0, (size_t)F->supernodes * sizeof *work);
    for (int32_t s = 0; s < F->supernodes; s++) { /* children have smaller numbers */
        const double own = work_of(F, s);
        work[s] += own;
        sum += own;
        if (F->parent[s] != -1) {
            work[F->parent[s]] += work[s];
        }
    }
    return sum;
}

/* task[s] = number of the task s belongs to, -1 = crown. Tasks are numbered along the walk. */
static void name_tasks(sl_cholesky *F, const double *work, double sum)
{
    const double most = sum / most_tasks;
    F->task_count = 0;
    for (int32_t k = F->supernodes - 1; k >= 0; k--) { /* parents first */
        const int32_t s = F->walk[k], parent = F->parent[s];
        const bool root = sum >= least_work && work[s] <= most && work[s] >= most / least_share &&
                          (parent == -1 || work[parent] > most);
        F->task[s] = root ? F->task_count++ : parent != -1 ? F->task[parent] : -1;
    }
    for (int32_t s = 0; s < F->supernodes; s++) {
        F->task[s] = F->task[s] != -1 ? F->task_count - 1 - F->task[s] : -1;
    }
}

static void find_ranges(sl_cholesky *F)
{
    for (int32_t t = 0; t < F->task_count; t++) {
        F->task_begin[t] = F->supernodes;
    }
    for (int32_t k = 0; k < F->supernodes; k++) {
        const int32_t t = F->task[F->walk[k]];
        if (t != -1) {
            F->task_begin[t] = k < F->task_begin[t] ? k : F->task_begin[t];
            F->task_end[t] = k + 1;
        }
    }
}

/* Rows below the tasks' roots, by true number; then the rows of supernodes in tasks that are outside of them become
 * references to these lists. number: n. */
static void code_outside_rows(sl_cholesky *F, int32_t *number)
{
    for (int32_t t = 0; t < F->task_count; t++) {
        const int32_t root = F->walk[F->task_end[t] - 1];
        const int32_t *row = F->below + F->below_first[root];
        int32_t *outside = F->outside + F->outside_first[t];
        for (int32_t i = 0; i < sl_supernode_below(F, root); i++) {
            outside[i] = row[i];
            number[row[i]] = -1 - i;
        }
        for (int32_t k = F->task_begin[t]; k < F->task_end[t]; k++) {
            const int32_t s = F->walk[k];
            int64_t p = F->below_first[s + 1];
            while (p > F->below_first[s] && F->below[p - 1] >= F->first[root + 1]) {
                p--;
                F->below[p] = number[F->below[p]];
            }
        }
    }
}

sl_status sl_tasks_create(sl_cholesky *F)
{
    double *work = sl_alloc(F->supernodes, sizeof *work);
    int32_t *number = NULL;
    sl_status status = SL_OK;
    F->task = sl_alloc(F->supernodes, sizeof *F->task);
    SL_TRY(work != NULL && F->task != NULL ? SL_OK : SL_OUT_OF_MEMORY);
    name_tasks(F, work, subtree_work(F, work));
    F->task_begin = sl_alloc(F->task_count, sizeof *F->task_begin);
    F->task_end = sl_alloc(F->task_count, sizeof *F->task_end);
    F->outside_first = sl_calloc((int64_t)F->task_count + 1, sizeof *F->outside_first);
    SL_TRY(F->task_begin != NULL && F->task_end != NULL && F->outside_first != NULL ? SL_OK : SL_OUT_OF_MEMORY);
    find_ranges(F);
    for (int32_t t = 0; t < F->task_count; t++) {
        const int32_t root = F->walk[F->task_end[t] - 1];
        F->outside_first[t + 1] = F->outside_first[t] + sl_supernode_below(F, root);
    }
    F->outside = sl_alloc(F->outside_first[F->task_count], sizeof *F->outside);
    number = sl_alloc(F->n, sizeof *number);
    SL_TRY(F->outside != NULL && number != NULL ? SL_OK : SL_OUT_OF_MEMORY);
    code_outside_rows(F, number);
cleanup:
    sl_free(work);
    sl_free(number);
    return status;
}

void sl_tasks_clear(sl_cholesky *F)
{
    sl_free(F->task);
    sl_free(F->task_begin);
    sl_free(F->task_end);
    sl_free(F->outside_first);
    sl_free(F->outside);
}
