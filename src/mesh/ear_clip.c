#include "mesh/ear_clip_internal.h"

#include "base/memory.h"
#include "geom/predicates.h"

sl_status sl_ear_clipper_init(int32_t capacity, sl_ear_clipper *out)
{
    *out = (sl_ear_clipper){.capacity = capacity};
    out->xy = sl_alloc(2 * (int64_t)capacity, sizeof *out->xy);
    out->quality = sl_alloc(capacity, sizeof *out->quality);
    out->link = sl_alloc(2 * (int64_t)capacity, sizeof *out->link);
    out->reflex = sl_alloc(capacity, sizeof *out->reflex);
    if (out->xy == NULL || out->quality == NULL || out->link == NULL || out->reflex == NULL) {
        sl_ear_clipper_clear(out);
        return SL_OUT_OF_MEMORY;
    }
    return SL_OK;
}

void sl_ear_clipper_clear(sl_ear_clipper *clipper)
{
    sl_free(clipper->xy);
    sl_free(clipper->quality);
    sl_free(clipper->link);
    sl_free(clipper->reflex);
    *clipper = (sl_ear_clipper){0};
}

static int32_t *prev_of(const sl_ear_clipper *e, int32_t i)
{
    return &e->link[2 * i];
}

static int32_t *next_of(const sl_ear_clipper *e, int32_t i)
{
    return &e->link[2 * i + 1];
}

static const double *at(const sl_ear_clipper *e, int32_t i)
{
    return e->xy + 2 * (int64_t)i;
}

static bool same_place(const double *a, const double *b)
{
    return a[0] == b[0] && a[1] == b[1];
}

/* Twice the signed area over the sum of squared sides: shape and orientation of triangle abc in one number. */
static double shape(const double *a, const double *b, const double *c)
{
    const double u[2] = {b[0] - a[0], b[1] - a[1]}, v[2] = {c[0] - a[0], c[1] - a[1]},
                 w[2] = {c[0] - b[0], c[1] - b[1]};
    const double sides = u[0] * u[0] + u[1] * u[1] + v[0] * v[0] + v[1] * v[1] + w[0] * w[0] + w[1] * w[1];
    return sides > 0.0 ? (u[0] * v[1] - u[1] * v[0]) / sides : 0.0;
}

/* Corners that lie exactly on an end of the triangle do not count: a polygon with a bridge to a hole visits them twice.
 */
static bool blocks(const double *p, const double *a, const double *b, const double *c)
{
    return sl_orient2d(a, b, p) >= 0 && sl_orient2d(b, c, p) >= 0 && sl_orient2d(c, a, p) >= 0 && !same_place(p, a) &&
           !same_place(p, b) && !same_place(p, c);
}

/* Updates what is known of corner i: reflex or not, an ear or not. */
static void look_at(sl_ear_clipper *e, int32_t i)
{
    const int32_t prev = *prev_of(e, i), next = *next_of(e, i);
    const double *a = at(e, prev), *b = at(e, i), *c = at(e, next);
    e->reflex[i] = sl_orient2d(a, b, c) <= 0;
    e->quality[i] = -1.0;
    if (e->reflex[i] != 0) {
        return;
    }
    for (int32_t j = *next_of(e, next); j != prev; j = *next_of(e, j)) {
        if (e->reflex[j] != 0 && blocks(at(e, j), a, b, c)) {
            return;
        }
    }
    const double q = shape(a, b, c);
    e->quality[i] = q > 0.0 ? q : 0.0;
}

/* The best ear, or without any the most convex corner; ties go to the first after `from`. */
static int32_t choose(const sl_ear_clipper *e, int32_t from)
{
    int32_t best = from, convex = from;
    double best_quality = -1.0, most_convex = -2.0;
    int32_t i = from;
    do {
        if (e->quality[i] > best_quality) {
            best_quality = e->quality[i];
            best = i;
        }
        i = *next_of(e, i);
    } while (i != from);
    if (best_quality >= 0.0) {
        return best;
    }
    do {
        const double s = shape(at(e, *prev_of(e, i)), at(e, i), at(e, *next_of(e, i)));
        if (s > most_convex) {
            most_convex = s;
            convex = i;
        }
        i = *next_of(e, i);
    } while (i != from);
    return convex;
}

void sl_ear_clip(sl_ear_clipper *e, int32_t d, int32_t *triangle)
{
    SL_ASSERT(d >= 3 && d <= e->capacity);
    for (int32_t i = 0; i < d; i++) {
        *prev_of(e, i) = i > 0 ? i - 1 : d - 1;
        *next_of(e, i) = i + 1 < d ? i + 1 : 0;
    }
    for (int32_t i = 0; i < d; i++) {
        e->reflex[i] = sl_orient2d(at(e, *prev_of(e, i)), at(e, i), at(e, *next_of(e, i))) <= 0;
    }
    for (int32_t i = 0; i < d; i++) {
        look_at(e, i);
    }
    int32_t from = 0;
    for (int32_t left = d; left > 3; left--) {
        const int32_t ear = choose(e, from), prev = *prev_of(e, ear), next = *next_of(e, ear);
        *triangle++ = prev;
        *triangle++ = ear;
        *triangle++ = next;
        *next_of(e, prev) = next;
        *prev_of(e, next) = prev;
        from = next;
        look_at(e, prev);
        look_at(e, next);
    }
    *triangle++ = *prev_of(e, from);
    *triangle++ = from;
    *triangle = *next_of(e, from);
}
