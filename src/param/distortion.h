/* Measures of how far a chart is from an isometry.
 * Layer: param. */
#ifndef SL_PARAM_DISTORTION_H
#define SL_PARAM_DISTORTION_H

#include "base/status.h"

/* Of one chart or of many triangles together. s1 >= s2 are the singular values of the map from 3D to UV, after the one
 * scale that makes the total areas equal. Triangles with 2 area <= 1e-5 longest^2 in 3D are left out of everything but
 * the flip count; in UV 2 area <= 1e-7 longest^2 is degenerate. */
typedef struct sl_distortion {
    double area_3d, area_uv; /* sums over the triangles measured, input units */
    double l2, linf;         /* Sander's stretch: sqrt of the area-weighted mean of (1/s1^2 + 1/s2^2)/2; max of 1/s2 */
    double angle_mean, angle_p95, angle_max; /* s1/s2, area-weighted mean and 95th percentile, maximum */
    double area_mean, area_max;              /* max(s1 s2, 1/(s1 s2)), area-weighted mean; maximum */
    int32_t flipped, degenerate;             /* UV triangles of negative (exact), of vanishing area */
    int32_t measured;                        /* triangles taken into account */
} sl_distortion;

/* nt triangles given by corners: xyz 9 doubles, uv 6 doubles a triangle. `sign` = +1 or -1: the orientation that counts
 * as unflipped. Infinite l2, linf, angle_max where a triangle has collapsed. SL_OUT_OF_MEMORY. O(nt log nt). */
SL_NODISCARD sl_status sl_distortion_measure(int32_t nt, const double *xyz, const double *uv, int sign,
                                             sl_distortion *out);

/* The same for indexed triangles: xyz nv x 3, uv nv x 2, tri 3 nt. */
SL_NODISCARD sl_status sl_distortion_measure_indexed(int32_t nt, const int32_t *tri, const double *xyz,
                                                     const double *uv, sl_distortion *out);

#endif
