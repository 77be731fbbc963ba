/* From Ritz vectors of the skeleton to vectors of the whole matrix. The lumped masses cost a pair (1 / lambda, u) an
 * error, above all in modes near it. What is amiss is known exactly at the price of one solve with the patches,
 *
 *     t = S(lambda) u = lambda (D u - (I + T'T) u) - lambda^2 E u        (S u = lambda D u; E lumped still),
 *
 * and u - inv(S - lambda D) t is right to second order. inv(S - lambda D) is inv(S) but for modes of small
 * eigenvalues, and of those the skeleton's own Ritz pairs (theta_j, u_j) tell:
 *
 *     inv(S - lambda D) = inv(S) + sum_j u_j lambda theta_j^2 / (1 - lambda theta_j) u_j'
 *
 * summed over the pairs beyond those that X holds, for among these the Rayleigh-Ritz step decides. The patches follow
 * by x_b = T x_t + lambda inv(A_bb) T x_t, the first two terms of their response at lambda. Source: Guyan 1965 (static
 * condensation), Hurty 1965 (patches by their boundaries), Davidson 1975 (correction of an approximate pair).
 * Deviations: the second term instead of the patches' own modes; the correction from Ritz pairs at hand. */
#include "eigen/skeleton.h"

#include "base/memory.h"

#include <math.h>
#include <string.h>

/* A mode beyond is treated as if it were at least this far from lambda: |1 - lambda theta|. */
static const double least_distance = 0.1;

sl_status sl_skeleton_take_modes(sl_skeleton *k)
{
    sl_krylov *b = &k->krylov;
    sl_status status = SL_OK;
    k->modes = k->modes < b->applied ? k->modes : b->applied / SL_PANEL * SL_PANEL;
    k->theta = sl_copy(b->theta, k->modes, sizeof *k->theta);
    SL_TRY(k->theta != NULL ? SL_OK : SL_OUT_OF_MEMORY);
    SL_TRY(sl_krylov_vectors(b, k->modes, k->s->columns, NULL));
    SL_TRY(sl_panels_take(&b->Q, k->modes, &k->U));
    sl_krylov_clear(b);
    const int64_t size = (int64_t)k->modes * SL_PANEL;
    k->partial = sl_alloc(sl_panels_partial_size(k->rows, k->modes), sizeof *k->partial);
    k->H = sl_calloc(size + SL_PANEL * SL_PANEL, sizeof *k->H);
    k->response = sl_alloc((int64_t)k->s->n * SL_PANEL, sizeof *k->response);
    SL_TRY(k->partial != NULL && k->H != NULL && k->response != NULL ? SL_OK : SL_OUT_OF_MEMORY);
    for (int32_t p = 0; p < sl_panel_count(k->modes); p++) {
        float *U = k->U.single + (int64_t)p * k->rows * SL_PANEL;
        for (int64_t i = 0; i < k->rows; i++) {
            for (int32_t c = 0; c < SL_PANEL; c++) {
                U[i * SL_PANEL + c] = (float)(U[i * SL_PANEL + c] / k->root[i]);
            }
        }
    }
cleanup:
    return status;
}

/* t := S(lambda) u, of which it holds T'T u. */
static void misfit(const sl_skeleton *k, const double *u, const double *lambda, double *t)
{
    for (int64_t i = 0; i < k->rows; i++) {
        const double excess = k->root[i] * k->root[i] - 1.0;
        for (int32_t c = 0; c < SL_PANEL; c++) {
            const int64_t at = i * SL_PANEL + c;
            t[at] = lambda[c] * ((excess - lambda[c] * k->second[i]) * u[at] - t[at]);
        }
    }
}

/* t := inv(S - lambda D) t, but for the pairs of X. */
static void solve_misfit(sl_skeleton *k, const double *lambda, double *t)
{
    sl_lanczos *s = k->s;
    const sl_panels far = sl_panels_from(&k->U, sl_panel_count(s->columns)); /* the pairs beyond those of X */
    const sl_panel_pair single = {SL_PANEL, {t, NULL}, {k->H, NULL}};
    double G[SL_PANEL * SL_PANEL];
    const double *theta = k->theta + sl_panel_count(s->columns) * SL_PANEL;
    if (far.columns > 0) {
        sl_panels_project(&far, far.columns, &single, k->partial, s->context);
        for (int32_t j = 0; j < far.columns; j++) {
            for (int32_t c = 0; c < SL_PANEL; c++) {
                const double share = lambda[c] * theta[j];
                k->H[j * SL_PANEL + c] *= -share * theta[j] / fmax(1.0 - share, least_distance);
            }
        }
    }
    sl_cholesky_forward_part(s->factor, SL_PART_TOP, t, SL_PANEL, s->solve_work, s->context);
    sl_cholesky_backward_part(s->factor, SL_PART_TOP, t, SL_PANEL, s->solve_work, s->context);
    if (far.columns > 0) {
        sl_panels_subtract(&far, far.columns, &single, k->partial, G, s->context);
    }
}

void sl_skeleton_recover(sl_skeleton *k, int32_t p)
{
    sl_lanczos *s = k->s;
    double *X = sl_panel_at(&s->X, p), *top = X + (int64_t)k->first * SL_PANEL, lambda[SL_PANEL];
    double *g = k->response, *t = g + (int64_t)k->first * SL_PANEL;
    const size_t bottom_bytes = (size_t)k->first * SL_PANEL * sizeof *X,
                 top_bytes = (size_t)k->rows * SL_PANEL * sizeof *X;
    for (int32_t c = 0; c < SL_PANEL; c++) {
        lambda[c] = 1.0 / k->theta[p * SL_PANEL + c];
    }
    memset(X, 0, bottom_bytes);
    sl_panels_load(&k->U, p * SL_PANEL, top, SL_PANEL);
    sl_cholesky_backward_part(s->factor, SL_PART_BOTTOM, X, SL_PANEL, s->solve_work, s->context); /* T u */
    memcpy(g, X, bottom_bytes);
    memset(t, 0, top_bytes);
    sl_cholesky_forward_part(s->factor, SL_PART_BOTTOM, g, SL_PANEL, s->solve_work, s->context); /* T'T u above */
    misfit(k, top, lambda, t);
    solve_misfit(k, lambda, t);
    for (int64_t i = 0; i < (int64_t)k->rows * SL_PANEL; i++) {
        top[i] -= t[i];
    }
    for (int64_t i = 0; i < k->first; i++) { /* g = inv(L_bb) T u becomes the second term on the way back */
        for (int32_t c = 0; c < SL_PANEL; c++) {
            X[i * SL_PANEL + c] = lambda[c] * g[i * SL_PANEL + c];
        }
    }
    sl_cholesky_backward_part(s->factor, SL_PART_BOTTOM, X, SL_PANEL, s->solve_work, s->context);
}
