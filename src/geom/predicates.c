#include "geom/predicates.h"

#include <math.h>

static const double unit_roundoff = 0x1p-53;
static const double underflow_guard = 0x1p-1000; /* far above what an underflowing product can lose */
static const int scaled_exponent = 500;          /* products of scaled coordinates stay below 2^1003 */

enum {
    PRODUCTS = 6,             /* of the expanded determinant */
    EXPANSION = 2 * PRODUCTS, /* components that hold its exact value */
};

/* x + y = a + b exactly, x = fl(a + b). Source: Shewchuk 1997, Theorem 7 (Knuth). */
static void two_sum(double a, double b, double *x, double *y)
{
    *x = a + b;
    const double b_virtual = *x - a, a_virtual = *x - b_virtual;
    *y = (a - a_virtual) + (b - b_virtual);
}

/* a = hi + lo with at most 26 bits each. Source: Shewchuk 1997, Theorem 17 (Dekker). */
static void split(double a, double *hi, double *lo)
{
    const double c = 0x1.0000002p27 * a;
    *hi = c - (c - a);
    *lo = a - *hi;
}

/* x + y = a b exactly, x = fl(a b). No fma: in software, on baseline x86-64, it costs ten times this.
 * Source: Shewchuk 1997, Theorem 18 (Veltkamp). */
static void two_product(double a, double b, double *x, double *y)
{
    double a_hi, a_lo, b_hi, b_lo;
    *x = a * b;
    split(a, &a_hi, &a_lo);
    split(b, &b_hi, &b_lo);
    *y = a_lo * b_lo - (((*x - a_hi * b_hi) - a_lo * b_hi) - a_hi * b_lo);
}

/* e := e + b exactly, smallest component first; e nonoverlapping before and after.
 * Source: Shewchuk 1997, Theorem 10 (GROW-EXPANSION). */
static int grow(double *e, int length, double b)
{
    double q = b;
    for (int k = 0; k < length; k++) {
        double sum;
        two_sum(q, e[k], &sum, &e[k]);
        q = sum;
    }
    e[length] = q;
    return length + 1;
}

/* a, b, c along one axis, times one power of two: the sign of the determinant stands, the products keep their range. */
static void scale_axis(double a, double b, double c, double out[3])
{
    int exponent;
    frexp(fmax(fabs(a), fmax(fabs(b), fabs(c))), &exponent);
    out[0] = ldexp(a, scaled_exponent - exponent);
    out[1] = ldexp(b, scaled_exponent - exponent);
    out[2] = ldexp(c, scaled_exponent - exponent);
}

/* Sign of ax by - ay bx + bx cy - by cx + cx ay - cy ax, the six products summed as one expansion. */
static int orient2d_exact(const double a[2], const double b[2], const double c[2])
{
    double x[3], y[3], e[EXPANSION];
    scale_axis(a[0], b[0], c[0], x);
    scale_axis(a[1], b[1], c[1], y);
    int length = 0;
    for (int k = 0; k < 3; k++) {
        const int n = (k + 1) % 3;
        double hi, lo;
        two_product(x[k], y[n], &hi, &lo);
        length = grow(e, length, lo);
        length = grow(e, length, hi);
        two_product(-x[n], y[k], &hi, &lo);
        length = grow(e, length, lo);
        length = grow(e, length, hi);
    }
    for (int k = length - 1; k >= 0; k--) { /* the largest nonzero component decides */
        if (e[k] != 0.0) {
            return e[k] > 0.0 ? 1 : -1;
        }
    }
    return 0;
}

int sl_orient2d(const double a[2], const double b[2], const double c[2])
{
    const double left = (a[0] - c[0]) * (b[1] - c[1]), right = (a[1] - c[1]) * (b[0] - c[0]);
    const double det = left - right;
    /* Shewchuk 1997, Figure 21, bound A. Overflow makes the comparison false, so it ends in the exact branch too. */
    const double bound = (3.0 + 16.0 * unit_roundoff) * unit_roundoff * (fabs(left) + fabs(right)) + underflow_guard;
    if (det > bound) {
        return 1;
    }
    if (det < -bound) {
        return -1;
    }
    return orient2d_exact(a, b, c);
}

/* Order along any line: by x, then y. */
static bool before(const double a[2], const double b[2])
{
    return a[0] < b[0] || (a[0] == b[0] && a[1] < b[1]);
}

/* p, known to be on the line of ab, lies on the closed segment ab. */
static bool within(const double a[2], const double b[2], const double p[2])
{
    const double *low = before(b, a) ? b : a, *high = before(b, a) ? a : b;
    return !before(p, low) && !before(high, p);
}

static sl_crossing cross_on_a_line(const double a[2], const double b[2], const double c[2], const double d[2])
{
    const double *ab_low = before(b, a) ? b : a, *ab_high = before(b, a) ? a : b;
    const double *cd_low = before(d, c) ? d : c, *cd_high = before(d, c) ? c : d;
    const double *low = before(ab_low, cd_low) ? cd_low : ab_low;
    const double *high = before(ab_high, cd_high) ? ab_high : cd_high;
    if (before(high, low)) {
        return SL_CROSS_NONE;
    }
    return before(low, high) ? SL_CROSS_OVERLAP : SL_CROSS_TOUCH;
}

sl_crossing sl_segments_cross(const double a[2], const double b[2], const double c[2], const double d[2])
{
    const int abc = sl_orient2d(a, b, c), abd = sl_orient2d(a, b, d);
    if (abc * abd > 0) {
        return SL_CROSS_NONE;
    }
    const int cda = sl_orient2d(c, d, a), cdb = sl_orient2d(c, d, b);
    if (cda * cdb > 0) {
        return SL_CROSS_NONE;
    }
    if (abc * abd < 0 && cda * cdb < 0) {
        return SL_CROSS_PROPER;
    }
    if (abc == 0 && abd == 0 && cda == 0 && cdb == 0) {
        return cross_on_a_line(a, b, c, d);
    }
    const bool touch = (abc == 0 && within(a, b, c)) || (abd == 0 && within(a, b, d)) ||
                       (cda == 0 && within(c, d, a)) || (cdb == 0 && within(c, d, b));
    return touch ? SL_CROSS_TOUCH : SL_CROSS_NONE;
}

/* No point of q lies strictly left of the line ab. */
static bool all_right_of(const double a[2], const double b[2], const double q[6])
{
    return sl_orient2d_quick(a, b, q) <= 0 && sl_orient2d_quick(a, b, q + 2) <= 0 &&
           sl_orient2d_quick(a, b, q + 4) <= 0;
}

/* By the edges of p: p is left of each. */
static sl_triangle_order part_by_edges(const double p[6], const double q[6])
{
    bool beside = false;
    for (int k = 0; k < 3; k++) {
        const double *a = p + 2 * k, *b = p + 2 * ((k + 1) % 3);
        if (all_right_of(a, b, q)) {
            if (a[0] != b[0]) {
                return a[0] < b[0] ? SL_TRIANGLE_ABOVE : SL_TRIANGLE_BELOW;
            }
            beside = true;
        }
    }
    return beside ? SL_TRIANGLES_BESIDE : SL_TRIANGLES_OVERLAP;
}

sl_triangle_order sl_triangles_order(const double p[6], const double q[6])
{
    const double p_low = fmin(p[1], fmin(p[3], p[5])), p_high = fmax(p[1], fmax(p[3], p[5]));
    const double q_low = fmin(q[1], fmin(q[3], q[5])), q_high = fmax(q[1], fmax(q[3], q[5]));
    if (p_low >= q_high) {
        return SL_TRIANGLE_ABOVE;
    }
    if (q_low >= p_high) {
        return SL_TRIANGLE_BELOW;
    }
    const sl_triangle_order by_p = part_by_edges(p, q);
    if (by_p == SL_TRIANGLE_ABOVE || by_p == SL_TRIANGLE_BELOW) {
        return by_p;
    }
    const sl_triangle_order by_q = part_by_edges(q, p);
    if (by_q == SL_TRIANGLE_ABOVE || by_q == SL_TRIANGLE_BELOW) {
        return by_q == SL_TRIANGLE_ABOVE ? SL_TRIANGLE_BELOW : SL_TRIANGLE_ABOVE;
    }
    return by_p == SL_TRIANGLES_BESIDE || by_q == SL_TRIANGLES_BESIDE ? SL_TRIANGLES_BESIDE : SL_TRIANGLES_OVERLAP;
}
