#include "pack/clearance.h"

#include "base/memory.h"
#include "pack/outline.h"

#include <math.h>

enum { MOST_CELLS = 512 }; /* along the longer side */

/* An edge of some chart's outline, in page coordinates. */
typedef struct placed_edge {
    double from[2], to[2];
    int32_t chart;
} placed_edge;

/* Edges by the grid cells that their boxes touch. */
typedef struct bucket_grid {
    int64_t edges;
    placed_edge *edge;
    double low[2], cell;
    int32_t size[2];
    int64_t *first; /* size[0] size[1] + 1 */
    int64_t *item;
} bucket_grid;

static void grid_clear(bucket_grid *g)
{
    sl_free(g->edge);
    sl_free(g->first);
    sl_free(g->item);
}

static sl_status list_edges(int32_t count, const sl_pack_chart *charts, bucket_grid *g)
{
    int64_t capacity = 0;
    sl_outline outline = {0};
    sl_status status = SL_OK;
    for (int32_t c = 0; c < count; c++) {
        sl_outline_clear(&outline);
        SL_TRY(sl_outline_init(&charts[c], &outline));
        SL_TRY(sl_reserve((void **)&g->edge, &capacity, g->edges + outline.count, sizeof *g->edge));
        for (int32_t k = 0; k < outline.count; k++) {
            const sl_outline_edge *e = &outline.edge[k];
            g->edge[g->edges++] = (placed_edge){{e->from[0] + outline.centre[0], e->from[1] + outline.centre[1]},
                                                {e->to[0] + outline.centre[0], e->to[1] + outline.centre[1]},
                                                c};
        }
    }
cleanup:
    sl_outline_clear(&outline);
    return status;
}

static void size_grid(bucket_grid *g, double limit)
{
    double high[2] = {-HUGE_VAL, -HUGE_VAL};
    g->low[0] = g->low[1] = HUGE_VAL;
    for (int64_t k = 0; k < g->edges; k++) {
        for (int i = 0; i < 2; i++) {
            g->low[i] = fmin(g->low[i], fmin(g->edge[k].from[i], g->edge[k].to[i]));
            high[i] = fmax(high[i], fmax(g->edge[k].from[i], g->edge[k].to[i]));
        }
    }
    const double side = fmax(high[0] - g->low[0], high[1] - g->low[1]);
    g->cell = fmax(limit, side / MOST_CELLS);
    for (int i = 0; i < 2; i++) {
        g->size[i] = (int32_t)((high[i] - g->low[i]) / g->cell) + 1;
    }
}

/* Cells that an edge's box touches, and those within `reach` of it. */
static void cells_of(const bucket_grid *g, const placed_edge *e, double reach, int32_t low[2], int32_t high[2])
{
    for (int i = 0; i < 2; i++) {
        const double a = (fmin(e->from[i], e->to[i]) - reach - g->low[i]) / g->cell;
        const double b = (fmax(e->from[i], e->to[i]) + reach - g->low[i]) / g->cell;
        low[i] = (int32_t)fmax(0.0, floor(a));
        high[i] = (int32_t)fmin(g->size[i] - 1.0, floor(b));
    }
}

/* Counting sort of the edges into their cells. */
static sl_status fill_grid(bucket_grid *g)
{
    const int64_t cells = (int64_t)g->size[0] * g->size[1];
    int32_t low[2], high[2];
    g->first = sl_calloc(cells + 1, sizeof *g->first);
    if (g->first == NULL) {
        return SL_OUT_OF_MEMORY;
    }
    for (int pass = 0; pass < 2; pass++) {
        for (int64_t k = 0; k < g->edges; k++) {
            cells_of(g, &g->edge[k], 0.0, low, high);
            for (int32_t y = low[1]; y <= high[1]; y++) {
                for (int32_t x = low[0]; x <= high[0]; x++) {
                    int64_t *at = &g->first[(int64_t)y * g->size[0] + x];
                    if (pass == 0) {
                        ++*at;
                    } else {
                        g->item[--*at] = k;
                    }
                }
            }
        }
        for (int64_t i = 0; pass == 0 && i < cells; i++) { /* from counts to ends; the second pass makes them starts */
            g->first[i + 1] += g->first[i];
        }
        if (pass == 0) {
            g->item = sl_alloc(g->first[cells], sizeof *g->item);
            if (g->item == NULL) {
                return SL_OUT_OF_MEMORY;
            }
        }
    }
    return SL_OK;
}

static double point_to_edge(const double p[2], const placed_edge *e)
{
    const double d[2] = {e->to[0] - e->from[0], e->to[1] - e->from[1]};
    const double r[2] = {p[0] - e->from[0], p[1] - e->from[1]};
    const double square = d[0] * d[0] + d[1] * d[1];
    const double t = square > 0.0 ? fmin(1.0, fmax(0.0, (d[0] * r[0] + d[1] * r[1]) / square)) : 0.0;
    return hypot(r[0] - t * d[0], r[1] - t * d[1]);
}

static double side_of(const placed_edge *e, const double p[2])
{
    return (e->to[0] - e->from[0]) * (p[1] - e->from[1]) - (e->to[1] - e->from[1]) * (p[0] - e->from[0]);
}

static double edge_distance(const placed_edge *a, const placed_edge *b)
{
    if (side_of(a, b->from) * side_of(a, b->to) < 0.0 && side_of(b, a->from) * side_of(b, a->to) < 0.0) {
        return 0.0;
    }
    return fmin(fmin(point_to_edge(a->from, b), point_to_edge(a->to, b)),
                fmin(point_to_edge(b->from, a), point_to_edge(b->to, a)));
}

static double least_distance(const bucket_grid *g, double limit)
{
    double least = limit;
    for (int64_t k = 0; k < g->edges; k++) {
        int32_t low[2], high[2];
        cells_of(g, &g->edge[k], least, low, high);
        for (int32_t y = low[1]; y <= high[1]; y++) {
            for (int32_t x = low[0]; x <= high[0]; x++) {
                const int64_t cell = (int64_t)y * g->size[0] + x;
                for (int64_t i = g->first[cell]; i < g->first[cell + 1]; i++) {
                    const placed_edge *other = &g->edge[g->item[i]];
                    if (other->chart < g->edge[k].chart) {
                        least = fmin(least, edge_distance(&g->edge[k], other));
                    }
                }
            }
        }
    }
    return least;
}

sl_status sl_pack_clearance(int32_t count, const sl_pack_chart *charts, double limit, double *out)
{
    SL_ASSERT(limit > 0.0);
    bucket_grid g = {0};
    sl_status status = SL_OK;
    SL_TRY(list_edges(count, charts, &g));
    if (g.edges == 0) {
        *out = limit;
        goto cleanup;
    }
    size_grid(&g, limit);
    SL_TRY(fill_grid(&g));
    *out = least_distance(&g, limit);
cleanup:
    grid_clear(&g);
    return status;
}
