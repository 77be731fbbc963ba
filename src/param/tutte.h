/* Tutte's embedding: injective by construction, the last resort.
 * Layer: param. */
#ifndef SL_PARAM_TUTTE_H
#define SL_PARAM_TUTTE_H

#include "base/context.h"
#include "mesh/patch.h"

/* How interior vertices are weighted; both positive, so that Tutte's theorem holds. */
typedef enum sl_tutte_weights {
    SL_TUTTE_UNIFORM,
    SL_TUTTE_MEAN_VALUE /* Floater 2003; nearer to the shape, positive on any mesh */
} sl_tutte_weights;

/* uv (nv x 2) of a disk with its border on a circle (vertices at their arc length, or evenly where that is degenerate),
 * scaled to the patch's 3D area. Where an edge joins two border vertices and would fold, the border is convex but not
 * strictly: the circle keeps it strict. SL_INFEASIBLE (not a disk), SL_SINGULAR, SL_OUT_OF_MEMORY, SL_CANCELLED.
 * Doubles can still collapse long limbs: check with sl_certify_embedding. Source: Tutte 1963. */
SL_NODISCARD sl_status sl_tutte(const sl_patch *patch, sl_tutte_weights weights, const sl_context *context, double *uv);

#endif
