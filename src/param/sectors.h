/* Tables of vertex sectors: sets of corners whose planar angles add up to a prescribed sum.
 * Layer: param. */
#ifndef SL_PARAM_SECTORS_H
#define SL_PARAM_SECTORS_H

#include "param/abf.h"

/* An owned table; `view` points into it and is what the solver borrows. Zero-initialised = empty. */
typedef struct sl_sector_table {
    sl_sectors view;
    int32_t *first;
    int32_t *corner;
    double *theta;
    int32_t *vertex; /* count: the vertex of a sector */
    int32_t *origin; /* count: the constraint that made a sector, -1 = the plain turn of an interior vertex */
} sl_sector_table;

/* One sector of 2 pi per interior vertex, in vertex order, each with its corners counter-clockwise from the patch's
 * outgoing halfedge: Eq. 3. SL_OUT_OF_MEMORY. O(corners). */
SL_NODISCARD sl_status sl_sectors_interior(const sl_patch *patch, sl_sector_table *out);

void sl_sectors_clear(sl_sector_table *table);

/* Is a table usable on a patch? SL_INFEASIBLE: a sector without corners, *bad_sector (nullable) tells which;
 * SL_BAD_INPUT: first not ascending, a corner out of range, theta not finite. */
SL_NODISCARD sl_status sl_sectors_check(const sl_patch *patch, const sl_sectors *sectors, int32_t *bad_sector);

/**
 * Can any angles satisfy the linear constraints g1 = 0 and g2 = 0, every one of them positive?
 *
 * Triangles and sectors that share corners form regions: those that lines and prescribed borders close off. In a region
 * where every corner is in a sector the angles of n triangles are prescribed altogether, and by Gauss-Bonnet
 *
 *     sum of theta = n pi
 *
 * or nothing can satisfy them; where some corners are free, these must hold what is left, each in (0, pi). A sector of
 * k triangles holds less than k pi, and several sectors less than the triangles around them together: a maximum flow of
 * angles from triangles to sectors decides that, and what it cannot pass through names the sectors that compete. That
 * is all there is to it: where nothing is found such angles exist. For tables where no corner is in two sectors.
 *
 * @param[in]  name nv: what messages call a patch vertex; nullable = its number in the patch
 * @param[out] diag the region's or sector's vertices, the sums, the constraints; element = a patch vertex; nullable
 *
 * SL_INFEASIBLE, SL_OUT_OF_MEMORY. O(corners) but for the flow: some tens of searches of O(corners).
 * Source: Gale 1957, "A theorem on flows in networks". */
SL_NODISCARD sl_status sl_sectors_feasible(const sl_patch *patch, const sl_sector_table *table, const int32_t *name,
                                           sl_diag *diag);

/* The next corner counter-clockwise around c's vertex, -1 where the border ends the fan. */
static inline int32_t sl_corner_rotate(const sl_patch *patch, int32_t c)
{
    return patch->twin[sl_corner_prev(c)];
}

#endif
