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

/* Back to no seams and no charts. */
void sl_opt_uncut(sl_opt_state *fine);

#endif
