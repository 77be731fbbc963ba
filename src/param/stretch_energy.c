#include "param/stretch_internal.h"

#include "base/memory.h"
#include "geom/vec3.h"

static const double HALF_ROOT = 0.70710678118654752440; /* 1 / sqrt(2) */
static const double LEAST_SQUARE = 1e-280, MOST_SQUARE = 1e280;

/* A 3D triangle is degenerate when its doubled area is at most this share of its longest edge squared (as distortion.h
 * says); it is then given the height RAISED_HEIGHT over that edge. */
static const double DEGENERATE = 1e-5;
static const double RAISED_HEIGHT = 1e-2;
static const double POINT_SIDE = 1e-3; /* side of what stands for a triangle shrunk to a point, per sqrt of mean area */

static double determinant(const double J[4])
{
    return J[0] * J[3] - J[1] * J[2];
}

static double squared_norm(const double J[4])
{
    return J[0] * J[0] + J[1] * J[1] + J[2] * J[2] + J[3] * J[3];
}

/* sqrt(a^2 + b^2); the squares of what is neither tiny nor huge neither vanish nor overflow. */
static double length_of(double a, double b)
{
    const double square = a * a + b * b;
    return square > LEAST_SQUARE && square < MOST_SQUARE ? sqrt(square) : hypot(a, b);
}

double sl_stretch_density(double w, const double J[4])
{
    const double d = determinant(J), I = squared_norm(J);
    return d > 0.0 ? (1.0 - w) * I + 2.0 * w * d + I / (d * d) : INFINITY;
}

void sl_stretch_density_gradient(double w, const double J[4], double P[4])
{
    const double d = determinant(J), I = squared_norm(J);
    const double along = 2.0 * (1.0 - w) + 2.0 / (d * d);  /* d psi / d I, times 2 */
    const double across = 2.0 * w - 2.0 * I / (d * d * d); /* d psi / d d; the cofactor matrix is d d / d J */
    P[0] = along * J[0] + across * J[3];
    P[1] = along * J[1] - across * J[2];
    P[2] = along * J[2] - across * J[1];
    P[3] = along * J[3] + across * J[0];
}

/* Eigenpairs of [a c; c b]: lambda[0] >= lambda[1], unit vectors (x[0], y[0]) and (x[1], y[1]). */
static void symmetric_eigen(double a, double b, double c, double lambda[2], double x[2], double y[2])
{
    const double half = 0.5 * (a - b), radius = length_of(half, c);
    lambda[0] = 0.5 * (a + b) + radius;
    lambda[1] = 0.5 * (a + b) - radius;
    const double p = half >= 0.0 ? half + radius : c, q = half >= 0.0 ? c : radius - half;
    const double n = length_of(p, q);
    x[0] = n > 0.0 ? p / n : 1.0;
    y[0] = n > 0.0 ? q / n : 0.0;
    x[1] = -y[0];
    y[1] = x[0];
}

/* J = U diag(s1, s2) V' with rotations U, V. Its similarity part is r1 (cos, sin) = (E, H), its reflected part (F, G):
 * U V' and U diag(1, -1) V' are these two, normalised, so that no angle need be computed. */
void sl_stretch_density_modes(double w, const double J[4], double lambda[4], double Q[16])
{
    const double E = 0.5 * (J[0] + J[3]), F = 0.5 * (J[0] - J[3]), G = 0.5 * (J[2] + J[1]), H = 0.5 * (J[2] - J[1]);
    const double same = length_of(E, H), mirrored = length_of(F, G);
    const double s1 = same + mirrored, d = determinant(J), s2 = d / s1, I = s1 * s1 + s2 * s2;
    const double ce = E / same, se = H / same;
    const double cf = mirrored > 0.0 ? F / mirrored : 1.0, sf = mirrored > 0.0 ? G / mirrored : 0.0;
    const double d3 = d * d * d;
    lambda[0] = 2.0 - 2.0 * (I - d) / d3;           /* (psi_1 + psi_2) / (s1 + s2) */
    lambda[1] = 2.0 - 4.0 * w + 2.0 * (I + d) / d3; /* (psi_1 - psi_2) / (s1 - s2) */
    const double twist[4] = {-se, -ce, ce, -se}, flip[4] = {-sf, cf, cf, sf};
    const double plus[4] = {ce, -se, se, ce}, minus[4] = {cf, sf, sf, -cf};
    double x[2], y[2];
    const double i1 = 1.0 / (s1 * s1), i2 = 1.0 / (s2 * s2);
    symmetric_eigen(2.0 * (1.0 - w) + 6.0 * i1 * i1, 2.0 * (1.0 - w) + 6.0 * i2 * i2, 2.0 * w, &lambda[2], x, y);
    for (int k = 0; k < 4; k++) {
        Q[k] = HALF_ROOT * twist[k];
        Q[4 + k] = HALF_ROOT * flip[k];
        for (int m = 0; m < 2; m++) { /* U diag(x, y) V' = (x + y)/2 plus + (x - y)/2 minus */
            Q[8 + 4 * m + k] = 0.5 * (x[m] + y[m]) * plus[k] + 0.5 * (x[m] - y[m]) * minus[k];
        }
    }
}

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

static void store_rest(sl_stretch_rest *rest, int32_t t, int32_t base, double x1, double x2, double y2)
{
    double g[3][2]; /* of the corners in the order base, base + 1, base + 2 */
    g[1][0] = 1.0 / x1;
    g[1][1] = -x2 / (x1 * y2);
    g[2][0] = 0.0;
    g[2][1] = 1.0 / y2;
    g[0][0] = -g[1][0];
    g[0][1] = -(g[1][1] + g[2][1]);
    double *out = &rest->gradient[4 * (int64_t)t];
    for (int32_t k = 1; k < 3; k++) {
        out[2 * (k - 1)] = g[(k - base + 3) % 3][0];
        out[2 * (k - 1) + 1] = g[(k - base + 3) % 3][1];
    }
    rest->weight[t] = 0.5 * x1 * y2;
}

sl_status sl_stretch_rest_init(const sl_patch *patch, sl_stretch_rest *rest)
{
    rest->nt = patch->nt;
    rest->gradient = sl_alloc(4 * (int64_t)patch->nt, sizeof *rest->gradient);
    rest->weight = sl_alloc(patch->nt, sizeof *rest->weight);
    rest->measured = sl_alloc(patch->nt, sizeof *rest->measured);
    if (rest->gradient == NULL || rest->weight == NULL || rest->measured == NULL) {
        sl_stretch_rest_clear(rest);
        return SL_OUT_OF_MEMORY;
    }
    double area = 0.0, total = 0.0;
    for (int32_t t = 0; t < patch->nt; t++) {
        area += sl_patch_triangle_area(patch, t);
    }
    const double mean = patch->nt > 0 && area > 0.0 ? area / patch->nt : 1.0, side = POINT_SIDE * sqrt(mean);
    for (int32_t t = 0; t < patch->nt; t++) {
        double x1, x2, y2;
        bool measured;
        const int32_t base = rest_shape(patch, t, &x1, &x2, &y2, &measured);
        if (!measured && x1 < side) {
            x1 = side;
            x2 = 0.5 * side;
            y2 = side;
        }
        rest->measured[t] = measured;
        store_rest(rest, t, base, x1, x2, y2);
        total += rest->weight[t];
    }
    rest->measured_weight = 0.0;
    for (int32_t t = 0; t < patch->nt; t++) {
        rest->weight[t] /= total;
        rest->measured_weight += rest->measured[t] != 0 ? rest->weight[t] : 0.0;
    }
    return SL_OK;
}

void sl_stretch_rest_clear(sl_stretch_rest *rest)
{
    sl_free(rest->gradient);
    sl_free(rest->weight);
    sl_free(rest->measured);
    *rest = (sl_stretch_rest){0};
}

void sl_stretch_jacobian(const sl_stretch_rest *rest, const int32_t *tri, const double *uv, int32_t t, double J[4])
{
    const double *g = &rest->gradient[4 * (int64_t)t];
    const double *a = &uv[2 * (int64_t)tri[3 * t]], *b = &uv[2 * (int64_t)tri[3 * t + 1]];
    const double *c = &uv[2 * (int64_t)tri[3 * t + 2]];
    for (int r = 0; r < 2; r++) {
        const double p = b[r] - a[r], q = c[r] - a[r];
        J[2 * r] = p * g[0] + q * g[2];
        J[2 * r + 1] = p * g[1] + q * g[3];
    }
}

sl_stretch_sums sl_stretch_measure(const sl_stretch_rest *rest, const int32_t *tri, double w, const double *uv)
{
    double energy = 0.0, inverse = 0.0, area = 0.0;
    for (int32_t t = 0; t < rest->nt; t++) {
        double J[4];
        sl_stretch_jacobian(rest, tri, uv, t, J);
        const double d = determinant(J), I = squared_norm(J);
        if (!(d > 0.0)) {
            return (sl_stretch_sums){INFINITY, INFINITY};
        }
        const double reciprocal = I / (d * d); /* s1^-2 + s2^-2 */
        energy += rest->weight[t] * ((1.0 - w) * I + 2.0 * w * d + reciprocal);
        if (rest->measured[t] != 0) {
            inverse += rest->weight[t] * 0.5 * reciprocal;
            area += rest->weight[t] * d;
        }
    }
    const double m = rest->measured_weight;
    return (sl_stretch_sums){energy, m > 0.0 ? sqrt(inverse / m * (area / m)) : 1.0};
}
