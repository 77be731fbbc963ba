/* Block Lanczos on the whole matrix. */
#include "base/memory.h"
#include "eigen/lanczos_internal.h"

#include <math.h>

/* Estimates stop at this share of the bound: recomputed residuals then meet it with room for rounding. */
static const double stop_share = 0.5;

/* The null space is the basis's fixed part: its sweeps take it out. */
static void apply_inverse(void *user, double *W, int32_t w)
{
    sl_lanczos_apply(user, W, w);
}

sl_status sl_lanczos_begin_plain(sl_lanczos *s)
{
    sl_status status = SL_OK;
    sl_krylov_clear(&s->krylov);
    s->krylov_live = false;
    SL_TRY(sl_krylov_init(s->n, s->null_count, s->block, s->max_basis, s->def.seed, s->context, &s->krylov));
    for (int32_t c = 0; c < s->null_count; c++) {
        sl_panels_store(&s->krylov.Q, c, s->N + (int64_t)c * s->n, 1);
    }
    s->krylov.apply = apply_inverse;
    s->krylov.user = s;
    sl_krylov_random(&s->krylov);
    s->krylov_live = true;
cleanup:
    if (status != SL_OK) {
        sl_krylov_clear(&s->krylov);
    }
    return status;
}

/* Largest estimated residual over its bound. For OP x = theta x + P y the vector OP x / theta, which is what is
 * delivered, has A v - lambda v = -P y / theta^2. */
static double estimate_worst(const sl_lanczos *s)
{
    const sl_krylov *b = &s->krylov;
    double worst = 0.0;
    for (int32_t j = 0; j < s->wanted; j++) {
        if (j >= b->found || !(b->theta[j] > 0.0)) {
            return INFINITY;
        }
        const double lambda = s->sigma + 1.0 / b->theta[j];
        const double residual = b->last[j] / (b->theta[j] * b->theta[j]);
        worst = fmax(worst, residual / (stop_share * sl_lanczos_bound(s, fmax(lambda, 0.0))));
    }
    return worst;
}

/* X := the leading Ritz vectors. The basis makes way for them, or stays for more. */
static sl_status take_vectors(sl_lanczos *s, bool basis_stays)
{
    sl_status status = SL_OK;
    SL_TRY(sl_krylov_vectors(&s->krylov, s->columns, s->columns, basis_stays ? &s->X : NULL));
    if (!basis_stays) {
        sl_panels_clear(&s->X);
        SL_TRY(sl_panels_take(&s->krylov.Q, s->columns, &s->X));
        sl_krylov_clear(&s->krylov);
        s->krylov_live = false;
    }
    for (int32_t p = 0; p < sl_panel_count(s->columns); p++) { /* the last block was projected once only */
        sl_lanczos_deflate(s, sl_panel_at(&s->X, p));
    }
    SL_TRY(sl_lanczos_rayleigh_ritz(s));
cleanup:
    return status;
}

static sl_status restart(sl_lanczos *s)
{
    sl_krylov *b = &s->krylov;
    sl_status status = SL_OK;
    const int32_t beyond = s->wanted / 2 > s->block ? s->wanted / 2 : s->block;
    int32_t kept = s->wanted + beyond;
    kept = kept < s->max_basis - 2 * s->block ? kept : s->max_basis - 2 * s->block;
    SL_TRY(sl_krylov_ritz(b, kept > s->columns ? kept : s->columns));
    if (s->X.data == NULL) {
        SL_TRY(sl_panels_create(s->n, s->columns, &s->X));
    }
    SL_TRY(take_vectors(s, true));
    SL_TRY(sl_krylov_restart(b, kept < b->found ? kept : b->found));
    s->info.restarts++;
cleanup:
    return status;
}

sl_status sl_lanczos_fill(sl_lanczos *s)
{
    sl_krylov *b = &s->krylov;
    sl_status status = SL_OK;
    const int32_t first = 2 * s->wanted + 4 * s->block, least = s->columns + s->block;
    sl_krylov_watch watch = {.look = first > least ? first : least, .worst = INFINITY};
    if (!s->krylov_live) {
        SL_TRY(sl_lanczos_begin_plain(s));
    }
    while (watch.worst > 1.0 && b->applied + b->w <= b->max_basis) {
        SL_TRY(sl_report_progress(s->context, "eigenvectors", (double)b->applied / b->max_basis));
        sl_krylov_expand(b);
        if (sl_krylov_looks(b, &watch)) {
            SL_TRY(sl_krylov_ritz(b, s->columns));
            sl_krylov_seen(b, &watch, estimate_worst(s));
        }
    }
    if (watch.worst > 1.0) {
        SL_TRY(restart(s));
    } else {
        SL_TRY(take_vectors(s, false));
        s->stage = sl_lanczos_worst(s) <= 1.0 ? SL_STAGE_CERTIFY : SL_STAGE_ITERATE;
    }
cleanup:
    return status;
}
