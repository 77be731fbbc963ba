/* The best atlas of a surface: darts, cuts and sewing weighed by one additive score.
 * Layer: optimize (may include segment and all below).
 *
 *     q_c = sqrt(I_c a_c) - A_c,   I_c = integral over the chart of (s1^-2 + s2^-2)/2,   a_c, A_c = area in UV, in
 * space
 *
 * sum q_c / A = L2 - 1 of the whole atlas when each chart has its best scale, so one chart's gain never depends on
 * another's. reports/design/best-atlas.md tells the whole way. */
#ifndef SL_OPTIMIZE_OPTIMIZE_H
#define SL_OPTIMIZE_OPTIMIZE_H

#include "seamcost/seamcost.h"
#include "segment/segment.h"

/* Which seams sewing must leave alone. An axis that the other side copies is never sewn. */
typedef enum sl_protect {
    SL_PROTECT_NONE,
    SL_PROTECT_AXIS, /* axes of symmetry (default) */
    SL_PROTECT_FIRST /* and the first spectral cut of each component or half */
} sl_protect;

typedef struct sl_optimize_def {
    double target_stretch; /* the atlas's L2 after one scale, at least 1; default 1.05 */
    double target_angle;   /* its area-weighted mean of s1/s2, at least 1; default 1.2 */
    double max_stretch;    /* L2 of any one chart; default 1.5 */
    double max_angle;      /* mean s1/s2 of any one chart; default 1.75 */
    double chart_cost;     /* what a chart is worth in seam length over sqrt(area); default 0.3 */
    double seam_cost;      /* what seam length is worth in itself; 0 = only charts count; default 1 */
    double empty_cost;     /* what as much empty texture as the surface's area is worth, likewise; default 1 */
    double start_stretch;  /* L2 above which the first cuts recurse; default 2.5 */
    sl_protect protect;
    sl_seam_cost_def weights; /* where seams run: factors on their length, of the whole mesh; `partner` is the
                                 pairing's; default sl_seam_cost_default(), sl_seam_cost_none() = length alone */
    double effort;       /* work on ruining and making seams again once the search has ended, in small pieces; 0 = none;
                            default 1 */
    int32_t max_cuts;    /* bound on cuts of one piece; default 400 */
    int32_t max_sewings; /* ... on sewings; with max_cuts it ends the same search earlier; default 100000 */
} sl_optimize_def;

sl_optimize_def sl_optimize_default(void);

/* Where the time goes. */
typedef enum sl_optimize_stage {
    SL_OPTIMIZE_COARSEN, /* coarse meshes, and what their edges cost */
    SL_OPTIMIZE_START,   /* the first cuts */
    SL_OPTIMIZE_GUESS,   /* candidate cuts, and guesses at them */
    SL_OPTIMIZE_CUT,     /* probes on whole charts, and the chosen ones solved to the end */
    SL_OPTIMIZE_BALANCE, /* the weight of the energy */
    SL_OPTIMIZE_SEW,     /* without balances */
    SL_OPTIMIZE_STRAIGHTEN,
    SL_OPTIMIZE_CARRY, /* the charts of a coarse mesh made and solved on the next finer one */
    SL_OPTIMIZE_STAGES
} sl_optimize_stage;

/* What was done, summed over the pieces. */
typedef struct sl_optimize_info {
    int32_t pieces, failed; /* cut here; left to the recursion because no valid start was found */
    int32_t missed;         /* pieces whose targets were not met */
    int32_t direct;         /* large pieces searched as they are: no coarse mesh's charts hold on them */
    int32_t cuts, sewings;  /* accepted, on whatever mesh */
    int32_t straightened;   /* parts of seams that were laid anew */
    int32_t trials;         /* candidate cuts and sewings solved */
    /* Of the process's CPU time [s]: of one thread, nothing else in the process running. The only figures that differ
     * from run to run. */
    double seconds[SL_OPTIMIZE_STAGES];
} sl_optimize_info;

/* sl_segment with each component, or half of one that its mirror image copies, cut by the optimiser instead of by the
 * recursion alone: the recursion's cuts start it. A piece that cannot be optimised is left to the recursion, counted
 * in info->failed. segment: method, rule, vectors, pairing, symmetry as for sl_segment; its sew and flatten bounds hold
 * for what is left to the recursion. info is nullable. Statuses and determinism as sl_segment, and SL_BAD_INPUT
 * (def->weights). */
SL_NODISCARD sl_status sl_optimize_segment(sl_mesh *mesh, const sl_triangulation *triangulation,
                                           const sl_segment_def *segment, const sl_optimize_def *def,
                                           const sl_context *context, sl_segmentation **out, sl_optimize_info *info);

#endif
