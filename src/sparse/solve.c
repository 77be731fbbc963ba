#include "sparse/cholesky.h"

#include "base/memory.h"
#include "sparse/cholesky_internal.h"

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
    return (int64_t)w * F->max_below;
}

/* The supernodes of a part. */
static void part_range(const sl_cholesky *F, sl_part part, int32_t *begin, int32_t *end)
{
    *begin = part == SL_PART_TOP ? F->bottom : 0;
    *end = part == SL_PART_BOTTOM ? F->bottom : F->supernodes;
}

void sl_cholesky_forward_part(const sl_cholesky *F, sl_part part, double *X, int32_t w, double *work,
                              const sl_context *context)
{
    (void)context;
    (void)work;
    int32_t begin, end;
    part_range(F, part, &begin, &end);
    const int32_t origin = F->first[begin]; /* TOP: X begins with the first top row */
    const sl_rows rows = {X - (int64_t)origin * w, NULL, w};
    for (int32_t s = begin; s < end; s++) {
        F->kernels->forward(F->L + F->panel[s], sl_supernode_width(F, s), sl_supernode_below(F, s),
                            F->below + F->below_first[s], X + (int64_t)(F->first[s] - origin) * w, rows);
    }
}

void sl_cholesky_backward_part(const sl_cholesky *F, sl_part part, double *X, int32_t w, double *work,
                               const sl_context *context)
{
    (void)context;
    (void)work;
    int32_t begin, end;
    part_range(F, part, &begin, &end);
    const int32_t origin = F->first[begin];
    const sl_rows rows = {X - (int64_t)origin * w, NULL, w};
    for (int32_t s = end - 1; s >= begin; s--) {
        double *own = X + (int64_t)(F->first[s] - origin) * w;
        const int32_t width = sl_supernode_width(F, s);
        if (F->sign != NULL) {
            apply_signs(F->sign + F->first[s], width, w, own);
        }
        F->kernels->backward(F->L + F->panel[s], width, sl_supernode_below(F, s), F->below + F->below_first[s], own,
                             rows);
    }
}

void sl_cholesky_permute_in(const sl_cholesky *F, const double *X, int32_t w, double *Y)
{
    const int64_t n = F->n;
    for (int64_t k = 0; k < n; k++) {
        for (int32_t c = 0; c < w; c++) {
            Y[k * w + c] = X[c * n + F->perm[k]];
        }
    }
}

void sl_cholesky_permute_out(const sl_cholesky *F, const double *Y, int32_t w, double *X)
{
    const int64_t n = F->n;
    for (int64_t k = 0; k < n; k++) {
        for (int32_t c = 0; c < w; c++) {
            X[c * n + F->perm[k]] = Y[k * w + c];
        }
    }
}

int64_t sl_cholesky_work_size(const sl_cholesky *F, int32_t nrhs)
{
    const int32_t b = nrhs < SL_SOLVE_WIDTH ? nrhs : SL_SOLVE_WIDTH;
    return b * (int64_t)F->n + sl_cholesky_block_work_size(F, b);
}

void sl_cholesky_solve(const sl_cholesky *F, double *X, int32_t nrhs, double *work)
{
    const int64_t n = F->n;
    for (int32_t done = 0; done < nrhs; done += SL_SOLVE_WIDTH) {
        const int32_t b = nrhs - done < SL_SOLVE_WIDTH ? nrhs - done : SL_SOLVE_WIDTH;
        sl_cholesky_permute_in(F, X + n * done, b, work);
        sl_cholesky_forward_part(F, SL_PART_ALL, work, b, work + n * b, NULL);
        sl_cholesky_backward_part(F, SL_PART_ALL, work, b, work + n * b, NULL);
        sl_cholesky_permute_out(F, work, b, X + n * done);
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
