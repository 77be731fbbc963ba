#include "eigen/lanczos_internal.h"

#include <cblas.h>
#include <math.h>
#include <string.h>

/* Estimates stop at this share of the tolerance: recomputed residuals then meet it with room for rounding. */
static const double stop_share = 0.5;

/* An eigenvalue of this many roundings of ||A|| is none: it is 0. */
static const double zero_roundings = 16.0;

/* Entries within this share of the largest tie for it, so that rounding does not choose the sign. */
static const double sign_tie = 1e-8;

/* Ascending eigenvalues and eigenvectors in place of a symmetric matrix of order m, leading dimension m. */
static sl_status eigen_in_place(sl_lanczos *s, int32_t m, double *M, double *values)
{
    const lapack_int work = 1 + 6 * m + 2 * m * m, int_work = 3 + 5 * m;
    const lapack_int info =
        LAPACKE_dsyevd_work(LAPACK_COL_MAJOR, 'V', 'L', m, M, m, values, s->lapack, work, s->lapack_int, int_work);
    return info == 0 ? SL_OK : SL_INTERNAL;
}

sl_status sl_lanczos_ritz(sl_lanczos *s)
{
    const int32_t m = s->size;
    for (int32_t k = 0; k < m; k++) {
        memcpy(s->S + (int64_t)k * m, s->T + (int64_t)k * s->max_basis, (size_t)m * sizeof *s->S);
    }
    const sl_status status = eigen_in_place(s, m, s->S, s->theta);
    for (int32_t k = 0; k < m / 2 && status == SL_OK; k++) {
        const double t = s->theta[k];
        s->theta[k] = s->theta[m - 1 - k];
        s->theta[m - 1 - k] = t;
        cblas_dswap(m, s->S + (int64_t)k * m, 1, s->S + (int64_t)(m - 1 - k) * m, 1);
    }
    return status;
}

double sl_lanczos_lambda(const sl_lanczos *s, double theta)
{
    return s->sigma + 1.0 / theta;
}

/* Z = M W for the next block W. */
static void multiply_next(sl_lanczos *s)
{
    const double *W = sl_lanczos_column(s, s->size);
    sl_csc_multiply_symmetric(s->A, W, s->block, s->Z);
    for (int64_t i = 0; i < (int64_t)s->n * s->block; i++) {
        s->Z[i] -= s->sigma * W[i];
    }
}

/* For a Ritz pair, OP v = theta v + W y with y = R (its last `block` coordinates), so A v - lambda v = -M W y / theta:
 * the Gram matrix of M W gives the norm of every residual. */
int32_t sl_lanczos_count_converged(sl_lanczos *s)
{
    const int32_t b = s->block, m = s->size;
    double y[SL_LANCZOS_MAX_BLOCK], Gy[SL_LANCZOS_MAX_BLOCK];
    multiply_next(s);
    cblas_dgemm(CblasColMajor, CblasTrans, CblasNoTrans, b, b, s->n, 1.0, s->Z, s->n, s->Z, s->n, 0.0, s->G, b);
    int32_t converged = 0;
    for (int32_t k = 0; k < s->wanted; k++) {
        memcpy(y, s->S + (int64_t)k * m + (m - b), (size_t)b * sizeof *y);
        cblas_dtrmv(CblasColMajor, CblasUpper, CblasNoTrans, CblasNonUnit, b, s->R, b, y, 1);
        cblas_dgemv(CblasColMajor, CblasNoTrans, b, b, 1.0, s->G, b, y, 1, 0.0, Gy, 1);
        const double squared = cblas_ddot(b, y, 1, Gy, 1);
        const double residual = sqrt(squared > 0.0 ? squared : 0.0) / fabs(s->theta[k]);
        converged += s->theta[k] > 0.0 && residual <= stop_share * s->tolerance * s->norm;
    }
    return converged;
}

void sl_lanczos_restart(sl_lanczos *s, int32_t kept)
{
    const int32_t m = s->size;
    sl_lanczos_rotate(s, sl_lanczos_column(s, 0), m, s->S, kept);
    memmove(sl_lanczos_column(s, kept), sl_lanczos_column(s, m), (size_t)s->n * (size_t)s->block * sizeof *s->Q);
    memset(s->T, 0, (size_t)s->max_basis * (size_t)s->max_basis * sizeof *s->T);
    for (int32_t k = 0; k < kept; k++) {
        s->T[(int64_t)k * s->max_basis + k] = s->theta[k];
    }
    s->size = kept;
}

/* Rotates X's computed columns to the eigenvectors of X'AX, lambda ascending. */
static sl_status rayleigh_ritz(sl_lanczos *s)
{
    const int32_t w = s->wanted, n = s->n;
    if (w == 0) {
        return SL_OK;
    }
    double *X = s->X + (int64_t)n * s->null_count, *lambda = s->lambda + s->null_count;
    for (int32_t c = 0; c < w; c += s->block) {
        const int32_t b = w - c < s->block ? w - c : s->block;
        sl_csc_multiply_symmetric(s->A, X + (int64_t)n * c, b, s->Z);
        cblas_dgemm(CblasColMajor, CblasTrans, CblasNoTrans, w, b, n, 1.0, X, n, s->Z, n, 0.0, s->G + (int64_t)w * c,
                    w);
    }
    const sl_status status = eigen_in_place(s, w, s->G, lambda);
    if (status == SL_OK) {
        sl_lanczos_rotate(s, X, w, s->G, w);
    }
    return status;
}

static void apply_sign_rule(int32_t n, double *x)
{
    double largest = 0.0;
    for (int32_t i = 0; i < n; i++) {
        largest = fmax(largest, fabs(x[i]));
    }
    for (int32_t i = 0; i < n; i++) {
        if (fabs(x[i]) >= (1.0 - sign_tie) * largest) {
            if (x[i] < 0.0) {
                cblas_dscal(n, -1.0, x, 1);
            }
            return;
        }
    }
}

/* The null space's pairs stand first with lambda = 0; a value that is negative beyond rounding goes before them. */
static void sort_pairs(sl_lanczos *s)
{
    for (int32_t k = 0; k < s->count; k++) {
        if (fabs(s->lambda[k]) <= zero_roundings * 0x1p-52 * s->norm) {
            s->lambda[k] = 0.0;
        }
        for (int32_t j = k; j > 0 && s->lambda[j] < s->lambda[j - 1]; j--) {
            const double t = s->lambda[j];
            s->lambda[j] = s->lambda[j - 1];
            s->lambda[j - 1] = t;
            cblas_dswap(s->n, s->X + (int64_t)s->n * j, 1, s->X + (int64_t)s->n * (j - 1), 1);
        }
    }
}

void sl_lanczos_finish_pairs(sl_lanczos *s)
{
    const int32_t n = s->n;
    sort_pairs(s);
    s->info.converged_count = 0;
    s->info.max_residual = 0.0;
    for (int32_t k = 0; k < s->count; k++) {
        double *x = s->X + (int64_t)n * k;
        apply_sign_rule(n, x);
        sl_csc_multiply_symmetric(s->A, x, 1, s->Z);
        cblas_daxpy(n, -s->lambda[k], x, 1, s->Z, 1);
        s->residual[k] = cblas_dnrm2(n, s->Z, 1) / s->norm;
        s->info.converged_count += s->residual[k] <= s->tolerance;
        s->info.max_residual = fmax(s->info.max_residual, s->residual[k]);
    }
    s->info.converged = s->finished && s->info.converged_count == s->count;
}

/* Puts the null space back in front of X, where sorting may have moved it. */
static void place_null_space(sl_lanczos *s)
{
    memcpy(s->X, s->Q, (size_t)s->n * (size_t)s->null_count * sizeof *s->X);
    memset(s->lambda, 0, (size_t)s->null_count * sizeof *s->lambda);
}

sl_status sl_lanczos_extract(sl_lanczos *s)
{
    place_null_space(s);
    memcpy(s->X + (int64_t)s->n * s->null_count, sl_lanczos_column(s, 0),
           (size_t)s->n * (size_t)s->wanted * sizeof *s->X);
    const sl_status status = rayleigh_ritz(s);
    if (status == SL_OK) {
        sl_lanczos_finish_pairs(s);
    }
    return status;
}

sl_status sl_lanczos_polish(sl_lanczos *s)
{
    double *X = s->X + (int64_t)s->n * s->null_count;
    place_null_space(s);
    memcpy(X, sl_lanczos_column(s, 0), (size_t)s->n * (size_t)s->wanted * sizeof *X);
    sl_cholesky_solve(s->factor, X, s->wanted, s->solve_work);
    s->info.solves += s->wanted;
    for (int32_t k = s->null_count; k < s->count; k++) {
        double *x = s->X + (int64_t)s->n * k;
        for (int pass = 0; pass < 2 && k > 0; pass++) {
            cblas_dgemv(CblasColMajor, CblasTrans, s->n, k, 1.0, s->X, s->n, x, 1, 0.0, s->H, 1);
            cblas_dgemv(CblasColMajor, CblasNoTrans, s->n, k, -1.0, s->X, s->n, s->H, 1, 1.0, x, 1);
        }
        cblas_dscal(s->n, 1.0 / cblas_dnrm2(s->n, x, 1), x, 1);
    }
    memcpy(sl_lanczos_column(s, 0), X, (size_t)s->n * (size_t)s->wanted * sizeof *X);
    const sl_status status = rayleigh_ritz(s);
    if (status == SL_OK) {
        sl_lanczos_finish_pairs(s);
    }
    return status;
}
