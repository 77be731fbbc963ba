/* Block inverse iteration with Rayleigh-Ritz steps. */
#include "eigen/lanczos_internal.h"

#include <math.h>

/* An eigenvalue of this many roundings of ||A|| is none: it is 0. */
static const double zero_roundings = 16.0;

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

void sl_lanczos_deflate(sl_lanczos *s, double *W, int32_t w)
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
    sl_cholesky_forward_part(s->factor, SL_PART_ALL, W, w, s->solve_work, s->context);
    sl_cholesky_backward_part(s->factor, SL_PART_ALL, W, w, s->solve_work, s->context);
    s->info.solves += w;
}

sl_status sl_lanczos_rayleigh_ritz(sl_lanczos *s)
{
    const sl_status status =
        sl_panels_rayleigh_ritz(&s->X, s->columns, &s->rows, s->norm, s->lambda, s->residual, s->context);
    s->have_pairs = s->have_pairs || status == SL_OK;
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
            sl_lanczos_deflate(s, sl_panel_at(&s->X, p), SL_PANEL);
        }
    }
    s->info.iterations++;
    SL_TRY(sl_lanczos_rayleigh_ritz(s));
cleanup:
    return status;
}
