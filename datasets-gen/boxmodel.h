/* Box modelling: a coarse cage of quads grows by extrusion and is smoothed by Catmull-Clark subdivision.
 * Layer: datasets-gen. */
#ifndef SL_GENERATORS_BOXMODEL_H
#define SL_GENERATORS_BOXMODEL_H

#include "generators.h"

/* A mesh of quads. In a mirrored cage only the half x >= 0 is modelled: a border edge with both ends at x = 0 exactly
 * is where the other half will be joined, and smoothing treats it as if that half were there already. */
typedef struct gen_cage {
    double *xyz;   /* 3 nv */
    int32_t *quad; /* 4 nq, outward orientation */
    int64_t nv, nq;
    int64_t xyz_capacity, quad_capacity;
    bool mirrored;
    bool failed; /* out of memory; further calls do nothing */
} gen_cage;

/* A cross-section of a limb: centre, half extents along the limb's side vector and across it. */
typedef struct gen_station {
    double centre[3];
    double width, depth;
} gen_station;

/* Number of the new vertex. */
int32_t gen_cage_vertex(gen_cage *cage, const double p[3]);

/* A quad of vertices made before. */
void gen_cage_quad(gen_cage *cage, const int32_t corner[4]);

/* The surface of a box of n[0] x n[1] x n[2] blocks, between the grid planes at[axis][0 .. n[axis]] (ascending). In a
 * mirrored cage at[0][0] must be 0, and that side is left open. The cage must be empty. */
void gen_cage_box(gen_cage *cage, const int32_t n[3], const double *const at[3]);

/* The quad whose centre is nearest to a point; -1 in an empty cage. O(nq). */
int32_t gen_cage_nearest(const gen_cage *cage, double x, double y, double z);

/* Extrudes a region of quads: the vertices of its outline are doubled, walls join old and new ones, and the region's
 * quads (same numbers) become the cap, which stays in place until it is moved. O(nv + count^2). */
void gen_cage_extrude(gen_cage *cage, const int32_t *region, int32_t count);

/* Extrudes the region along `stations` cross-sections. The cap takes the shape of its outline mapped to an ellipse
 * around each station's centre, square to the path there, its width along `side` (made square to the path). A region
 * that touches the mirror plane must have side = (1, 0, 0) and centres with x = 0. */
void gen_cage_limb(gen_cage *cage, const int32_t *region, int32_t count, const double side[3],
                   const gen_station *station, int32_t stations);

/* One Catmull-Clark step; borders become cubic B-splines. O(nq log nq).
 * Source: Catmull and Clark 1978, "Recursively generated B-spline surfaces on arbitrary topological meshes"; border
 * rule: Nasri 1987, "Polyhedral subdivision methods for free-form surfaces". */
void gen_cage_smooth(gen_cage *cage);

/* Smooths `levels` times, joins the mirrored half (its vertices follow in the order of those they mirror, those at
 * x = 0 are shared; its quads in the order of theirs, from the image of the first corner on), hands the mesh over and
 * empties the cage. SL_OUT_OF_MEMORY. */
SL_NODISCARD sl_status gen_cage_finish(gen_cage *cage, int32_t levels, sl_generated **out);

void gen_cage_clear(gen_cage *cage);

#endif
