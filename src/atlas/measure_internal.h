/* An atlas taken apart for its measures.
 * Layer: atlas (private). */
#ifndef SL_ATLAS_MEASURE_INTERNAL_H
#define SL_ATLAS_MEASURE_INTERNAL_H

#include "atlas/measure.h"
#include "mesh/triangulate.h"

/* Triangles grouped by chart. Charts numbered from `counted` on consist of isolated facets only. */
typedef struct sl_atlas_view {
    const sl_polygons *polygons;
    const sl_sharing_table *table; /* nullable */
    sl_mesh *mesh;                 /* for the repair's reorientation, its isolated facets and the normalisation */
    sl_triangulation *triangulation;
    int32_t nt;
    double *xyz;         /* 9 nt, normalised */
    double *uv;          /* 6 nt, bounding square moved to [0, 1]^2 by sl_atlas_view_texels */
    int32_t *face_chart; /* nf */
    int32_t charts, counted;
    int32_t *chart_first; /* charts + 1: triangle range of a chart */
    double seam_length;   /* normalised units */
} sl_atlas_view;

/* Is a facet a duplicate or degenerate? */
static inline bool sl_view_isolated(const sl_atlas_view *view, int32_t f)
{
    return (view->mesh->face_flags[f] & (SL_FACE_DUPLICATE | SL_FACE_DEGENERATE)) != 0;
}

/* Fills in face_chart, charts, counted, seam_length: facets joined over edges of equal UVs. SL_OUT_OF_MEMORY. */
SL_NODISCARD sl_status sl_atlas_view_charts(sl_atlas_view *view, const double *corner_uv);

/* Fills in nt, xyz, uv, chart_first: facet order inside a chart, all turned so that a chart's main orientation is
 * positive. SL_OUT_OF_MEMORY. */
SL_NODISCARD sl_status sl_atlas_view_triangles(sl_atlas_view *view, const double *corner_uv);

/* Fills in fill, copies and the overlaps, chart by chart, copies after the charts they copy; moves the UVs into the
 * unit square. SL_OUT_OF_MEMORY, SL_CANCELLED. */
SL_NODISCARD sl_status sl_atlas_view_texels(sl_atlas_view *view, const sl_context *context, sl_atlas_measure *out);

#endif
