/* Matching of triangles into quads.
 * Layer: mesh, private. */
#ifndef SL_MESH_PAIR_INTERNAL_H
#define SL_MESH_PAIR_INTERNAL_H

#include "mesh/mesh.h"

/* A matching of the facets along candidate edges. */
typedef struct sl_matching {
    const sl_mesh *mesh;
    const double *score; /* nh: of the quad across a halfedge, in (0, 1]; 0 = not a candidate */
    int32_t *mate;       /* nf: the facet's halfedge across which its partner lies, -1 = free */
} sl_matching;

/* Quality of the quad that the two triangles on the edge of h would form:
 *
 *     (1 - max over its four angles of |angle - pi/2| / (pi/2)) * cos(angle between the triangles' normals)
 *
 * 1 for a square, at most 0 when the quad is not convex or is bent by a right angle. h must have a twin; both facets
 * triangles of positive area. */
double sl_pair_score(const sl_mesh *mesh, int32_t h);

/* How clearly the edge of h belongs to the matching of largest total weight: > 0 in it, < 0 not in it, by max-product
 * message passing; -infinity for edges that are no candidates. belief: nh, equal for twins up to rounding. Exact after
 * enough rounds where the linear relaxation of the matching is; else a good order for rounding it greedily. O(nh) a
 * round. Source: Bayati, Shah, Sharma 2008, "Max-product for maximum weight matching"; Sanghavi, Malioutov, Willsky
 * 2011, "Belief propagation and LP relaxation for weighted matching in general graphs". Deviations: damped, rounds
 * bounded. */
SL_NODISCARD sl_status sl_pair_beliefs(const sl_mesh *mesh, const double *score, double *belief);

/* Pairs more triangles along alternating paths while that is possible within a bounded search around each free one. */
SL_NODISCARD sl_status sl_matching_augment(sl_matching *matching);

#endif
