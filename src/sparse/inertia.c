#include "base/memory.h"
#include "sparse/front.h"

#include <float.h>
#include <math.h>
#include <string.h>

/* Pivots no larger than this share of max|a_ij| are replaced by it: it is far below any error bound. */
static const double tiny_pivot = 0x1p-100;

/* What is gathered as panels come and go: L here is the scaled |D|^(1/2) one. */
typedef struct gathering {
    const sl_cholesky *F;
    double *row_sum;     /* n: row sums of |L| |L'| */
    int32_t *row_length; /* n: entries in each row of L */
    double replaced;     /* the root that tells a replaced pivot */
    sl_inertia_info info;
} gathering;

static void add_panel(void *user, int32_t s, const double *panel, const int8_t *sign)
{
    gathering *g = user;
    const sl_cholesky *F = g->F;
    const int32_t width = sl_supernode_width(F, s), below = sl_supernode_below(F, s), height = width + below;
    const int32_t *row = F->below + F->below_first[s];
    for (int32_t k = 0; k < width; k++) {
        const double *column = panel + (int64_t)k * height, d = column[k] * column[k];
        double sum = 0.0, largest = 0.0;
        for (int32_t i = k; i < height; i++) {
            const double size = fabs(column[i]);
            sum += size;
            largest = size > largest ? size : largest;
        }
        g->info.max_l = fmax(g->info.max_l, largest / column[k]);
        g->info.max_d = fmax(g->info.max_d, d);
        g->info.zero += column[k] == g->replaced;
        g->info.negative += sign[k] < 0;
        for (int32_t i = k; i < width; i++) {
            g->row_sum[F->first[s] + i] += fabs(column[i]) * sum;
        }
        for (int32_t i = 0; i < below; i++) {
            g->row_sum[row[i]] += fabs(column[width + i]) * sum;
        }
    }
    for (int32_t k = 0; k < width; k++) {
        g->row_length[F->first[s] + k] += k + 1;
    }
    for (int32_t i = 0; i < below; i++) {
        g->row_length[row[i]] += width;
    }
}

/* ||E||_inf, from |E| <= gamma |L||D||L'| by rows; the shift's rounding and replaced pivots on top. */
static void bound_error(gathering *g)
{
    const double unit = 0.5 * DBL_EPSILON;
    double largest = 0.0;
    for (int32_t i = 0; i < g->F->n; i++) {
        const double terms = g->row_length[i] + 4.0; /* a product each, the root, the quotient, the scaling */
        largest = fmax(largest, terms * unit / (1.0 - terms * unit) * g->row_sum[i]);
    }
    const double replaced = g->info.zero > 0 ? 2.0 * tiny_pivot * g->info.max_a : 0.0;
    g->info.backward_error = largest + unit * g->info.max_a + replaced;
    g->info.growth = g->info.max_a > 0.0 ? g->info.max_d / g->info.max_a : 1.0;
    g->info.positive = g->F->n - g->info.negative - g->info.zero;
    if (!isfinite(g->info.backward_error)) {
        g->info.backward_error = INFINITY;
    }
}

sl_status sl_inertia(const sl_cholesky *F, const sl_csc *A, double sigma, const sl_context *context,
                     sl_inertia_info *info)
{
    (void)context;
    gathering g = {.F = F};
    int8_t *sign = NULL;
    double diagonal;
    sl_status status = SL_OK;
    SL_TRY(sl_check_values(F, A, sigma, &g.info.max_a, &diagonal));
    sign = sl_alloc(F->n, sizeof *sign);
    g.row_sum = sl_calloc(F->n, sizeof *g.row_sum);
    g.row_length = sl_calloc(F->n, sizeof *g.row_length);
    if (sign == NULL || g.row_sum == NULL || g.row_length == NULL) {
        status = SL_OUT_OF_MEMORY;
        goto cleanup;
    }
    const double least = fmax(tiny_pivot * g.info.max_a, DBL_MIN);
    g.replaced = sqrt(least);
    sl_front_job job = {.F = F,
                        .A = A,
                        .sigma = sigma,
                        .least = least,
                        .replacement = least,
                        .sign = sign,
                        .panel_done = add_panel,
                        .user = &g};
    SL_TRY(sl_factor_fronts(&job));
    bound_error(&g);
    *info = g.info;
cleanup:
    sl_free(sign);
    sl_free(g.row_sum);
    sl_free(g.row_length);
    return status;
}
