#include "param/distortion.h"

#include "base/memory.h"
#include "geom/predicates.h"
#include "geom/vec3.h"

#include <stdlib.h>

/* A triangle whose doubled area is at most this share of its longest edge squared has no shape to speak of. */
static const double DEGENERATE_3D = 1e-5;
static const double DEGENERATE_UV = 1e-7;
static const double PERCENTILE = 0.95;

/* Where the corners come from: tri == NULL, triangle after triangle; else by index. */
typedef struct source {
    int32_t nt;
    const int32_t *tri;
    const double *xyz, *uv;
} source;

/* What the second pass and the percentile need of a measured triangle. */
typedef struct sample {
    double area;  /* 3D */
    double angle; /* s1 / s2 */
    double det;   /* s1 s2, before the common scale */
} sample;

typedef struct totals {
    double stretch; /* sum of area (1/s1^2 + 1/s2^2)/2 */
    double linf;    /* max 1/s2 */
    int32_t count;
} totals;

static void fetch(const source *in, int32_t t, double p[3][3], double q[3][2])
{
    for (int k = 0; k < 3; k++) {
        const int64_t corner = 3 * (int64_t)t + k;
        const int64_t v = in->tri != NULL ? in->tri[corner] : corner;
        for (int d = 0; d < 3; d++) {
            p[k][d] = in->xyz[3 * v + d];
        }
        q[k][0] = in->uv[2 * v];
        q[k][1] = in->uv[2 * v + 1];
    }
}

/* Doubled area and longest edge squared of a 3D triangle, with its planar coordinates (0, 0), (x1, 0), (x2, y2). */
static bool flat_shape(double p[3][3], double *x1, double *x2, double *y2)
{
    double e1[3], e2[3], e3[3], n[3];
    sl_vec3_sub(p[1], p[0], e1);
    sl_vec3_sub(p[2], p[0], e2);
    sl_vec3_sub(p[2], p[1], e3);
    sl_vec3_cross(e1, e2, n);
    const double doubled = sl_vec3_norm(n);
    const double longest = fmax(sl_vec3_dot(e1, e1), fmax(sl_vec3_dot(e2, e2), sl_vec3_dot(e3, e3)));
    if (!(doubled > DEGENERATE_3D * longest)) {
        return false;
    }
    *x1 = sl_vec3_norm(e1);
    *x2 = sl_vec3_dot(e1, e2) / *x1;
    *y2 = doubled / *x1;
    return true;
}

static double squared_distance_2d(const double a[2], const double b[2])
{
    const double x = b[0] - a[0], y = b[1] - a[1];
    return x * x + y * y;
}

/* Singular values s1 >= s2 of the linear map taking the planar triangle to q; s2 from the determinant, so that it keeps
 * its relative accuracy. Returns |doubled UV area|. */
static double singular_values(double x1, double x2, double y2, double q[3][2], double *s1, double *s2)
{
    const double u1 = q[1][0] - q[0][0], v1 = q[1][1] - q[0][1], u2 = q[2][0] - q[0][0], v2 = q[2][1] - q[0][1];
    const double a = u1 / x1, c = v1 / x1, b = (u2 - a * x2) / y2, d = (v2 - c * x2) / y2;
    const double doubled = fabs(u1 * v2 - u2 * v1);
    *s1 = 0.5 * (hypot(a + d, c - b) + hypot(a - d, c + b));
    *s2 = *s1 > 0.0 ? doubled / (x1 * y2) / *s1 : 0.0;
    return doubled;
}

static bool is_finite_uv(double q[3][2])
{
    return isfinite(q[0][0]) && isfinite(q[0][1]) && isfinite(q[1][0]) && isfinite(q[1][1]) && isfinite(q[2][0]) &&
           isfinite(q[2][1]);
}

/* One triangle into the sums; its sample is written if it counts. */
static void add_triangle(double p[3][3], double q[3][2], int sign, sl_distortion *out, totals *sum, sample *samples)
{
    const bool finite = is_finite_uv(q);
    if (finite && sign * sl_orient2d(q[0], q[1], q[2]) < 0) {
        out->flipped++;
    }
    double x1, x2, y2, s1 = 0.0, s2 = 0.0;
    if (!flat_shape(p, &x1, &x2, &y2)) {
        return;
    }
    const double area = 0.5 * x1 * y2;
    const double doubled_uv = finite ? singular_values(x1, x2, y2, q, &s1, &s2) : 0.0;
    const double longest_uv =
        fmax(squared_distance_2d(q[0], q[1]), fmax(squared_distance_2d(q[1], q[2]), squared_distance_2d(q[2], q[0])));
    if (!(doubled_uv > DEGENERATE_UV * longest_uv)) {
        out->degenerate++;
    }
    const bool collapsed = !(s2 > 0.0);
    out->area_3d += area;
    out->area_uv += 0.5 * doubled_uv;
    sum->stretch += collapsed ? INFINITY : 0.5 * area * (1.0 / (s1 * s1) + 1.0 / (s2 * s2));
    sum->linf = collapsed ? INFINITY : fmax(sum->linf, 1.0 / s2);
    samples[sum->count++] = (sample){area, collapsed ? INFINITY : s1 / s2, s1 * s2};
}

static int by_angle(const void *a, const void *b)
{
    const double x = ((const sample *)a)->angle, y = ((const sample *)b)->angle;
    return (x > y) - (x < y);
}

/* Everything that needs the common scale, which makes the UV area equal to the 3D area. */
static void finish(const totals *sum, sample *samples, sl_distortion *out)
{
    const double ratio = out->area_uv / out->area_3d; /* the scale squared is 1 / ratio */
    out->l2 = sqrt(sum->stretch / out->area_3d * ratio);
    out->linf = sum->linf * sqrt(ratio);
    if (!isfinite(sum->stretch)) {
        out->l2 = INFINITY;
        out->linf = INFINITY;
    }
    qsort(samples, (size_t)sum->count, sizeof *samples, by_angle);
    double below = 0.0, angle = 0.0, area = 0.0;
    out->area_max = 1.0;
    out->angle_max = samples[sum->count - 1].angle;
    out->angle_p95 = out->angle_max;
    bool found = false;
    for (int32_t i = 0; i < sum->count; i++) {
        const sample s = samples[i];
        const double det = s.det / ratio;
        const double change = det > 0.0 ? fmax(det, 1.0 / det) : INFINITY;
        below += s.area;
        angle += s.area * s.angle;
        area += s.area * change;
        out->area_max = fmax(out->area_max, change);
        if (!found && below >= PERCENTILE * out->area_3d) {
            out->angle_p95 = s.angle;
            found = true;
        }
    }
    out->angle_mean = angle / out->area_3d;
    out->area_mean = area / out->area_3d;
}

static sl_status measure(const source *in, int sign, sl_distortion *out)
{
    SL_ASSERT(in->nt >= 0 && (sign == 1 || sign == -1));
    sample *samples = sl_alloc(in->nt, sizeof *samples);
    if (samples == NULL) {
        return SL_OUT_OF_MEMORY;
    }
    *out = (sl_distortion){.l2 = 1.0,
                           .linf = 1.0,
                           .angle_mean = 1.0,
                           .angle_p95 = 1.0,
                           .angle_max = 1.0,
                           .area_mean = 1.0,
                           .area_max = 1.0};
    totals sum = {0};
    for (int32_t t = 0; t < in->nt; t++) {
        double p[3][3], q[3][2];
        fetch(in, t, p, q);
        add_triangle(p, q, sign, out, &sum, samples);
    }
    out->measured = sum.count;
    if (sum.count > 0) {
        finish(&sum, samples, out);
    }
    sl_free(samples);
    return SL_OK;
}

sl_status sl_distortion_measure(int32_t nt, const double *xyz, const double *uv, int sign, sl_distortion *out)
{
    const source in = {nt, NULL, xyz, uv};
    return measure(&in, sign, out);
}

sl_status sl_distortion_measure_indexed(int32_t nt, const int32_t *tri, const double *xyz, const double *uv,
                                        sl_distortion *out)
{
    const source in = {nt, tri, xyz, uv};
    return measure(&in, 1, out);
}
