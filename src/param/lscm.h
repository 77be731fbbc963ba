/* Least squares conformal maps.
 * Layer: param (may include mesh, sparse, overlap, geom, graph, base). */
#ifndef SL_PARAM_LSCM_H
#define SL_PARAM_LSCM_H

#include "base/context.h"
#include "mesh/patch.h"

/* uv (nv x 2) minimising the conformal energy of Levy et al. 2002 with two far border vertices pinned; scaled to the
 * patch's 3D area, first pin at the origin. Angles below 1e-6 count as 1e-6, so degenerate triangles stay thin and the
 * rest sound. No promise about flips. One Cholesky factor of 2 nv - 4 unknowns, solved until refined to working accuracy.
 * SL_SINGULAR (no border, fewer than 3 vertices, several components), SL_OUT_OF_MEMORY, SL_CANCELLED. Deterministic. */
SL_NODISCARD sl_status sl_lscm(const sl_patch *patch, const sl_context *context, double *uv);

#endif
