/* The features of edges that the weight is made of.
 * Layer: seamcost (private). */
#ifndef SL_SEAMCOST_INTERNAL_H
#define SL_SEAMCOST_INTERNAL_H

#include "seamcost/seamcost.h"

/* angle: nh, the dihedral angle of each halfedge's edge. O(nh). */
SL_NODISCARD sl_status sl_seam_dihedrals(const sl_mesh *mesh, double *angle);

/* turn: nv, how far the normals turn over twice the reach around each vertex [rad], < 0 where concave: the integrated
 * mean curvature of the edges over the area, both spread over about the reach by diffusion.
 * Source: Cohen-Steiner, Morvan 2003, "Restricted Delaunay triangulations and normal cycle": the curvature measure. */
SL_NODISCARD sl_status sl_seam_turns(const sl_mesh *mesh, const double *dihedral, double reach, double *turn);

/* feature: nh, 1 - 1 / (edges of the loop), 1 where it closes, 0 beside no quad. partner: nullable. O(nh). */
SL_NODISCARD sl_status sl_seam_loops(const sl_mesh *mesh, const int32_t *partner, double *feature);

#endif
