/* Room between the parts of a chart's border that touch each other.
 * Layer: param. */
#ifndef SL_PARAM_OPEN_H
#define SL_PARAM_OPEN_H

#include "mesh/patch.h"

/* out: uv with each border vertex moved along the bisector of its interior angle, by `share` of the shorter border edge
 * there or by `least` [uv units], whichever is longer, and at most by 1/8 of that edge. Whether out is still an
 * embedding is for the caller to check. patch: one loop; border: its nb vertex pairs in order; uv, out: nv x 2; angle:
 * nv, work. No allocation. O(corners). */
void sl_open_border(const sl_patch *patch, int32_t nb, const int32_t *border, const double *uv, double share,
                    double least, double *angle, double *out);

/* Does the border stay simple when its nv points are rounded to multiples of `step` from the first? rounded: nv x 2,
 * work. SL_BAD_INPUT (not finite), SL_OUT_OF_MEMORY. */
SL_NODISCARD sl_status sl_border_survives(int32_t nv, int32_t nb, const int32_t *border, const double *uv, double step,
                                          double *rounded, bool *survives);

#endif
