/* Arrangements: where charts stand, whatever the grid; and the search for good ones.
 * Layer: pack. */
#ifndef SL_PACK_ARRANGE_H
#define SL_PACK_ARRANGE_H

#include "pack/layout.h"

/* A chart's place: the outline's points are turned by angle, scaled, and moved to `at`. */
typedef struct sl_pose {
    double angle; /* [rad] */
    double at[2]; /* where the outline's centre is on the page [texels] */
    int32_t page;
} sl_pose;

typedef struct sl_arrangement {
    double scale;  /* [texels a UV unit]; 0 = none yet, or nothing but points */
    sl_pose *pose; /* count; owned */
} sl_arrangement;

/* How a search is to be made. */
typedef struct sl_search_def {
    sl_pack_rotations rotations;
    const double *upright; /* count: angle at which each chart stands upright; borrowed */
    double scale;          /* to be kept [texels a UV unit]; 0 = as large as possible */
    int64_t work;          /* words to look at after the first arrangement was found; 0 = that is enough */
} sl_search_def;

/* Poses of charts that all have a spot. */
void sl_pose_from_spots(const sl_sheet *sheet, const sl_spot *spot, sl_pose *pose);

/* Arranges all charts: first scales by bisection, with a few plans at each; then plans changed at random, at scales
 * that grow with each success. SL_INFEASIBLE: nothing fits, at the scale asked for or at all. SL_OUT_OF_MEMORY,
 * SL_CANCELLED. best->pose: count, written on success. *attempts grows by the layouts made. */
SL_NODISCARD sl_status sl_search(const sl_pack_task *task, const sl_search_def *def, sl_arrangement *best,
                                 int32_t *attempts);

/* Cells along a page's width that suit so many charts. */
int32_t sl_search_grid(const sl_pack_task *task);

#endif
