/* The pieces of the horizon packer. All lengths in texels, columns in cells.
 * Layer: pack. */
#ifndef SL_PACK_PACK_INTERNAL_H
#define SL_PACK_PACK_INTERNAL_H

#include "pack/pack.h"

/* A chart in one orientation at one scale, grown by half the margin: column j of the chart spans low[j] .. high[j]
 * above the chart's own origin. */
typedef struct sl_profile {
    int32_t columns;
    double *low, *high;
    double height;       /* max high; min low is 0 */
    double origin[2];    /* texel position of UV (0, 0) when the profile's corner stands at (0, 0) */
    double cosine, sine; /* of its orientation */
} sl_profile;

/* The page's skyline. */
typedef struct sl_horizon {
    int32_t columns;
    double cell;    /* texels a column */
    double side;    /* texels */
    double *height; /* columns */
} sl_horizon;

/* Outline of a chart's triangles turned by angle, scaled by scale [texels a UV unit], grown by grow [texels]; low and
 * high have room for capacity columns. false: wider than that. */
bool sl_profile_make(const sl_pack_chart *chart, double angle, double scale, double grow, double cell, int32_t capacity,
                     sl_profile *out);

/* Best place of a profile: fills x (column) and y (texels); *cost = what is lost under it, for comparing orientations.
 * false: it fits nowhere. O(columns * profile columns). */
bool sl_horizon_find(const sl_horizon *horizon, const sl_profile *profile, int32_t *x, double *y, double *cost);

void sl_horizon_put(sl_horizon *horizon, const sl_profile *profile, int32_t x, double y);

#endif
