/* Exact geometric predicates on doubles.
 * Layer: geom. */
#ifndef SL_GEOM_PREDICATES_H
#define SL_GEOM_PREDICATES_H

#include "base/status.h"

#include <math.h>

/* Sign of twice the signed area of triangle a b c: +1 counter-clockwise, -1 clockwise, 0 exactly collinear. Exact for
 * all finite doubles whose nonzero x span less than a factor of 2^900, and likewise the nonzero y: denormals and 1e300
 * are fine, both at once are not. Not defined for NaN and infinities. Source: Shewchuk 1997, "Adaptive precision
 * floating-point arithmetic"; filter, then exact expansions. */
int sl_orient2d(const double a[2], const double b[2], const double c[2]);

/* The sign where a filter of a few operations is sure of it, else 0: also for NaN and infinities. */
static inline int sl_orient2d_sure(const double a[2], const double b[2], const double c[2])
{
    const double left = (a[0] - c[0]) * (b[1] - c[1]), right = (a[1] - c[1]) * (b[0] - c[0]);
    const double det = left - right;
    /* A little over bound A of the source, and far above what an underflowing product can lose. Overflow and NaN make
     * both comparisons false. */
    const double bound = 0x1.8p-52 * (1.0 + 0x1p-40) * (fabs(left) + fabs(right)) + 0x1p-1000;
    return (det > bound) - (det < -bound);
}

/* sl_orient2d with that filter in the caller's loop. */
static inline int sl_orient2d_quick(const double a[2], const double b[2], const double c[2])
{
    const int sign = sl_orient2d_sure(a, b, c);
    return sign != 0 ? sign : sl_orient2d(a, b, c);
}

/* How two closed segments ab and cd meet. */
typedef enum sl_crossing {
    SL_CROSS_NONE,   /* no common point */
    SL_CROSS_TOUCH,  /* a common point that is an end of one of them, not a proper crossing */
    SL_CROSS_PROPER, /* interiors cross in one point */
    SL_CROSS_OVERLAP /* collinear with more than one common point */
} sl_crossing;

/* Exact, by sl_orient2d. A segment may be a single point; where two points meet that is SL_CROSS_TOUCH. */
sl_crossing sl_segments_cross(const double a[2], const double b[2], const double c[2], const double d[2]);

/* How two triangles lie to each other, seen along the y axis. */
typedef enum sl_triangle_order {
    SL_TRIANGLES_OVERLAP, /* their interiors have a common point */
    SL_TRIANGLE_BELOW,    /* a line that is not vertical parts them, the first one below or on it */
    SL_TRIANGLE_ABOVE,    /* likewise above or on it */
    SL_TRIANGLES_BESIDE   /* only a vertical line parts them: their ranges of x have no common interior */
} sl_triangle_order;

/* Exact, by sl_orient2d. p, q: three points each, counter-clockwise and not collinear. Two triangles without a common
 * interior point are parted by the line of an edge of one of them, so six lines decide. Touching is no overlap. */
sl_triangle_order sl_triangles_order(const double p[6], const double q[6]);

#endif
