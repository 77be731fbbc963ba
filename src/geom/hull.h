/* Convex hulls and tight rectangles of points in the plane.
 * Layer: geom. */
#ifndef SL_GEOM_HULL_H
#define SL_GEOM_HULL_H

#include "base/status.h"

/* Convex hull of the n points at point[2 i], counter-clockwise from the point smallest in x, then y. hull: n indices,
 * *count of them used; exactly collinear points between corners and repeated points are left out (of equal points the
 * smallest index stays). n = 0 gives 0, equal points 1, collinear points 2. Exact, by sl_orient2d.
 * SL_BAD_INPUT (a coordinate not finite), SL_OUT_OF_MEMORY. O(n log n).
 * Source: Andrew 1979, "Another efficient algorithm for convex hulls in two dimensions". */
SL_NODISCARD sl_status sl_convex_hull_2d(const double *point, int32_t n, int32_t *hull, int32_t *count);

/* A rectangle whose first axis points along (cos angle, sin angle): { p : low[0] <= p . axis <= low[0] + width,
 * low[1] <= p . normal <= low[1] + height } with normal = (-sin angle, cos angle). Turning the points by -angle makes
 * it stand upright with its lower left corner at `low`. */
typedef struct sl_rectangle {
    double angle;         /* [rad], in [0, pi/2) */
    double axis[2];       /* (cos angle, sin angle) */
    double width, height; /* along the axis and its normal */
    double low[2];
} sl_rectangle;

/* A rectangle of smallest area around n >= 1 points; of equal areas the first by hull edge. One side lies on an edge of
 * the hull; collinear points give height 0 or width 0. Rotating calipers over the hull. SL_BAD_INPUT (n < 1, a
 * coordinate not finite), SL_OUT_OF_MEMORY. O(n log n). Source: Freeman & Shapira 1975, "Determining the minimum-area
 * encasing rectangle"; Toussaint 1983. */
SL_NODISCARD sl_status sl_min_area_rectangle(const double *point, int32_t n, sl_rectangle *out);

#endif
