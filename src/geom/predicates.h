/* Exact geometric predicates on doubles.
 * Layer: geom. */
#ifndef SL_GEOM_PREDICATES_H
#define SL_GEOM_PREDICATES_H

#include "base/status.h"

/* Sign of twice the signed area of triangle a b c: +1 counter-clockwise, -1 clockwise, 0 exactly collinear. Exact for
 * all finite doubles whose nonzero x span less than a factor of 2^900, and likewise the nonzero y: denormals and 1e300
 * are fine, both at once are not. Not defined for NaN and infinities. Source: Shewchuk 1997, "Adaptive precision
 * floating-point arithmetic"; filter, then exact expansions. */
int sl_orient2d(const double a[2], const double b[2], const double c[2]);

/* How two closed segments ab and cd meet. */
typedef enum sl_crossing {
    SL_CROSS_NONE,   /* no common point */
    SL_CROSS_TOUCH,  /* a common point that is an end of one of them, not a proper crossing */
    SL_CROSS_PROPER, /* interiors cross in one point */
    SL_CROSS_OVERLAP /* collinear with more than one common point */
} sl_crossing;

/* Exact, by sl_orient2d. A segment may be a single point; where two points meet that is SL_CROSS_TOUCH. */
sl_crossing sl_segments_cross(const double a[2], const double b[2], const double c[2], const double d[2]);

#endif
