#include "param/stretch_levels_internal.h"

#include "geom/predicates.h"
#include "geom/vec3.h"

#include <math.h>

static const double LEAST_HEIGHT = 1e-2; /* of a rest shape over its longer edge at the vertex */
static const double LEAST_SHARE = 0.05;  /* of an edge, between a new vertex on it and its ends */
static const double ENOUGH = 1e-2;       /* a step that gains less of the energy is the last */
enum { STEPS = 8, HALVINGS = 12, APPROACHES = 200 };

/* The triangles around one vertex, which is corner 0 of each: J = [p_i - p, p_next - p] M. */
typedef struct star {
    int32_t count;
    int32_t triangles; /* = count, one less at the border */
    int32_t into;
    bool inside; /* of the ring's last edge, too, though there is no triangle */
    double w;
    double uv[SL_RING_MAX][2];
    double m[SL_RING_MAX][3]; /* M = [m0 m1; 0 m2] */
    double weight[SL_RING_MAX];
} star;

/* In line, which the library's fmax is not. */
static double larger(double a, double b)
{
    return a > b ? a : b;
}

static void rest_of(const double a[3], const double b[3], double m[3], double *weight)
{
    double n[3];
    sl_vec3_cross(a, b, n);
    if (!(sl_vec3_dot(a, a) + sl_vec3_dot(b, b) > 0.0)) { /* a point: any shape will do */
        m[0] = m[2] = 1.0;
        m[1] = *weight = 0.0;
        return;
    }
    const double la = sl_vec3_norm(a), lb = sl_vec3_norm(b), longer = la > lb ? la : lb;
    const double x1 = larger(la, LEAST_HEIGHT * longer), x2 = sl_vec3_dot(a, b) / x1;
    const double y2 = larger(sl_vec3_norm(n) / x1, LEAST_HEIGHT * longer);
    m[0] = 1.0 / x1;
    m[1] = -x2 / (x1 * y2);
    m[2] = 1.0 / y2;
    *weight = x1 * y2;
}

/* Twice the area of (p, a, b). */
static double cross_at(const double p[2], const double a[2], const double b[2])
{
    return (a[0] - p[0]) * (b[1] - p[1]) - (a[1] - p[1]) * (b[0] - p[0]);
}

/* The energy at p; with G (2) and H (h00, h01, h11) its derivatives. Infinite when a triangle is not positive.
 * With J affine in p, I = |J|^2 is quadratic and d = det J linear: psi = (1 - w) I + 2 w d + I / d^2. */
static double energy_at(const star *s, const double p[2], double G[2], double H[3])
{
    double energy = 0.0;
    for (int k = 0; k < 3 && G != NULL; k++) {
        H[k] = 0.0;
        G[k % 2] = 0.0;
    }
    if (s->inside && !(cross_at(p, s->uv[s->count - 1], s->uv[0]) > 0.0)) {
        return INFINITY;
    }
    for (int32_t i = 0; i < s->triangles; i++) {
        const double *a = s->uv[i], *b = s->uv[i + 1 < s->count ? i + 1 : 0], *m = s->m[i];
        const double ax = a[0] - p[0], ay = a[1] - p[1], bx = b[0] - p[0], by = b[1] - p[1];
        const double J[4] = {ax * m[0], ax * m[1] + bx * m[2], ay * m[0], ay * m[1] + by * m[2]};
        const double d = (ax * by - ay * bx) * m[0] * m[2];
        if (!(d > 0.0)) {
            return INFINITY;
        }
        const double I = J[0] * J[0] + J[1] * J[1] + J[2] * J[2] + J[3] * J[3], r = 1.0 / d, r2 = r * r;
        energy += s->weight[i] * ((1.0 - s->w) * I + 2.0 * s->w * d + I * r2);
        if (G == NULL) {
            continue;
        }
        const double g0 = m[0], g1 = m[1] + m[2]; /* J falls by p (g0, g1) */
        const double ix = -2.0 * (J[0] * g0 + J[1] * g1), iy = -2.0 * (J[2] * g0 + J[3] * g1);
        const double ex = m[0] * m[2] * (a[1] - b[1]), ey = m[0] * m[2] * (b[0] - a[0]);
        const double along = 1.0 - s->w + r2, across = 2.0 * s->w - 2.0 * I * r2 * r;
        const double bend = along * 2.0 * (g0 * g0 + g1 * g1), mixed = -2.0 * r2 * r, steep = 6.0 * I * r2 * r2;
        G[0] += s->weight[i] * (along * ix + across * ex);
        G[1] += s->weight[i] * (along * iy + across * ey);
        H[0] += s->weight[i] * (bend + 2.0 * mixed * ix * ex + steep * ex * ex);
        H[1] += s->weight[i] * (mixed * (ix * ey + iy * ex) + steep * ex * ey);
        H[2] += s->weight[i] * (bend + 2.0 * mixed * iy * ey + steep * ey * ey);
    }
    return energy;
}

/* step = -inv(H) G, H made positive definite by a multiple of the identity where it is not. */
static void newton_step(const double G[2], const double H[3], double step[2])
{
    const double half = 0.5 * (H[0] - H[2]), radius = sqrt(half * half + H[1] * H[1]), mean = 0.5 * (H[0] + H[2]);
    const double least = mean - radius, floor = 1e-3 * (fabs(mean) + radius);
    const double shift = least < floor ? floor - least : 0.0;
    const double a = H[0] + shift, c = H[2] + shift, det = a * c - H[1] * H[1];
    step[0] = -(c * G[0] - H[1] * G[1]) / det;
    step[1] = -(a * G[1] - H[1] * G[0]) / det;
}

/* Down from p, where the energy is finite. */
static void descend(const star *s, double p[2])
{
    for (int i = 0; i < STEPS; i++) {
        double G[2], H[3], step[2], length = 1.0;
        const double before = energy_at(s, p, G, H);
        newton_step(G, H, step);
        double energy = INFINITY, q[2] = {p[0], p[1]};
        for (int k = 0; k < HALVINGS && !(energy < before); k++) {
            q[0] = p[0] + length * step[0];
            q[1] = p[1] + length * step[1];
            energy = energy_at(s, q, NULL, NULL);
            length *= 0.5;
        }
        if (!(energy < before)) {
            return;
        }
        p[0] = q[0];
        p[1] = q[1];
        if (before - energy < ENOUGH * before) {
            return;
        }
    }
}

/* The mean value coordinates of the vertex in its ring in space, applied to the ring in the plane (Floater 2003). */
static void mean_value_place(const star *s, double edge[SL_RING_MAX][3], double p[2])
{
    double half[SL_RING_MAX], sum = 0.0;
    p[0] = p[1] = 0.0;
    for (int32_t i = 0; i < s->count; i++) { /* tan of half the angle between edges i and i + 1 */
        const double *a = edge[i], *b = edge[(i + 1) % s->count];
        double n[3];
        sl_vec3_cross(a, b, n);
        const double sine = sl_vec3_norm(n), product = sl_vec3_norm(a) * sl_vec3_norm(b);
        half[i] = sine > 0.0 ? (product - sl_vec3_dot(a, b)) / sine : 0.0;
    }
    for (int32_t i = 0; i < s->count; i++) {
        const double weight = (half[i] + half[(i + s->count - 1) % s->count]) / sl_vec3_norm(edge[i]);
        p[0] += weight * s->uv[i][0];
        p[1] += weight * s->uv[i][1];
        sum += weight;
    }
    p[0] /= sum;
    p[1] /= sum;
}

/* Where a border vertex is nearest in space to the edge that stands for it, that part of the edge in the plane. */
static void edge_place(const star *s, double edge[SL_RING_MAX][3], double p[2])
{
    double along[3];
    sl_vec3_sub(edge[0], edge[s->count - 1], along);
    const double t = -sl_vec3_dot(edge[s->count - 1], along) / sl_vec3_dot(along, along);
    const double share = t > LEAST_SHARE ? fmin(t, 1.0 - LEAST_SHARE) : LEAST_SHARE;
    for (int k = 0; k < 2; k++) {
        p[k] = s->uv[s->count - 1][k] + share * (s->uv[0][k] - s->uv[s->count - 1][k]);
    }
}

/* The neighbour it was moved into sees the whole ring: near it, inside both edges that meet there, the vertex does so,
 * too. */
static bool place_near(const star *s, double p[2])
{
    const double *u = s->uv[s->into], *next = s->uv[(s->into + 1) % s->count];
    const double *last = s->uv[(s->into + s->count - 1) % s->count];
    const double ex = next[0] - u[0], ey = next[1] - u[1], fx = u[0] - last[0], fy = u[1] - last[1];
    const double e = sqrt(ex * ex + ey * ey), f = sqrt(fx * fx + fy * fy);
    const double dx = -ey / e - fy / f, dy = ex / e + fx / f;
    double length = 0.25 * (e < f ? e : f);
    for (int i = 0; i < APPROACHES; i++) {
        p[0] = u[0] + length * dx;
        p[1] = u[1] + length * dy;
        if (isfinite(energy_at(s, p, NULL, NULL))) {
            return true;
        }
        length *= 0.5;
    }
    return false;
}

static bool all_positive(const star *s, const double p[2])
{
    for (int32_t i = 0; i < s->triangles; i++) {
        if (sl_orient2d(p, s->uv[i], s->uv[(i + 1) % s->count]) <= 0) {
            return false;
        }
    }
    return !s->inside || sl_orient2d(p, s->uv[s->count - 1], s->uv[0]) > 0;
}

/* Fills the star and, where asked, the edges from the vertex to its ring in space. */
static void star_of(const double *xyz, const sl_removal *removal, const int32_t *ring, const double *uv,
                    double edge[SL_RING_MAX][3], star *s)
{
    const int32_t count = removal->count;
    for (int32_t i = 0; i < count; i++) {
        sl_vec3_sub(&xyz[3 * (int64_t)ring[i]], &xyz[3 * (int64_t)removal->vertex], edge[i]);
        s->uv[i][0] = uv[2 * (int64_t)ring[i]];
        s->uv[i][1] = uv[2 * (int64_t)ring[i] + 1];
    }
    s->count = count;
    s->triangles = count - (removal->open ? 1 : 0);
    s->into = removal->into;
    for (int32_t i = 0; i < s->triangles; i++) {
        rest_of(edge[i], edge[(i + 1) % count], s->m[i], &s->weight[i]);
    }
}

bool sl_stretch_insert(const double *xyz, const sl_removal *removal, const int32_t *ring, double w, bool inside,
                       double *uv)
{
    star s = {.w = w, .inside = inside && removal->open};
    double edge[SL_RING_MAX][3], *p = &uv[2 * (int64_t)removal->vertex];
    star_of(xyz, removal, ring, uv, edge, &s);
    if (removal->open) {
        edge_place(&s, edge, p);
    } else {
        mean_value_place(&s, edge, p);
    }
    if (!isfinite(energy_at(&s, p, NULL, NULL)) && !place_near(&s, p)) {
        return false;
    }
    descend(&s, p);
    return all_positive(&s, p) || (place_near(&s, p) && all_positive(&s, p));
}

bool sl_stretch_settle(const double *xyz, const sl_removal *star_at, const int32_t *ring, double w, double limit,
                       double *uv)
{
    star s = {.w = w};
    double edge[SL_RING_MAX][3], *p = &uv[2 * (int64_t)star_at->vertex], area = 0.0;
    star_of(xyz, star_at, ring, uv, edge, &s);
    for (int32_t i = 0; i < s.triangles; i++) {
        area += s.weight[i];
    }
    const double before = energy_at(&s, p, NULL, NULL), old[2] = {p[0], p[1]};
    if (!(before > limit * area) || !isfinite(before)) {
        return false;
    }
    descend(&s, p);
    if (!all_positive(&s, p)) {
        p[0] = old[0];
        p[1] = old[1];
    }
    return true;
}
