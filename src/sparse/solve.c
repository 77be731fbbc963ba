#include "sparse/cholesky.h"

#include "base/memory.h"
#include "sparse/cholesky_internal.h"

#include <cblas.h>

/* Right-hand sides are solved for in groups, stored row by row: W[k * b + c] is unknown k of side c, so a supernode's
 * rows are one dense block and a scattered row is one cache line. */

/* Below this many multiplications (of one side) a call of BLAS costs more than plain loops. */
static const int64_t plain_work = 256;

/* t[0..b) -= a * x[0..b) */
static inline void subtract_scaled(double *restrict t, double a, const double *restrict x, int32_t b)
{
    for (int32_t c = 0; c < b; c++) {
        t[c] -= a * x[c];
    }
}

static inline void forward_plain(const double *panel, int32_t width, int32_t below, const int32_t *row, double *own,
                                 double *W, int32_t b)
{
    const int32_t height = width + below;
    for (int32_t k = 0; k < width; k++) {
        const double *column = panel + (int64_t)k * height;
        double *x = own + (int64_t)k * b;
        for (int32_t c = 0; c < b; c++) {
            x[c] /= column[k];
        }
        for (int32_t i = k + 1; i < width; i++) {
            subtract_scaled(own + (int64_t)i * b, column[i], x, b);
        }
        for (int32_t i = 0; i < below; i++) {
            subtract_scaled(W + (int64_t)row[i] * b, column[width + i], x, b);
        }
    }
}

static inline void backward_plain(const double *panel, int32_t width, int32_t below, const int32_t *row, double *own,
                                  const double *W, int32_t b)
{
    const int32_t height = width + below;
    for (int32_t k = width - 1; k >= 0; k--) {
        const double *column = panel + (int64_t)k * height;
        double *x = own + (int64_t)k * b;
        for (int32_t i = 0; i < below; i++) {
            subtract_scaled(x, column[width + i], W + (int64_t)row[i] * b, b);
        }
        for (int32_t i = k + 1; i < width; i++) {
            subtract_scaled(x, column[i], own + (int64_t)i * b, b);
        }
        for (int32_t c = 0; c < b; c++) {
            x[c] /= column[k];
        }
    }
}

/* own := inv(L11) own, then the rows below -= L21 own. gathered: below x b. */
static void forward(const sl_cholesky *F, int32_t s, double *W, int32_t b, double *gathered)
{
    const int32_t width = sl_supernode_width(F, s), below = sl_supernode_below(F, s), height = width + below;
    const int32_t *row = F->below + F->below_first[s];
    const double *panel = F->L + F->panel[s];
    double *own = W + (int64_t)F->first[s] * b;
    if ((int64_t)width * height <= plain_work) {
        if (b == SL_SOLVE_WIDTH) {
            forward_plain(panel, width, below, row, own, W, SL_SOLVE_WIDTH); /* the compiler knows the width */
        } else {
            forward_plain(panel, width, below, row, own, W, b);
        }
        return;
    }
    /* Row by row is transposed column by column: own' is b x width. */
    cblas_dtrsm(CblasColMajor, CblasRight, CblasLower, CblasTrans, CblasNonUnit, b, width, 1.0, panel, height, own, b);
    if (below == 0) {
        return;
    }
    cblas_dgemm(CblasColMajor, CblasNoTrans, CblasTrans, b, below, width, 1.0, own, b, panel + width, height, 0.0,
                gathered, b);
    for (int32_t i = 0; i < below; i++) {
        subtract_scaled(W + (int64_t)row[i] * b, 1.0, gathered + (int64_t)i * b, b);
    }
}

/* own := inv(L11') (S own - L21' rows below). */
static void backward(const sl_cholesky *F, int32_t s, double *W, int32_t b, double *gathered)
{
    const int32_t width = sl_supernode_width(F, s), below = sl_supernode_below(F, s), height = width + below;
    const int32_t *row = F->below + F->below_first[s];
    const double *panel = F->L + F->panel[s];
    double *own = W + (int64_t)F->first[s] * b;
    for (int32_t k = 0; k < width && F->sign != NULL; k++) {
        for (int32_t c = 0; c < b && F->sign[F->first[s] + k] < 0; c++) {
            own[(int64_t)k * b + c] = -own[(int64_t)k * b + c];
        }
    }
    if ((int64_t)width * height <= plain_work) {
        if (b == SL_SOLVE_WIDTH) {
            backward_plain(panel, width, below, row, own, W, SL_SOLVE_WIDTH);
        } else {
            backward_plain(panel, width, below, row, own, W, b);
        }
        return;
    }
    for (int32_t i = 0; i < below; i++) {
        for (int32_t c = 0; c < b; c++) {
            gathered[(int64_t)i * b + c] = W[(int64_t)row[i] * b + c];
        }
    }
    if (below > 0) {
        cblas_dgemm(CblasColMajor, CblasNoTrans, CblasNoTrans, b, width, below, -1.0, gathered, b, panel + width,
                    height, 1.0, own, b);
    }
    cblas_dtrsm(CblasColMajor, CblasRight, CblasLower, CblasNoTrans, CblasNonUnit, b, width, 1.0, panel, height, own,
                b);
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
    int32_t begin, end;
    part_range(F, part, &begin, &end);
    double *rows = X - (int64_t)F->first[begin] * w; /* TOP: X begins with the first top row */
    for (int32_t s = begin; s < end; s++) {
        forward(F, s, rows, w, work);
    }
}

void sl_cholesky_backward_part(const sl_cholesky *F, sl_part part, double *X, int32_t w, double *work,
                               const sl_context *context)
{
    (void)context;
    int32_t begin, end;
    part_range(F, part, &begin, &end);
    double *rows = X - (int64_t)F->first[begin] * w;
    for (int32_t s = end - 1; s >= begin; s--) {
        backward(F, s, rows, w, work);
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
