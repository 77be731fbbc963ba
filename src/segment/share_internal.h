/* Symmetric sharing: where an axis is cut, what is copied, and the charts that are copies.
 * Layer: segment (private). */
#ifndef SL_SEGMENT_SHARE_INTERNAL_H
#define SL_SEGMENT_SHARE_INTERNAL_H

#include "segment/segment_internal.h"

/* Finds the mirror of a connected piece whose halves are best to flatten, and cuts along its axis: job gets parts
 * (those of the first half and of the facets that straddle the axis), seam, copies (all in numbers of the piece) and
 * split. *taken = false: there is none, nothing has changed. partner: nullable. SL_OUT_OF_MEMORY, SL_CANCELLED. */
SL_NODISCARD sl_status sl_cut_axis(const sl_recursion *recursion, sl_piece *piece, const int32_t *partner,
                                   sl_chart_job *job, bool *taken);

/* The same along the plane of a near symmetry, smoothed, with nothing copied. */
SL_NODISCARD sl_status sl_cut_near_plane(const sl_recursion *recursion, sl_piece *piece, const int32_t *partner,
                                         sl_chart_job *job, bool *taken);

/* After a cut into two connected parts: are they isomorphic, by the map that carries the two sides of a seam edge onto
 * one another, with equal edge lengths? Then the second copies the first. SL_OUT_OF_MEMORY. */
SL_NODISCARD sl_status sl_share_halves(const sl_piece *piece, sl_chart_job *job);

/* Cuts the edges between facets of different sides; labels the connected parts. */
SL_NODISCARD sl_status sl_label_parts(sl_piece *piece, const int32_t *side, sl_chart_job *job);

/* Every corner that copies another, over a whole run. */
typedef struct sl_sharing {
    int32_t *from;     /* nh: corner copied, which may itself copy another; -1 = none */
    uint8_t *reverses; /* nf: bits of what the facet's corners copy */
    uint8_t *near;     /* nf */
    sl_sharing_info info;
} sl_sharing;

void sl_sharing_clear(sl_sharing *sharing);

/* Adds a list of the mesh's corners. SL_OUT_OF_MEMORY. */
SL_NODISCARD sl_status sl_sharing_add(sl_sharing *sharing, const sl_mesh *mesh, const sl_copy_list *copies);

/* Components that are copies of others: their jobs are taken out of the list. partner: nullable. SL_OUT_OF_MEMORY,
 * SL_CANCELLED. */
SL_NODISCARD sl_status sl_share_components(const sl_mesh *mesh, const int32_t *partner, const sl_segment_def *def,
                                           const sl_context *context, sl_job_list *jobs, sl_sharing *sharing);

/* The facets that copy those of one chart. */
typedef struct sl_images_of {
    const int32_t *facet; /* count */
    int32_t count;
    const int32_t *from;     /* nh: corner of the chart that a corner of those facets copies */
    const uint8_t *mirrored; /* nf */
} sl_images_of;

SL_NODISCARD sl_status sl_unfold_images(const sl_recursion *recursion, const sl_images_of *images, sl_chart_job *job);

/* Charts of the facets that copy, when all others are done: work's edges are cut where the source's are, UVs taken
 * over, each chart judged on its own geometry. What is not valid goes to refused, its facets copying nothing any more,
 * its inner edges sewn. def->unshare: copies become charts of their own. Appends to done. SL_OUT_OF_MEMORY,
 * SL_CANCELLED. */
SL_NODISCARD sl_status sl_sharing_resolve(sl_sharing *sharing, const sl_recursion *recursion, const sl_mesh *mesh,
                                          sl_mesh *work, const sl_context *context, sl_job_list *done,
                                          sl_job_list *refused);

#endif
