/* Rayleigh-Ritz steps with the matrix itself. */
#include "base/memory.h"
#include "eigen/panel.h"

#include <lapacke.h>
#include <math.h>
#include <string.h>

/* An eigenvalue of this many roundings of ||A|| is none: it is 0. */
static const double zero_roundings = 16.0;

/* Added to a Gram matrix of unit vectors that is not positive definite to rounding. */
static const double gram_shift = 1e-13;

/* XX := D XX D, XAX := D XAX D with D = diag(XX)^(-1/2), kept in scale. */
static void scale_grams(int32_t m, double *XX, double *XAX, double *scale)
{
    for (int32_t k = 0; k < m; k++) {
        const double square = XX[(int64_t)k * m + k];
        scale[k] = square > 0.0 ? 1.0 / sqrt(square) : 1.0;
    }
    for (int32_t j = 0; j < m; j++) {
        for (int32_t i = 0; i < m; i++) {
            XX[(int64_t)j * m + i] *= scale[i] * scale[j];
            XAX[(int64_t)j * m + i] *= scale[i] * scale[j];
        }
    }
}

/* Eigenvectors of the pencil (XAX, XX) over XAX, values over lambda. */
static sl_status solve_pencil(int32_t m, double *XX, double *XAX, double *lambda)
{
    double *copy = sl_copy(XX, 2 * (int64_t)m * m, sizeof *copy); /* the two stand one after the other */
    if (copy == NULL) {
        return SL_OUT_OF_MEMORY;
    }
    lapack_int info = LAPACKE_dsygvd(LAPACK_COL_MAJOR, 1, 'V', 'L', m, XAX, m, XX, m, lambda);
    if (info > m) {
        memcpy(XX, copy, 2 * (size_t)m * (size_t)m * sizeof *copy);
        for (int32_t k = 0; k < m; k++) {
            XX[(int64_t)k * m + k] += gram_shift * m;
        }
        info = LAPACKE_dsygvd(LAPACK_COL_MAJOR, 1, 'V', 'L', m, XAX, m, XX, m, lambda);
    }
    sl_free(copy);
    return info == 0 ? SL_OK : info == LAPACK_WORK_MEMORY_ERROR ? SL_OUT_OF_MEMORY : SL_INTERNAL;
}

sl_status sl_panels_rayleigh_ritz(sl_panels *X, int32_t m, const sl_rows *A, double norm, double *lambda,
                                  double *residual, const sl_context *context)
{
    sl_status status = SL_OK;
    double *XX = sl_alloc(2 * (int64_t)m * m + m, sizeof *XX);
    SL_TRY(XX != NULL ? SL_OK : SL_OUT_OF_MEMORY);
    double *XAX = XX + (int64_t)m * m, *scale = XAX + (int64_t)m * m;
    SL_TRY(sl_panels_grams(X, m, A, XX, XAX, context));
    scale_grams(m, XX, XAX, scale);
    SL_TRY(solve_pencil(m, XX, XAX, lambda));
    for (int32_t k = 0; k < m; k++) {
        for (int32_t i = 0; i < m; i++) {
            XAX[(int64_t)k * m + i] *= scale[i];
        }
        if (fabs(lambda[k]) <= zero_roundings * 0x1p-52 * norm) {
            lambda[k] = 0.0;
        }
    }
    SL_TRY(sl_panels_rotate(X, m, XAX, m, NULL, context));
    SL_TRY(sl_panels_residuals(X, m, A, lambda, residual, context));
cleanup:
    sl_free(XX);
    return status;
}
