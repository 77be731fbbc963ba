#include "locate.h"

#include "base/memory.h"

#include <math.h>
#include <stdlib.h>

/* A direction of length below 1 that no plane of symmetry of a model is likely to be square to. */
static double along(const double p[3])
{
    return 0.7548776662466927 * p[0] + 0.5698402909980532 * p[1] + 0.3247179572447460 * p[2];
}

/* The largest of |along| over |coordinate differences|: the sum of the direction's coordinates. */
static const double along_reach = 1.65;

static int compare(const void *a, const void *b)
{
    const gen_located *x = a, *y = b;
    if (x->along != y->along) {
        return x->along < y->along ? -1 : 1;
    }
    return x->vertex < y->vertex ? -1 : x->vertex > y->vertex;
}

static double extent_of(const double *xyz, int32_t nv)
{
    double extent = 0.0;
    for (int axis = 0; axis < 3; axis++) {
        double lo = HUGE_VAL, hi = -HUGE_VAL;
        for (int64_t v = 0; v < nv; v++) {
            lo = fmin(lo, xyz[3 * v + axis]);
            hi = fmax(hi, xyz[3 * v + axis]);
        }
        extent = fmax(extent, hi - lo);
    }
    return extent;
}

sl_status gen_locator_init(gen_locator *locator, const double *xyz, int32_t nv, double tolerance)
{
    *locator = (gen_locator){.xyz = xyz, .nv = nv, .tolerance = tolerance * extent_of(xyz, nv)};
    locator->order = sl_alloc(nv, sizeof *locator->order);
    if (locator->order == NULL) {
        return SL_OUT_OF_MEMORY;
    }
    for (int32_t v = 0; v < nv; v++) {
        locator->order[v] = (gen_located){along(xyz + 3 * (int64_t)v), v};
    }
    qsort(locator->order, (size_t)nv, sizeof *locator->order, compare);
    return SL_OK;
}

int32_t gen_locate(const gen_locator *locator, const double p[3])
{
    const double here = along(p), reach = along_reach * locator->tolerance;
    int32_t low = 0, high = locator->nv, found = -1;
    while (low < high) {
        const int32_t middle = low + (high - low) / 2;
        if (locator->order[middle].along < here - reach) {
            low = middle + 1;
        } else {
            high = middle;
        }
    }
    for (; low < locator->nv && locator->order[low].along <= here + reach; low++) {
        const int32_t v = locator->order[low].vertex;
        const double *q = locator->xyz + 3 * (int64_t)v;
        const double d = fmax(fmax(fabs(p[0] - q[0]), fabs(p[1] - q[1])), fabs(p[2] - q[2]));
        if (d <= locator->tolerance && (found < 0 || v < found)) {
            found = v;
        }
    }
    return found;
}

void gen_locator_clear(gen_locator *locator)
{
    sl_free(locator->order);
    *locator = (gen_locator){0};
}
