/* Charts onto texture pages by shape, at one common scale.
 * Layer: pack (may include overlap, geom, base). */
#ifndef SL_PACK_PACK_H
#define SL_PACK_PACK_H

#include "base/context.h"

/* One chart: UVs in units of one common texel density. Borrowed. */
typedef struct sl_pack_chart {
    int32_t nv, nt;
    const double *uv;   /* nv x 2 */
    const int32_t *tri; /* 3 nt */
    double upright;     /* angle at which it stands upright [rad]; where turns by right angles begin; default 0 */
} sl_pack_chart;

/* Where a chart went: atlas uv = scale * R(angle) uv + offset. A page is [0, 1] x [0, height / width]. */
typedef struct sl_placement {
    double angle; /* [rad] */
    double offset[2];
    int32_t page; /* from 0 */
} sl_placement;

/* How charts may be turned. */
typedef enum sl_pack_rotations {
    SL_ROTATE_FREE,  /* by any angle */
    SL_ROTATE_RIGHT, /* upright, or by right angles from there */
    SL_ROTATE_NONE   /* upright */
} sl_pack_rotations;

typedef struct sl_pack_def {
    int32_t resolution;          /* texels along a page's width; default 2048 */
    double margin;               /* least distance between charts [texels]; half of it to the page's edge; default 4 */
    sl_pack_rotations rotations; /* default SL_ROTATE_FREE */
    int32_t effort;              /* 0 to 12: each step about doubles the work beyond the first layout; default 2 */
    int32_t height;              /* texels along a page's height; 0 = as the width; default 0 */
    int32_t pages;               /* at most so many pages, up to 1000; default 1, as is 0 */
    double density;              /* texels a UV unit; 0 = the largest that fits; default 0 */
} sl_pack_def;

sl_pack_def sl_pack_default(void);

typedef struct sl_pack_info {
    double scale;     /* one for all charts: keeps texel densities equal; page widths a UV unit */
    double fill;      /* covered area / area of the pages used */
    int32_t pages;    /* pages used */
    int32_t attempts; /* times all charts were laid out */
} sl_pack_info;

/* placement: count. Charts are never reflected.
 *
 * Charts become masks of grid cells, one for each of several orientations: every cell that the chart grown by half the
 * margin touches. Masks that share no cell are therefore a margin apart, whatever their shapes: they nest in holes and
 * bays. Largest first, each goes where it lies lowest and leftmost; a search over orders and orientations follows, at
 * growing scales. Then up to 2048 charts are let overlap at larger scales and pushed apart again, on finer and finer
 * grids, down to a 2048th of the page (reports/design/packing.md). A density that is given is kept and fills pages one
 * after another; then (effort above 0) the emptiest page's charts are pushed in among the others, page by page, as long
 * as that succeeds.
 * Zero-size charts (isolated degenerate facets) get one texel each. SL_INFEASIBLE (so many charts that one texel each
 * and their margins do not fit, or not at the density asked for), SL_BAD_INPUT (UV not finite), SL_OUT_OF_MEMORY,
 * SL_CANCELLED. Work is counted, never timed; the same bytes for any number of threads. */
SL_NODISCARD sl_status sl_pack(int32_t count, const sl_pack_chart *charts, const sl_pack_def *def,
                               const sl_context *context, sl_placement *placement, sl_pack_info *info);

#endif
