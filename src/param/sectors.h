/* Tables of vertex sectors: runs of corners whose planar angles add up to a prescribed sum.
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
} sl_sector_table;

/* One sector of 2 pi per interior vertex, in vertex order, each with its corners counter-clockwise from the patch's
 * outgoing halfedge: Eq. 3. SL_OUT_OF_MEMORY. O(corners). */
SL_NODISCARD sl_status sl_sectors_interior(const sl_patch *patch, sl_sector_table *out);

void sl_sectors_clear(sl_sector_table *table);

/* Is a table usable on a patch? SL_INFEASIBLE: a sector without corners, *bad_sector (nullable) tells which;
 * SL_BAD_INPUT: first not ascending, a corner out of range, theta not finite. */
SL_NODISCARD sl_status sl_sectors_check(const sl_patch *patch, const sl_sectors *sectors, int32_t *bad_sector);

/* The next corner counter-clockwise around c's vertex, -1 where the border ends the fan. */
static inline int32_t sl_corner_rotate(const sl_patch *patch, int32_t c)
{
    return patch->twin[sl_corner_prev(c)];
}

#endif
