/* Block inverse iteration with Rayleigh-Ritz steps. */
#include "base/memory.h"
#include "eigen/lanczos_internal.h"

#include <math.h>
#include <string.h>

/* An eigenvalue of this many roundings of ||A|| is none: it is 0. */
static const double zero_roundings = 16.0;

/* After the skeleton a step goes so much further than an inverse iteration: the errors left lie between 0 and 0.45 on
 * the scale of lambda / lambda_j, and |1 - relaxation (1 - lambda / lambda_j)| is least for all of them together. */
static const double relaxation = 1.3;

/* Panels whose residuals are all below this share of their bound are left alone. */
static const double locked_share = 0.3;

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

void sl_lanczos_deflate(sl_lanczos *s, double *W)
{
    for (int32_t k = 0; k < s->null_count; k++) {
        sl_panel_remove(s->n, s->N + (int64_t)k * s->n, W, s->context);
    }
}

void sl_lanczos_apply(sl_lanczos *s, double *W, int32_t w)
{
    sl_cholesky_forward_part(s->factor, SL_PART_ALL, W, w, s->solve_work, s->context);
    sl_cholesky_backward_part(s->factor, SL_PART_ALL, W, w, s->solve_work, s->context);
    s->info.solves += w;
}

sl_status sl_lanczos_rayleigh_ritz(sl_lanczos *s)
{
    sl_status status = SL_OK;
    if (s->rows.first == NULL) {
        SL_TRY(sl_rows_create(s->A, s->perm, &s->rows));
    }
    SL_TRY(sl_panels_rayleigh_ritz(&s->X, s->columns, &s->rows, s->norm, s->lambda, s->residual, s->context));
    s->have_pairs = true;
cleanup:
    return status;
}

/* X := (1 - relaxation) before + relaxation lambda X */
static void relax(const sl_lanczos *s, int32_t p, const double *before, double *X)
{
    const double *lambda = s->lambda + (int64_t)p * SL_PANEL;
    for (int64_t i = 0; i < s->n; i++) {
        for (int32_t c = 0; c < SL_PANEL; c++) {
            const int64_t at = i * SL_PANEL + c;
            X[at] = (1.0 - relaxation) * before[at] + relaxation * lambda[c] * X[at];
        }
    }
}

sl_status sl_lanczos_iterate(sl_lanczos *s)
{
    sl_status status = SL_OK;
    const size_t bytes = (size_t)s->n * SL_PANEL * sizeof(double);
    double *before = s->krylov_tried ? NULL : sl_alloc((int64_t)s->n * SL_PANEL, sizeof *before);
    SL_TRY(s->krylov_tried || before != NULL ? SL_OK : SL_OUT_OF_MEMORY);
    const int32_t panels = sl_panel_count(s->columns);
    for (int32_t p = 0; p < panels; p++) {
        bool locked = (p + 1) * SL_PANEL <= s->needed;
        for (int32_t k = p * SL_PANEL; k < (p + 1) * SL_PANEL && locked; k++) {
            locked = s->residual[k] <= locked_share * sl_lanczos_bound(s, s->lambda[k]);
        }
        SL_TRY(sl_report_progress(s->context, "eigenvectors", (double)p / panels));
        double *X = sl_panel_at(&s->X, p);
        if (before != NULL && !locked) {
            memcpy(before, X, bytes);
        }
        if (!locked) {
            sl_lanczos_apply(s, X, SL_PANEL);
            sl_lanczos_deflate(s, X);
        }
        if (before != NULL && !locked) {
            relax(s, p, before, X);
        }
    }
    s->info.iterations++;
    sl_free(before);
    before = NULL;
    SL_TRY(sl_lanczos_rayleigh_ritz(s));
cleanup:
    sl_free(before);
    return status;
}
