/* Triangles that do not go by eight: those too large for 32 bits, and those clipped at the near plane. */
#include "render/frame_internal.h"

#include <math.h>

/* A polygon on the picture: a triangle, or what the near plane leaves of it. */
typedef struct outline {
    int32_t count;
    sl_frame_vertex corner[4];
} outline;

static int32_t least(int32_t a, int32_t b)
{
    return a < b ? a : b;
}

static int32_t most(int32_t a, int32_t b)
{
    return a > b ? a : b;
}

/* Where an edge meets the near plane: computed from its end in front, so the same for both its triangles. */
static sl_frame_vertex cut_edge(const sl_frame *f, const double p[3], const double q[3])
{
    const double near = f->camera.near_depth;
    const double *in = p[2] >= near ? p : q, *out = p[2] >= near ? q : p;
    const double s = (in[2] - near) / (in[2] - out[2]);
    const double cut[3] = {in[0] + s * (out[0] - in[0]), in[1] + s * (out[1] - in[1]), near};
    sl_frame_vertex vertex = {.cosine = 0.0f};
    sl_frame_snap(f, cut, &vertex);
    return vertex;
}

/* What of the triangle is in front of the near plane; count 0: nothing, or it reaches too far beside the picture. */
static outline find_outline(const sl_frame *f, int32_t t)
{
    outline o = {.count = 0};
    double eye[3][3];
    const int32_t *tri = f->tri + 3 * (int64_t)t;
    bool behind[3];
    for (int k = 0; k < 3; k++) {
        const sl_frame_vertex *v = &f->vertex[tri[k]];
        behind[k] = v->x == SL_FRAME_FAR && v->y == SL_FRAME_BEHIND;
        if (v->x == SL_FRAME_FAR && !behind[k]) {
            return o;
        }
        sl_camera_to_eye(&f->camera, f->xyz + 3 * (int64_t)tri[k], eye[k]);
    }
    for (int k = 0; k < 3; k++) {
        const int next = (k + 1) % 3;
        if (!behind[k]) {
            o.corner[o.count++] = f->vertex[tri[k]];
        }
        if (behind[k] != behind[next]) {
            o.corner[o.count++] = cut_edge(f, eye[k], eye[next]);
        }
    }
    for (int32_t k = 0; k < o.count; k++) {
        if (o.corner[k].x == SL_FRAME_FAR) {
            return (outline){.count = 0};
        }
    }
    return o;
}

/* Twice the area, negative seen from the front. */
static int64_t area_of(const sl_frame_vertex *a, const sl_frame_vertex *b, const sl_frame_vertex *c)
{
    return ((int64_t)b->x - a->x) * ((int64_t)c->y - a->y) - ((int64_t)c->x - a->x) * ((int64_t)b->y - a->y);
}

bool sl_frame_keep_odd(const sl_frame *f, int32_t t, sl_frame_span *span)
{
    const outline o = find_outline(f, t);
    int32_t lo[2] = {INT32_MAX, INT32_MAX}, hi[2] = {INT32_MIN, INT32_MIN};
    int64_t area = 0;
    for (int32_t k = 0; k < o.count; k++) {
        lo[0] = least(lo[0], o.corner[k].x);
        hi[0] = most(hi[0], o.corner[k].x);
        lo[1] = least(lo[1], o.corner[k].y);
        hi[1] = most(hi[1], o.corner[k].y);
        area += k >= 2 ? area_of(&o.corner[0], &o.corner[k - 1], &o.corner[k]) : 0;
    }
    if (o.count == 0 || area == 0 || (f->style.cull && area > 0)) {
        return false;
    }
    const int32_t x0 = most((lo[0] + SL_SUBPIXELS - 1) >> 8, 0), x1 = least(hi[0] >> 8, f->width - 1);
    const int32_t y0 = most((lo[1] + SL_SUBPIXELS - 1) >> 8, 0), y1 = least(hi[1] >> 8, f->height - 1);
    if (x0 > x1 || y0 > y1) {
        return false;
    }
    *span = (sl_frame_span){(uint16_t)(y0 / SL_FRAME_BAND), (uint16_t)(y1 / SL_FRAME_BAND)};
    return true;
}

/* As edge8 of the kernels, in 64 bits. */
typedef struct side {
    int64_t value, step_x, step_y;
} side;

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
    return (plane){(float)at, (float)dx, (float)dy, near < c->key ? near : c->key, far > c->key ? far : c->key};
}

/* Without branches, so that compilers take several pixels at a time. */
static void fill_row(const plane *p, float row, int32_t begin, int32_t end, int32_t place, float *restrict depth,
                     int32_t *restrict seen)
{
    for (int32_t i = begin; i < end; i++) {
        const float at = row + p->dx * (float)i, above = at > p->lo ? at : p->lo, key = above < p->hi ? above : p->hi;
        const bool nearer = key < depth[i];
        depth[i] = nearer ? key : depth[i];
        seen[i] = nearer ? place : seen[i];
    }
}

static void raster_one(const sl_frame *f, const sl_frame_vertex *a, const sl_frame_vertex *b, const sl_frame_vertex *c,
                       int32_t place, int32_t row, int32_t row_end)
{
    const int32_t x0 = most((least(least(a->x, b->x), c->x) + SL_SUBPIXELS - 1) >> 8, 0);
    const int32_t x1 = least(most(most(a->x, b->x), c->x) >> 8, f->width - 1);
    const int32_t y0 = most((least(least(a->y, b->y), c->y) + SL_SUBPIXELS - 1) >> 8, row);
    const int32_t y1 = least(most(most(a->y, b->y), c->y) >> 8, row_end - 1);
    const int64_t area = area_of(a, b, c);
    if (x0 > x1 || y0 > y1 || area == 0) {
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
        const int64_t first = (int64_t)y * f->stride + x0;
        int32_t begin = 0, end = x1 - x0 + 1;
        for (int k = 0; k < 3; k++) {
            narrow(&s[k], &begin, &end);
            s[k].value += s[k].step_y;
        }
        fill_row(&p, p.at + p.dy * (float)(y - y0), begin, end, place, f->depth + first, f->seen + first);
    }
}

void sl_frame_raster_odd(const sl_frame *f, int32_t t, int32_t place, int32_t row, int32_t row_end)
{
    const outline o = find_outline(f, t);
    for (int32_t k = 2; k < o.count; k++) {
        raster_one(f, &o.corner[0], &o.corner[k - 1], &o.corner[k], place, row, row_end);
    }
}
