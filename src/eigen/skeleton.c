/* Lanczos on the separators. Static condensation of the patches leaves S x_t = lambda D x_t for the Schur complement S
 * and the condensed mass I + T'T lumped to its row sums D; recover.c makes good what that neglects. Source: Guyan 1965
 * (static condensation). Deviation: lumped mass. */
#include "eigen/skeleton.h"

#include "base/memory.h"

#include <math.h>
#include <string.h>

/* Ritz pairs of the skeleton go on to the whole matrix when ||OP x - theta x|| is below a share of theta: half of what
 * the mode allows ||A v - lambda v|| / lambda, for one inverse iteration hands such an error on nearly undiminished,
 * but between these, where the condensation's own error rules. */
static const double least_tolerance = 5e-5, most_tolerance = 2e-3, tolerance_share = 0.5;

/* A null vector that has less than this length on the separators is left out: a component inside one patch. */
static const double least_null_length = 1e-8;

enum { MAX_FILLINGS = 5 };

/* W := D^(1/2) W */
static void scale_rows(const sl_skeleton *k, double *W, int32_t w)
{
    for (int64_t i = 0; i < k->rows; i++) {
        for (int32_t c = 0; c < w; c++) {
            W[i * w + c] *= k->root[i];
        }
    }
}

/* W := D^(1/2) inv(S) D^(1/2) W */
static void apply_skeleton(void *user, double *W, int32_t w)
{
    const sl_skeleton *k = user;
    sl_lanczos *s = k->s;
    scale_rows(k, W, w);
    sl_cholesky_forward_part(s->factor, SL_PART_TOP, W, w, s->solve_work, s->context);
    sl_cholesky_backward_part(s->factor, SL_PART_TOP, W, w, s->solve_work, s->context);
    scale_rows(k, W, w);
    s->info.skeleton_solves += w;
}

/* D = (I + T'T) 1 and E = T' inv(A_bb) T 1, both as if T 1 = 1. False unless D is positive. */
static bool condense_masses(sl_skeleton *k)
{
    const sl_lanczos *s = k->s;
    double *top = k->column + k->first;
    for (int32_t i = 0; i < s->n; i++) {
        k->column[i] = 1.0;
    }
    sl_cholesky_forward_part(s->factor, SL_PART_BOTTOM, k->column, 1, s->solve_work, s->context);
    for (int32_t i = 0; i < k->rows; i++) {
        if (!(top[i] > 0.0 && isfinite(top[i]))) {
            return false;
        }
        k->root[i] = sqrt(top[i]);
    }
    memset(top, 0, (size_t)k->rows * sizeof *top);
    sl_cholesky_backward_part(s->factor, SL_PART_BOTTOM, k->column, 1, s->solve_work, s->context); /* inv(A_bb) 1 */
    sl_cholesky_forward_part(s->factor, SL_PART_BOTTOM, k->column, 1, s->solve_work, s->context);
    memcpy(k->second, top, (size_t)k->rows * sizeof *top);
    return true;
}

/* The null space's share in the skeleton, D^(1/2) N_t made orthonormal, as the basis's fixed columns. u: rows. */
static void fix_null_space(sl_skeleton *k, double *u)
{
    sl_krylov *b = &k->krylov;
    double *v = k->column;
    b->fixed = 0;
    for (int32_t c = 0; c < k->s->null_count; c++) {
        const double *from = k->s->N + (int64_t)c * k->s->n + k->first;
        for (int32_t i = 0; i < k->rows; i++) {
            v[i] = from[i] * k->root[i];
        }
        double length = 0.0;
        for (int pass = 0; pass < 2; pass++) {
            for (int32_t j = 0; j < b->fixed; j++) {
                double dot = 0.0;
                sl_panels_load(&b->Q, j, u, 1);
                for (int32_t i = 0; i < k->rows; i++) {
                    dot += u[i] * v[i];
                }
                for (int32_t i = 0; i < k->rows; i++) {
                    v[i] -= dot * u[i];
                }
            }
        }
        for (int32_t i = 0; i < k->rows; i++) {
            length += v[i] * v[i];
        }
        length = sqrt(length);
        for (int32_t i = 0; i < k->rows && length > least_null_length; i++) {
            v[i] /= length;
        }
        if (length > least_null_length) {
            sl_panels_store(&b->Q, b->fixed++, v, 1);
        }
    }
}

/* Largest estimated error over what is allowed: at most 1 when all have converged. */
static double worst_error(const sl_skeleton *k)
{
    const sl_krylov *b = &k->krylov;
    double worst = 0.0;
    if (b->found < k->s->columns || !(b->theta[b->found - 1] > 0.0)) {
        return INFINITY;
    }
    for (int32_t j = 0; j < k->s->wanted; j++) {
        const double lambda = 1.0 / b->theta[j];
        const double share = tolerance_share * sl_lanczos_bound(k->s, lambda) / lambda;
        const double tolerance = fmax(least_tolerance, fmin(most_tolerance, share));
        worst = fmax(worst, b->last[j] / (tolerance * b->theta[j]));
    }
    return worst;
}

static sl_status run_krylov(sl_skeleton *k, bool *converged)
{
    sl_krylov *b = &k->krylov;
    const sl_lanczos *s = k->s;
    sl_status status = SL_OK;
    sl_krylov_watch watch = {.look = s->columns + s->wanted + 3 * b->block};
    *converged = false;
    sl_krylov_random(b);
    for (int32_t filling = 0; filling < MAX_FILLINGS && !*converged; filling++) {
        while (!*converged && b->applied + b->w <= b->max_basis) {
            SL_TRY(sl_report_progress(s->context, "separators", (double)b->applied / b->max_basis));
            sl_krylov_expand(b);
            if (sl_krylov_looks(b, &watch)) {
                SL_TRY(sl_krylov_ritz(b, s->columns));
                sl_krylov_seen(b, &watch, worst_error(k));
                *converged = watch.worst <= 1.0;
            }
        }
        if (!*converged) {
            SL_TRY(sl_krylov_restart(b, b->found));
            watch = (sl_krylov_watch){.look = b->applied + 4 * b->block};
        }
    }
cleanup:
    return status;
}

/* The Ritz pairs of the skeleton. *usable = false when there are none. */
static sl_status find_modes(sl_skeleton *k, bool *usable)
{
    sl_lanczos *s = k->s;
    sl_status status = SL_OK;
    double *spare = NULL;
    k->root = sl_alloc(k->rows, sizeof *k->root);
    k->second = sl_alloc(k->rows, sizeof *k->second);
    k->column = sl_alloc(s->n, sizeof *k->column);
    spare = sl_alloc(k->rows, sizeof *spare);
    SL_TRY(k->root != NULL && k->second != NULL && k->column != NULL && spare != NULL ? SL_OK : SL_OUT_OF_MEMORY);
    SL_TRY(
        sl_krylov_init(k->rows, s->null_count, SL_PANEL, s->max_basis, SL_SINGLE, s->def.seed, s->context, &k->krylov));
    *usable = condense_masses(k);
    if (*usable) {
        fix_null_space(k, spare);
        k->krylov.apply = apply_skeleton;
        k->krylov.user = k;
        SL_TRY(run_krylov(k, usable));
    }
cleanup:
    sl_free(spare);
    sl_free(k->column);
    k->column = NULL;
    return status;
}

static void clear(sl_skeleton *k)
{
    sl_krylov_clear(&k->krylov);
    sl_panels_clear(&k->U);
    sl_free(k->root);
    sl_free(k->second);
    sl_free(k->column);
    sl_free(k->response);
    sl_free(k->theta);
    sl_free(k->partial);
    sl_free(k->H);
}

sl_status sl_lanczos_skeleton(sl_lanczos *s, bool *usable)
{
    const int32_t panels = sl_panel_count(s->columns);
    sl_skeleton k = {.s = s, .first = sl_cholesky_top_first(s->factor), .modes = s->columns + SL_MODES_BEYOND};
    sl_status status = SL_OK;
    k.rows = s->n - k.first;
    *usable = k.first > 0 && (int64_t)k.rows > (int64_t)s->max_basis + 2 * SL_PANEL + s->null_count;
    if (!*usable) {
        return SL_OK;
    }
    SL_TRY(find_modes(&k, usable));
    if (*usable) {
        SL_TRY(sl_skeleton_take_modes(&k));
        SL_TRY(sl_panels_create(s->n, s->columns, SL_DOUBLE, &s->X));
        for (int32_t p = 0; p < panels; p++) {
            SL_TRY(sl_report_progress(s->context, "patches", (double)p / panels));
            sl_skeleton_recover(&k, p);
            sl_lanczos_deflate(s, sl_panel_at(&s->X, p));
            sl_lanczos_apply(s, sl_panel_at(&s->X, p), SL_PANEL);
            sl_lanczos_deflate(s, sl_panel_at(&s->X, p));
        }
        clear(&k);
        k = (sl_skeleton){.s = s};
        s->info.iterations++;
        SL_TRY(sl_lanczos_rayleigh_ritz(s));
    }
cleanup:
    clear(&k);
    return status;
}
