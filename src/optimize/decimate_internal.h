/* A coarse mesh of a surface, and the way back from its seams to the surface's.
 * Layer: optimize (private). */
#ifndef SL_OPTIMIZE_DECIMATE_INTERNAL_H
#define SL_OPTIMIZE_DECIMATE_INTERNAL_H

#include "mesh/build.h"
#include "optimize/optimize_internal.h"

/* A mesh of about so many triangles (more where none can go) that is homeomorphic to the patch; vertex[i] = the patch's
 * vertex that vertex i of the mesh is. Both owned by the caller. SL_OUT_OF_MEMORY, SL_BAD_INPUT (nothing is left). */
SL_NODISCARD sl_status sl_opt_decimate(const sl_patch *patch, int32_t triangles, sl_mesh **mesh, int32_t **vertex);

/* Carries the seams of a coarse state over: each arc becomes a shortest path of the fine surface near it. vertex[i]:
 * the fine surface's vertex of the coarse mesh's vertex i. fine: no edge cut yet, no charts; *carried = false where
 * paths would have to cross, or the charts are not those of the coarse state, disk for disk; then fine is as it was.
 * The charts are laid flat, coarse->w taken over. SL_OUT_OF_MEMORY, SL_CANCELLED. */
SL_NODISCARD sl_status sl_opt_carry(const sl_opt_state *coarse, const int32_t *vertex, sl_opt_state *fine,
                                    bool *carried);

/* The fine vertex at a corner of the coarse patch. */
int32_t sl_opt_fine_vertex(const sl_opt_surface *coarse, const int32_t *vertex, int32_t corner);

/* UVs of the fine charts from the coarse ones, about: each vertex where the coarse chart's triangle nearest to it puts
 * it, of those around the nearest coarse vertex inside the same chart. There may be flips. Charts that no coarse one
 * answers to stay as they are. SL_OUT_OF_MEMORY. */
SL_NODISCARD sl_status sl_opt_guess(const sl_opt_state *coarse, const int32_t *vertex, sl_opt_state *fine);

/* weight: mesh->nh, out: what a seam along a coarse edge costs on the fine surface over its length: the cheapest path
 * near it, so that the coarse mesh's seams cost what they will. 1 where there is none. SL_OUT_OF_MEMORY. */
SL_NODISCARD sl_status sl_opt_coarse_weights(const sl_opt_surface *fine, const sl_mesh *mesh, const int32_t *vertex,
                                             double *weight);

/* Back to no seams and no charts. */
void sl_opt_uncut(sl_opt_state *fine);

#endif
