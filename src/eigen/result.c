/* The pairs found, as the caller wants them. */
#include "eigen/lanczos_internal.h"

#include <math.h>
#include <string.h>

/* Entries within this share of the largest tie for it, so that rounding does not choose the sign. */
static const double sign_tie = 1e-8;

void sl_lanczos_sign_rule(int32_t n, double *x)
{
    double largest = 0.0;
    for (int32_t i = 0; i < n; i++) {
        largest = fmax(largest, fabs(x[i]));
    }
    int32_t first = 0;
    while (first < n && !(fabs(x[first]) >= (1.0 - sign_tie) * largest)) {
        first++;
    }
    if (first < n && x[first] < 0.0) {
        for (int32_t i = 0; i < n; i++) {
            x[i] = -x[i];
        }
    }
}

void sl_lanczos_summarise(sl_lanczos *s)
{
    sl_lanczos_info *info = &s->info;
    info->converged_count = s->null_count;
    info->max_residual = info->max_relative = 0.0;
    for (int32_t k = 0; k < s->wanted && s->have_pairs; k++) {
        const double lambda = s->lambda[k], residual = s->residual[k];
        info->converged_count += residual <= sl_lanczos_bound(s, lambda);
        info->max_residual = fmax(info->max_residual, residual / s->norm);
        info->max_relative = fmax(info->max_relative, lambda > 0.0 ? residual / lambda : 0.0);
    }
    info->converged = info->converged_count == s->count && s->stage == SL_STAGE_DONE;
}

/* Column k, unknowns as in A. */
static void copy_column(const sl_lanczos *s, const sl_panels *from, int32_t k, double *to)
{
    const double *lane = sl_panel_at(from, k / SL_PANEL) + k % SL_PANEL;
    for (int64_t i = 0; i < s->n; i++) {
        to[s->perm[i]] = lane[i * SL_PANEL];
    }
}

void sl_lanczos_result(const sl_lanczos *s, double *lambda, double *vectors, double *residual)
{
    const int64_t n = s->n;
    if (s->info.dense) {
        memcpy(lambda, s->dense_lambda, (size_t)s->count * sizeof *lambda);
        memcpy(vectors, s->dense_X, (size_t)(n * s->count) * sizeof *vectors);
        if (residual != NULL) {
            memcpy(residual, s->dense_residual, (size_t)s->count * sizeof *residual);
        }
        return;
    }
    memset(lambda, 0, (size_t)s->count * sizeof *lambda);
    if (residual != NULL) {
        memset(residual, 0, (size_t)s->count * sizeof *residual);
    }
    for (int32_t k = 0; k < s->null_count; k++) {
        copy_column(s, &s->N, k, vectors + n * k);
        sl_lanczos_sign_rule(s->n, vectors + n * k);
    }
    for (int32_t k = 0; k < s->wanted; k++) {
        double *v = vectors + n * (s->null_count + k);
        if (!s->have_pairs) {
            memset(v, 0, (size_t)n * sizeof *v);
            continue;
        }
        lambda[s->null_count + k] = s->lambda[k];
        if (residual != NULL) {
            residual[s->null_count + k] = s->residual[k] / s->norm;
        }
        copy_column(s, &s->X, k, v);
        sl_lanczos_sign_rule(s->n, v);
    }
}
