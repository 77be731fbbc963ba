/* Vertices whose star is far worse than what a minimum has are moved one by one; what the Newton steps after that meet
 * is no longer singular. Few are: the others are told by a bound a triangle, without its rest shape. */
#include "param/stretch_levels_internal.h"

#include "base/memory.h"
#include "geom/vec3.h"

#include <string.h>

static const double SURE = 0.9;         /* of the limit: the bound is rounded otherwise than the energy */
static const double WELL_SHAPED = 0.02; /* height over longest edge; twice where rest shapes begin to be raised */
enum { SWEEPS = 4 };

/* Is the energy of a triangle surely below limit times its area? With Q = |p|^2 |b|^2 - 2 (p.q)(a.b) + |q|^2 |a|^2 for
 * the edges a, b in space and p, q in the plane
 *
 *     I = Q / |a x b|^2,  I / d^2 = Q / (p x q)^2,  2 w d <= w I for w > 0, <= 0 else. */
static bool is_calm(const sl_patch *patch, const double *uv, int32_t t, double w, double limit)
{
    const int32_t *v = &patch->tri[3 * (int64_t)t];
    const double *x = &patch->xyz[3 * (int64_t)v[0]], *o = &uv[2 * (int64_t)v[0]];
    const double *u1 = &uv[2 * (int64_t)v[1]], *u2 = &uv[2 * (int64_t)v[2]];
    double a[3], b[3], c[3], n[3];
    sl_vec3_sub(&patch->xyz[3 * (int64_t)v[1]], x, a);
    sl_vec3_sub(&patch->xyz[3 * (int64_t)v[2]], x, b);
    sl_vec3_sub(b, a, c);
    sl_vec3_cross(a, b, n);
    const double p[2] = {u1[0] - o[0], u1[1] - o[1]}, q[2] = {u2[0] - o[0], u2[1] - o[1]};
    const double aa = sl_vec3_dot(a, a), bb = sl_vec3_dot(b, b), cc = sl_vec3_dot(c, c), nn = sl_vec3_dot(n, n);
    const double longest = aa > bb ? (aa > cc ? aa : cc) : (bb > cc ? bb : cc);
    const double cross = p[0] * q[1] - p[1] * q[0], cross2 = cross * cross;
    const double Q = (p[0] * p[0] + p[1] * p[1]) * bb - 2.0 * (p[0] * q[0] + p[1] * q[1]) * sl_vec3_dot(a, b) +
                     (q[0] * q[0] + q[1] * q[1]) * aa;
    const double factor = w > 0.0 ? 1.0 : 1.0 - w;
    return cross > 0.0 && nn > WELL_SHAPED * WELL_SHAPED * longest * longest &&
           Q * (factor * cross2 + nn) < SURE * limit * nn * cross2;
}

/* Notes the corners of triangle t unless it is calm. */
static void look_at(const sl_patch *patch, const double *uv, int32_t t, double w, double limit, uint8_t *suspect)
{
    if (!is_calm(patch, uv, t, w, limit)) {
        for (int k = 0; k < 3; k++) {
            suspect[patch->tri[3 * (int64_t)t + k]] = 1;
        }
    }
}

/* The neighbours of an interior vertex, the first few; returns how many there are. */
static int32_t ring_of(const sl_patch *patch, int32_t v, int32_t ring[SL_RING_MAX])
{
    int32_t h = patch->outgoing[v], count = 0;
    do {
        if (count < SL_RING_MAX) {
            ring[count] = patch->tri[sl_corner_next(h)];
        }
        count++;
        h = patch->twin[sl_corner_prev(h)];
    } while (h != patch->outgoing[v]);
    return count;
}

/* Moves v if its star asks for it; the triangles around are looked at anew then. */
static bool settle_vertex(const sl_patch *patch, int32_t v, double w, double limit, double *uv, uint8_t *suspect)
{
    int32_t ring[SL_RING_MAX];
    const sl_removal star = {.vertex = v, .count = ring_of(patch, v, ring)};
    if (star.count > SL_RING_MAX || !sl_stretch_settle(patch->xyz, &star, ring, w, limit, uv)) {
        return false;
    }
    int32_t h = patch->outgoing[v];
    do {
        look_at(patch, uv, h / 3, w, limit, suspect);
        h = patch->twin[sl_corner_prev(h)];
    } while (h != patch->outgoing[v]);
    return true;
}

sl_status sl_stretch_settle_all(const sl_patch *patch, double w, double limit, double *uv)
{
    uint8_t *suspect = sl_calloc(patch->nv, sizeof *suspect); /* may be worse than the limit */
    if (suspect == NULL) {
        return SL_OUT_OF_MEMORY;
    }
    for (int32_t t = 0; t < patch->nt; t++) {
        look_at(patch, uv, t, w, limit, suspect);
    }
    int32_t moved = 1;
    for (int sweep = 0; sweep < SWEEPS && moved > 0; sweep++) {
        moved = 0;
        for (int32_t v = 0; v < patch->nv; v++) {
            if (suspect[v] && patch->border[v] == 0) {
                moved += settle_vertex(patch, v, w, limit, uv, suspect);
            }
        }
    }
    sl_free(suspect);
    return SL_OK;
}
