/* Box modelling by places: the quads meant are those nearest to given points.
 * Layer: datasets-gen. */
#ifndef SL_GENERATORS_SCULPT_H
#define SL_GENERATORS_SCULPT_H

#include "boxmodel.h"

enum { GEN_MAX_REGION = 64 }; /* quads of a region given by points */

/* The region of the quads nearest to `count` points; returns how many different ones there are (region: count).
 * More points than GEN_MAX_REGION fail the cage. O(count * nq). */
int32_t gen_pick(gen_cage *cage, const double (*at)[3], int32_t count, int32_t *region);

/* A limb from the quads nearest to the points, see gen_cage_limb. */
void gen_grow(gen_cage *cage, const double (*at)[3], int32_t count, const double side[3], const gen_station *station,
              int32_t stations);

/* Extrudes the quads nearest to the points and moves their vertices p to c + scale * (p - c) + move by axis, c their
 * centroid (in the mirror plane when the region touches it; its vertices in the plane stay there). */
void gen_push(gen_cage *cage, const double (*at)[3], int32_t count, const double move[3], const double scale[3]);

/* A rounded bump of that radius, an eye for instance, grown towards `out` from the quad nearest to a point. */
void gen_bump(gen_cage *cage, const double at[3], const double out[3], double radius);

/* Removes the quads nearest to the points, and every vertex that no quad uses any more: an opening. */
void gen_open(gen_cage *cage, const double (*at)[3], int32_t count);

/* gen_cage_finish of a mirrored cage, which plants the mirror in x = 0. Those of gen_cage_finish and gen_plant. */
SL_NODISCARD sl_status gen_finish_mirrored(gen_cage *cage, int32_t levels, sl_generated **out);

#endif
