/* Least squares conformal layout of triangles given by their angles: what LSCM and ABF++ share; internal to the room.
 * Layer: param. */
#ifndef SL_PARAM_RECONSTRUCT_INTERNAL_H
#define SL_PARAM_RECONSTRUCT_INTERNAL_H

#include "base/context.h"
#include "mesh/patch.h"

/**
 * Positions that minimise the conformal energy of the patch with triangle t of the angles angle[3 t + k].
 *
 *     E = sum over t of |W_0 U_0 + W_1 U_1 + W_2 U_2|^2 / (2 A_t),   W_k = edge opposite to corner k, a complex number
 *
 * Two far border vertices are pinned, the first at the origin; the result is scaled to the patch's 3D area.
 *
 * @param[in]  angle 3 nt, > 0 and with sum pi in each triangle; corrected here where they are not
 * @param[out] uv    nv x 2
 *
 * SL_SINGULAR (no border, fewer than 3 vertices, a vertex without triangles, several components), SL_OUT_OF_MEMORY,
 * SL_CANCELLED. One Cholesky factor of 2 nv - 4 unknowns, a few solves. Deterministic.
 * Source: Levy, Petitjean, Ray, Maillot 2002, "Least squares conformal maps for automatic texture atlas generation". */
SL_NODISCARD sl_status sl_conformal_layout(const sl_patch *patch, const double *angle, const sl_context *context,
                                           double *uv);

#endif
