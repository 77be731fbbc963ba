#include "pack/pack.h"

#include "base/memory.h"
#include "geom/hull.h"
#include "pack/pack_internal.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Columns a page has: finer ones waste less beside each chart and cost more. */
static const int32_t page_columns = 512;

/* Scales tried after the first one that fits; each halves the interval. */
static const int32_t bisections = 14;

/* The first scale would fill this much of the page; no packing of ours reaches it. */
static const double hopeful_fill = 0.95;

static const double two_pi = 6.283185307179586;
static const double root_two = 1.4142135623730951;

/* A chart's place in the order of packing. */
typedef struct pack_item {
    double key; /* larger first */
    int32_t chart;
} pack_item;

typedef struct packer {
    int32_t count;
    const sl_pack_chart *charts;
    const sl_pack_def *def;
    double *angle;    /* count: of the smallest enclosing rectangle */
    double *area;     /* count: UV area */
    double *extent;   /* count: longer side of that rectangle */
    pack_item *order; /* count, for the order at hand */
    sl_horizon horizon;
    sl_profile trial, best; /* buffers, swapped */
    sl_placement *place, *best_place;
} packer;

sl_pack_def sl_pack_default(void)
{
    return (sl_pack_def){.resolution = 2048, .margin = 4.0, .rotations = 4, .turns = 1};
}

static double chart_area(const sl_pack_chart *chart)
{
    double area = 0.0;
    for (int32_t t = 0; t < chart->nt; t++) {
        const double *a = chart->uv + 2 * (int64_t)chart->tri[3 * (int64_t)t];
        const double *b = chart->uv + 2 * (int64_t)chart->tri[3 * (int64_t)t + 1];
        const double *c = chart->uv + 2 * (int64_t)chart->tri[3 * (int64_t)t + 2];
        area += 0.5 * fabs((b[0] - a[0]) * (c[1] - a[1]) - (c[0] - a[0]) * (b[1] - a[1]));
    }
    return area;
}

static int compare_items(const void *pa, const void *pb)
{
    const pack_item *a = pa, *b = pb;
    if (a->key != b->key) {
        return a->key > b->key ? -1 : 1;
    }
    return (a->chart > b->chart) - (a->chart < b->chart);
}

static void packer_clear(packer *p)
{
    sl_free(p->angle);
    sl_free(p->area);
    sl_free(p->extent);
    sl_free(p->order);
    sl_free(p->horizon.height);
    sl_free(p->trial.low);
    sl_free(p->trial.high);
    sl_free(p->best.low);
    sl_free(p->best.high);
    sl_free(p->place);
    sl_free(p->best_place);
}

static sl_status measure_charts(packer *p)
{
    for (int32_t c = 0; c < p->count; c++) {
        const sl_pack_chart *chart = &p->charts[c];
        sl_rectangle box;
        for (int64_t k = 0; k < 2 * (int64_t)chart->nv; k++) {
            if (!isfinite(chart->uv[k])) {
                return SL_BAD_INPUT;
            }
        }
        const sl_status status = sl_min_area_rectangle(chart->uv, chart->nv, &box);
        if (status != SL_OK) {
            return status;
        }
        p->angle[c] = -box.angle;
        p->extent[c] = fmax(box.width, box.height);
        p->area[c] = chart_area(chart);
    }
    return SL_OK;
}

static sl_status packer_init(packer *p)
{
    const int32_t n = p->count;
    p->horizon.side = p->def->resolution;
    p->horizon.columns = p->def->resolution < page_columns ? p->def->resolution : page_columns;
    p->horizon.cell = p->horizon.side / p->horizon.columns;
    p->angle = sl_alloc(n, sizeof *p->angle);
    p->area = sl_alloc(n, sizeof *p->area);
    p->extent = sl_alloc(n, sizeof *p->extent);
    p->order = sl_alloc(n, sizeof *p->order);
    p->place = sl_calloc(n, sizeof *p->place);
    p->best_place = sl_calloc(n, sizeof *p->best_place);
    p->horizon.height = sl_alloc(p->horizon.columns, sizeof *p->horizon.height);
    p->trial.low = sl_alloc(p->horizon.columns, sizeof *p->trial.low);
    p->trial.high = sl_alloc(p->horizon.columns, sizeof *p->trial.high);
    p->best.low = sl_alloc(p->horizon.columns, sizeof *p->best.low);
    p->best.high = sl_alloc(p->horizon.columns, sizeof *p->best.high);
    if (p->angle == NULL || p->area == NULL || p->extent == NULL || p->order == NULL || p->place == NULL ||
        p->best_place == NULL || p->horizon.height == NULL || p->trial.low == NULL || p->trial.high == NULL ||
        p->best.low == NULL || p->best.high == NULL) {
        return SL_OUT_OF_MEMORY;
    }
    return measure_charts(p);
}

/* A chart without extent gets one texel: it is grown by half a texel more. */
static double growth(const packer *p, int32_t chart)
{
    return 0.5 * p->def->margin + (p->extent[chart] > 0.0 ? 0.0 : 0.5);
}

/* Puts one chart where it costs least over its orientations. */
static bool put_chart(packer *p, int32_t chart, double scale)
{
    bool found = false;
    int32_t best_x = 0;
    double best_y = 0.0, best_cost = HUGE_VAL, best_angle = 0.0;
    for (int32_t r = 0; r < p->def->rotations; r++) {
        int32_t x = 0;
        double y = 0.0, cost = HUGE_VAL;
        const double angle = p->angle[chart] + two_pi * r / p->def->rotations;
        if (sl_profile_make(&p->charts[chart], angle, scale, growth(p, chart), p->horizon.cell, p->horizon.columns,
                            &p->trial) &&
            sl_horizon_find(&p->horizon, &p->trial, &x, &y, &cost) && cost < best_cost) {
            const sl_profile kept = p->best;
            p->best = p->trial;
            p->trial = kept;
            best_x = x;
            best_y = y;
            best_cost = cost;
            best_angle = angle;
            found = true;
        }
    }
    if (found) {
        sl_horizon_put(&p->horizon, &p->best, best_x, best_y);
        p->place[chart].angle = best_angle;
        p->place[chart].offset[0] = (p->best.origin[0] + best_x * p->horizon.cell) / p->horizon.side;
        p->place[chart].offset[1] = (p->best.origin[1] + best_y) / p->horizon.side;
    }
    return found;
}

/* Packs everything at one scale [texels a UV unit] in one order; false when something does not fit. */
static bool pack_at(packer *p, double scale, bool by_area)
{
    for (int32_t c = 0; c < p->count; c++) {
        p->order[c] = (pack_item){by_area ? p->area[c] : p->extent[c], c};
    }
    qsort(p->order, (size_t)p->count, sizeof *p->order, compare_items);
    memset(p->horizon.height, 0, (size_t)p->horizon.columns * sizeof *p->horizon.height);
    for (int32_t k = 0; k < p->count; k++) {
        if (!put_chart(p, p->order[k].chart, scale)) {
            return false;
        }
    }
    return true;
}

/* Keeps the places found when they are at a larger scale than any before. */
static bool attempt(packer *p, double scale, sl_pack_info *info)
{
    for (int32_t by_area = 0; by_area < 2; by_area++) {
        info->attempts++;
        if (pack_at(p, scale, by_area != 0)) {
            sl_placement *kept = p->best_place;
            p->best_place = p->place;
            p->place = kept;
            return true;
        }
    }
    return false;
}

/* No scale above this one can fit: all area must, and so must the longest chart along the page's diagonal. */
static double highest_scale(const packer *p, double area)
{
    double high = area > 0.0 ? p->horizon.side * sqrt(hopeful_fill / area) : 1.0;
    for (int32_t c = 0; area > 0.0 && c < p->count; c++) { /* needles: area alone is no bound to begin from */
        high = p->extent[c] > 0.0 ? fmin(high, root_two * p->horizon.side / p->extent[c]) : high;
    }
    return high;
}

/* Largest scale that fits, by bisection over counted attempts. */
static sl_status search_scale(packer *p, double area, const sl_context *context, sl_pack_info *info, double *scale)
{
    double high = highest_scale(p, area), low = 0.0;
    double trial = high * 0.75;
    for (int32_t k = 0; k < 2 * bisections; k++) {
        const sl_status status = sl_report_progress(context, "packing", (double)k / (2 * bisections));
        if (status != SL_OK) {
            return status;
        }
        if (attempt(p, trial, info)) {
            low = trial;
        } else {
            high = trial;
        }
        if (low > 0.0 && high - low < 2e-3 * low) {
            break;
        }
        trial = low > 0.0 ? 0.5 * (low + high) : 0.5 * high;
    }
    if (low <= 0.0 && (area > 0.0 || !attempt(p, 0.0, info))) { /* without area: one point each and their margins */
        return SL_INFEASIBLE;
    }
    *scale = low;
    return SL_OK;
}

/* The search with the largest chart turned a little each time. */
static sl_status search_turns(packer *p, double area, const sl_context *context, sl_placement *placement,
                              sl_pack_info *info, double *scale)
{
    const int32_t turns = p->def->turns > 1 ? p->def->turns : 1;
    int32_t largest = 0;
    for (int32_t c = 1; c < p->count; c++) {
        largest = p->area[c] > p->area[largest] ? c : largest;
    }
    for (int32_t turn = 0; turn < turns; turn++) {
        double found = 0.0;
        const sl_status status = search_scale(p, area, context, info, &found);
        if (status != SL_OK) {
            return status;
        }
        if (p->count > 0 && (turn == 0 || found > *scale)) {
            memcpy(placement, p->best_place, (size_t)p->count * sizeof *placement);
            *scale = found;
        }
        if (p->count > 0) {
            p->angle[largest] += 0.25 * two_pi / turns;
        }
    }
    return SL_OK;
}

sl_status sl_pack(int32_t count, const sl_pack_chart *charts, const sl_pack_def *def, const sl_context *context,
                  sl_placement *placement, sl_pack_info *info)
{
    SL_ASSERT(count >= 0 && def->resolution > 0 && def->rotations > 0 && def->margin >= 0.0);
    packer p = {.count = count, .charts = charts, .def = def};
    double area = 0.0, scale = 0.0;
    sl_status status = SL_OK;
    *info = (sl_pack_info){0};
    SL_TRY(packer_init(&p));
    for (int32_t c = 0; c < count; c++) {
        area += p.area[c];
    }
    SL_TRY(search_turns(&p, area, context, placement, info, &scale));
    info->scale = scale / p.horizon.side;
    info->fill = area * info->scale * info->scale;
cleanup:
    packer_clear(&p);
    return status;
}
