/* Antialiased lines over a band of rows, hidden where the surface is nearer. */
#include "render/frame_internal.h"

#include <float.h>
#include <math.h>

static const double depth_slack = 3e-4; /* of the key's range: snapped corners leave the plane by less */
enum { LINE_CHUNK = 1 << 12 };

static const double line_guard = 128.0; /* pixels beside the picture that clipped lines may reach */

/* A line on the picture, in pixels relative to pixel centres. */
typedef struct stroke {
    double a[2], b[2], key[2], half;
    const uint8_t *rgb;
    double d[2], per_square, per_major, reach, most; /* set when it is drawn */
    bool steep;                                      /* the long axis is y */
} stroke;

/* Without calls, unlike the library's: a frame may hold a hundred thousand lines. */
static inline double lesser(double a, double b)
{
    return a < b ? a : b;
}

static inline double greater(double a, double b)
{
    return a > b ? a : b;
}

/* |x| below 2^31. */
static inline int32_t floor_of(double x)
{
    const int32_t whole = (int32_t)x;
    return whole - (x < whole);
}

static inline int32_t ceil_of(double x)
{
    return -floor_of(-x);
}

/* Depth of the surface seen at the pixel nearest to (x, y), followed along its own slope to (x, y). */
static double surface_key(const sl_frame *f, double x, double y)
{
    const int32_t ix = floor_of(x + 0.5), iy = floor_of(y + 0.5);
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
    const double lo = lesser(lesser((double)a->key, (double)b->key), (double)c->key);
    const double hi = greater(greater((double)a->key, (double)b->key), (double)c->key);
    return lesser(greater(moved, lo), hi);
}

static void blend(uint8_t *out, const uint8_t rgb[3], double amount)
{
    for (int k = 0; k < 3; k++) {
        out[k] = (uint8_t)(out[k] + amount * (rgb[k] - out[k]) + 0.5);
    }
}

/* How far a line's pixels are from its middle, at most 45 degrees askew. */
static double reach_of(const stroke *s)
{
    return 1.5 * (s->half + 0.5);
}

/* The pixels across the line at position `at` of its long axis. */
static void cross_section(const sl_frame *f, const stroke *s, int32_t at, int32_t row, int32_t row_end, uint8_t *rgba)
{
    const int major = s->steep ? 1 : 0, minor = 1 - major;
    const double part = lesser(greater((at - s->a[major]) * s->per_major, 0.0), 1.0);
    const double middle[2] = {s->a[0] + part * s->d[0], s->a[1] + part * s->d[1]};
    if (s->key[0] + part * (s->key[1] - s->key[0]) > surface_key(f, middle[0], middle[1]) + depth_slack) {
        return;
    }
    const int32_t begin = ceil_of(greater(middle[minor] - s->reach, minor == 1 ? row : 0));
    const int32_t end = floor_of(lesser(middle[minor] + s->reach, minor == 1 ? row_end - 1 : f->width - 1));
    for (int32_t k = begin; k <= end; k++) {
        const int32_t x = s->steep ? k : at, y = s->steep ? at : k;
        const double px = x - s->a[0], py = y - s->a[1];
        const double u = lesser(greater((px * s->d[0] + py * s->d[1]) * s->per_square, 0.0), 1.0);
        const double dx = px - u * s->d[0], dy = py - u * s->d[1];
        const double coverage = lesser(s->half + 0.5 - sqrt(dx * dx + dy * dy), s->most);
        if (coverage > 0.0) {
            blend(rgba + 4 * ((int64_t)y * f->width + x), s->rgb, coverage);
        }
    }
}

static void draw_stroke(const sl_frame *f, stroke *s, int32_t row, int32_t row_end, uint8_t *rgba)
{
    s->reach = reach_of(s);
    s->d[0] = s->b[0] - s->a[0];
    s->d[1] = s->b[1] - s->a[1];
    s->steep = fabs(s->d[1]) > fabs(s->d[0]);
    s->most = lesser(2.0 * s->half, 1.0);
    const int major = s->steep ? 1 : 0;
    const double square = s->d[0] * s->d[0] + s->d[1] * s->d[1];
    s->per_square = square > 0.0 ? 1.0 / square : 0.0;
    s->per_major = s->d[major] != 0.0 ? 1.0 / s->d[major] : 0.0;
    const double lo = lesser(s->a[major], s->b[major]), hi = greater(s->a[major], s->b[major]);
    const int32_t begin = ceil_of(greater(lo - s->half, s->steep ? row : 0));
    const int32_t end = floor_of(lesser(hi + s->half, s->steep ? row_end - 1 : f->width - 1));
    for (int32_t at = begin; at <= end; at++) {
        cross_section(f, s, at, row, row_end, rgba);
    }
}

/* Keeps of [*from, *to] what is not below 0 of a function that is d0 at 0 and d1 at 1, and linear between. */
static void cut(double d0, double d1, double *from, double *to)
{
    if (d0 < 0.0 && d1 < 0.0) {
        *to = -1.0;
    } else if (d0 < 0.0) {
        *from = fmax(*from, d0 / (d0 - d1));
    } else if (d1 < 0.0) {
        *to = fmin(*to, d0 / (d0 - d1));
    }
}

/* A line with an end off the picture's plane: what is in front of the near plane and near the picture. */
static bool clip_line(const sl_frame *f, int32_t v, int32_t w, stroke *s)
{
    const sl_camera *c = &f->camera;
    const double size[2] = {f->width, f->height}, scale = f->height * c->focal;
    double p[2][3], from = 0.0, to = 1.0;
    sl_camera_to_eye(c, f->xyz + 3 * (int64_t)v, p[0]);
    sl_camera_to_eye(c, f->xyz + 3 * (int64_t)w, p[1]);
    for (int i = 0; i < 2; i++) {
        if (!(fabs(p[i][0]) + fabs(p[i][1]) + fabs(p[i][2]) < DBL_MAX)) {
            return false;
        }
    }
    if (c->perspective) {
        cut(p[0][2] - c->near_depth, p[1][2] - c->near_depth, &from, &to);
    }
    for (int axis = 0; axis < 2; axis++) { /* both conditions times the depth, which makes them linear */
        const double before = c->centre[axis] * size[axis] + line_guard, after = size[axis] + 2.0 * line_guard - before;
        const double sign = axis == 0 ? scale : -scale;
        const double z0 = c->perspective ? p[0][2] : 1.0, z1 = c->perspective ? p[1][2] : 1.0;
        cut(before * z0 + sign * p[0][axis], before * z1 + sign * p[1][axis], &from, &to);
        cut(after * z0 - sign * p[0][axis], after * z1 - sign * p[1][axis], &from, &to);
    }
    for (int i = 0; i < 2 && from < to; i++) {
        const double at = i == 0 ? from : to;
        double eye[3], *end = i == 0 ? s->a : s->b;
        for (int k = 0; k < 3; k++) {
            eye[k] = p[0][k] + at * (p[1][k] - p[0][k]);
        }
        sl_camera_project(c, f->width, f->height, eye, end);
        end[0] -= 0.5;
        end[1] -= 0.5;
        s->key[i] = f->key_offset + f->key_scale * (c->perspective ? 1.0 / eye[2] : eye[2]);
    }
    const double reach = from < to ? fabs(s->a[0]) + fabs(s->a[1]) + fabs(s->b[0]) + fabs(s->b[1]) : INFINITY;
    return reach < SL_FRAME_FARTHEST; /* rounding may have spoilt it: false for NaN, too */
}

/* The line from v to w; s->half and s->rgb are set. */
static bool find_line(const sl_frame *f, int32_t v, int32_t w, stroke *s)
{
    const sl_frame_vertex *end[2] = {&f->vertex[v], &f->vertex[w]};
    if (end[0]->x == SL_FRAME_FAR || end[1]->x == SL_FRAME_FAR) {
        return clip_line(f, v, w, s);
    }
    for (int i = 0; i < 2; i++) {
        double *at = i == 0 ? s->a : s->b;
        at[0] = (double)end[i]->x / SL_SUBPIXELS;
        at[1] = (double)end[i]->y / SL_SUBPIXELS;
        s->key[i] = (double)end[i]->key;
    }
    return true;
}

typedef struct span_task {
    const sl_frame *frame;
    const sl_frame_lines *lines;
} span_task;

static void span_lines(void *user, int64_t begin, int64_t end, int32_t chunk)
{
    (void)chunk;
    const span_task *task = user;
    const sl_frame *f = task->frame;
    for (int64_t i = begin; i < end; i++) {
        stroke s = {.half = 0.5 * task->lines->width, .rgb = task->lines->rgb};
        sl_frame_span span = {1, 0};
        if (find_line(f, task->lines->pair[2 * i], task->lines->pair[2 * i + 1], &s)) {
            const double reach = reach_of(&s), last = f->height - 1;
            const double lo = lesser(s.a[1], s.b[1]) - reach, hi = greater(s.a[1], s.b[1]) + reach;
            if (hi >= 0.0 && lo <= last) {
                span.first = (uint16_t)(floor_of(greater(lo, 0.0)) / SL_FRAME_BAND);
                span.last = (uint16_t)(floor_of(lesser(hi, last)) / SL_FRAME_BAND);
            }
        }
        task->lines->span[i] = span;
    }
}

void sl_frame_span_lines(sl_frame *f, const sl_context *context)
{
    for (int layer = 0; layer < SL_FRAME_LAYERS; layer++) {
        span_task task = {f, &f->lines[layer]};
        sl_parallel_for(context, task.lines->count, LINE_CHUNK, span_lines, &task);
    }
}

void sl_frame_draw_lines(const sl_frame *f, int32_t band, int32_t row, int32_t row_end, uint8_t *rgba)
{
    for (int layer = 0; layer < SL_FRAME_LAYERS; layer++) {
        const sl_frame_lines *lines = &f->lines[layer];
        for (int64_t i = 0; i < lines->count; i++) {
            if (lines->span[i].first > band || lines->span[i].last < band) {
                continue;
            }
            stroke s;
            s.half = 0.5 * lines->width;
            s.rgb = lines->rgb;
            if (find_line(f, lines->pair[2 * i], lines->pair[2 * i + 1], &s)) {
                draw_stroke(f, &s, row, row_end, rgba);
            }
        }
    }
}
