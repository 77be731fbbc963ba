/* A chart in one orientation at one scale, as grid cells. All lengths in cells.
 * Layer: pack. */
#ifndef SL_PACK_MASK_H
#define SL_PACK_MASK_H

#include "pack/outline.h"

/* Cells left .. left + length - 1 of one row. */
typedef struct sl_mask_run {
    int32_t row, left, length;
} sl_mask_run;

typedef struct sl_mask {
    int32_t width, height; /* 0 = larger than was allowed, no runs */
    int32_t count;
    sl_mask_run *run;  /* owned; the longest first */
    double angle;      /* [rad] */
    double origin[2];  /* where the outline's centre is when the mask's lower left corner stands at (0, 0) */
    int32_t centre[2]; /* twice its centre of gravity */
    int64_t cells;     /* how many there are */
} sl_mask;

/* Every cell that the outline's triangles, turned by angle, scaled by scale [cells a UV unit] and grown by grow, touch;
 * and perhaps some within 1e-6 of them. Larger than max_width x max_height cells: width = height = 0.
 * SL_OUT_OF_MEMORY. O(edges + rows that edges cross + cells). */
SL_NODISCARD sl_status sl_mask_init(const sl_outline *outline, double angle, double scale, double grow,
                                    int32_t max_width, int32_t max_height, sl_mask *out);

void sl_pack_mask_clear(sl_mask *mask);

#endif
