#include "sparse/front.h"

#include <cblas.h>
#include <lapacke.h>
#include <math.h>

/* Below this many multiplications a call of BLAS costs more than plain loops. */
static const int64_t plain_work = 2048;

/* Puts the pivot's root on the diagonal and scales its column; false when the pivot is bad. */
static bool take_pivot(double *column, int32_t k, int32_t height, double least, double replacement, int8_t *sign)
{
    double d = column[k];
    const double size = sign != NULL ? fabs(d) : d;
    bool good = size > least && isfinite(d);
    if (!good && replacement > 0.0) {
        d = replacement;
        good = true;
    }
    const double root = sqrt(fabs(d)), scale = d < 0.0 ? -1.0 / root : 1.0 / root;
    column[k] = root;
    for (int32_t i = k + 1; i < height; i++) {
        column[i] *= scale;
    }
    if (sign != NULL) {
        sign[k] = d < 0.0 ? -1 : 1;
    }
    return good;
}

static int32_t factor_plain(double *panel, int32_t width, int32_t height, double least, double replacement,
                            int8_t *sign)
{
    for (int32_t k = 0; k < width; k++) {
        double *column = panel + (int64_t)k * height;
        for (int32_t j = 0; j < k; j++) {
            const double *left = panel + (int64_t)j * height;
            const double factor = sign != NULL && sign[j] < 0 ? -left[k] : left[k];
            for (int32_t i = k; i < height; i++) {
                column[i] -= factor * left[i];
            }
        }
        if (!take_pivot(column, k, height, least, replacement, sign)) {
            return k;
        }
    }
    return -1;
}

static int32_t factor_blocked(double *panel, int32_t width, int32_t height, double least)
{
    const int info = LAPACKE_dpotrf_work(LAPACK_COL_MAJOR, 'L', width, panel, height);
    if (info > 0) {
        return info - 1;
    }
    for (int32_t k = 0; k < width; k++) {
        const double root = panel[k * (int64_t)(height + 1)];
        if (!(root > 0.0 && root * root > least && isfinite(root))) {
            return k;
        }
    }
    if (height > width) {
        cblas_dtrsm(CblasColMajor, CblasRight, CblasLower, CblasTrans, CblasNonUnit, height - width, width, 1.0, panel,
                    height, panel + width, height);
    }
    return -1;
}

int32_t sl_front_factor(double *panel, int32_t width, int32_t height, double least, double replacement, int8_t *sign)
{
    const bool plain = sign != NULL || (int64_t)width * width * height <= plain_work;
    return plain ? factor_plain(panel, width, height, least, replacement, sign)
                 : factor_blocked(panel, width, height, least);
}

static bool all_positive(const int8_t *sign, int32_t count)
{
    for (int32_t k = 0; k < count; k++) {
        if (sign[k] < 0) {
            return false;
        }
    }
    return true;
}

void sl_front_update(const double *panel, int32_t width, int32_t below, const int8_t *sign, double *own)
{
    const int32_t height = width + below;
    const bool definite = sign == NULL || all_positive(sign, width);
    if (definite && (int64_t)width * below * below > plain_work) {
        cblas_dsyrk(CblasColMajor, CblasLower, CblasNoTrans, below, width, -1.0, panel + width, height, 1.0, own,
                    below);
        return;
    }
    for (int32_t k = 0; k < below; k++) {
        double *column = own + (int64_t)k * below;
        for (int32_t j = 0; j < width; j++) {
            const double *left = panel + (int64_t)j * height + width;
            const double factor = definite || sign[j] > 0 ? left[k] : -left[k];
            for (int32_t i = k; i < below; i++) {
                column[i] -= factor * left[i];
            }
        }
    }
}
