/* The columns by which atlases are compared, for any mesh with UVs.
 * Layer: atlas. */
#ifndef SL_ATLAS_MEASURE_H
#define SL_ATLAS_MEASURE_H

#include "base/context.h"
#include "mesh/build.h"
#include "param/distortion.h"

/* Positions and UVs are welded by exact value; facets are fans from their first corner, cut into ears
 * where that fan turns over in 3D (a valid map of a concave facet would count as flipped). A seam edge has two or more
 * facets with different UVs along it; borders of the mesh are none. Charts join over edges with equal UVs. Duplicate
 * and degenerate facets (as the builder isolates them) make neither charts nor seams of their own and are counted
 * apart; they do count as triangles and texels. */
typedef struct sl_atlas_measure {
    int32_t triangles;
    int32_t charts, charts10; /* charts; those of at most 10 triangles */
    int32_t duplicate_facets, degenerate_facets;
    double seam_length;    /* over sqrt(surface area) */
    double seam_diagonal;  /* over the diagonal of the bounding box */
    sl_distortion global;  /* after one scale for the whole atlas: L2, Linf, angle, area; flipped, degenerate */
    double overlap_inside; /* share of covered texels hit twice within a chart */
    double overlap_across; /* ... across charts */
    int32_t copies;        /* charts that copy another, by the sharing table; 0 without one */
    double shared;         /* share of covered texels that copies and their sources have in common: intended, and not
                              counted as overlap */
    double fill;           /* covered texels / resolution^2 of the UVs' bounding square */
    double chart_l2_mean, chart_l2_worst; /* L2 with each chart's best scale; mean over charts, worst */
    int32_t worst_chart;                  /* numbered by first facet */
    int32_t resolution;
} sl_atlas_measure;

/* Which charts show the same texels on purpose: what a sidecar says (sl_sidecar_read). */
typedef struct sl_sharing_table {
    int32_t nf, nchart;
    int32_t *face_chart; /* nf: below nchart */
    int32_t *copy_of;    /* nchart: the chart that a copy takes its UVs from, itself no copy; -1 = its own */
} sl_sharing_table;

void sl_sharing_table_clear(sl_sharing_table *table);

/* sl_measure_atlas with a table (nullable, table->nf = polygons->nf): facets of different charts of the table are never
 * joined, and where a copy covers its source that is shared and no overlap. Everything else is as without. */
SL_NODISCARD sl_status sl_measure_shared(const sl_polygons *polygons, const double *corner_uv,
                                         const sl_sharing_table *table, int32_t resolution, const sl_context *context,
                                         sl_atlas_measure *out, sl_diag *diag);

/* corner_uv: 2 per corner. Orientation is judged per chart (the sign of most of its area is right), after the repair's
 * reorientation of facets. SL_BAD_INPUT (a corner without a finite UV: diag names the facet), SL_OUT_OF_MEMORY. */
SL_NODISCARD sl_status sl_measure_atlas(const sl_polygons *polygons, const double *corner_uv, int32_t resolution,
                                        const sl_context *context, sl_atlas_measure *out, sl_diag *diag);

#endif
