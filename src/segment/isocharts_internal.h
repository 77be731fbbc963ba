/* Iso-charts: clusters around the extremes of an embedding of geodesic distances, borders refined by graph cuts.
 * Source: Zhou, Snyder, Guo, Shum 2004, "Iso-charts: stretch-driven mesh parameterization using spectral analysis".
 * Layer: segment (private). */
#ifndef SL_SEGMENT_ISOCHARTS_INTERNAL_H
#define SL_SEGMENT_ISOCHARTS_INTERNAL_H

#include "segment/baseline_internal.h"
#include "segment/geodesic_internal.h"

enum { SL_ISO_CLUSTERS = 2 * SL_MDS_DIMS, SL_ISO_LANDMARKS = 100 };

/* What the steps hand on. Distances are those along the surface. */
typedef struct sl_isocharts {
    const sl_piece *piece;
    const sl_facet_graph *graph;
    sl_geodesics geodesics;
    int32_t landmarks;
    int32_t *landmark; /* vertices */
    float *distance;   /* landmarks x nv */
    sl_mds mds;
    int32_t dims;                    /* that dominate */
    int32_t clusters;                /* representatives */
    int32_t vertex[SL_ISO_CLUSTERS]; /* of each */
    int32_t seed[SL_ISO_CLUSTERS];   /* its node */
    double *node_distance;           /* clusters x n: mean distance of a node's corners from the representative */
    double *area;                    /* n */
    int32_t *label;                  /* n */
    double *vertex_work;             /* nv */
} sl_isocharts;

/* Mean over the corners of each node of a value at the vertices. node: n; count: n, scratch. */
void sl_node_means(const sl_piece *piece, const sl_facet_graph *graph, const double *vertex, double *node,
                   int32_t *count);

/* Landmarks by farthest points, their distances, the embedding, and how many dimensions dominate. SL_OUT_OF_MEMORY,
 * SL_CANCELLED, SL_INTERNAL. */
SL_NODISCARD sl_status sl_iso_embed(sl_isocharts *iso, const sl_context *context);

/* The extremes of the dominant dimensions, those too close to others left out, at most `most`; label: clusters grown
 * around them by geodesic distance, each connected. SL_OUT_OF_MEMORY. */
SL_NODISCARD sl_status sl_iso_cluster(sl_isocharts *iso, int32_t most);

/* Moves the borders between clusters to minimum cuts by angle and distortion; clusters stay connected and keep their
 * representatives. SL_OUT_OF_MEMORY, SL_INTERNAL. */
SL_NODISCARD sl_status sl_iso_refine(sl_isocharts *iso);

#endif
