/* Block Lanczos on the whole matrix. */
#include "base/memory.h"
#include "eigen/lanczos_internal.h"

#include <math.h>

/* Estimates stop at this share of the bound: recomputed residuals then meet it with room for rounding. */
static const double stop_share = 0.5;

/* With a single basis an inverse iteration follows, which takes them down by more than this; measured: 5 to 8. */
static const double single_share = 2.5;

/* Largest ratio of inverse eigenvalues that single precision is used for. */
static const double single_spread = 1e4;

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
    SL_TRY(
        sl_krylov_init(s->n, s->null_count, s->block, s->max_basis, s->precision, s->def.seed, s->context, &s->krylov));
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
    const double share = s->precision == SL_SINGLE ? single_share : stop_share;
    for (int32_t j = 0; j < s->wanted; j++) {
        if (j >= b->found || !(b->theta[j] > 0.0)) {
            return INFINITY;
        }
        const double lambda = s->sigma + 1.0 / b->theta[j];
        const double residual = b->last[j] / (b->theta[j] * b->theta[j]);
        worst = fmax(worst, residual / (share * sl_lanczos_bound(s, fmax(lambda, 0.0))));
    }
    return worst;
}

/* X := the leading Ritz vectors, in the basis's own memory, which is spent. */
static sl_status make_vectors(sl_lanczos *s)
{
    sl_panels narrow = {.rows = 0};
    sl_status status = SL_OK;
    sl_panels_clear(&s->X);
    SL_TRY(sl_krylov_vectors(&s->krylov, s->columns, s->columns, NULL));
    SL_TRY(sl_panels_take(&s->krylov.Q, s->columns, s->precision == SL_SINGLE ? &narrow : &s->X));
    sl_krylov_clear(&s->krylov);
    s->krylov_live = false;
    if (s->precision == SL_SINGLE) {
        SL_TRY(sl_panels_create(s->n, s->columns, SL_DOUBLE, &s->X));
        for (int32_t k = 0; k < s->columns; k += SL_PANEL) {
            sl_panels_load(&narrow, k, sl_panel_at(&s->X, k / SL_PANEL), SL_PANEL);
        }
    }
cleanup:
    sl_panels_clear(&narrow);
    return status;
}

/* What rounding left in vectors of single precision an inverse iteration takes out. */
static void clean_vectors(sl_lanczos *s)
{
    for (int32_t p = 0; p < sl_panel_count(s->columns); p++) {
        sl_lanczos_deflate(s, sl_panel_at(&s->X, p));
        sl_lanczos_apply(s, sl_panel_at(&s->X, p), SL_PANEL);
    }
    s->info.iterations++;
}

/* X := the leading Ritz vectors. The basis makes way for them, or stays for more. */
static sl_status take_vectors(sl_lanczos *s, bool basis_stays)
{
    sl_status status = SL_OK;
    if (basis_stays) {
        SL_TRY(sl_krylov_vectors(&s->krylov, s->columns, s->columns, &s->X));
    } else {
        SL_TRY(make_vectors(s));
        if (s->precision == SL_SINGLE) {
            clean_vectors(s);
        }
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
        SL_TRY(sl_panels_create(s->n, s->columns, SL_DOUBLE, &s->X));
    }
    SL_TRY(take_vectors(s, true));
    SL_TRY(sl_krylov_restart(b, kept < b->found ? kept : b->found));
    s->info.restarts++;
cleanup:
    return status;
}

/* Roundings of the largest values drown the smallest ones wanted. */
static bool drowns(const sl_lanczos *s)
{
    const sl_krylov *b = &s->krylov;
    return s->precision == SL_SINGLE && b->found >= s->wanted &&
           !(b->theta[0] < single_spread * b->theta[s->wanted - 1]);
}

/* The filling begins anew: a basis of single precision is not worth a restart, which its roundings would go
 * through again and again. */
static void begin_double(sl_lanczos *s)
{
    sl_krylov_clear(&s->krylov);
    s->krylov_live = false;
    s->precision = SL_DOUBLE;
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
            if (drowns(s)) {
                break;
            }
            sl_krylov_seen(b, &watch, estimate_worst(s));
        }
    }
    if (watch.worst > 1.0 && s->precision == SL_SINGLE) {
        begin_double(s);
        return sl_lanczos_fill(s);
    } else if (watch.worst > 1.0) {
        SL_TRY(restart(s));
    } else {
        SL_TRY(take_vectors(s, false));
        s->stage = sl_lanczos_worst(s) <= 1.0 ? SL_STAGE_CERTIFY : SL_STAGE_ITERATE;
    }
cleanup:
    return status;
}
