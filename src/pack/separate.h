/* Arrangements packed tighter by letting charts overlap and pushing them apart again.
 * Layer: pack. */
#ifndef SL_PACK_SEPARATE_H
#define SL_PACK_SEPARATE_H

#include "pack/arrange.h"

typedef struct sl_separate_def {
    int32_t grid;   /* cells along a page's width */
    bool far;       /* charts may also move across the page, and be turned by any of the search's angles */
    int32_t sweeps; /* over all charts that overlap, without their overlap becoming less, before a scale is given up */
    double step;    /* first growth of the scale, relative; halved each time a scale is given up */
    int32_t halvings; /* ... so often */
    uint64_t seed;
    sl_pack_rotations rotations;
} sl_separate_def;

/* Grows best->scale for as long as the charts, let overlap at first, can be pushed apart on the grid: each chart that
 * overlaps moves to the place nearby, or anywhere on its page, where the weighted area of its overlaps is least; the
 * weights of pairs that still overlap after a sweep grow. best is left as it was where that never succeeds.
 * SL_OUT_OF_MEMORY, SL_CANCELLED. *attempts grows by the scales tried. Source: Egeblad, Nielsen, Odgaard 2007, "Fast
 * neighborhood search for two- and three-dimensional nesting problems" (guided local search over overlaps); Gardeyn,
 * Wauters 2025, "An open-source heuristic to reboot 2D nesting research" (growing weights of pairs). Deviations:
 * overlaps are areas of grid cells, and all places of a window are looked at. */
SL_NODISCARD sl_status sl_separate(const sl_pack_task *task, const sl_separate_def *def, sl_arrangement *best,
                                   int32_t *attempts);

/* The same at the scale that the arrangement has: charts that overlap there are pushed apart. *apart = false: they
 * still overlap, less than before as a rule; the poses are where they came to, for a finer grid. def->step and halvings
 * are not used. Statuses and cost as sl_separate. */
SL_NODISCARD sl_status sl_separate_at(const sl_pack_task *task, const sl_separate_def *def, sl_arrangement *arrangement,
                                      bool *apart, int32_t *attempts);

/* At the scale that best has: charts of the emptiest page go onto the others and all are pushed apart there, for as
 * long as that succeeds. sweeps: as sl_separate_def.sweeps; finest: cells along a page's width. SL_OUT_OF_MEMORY,
 * SL_CANCELLED. */
SL_NODISCARD sl_status sl_fewer_pages(const sl_pack_task *task, sl_pack_rotations rotations, int32_t sweeps,
                                      int32_t finest, sl_arrangement *best, int32_t *attempts);

#endif
