#include "overlap/raster_internal.h"

#include <math.h>
#include <stdlib.h>

/* Positions reach 2^38, so the numerators of far corners need more than 64 bits; the set-up alone. */
__extension__ typedef __int128 wide;

static const int64_t near_bound = INT64_C(1) << 29; /* below it every numerator fits 64 bits */

int64_t sl_raster_snap(double u, int32_t size)
{
    const float clip = 2.0f * (float)u - 1.0f; /* fl32(2u - 1): the doubling is exact */
    /* fmaf(clip, size / 2, size / 2): in double the sum is exact (clip is a multiple of 2^-25, size / 2 of 2^-1, 53
     * bits suffice), so the one rounding to float is that of the fused operation, on any processor. */
    const double half = 0.5 * size;
    const float window = (float)((double)clip * half + half);
    return llrintf((window - 0.5f) * (float)SL_RASTER_SUBPIXEL); /* half to even, the default rounding mode */
}

bool sl_raster_in_range(const double *uv, const int32_t tri[3])
{
    bool good = true;
    for (int k = 0; k < 3; k++) { /* a NaN compares false */
        const double *p = uv + 2 * (int64_t)tri[k];
        good = good && fabs(p[0]) <= SL_RASTER_MAX_COORDINATE && fabs(p[1]) <= SL_RASTER_MAX_COORDINATE;
    }
    return good;
}

bool sl_raster_triangle_set(const double *uv, const int32_t tri[3], int32_t width, int32_t height,
                            sl_raster_triangle *out)
{
    for (int k = 0; k < 3; k++) {
        const double *p = uv + 2 * (int64_t)tri[k];
        out->x[k] = sl_raster_snap(p[0], width);
        out->y[k] = sl_raster_snap(p[1], height);
    }
    const int64_t *x = out->x, *y = out->y;
    const wide area = (wide)(x[0] - x[1]) * (y[2] - y[0]) - (wide)(x[2] - x[0]) * (y[0] - y[1]);
    if (area < 0) {
        const int64_t x1 = x[1], y1 = y[1];
        out->x[1] = x[2];
        out->y[1] = y[2];
        out->x[2] = x1;
        out->y[2] = y1;
    }
    return area != 0;
}

/* floor(a / b) for b > 0. */
static int64_t floor_divide(int64_t a, int64_t b)
{
    const int64_t q = a / b;
    return q - (a % b < 0);
}

static int64_t least(int64_t a, int64_t b)
{
    return a < b ? a : b;
}

static int64_t greatest(int64_t a, int64_t b)
{
    return a > b ? a : b;
}

void sl_raster_rows(const sl_raster_triangle *triangle, int32_t height, int32_t *begin, int32_t *end)
{
    const int64_t *y = triangle->y;
    const int64_t low = least(y[0], least(y[1], y[2])), high = greatest(y[0], greatest(y[1], y[2]));
    *begin = (int32_t)greatest(0, least(height, floor_divide(low + SL_RASTER_SUBPIXEL - 1, SL_RASTER_SUBPIXEL)));
    *end = (int32_t)least(height, greatest(0, floor_divide(high, SL_RASTER_SUBPIXEL) + 1));
}

/* The edge's limit in the first row is floor(numerator / divisor), the numerator growing by `step` a row. Limits fit 64
 * bits: heights are float32 numbers, so two that differ do so by 2^-25 of themselves, and no limit exceeds 2^57. */
static void start_edge(sl_raster_edge *edge, wide numerator, int64_t divisor, int64_t step, bool near)
{
    edge->divisor = divisor;
    edge->limit_step = floor_divide(step, divisor);
    edge->rest_step = step - edge->limit_step * divisor;
    if (near) {
        edge->limit = floor_divide((int64_t)numerator, divisor);
        edge->rest = (int64_t)numerator - edge->limit * divisor;
        return;
    }
    const wide rest = numerator % divisor, limit = numerator / divisor - (rest < 0);
    edge->rest = (int64_t)(rest < 0 ? rest + divisor : rest);
    edge->limit = (int64_t)limit;
}

static void step_edge(sl_raster_edge *edge)
{
    edge->limit += edge->limit_step;
    edge->rest += edge->rest_step;
    if (edge->rest >= edge->divisor) {
        edge->rest -= edge->divisor;
        edge->limit++;
    }
}

/* A level edge only decides whether the row through it is inside: it is on the top-left side alone. */
static void trim_level_edge(sl_raster_walk *walk, const sl_raster_triangle *t, int i, int n)
{
    const bool counts = t->y[i] != t->y[n] || t->x[i] > t->x[n] || t->y[i] % SL_RASTER_SUBPIXEL != 0;
    const int64_t level = t->y[i] / SL_RASTER_SUBPIXEL;
    if (counts || walk->row >= walk->row_end) {
        return;
    }
    if (level == walk->row) {
        walk->row++;
    } else if (level == walk->row_end - 1) {
        walk->row_end--;
    }
}

/* Edge from corner i to corner n: texel (px, row) is inside iff  r - 256 dx px > 0  with
 * r = dx xi - dy (yi - 256 row) + bias.  For dx > 0 that is  px <= floor((r - 1) / (256 dx)), for dx < 0
 * px >= floor(-r / (256 |dx|)) + 1. */
static void add_slanted_edge(sl_raster_walk *walk, const sl_raster_triangle *t, int i, int n, bool near)
{
    const int64_t dx = t->y[i] - t->y[n], dy = t->x[i] - t->x[n];
    const int64_t down = t->y[i] - (int64_t)SL_RASTER_SUBPIXEL * walk->row;
    const int64_t bias = dx < 0;
    const wide r = near ? (wide)(dx * t->x[i] - dy * down + bias) : (wide)dx * t->x[i] - (wide)dy * down + bias;
    if (dx > 0) {
        start_edge(&walk->right[walk->right_count++], r - 1, SL_RASTER_SUBPIXEL * dx, SL_RASTER_SUBPIXEL * dy, near);
    } else if (dx < 0) {
        start_edge(&walk->left[walk->left_count++], -r, -SL_RASTER_SUBPIXEL * dx, -SL_RASTER_SUBPIXEL * dy, near);
    }
}

void sl_raster_walk_start(const sl_raster_triangle *triangle, int32_t width, int32_t row_begin, int32_t row_end,
                          sl_raster_walk *walk)
{
    bool near = true;
    walk->right_count = walk->left_count = 0;
    walk->row = row_begin;
    walk->row_end = row_end;
    walk->width = width;
    for (int k = 0; k < 3; k++) {
        trim_level_edge(walk, triangle, k, (k + 1) % 3);
        near = near && llabs(triangle->x[k]) < near_bound && llabs(triangle->y[k]) < near_bound;
    }
    for (int k = 0; k < 3; k++) {
        add_slanted_edge(walk, triangle, k, (k + 1) % 3, near);
    }
}

bool sl_raster_walk_next(sl_raster_walk *walk, int32_t *row, int32_t *begin, int32_t *end)
{
    if (walk->row >= walk->row_end) {
        return false;
    }
    int64_t first = 0, last = (int64_t)walk->width - 1;
    for (int32_t k = 0; k < walk->left_count; k++) {
        first = greatest(first, walk->left[k].limit + 1);
        step_edge(&walk->left[k]);
    }
    for (int32_t k = 0; k < walk->right_count; k++) {
        last = least(last, walk->right[k].limit);
        step_edge(&walk->right[k]);
    }
    *row = walk->row++;
    *begin = (int32_t)least(first, walk->width);
    *end = (int32_t)greatest(last + 1, 0);
    return true;
}
