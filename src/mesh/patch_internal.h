/* What the ways to make a patch share.
 * Layer: mesh, private. */
#ifndef SL_MESH_PATCH_INTERNAL_H
#define SL_MESH_PATCH_INTERNAL_H

#include "mesh/patch.h"

/* A patch of nt triangles with its per-corner and per-triangle arrays allocated, nothing filled, no vertices yet. */
SL_NODISCARD sl_status sl_patch_allocate(int64_t nt, sl_patch **out);

/* Given tri (as indices into xyz) and twin: makes a vertex of each fan of triangles, then outgoing, border, loops,
 * euler. */
SL_NODISCARD sl_status sl_patch_finish(sl_patch *patch, const double *xyz);

#endif
