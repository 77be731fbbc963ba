#include "base/memory.h"
#include "eigen/lanczos_internal.h"

#include <math.h>
#include <string.h>

/* An eigenvalue of this many roundings of ||A|| is none: it is 0. */
static const double zero_roundings = 16.0;

/* Values whose relative distance is at most this belong to one cluster. */
static const double dense_gap = 1e-6;

sl_status sl_dense_eigen(int32_t n, double *A, double *lambda, double *V)
{
    if (n == 0) {
        return SL_OK;
    }
    lapack_int found = 0;
    lapack_int *support = sl_alloc(2 * (int64_t)n, sizeof *support);
    if (support == NULL) {
        return SL_OUT_OF_MEMORY;
    }
    const lapack_int info =
        LAPACKE_dsyevr(LAPACK_COL_MAJOR, 'V', 'A', 'L', n, A, n, 0.0, 0.0, 0, 0, 0.0, &found, lambda, V, n, support);
    sl_free(support);
    if (info == LAPACK_WORK_MEMORY_ERROR) {
        return SL_OUT_OF_MEMORY;
    }
    return info == 0 && found == n ? SL_OK : SL_INTERNAL;
}

/* Lower triangle of A + 2 ||A|| N N': the null space N goes to the far end of the spectrum. */
static void fill_dense(const sl_lanczos *s, double *D)
{
    const int64_t n = s->n;
    memset(D, 0, (size_t)(n * n) * sizeof *D);
    for (int64_t j = 0; j < n; j++) {
        for (int64_t p = s->A->colptr[j]; p < s->A->colptr[j + 1]; p++) {
            D[j * n + s->A->row[p]] = s->A->val[p];
        }
    }
    for (int32_t k = 0; k < s->null_count; k++) {
        const double *v = s->def.null_space + n * k;
        for (int64_t j = 0; j < n; j++) {
            for (int64_t i = j; i < n; i++) {
                D[j * n + i] += 2.0 * s->norm * v[i] * v[j];
            }
        }
    }
}

/* Residuals and info of the results; spare: n. */
static void summarise_dense(sl_lanczos *s, double *spare)
{
    sl_lanczos_info *info = &s->info;
    info->converged_count = 0;
    info->max_residual = info->max_relative = 0.0;
    for (int32_t k = 0; k < s->count; k++) {
        double *x = s->dense_X + (int64_t)s->n * k, squares = 0.0;
        sl_lanczos_sign_rule(s->n, x);
        sl_csc_multiply_symmetric(s->A, x, 1, spare);
        for (int32_t i = 0; i < s->n; i++) {
            const double d = spare[i] - s->dense_lambda[k] * x[i];
            squares += d * d;
        }
        const double residual = sqrt(squares), lambda = s->dense_lambda[k];
        s->dense_residual[k] = residual / s->norm;
        info->max_residual = fmax(info->max_residual, s->dense_residual[k]);
        if (k >= s->null_count) {
            info->max_relative = fmax(info->max_relative, lambda > 0.0 ? residual / lambda : 0.0);
        }
        info->converged_count += residual <= sl_lanczos_bound(s, lambda);
    }
    info->converged = info->converged_count == s->count;
}

/* LAPACK has found all: sigma stands in the first gap above the last value wanted. lambda: n - null_count values. */
static void certify_dense(sl_lanczos *s, const double *lambda)
{
    const int32_t all = s->n - s->null_count;
    int32_t m = s->wanted;
    double last = m > 0 ? lambda[m - 1] : 0.0;
    while (m < all && !(lambda[m] - last > dense_gap * fmax(fabs(last), dense_gap * s->norm))) {
        last = lambda[m++];
    }
    s->info.sigma = m < all ? 0.5 * (last + lambda[m]) : last + dense_gap * s->norm;
    s->info.count = s->null_count + m;
    s->info.certified = s->def.certify;
}

static sl_status allocate(sl_lanczos *s)
{
    sl_free(s->dense_X);
    sl_free(s->dense_lambda);
    sl_free(s->dense_residual);
    s->dense_X = sl_calloc((int64_t)s->n * s->count, sizeof *s->dense_X);
    s->dense_lambda = sl_calloc(s->count, sizeof *s->dense_lambda);
    s->dense_residual = sl_calloc(s->count, sizeof *s->dense_residual);
    return s->dense_X != NULL && s->dense_lambda != NULL && s->dense_residual != NULL ? SL_OK : SL_OUT_OF_MEMORY;
}

sl_status sl_lanczos_solve_dense(sl_lanczos *s)
{
    const int64_t n = s->n;
    const size_t column = (size_t)n * sizeof(double);
    double *D = NULL, *V = NULL, *lambda = NULL;
    int64_t entries = 0;
    sl_status status = SL_OK;
    SL_TRY(sl_mul_size(n, n, &entries));
    D = sl_alloc(entries, sizeof *D);
    V = sl_alloc(entries, sizeof *V);
    lambda = sl_alloc(n, sizeof *lambda);
    SL_TRY(D != NULL && V != NULL && lambda != NULL ? SL_OK : SL_OUT_OF_MEMORY);
    SL_TRY(allocate(s));
    fill_dense(s, D);
    SL_TRY(sl_dense_eigen(s->n, D, lambda, V));
    for (int32_t k = 0; k < s->null_count; k++) {
        memcpy(s->dense_X + n * k, s->def.null_space + n * k, column);
    }
    memcpy(s->dense_X + n * s->null_count, V, (size_t)s->wanted * column);
    for (int32_t k = 0; k < s->wanted; k++) {
        const bool zero = fabs(lambda[k]) <= zero_roundings * 0x1p-52 * s->norm;
        s->dense_lambda[s->null_count + k] = zero ? 0.0 : lambda[k];
    }
    s->info.dense = true;
    s->stage = SL_STAGE_DONE;
    summarise_dense(s, V);
    certify_dense(s, lambda);
cleanup:
    sl_free(D);
    sl_free(V);
    sl_free(lambda);
    return status;
}
