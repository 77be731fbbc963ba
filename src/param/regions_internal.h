/* Regions of a chart that its vertex sectors tie together, and which rows of g2 depend on the others; internal to the
 * room.
 * Layer: param. */
#ifndef SL_PARAM_REGIONS_INTERNAL_H
#define SL_PARAM_REGIONS_INTERNAL_H

#include "param/sectors.h"

/* A region: triangles and sectors joined by common corners. If each of its corners is in one sector, the sum of its
 * rows of g1 minus that of its rows of g2 vanishes identically: one row depends on the others. */
typedef struct sl_regions {
    int32_t count;
    int32_t *of_triangle; /* nt */
    int32_t *of_sector;   /* sectors->count */
    int32_t *triangles;   /* count */
    int32_t *free;        /* count: corners in no sector */
    int32_t *dependent;   /* count: the sector whose row is left out, -1 = none */
    double *excess;       /* count: sum of theta - pi triangles [rad] */
} sl_regions;

/* sectors as sl_sectors_check passes them. Regions with a corner in two sectors have dependent = -1.
 * SL_OUT_OF_MEMORY. O(corners). */
SL_NODISCARD sl_status sl_regions_init(sl_regions *regions, const sl_patch *patch, const sl_sectors *sectors);
void sl_regions_clear(sl_regions *regions);

/* The excess of every region for these theta. Allocates nothing. */
void sl_regions_sum(sl_regions *regions, int32_t count, const double *theta);

/* The first region with a dependent row whose excess is not 0 within rounding; -1 = none. */
int32_t sl_regions_contradicted(const sl_regions *regions);

#endif
