/* Auto-sew in two files: who may be merged (sew.c), and one merge tried (merge.c).
 * Layer: segment (private). */
#ifndef SL_SEGMENT_SEW_INTERNAL_H
#define SL_SEGMENT_SEW_INTERNAL_H

#include "segment/segment_internal.h"

/* What all merges share. */
typedef struct sl_sewing {
    const sl_mesh *work; /* charts' seams cut */
    const sl_triangulation *triangulation;
    const uint8_t *sewable;    /* nh: 1 on seam edges that may be sewn */
    sl_flatten_def flatten;    /* max_stretch = the bound of merged charts */
    const sl_context *context; /* no progress */
} sl_sewing;

/* Tries to make one chart of a and b along their longest common arc. job: on return done says whether that is valid;
 * then face, corner_uv, flat, topology are the merged chart's and joined lists the halfedges to sew. Its status is in
 * the job. */
void sl_merge_charts(const sl_sewing *sewing, const sl_chart_job *a, const sl_chart_job *b, sl_chart_job *job);

#endif
