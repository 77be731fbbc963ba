/* Rays against triangles: a hierarchy of boxes.
 * Layer: geom (may include base). */
#ifndef SL_GEOM_BVH_H
#define SL_GEOM_BVH_H

#include "base/status.h"

#define SL_BVH_FARTHEST 1e150 /* coordinates beyond would overflow where they are multiplied */

typedef struct sl_bvh sl_bvh; /* opaque: owns copies of the triangles */

/* The points origin + t direction for near < t < far. */
typedef struct sl_ray {
    double origin[3], direction[3]; /* finite; a direction of length 0 hits nothing */
    double near, far;               /* far may be infinite */
    int32_t skip;                   /* a triangle that is passed through, -1 = none */
} sl_ray;

/* Where a ray meets a triangle: at t, in the point  (1 - u - v) a + u b + v c  of its corners. */
typedef struct sl_ray_hit {
    int32_t triangle;
    double t, u, v;
} sl_ray_hit;

/* xyz: points; tri: 3 nt indices; borrowed for the call. Triangles with a coordinate that is not
 * finite, or beyond SL_BVH_FARTHEST, are left out. Boxes
 * are split by the surface area heuristic over bins, four to a node. SL_OUT_OF_MEMORY. Deterministic. O(nt log nt).
 * Source: Goldsmith, Salmon 1987, "Automatic creation of object hierarchies for ray tracing"; Wald 2007, "On fast
 * construction of SAH-based bounding volume hierarchies". */
SL_NODISCARD sl_status sl_bvh_create(const double *xyz, int32_t nt, const int32_t *tri, sl_bvh **out);
void sl_bvh_free(sl_bvh *bvh); /* NULL is a no-op */

/* Does the ray meet any triangle? Both sides count; a ray through a common edge of two triangles meets one of them at
 * least, also where rounding is worst. Triangles without area, and those seen exactly edge-on, are never met. Source:
 * Woop, Benthin, Wald 2013, "Watertight ray/triangle intersection", in double precision. */
bool sl_bvh_any(const sl_bvh *bvh, const sl_ray *ray);

/* The first triangle met; of several at the same t the one of the smallest number. False: none, *hit is unchanged. */
bool sl_bvh_first(const sl_bvh *bvh, const sl_ray *ray, sl_ray_hit *hit);

#endif
