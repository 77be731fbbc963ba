/* The visibility buffer of a band of rows. */
#include "render/frame_internal.h"

#include <math.h>
#include <string.h>

enum { SHORT_ROW = 12 };

static const float most_key = 4294967040.0f; /* the largest float below 2^32 */

/* value >= 0 inside; the top-left rule is in the value. Source: Pineda 1988, "A parallel algorithm for polygon
 * rasterization". */
typedef struct side {
    int64_t value, step_x, step_y;
} side;

typedef struct window {
    const sl_frame *frame;
    int32_t row, row_end;
} window;

static int32_t least(int32_t a, int32_t b)
{
    return a < b ? a : b;
}

static int32_t most(int32_t a, int32_t b)
{
    return a > b ? a : b;
}

static side make_side(const sl_frame_vertex *a, const sl_frame_vertex *b, int32_t px, int32_t py)
{
    const int64_t dx = (int64_t)b->x - a->x, dy = (int64_t)b->y - a->y;
    const int64_t value = dx * ((int64_t)SL_SUBPIXELS * py - a->y) - dy * ((int64_t)SL_SUBPIXELS * px - a->x);
    return (side){value - !(dy < 0 || (dy == 0 && dx > 0)), -SL_SUBPIXELS * dy, SL_SUBPIXELS * dx};
}

/* Offsets [*begin, *end) of a row where the side is positive. */
static void narrow(const side *s, int32_t *begin, int32_t *end)
{
    if (s->step_x > 0) {
        const int64_t skip = s->value >= 0 ? 0 : (s->step_x - 1 - s->value) / s->step_x;
        *begin = skip > *begin ? (skip < *end ? (int32_t)skip : *end) : *begin;
    } else if (s->step_x < 0) {
        const int64_t stop = s->value >= 0 ? s->value / -s->step_x + 1 : 0;
        *end = stop < *end ? (int32_t)stop : *end;
    } else if (s->value < 0) {
        *end = *begin;
    }
}

/* Depth over the picture, clamped to the triangle's own: slivers must not extrapolate. */
typedef struct plane {
    float at, dx, dy, lo, hi;
} plane;

static plane make_plane(const sl_frame_vertex *a, const sl_frame_vertex *b, const sl_frame_vertex *c, int64_t area,
                        int32_t px, int32_t py)
{
    const double scale = SL_SUBPIXELS / (double)area;
    const double bx = (double)b->x - a->x, by = (double)b->y - a->y, cx = (double)c->x - a->x, cy = (double)c->y - a->y;
    const double bk = (double)b->key - (double)a->key, ck = (double)c->key - (double)a->key;
    const double dx = (bk * cy - ck * by) * scale, dy = (ck * bx - bk * cx) * scale;
    const double at =
        (double)a->key + dx * (px - (double)a->x / SL_SUBPIXELS) + dy * (py - (double)a->y / SL_SUBPIXELS);
    const float near = a->key < b->key ? a->key : b->key, far = a->key > b->key ? a->key : b->key;
    const float lo = near < c->key ? near : c->key, hi = far > c->key ? far : c->key;
    return (plane){(float)at, (float)dx, (float)dy, lo > 0.0f ? lo : 0.0f, hi < 1.0f ? hi : 1.0f};
}

static void put(uint64_t *at, float key, const plane *p, uint32_t t)
{
    const float above = key > p->lo ? key : p->lo, bounded = above < p->hi ? above : p->hi;
    const uint64_t word = (uint64_t)(int64_t)(bounded * most_key) << 32 | t;
    *at = word < *at ? word : *at;
}

static void draw_row(uint64_t *row, int32_t length, const side s[3], const plane *p, float key, uint32_t t)
{
    if (length <= SHORT_ROW) {
        int64_t a = s[0].value, b = s[1].value, c = s[2].value;
        for (int32_t i = 0; i < length; i++) {
            if ((a | b | c) >= 0) {
                put(row + i, key + p->dx * (float)i, p, t);
            }
            a += s[0].step_x;
            b += s[1].step_x;
            c += s[2].step_x;
        }
        return;
    }
    int32_t begin = 0, end = length;
    for (int k = 0; k < 3; k++) {
        narrow(&s[k], &begin, &end);
    }
    for (int32_t i = begin; i < end; i++) {
        put(row + i, key + p->dx * (float)i, p, t);
    }
}

static void draw_triangle(const window *w, const sl_frame_vertex *a, const sl_frame_vertex *b, const sl_frame_vertex *c,
                          uint32_t t)
{
    const sl_frame *f = w->frame;
    const int32_t x0 = most((least(least(a->x, b->x), c->x) + SL_SUBPIXELS - 1) >> 8, 0);
    const int32_t x1 = least(most(most(a->x, b->x), c->x) >> 8, f->width - 1);
    const int32_t y0 = most((least(least(a->y, b->y), c->y) + SL_SUBPIXELS - 1) >> 8, w->row);
    const int32_t y1 = least(most(most(a->y, b->y), c->y) >> 8, w->row_end - 1);
    const int64_t area =
        ((int64_t)b->x - a->x) * ((int64_t)c->y - a->y) - ((int64_t)c->x - a->x) * ((int64_t)b->y - a->y);
    if (x0 > x1 || y0 > y1 || area == 0 || (f->style.cull && area > 0)) {
        return;
    }
    const plane p = make_plane(a, b, c, area, x0, y0);
    if (area < 0) {
        const sl_frame_vertex *swap = b;
        b = c;
        c = swap;
    }
    side s[3] = {make_side(a, b, x0, y0), make_side(b, c, x0, y0), make_side(c, a, x0, y0)};
    for (int32_t y = y0; y <= y1; y++) {
        draw_row(f->zid + (int64_t)y * f->width + x0, x1 - x0 + 1, s, &p, p.at + p.dy * (float)(y - y0), t);
        for (int k = 0; k < 3; k++) {
            s[k].value += s[k].step_y;
        }
    }
}

/* Clips at the near plane; the cut of an edge is the same from both its triangles. */
static void draw_clipped(const window *w, uint32_t t)
{
    const sl_frame *f = w->frame;
    const double near = f->camera.near_depth;
    double eye[3][3];
    sl_frame_vertex corner[4];
    int32_t count = 0;
    for (int k = 0; k < 3; k++) {
        sl_camera_to_eye(&f->camera, f->xyz + 3 * (int64_t)f->tri[3 * (int64_t)t + k], eye[k]);
        if (!isfinite(eye[k][0] + eye[k][1] + eye[k][2]) || !f->camera.perspective) {
            return;
        }
    }
    for (int k = 0; k < 3; k++) {
        const double *p = eye[k], *q = eye[(k + 1) % 3];
        if (p[2] >= near) {
            sl_frame_snap(f, p, &corner[count++]);
        }
        if ((p[2] >= near) != (q[2] >= near)) {
            const double *in = p[2] >= near ? p : q, *out = p[2] >= near ? q : p;
            const double s = (in[2] - near) / (in[2] - out[2]);
            const double cut[3] = {in[0] + s * (out[0] - in[0]), in[1] + s * (out[1] - in[1]), near};
            sl_frame_snap(f, cut, &corner[count++]);
        }
    }
    for (int32_t k = 0; k < count; k++) {
        if (corner[k].x == SL_FRAME_FAR) {
            return;
        }
    }
    for (int32_t k = 2; k < count; k++) {
        draw_triangle(w, &corner[0], &corner[k - 1], &corner[k], t);
    }
}

void sl_frame_raster(const sl_frame *f, int32_t band, int32_t row, int32_t row_end)
{
    const window w = {f, row, row_end};
    memset(f->zid + (int64_t)row * f->width, 0xff, (size_t)(row_end - row) * (size_t)f->width * sizeof *f->zid);
    for (int64_t i = f->band_first[band]; i < f->band_first[band + 1]; i++) {
        const int32_t t = f->banded[i];
        const sl_frame_vertex *a = &f->vertex[f->tri[3 * (int64_t)t]], *b = &f->vertex[f->tri[3 * (int64_t)t + 1]],
                              *c = &f->vertex[f->tri[3 * (int64_t)t + 2]];
        if (a->x == SL_FRAME_FAR || b->x == SL_FRAME_FAR || c->x == SL_FRAME_FAR) {
            draw_clipped(&w, (uint32_t)t);
        } else {
            draw_triangle(&w, a, b, c, (uint32_t)t);
        }
    }
}
