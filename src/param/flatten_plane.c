#include "param/flatten_internal.h"

#include "geom/vec3.h"

static const double PLANAR = 1e-12; /* distance from the plane, per extent */
static const double SCALE_ROUNDING = 1e-14;

static const double *position(const sl_patch *patch, int64_t corner)
{
    return &patch->xyz[3 * (int64_t)patch->tri[corner]];
}

/* The patch's unit vector area; false when it vanishes. */
static bool unit_normal(const sl_patch *patch, double n[3])
{
    n[0] = n[1] = n[2] = 0.0;
    for (int64_t t = 0; t < patch->nt; t++) {
        double a[3], b[3], c[3];
        sl_vec3_sub(position(patch, 3 * t + 1), position(patch, 3 * t), a);
        sl_vec3_sub(position(patch, 3 * t + 2), position(patch, 3 * t), b);
        sl_vec3_cross(a, b, c);
        sl_vec3_add(n, c, n);
    }
    const double length = sl_vec3_norm(n);
    for (int k = 0; k < 3; k++) {
        n[k] /= length;
    }
    return length > 0.0 && isfinite(length);
}

/* Unit vectors x, y with x * y = n, from the axis least aligned with n. */
static void plane_axes(const double n[3], double x[3], double y[3])
{
    int least = 0;
    for (int k = 1; k < 3; k++) {
        least = fabs(n[k]) < fabs(n[least]) ? k : least;
    }
    double axis[3] = {0.0, 0.0, 0.0};
    axis[least] = 1.0;
    sl_vec3_cross(axis, n, x);
    const double length = sl_vec3_norm(x);
    for (int k = 0; k < 3; k++) {
        x[k] /= length;
    }
    sl_vec3_cross(n, x, y);
}

bool sl_flatten_project(const sl_patch *patch, double *uv)
{
    double n[3], x[3], y[3], extent = 0.0, off = 0.0;
    if (!unit_normal(patch, n)) {
        return false;
    }
    plane_axes(n, x, y);
    for (int64_t v = 0; v < patch->nv; v++) {
        double d[3];
        sl_vec3_sub(&patch->xyz[3 * v], &patch->xyz[0], d);
        uv[2 * v] = sl_vec3_dot(d, x);
        uv[2 * v + 1] = sl_vec3_dot(d, y);
        off = fmax(off, fabs(sl_vec3_dot(d, n)));
        extent = fmax(extent, sl_vec3_norm(d));
    }
    return off <= PLANAR * extent;
}

bool sl_flatten_is_one_facet(const sl_patch *patch)
{
    for (int32_t t = 1; t < patch->nt; t++) {
        if (patch->facet[t] != patch->facet[0]) {
            return false;
        }
    }
    return true;
}

void sl_flatten_scale(const sl_patch *patch, double *uv)
{
    double area = 0.0, doubled = 0.0;
    for (int32_t t = 0; t < patch->nt; t++) {
        const int32_t *v = &patch->tri[3 * (int64_t)t];
        const double *a = &uv[2 * (int64_t)v[0]], *b = &uv[2 * (int64_t)v[1]], *c = &uv[2 * (int64_t)v[2]];
        doubled += (b[0] - a[0]) * (c[1] - a[1]) - (c[0] - a[0]) * (b[1] - a[1]);
        area += sl_patch_triangle_area(patch, t);
    }
    const double scale = sqrt(2.0 * area / doubled);
    if (!(area > 0.0) || !(doubled > 0.0) || !isfinite(scale) || fabs(scale - 1.0) <= SCALE_ROUNDING) {
        return;
    }
    for (int64_t i = 0; i < 2 * (int64_t)patch->nv; i++) {
        uv[i] *= scale;
    }
}
