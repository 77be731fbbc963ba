/* The whole way: a mesh file's polygons in, one checked texture atlas out.
 * Layer: atlas (may include segment, pack, meshio and all below). */
#ifndef SL_ATLAS_ATLAS_H
#define SL_ATLAS_ATLAS_H

#include "atlas/seams.h"
#include "mesh/build.h"
#include "optimize/optimize.h"
#include "pack/pack.h"
#include "segment/segment.h"

typedef struct sl_atlas_def {
    sl_segment_def segment;
    bool best; /* automatic seams by search, as `optimize` says, from the segmentation's cuts; default false */
    sl_optimize_def optimize;
    sl_pack_def pack;         /* density is per unit of length in space, in the mean over the surface */
    sl_seam_source seams;     /* who cuts: default SL_SEAMS_AUTOMATIC */
    sl_seam_input seam_input; /* borrowed; what the other sources need */
    int32_t check_resolution; /* texels a side of the last overlap test; default 4096 */
} sl_atlas_def;

sl_atlas_def sl_atlas_default(void);

/* What the finished atlas was found to be, judged on the UVs as written. */
typedef struct sl_atlas_check {
    int32_t flipped;                            /* triangles of the wrong orientation, by exact predicate */
    int32_t degenerate;                         /* UV triangles of zero area whose 3D triangle has some */
    int32_t uncertified_charts;                 /* charts without a proof that they do not overlap themselves */
    int32_t resolution;                         /* texels a side */
    int64_t covered_texels, overlapping_texels; /* of charts that are no copies */
    int64_t shared_texels;                      /* hit by copies, too: intended, and no fault */
    bool proven;                                /* no two triangles of these charts overlap, by exact predicates */
    int32_t unlike;                             /* corners of copies whose UVs are not, bit for bit, those they copy */
    bool passed; /* nothing flipped, degenerate, overlapping, uncertified or unlike, and proven; a mirrored copy is
                    judged by its own orientation */
} sl_atlas_check;

/* A sentence for the user about one chart (or none: -1). */
typedef struct sl_warning {
    int32_t chart;
    char text[192];
} sl_warning;

typedef struct sl_atlas {
    sl_mesh *mesh;
    sl_triangulation *triangulation;
    sl_repair_report repair;
    sl_segmentation *segmentation;
    sl_optimize_info optimized; /* of the search, where def->best */
    double *corner_uv;          /* nh x 2, by mesh halfedge, quantised as files hold them; page p fills the UDIM tile
                                   1001 + p: [0, 1] each way, moved by (p % 10, p / 10) */
    double *input_corner_uv;    /* the same by input corner */
    sl_placement *placement;    /* one a chart; a copy has its source's */
    sl_pack_info pack;
    double texels_a_unit; /* of length in space, in the mean */
    sl_atlas_check check;
    int32_t nwarning;
    sl_warning *warning;
} sl_atlas;

/* polygons: borrowed. Steps: build, cut (by def->seams), flatten, pack, quantise, check (with all digits, or on a
 * page smaller by a 4096th, where the first try fails). *out is given also when its
 * check did not pass (look at check.passed: what fails must not be delivered). SL_BAD_INPUT, SL_INFEASIBLE (the user's
 * seams leave a chart that is no disk, or too many charts for the page), SL_LIMIT (the cap on
 * charts left one that cannot be laid flat), SL_OUT_OF_MEMORY, SL_CANCELLED, SL_INTERNAL.
 * diag is nullable. Same bytes for any number of threads. */
SL_NODISCARD sl_status sl_unwrap(const sl_polygons *polygons, const sl_atlas_def *def, const sl_context *context,
                                 sl_atlas **out, sl_diag *diag);

/* Where page p lies in UV space, along u (axis 0) and v (axis 1). */
static inline double sl_page_tile(int32_t page, int axis)
{
    return axis == 0 ? page % 10 : page / 10;
}

/* Charts placed by other hands: from segmentation->corner_uv, placement and pack.scale fills corner_uv and
 * input_corner_uv, as they will be written, and check. Everything else in atlas stands; corner_uv and input_corner_uv
 * are allocated (nh x 2). May make pack.scale smaller, with the offsets. SL_OUT_OF_MEMORY, SL_BAD_INPUT (a UV is not
 * finite, or too far out to be judged). */
SL_NODISCARD sl_status sl_atlas_settle(sl_atlas *atlas, const sl_atlas_def *def, const sl_context *context);

void sl_atlas_free(sl_atlas *atlas); /* NULL is a no-op */

/* Number of the chart that chart c shows: itself, or the one it copies. */
static inline int32_t sl_chart_shown(const sl_segmentation *segmentation, int32_t c)
{
    return segmentation->chart[c].copy_of >= 0 ? segmentation->chart[c].copy_of : c;
}

/* Seam edges as mesh halfedges, one per edge cut or opened along differing UVs of two charts; *count of them. Owned by
 * the caller (sl_free). SL_OUT_OF_MEMORY. */
SL_NODISCARD sl_status sl_atlas_seams(const sl_mesh *mesh, int32_t **halfedge, int32_t *count);

/* Total length of the seams, normalised mesh. */
double sl_atlas_seam_length(const sl_mesh *mesh);

/* The same over the diagonal of the bounding box; 0 for a mesh without extent. */
double sl_atlas_seam_diagonals(const sl_mesh *mesh);

#endif
