#include "base/memory.h"
#include "sparse/front.h"

#include <float.h>
#include <math.h>
#include <string.h>

/* Pivots no larger than this share of max|a_ij| are replaced by it: it is far below any error bound. */
static const double tiny_pivot = 0x1p-100;

/* What is gathered as panels of one task, or of the crown, come and go. L here is the scaled L |D|^(1/2). */
typedef struct harvest {
    double *column; /* 2 max_width: sums and largest entries of the columns at hand */
    double max_l, max_d;
    int32_t zero, negative;
} harvest;

/* Sums over the rows of L: n of them, then those outside of the tasks, by task. */
typedef struct gathering {
    const sl_cholesky *F;
    double *row_sum;     /* of |L| |L'| */
    int32_t *row_length; /* entries */
    harvest *task;       /* task_count, and the crown */
    double *column;      /* room for theirs */
    double replaced;     /* the reciprocal root that tells a replaced pivot */
} gathering;

/* Sums and largest entry of each column of |L| in the panel; length: width each. */
static void scan_columns(const double *panel, int32_t width, int32_t below, double *sum, double *largest)
{
    for (int32_t k = 0; k < width; k++) {
        sum[k] = largest[k] = 1.0 / panel[sl_own_place(width, k, k)];
        for (int32_t i = k + 1; i < width; i++) {
            const double size = fabs(panel[sl_own_place(width, i, k)]);
            sum[k] += size;
            largest[k] = size > largest[k] ? size : largest[k];
        }
    }
    const double *slab = panel + sl_own_size(width);
    for (int32_t i = 0; i < below; i += SL_SLAB) {
        const int32_t rows = below - i < SL_SLAB ? below - i : SL_SLAB;
        for (int32_t k = 0; k < width; k++) {
            for (int32_t r = 0; r < rows; r++) {
                const double size = fabs(*slab++);
                sum[k] += size;
                largest[k] = size > largest[k] ? size : largest[k];
            }
        }
    }
}

/* Where row r of a supernode in task t is summed. */
static int64_t place_of_row(const sl_cholesky *F, int32_t t, int32_t r)
{
    return r >= 0 ? r : F->n + F->outside_first[t] - 1 - r;
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
            const int64_t place = place_of_row(F, F->task[s], row[i + r]);
            double total = 0.0;
            for (int32_t k = 0; k < width; k++) {
                total += fabs(slab[k * rows + r]) * sum[k];
            }
            g->row_sum[place] += total;
            g->row_length[place] += width;
        }
        slab += (int64_t)rows * width;
    }
}

static void add_panel(void *user, int32_t s, const double *panel, const int8_t *sign)
{
    gathering *g = user;
    const sl_cholesky *F = g->F;
    const int32_t width = sl_supernode_width(F, s);
    harvest *h = &g->task[F->task[s] != -1 ? F->task[s] : F->task_count];
    double *largest = h->column + F->max_width;
    scan_columns(panel, width, sl_supernode_below(F, s), h->column, largest);
    add_to_row_sums(g, s, panel, h->column);
    for (int32_t k = 0; k < width; k++) {
        const double reciprocal = panel[sl_own_place(width, k, k)];
        h->max_l = fmax(h->max_l, largest[k] * reciprocal);
        h->max_d = fmax(h->max_d, 1.0 / (reciprocal * reciprocal));
        h->zero += reciprocal == g->replaced;
        h->negative += sign[k] < 0;
    }
}

static void gathering_clear(gathering *g)
{
    sl_free(g->row_sum);
    sl_free(g->row_length);
    sl_free(g->task);
    sl_free(g->column);
}

static sl_status gathering_init(gathering *g, const sl_cholesky *F)
{
    const int64_t sums = F->n + F->outside_first[F->task_count], columns = 2 * (int64_t)F->max_width;
    *g = (gathering){.F = F};
    g->row_sum = sl_calloc(sums, sizeof *g->row_sum);
    g->row_length = sl_calloc(sums, sizeof *g->row_length);
    g->task = sl_calloc((int64_t)F->task_count + 1, sizeof *g->task);
    g->column = sl_alloc(columns * (F->task_count + 1), sizeof *g->column);
    if (g->row_sum == NULL || g->row_length == NULL || g->task == NULL || g->column == NULL) {
        return SL_OUT_OF_MEMORY;
    }
    for (int32_t t = 0; t <= F->task_count; t++) {
        g->task[t].column = g->column + columns * t;
    }
    return SL_OK;
}

/* Tasks into one, in their order. */
static void merge_harvests(gathering *g, sl_inertia_info *info)
{
    const sl_cholesky *F = g->F;
    for (int32_t t = 0; t <= F->task_count; t++) {
        const harvest *h = &g->task[t];
        info->max_l = fmax(info->max_l, h->max_l);
        info->max_d = fmax(info->max_d, h->max_d);
        info->zero += h->zero;
        info->negative += h->negative;
    }
    for (int64_t k = 0; k < F->outside_first[F->task_count]; k++) {
        g->row_sum[F->outside[k]] += g->row_sum[F->n + k];
        g->row_length[F->outside[k]] += g->row_length[F->n + k];
    }
    info->positive = F->n - info->negative - info->zero;
}

/* ||E||_inf, from |E| <= gamma |L||D||L'| by rows; the shift's rounding and replaced pivots on top. */
static double error_bound(const gathering *g, const sl_inertia_info *info)
{
    const double unit = 0.5 * DBL_EPSILON;
    double largest = 0.0;
    for (int32_t i = 0; i < g->F->n; i++) {
        const double terms = g->row_length[i] + 4.0; /* a product each, the root, its reciprocal, the scaling */
        largest = fmax(largest, terms * unit / (1.0 - terms * unit) * g->row_sum[i]);
    }
    const double replaced = info->zero > 0 ? 2.0 * tiny_pivot * info->max_a : 0.0;
    const double bound = largest + unit * info->max_a + replaced;
    return isfinite(bound) ? bound : INFINITY;
}

sl_status sl_inertia(const sl_cholesky *F, const sl_csc *A, double sigma, const sl_context *context,
                     sl_inertia_info *info)
{
    gathering g = {0};
    sl_inertia_info found = {0};
    int8_t *sign = NULL;
    double diagonal;
    sl_status status = SL_OK;
    SL_TRY(sl_check_values(F, A, sigma, &found.max_a, &diagonal));
    sign = sl_alloc(F->n, sizeof *sign);
    SL_TRY(sign != NULL ? SL_OK : SL_OUT_OF_MEMORY);
    SL_TRY(gathering_init(&g, F));
    const double least = fmax(tiny_pivot * found.max_a, DBL_MIN);
    g.replaced = 1.0 / sqrt(least);
    sl_front_job job = {.F = F,
                        .A = A,
                        .sigma = sigma,
                        .stage = "inertia",
                        .pivoting = {least, least},
                        .sign = sign,
                        .panel_done = add_panel,
                        .user = &g};
    SL_TRY(sl_factor_fronts(&job, context));
    merge_harvests(&g, &found);
    found.backward_error = error_bound(&g, &found);
    found.growth = found.max_a > 0.0 ? found.max_d / found.max_a : 1.0;
    *info = found;
cleanup:
    sl_free(sign);
    gathering_clear(&g);
    return status;
}
