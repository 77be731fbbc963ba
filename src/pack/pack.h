/* Charts into the unit square at one common scale.
 * Layer: pack (may include overlap, geom, base). */
#ifndef SL_PACK_PACK_H
#define SL_PACK_PACK_H

#include "base/context.h"

/* One chart: UVs in units of one common texel density. Borrowed. */
typedef struct sl_pack_chart {
    int32_t nv, nt;
    const double *uv;   /* nv x 2 */
    const int32_t *tri; /* 3 nt */
} sl_pack_chart;

/* Where a chart went: atlas uv = scale * R(angle) uv + offset, in [0, 1]^2. */
typedef struct sl_placement {
    double angle; /* [rad] */
    double offset[2];
} sl_placement;

typedef struct sl_pack_def {
    int32_t resolution; /* texels a side; default 2048 */
    double margin;      /* least distance between charts [texels]; half of it to the page's edge; default 4 */
    int32_t rotations;  /* orientations tried a chart besides its minimum-area rectangle's; default 4 (by 90 degrees) */
    int32_t turns;      /* the largest chart is also turned by this many parts of a quarter, the whole packing done anew
                           each time and the largest scale kept: for few, large charts; default 1, as is 0 */
} sl_pack_def;

sl_pack_def sl_pack_default(void);

typedef struct sl_pack_info {
    double scale;     /* one for all charts: keeps texel densities equal */
    double fill;      /* covered area / page area */
    int32_t attempts; /* scales tried */
} sl_pack_info;

/* placement: count. Charts are never reflected. By shape: horizon per chart outline at a coarse grid of the target
 * resolution, largest first, the scale found by bisection over counted attempts. Zero-size charts (isolated degenerate
 * facets) get one texel each. SL_INFEASIBLE (so many charts that one texel each and their margins do not fit),
 * SL_BAD_INPUT (UV not finite), SL_OUT_OF_MEMORY, SL_CANCELLED. Deterministic. */
SL_NODISCARD sl_status sl_pack(int32_t count, const sl_pack_chart *charts, const sl_pack_def *def,
                               const sl_context *context, sl_placement *placement, sl_pack_info *info);

#endif
