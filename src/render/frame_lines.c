/* Antialiased lines over a band of rows, hidden where the surface is nearer. */
#include "render/frame_internal.h"

#include <math.h>

static const double depth_slack = 3e-4; /* of the key's range: snapped corners leave the plane by less */

/* A line on the picture, in pixels relative to pixel centres. */
typedef struct stroke {
    double a[2], b[2], key[2], half;
    const uint8_t *rgb;
} stroke;

/* Depth of the surface seen at the pixel nearest to (x, y), followed along its own slope to (x, y). */
static double surface_key(const sl_frame *f, double x, double y)
{
    const int32_t ix = (int32_t)floor(x + 0.5), iy = (int32_t)floor(y + 0.5);
    if (ix < 0 || iy < 0 || ix >= f->width || iy >= f->height) {
        return 2.0;
    }
    const int32_t t = sl_frame_triangle(f, ix, iy);
    const double key = (double)f->depth[(int64_t)iy * f->stride + ix];
    if (t < 0 || sl_frame_is_off(f, t)) {
        return key;
    }
    const sl_frame_vertex *a = &f->vertex[f->tri[3 * (int64_t)t]], *b = &f->vertex[f->tri[3 * (int64_t)t + 1]],
                          *c = &f->vertex[f->tri[3 * (int64_t)t + 2]];
    const double bx = (double)b->x - a->x, by = (double)b->y - a->y, cx = (double)c->x - a->x, cy = (double)c->y - a->y;
    const double bk = (double)b->key - (double)a->key, ck = (double)c->key - (double)a->key;
    const double scale = SL_SUBPIXELS / (bx * cy - cx * by);
    const double moved = key + scale * ((bk * cy - ck * by) * (x - ix) + (ck * bx - bk * cx) * (y - iy));
    const double lo = (double)fminf(fminf(a->key, b->key), c->key), hi = (double)fmaxf(fmaxf(a->key, b->key), c->key);
    return fmin(fmax(moved, lo), hi);
}

static void blend(uint8_t *out, const uint8_t rgb[3], double amount)
{
    for (int k = 0; k < 3; k++) {
        out[k] = (uint8_t)(out[k] + amount * (rgb[k] - out[k]) + 0.5);
    }
}

/* The pixels across the line at position `at` of its long axis; `steep`: that axis is y. */
static void cross_section(const sl_frame *f, const stroke *s, bool steep, int32_t at, int32_t row, int32_t row_end,
                          uint8_t *rgba)
{
    const int major = steep ? 1 : 0, minor = 1 - major;
    const double d[2] = {s->b[0] - s->a[0], s->b[1] - s->a[1]}, square = d[0] * d[0] + d[1] * d[1];
    const double part = fmin(fmax((at - s->a[major]) / (d[major] == 0.0 ? 1.0 : d[major]), 0.0), 1.0);
    const double middle[2] = {s->a[0] + part * d[0], s->a[1] + part * d[1]};
    if (s->key[0] + part * (s->key[1] - s->key[0]) > surface_key(f, middle[0], middle[1]) + depth_slack) {
        return;
    }
    const double reach = 1.5 * (s->half + 0.5); /* at most 45 degrees askew */
    const int32_t begin = (int32_t)fmax(ceil(middle[minor] - reach), minor == 1 ? row : 0);
    const int32_t end = (int32_t)fmin(floor(middle[minor] + reach), minor == 1 ? row_end - 1 : f->width - 1);
    for (int32_t k = begin; k <= end; k++) {
        const int32_t x = steep ? k : at, y = steep ? at : k;
        const double px = x - s->a[0], py = y - s->a[1];
        const double u = square > 0.0 ? fmin(fmax((px * d[0] + py * d[1]) / square, 0.0), 1.0) : 0.0;
        const double distance = hypot(px - u * d[0], py - u * d[1]);
        const double coverage = fmin(s->half + 0.5 - distance, fmin(2.0 * s->half, 1.0));
        if (coverage > 0.0) {
            blend(rgba + 4 * ((int64_t)y * f->width + x), s->rgb, coverage);
        }
    }
}

static void draw_stroke(const sl_frame *f, const stroke *s, int32_t row, int32_t row_end, uint8_t *rgba)
{
    const double reach = 1.5 * (s->half + 0.5);
    if (!(fmax(s->a[1], s->b[1]) + reach >= row && fmin(s->a[1], s->b[1]) - reach < row_end)) {
        return;
    }
    const bool steep = fabs(s->b[1] - s->a[1]) > fabs(s->b[0] - s->a[0]);
    const int major = steep ? 1 : 0;
    const double lo = fmin(s->a[major], s->b[major]), hi = fmax(s->a[major], s->b[major]);
    const int32_t begin = (int32_t)fmax(ceil(lo - s->half), steep ? row : 0);
    const int32_t end = (int32_t)fmin(floor(hi + s->half), steep ? row_end - 1 : f->width - 1);
    for (int32_t at = begin; at <= end; at++) {
        cross_section(f, s, steep, at, row, row_end, rgba);
    }
}

void sl_frame_draw_lines(const sl_frame *f, int32_t row, int32_t row_end, uint8_t *rgba)
{
    for (int layer = 0; layer < SL_FRAME_LAYERS; layer++) {
        const sl_frame_lines *lines = &f->lines[layer];
        for (int32_t i = 0; i < lines->count; i++) {
            const sl_frame_vertex *a = &f->vertex[lines->pair[2 * (int64_t)i]],
                                  *b = &f->vertex[lines->pair[2 * (int64_t)i + 1]];
            if (a->x == SL_FRAME_FAR || b->x == SL_FRAME_FAR) {
                continue;
            }
            const stroke s = {{(double)a->x / SL_SUBPIXELS, (double)a->y / SL_SUBPIXELS},
                              {(double)b->x / SL_SUBPIXELS, (double)b->y / SL_SUBPIXELS},
                              {(double)a->key, (double)b->key},
                              0.5 * lines->width,
                              lines->rgb};
            draw_stroke(f, &s, row, row_end, rgba);
        }
    }
}
