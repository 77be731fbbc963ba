/* Least squares conformal layout of triangles given by their angles: what LSCM and ABF++ share; internal to the room.
 * Layer: param. */
#ifndef SL_PARAM_RECONSTRUCT_INTERNAL_H
#define SL_PARAM_RECONSTRUCT_INTERNAL_H

#include "base/context.h"
#include "mesh/patch.h"

/* sl_reconstruct_create, _solve and _free in one: positions from angles, see reconstruct.h. SL_SINGULAR,
 * SL_OUT_OF_MEMORY, SL_CANCELLED. */
SL_NODISCARD sl_status sl_conformal_layout(const sl_patch *patch, const double *angle, const sl_context *context,
                                           double *uv);

#endif
