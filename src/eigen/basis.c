#include "eigen/lanczos_internal.h"

#include <cblas.h>
#include <string.h>

/* A vector that keeps less than this share of its length under orthogonalisation lies in the span already: what is left
 * is rounding. It is far below any tolerance asked for. */
static const double dependent_share = 1e-11;

/* A vector that keeps less than this share of its length within its block is projected again. */
static const double kept_share = 0.5;

static const int32_t rotation_rows = 256;

double *sl_lanczos_column(const sl_lanczos *s, int32_t k)
{
    return s->Q + (int64_t)s->n * (s->null_count + k);
}

/* W -= Q (Q' W) over the first `columns` columns of Q; H = Q' W, columns x width. */
static void project_out(const sl_lanczos *s, int32_t columns, double *W, int32_t width, double *H)
{
    if (columns == 0) {
        return;
    }
    cblas_dgemm(CblasColMajor, CblasTrans, CblasNoTrans, columns, width, s->n, 1.0, s->Q, s->n, W, s->n, 0.0, H,
                columns);
    cblas_dgemm(CblasColMajor, CblasNoTrans, CblasNoTrans, s->n, width, columns, -1.0, s->Q, s->n, H, columns, 1.0, W,
                s->n);
}

/* Fills w with random numbers and makes it a unit vector orthogonal to the first `columns` columns of Q. Three passes:
 * each wins the digits the one before lost. */
static void random_unit(sl_lanczos *s, int32_t columns, double *w)
{
    for (int32_t i = 0; i < s->n; i++) {
        w[i] = 2.0 * sl_rng_uniform(&s->rng) - 1.0;
    }
    double *H = s->H + (int64_t)(s->null_count + s->max_basis + s->block) * s->block;
    for (int pass = 0; pass < 3; pass++) {
        project_out(s, columns, w, 1, H);
        cblas_dscal(s->n, 1.0 / cblas_dnrm2(s->n, w, 1), w, 1);
    }
}

void sl_lanczos_random_block(sl_lanczos *s)
{
    for (int32_t c = 0; c < s->block; c++) {
        random_unit(s, s->null_count + s->size + c, sl_lanczos_column(s, s->size + c));
    }
}

/* w, column c of the block at `at`, made orthogonal to the columns of the block before it; their shares go to r. */
static void orthogonalise_within(sl_lanczos *s, int32_t at, int32_t c, double *w, double *r)
{
    const double *W = sl_lanczos_column(s, at);
    for (int pass = 0; pass < 2 && c > 0; pass++) {
        cblas_dgemv(CblasColMajor, CblasTrans, s->n, c, 1.0, W, s->n, w, 1, 0.0, s->H, 1);
        cblas_dgemv(CblasColMajor, CblasNoTrans, s->n, c, -1.0, W, s->n, s->H, 1, 1.0, w, 1);
        cblas_daxpy(c, 1.0, s->H, 1, r, 1);
    }
}

/* Makes the block at column `at` (orthogonal to all before it) orthonormal: W = W_new R. length: the columns' norms
 * before they were projected. Columns that depend on the others are replaced by random ones, with zeros in R. */
static void orthonormalise_block(sl_lanczos *s, int32_t at, const double *length)
{
    const int32_t b = s->block;
    memset(s->R, 0, (size_t)b * (size_t)b * sizeof *s->R);
    for (int32_t c = 0; c < b; c++) {
        double *w = sl_lanczos_column(s, at + c), *r = s->R + (int64_t)c * b;
        const double before = cblas_dnrm2(s->n, w, 1);
        orthogonalise_within(s, at, c, w, r);
        const double left = cblas_dnrm2(s->n, w, 1);
        if (!(left > dependent_share * length[c])) {
            random_unit(s, s->null_count + at + c, w);
            continue;
        }
        r[c] = left;
        cblas_dscal(s->n, 1.0 / left, w, 1);
        if (left < kept_share * before) { /* what shrank has lost its right angle to the basis */
            project_out(s, s->null_count + at + c, w, 1, s->H);
            cblas_dscal(s->n, 1.0 / cblas_dnrm2(s->n, w, 1), w, 1);
        }
    }
}

/* T's columns of the block just multiplied: H is Q' OP W with the null space's rows on top. */
static void store_projection(sl_lanczos *s, const double *H, int32_t columns)
{
    const int64_t ld = s->max_basis;
    for (int32_t c = 0; c < s->block; c++) {
        const int32_t j = s->size + c;
        for (int32_t i = 0; i < s->size + s->block; i++) {
            const double h = H[(int64_t)c * columns + s->null_count + i];
            s->T[j * ld + i] = h;
            if (i < s->size) {
                s->T[i * ld + j] = h;
            }
        }
    }
    for (int32_t c = 0; c < s->block; c++) { /* symmetric up to rounding: made so */
        for (int32_t i = 0; i < c; i++) {
            double *a = &s->T[(s->size + c) * ld + s->size + i], *b = &s->T[(s->size + i) * ld + s->size + c];
            *a = *b = 0.5 * (*a + *b);
        }
    }
}

void sl_lanczos_expand(sl_lanczos *s)
{
    const int32_t b = s->block, next = s->size + b, columns = s->null_count + next;
    double *W = sl_lanczos_column(s, next), *H = s->H, *again = s->H + (int64_t)columns * b;
    double length[SL_LANCZOS_MAX_BLOCK];
    memcpy(W, sl_lanczos_column(s, s->size), (size_t)s->n * (size_t)b * sizeof *W);
    sl_cholesky_solve(s->factor, W, b, s->solve_work);
    s->info.solves += b;
    for (int32_t c = 0; c < b; c++) {
        length[c] = cblas_dnrm2(s->n, W + (int64_t)c * s->n, 1);
    }
    project_out(s, columns, W, b, H);
    project_out(s, columns, W, b, again);
    cblas_daxpy(columns * b, 1.0, again, 1, H, 1);
    store_projection(s, H, columns);
    orthonormalise_block(s, next, length);
    s->size = next;
}

void sl_lanczos_rotate(sl_lanczos *s, double *V, int32_t columns, const double *S, int32_t kept)
{
    for (int32_t row = 0; row < s->n; row += rotation_rows) {
        const int32_t rows = s->n - row < rotation_rows ? s->n - row : rotation_rows;
        for (int32_t k = 0; k < columns; k++) {
            memcpy(s->chunk + (int64_t)k * rows, V + (int64_t)k * s->n + row, (size_t)rows * sizeof *V);
        }
        cblas_dgemm(CblasColMajor, CblasNoTrans, CblasNoTrans, rows, kept, columns, 1.0, s->chunk, rows, S, columns,
                    0.0, V + row, s->n);
    }
}

int64_t sl_lanczos_rotation_work(const sl_lanczos *s)
{
    return (int64_t)rotation_rows * s->max_basis;
}
