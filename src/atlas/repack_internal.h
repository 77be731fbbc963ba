/* Charts of existing UVs, as the packer wants them.
 * Layer: atlas (private). */
#ifndef SL_ATLAS_REPACK_INTERNAL_H
#define SL_ATLAS_REPACK_INTERNAL_H

#include "atlas/measure_internal.h"
#include "atlas/repack.h"

/* Facets and triangles grouped by chart; the input's UVs by corner. */
typedef struct sl_uv_charts {
    int32_t count;
    sl_pack_chart *chart;    /* count */
    int32_t *copy_of;        /* count: an earlier chart of exactly the same triangles, itself no copy; -1 = none */
    int32_t *corner, *first; /* corners by chart: corner[first[c] .. first[c + 1] - 1], the points of chart c */
    double *uv;              /* of corner */
    int32_t *tri;
} sl_uv_charts;

/* view: charts found. *out is cleared by the caller in any case. SL_OUT_OF_MEMORY. */
SL_NODISCARD sl_status sl_uv_charts_init(const sl_atlas_view *view, const double *corner_uv, sl_uv_charts *out);
void sl_uv_charts_clear(sl_uv_charts *charts);

/* Angle by which each chart is turned so that the axis points along +v; 0 for one that lies level. */
void sl_uv_charts_stand_up(const sl_atlas_view *view, int32_t axis, sl_uv_charts *charts);

#endif
