/* Where a seam would be least noticed: one weight an edge, for every path and minimum cut that places seams.
 * Layer: seamcost (may include mesh and below). */
#ifndef SL_SEAMCOST_SEAMCOST_H
#define SL_SEAMCOST_SEAMCOST_H

#include "base/context.h"
#include "mesh/mesh.h"
#include "seamcost/ambient.h"

/* The weight of edge e that multiplies its length:
 *
 *     weight[e] = max(floor, (1 - crease c_e) (1 - concavity v_e) (1 - visibility h_e) (1 - loops l_e))
 *
 * with features in [0, 1], each with its strength in [0, 1]; a strength of 0 costs no time. The diagonal of a pair of
 * triangles weighs `diagonal` times as much.
 *   c  how sharp the edge is: its dihedral angle beyond `angle_low`, full at `angle_high`, convex or concave
 *   v  how deep the valley is that the edge lies in: the turn of the normals over `reach`, where the surface is
 *      concave, on the same ramp
 *   h  how hidden the edge is: 1 - the mean ambient visibility of the facets beside it (seamcost/ambient.h)
 *   l  how long the edge loop is that the edge belongs to: 1 - 1 / edges; a loop runs straight on through regular
 *      vertices (four quads, of pairs of triangles too); 1 where it closes, 0 for edges beside no quad */
typedef struct sl_seam_cost_def {
    double crease;          /* default 0.6 */
    double concavity;       /* default 0.4 */
    double visibility;      /* default 0.5 */
    double loops;           /* default 0.3 */
    double floor;           /* in (0, 1]; default 0.1 */
    double diagonal;        /* >= 1; default 8: a seam follows the edges of quads unless there is no other way */
    double angle_low;       /* [rad] default 20 degrees */
    double angle_high;      /* [rad] > angle_low; default 50 degrees */
    double reach;           /* over the square root of the surface's area; default 0.02 */
    sl_ambient_def ambient; /* rays of the visibility */
    const double *visible;  /* nf: as sl_ambient_compute gives it; borrowed; NULL = computed where needed (default) */
    const int32_t *partner; /* nf: as sl_pair_triangles gives it; borrowed; NULL = no pairs (default) */
} sl_seam_cost_def;

sl_seam_cost_def sl_seam_cost_default(void);

/* All strengths 0: plain length. */
sl_seam_cost_def sl_seam_cost_none(void);

/* weight: nh, equal for the two halfedges of an edge, seams already cut included; in [floor, 1]. An edge beside a
 * degenerate facet counts as flat; a border has weight 1; a diagonal up to `diagonal`. Does not depend on the mesh's
 * scale or place. SL_BAD_INPUT (a strength or floor out of range), SL_OUT_OF_MEMORY, SL_CANCELLED. Same bytes for any
 * number of threads. O(nh log nh). Source: visibility and concavity as where seams belong, Sheffer, Hart 2002,
 * "Seamster". */
SL_NODISCARD sl_status sl_seam_cost_compute(const sl_mesh *mesh, const sl_seam_cost_def *def, const sl_context *context,
                                            double *weight);

/* Dihedral angle of the edge of h [rad]: 0 where flat, > 0 convex, < 0 concave, in [-pi, pi]; 0 at a border and beside
 * a facet without area. Across seams too. */
double sl_seam_dihedral(const sl_mesh *mesh, int32_t h);

#endif
