/* Lanczos on the separators. Static condensation of the patches turns A x = lambda x into S x_t = lambda D x_t for the
 * Schur complement S and the condensed mass I + T'T, T = -inv(A_bb) A_bt, lumped to its row sums D; the patches follow
 * by x_b = T x_t + lambda inv(A_bb) T x_t, the first two terms of their response at lambda. Source: Guyan 1965 (static
 * condensation), Hurty 1965 (patches by their boundaries). Deviation: lumped mass; the second term instead of the
 * patches' own modes. */
#include "base/memory.h"
#include "eigen/lanczos_internal.h"

#include <math.h>
#include <string.h>

/* Ritz pairs of the skeleton go on to the whole matrix when ||OP x - theta x|| is below a share of theta: half of what
 * the mode allows ||A v - lambda v|| / lambda, for one inverse iteration hands such an error on nearly undiminished,
 * but between these, where the condensation's own error rules. */
static const double least_tolerance = 1e-4, most_tolerance = 2e-3, tolerance_share = 0.5;

/* A null vector that has less than this length on the separators is left out: a component inside one patch. */
static const double least_null_length = 1e-8;

enum { MAX_FILLINGS = 5 };

typedef struct skeleton {
    sl_lanczos *s;
    int32_t first, rows; /* of the top part */
    double *root;        /* D^(1/2) */
    double *column;      /* n */
    double *response;    /* n x 8 */
    sl_krylov krylov;
} skeleton;

/* W := D^(1/2) inv(S) D^(1/2) W */
static void apply_skeleton(void *user, double *W, int32_t w)
{
    skeleton *k = user;
    sl_lanczos *s = k->s;
    for (int pass = 0; pass < 2; pass++) {
        for (int64_t i = 0; i < k->rows; i++) {
            for (int32_t c = 0; c < w; c++) {
                W[i * w + c] *= k->root[i];
            }
        }
        if (pass == 0) {
            sl_cholesky_forward_part(s->factor, SL_PART_TOP, W, w, s->solve_work, s->context);
            sl_cholesky_backward_part(s->factor, SL_PART_TOP, W, w, s->solve_work, s->context);
        }
    }
    s->info.skeleton_solves += w;
}

/* D = 1 + T' 1, by eliminating the patches from a vector of ones. False unless positive. */
static bool condense_mass(skeleton *k)
{
    sl_lanczos *s = k->s;
    for (int32_t i = 0; i < s->n; i++) {
        k->column[i] = 1.0;
    }
    sl_cholesky_forward_part(s->factor, SL_PART_BOTTOM, k->column, 1, s->solve_work, s->context);
    for (int32_t i = 0; i < k->rows; i++) {
        const double mass = k->column[k->first + i];
        if (!(mass > 0.0 && isfinite(mass))) {
            return false;
        }
        k->root[i] = sqrt(mass);
    }
    return true;
}

/* The null space's share in the skeleton, D^(1/2) N_t made orthonormal, as the basis's fixed columns. */
static void fix_null_space(skeleton *k)
{
    sl_krylov *b = &k->krylov;
    double *v = k->column, *u = k->response;
    b->fixed = 0;
    for (int32_t c = 0; c < k->s->null_count; c++) {
        sl_panels_load(&k->s->N, c, k->response, 1);
        for (int32_t i = 0; i < k->rows; i++) {
            v[i] = k->response[k->first + i] * k->root[i];
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

static bool has_converged(const skeleton *k)
{
    const sl_krylov *b = &k->krylov;
    for (int32_t j = 0; j < k->s->wanted; j++) {
        const double lambda = 1.0 / b->theta[j];
        const double share = tolerance_share * sl_lanczos_bound(k->s, lambda) / lambda;
        const double tolerance = fmax(least_tolerance, fmin(most_tolerance, share));
        if (!(b->theta[j] > 0.0 && b->last[j] <= tolerance * b->theta[j])) {
            return false;
        }
    }
    return b->found == k->s->columns && b->theta[b->found - 1] > 0.0;
}

static sl_status run_krylov(skeleton *k, bool *converged)
{
    sl_krylov *b = &k->krylov;
    const sl_lanczos *s = k->s;
    const int32_t first_look = s->columns + s->wanted + 2 * b->block;
    sl_status status = SL_OK;
    *converged = false;
    sl_krylov_random(b);
    for (int32_t filling = 0; filling < MAX_FILLINGS && !*converged; filling++) {
        while (!*converged && b->applied + b->w <= b->max_basis) {
            SL_TRY(sl_report_progress(s->context, "separators", (double)b->applied / b->max_basis));
            sl_krylov_expand(b);
            if (b->applied >= first_look || b->applied + b->w > b->max_basis) {
                SL_TRY(sl_krylov_ritz(b, s->columns));
                *converged = has_converged(k);
            }
        }
        if (!*converged) {
            SL_TRY(sl_krylov_restart(b, b->found));
        }
    }
cleanup:
    return status;
}

/* Panel p of X := the Ritz vectors of the skeleton with their patches. */
static void recover_panel(skeleton *k, int32_t p)
{
    sl_lanczos *s = k->s;
    double *X = sl_panel_at(&s->X, p), *top = X + (int64_t)k->first * SL_PANEL, lambda[SL_PANEL];
    const double *U = sl_panel_at(&k->krylov.Q, p);
    const size_t bottom_bytes = (size_t)k->first * SL_PANEL * sizeof *X,
                 all_bytes = (size_t)s->n * SL_PANEL * sizeof *X;
    for (int32_t c = 0; c < SL_PANEL; c++) {
        lambda[c] = 1.0 / k->krylov.theta[p * SL_PANEL + c];
    }
    memset(X, 0, bottom_bytes);
    for (int64_t i = 0; i < k->rows; i++) {
        for (int32_t c = 0; c < SL_PANEL; c++) {
            top[i * SL_PANEL + c] = U[i * SL_PANEL + c] / k->root[i];
        }
    }
    sl_cholesky_backward_part(s->factor, SL_PART_BOTTOM, X, SL_PANEL, s->solve_work, s->context);
    memcpy(k->response, X, all_bytes);
    sl_cholesky_forward_part(s->factor, SL_PART_BOTTOM, k->response, SL_PANEL, s->solve_work, s->context);
    memset(k->response + (int64_t)k->first * SL_PANEL, 0, all_bytes - bottom_bytes);
    sl_cholesky_backward_part(s->factor, SL_PART_BOTTOM, k->response, SL_PANEL, s->solve_work, s->context);
    for (int64_t i = 0; i < k->first; i++) {
        for (int32_t c = 0; c < SL_PANEL; c++) {
            X[i * SL_PANEL + c] += lambda[c] * k->response[i * SL_PANEL + c];
        }
    }
}

sl_status sl_lanczos_skeleton(sl_lanczos *s, bool *usable)
{
    skeleton k = {.s = s, .first = sl_cholesky_top_first(s->factor)};
    sl_status status = SL_OK;
    k.rows = s->n - k.first;
    *usable = k.first > 0 && (int64_t)k.rows > (int64_t)s->max_basis + 2 * SL_PANEL + s->null_count;
    if (!*usable) {
        return SL_OK;
    }
    k.root = sl_alloc(k.rows, sizeof *k.root);
    k.column = sl_alloc(s->n, sizeof *k.column);
    k.response = sl_alloc((int64_t)s->n * SL_PANEL, sizeof *k.response);
    SL_TRY(k.root != NULL && k.column != NULL && k.response != NULL ? SL_OK : SL_OUT_OF_MEMORY);
    SL_TRY(sl_krylov_init(k.rows, s->null_count, SL_PANEL, s->max_basis, s->def.seed, s->context, &k.krylov));
    *usable = condense_mass(&k);
    if (*usable) {
        fix_null_space(&k);
        k.krylov.apply = apply_skeleton;
        k.krylov.user = &k;
        SL_TRY(run_krylov(&k, usable));
    }
    if (*usable) {
        SL_TRY(sl_krylov_vectors(&k.krylov, s->columns, NULL));
        for (int32_t p = 0; p < sl_panel_count(s->columns); p++) {
            SL_TRY(sl_report_progress(s->context, "patches", (double)p / sl_panel_count(s->columns)));
            recover_panel(&k, p);
            sl_lanczos_deflate(s, sl_panel_at(&s->X, p), SL_PANEL);
            sl_lanczos_apply(s, sl_panel_at(&s->X, p), SL_PANEL);
            sl_lanczos_deflate(s, sl_panel_at(&s->X, p), SL_PANEL);
        }
        s->info.iterations++;
        SL_TRY(sl_lanczos_rayleigh_ritz(s));
    }
cleanup:
    sl_krylov_clear(&k.krylov);
    sl_free(k.root);
    sl_free(k.column);
    sl_free(k.response);
    return status;
}
