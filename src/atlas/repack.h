/* Existing UVs packed anew: charts as they are, only moved and turned.
 * Layer: atlas. */
#ifndef SL_ATLAS_REPACK_H
#define SL_ATLAS_REPACK_H

#include "atlas/measure.h"
#include "pack/pack.h"

/* Which way is up in space, for charts that are to stand upright. */
typedef enum sl_up_axis { SL_UP_AS_IS, SL_UP_X, SL_UP_Y, SL_UP_Z } sl_up_axis;

typedef struct sl_repack_def {
    sl_pack_def pack; /* density is per unit of length in space, in the mean over the surface */
    sl_up_axis
        up; /* upright: this axis of space points along +v, as far as a chart has one; default as the input lies */
} sl_repack_def;

sl_repack_def sl_repack_default(void);

typedef struct sl_repacked {
    double *corner_uv; /* 2 a corner, as files hold them; page p is the UDIM tile 1001 + p: moved by (p % 10, p / 10) */
    sl_sharing_table
        table;     /* the charts found; those whose triangles are, bit for bit, those of an earlier one copy it */
    int32_t *page; /* a chart */
    int32_t charts, copies;
    sl_pack_info pack;
    double texels_a_unit; /* of length in space, in the mean */
    double clearance;     /* least distance between two charts [texels]; the margin where none are nearer */
    int32_t red_inside;   /* triangles that overlap others of their own chart: the input's, packing keeps them */
    int32_t red;          /* triangles that overlap any others, exactly */
    bool passed;          /* no chart overlaps another, and all keep the margin */
} sl_repacked;

/* polygons, corner_uv, table (nullable): as sl_measure_shared takes them; a copy stays where its source goes.
 * SL_BAD_INPUT (a corner without a finite UV: diag names the facet), SL_INFEASIBLE (too many charts for the pages),
 * SL_OUT_OF_MEMORY, SL_CANCELLED. *out is freed by sl_repacked_clear, also after failure. Same bytes for any number of
 * threads. */
SL_NODISCARD sl_status sl_repack(const sl_polygons *polygons, const double *corner_uv, const sl_sharing_table *table,
                                 const sl_repack_def *def, const sl_context *context, sl_repacked *out, sl_diag *diag);

void sl_repacked_clear(sl_repacked *repacked);

#endif
