/* Block inverse iteration with Rayleigh-Ritz steps. */
#include "base/memory.h"
#include "eigen/lanczos_internal.h"

#include <math.h>
#include <string.h>

/* An eigenvalue of this many roundings of ||A|| is none: it is 0. */
static const double zero_roundings = 16.0;

/* Panels whose residuals are all below this share of their bound are left alone. */
static const double locked_share = 0.3;

/* Added to a Gram matrix of unit vectors that is not positive definite to rounding. */
static const double gram_shift = 1e-13;

double sl_lanczos_bound(const sl_lanczos *s, double lambda)
{
    const double absolute = s->def.tolerance * s->norm;
    if (s->def.mode == SL_LANCZOS_TOLERANCE) {
        return absolute;
    }
    /* lambda may be a zero whose relative residual means nothing; a tolerance still binds it */
    return lambda > zero_roundings * 0x1p-52 * s->norm * s->n ? s->def.sign_tolerance * lambda : absolute;
}

double sl_lanczos_worst(const sl_lanczos *s)
{
    double worst = 0.0;
    for (int32_t k = 0; k < s->needed; k++) {
        worst = fmax(worst, s->residual[k] / sl_lanczos_bound(s, s->lambda[k]));
    }
    return worst;
}

static void deflate(sl_lanczos *s, double *W, int32_t w)
{
    double G[SL_PANEL * SL_PANEL];
    const sl_panel_pair single = {w, {W, NULL}, {s->H, NULL}};
    if (s->null_count > 0) {
        sl_panels_project(&s->N, s->null_count, &single, s->partial, s->context);
        sl_panels_subtract(&s->N, s->null_count, &single, s->partial, G, s->context);
    }
}

void sl_lanczos_apply(sl_lanczos *s, double *W, int32_t w)
{
    deflate(s, W, w);
    sl_cholesky_forward_part(s->factor, SL_PART_ALL, W, w, s->solve_work, s->context);
    sl_cholesky_backward_part(s->factor, SL_PART_ALL, W, w, s->solve_work, s->context);
    deflate(s, W, w);
    s->info.solves += w;
}

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

sl_status sl_lanczos_rayleigh_ritz(sl_lanczos *s)
{
    const int32_t m = s->columns;
    sl_status status = SL_OK;
    double *XX = sl_alloc(2 * (int64_t)m * m + m, sizeof *XX);
    SL_TRY(XX != NULL ? SL_OK : SL_OUT_OF_MEMORY);
    double *XAX = XX + (int64_t)m * m, *scale = XAX + (int64_t)m * m;
    SL_TRY(sl_panels_grams(&s->X, m, &s->rows, XX, XAX, s->context));
    scale_grams(m, XX, XAX, scale);
    SL_TRY(solve_pencil(m, XX, XAX, s->lambda));
    for (int32_t k = 0; k < m; k++) {
        for (int32_t i = 0; i < m; i++) {
            XAX[(int64_t)k * m + i] *= scale[i];
        }
        if (fabs(s->lambda[k]) <= zero_roundings * 0x1p-52 * s->norm) {
            s->lambda[k] = 0.0;
        }
    }
    SL_TRY(sl_panels_rotate(&s->X, m, XAX, m, NULL, s->context));
    SL_TRY(sl_panels_residuals(&s->X, m, &s->rows, s->lambda, s->residual, s->context));
    s->have_pairs = true;
cleanup:
    sl_free(XX);
    return status;
}

sl_status sl_lanczos_iterate(sl_lanczos *s)
{
    sl_status status = SL_OK;
    const int32_t panels = sl_panel_count(s->columns);
    for (int32_t p = 0; p < panels; p++) {
        bool locked = (p + 1) * SL_PANEL <= s->needed;
        for (int32_t k = p * SL_PANEL; k < (p + 1) * SL_PANEL && locked; k++) {
            locked = s->residual[k] <= locked_share * sl_lanczos_bound(s, s->lambda[k]);
        }
        SL_TRY(sl_report_progress(s->context, "eigenvectors", (double)p / panels));
        if (!locked) {
            sl_lanczos_apply(s, sl_panel_at(&s->X, p), SL_PANEL);
        }
    }
    s->info.iterations++;
    SL_TRY(sl_lanczos_rayleigh_ritz(s));
cleanup:
    return status;
}
