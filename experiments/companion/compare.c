#include "companion.h"

#include <math.h>
#include <stdlib.h>

static const double equal_log2 = 0.0143553; /* one hundredth */
static const double axis_kept = 0.9;        /* of its length */

/* What is too small to matter counts as no difference: a millisecond, a degree. */
double log_ratio(const model *m, int way, int base, int metric)
{
    if (m->way[base].failed || m->way[way].failed) {
        return NAN;
    }
    const double below = m->way[base].metric[metric], value = m->way[way].metric[metric];
    const double floor = metric == EXP_SECONDS ? 1e-3 : metric == EXP_JAGGED ? 1.0 : 1e-6;
    return log2(fmax(value, floor) / fmax(below, floor));
}

static int compare_doubles(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

sl_status compare(const companion *all, int way, int base, int metric, comparison *out)
{
    double *ratio = sl_alloc((int64_t)all->count + 1, sizeof *ratio);
    int32_t n = 0;
    *out = (comparison){0};
    if (ratio == NULL) {
        return SL_OUT_OF_MEMORY;
    }
    for (int32_t k = 0; k < all->count; k++) {
        const double r = log_ratio(&all->model[k], way, base, metric);
        if (!isnan(r)) {
            ratio[n++] = r;
        }
        out->better += r < -equal_log2;
        out->worse += r > equal_log2;
        out->equal += fabs(r) <= equal_log2;
    }
    qsort(ratio, (size_t)n, sizeof *ratio, compare_doubles);
    out->median = n > 0 ? 0.5 * (ratio[(n - 1) / 2] + ratio[n / 2]) : 0.0;
    sl_free(ratio);
    return SL_OK;
}

void count_axes(const companion *all, int way, int32_t *kept, int32_t *of)
{
    *kept = *of = 0;
    for (int32_t k = 0; k < all->count; k++) {
        const exp_numbers *o = &all->model[k].way[way];
        *of += !o->failed && o->axis >= 0.0;
        *kept += !o->failed && o->axis >= axis_kept;
    }
}

int paper_loses_to(const model *m)
{
    const double *own = m->way[EXP_SPECTRAL].metric;
    int best = -1;
    for (int way = 0; !m->way[EXP_SPECTRAL].failed && way < EXP_METHODS; way++) {
        const double *other = m->way[way].metric;
        if (m->way[way].failed || other[EXP_CHARTS] >= own[EXP_CHARTS] || other[EXP_SEAM] > own[EXP_SEAM]) {
            continue;
        }
        const double *so_far = best >= 0 ? m->way[best].metric : NULL;
        if (so_far == NULL || other[EXP_CHARTS] < so_far[EXP_CHARTS] ||
            (other[EXP_CHARTS] == so_far[EXP_CHARTS] && other[EXP_SEAM] < so_far[EXP_SEAM])) {
            best = way;
        }
    }
    return best;
}
