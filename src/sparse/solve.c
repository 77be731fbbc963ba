#include "sparse/cholesky.h"

#include "base/memory.h"
#include "sparse/cholesky_internal.h"

#include <string.h>

/* Right-hand sides are solved for in groups, stored row by row: W[k * b + c] is unknown k of side c, so a supernode's
 * rows are one dense block and a scattered row is one cache line. */

/* own := S own for the columns of s. */
static void apply_signs(const int8_t *sign, int32_t width, int32_t w, double *own)
{
    for (int32_t k = 0; k < width; k++) {
        for (int32_t c = 0; c < w && sign[k] < 0; c++) {
            own[(int64_t)k * w + c] = -own[(int64_t)k * w + c];
        }
    }
}

int64_t sl_cholesky_block_work_size(const sl_cholesky *F, int32_t w)
{
    return (int64_t)w * F->outside_first[F->task_count];
}

/* A solve over one part. */
typedef struct part_solve {
    const sl_cholesky *F;
    int32_t begin, end; /* its supernodes */
    int32_t origin;     /* row of the first of X: TOP leaves the bottom rows out */
    double *X, *work;
    int32_t w;
} part_solve;

static part_solve part_of(const sl_cholesky *F, sl_part part, double *X, int32_t w, double *work)
{
    SL_ASSERT(w >= 1 && w <= SL_CHOLESKY_MAX_BLOCK && F->L != NULL);
    part_solve p = {.F = F, .X = X, .work = work, .w = w};
    p.begin = part == SL_PART_TOP ? F->bottom : 0;
    p.end = part == SL_PART_BOTTOM ? F->bottom : F->supernodes;
    p.origin = F->first[p.begin];
    return p;
}

/* Rows of X that stand for the rows outside of task t; they are summed or copied in work. */
static double *outside_of(const part_solve *p, int32_t t)
{
    return p->work + p->F->outside_first[t] * p->w;
}

static void forward_supernode(const part_solve *p, int32_t s, double *outside)
{
    const sl_cholesky *F = p->F;
    const sl_rows rows = {p->X, outside, p->w, p->origin};
    F->kernels->forward(F->L + F->panel[s], sl_supernode_width(F, s), sl_supernode_below(F, s),
                        F->below + F->below_first[s], p->X + (int64_t)(F->first[s] - p->origin) * p->w, rows);
}

static void backward_supernode(const part_solve *p, int32_t s, double *outside)
{
    const sl_cholesky *F = p->F;
    const sl_rows rows = {p->X, outside, p->w, p->origin};
    const int32_t width = sl_supernode_width(F, s);
    double *own = p->X + (int64_t)(F->first[s] - p->origin) * p->w;
    if (F->sign != NULL) {
        apply_signs(F->sign + F->first[s], width, p->w, own);
    }
    F->kernels->backward(F->L + F->panel[s], width, sl_supernode_below(F, s), F->below + F->below_first[s], own, rows);
}

static void forward_task(void *user, int64_t begin, int64_t end, int32_t t)
{
    (void)begin, (void)end;
    const part_solve *p = user;
    const sl_cholesky *F = p->F;
    const int64_t size = (F->outside_first[t + 1] - F->outside_first[t]) * p->w;
    memset(outside_of(p, t), 0, (size_t)size * sizeof(double));
    for (int32_t k = F->task_begin[t]; k < F->task_end[t]; k++) {
        if (F->walk[k] >= p->begin && F->walk[k] < p->end) {
            forward_supernode(p, F->walk[k], outside_of(p, t));
        }
    }
}

static void backward_task(void *user, int64_t begin, int64_t end, int32_t t)
{
    (void)begin, (void)end;
    const part_solve *p = user;
    const sl_cholesky *F = p->F;
    double *outside = outside_of(p, t);
    for (int64_t k = F->outside_first[t]; k < F->outside_first[t + 1]; k++) {
        memcpy(outside, p->X + (int64_t)(F->outside[k] - p->origin) * p->w, (size_t)p->w * sizeof *outside);
        outside += p->w;
    }
    for (int32_t k = F->task_end[t] - 1; k >= F->task_begin[t]; k--) {
        if (F->walk[k] >= p->begin && F->walk[k] < p->end) {
            backward_supernode(p, F->walk[k], outside_of(p, t));
        }
    }
}

/* What tasks have for the crown, in their order. */
static void add_outside(const part_solve *p)
{
    const sl_cholesky *F = p->F;
    const double *from = p->work;
    for (int64_t k = 0; k < F->outside_first[F->task_count]; k++) {
        double *to = p->X + (int64_t)(F->outside[k] - p->origin) * p->w;
        for (int32_t c = 0; c < p->w; c++) {
            to[c] += *from++;
        }
    }
}

void sl_cholesky_forward_part(const sl_cholesky *F, sl_part part, double *X, int32_t w, double *work,
                              const sl_context *context)
{
    part_solve p = part_of(F, part, X, w, work);
    sl_parallel_for(context, F->task_count, 1, forward_task, &p);
    add_outside(&p);
    for (int32_t s = p.begin; s < p.end; s++) {
        if (F->task[s] == -1) {
            forward_supernode(&p, s, NULL);
        }
    }
}

void sl_cholesky_backward_part(const sl_cholesky *F, sl_part part, double *X, int32_t w, double *work,
                               const sl_context *context)
{
    part_solve p = part_of(F, part, X, w, work);
    for (int32_t s = p.end - 1; s >= p.begin; s--) {
        if (F->task[s] == -1) {
            backward_supernode(&p, s, NULL);
        }
    }
    sl_parallel_for(context, F->task_count, 1, backward_task, &p);
}

/* Unknowns are taken in A's order: the columns of X are then read and written in one sweep each, and only whole rows of
 * Y, a cache line of eight sides, are at random. Rows of Y beyond the sides are filled with zeros. */
static inline void permute_in(const sl_cholesky *F, const double *X, int32_t sides, int32_t w, double *Y)
{
    const int64_t n = F->n;
    for (int64_t i = 0; i < n; i++) {
        double *row = Y + (int64_t)F->place[i] * w;
        for (int32_t c = 0; c < sides; c++) {
            row[c] = X[c * n + i];
        }
        for (int32_t c = sides; c < w; c++) {
            row[c] = 0.0;
        }
    }
}

static inline void permute_out(const sl_cholesky *F, const double *Y, int32_t sides, int32_t w, double *X)
{
    const int64_t n = F->n;
    for (int64_t i = 0; i < n; i++) {
        const double *row = Y + (int64_t)F->place[i] * w;
        for (int32_t c = 0; c < sides; c++) {
            X[c * n + i] = row[c];
        }
    }
}

/* The compiler knows the widths that matter. */
static void load_sides(const sl_cholesky *F, const double *X, int32_t sides, int32_t w, double *Y)
{
    if (sides == SL_SOLVE_WIDTH && w == SL_SOLVE_WIDTH) {
        permute_in(F, X, SL_SOLVE_WIDTH, SL_SOLVE_WIDTH, Y);
    } else if (w == 1) {
        permute_in(F, X, 1, 1, Y);
    } else {
        permute_in(F, X, sides, w, Y);
    }
}

static void store_sides(const sl_cholesky *F, const double *Y, int32_t sides, int32_t w, double *X)
{
    if (sides == SL_SOLVE_WIDTH && w == SL_SOLVE_WIDTH) {
        permute_out(F, Y, SL_SOLVE_WIDTH, SL_SOLVE_WIDTH, X);
    } else if (w == 1) {
        permute_out(F, Y, 1, 1, X);
    } else {
        permute_out(F, Y, sides, w, X);
    }
}

void sl_cholesky_permute_in(const sl_cholesky *F, const double *X, int32_t w, double *Y)
{
    load_sides(F, X, w, w, Y);
}

void sl_cholesky_permute_out(const sl_cholesky *F, const double *Y, int32_t w, double *X)
{
    store_sides(F, Y, w, w, X);
}

/* Columns of the block that `sides` right-hand sides are solved in: the kernels have a form of their own for one, and
 * for multiples of four. */
static int32_t block_width(int32_t sides)
{
    return sides >= SL_SOLVE_WIDTH ? SL_SOLVE_WIDTH : sides == 1 ? 1 : (sides + 3) / 4 * 4;
}

int64_t sl_cholesky_work_size(const sl_cholesky *F, int32_t nrhs)
{
    const int32_t w = block_width(nrhs);
    return w * (int64_t)F->n + sl_cholesky_block_work_size(F, w);
}

void sl_cholesky_solve(const sl_cholesky *F, double *X, int32_t nrhs, double *work)
{
    const int64_t n = F->n;
    for (int32_t done = 0; done < nrhs; done += SL_SOLVE_WIDTH) {
        const int32_t left = nrhs - done, sides = left < SL_SOLVE_WIDTH ? left : SL_SOLVE_WIDTH, w = block_width(sides);
        load_sides(F, X + n * done, sides, w, work);
        sl_cholesky_forward_part(F, SL_PART_ALL, work, w, work + n * w, NULL);
        sl_cholesky_backward_part(F, SL_PART_ALL, work, w, work + n * w, NULL);
        store_sides(F, work, sides, w, X + n * done);
    }
}

sl_status sl_cholesky_solve_once(const sl_csc *A, const sl_cholesky_def *def, double *X, int32_t nrhs)
{
    sl_cholesky *F = NULL;
    double *work = NULL;
    sl_status status = SL_OK;
    SL_TRY(sl_cholesky_analyze(A, def, &F));
    SL_TRY(sl_cholesky_factor(F, A, NULL));
    work = sl_alloc(sl_cholesky_work_size(F, nrhs), sizeof *work);
    SL_TRY(work != NULL ? SL_OK : SL_OUT_OF_MEMORY);
    sl_cholesky_solve(F, X, nrhs, work);
cleanup:
    sl_free(work);
    sl_cholesky_free(F);
    return status;
}
