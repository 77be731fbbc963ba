/* Multifrontal factorisation. Source: Duff, Reid 1983; Liu 1992. A supernode's panel takes A's entries and its
 * children's update matrices, is factored, and leaves its own update matrix for its parent. */
#include "base/memory.h"
#include "sparse/extend_add.h"
#include "sparse/front.h"

#include <string.h>

/* Fronts with this many multiplications and more are shared among workers. */
static const double shared_work = 4e6;

/* Progress is reported whenever so many multiplications are done: tens of milliseconds. */
static const double report_work = 5e8;

/* One walk's state. Update matrices live on two stacks that grow from the ends of one array: those of supernodes
 * at even depth from the left, at odd depth from the right, so that a parent's is not made where its children's lie. */
typedef struct walker {
    const sl_front_job *job;
    const sl_context *context; /* for large fronts, NULL = serial */
    sl_front_space own;        /* unless the job brings its space */
    const sl_front_space *space;
    int64_t room, left, right; /* doubles: all, used on either side */
    double **kept;             /* by task: update matrices of their roots; NULL = they are on the stacks */
    double *panel;             /* where panels are made when they are not kept */
} walker;

sl_status sl_front_space_init(const sl_cholesky *F, int64_t room, sl_front_space *space)
{
    *space = (sl_front_space){sl_alloc(room, sizeof *space->updates),
                              sl_alloc(sl_front_spare(F->max_width), sizeof *space->spare)};
    if (space->updates == NULL || space->spare == NULL) {
        sl_front_space_clear(space);
        return SL_OUT_OF_MEMORY;
    }
    return SL_OK;
}

void sl_front_space_clear(sl_front_space *space)
{
    sl_free(space->updates);
    sl_free(space->spare);
    *space = (sl_front_space){0};
}

static void walker_clear(walker *w)
{
    sl_front_space_clear(&w->own);
    sl_free(w->panel);
}

/* given: space for `room` doubles, NULL = it is allocated. The walker must stay where it is. */
static sl_status walker_init(walker *w, const sl_front_job *job, int64_t room, const sl_front_space *given)
{
    sl_status status = SL_OK;
    *w = (walker){.job = job, .room = room, .space = given != NULL ? given : &w->own};
    if (given == NULL) {
        SL_TRY(sl_front_space_init(job->F, room, &w->own));
    }
    if (job->L == NULL) {
        w->panel = sl_alloc(job->F->max_panel, sizeof *w->panel);
        status = w->panel != NULL ? SL_OK : SL_OUT_OF_MEMORY;
    }
cleanup:
    return status;
}

static double *push_update(walker *w, int32_t s)
{
    const sl_cholesky *F = w->job->F;
    const int64_t size = sl_packed_size(sl_supernode_below(F, s));
    SL_ASSERT(w->left + w->right + size <= w->room);
    if (F->odd[s]) {
        w->right += size;
        return w->space->updates + w->room - w->right;
    }
    w->left += size;
    return w->space->updates + w->left - size;
}

/* Those of children, last first, so that *depth doubles on their stack are passed. */
static const double *find_update(const walker *w, int32_t c, int64_t *depth)
{
    const sl_cholesky *F = w->job->F;
    if (w->kept != NULL && F->task[c] != -1) {
        return w->kept[F->task[c]];
    }
    *depth += sl_packed_size(sl_supernode_below(F, c));
    return F->odd[c] ? w->space->updates + w->room - w->right + *depth - sl_packed_size(sl_supernode_below(F, c))
                     : w->space->updates + w->left - *depth;
}

static void pop_updates(walker *w, int32_t s)
{
    const sl_cholesky *F = w->job->F;
    for (int32_t c = F->child[s]; c != -1; c = F->sibling[c]) {
        const int64_t size = sl_packed_size(sl_supernode_below(F, c));
        if (w->kept != NULL && F->task[c] != -1) {
            sl_free(w->kept[F->task[c]]);
            w->kept[F->task[c]] = NULL;
        } else if (F->odd[c]) {
            w->right -= size;
        } else {
            w->left -= size;
        }
    }
}

/* A's entries into the panel of s. */
static void scatter_entries(const sl_front_job *job, int32_t s, double *panel)
{
    const sl_cholesky *F = job->F;
    const int64_t begin = F->entry_first[s], end = F->entry_first[s + 1];
    const int32_t width = sl_supernode_width(F, s);
    for (int64_t e = begin; e < end; e++) {
        panel[F->entry_to[e]] = job->A->val[F->entry_from[e]];
    }
    for (int64_t e = begin; e < begin + width; e++) {
        panel[F->entry_to[e]] -= job->sigma;
    }
}

/* A part of a front for sl_parallel_for. */
typedef struct shared_front {
    const sl_kernels *kernels;
    double *panel, *spare, *U;
    int8_t *sign;
    int32_t width, below, begin;
} shared_front;

static void trail_some(void *user, int64_t begin, int64_t end, int32_t chunk)
{
    (void)chunk;
    const shared_front *f = user;
    f->kernels->trail(f->panel, f->width, f->below, f->begin, f->sign, f->spare, (int32_t)begin, (int32_t)end);
}

static void update_some(void *user, int64_t begin, int64_t end, int32_t chunk)
{
    (void)chunk;
    const shared_front *f = user;
    f->kernels->update(f->panel, f->width, f->below, f->sign, f->spare, (int32_t)begin, (int32_t)end, f->U);
}

static const sl_context *sharing(const walker *w, const shared_front *f)
{
    const double height = (double)f->width + f->below;
    return f->width * height * height < shared_work ? NULL : w->context;
}

static int32_t factor_panel(const walker *w, shared_front *f, sl_pivoting pivoting)
{
    int32_t bad = -1;
    f->kernels->open(f->panel, f->width, f->below, f->spare);
    if (f->sign != NULL) {
        memset(f->sign, 1, (size_t)f->width); /* columns yet to come count as positive */
    }
    for (f->begin = 0; f->begin < f->width && bad == -1; f->begin += SL_KERNEL_DEPTH) {
        bad = f->kernels->columns(f->panel, f->width, f->below, f->begin, pivoting, f->sign, f->spare);
        const int32_t pairs = bad == -1 ? sl_trail_pairs(f->width, f->below, f->begin) : 0;
        if (pairs > 0) {
            sl_parallel_for(sharing(w, f), pairs, 4, trail_some, f);
        }
    }
    f->kernels->close(f->panel, f->width, f->below, f->spare);
    return bad;
}

/* Returns the bad column or -1. */
static int32_t factor_supernode(walker *w, int32_t s)
{
    const sl_front_job *job = w->job;
    const sl_cholesky *F = job->F;
    const int32_t width = sl_supernode_width(F, s), below = sl_supernode_below(F, s);
    double *panel = job->L != NULL ? job->L + F->panel[s] : w->panel, *own = push_update(w, s);
    int8_t *sign = job->sign != NULL ? job->sign + F->first[s] : NULL;
    int64_t depth = 0;
    memset(panel, 0, (size_t)(F->panel[s + 1] - F->panel[s]) * sizeof *panel);
    scatter_entries(job, s, panel);
    for (int32_t c = F->child[s]; c != -1; c = F->sibling[c]) {
        sl_extend_panel(F, c, find_update(w, c, &depth), panel);
    }
    shared_front f = {F->kernels, panel, w->space->spare, own, sign, width, below, 0};
    const int32_t bad = factor_panel(w, &f, job->pivoting);
    if (bad != -1) {
        return F->first[s] + bad;
    }
    sl_parallel_for(sharing(w, &f), sl_slab_pairs(below), 2, update_some, &f);
    depth = 0;
    for (int32_t c = F->child[s]; c != -1; c = F->sibling[c]) {
        sl_extend_update(F, c, find_update(w, c, &depth), own);
    }
    pop_updates(w, s);
    if (job->panel_done != NULL) {
        job->panel_done(job->user, s, panel, sign);
    }
    return -1;
}

static double work_of(const sl_cholesky *F, int32_t s)
{
    const double width = sl_supernode_width(F, s), height = width + sl_supernode_below(F, s);
    return width * height * height;
}

/* The supernodes of `walk`, or those of the crown alone, whose tasks are done. */
static sl_status walk_tree(walker *w, sl_front_job *job, const sl_context *context, const int32_t *task_bad)
{
    const sl_cholesky *F = job->F;
    double reported = 0.0, done = 0.0, all = 1.0;
    sl_status status = SL_OK;
    for (int32_t s = 0; s < F->supernodes; s++) {
        all += work_of(F, s);
    }
    for (int32_t k = 0; k < F->supernodes && job->bad == -1; k++) {
        const int32_t s = F->walk[k], t = F->task[s];
        job->bad = task_bad == NULL || t == -1 ? factor_supernode(w, s) : task_bad[t];
        done += work_of(F, s);
        if (done - reported >= report_work) {
            reported = done;
            SL_TRY(sl_report_progress(context, job->stage, done / all));
        }
    }
cleanup:
    return status;
}

/* Tasks by workers. */
typedef struct task_job {
    const sl_front_job *job;
    double **kept;     /* results, by task */
    int32_t *bad;      /* -1 = none */
    sl_status *status; /* by task */
} task_job;

/* The deepest its stacks become; a root's own update matrix is above its children's. */
static int64_t room_of_task(const sl_cholesky *F, int32_t t)
{
    int64_t top = 0, deepest = 0;
    for (int32_t k = F->task_begin[t]; k < F->task_end[t]; k++) {
        const int32_t s = F->walk[k];
        top += sl_packed_size(sl_supernode_below(F, s));
        deepest = top > deepest ? top : deepest;
        for (int32_t c = F->child[s]; c != -1; c = F->sibling[c]) {
            top -= sl_packed_size(sl_supernode_below(F, c));
        }
    }
    return deepest;
}

static void run_task(void *user, int64_t begin, int64_t end, int32_t t)
{
    (void)begin, (void)end;
    task_job *tasks = user;
    const sl_cholesky *F = tasks->job->F;
    const int32_t root = F->walk[F->task_end[t] - 1];
    const int64_t size = sl_packed_size(sl_supernode_below(F, root));
    walker w;
    sl_status status = SL_OK;
    SL_TRY(walker_init(&w, tasks->job, room_of_task(F, t), NULL));
    for (int32_t k = F->task_begin[t]; k < F->task_end[t] && tasks->bad[t] == -1; k++) {
        tasks->bad[t] = factor_supernode(&w, F->walk[k]);
    }
    tasks->kept[t] =
        sl_copy(F->odd[root] ? w.space->updates + w.room - size : w.space->updates, size, sizeof **tasks->kept);
    SL_TRY(tasks->kept[t] != NULL ? SL_OK : SL_OUT_OF_MEMORY);
cleanup:
    walker_clear(&w);
    tasks->status[t] = status;
}

/* All tasks by the workers, then the crown. */
static sl_status factor_in_parallel(walker *w, sl_front_job *job, const sl_context *context)
{
    const sl_cholesky *F = job->F;
    const int64_t count = F->task_count;
    task_job tasks = {.job = job};
    sl_status status = SL_OK;
    tasks.kept = sl_calloc(count, sizeof *tasks.kept);
    tasks.bad = sl_alloc(count, sizeof *tasks.bad);
    tasks.status = sl_alloc(count, sizeof *tasks.status);
    SL_TRY(tasks.kept != NULL && tasks.bad != NULL && tasks.status != NULL ? SL_OK : SL_OUT_OF_MEMORY);
    memset(tasks.bad, -1, (size_t)count * sizeof *tasks.bad);
    sl_parallel_for(context, count, 1, run_task, &tasks);
    for (int32_t t = 0; t < count; t++) {
        SL_TRY(tasks.status[t]);
    }
    w->kept = tasks.kept;
    w->context = context;
    SL_TRY(walk_tree(w, job, context, tasks.bad));
cleanup:
    for (int32_t t = 0; t < count && tasks.kept != NULL; t++) {
        sl_free(tasks.kept[t]);
    }
    sl_free(tasks.kept);
    sl_free(tasks.bad);
    sl_free(tasks.status);
    return status;
}

sl_status sl_factor_fronts(sl_front_job *job, const sl_context *context)
{
    const sl_cholesky *F = job->F;
    const bool parallel = context != NULL && context->executor != NULL && context->executor->workers > 1;
    walker w = {0};
    sl_status status = SL_OK;
    job->bad = -1;
    SL_TRY(walker_init(&w, job, F->max_update, job->space));
    if (parallel && F->task_count > 0) {
        SL_TRY(factor_in_parallel(&w, job, context));
    } else {
        SL_TRY(walk_tree(&w, job, context, NULL));
    }
cleanup:
    walker_clear(&w);
    return status;
}
