/* Tutte's embedding: injective by construction, the last resort.
 * Layer: param. */
#ifndef SL_PARAM_TUTTE_H
#define SL_PARAM_TUTTE_H

#include "base/context.h"
#include "mesh/patch.h"

/* How interior vertices are weighted. Both are positive, so that Tutte's theorem holds, and symmetric, so that one
 * Cholesky factor does (Floater's mean values are positive but not symmetric). */
typedef enum sl_tutte_weights {
    SL_TUTTE_UNIFORM,
    SL_TUTTE_COTANGENT /* cot a + cot b, each cotangent clamped to [0.05, 20]; nearer to the shape */
} sl_tutte_weights;

/* uv (nv x 2) of a disk with its border on a circle: vertices at their arc length, border edges shorter than 1e-3 of
 * the mean lengthened to that; scaled to the patch's 3D area. The circle keeps the border strictly convex, so an edge
 * that joins two border vertices does no harm. uv is unchanged on failure. SL_INFEASIBLE (not a disk, or a border of
 * two edges), SL_SINGULAR, SL_OUT_OF_MEMORY, SL_CANCELLED. One Cholesky solve of the interior vertices, two right
 * sides. Doubles can still collapse long limbs, and a region held by one edge counted twice collapses by right: check
 * with sl_certify_embedding. Source: Tutte 1963, "How to draw a graph"; weights: Eck et al. 1995, clamped. */
SL_NODISCARD sl_status sl_tutte(const sl_patch *patch, sl_tutte_weights weights, const sl_context *context, double *uv);

#endif
