/* One triangle: clipped in eye space (Sutherland and Hodgman 1974), projected, snapped. */
#include "draw/screen_internal.h"
#include "geom/vec3.h"

#include <float.h>
#include <string.h>

enum { MAX_CORNERS = 8, PLANES = 5 };

static const double guard = 16384.0;   /* samples beyond the picture that need no clipping: products fit 64 bits */
static const double huge_value = 1e60; /* larger coordinates are dropped */

typedef struct polygon {
    int32_t count;
    double p[MAX_CORNERS][3];
} polygon;

bool sl_screen_point_is_usable(const double eye[3])
{
    return fabs(eye[0]) < huge_value && fabs(eye[1]) < huge_value && fabs(eye[2]) < huge_value;
}

/* Signed distance (of any scale) inside plane k: 0 = near, 1-4 = the sides of the guarded picture. */
static double inside(const sl_screen *s, int k, const double p[3])
{
    const sl_camera *c = &s->camera;
    if (k == 0) {
        return p[2] - c->near_depth;
    }
    const int axis = (k - 1) / 2;
    const double reach = fmax(c->centre[axis], 1.0 - c->centre[axis]) * (axis == 0 ? s->width : s->height);
    const double half = (reach + guard) / (s->height * c->focal);
    const double limit = half * (c->perspective ? p[2] : 1.0);
    return (k & 1) != 0 ? limit - p[axis] : limit + p[axis];
}

/* Where the edge crosses the plane; always computed from the inner end, so both triangles of an edge agree. */
static void cross_plane(const double in[3], const double out[3], double d_in, double d_out, double at[3])
{
    const double t = d_in / (d_in - d_out);
    for (int k = 0; k < 3; k++) {
        at[k] = in[k] + t * (out[k] - in[k]);
    }
}

static void clip(const sl_screen *s, int plane, const polygon *from, polygon *to)
{
    to->count = 0;
    for (int32_t i = 0; i < from->count; i++) {
        const double *a = from->p[i], *b = from->p[(i + 1) % from->count];
        const double da = inside(s, plane, a), db = inside(s, plane, b);
        if (da >= 0.0) {
            memcpy(to->p[to->count++], a, sizeof to->p[0]);
        }
        if ((da >= 0.0) != (db >= 0.0) && to->count < MAX_CORNERS) {
            if (da >= 0.0) {
                cross_plane(a, b, da, db, to->p[to->count++]);
            } else {
                cross_plane(b, a, db, da, to->p[to->count++]);
            }
        }
    }
}

static void project(const sl_screen *s, const double eye[3], sl_snapped *to)
{
    double sample[2];
    sl_camera_project(&s->camera, s->width, s->height, eye, sample);
    to->x = (int32_t)rint((sample[0] - 0.5) * SL_SUBPIXELS);
    to->y = (int32_t)rint((sample[1] - 0.5) * SL_SUBPIXELS);
    to->key = sl_screen_key(s, eye[2]);
}

void sl_screen_snap(const sl_screen *s, const double eye[3], sl_snapped *snapped)
{
    *snapped = (sl_snapped){.outside = SL_UNUSABLE};
    if (!sl_screen_point_is_usable(eye)) {
        return;
    }
    unsigned outside = 0;
    for (int plane = 0; plane < PLANES; plane++) {
        outside |= inside(s, plane, eye) >= 0.0 ? 0u : 1u << plane;
    }
    if (outside == 0) {
        project(s, eye, snapped);
    }
    snapped->outside = (uint8_t)outside;
}

/* The key as a linear function of the sample position, through the snapped corners. */
static bool set_piece(const sl_snapped *v0, const sl_snapped *v1, const sl_snapped *v2, int32_t triangle,
                      sl_piece *piece)
{
    const int32_t x[3] = {v0->x, v1->x, v2->x}, y[3] = {v0->y, v1->y, v2->y};
    const double key[3] = {v0->key, v1->key, v2->key};
    const int64_t ax = (int64_t)x[1] - x[0], ay = (int64_t)y[1] - y[0];
    const int64_t bx = (int64_t)x[2] - x[0], by = (int64_t)y[2] - y[0];
    const int64_t area = ax * by - bx * ay;
    if (area == 0) {
        return false;
    }
    /* Anticlockwise in array space (y down) or not, the filler wants one orientation: swap two corners. */
    const int second = area > 0 ? 1 : 2, third = 3 - second;
    *piece = (sl_piece){.x = {x[0], x[second], x[third]}, .y = {y[0], y[second], y[third]}, .triangle = triangle};
    const double ka = key[1] - key[0], kb = key[2] - key[0], per_sample = (double)SL_SUBPIXELS / (double)area;
    piece->key[1] = (ka * (double)by - kb * (double)ay) * per_sample;
    piece->key[2] = (kb * (double)ax - ka * (double)bx) * per_sample;
    piece->key[0] = key[0] - (piece->key[1] * x[0] + piece->key[2] * y[0]) / SL_SUBPIXELS;
    piece->least_key = (float)fmin(key[0], fmin(key[1], key[2]));
    piece->greatest_key = (float)fmax(key[0], fmax(key[1], key[2]));
    return true;
}

/* Rounds towards the samples inside [lo, hi] (in 1/256 sample): first sample at or after lo, one after the last. */
static void sample_range(int32_t lo, int32_t hi, int32_t count, int32_t *first, int32_t *end)
{
    const int32_t a = lo > 0 ? (lo + SL_SUBPIXELS - 1) / SL_SUBPIXELS : 0;
    const int32_t b = hi >= 0 ? hi / SL_SUBPIXELS + 1 : 0;
    *first = a;
    *end = b < count ? b : count;
}

static int32_t least(const int32_t v[3])
{
    const int32_t a = v[0] < v[1] ? v[0] : v[1];
    return a < v[2] ? a : v[2];
}

static int32_t greatest(const int32_t v[3])
{
    const int32_t a = v[0] > v[1] ? v[0] : v[1];
    return a > v[2] ? a : v[2];
}

void sl_piece_rows(const sl_piece *piece, int32_t rows, int32_t *lo, int32_t *hi)
{
    sample_range(least(piece->y), greatest(piece->y), rows, lo, hi);
}

void sl_piece_columns(const sl_piece *piece, int32_t columns, int32_t *lo, int32_t *hi)
{
    sample_range(least(piece->x), greatest(piece->x), columns, lo, hi);
}

static bool touches_samples(const sl_screen *s, const sl_piece *piece)
{
    int32_t x0, x1, y0, y1;
    sl_piece_columns(piece, s->width, &x0, &x1);
    sl_piece_rows(piece, s->height, &y0, &y1);
    return x0 < x1 && y0 < y1;
}

/* The pieces of a triangle that crosses the planes of `crossed`. */
static int32_t cut_crossing(const sl_screen *s, int32_t t, unsigned crossed, sl_piece *pieces)
{
    polygon poly[2] = {{.count = 3}, {.count = 0}};
    sl_snapped corner[MAX_CORNERS];
    int32_t now = 0, count = 0;
    for (int k = 0; k < 3; k++) {
        memcpy(poly[0].p[k], s->eye + 3 * (int64_t)s->tri[3 * (int64_t)t + k], sizeof poly[0].p[0]);
    }
    for (int plane = 0; plane < PLANES && poly[now].count >= 3; plane++) {
        if ((crossed >> plane & 1) != 0) {
            clip(s, plane, &poly[now], &poly[1 - now]);
            now = 1 - now;
        }
    }
    for (int32_t i = 0; i < poly[now].count; i++) {
        project(s, poly[now].p[i], &corner[i]);
    }
    for (int32_t i = 1; i + 1 < poly[now].count && count < SL_MAX_PIECES; i++) {
        sl_piece *piece = &pieces[count];
        count += set_piece(&corner[0], &corner[i], &corner[i + 1], t, piece) && touches_samples(s, piece) ? 1 : 0;
    }
    return count;
}

int32_t sl_screen_cut(const sl_screen *s, int32_t t, sl_piece *pieces)
{
    const int32_t *tri = s->tri + 3 * (int64_t)t;
    const sl_snapped *v[3] = {&s->snapped[tri[0]], &s->snapped[tri[1]], &s->snapped[tri[2]]};
    const unsigned any = (unsigned)v[0]->outside | v[1]->outside | v[2]->outside;
    const unsigned all = (unsigned)v[0]->outside & v[1]->outside & v[2]->outside;
    if ((any & SL_UNUSABLE) != 0 || all != 0) {
        return 0;
    }
    if (any != 0) {
        return cut_crossing(s, t, any, pieces);
    }
    return set_piece(v[0], v[1], v[2], t, pieces) && touches_samples(s, pieces) ? 1 : 0;
}
