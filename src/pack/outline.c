#include "pack/outline.h"

#include "base/memory.h"
#include "geom/hull.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* An edge with its ends in ascending order, and which way it was run along. */
typedef struct ordered_edge {
    double low[2], high[2];
    int32_t turns; /* +1 from low to high, -1 back */
    bool flat;     /* of a triangle without area: never left out */
} ordered_edge;

static int compare_points(const double a[2], const double b[2])
{
    if (a[0] != b[0]) {
        return a[0] < b[0] ? -1 : 1;
    }
    return (a[1] > b[1]) - (a[1] < b[1]);
}

static int compare_edges(const void *pa, const void *pb)
{
    const ordered_edge *a = pa, *b = pb;
    const int order = compare_points(a->low, b->low);
    return order != 0 ? order : compare_points(a->high, b->high);
}

static ordered_edge order_edge(const double *a, const double *b)
{
    ordered_edge e = {{a[0], a[1]}, {b[0], b[1]}, 1, false};
    if (compare_points(a, b) > 0) {
        e = (ordered_edge){{b[0], b[1]}, {a[0], a[1]}, -1, false};
    }
    return e;
}

/* The edges of all triangles, each triangle turned to positive area. */
static void list_edges(const sl_pack_chart *chart, ordered_edge *edge, double *area)
{
    for (int32_t t = 0; t < chart->nt; t++) {
        const double *p[3];
        for (int k = 0; k < 3; k++) {
            p[k] = chart->uv + 2 * (int64_t)chart->tri[3 * (int64_t)t + k];
        }
        const double twice = (p[1][0] - p[0][0]) * (p[2][1] - p[0][1]) - (p[2][0] - p[0][0]) * (p[1][1] - p[0][1]);
        for (int k = 0; k < 3; k++) {
            const double *a = p[k], *b = p[(k + 1) % 3];
            edge[3 * (int64_t)t + k] = twice < 0.0 ? order_edge(b, a) : order_edge(a, b);
            edge[3 * (int64_t)t + k].flat = !(fabs(twice) > 0.0);
        }
        *area += 0.5 * fabs(twice);
    }
}

/* How often the outline runs along the equal edges [begin, end), forth and back. */
static void count_runs(const ordered_edge *edge, int64_t begin, int64_t end, int32_t runs[2])
{
    int32_t sum = 0;
    bool flat = false;
    for (int64_t i = begin; i < end; i++) {
        sum += edge[i].turns;
        flat |= edge[i].flat;
    }
    runs[0] = sum > 0 ? sum : 0;
    runs[1] = sum < 0 ? -sum : 0;
    if (sum == 0 && flat) {
        runs[0] = runs[1] = 1;
    }
}

/* Sorted edges in; those whose directions do not cancel out are kept, relative to the centre. */
static sl_status keep_uncancelled(const ordered_edge *edge, int64_t n, sl_outline *out)
{
    out->edge = sl_alloc(n + 1, sizeof *out->edge);
    if (out->edge == NULL) {
        return SL_OUT_OF_MEMORY;
    }
    for (int64_t begin = 0, end; begin < n; begin = end) {
        int32_t runs[2];
        for (end = begin + 1; end < n && compare_edges(&edge[begin], &edge[end]) == 0; end++) {
        }
        count_runs(edge, begin, end, runs);
        for (int32_t k = 0; k < runs[0] + runs[1]; k++) {
            const double *from = k < runs[0] ? edge[begin].low : edge[begin].high;
            const double *to = k < runs[0] ? edge[begin].high : edge[begin].low;
            out->edge[out->count++] = (sl_outline_edge){{from[0] - out->centre[0], from[1] - out->centre[1]},
                                                        {to[0] - out->centre[0], to[1] - out->centre[1]}};
        }
    }
    return SL_OK;
}

static void find_radius(sl_outline *out)
{
    for (int32_t k = 0; k < out->count; k++) {
        out->radius = fmax(out->radius, hypot(out->edge[k].from[0], out->edge[k].from[1]));
        out->radius = fmax(out->radius, hypot(out->edge[k].to[0], out->edge[k].to[1]));
    }
}

static sl_status frame(const sl_pack_chart *chart, sl_outline *out)
{
    double low[2] = {HUGE_VAL, HUGE_VAL}, high[2] = {-HUGE_VAL, -HUGE_VAL};
    sl_rectangle box;
    for (int64_t i = 0; i < 2 * (int64_t)chart->nv; i++) {
        if (!isfinite(chart->uv[i])) {
            return SL_BAD_INPUT;
        }
        low[i % 2] = fmin(low[i % 2], chart->uv[i]);
        high[i % 2] = fmax(high[i % 2], chart->uv[i]);
    }
    const sl_status status = sl_min_area_rectangle(chart->uv, chart->nv, &box);
    if (status == SL_OK) {
        out->angle = -box.angle;
        out->extent = fmax(box.width, box.height);
        for (int k = 0; k < 2; k++) {
            out->centre[k] = 0.5 * low[k] + 0.5 * high[k];
        }
    }
    return status;
}

sl_status sl_outline_init(const sl_pack_chart *chart, sl_outline *out)
{
    sl_status status = SL_OK;
    const int64_t n = 3 * (int64_t)chart->nt;
    ordered_edge *edge = NULL;
    *out = (sl_outline){0};
    SL_TRY(frame(chart, out));
    edge = sl_alloc(n, sizeof *edge);
    SL_TRY(edge != NULL ? SL_OK : SL_OUT_OF_MEMORY);
    list_edges(chart, edge, &out->area);
    qsort(edge, (size_t)n, sizeof *edge, compare_edges);
    SL_TRY(keep_uncancelled(edge, n, out));
    if (out->count == 0) { /* no area at all: its own centre, so that it has a place */
        out->edge[out->count++] = (sl_outline_edge){{0.0, 0.0}, {0.0, 0.0}};
    }
    find_radius(out);
cleanup:
    sl_free(edge);
    return status;
}

void sl_outline_clear(sl_outline *outline)
{
    sl_free(outline->edge);
    *outline = (sl_outline){0};
}
