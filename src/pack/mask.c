#include "pack/mask.h"

#include "base/memory.h"

#include <math.h>
#include <stdlib.h>

/* A span along an edge counts so much in the sums, a triangle over a cell's centre 1. */
enum { TOUCHED = 1 << 16 };

static const double rounding = 1e-6; /* cells: what positions may be off by rounding */

/* The row sums of a mask in the making: value[j] = sum of diff[0 .. j] in its row. */
typedef struct raster {
    int32_t width, height, stride;
    int32_t *diff; /* height x stride */
    double cosine, sine, scale, grow;
    double low[2];
} raster;

static void turn(const raster *r, const double from[2], double to[2])
{
    to[0] = r->scale * (r->cosine * from[0] - r->sine * from[1]);
    to[1] = r->scale * (r->sine * from[0] + r->cosine * from[1]);
}

/* The rightmost x at height y of all points within grow of the segment ab; -HUGE_VAL where there are none. */
static double right_side(const double a[2], const double b[2], double grow, double y)
{
    double x = -HUGE_VAL;
    const double da = y - a[1], db = y - b[1], square = grow * grow;
    if (da * da <= square) {
        x = a[0] + sqrt(square - da * da);
    }
    if (db * db <= square) {
        x = fmax(x, b[0] + sqrt(square - db * db));
    }
    const double dx = b[0] - a[0], dy = b[1] - a[1], length = sqrt(dx * dx + dy * dy);
    if (fabs(dy) > 0.0) { /* the edge moved to its right by grow */
        const double nx = fabs(dy) / length, ny = dy > 0.0 ? -dx / length : dx / length;
        const double t = (y - a[1] - grow * ny) / dy;
        if (t >= 0.0 && t <= 1.0) {
            x = fmax(x, a[0] + t * dx + grow * nx);
        }
    }
    return x;
}

/* The farthest that the grown segment reaches to the right within the row of cells [y, y + 1]: its sides are concave,
 * so that is at its rightmost point, or else at the row's edge nearest to that. */
static double reach(const double a[2], const double b[2], double grow, double y)
{
    const double *far = a[0] >= b[0] ? a : b;
    if (far[1] >= y && far[1] <= y + 1.0) {
        return far[0] + grow;
    }
    const double x = right_side(a, b, grow, far[1] < y ? y : y + 1.0);
    return x > -HUGE_VAL ? x : fmax(a[0], b[0]) + grow; /* a tip that rounding lost */
}

/* Cells that the grown edge touches. */
static void cover_edge(raster *r, const double a[2], const double b[2])
{
    const double grow = r->grow + rounding;
    const double low = fmin(a[1], b[1]) - grow, high = fmax(a[1], b[1]) + grow;
    const int32_t first = (int32_t)fmax(0.0, floor(low)), last = (int32_t)fmin(r->height - 1.0, floor(high));
    const double ma[2] = {-a[0], a[1]}, mb[2] = {-b[0], b[1]};
    for (int32_t row = first; row <= last; row++) {
        const int32_t right = (int32_t)fmin(r->width - 1.0, floor(reach(a, b, grow, row)));
        const int32_t left = (int32_t)fmax(0.0, floor(-reach(ma, mb, grow, row)));
        if (left <= right) {
            r->diff[(int64_t)row * r->stride + left] += TOUCHED;
            r->diff[(int64_t)row * r->stride + right + 1] -= TOUCHED;
        }
    }
}

/* What lies right of the edge, by cell centres: +1 where it runs down, -1 where it runs up. */
static void cross_edge(raster *r, const double a[2], const double b[2])
{
    const bool up = a[1] < b[1];
    const double *low = up ? a : b, *high = up ? b : a;
    const int32_t first = (int32_t)fmax(0.0, ceil(low[1] - 0.5));
    const int32_t end = (int32_t)fmin(r->height, ceil(high[1] - 0.5));
    for (int32_t row = first; row < end; row++) {
        const double t = (row + 0.5 - low[1]) / (high[1] - low[1]);
        const double x = ceil(low[0] + t * (high[0] - low[0]) - 0.5);
        const int32_t column = (int32_t)fmin(r->width, fmax(0.0, x));
        r->diff[(int64_t)row * r->stride + column] += up ? -1 : 1;
    }
}

static void draw(raster *r, const sl_outline *outline)
{
    for (int32_t k = 0; k < outline->count; k++) {
        double a[2], b[2];
        turn(r, outline->edge[k].from, a);
        turn(r, outline->edge[k].to, b);
        for (int i = 0; i < 2; i++) {
            a[i] -= r->low[i];
            b[i] -= r->low[i];
        }
        cover_edge(r, a, b);
        cross_edge(r, a, b);
    }
}

/* Box of the turned, grown outline. */
static void measure(raster *r, const sl_outline *outline, double high[2])
{
    r->low[0] = r->low[1] = HUGE_VAL;
    high[0] = high[1] = -HUGE_VAL;
    for (int32_t k = 0; k < outline->count; k++) {
        double p[2][2];
        turn(r, outline->edge[k].from, p[0]);
        turn(r, outline->edge[k].to, p[1]);
        for (int i = 0; i < 4; i++) {
            r->low[i % 2] = fmin(r->low[i % 2], p[i / 2][i % 2]);
            high[i % 2] = fmax(high[i % 2], p[i / 2][i % 2]);
        }
    }
    for (int i = 0; i < 2; i++) { /* the box stands in the middle of the cells it needs */
        const double size = high[i] - r->low[i] + 2.0 * (r->grow + rounding);
        const double spare = 0.5 * (ceil(size) - size);
        r->low[i] -= r->grow + rounding + spare;
        high[i] += r->grow + rounding + spare;
    }
}

static int compare_runs(const void *pa, const void *pb)
{
    const sl_mask_run *a = pa, *b = pb;
    if (a->length != b->length) {
        return a->length > b->length ? -1 : 1;
    }
    if (a->row != b->row) {
        return a->row < b->row ? -1 : 1;
    }
    return (a->left > b->left) - (a->left < b->left);
}

/* Lists the covered runs of a row; list has room for as many as a row can have. Returns how many. */
static int32_t list_row(const raster *r, int32_t row, sl_mask_run *list)
{
    const int32_t *diff = r->diff + (int64_t)row * r->stride;
    int32_t count = 0, sum = 0, begin = -1;
    for (int32_t x = 0; x <= r->width; x++) {
        if (diff[x] == 0) {
            continue;
        }
        sum += diff[x];
        if (sum > 0 && begin < 0) {
            begin = x;
        } else if (sum <= 0 && begin >= 0) {
            list[count++] = (sl_mask_run){row, begin, x - begin};
            begin = -1;
        }
    }
    if (begin >= 0) { /* never, by exact arithmetic: the sum of a row is 0 */
        list[count++] = (sl_mask_run){row, begin, r->width - begin};
    }
    return count;
}

static sl_status list_runs(const raster *r, sl_mask *out)
{
    int64_t capacity = 0;
    for (int32_t row = 0; row < r->height; row++) {
        const sl_status status =
            sl_reserve((void **)&out->run, &capacity, (int64_t)out->count + r->width / 2 + 1, sizeof *out->run);
        if (status != SL_OK) {
            return status;
        }
        out->count += list_row(r, row, out->run + out->count);
    }
    double sum[3] = {0.0, 0.0, 0.0}; /* exact: whole numbers far below 2^53 */
    for (int32_t k = 0; k < out->count; k++) {
        const sl_mask_run *run = &out->run[k];
        sum[0] += run->length;
        sum[1] += (double)run->length * (2.0 * run->left + run->length);
        sum[2] += (double)run->length * (2.0 * run->row + 1.0);
    }
    for (int i = 0; i < 2; i++) {
        out->centre[i] = (int32_t)(sum[i + 1] / fmax(1.0, sum[0]));
    }
    out->cells = (int64_t)sum[0];
    qsort(out->run, (size_t)out->count, sizeof *out->run, compare_runs);
    return SL_OK;
}

sl_status sl_mask_init(const sl_outline *outline, double angle, double scale, double grow, int32_t max_width,
                       int32_t max_height, sl_mask *out)
{
    raster r = {.cosine = cos(angle), .sine = sin(angle), .scale = scale, .grow = grow};
    double high[2];
    *out = (sl_mask){.angle = angle};
    measure(&r, outline, high);
    const double width = ceil(high[0] - r.low[0] - rounding), height = ceil(high[1] - r.low[1] - rounding);
    if (!(width <= max_width && height <= max_height)) {
        return SL_OK;
    }
    r.width = (int32_t)fmax(1.0, width);
    r.height = (int32_t)fmax(1.0, height);
    r.stride = r.width + 1;
    r.diff = sl_calloc((int64_t)r.stride * r.height, sizeof *r.diff);
    if (r.diff == NULL) {
        return SL_OUT_OF_MEMORY;
    }
    draw(&r, outline);
    out->width = r.width;
    out->height = r.height;
    out->origin[0] = -r.low[0];
    out->origin[1] = -r.low[1];
    const sl_status status = list_runs(&r, out);
    sl_free(r.diff);
    return status;
}

void sl_pack_mask_clear(sl_mask *mask)
{
    sl_free(mask->run);
    *mask = (sl_mask){0};
}
