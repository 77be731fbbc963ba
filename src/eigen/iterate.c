/* Block inverse iteration with Rayleigh-Ritz steps. */
#include "base/memory.h"
#include "eigen/lanczos_internal.h"

#include <math.h>
#include <string.h>

/* An eigenvalue of this many roundings of ||A|| is none: it is 0. */
static const double zero_roundings = 16.0;

/* After the skeleton, steps x := x - omega (x - lambda inv(A) x) go together: with omega = 1 / (1 - r) for the roots r
 * of the Chebyshev polynomial of [0, reach], errors at lambda / lambda_j within it fall as fast as they can. What lies
 * beyond is little, by the correction on the skeleton. Measured: k steps gain about gain_share T_k(2 / reach - 1). */
static const double reach = 0.5, gain_share = 1.8;

enum { MOST_STEPS = 6 };

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

/* Steps that should bring the worst residual, so many times what is allowed, below it. */
static int32_t steps_for(double worst)
{
    const double x = 2.0 / reach - 1.0;
    double before = 1.0, value = x;
    int32_t steps = 1;
    while (gain_share * value < worst && steps < MOST_STEPS) {
        const double next = 2.0 * x * value - before;
        before = value;
        value = next;
        steps++;
    }
    return steps;
}

/* X := (1 - omega) before + omega (lambda - sigma) X */
static void relax(const sl_lanczos *s, int32_t p, double omega, const double *before, double *X)
{
    const double *lambda = s->lambda + (int64_t)p * SL_PANEL;
    for (int64_t i = 0; i < s->n; i++) {
        for (int32_t c = 0; c < SL_PANEL; c++) {
            const int64_t at = i * SL_PANEL + c;
            X[at] = (1.0 - omega) * before[at] + omega * (lambda[c] - s->sigma) * X[at];
        }
    }
}

/* All steps of panel p. before: n x 8. */
static void polish(sl_lanczos *s, int32_t p, int32_t steps, double *before)
{
    const double pi = 3.14159265358979323846;
    double *X = sl_panel_at(&s->X, p);
    for (int32_t k = 0; k < steps; k++) {
        const double root = 0.5 * reach * (1.0 + cos(pi * (k + 0.5) / steps));
        memcpy(before, X, (size_t)s->n * SL_PANEL * sizeof *X);
        sl_lanczos_apply(s, X, SL_PANEL);
        relax(s, p, 1.0 / (1.0 - root), before, X);
        sl_lanczos_deflate(s, X);
    }
}

sl_status sl_lanczos_iterate(sl_lanczos *s)
{
    sl_status status = SL_OK;
    const int32_t panels = sl_panel_count(s->columns), steps = steps_for(sl_lanczos_worst(s));
    double *before = s->krylov_tried ? NULL : sl_alloc((int64_t)s->n * SL_PANEL, sizeof *before);
    SL_TRY(s->krylov_tried || before != NULL ? SL_OK : SL_OUT_OF_MEMORY);
    for (int32_t p = 0; p < panels; p++) {
        bool locked = (p + 1) * SL_PANEL <= s->needed;
        for (int32_t k = p * SL_PANEL; k < (p + 1) * SL_PANEL && locked; k++) {
            locked = s->residual[k] <= locked_share * sl_lanczos_bound(s, s->lambda[k]);
        }
        SL_TRY(sl_report_progress(s->context, "eigenvectors", (double)p / panels));
        if (locked) {
            continue;
        }
        if (before != NULL) {
            polish(s, p, steps, before);
        } else {
            sl_lanczos_apply(s, sl_panel_at(&s->X, p), SL_PANEL);
            sl_lanczos_deflate(s, sl_panel_at(&s->X, p));
        }
    }
    s->info.iterations += before != NULL ? steps : 1;
    sl_free(before);
    before = NULL;
    SL_TRY(sl_lanczos_rayleigh_ritz(s));
cleanup:
    sl_free(before);
    return status;
}
