#include "param/stretch_internal.h"

#include "base/memory.h"
#include "geom/vec3.h"

#include <math.h>

/* A 3D triangle is degenerate when its doubled area is at most this share of its longest edge squared (as distortion.h
 * says); it is then given the height RAISED_HEIGHT over that edge. */
static const double DEGENERATE = 1e-5;
static const double RAISED_HEIGHT = 1e-2;
static const double POINT_SIDE = 1e-3; /* side of what stands for a triangle shrunk to a point, per sqrt of mean area */

/* Planar coordinates (0, 0), (*x1, 0), (*x2, *y2) of triangle t, starting at the corner returned; *measured = false and
 * a raised height when it is degenerate, *y2 = 0 when it is a point. */
static int32_t rest_shape(const sl_patch *patch, int32_t t, double *x1, double *x2, double *y2, bool *measured)
{
    double length[3];
    int32_t base = 0;
    for (int32_t k = 0; k < 3; k++) {
        length[k] = sl_vec3_distance(&patch->xyz[3 * (int64_t)patch->tri[3 * t + k]],
                                     &patch->xyz[3 * (int64_t)patch->tri[3 * t + (k + 1) % 3]]);
        base = length[k] > length[base] ? k : base;
    }
    const double *o = &patch->xyz[3 * (int64_t)patch->tri[3 * t + base]];
    double e1[3], e2[3], n[3];
    sl_vec3_sub(&patch->xyz[3 * (int64_t)patch->tri[3 * t + (base + 1) % 3]], o, e1);
    sl_vec3_sub(&patch->xyz[3 * (int64_t)patch->tri[3 * t + (base + 2) % 3]], o, e2);
    sl_vec3_cross(e1, e2, n);
    const double doubled = sl_vec3_norm(n);
    *x1 = length[base];
    *measured = doubled > DEGENERATE * *x1 * *x1;
    *x2 = *x1 > 0.0 ? sl_vec3_dot(e1, e2) / *x1 : 0.0;
    *y2 = *measured ? doubled / *x1 : RAISED_HEIGHT * *x1;
    return base;
}

static void store_rest(sl_strip_rest *strip, int32_t lane, int32_t base, double x1, double x2, double y2)
{
    double g[3][2]; /* of the corners in the order base, base + 1, base + 2 */
    g[1][0] = 1.0 / x1;
    g[1][1] = -x2 / (x1 * y2);
    g[2][0] = 0.0;
    g[2][1] = 1.0 / y2;
    g[0][0] = -g[1][0];
    g[0][1] = -(g[1][1] + g[2][1]);
    for (int32_t k = 1; k < 3; k++) {
        strip->gradient[2 * (k - 1)][lane] = g[(k - base + 3) % 3][0];
        strip->gradient[2 * (k - 1) + 1][lane] = g[(k - base + 3) % 3][1];
    }
    strip->weight[lane] = 0.5 * x1 * y2;
}

/* The lanes beyond the last triangle repeat its shape and weigh nothing. */
static void pad_last_strip(sl_stretch_rest *rest)
{
    for (int32_t t = rest->nt; t < SL_STRIP * rest->strips && t > 0; t++) {
        sl_strip_rest *strip = &rest->strip[t / SL_STRIP];
        const int32_t lane = t % SL_STRIP;
        for (int k = 0; k < 4; k++) {
            strip->gradient[k][lane] = strip->gradient[k][lane - 1];
        }
        strip->weight[lane] = strip->counted[lane] = 0.0;
    }
}

/* Rest shapes with their areas for weights; returns the sum of these. */
static double store_shapes(const sl_patch *patch, double side, sl_stretch_rest *rest)
{
    double total = 0.0;
    for (int32_t t = 0; t < patch->nt; t++) {
        sl_strip_rest *strip = &rest->strip[t / SL_STRIP];
        const int32_t lane = t % SL_STRIP;
        double x1, x2, y2;
        bool measured;
        const int32_t base = rest_shape(patch, t, &x1, &x2, &y2, &measured);
        if (!measured && x1 < side) {
            x1 = side;
            x2 = 0.5 * side;
            y2 = side;
        }
        store_rest(strip, lane, base, x1, x2, y2);
        strip->counted[lane] = measured ? 1.0 : 0.0;
        total += strip->weight[lane];
    }
    return total;
}

sl_status sl_stretch_rest_init(const sl_patch *patch, sl_stretch_rest *rest)
{
    rest->nt = patch->nt;
    rest->strips = patch->nt / SL_STRIP + (patch->nt % SL_STRIP != 0);
    rest->kernels = sl_stretch_kernels_best();
    rest->measured_weight = 0.0;
    if (rest->strips > rest->capacity) {
        sl_free(rest->strip);
        rest->capacity = 0;
        rest->strip = sl_alloc(rest->strips, sizeof *rest->strip);
        if (rest->strip == NULL) {
            return SL_OUT_OF_MEMORY;
        }
        rest->capacity = rest->strips;
    }
    double area = 0.0;
    for (int32_t t = 0; t < patch->nt; t++) {
        area += sl_patch_triangle_area(patch, t);
    }
    const double mean = patch->nt > 0 && area > 0.0 ? area / patch->nt : 1.0;
    rest->total = store_shapes(patch, POINT_SIDE * sqrt(mean), rest);
    for (int32_t t = 0; t < patch->nt; t++) {
        sl_strip_rest *strip = &rest->strip[t / SL_STRIP];
        const int32_t lane = t % SL_STRIP;
        strip->weight[lane] /= rest->total;
        strip->counted[lane] *= strip->weight[lane];
        rest->measured_weight += strip->counted[lane];
    }
    pad_last_strip(rest);
    return SL_OK;
}

void sl_stretch_rest_clear(sl_stretch_rest *rest)
{
    sl_free(rest->strip);
    *rest = (sl_stretch_rest){0};
}

void sl_stretch_gather(const sl_stretch_rest *rest, const int32_t *tri, const double *x, int32_t s,
                       sl_strip_corners corners)
{
    const int32_t first = SL_STRIP * s, left = rest->nt - first, count = left < SL_STRIP ? left : SL_STRIP;
    for (int32_t lane = 0; lane < count; lane++) {
        const int32_t *v = &tri[3 * (int64_t)(first + lane)];
        for (int k = 0; k < 3; k++) {
            const double *p = &x[2 * (int64_t)v[k]];
            corners[2 * k][lane] = p[0];
            corners[2 * k + 1][lane] = p[1];
        }
    }
    for (int32_t lane = count; lane < SL_STRIP; lane++) {
        for (int k = 0; k < 6; k++) {
            corners[k][lane] = corners[k][count - 1];
        }
    }
}

/* ((0 + 1) + (2 + 3)) + ((4 + 5) + (6 + 7)) */
static double sum_of_lanes(const double x[SL_STRETCH_LANES])
{
    return ((x[0] + x[1]) + (x[2] + x[3])) + ((x[4] + x[5]) + (x[6] + x[7]));
}

sl_stretch_sums sl_stretch_measure(const sl_stretch_rest *rest, const int32_t *tri, double w, const double *uv)
{
    sl_stretch_lanes lanes = {0};
    sl_strip_corners corners;
    for (int l = 0; l < SL_STRETCH_LANES; l++) {
        lanes.least[l] = lanes.sure[l] = INFINITY;
    }
    for (int32_t s = 0; s < rest->strips; s++) {
        sl_stretch_gather(rest, tri, uv, s, corners);
        rest->kernels->measure(w, &rest->strip[s], corners, &lanes);
    }
    bool positive = true, sure = true;
    for (int l = 0; l < SL_STRETCH_LANES; l++) {
        positive = positive && lanes.least[l] > 0.0;
        sure = sure && lanes.sure[l] > 0.0;
    }
    const double energy = sum_of_lanes(lanes.energy);
    if (!positive || isnan(energy)) {
        return (sl_stretch_sums){INFINITY, INFINITY, false};
    }
    const double m = rest->measured_weight, inverse = 0.5 * sum_of_lanes(lanes.inverse);
    return (sl_stretch_sums){energy, m > 0.0 ? sqrt(inverse / m * (sum_of_lanes(lanes.area) / m)) : 1.0, sure};
}

double sl_stretch_step_bound(const sl_stretch_rest *rest, const int32_t *tri, const double *uv, const double *direction)
{
    double lanes[SL_STRETCH_LANES], bound = INFINITY;
    sl_strip_corners corners, along;
    for (int l = 0; l < SL_STRETCH_LANES; l++) {
        lanes[l] = INFINITY;
    }
    for (int32_t s = 0; s < rest->strips; s++) {
        sl_stretch_gather(rest, tri, uv, s, corners);
        sl_stretch_gather(rest, tri, direction, s, along);
        rest->kernels->bound(corners, along, lanes);
    }
    for (int l = 0; l < SL_STRETCH_LANES; l++) {
        bound = lanes[l] < bound ? lanes[l] : bound;
    }
    return bound;
}

static void add_terms(sl_stretch_terms *sum, sl_stretch_terms x)
{
    sum->area += x.area;
    sum->uv += x.uv;
    sum->inverse += x.inverse;
    sum->angle += x.angle;
}

/* s1/s2 + s2/s1 = I / d = m, so s1/s2 = (m + sqrt(m^2 - 4)) / 2. */
static sl_stretch_terms terms_of_triangle(const sl_patch *patch, int32_t t, const double *uv)
{
    double x1, x2, y2;
    bool measured;
    const int32_t base = rest_shape(patch, t, &x1, &x2, &y2, &measured);
    if (!measured) {
        return (sl_stretch_terms){0};
    }
    const int32_t *v = &patch->tri[3 * (int64_t)t];
    const double *o = &uv[2 * (int64_t)v[base]], *a = &uv[2 * (int64_t)v[(base + 1) % 3]];
    const double *b = &uv[2 * (int64_t)v[(base + 2) % 3]];
    const double ex = a[0] - o[0], ey = a[1] - o[1], fx = b[0] - o[0], fy = b[1] - o[1];
    const double d = (ex * fy - ey * fx) / (x1 * y2), area = 0.5 * x1 * y2;
    if (!(d > 0.0)) {
        return (sl_stretch_terms){area, area * d, INFINITY, INFINITY};
    }
    const double jx = ex / x1, jy = ey / x1, kx = (fx - x2 * jx) / y2, ky = (fy - x2 * jy) / y2;
    const double I = jx * jx + jy * jy + kx * kx + ky * ky, m = I / d;
    const double shear = m > 2.0 ? 0.5 * (m + sqrt((m - 2.0) * (m + 2.0))) : 1.0;
    return (sl_stretch_terms){area, area * d, 0.5 * area * m / d, area * shear};
}

sl_stretch_terms sl_stretch_terms_of(const sl_patch *patch, const double *uv, sl_stretch_terms *term)
{
    sl_stretch_terms sum = {0};
    for (int32_t t = 0; t < patch->nt; t++) {
        const sl_stretch_terms x = terms_of_triangle(patch, t, uv);
        add_terms(&sum, x);
        if (term != NULL) {
            term[t] = x;
        }
    }
    return sum;
}
