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
    double *column;      /* 2 max_width: sums and largest entries of the columns at hand */
    double replaced;     /* the reciprocal root that tells a replaced pivot */
    sl_inertia_info info;
} gathering;

/* Sums and largest entry of each column of |L| in the panel; length: width each. */
static void scan_columns(const double *panel, int32_t width, int32_t below, double *sum, double *largest)
{
    for (int32_t k = 0; k < width; k++) {
        sum[k] = largest[k] = 1.0 / panel[sl_own_place(width, k, k)];
        for (int32_t i = k + 1; i < width; i++) {
            const double size = fabs(panel[sl_own_place(width, i, k)]);
            sum[k] += size;
            largest[k] = fmax(largest[k], size);
        }
    }
    const double *slab = panel + sl_own_size(width);
    for (int32_t i = 0; i < below; i += SL_SLAB) {
        const int32_t rows = below - i < SL_SLAB ? below - i : SL_SLAB;
        for (int32_t k = 0; k < width; k++) {
            for (int32_t r = 0; r < rows; r++) {
                const double size = fabs(*slab++);
                sum[k] += size;
                largest[k] = fmax(largest[k], size);
            }
        }
    }
}

static void add_to_row_sums(gathering *g, int32_t s, const double *panel, const double *sum)
{
    const sl_cholesky *F = g->F;
    const int32_t width = sl_supernode_width(F, s), below = sl_supernode_below(F, s);
    const int32_t *row = F->below + F->below_first[s];
    for (int32_t i = 0; i < width; i++) {
        double *to = &g->row_sum[F->first[s] + i];
        for (int32_t k = 0; k < i; k++) {
            *to += fabs(panel[sl_own_place(width, i, k)]) * sum[k];
        }
        *to += sum[i] / panel[sl_own_place(width, i, i)];
        g->row_length[F->first[s] + i] += i + 1;
    }
    const double *slab = panel + sl_own_size(width);
    for (int32_t i = 0; i < below; i += SL_SLAB) {
        const int32_t rows = below - i < SL_SLAB ? below - i : SL_SLAB;
        for (int32_t r = 0; r < rows; r++) {
            g->row_length[row[i + r]] += width;
            for (int32_t k = 0; k < width; k++) {
                g->row_sum[row[i + r]] += fabs(slab[k * rows + r]) * sum[k];
            }
        }
        slab += (int64_t)rows * width;
    }
}

static void add_panel(void *user, int32_t s, const double *panel, const int8_t *sign)
{
    gathering *g = user;
    const sl_cholesky *F = g->F;
    const int32_t width = sl_supernode_width(F, s);
    double *largest = g->column + F->max_width;
    scan_columns(panel, width, sl_supernode_below(F, s), g->column, largest);
    add_to_row_sums(g, s, panel, g->column);
    for (int32_t k = 0; k < width; k++) {
        const double reciprocal = panel[sl_own_place(width, k, k)];
        g->info.max_l = fmax(g->info.max_l, largest[k] * reciprocal);
        g->info.max_d = fmax(g->info.max_d, 1.0 / (reciprocal * reciprocal));
        g->info.zero += reciprocal == g->replaced;
        g->info.negative += sign[k] < 0;
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
    g.column = sl_alloc(2 * (int64_t)F->max_width, sizeof *g.column);
    if (sign == NULL || g.column == NULL || g.row_sum == NULL || g.row_length == NULL) {
        status = SL_OUT_OF_MEMORY;
        goto cleanup;
    }
    const double least = fmax(tiny_pivot * g.info.max_a, DBL_MIN);
    g.replaced = 1.0 / sqrt(least);
    sl_front_job job = {
        .F = F, .A = A, .sigma = sigma, .pivoting = {least, least}, .sign = sign, .panel_done = add_panel, .user = &g};
    SL_TRY(sl_factor_fronts(&job));
    bound_error(&g);
    *info = g.info;
cleanup:
    sl_free(sign);
    sl_free(g.column);
    sl_free(g.row_sum);
    sl_free(g.row_length);
    return status;
}
