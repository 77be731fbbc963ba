#include "draw/mask.h"

#include <math.h>
#include <string.h>

static const double far_away = 1e7;                  /* samples; positions beyond are not drawn */
static const double flat_slack = 1.0;                /* a line passes this many samples' size behind the surface ... */
static const double steep_slack = 2.0;               /* ... and this many half widths where the surface is steep */
static const double snap_slack = 2.0 / SL_SUBPIXELS; /* positions of surfaces are snapped, those of lines are not */

void sl_mask_clear(sl_mask *mask)
{
    memset(mask->coverage, 0, (size_t)mask->width * (size_t)mask->height * sizeof *mask->coverage);
}

/* A segment prepared for distance queries, with its key at both ends when it lies in the scene. */
typedef struct stroke {
    double a[2], d[2], inverse_length2;
    double half, peak; /* half width >= 1/2; opacity of lines thinner than a sample */
    double reach;      /* distance beyond which nothing is covered */
    double key_a, key_change;
} stroke;

static stroke make_stroke(const double a[2], const double b[2], double width)
{
    stroke s = {.a = {a[0], a[1]}, .d = {b[0] - a[0], b[1] - a[1]}};
    const double length2 = s.d[0] * s.d[0] + s.d[1] * s.d[1];
    s.inverse_length2 = length2 > 0.0 ? 1.0 / length2 : 0.0;
    s.half = 0.5 * fmax(width, 1.0);
    s.peak = fmin(fmax(width, 0.0), 1.0);
    s.reach = s.half + 0.5;
    return s;
}

static bool is_drawable(const double p[2])
{
    return fabs(p[0]) < far_away && fabs(p[1]) < far_away; /* false for NaN */
}

static double clamp(double x, double lo, double hi)
{
    return x > lo ? (x < hi ? x : hi) : lo;
}

/* Place of the nearest point on the stroke, in [0, 1]; its distance. */
static double nearest(const stroke *s, double x, double y, double *distance)
{
    const double px = x - s->a[0], py = y - s->a[1];
    const double t = clamp((px * s->d[0] + py * s->d[1]) * s->inverse_length2, 0.0, 1.0);
    const double rx = px - t * s->d[0], ry = py - t * s->d[1];
    *distance = sqrt(rx * rx + ry * ry);
    return t;
}

static double coverage_at(const stroke *s, double distance)
{
    return s->peak * clamp(s->reach - distance, 0.0, 1.0);
}

/* Clips [lo, hi] to the window's integers. */
static void to_range(double lo, double hi, int32_t first, int32_t count, int32_t *begin, int32_t *end)
{
    *begin = (int32_t)clamp(floor(lo), first, (double)first + count);
    *end = (int32_t)clamp(floor(hi) + 1.0, first, (double)first + count);
}

/* Columns that the stroke can reach in the row of centre y. */
static void columns_of(const stroke *s, double y, const sl_mask *m, int32_t *begin, int32_t *end)
{
    double t0 = 0.0, t1 = 1.0;
    if (s->d[1] != 0.0) {
        const double u = (y - s->reach - s->a[1]) / s->d[1], v = (y + s->reach - s->a[1]) / s->d[1];
        t0 = clamp(fmin(u, v), 0.0, 1.0);
        t1 = clamp(fmax(u, v), 0.0, 1.0);
    }
    const double x0 = s->a[0] + t0 * s->d[0], x1 = s->a[0] + t1 * s->d[0];
    to_range(fmin(x0, x1) - s->reach, fmax(x0, x1) + s->reach, m->x0, m->width, begin, end);
}

static void rows_of(const stroke *s, const sl_mask *m, int32_t *begin, int32_t *end)
{
    const double y0 = fmin(s->a[1], s->a[1] + s->d[1]), y1 = fmax(s->a[1], s->a[1] + s->d[1]);
    to_range(y0 - s->reach, y1 + s->reach, m->y0, m->height, begin, end);
}

static float *mask_at(const sl_mask *m, int32_t x, int32_t y)
{
    return m->coverage + (int64_t)(y - m->y0) * m->width + (x - m->x0);
}

static void put(const sl_mask *m, int32_t x, int32_t y, double coverage)
{
    float *at = mask_at(m, x, y);
    *at = (float)coverage > *at ? (float)coverage : *at;
}

void sl_mask_segment(sl_mask *mask, const double a[2], const double b[2], double width)
{
    if (!is_drawable(a) || !is_drawable(b) || !(width > 0.0)) {
        return;
    }
    const stroke s = make_stroke(a, b, width);
    int32_t y0, y1, x0, x1;
    rows_of(&s, mask, &y0, &y1);
    for (int32_t y = y0; y < y1; y++) {
        columns_of(&s, y + 0.5, mask, &x0, &x1);
        for (int32_t x = x0; x < x1; x++) {
            double distance;
            nearest(&s, x + 0.5, y + 0.5, &distance);
            put(mask, x, y, coverage_at(&s, distance));
        }
    }
}

void sl_mask_disc(sl_mask *mask, const double centre[2], double radius)
{
    sl_mask_segment(mask, centre, centre, 2.0 * radius);
}

void sl_mask_rectangle(sl_mask *mask, double x0, double y0, double x1, double y1)
{
    if (!(x0 < x1 && y0 < y1)) {
        return;
    }
    int32_t c0, c1, r0, r1;
    to_range(x0, x1, mask->x0, mask->width, &c0, &c1);
    to_range(y0, y1, mask->y0, mask->height, &r0, &r1);
    for (int32_t y = r0; y < r1; y++) {
        const double high = clamp(fmin(y1, y + 1.0) - fmax(y0, y), 0.0, 1.0);
        for (int32_t x = c0; x < c1; x++) {
            put(mask, x, y, high * clamp(fmin(x1, x + 1.0) - fmax(x0, x), 0.0, 1.0));
        }
    }
}

/* Does the surface at sample (x, y) hide the line's point (lx, ly) of that key? */
static bool is_hidden(const sl_screen *screen, uint64_t zid, double x, double y, const double line[2], double key,
                      double half)
{
    const double surface = sl_visible_key(zid);
    if (key <= surface) {
        return false;
    }
    /* One sample's size at the line's depth, in units of the key. */
    const sl_camera *c = &screen->camera;
    const double inverse_depth = c->perspective ? (key - screen->key_offset) / screen->key_scale : 1.0;
    const double unit = fabs(screen->key_scale) * inverse_depth / (screen->height * c->focal);
    double plane[3];
    if (!sl_screen_plane(screen, sl_visible_triangle(zid), plane)) {
        return key > surface + steep_slack * half * unit;
    }
    const double lift = plane[1] * (line[0] - x) + plane[2] * (line[1] - y);
    const double slope = (fabs(plane[1]) + fabs(plane[2])) / unit; /* samples deep per sample along */
    if (fabs(key - (surface + lift)) < (flat_slack + snap_slack * slope) * unit) {
        return false; /* the line lies in the plane of what is seen here */
    }
    return key > surface + clamp(lift, 0.0, steep_slack * half * unit) + flat_slack * unit;
}

static void put_if_visible(sl_mask *mask, const sl_screen *screen, const sl_visibility *visible, const stroke *s,
                           int32_t x, int32_t y)
{
    double distance;
    const double t = nearest(s, x + 0.5, y + 0.5, &distance);
    const double coverage = coverage_at(s, distance);
    if (coverage <= 0.0 || coverage <= (double)*mask_at(mask, x, y)) {
        return;
    }
    const uint64_t zid = visible->zid[(int64_t)(y - visible->y0) * visible->width + (x - visible->x0)];
    const double line[2] = {s->a[0] + t * s->d[0], s->a[1] + t * s->d[1]};
    if (!is_hidden(screen, zid, x + 0.5, y + 0.5, line, s->key_a + t * s->key_change, s->half)) {
        put(mask, x, y, coverage);
    }
}

/* Moves the end behind the near plane onto it; false when the whole segment is behind. */
static bool clip_near(const sl_camera *camera, const double a[3], const double b[3], double p[3], double q[3])
{
    const double da = a[2] - camera->near_depth, db = b[2] - camera->near_depth;
    memcpy(p, a, 3 * sizeof *p);
    memcpy(q, b, 3 * sizeof *q);
    if (!(da > 0.0 || db > 0.0)) {
        return false;
    }
    double *moved = da < 0.0 ? p : db < 0.0 ? q : NULL;
    for (int k = 0; k < 3 && moved != NULL; k++) {
        moved[k] = a[k] + da / (da - db) * (b[k] - a[k]);
    }
    return true;
}

void sl_mask_visible_segment(sl_mask *mask, const sl_screen *screen, const sl_visibility *visible, const double a[3],
                             const double b[3], double width)
{
    double p[3], q[3], sp[2], sq[2];
    if (!(width > 0.0) || !clip_near(&screen->camera, a, b, p, q)) {
        return;
    }
    sl_camera_project(&screen->camera, screen->width, screen->height, p, sp);
    sl_camera_project(&screen->camera, screen->width, screen->height, q, sq);
    if (!is_drawable(sp) || !is_drawable(sq)) {
        return;
    }
    stroke s = make_stroke(sp, sq, width);
    s.key_a = sl_screen_key(screen, p[2]);
    s.key_change = sl_screen_key(screen, q[2]) - s.key_a;
    int32_t y0, y1, x0, x1;
    rows_of(&s, mask, &y0, &y1);
    for (int32_t y = y0; y < y1; y++) {
        columns_of(&s, y + 0.5, mask, &x0, &x1);
        for (int32_t x = x0; x < x1; x++) {
            put_if_visible(mask, screen, visible, &s, x, y);
        }
    }
}

void sl_mask_visible_disc(sl_mask *mask, const sl_screen *screen, const sl_visibility *visible, const double centre[3],
                          double radius)
{
    sl_mask_visible_segment(mask, screen, visible, centre, centre, 2.0 * radius);
}
