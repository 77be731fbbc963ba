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

/* Panels of `from` on their way to the caller's columns. */
typedef struct copying {
    const sl_lanczos *solver;
    const sl_panels *from;
    int32_t columns;
    double *to;
} copying;

/* Columns with unknowns as in A, column-major: a panel's lanes together, as they lie. */
static void copy_panel(void *user, int64_t begin, int64_t end, int32_t chunk)
{
    (void)end, (void)chunk;
    const copying *c = user;
    const int64_t n = c->solver->n;
    const int32_t first = (int32_t)begin * SL_PANEL, left = c->columns - first;
    const int32_t lanes = left < SL_PANEL ? left : SL_PANEL;
    const double *panel = sl_panel_at(c->from, (int32_t)begin);
    double *block = c->to + n * first;
    for (int64_t i = 0; i < n; i++) {
        for (int32_t k = 0; k < lanes; k++) {
            block[n * k + c->solver->perm[i]] = panel[i * SL_PANEL + k];
        }
    }
    for (int32_t k = 0; k < lanes; k++) {
        sl_lanczos_sign_rule(c->solver->n, block + n * k);
    }
}

static void dense_result(const sl_lanczos *s, double *lambda, double *vectors, double *residual)
{
    memcpy(lambda, s->dense_lambda, (size_t)s->count * sizeof *lambda);
    memcpy(vectors, s->dense_X, (size_t)s->n * (size_t)s->count * sizeof *vectors);
    if (residual != NULL) {
        memcpy(residual, s->dense_residual, (size_t)s->count * sizeof *residual);
    }
}

void sl_lanczos_result(const sl_lanczos *s, double *lambda, double *vectors, double *residual)
{
    double *computed = vectors + (int64_t)s->n * s->null_count;
    if (s->info.dense) {
        dense_result(s, lambda, vectors, residual);
        return;
    }
    memset(lambda, 0, (size_t)s->count * sizeof *lambda);
    if (residual != NULL) {
        memset(residual, 0, (size_t)s->count * sizeof *residual);
    }
    for (int32_t k = 0; k < s->null_count; k++) {
        double *to = vectors + (int64_t)s->n * k;
        memcpy(to, s->def.null_space + (int64_t)s->n * k, (size_t)s->n * sizeof *to);
        sl_lanczos_sign_rule(s->n, to);
    }
    if (!s->have_pairs) {
        memset(computed, 0, (size_t)s->n * (size_t)s->wanted * sizeof *computed);
        return;
    }
    copying job = {s, &s->X, s->wanted, computed};
    sl_parallel_for(s->context, sl_panel_count(s->wanted), 1, copy_panel, &job);
    for (int32_t k = 0; k < s->wanted; k++) {
        lambda[s->null_count + k] = s->lambda[k];
        if (residual != NULL) {
            residual[s->null_count + k] = s->residual[k] / s->norm;
        }
    }
}
