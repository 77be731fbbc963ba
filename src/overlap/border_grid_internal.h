/* Which segments may meet: a hashed uniform grid over segments in the plane.
 * Layer: overlap. Private. */
#ifndef SL_OVERLAP_BORDER_GRID_INTERNAL_H
#define SL_OVERLAP_BORDER_GRID_INTERNAL_H

#include "base/status.h"

/* Occupied cells are numbered as they are first met. Segment s passes the cells cell[cell_first[s] .. cell_first[s + 1]
 * - 1], cell c holds the segments member[member_first[c] .. member_first[c + 1] - 1], in ascending order. */
typedef struct sl_border_grid {
    int32_t segments, cells;
    int64_t *cell_first; /* segments + 1 */
    int32_t *cell;
    int64_t *member_first; /* cells + 1 */
    int32_t *member;
} sl_border_grid;

/* Segment s joins the points pair[2 s] and pair[2 s + 1] of point (x, y each, finite). Two segments with a common point
 * have a common cell. Cells are as wide as the mean segment is long, so a segment passes three on average.
 * SL_OUT_OF_MEMORY. O(segments). Freed by sl_border_grid_clear, also after failure. */
SL_NODISCARD sl_status sl_border_grid_build(const double *point, int32_t segments, const int32_t *pair,
                                            sl_border_grid *grid);

void sl_border_grid_clear(sl_border_grid *grid);

#endif
