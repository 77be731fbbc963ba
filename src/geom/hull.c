#include "geom/hull.h"

#include "base/memory.h"
#include "geom/predicates.h"

#include <math.h>
#include <stdlib.h>

typedef struct indexed_point {
    double p[2];
    int32_t index;
} indexed_point;

static int compare_points(const void *a, const void *b)
{
    const indexed_point *s = a, *t = b;
    for (int k = 0; k < 2; k++) {
        if (s->p[k] != t->p[k]) {
            return s->p[k] < t->p[k] ? -1 : 1;
        }
    }
    return (s->index > t->index) - (s->index < t->index);
}

/* The points by x, then y, then index; of equal points only the first. */
static sl_status sorted_points(const double *point, int32_t n, indexed_point **out, int32_t *count)
{
    for (int64_t k = 0; k < 2 * (int64_t)n; k++) {
        if (!isfinite(point[k])) {
            return SL_BAD_INPUT;
        }
    }
    indexed_point *sorted = sl_alloc(n, sizeof *sorted);
    if (sorted == NULL) {
        return SL_OUT_OF_MEMORY;
    }
    for (int32_t i = 0; i < n; i++) { /* + 0.0 turns -0 into 0: they are one point */
        sorted[i] = (indexed_point){{point[2 * (int64_t)i] + 0.0, point[2 * (int64_t)i + 1] + 0.0}, i};
    }
    qsort(sorted, (size_t)n, sizeof *sorted, compare_points);
    int32_t kept = 0;
    for (int32_t i = 0; i < n; i++) {
        if (kept == 0 || sorted[i].p[0] != sorted[kept - 1].p[0] || sorted[i].p[1] != sorted[kept - 1].p[1]) {
            sorted[kept++] = sorted[i];
        }
    }
    *out = sorted;
    *count = kept;
    return SL_OK;
}

/* Takes off the corners that going on to point i would make reflex or straight; those before `base` stay. */
static int32_t chain_trim(const double *point, const int32_t *chain, int32_t base, int32_t count, int32_t i)
{
    while (count - base >= 2 && sl_orient2d(point + 2 * (int64_t)chain[count - 2],
                                            point + 2 * (int64_t)chain[count - 1], point + 2 * (int64_t)i) <= 0) {
        count--;
    }
    return count;
}

sl_status sl_convex_hull_2d(const double *point, int32_t n, int32_t *hull, int32_t *count)
{
    SL_ASSERT(n >= 0);
    sl_status status = SL_OK;
    indexed_point *sorted = NULL;
    int32_t *chain = NULL, distinct = 0, corners = 0;
    SL_TRY(sorted_points(point, n, &sorted, &distinct));
    chain = sl_alloc(2 * (int64_t)distinct,
                     sizeof *chain); /* on its way back the upper chain meets the lower one's points */
    if (chain == NULL) {
        SL_TRY(SL_OUT_OF_MEMORY);
    }
    for (int32_t i = 0; i < distinct; i++) {
        corners = chain_trim(point, chain, 0, corners, sorted[i].index);
        chain[corners++] = sorted[i].index;
    }
    const int32_t base = corners - 1;
    for (int32_t i = distinct - 2; i >= 0; i--) {
        corners = chain_trim(point, chain, base, corners, sorted[i].index);
        if (i > 0) { /* the leftmost point closes the hull: it is there already */
            chain[corners++] = sorted[i].index;
        }
    }
    for (int32_t k = 0; k < corners; k++) {
        hull[k] = chain[k];
    }
    *count = corners;
cleanup:
    sl_free(chain);
    sl_free(sorted);
    return status;
}

/* A hull and one direction; the calipers' arms are hull corners that only move forward. */
typedef struct calipers {
    const double *point;
    const int32_t *hull;
    int32_t count;
    double axis[2];
} calipers;

static const double *corner(const calipers *c, int32_t k)
{
    return c->point + 2 * (int64_t)c->hull[k % c->count];
}

/* How far corner `to` is ahead of corner `from` along (x, y). */
static double ahead(const calipers *c, int32_t from, int32_t to, double x, double y)
{
    const double *p = corner(c, from), *q = corner(c, to);
    return (q[0] - p[0]) * x + (q[1] - p[1]) * y;
}

/* Moves an arm on to the corner furthest along (x, y); at most once round, whatever the rounding. */
static int32_t advance(const calipers *c, int32_t arm, double x, double y)
{
    for (int32_t moves = 0; moves < c->count && ahead(c, arm, arm + 1, x, y) > 0.0; moves++) {
        arm++;
    }
    return arm;
}

/* The hull edge whose rectangle has the smallest area. */
static int32_t best_edge(calipers *c)
{
    int32_t best = 0, right = 0, top = 0, left = 0;
    double best_area = HUGE_VAL;
    for (int32_t e = 0; e < c->count; e++) {
        const double *p = corner(c, e), *q = corner(c, e + 1);
        const double length = hypot(q[0] - p[0], q[1] - p[1]);
        const double x = (q[0] - p[0]) / length, y = (q[1] - p[1]) / length;
        right = advance(c, right > e ? right : e + 1, x, y);
        top = advance(c, top > right ? top : right, -y, x);
        left = advance(c, left > top ? left : top, -x, -y);
        const double area = ahead(c, left, right, x, y) * ahead(c, e, top, -y, x);
        if (area < best_area) {
            best_area = area;
            best = e;
        }
    }
    return best;
}

/* The axis of an edge, turned by quarters into the first quadrant: the same rectangle, one name for it. */
static void first_quadrant(const double *p, const double *q, double axis[2])
{
    const double length = hypot(q[0] - p[0], q[1] - p[1]);
    double x = (q[0] - p[0]) / length, y = (q[1] - p[1]) / length;
    for (int quarter = 0; quarter < 3 && !(x > 0.0 && y >= 0.0); quarter++) {
        const double turned = -y;
        y = x;
        x = turned;
    }
    axis[0] = x;
    axis[1] = y + 0.0; /* no -0 */
}

/* Extents of all hull corners about the axis, so that the rectangle holds them whatever the calipers' rounding. */
static void measure(const calipers *c, sl_rectangle *out)
{
    double high[2] = {-HUGE_VAL, -HUGE_VAL};
    out->low[0] = out->low[1] = HUGE_VAL;
    for (int32_t k = 0; k < c->count; k++) {
        const double *p = corner(c, k);
        const double along[2] = {p[0] * c->axis[0] + p[1] * c->axis[1], p[1] * c->axis[0] - p[0] * c->axis[1]};
        for (int a = 0; a < 2; a++) {
            out->low[a] = fmin(out->low[a], along[a]);
            high[a] = fmax(high[a], along[a]);
        }
    }
    out->axis[0] = c->axis[0];
    out->axis[1] = c->axis[1];
    out->angle = atan2(c->axis[1], c->axis[0]);
    out->width = high[0] - out->low[0];
    out->height = high[1] - out->low[1];
}

sl_status sl_min_area_rectangle(const double *point, int32_t n, sl_rectangle *out)
{
    if (n < 1) {
        return SL_BAD_INPUT;
    }
    sl_status status = SL_OK;
    int32_t *hull = sl_alloc(n, sizeof *hull), count = 0;
    if (hull == NULL) {
        SL_TRY(SL_OUT_OF_MEMORY);
    }
    SL_TRY(sl_convex_hull_2d(point, n, hull, &count));
    calipers c = {point, hull, count, {1.0, 0.0}};
    if (count >= 2) {
        const int32_t e = best_edge(&c);
        first_quadrant(corner(&c, e), corner(&c, e + 1), c.axis);
    }
    measure(&c, out);
cleanup:
    sl_free(hull);
    return status;
}
