/* Ambient visibility: how much of the outside each facet sees.
 * Layer: seamcost. */
#ifndef SL_SEAMCOST_AMBIENT_H
#define SL_SEAMCOST_AMBIENT_H

#include "base/context.h"
#include "mesh/mesh.h"

typedef struct sl_ambient_def {
    int32_t rays;       /* a facet, [4, 256]; fewer on large meshes, then averaged over neighbours; default 32 */
    int64_t rays_total; /* at most about so many, at least 1 a facet; default 2^20 */
} sl_ambient_def;

sl_ambient_def sl_ambient_default(void);

/* visibility[f], in [0, 1]: the share of the rays from facet f, weighted by the cosine to its normal, that leave the
 * mesh:
 *
 *     v = 1 / pi  integral over the hemisphere of  sees(w) (n . w) dw
 *
 * Components with borders are seen from both sides, and the better one counts (the first where it sees three
 * quarters); closed ones from outside, whichever way their facets run. Directions are the same for every facet, in a
 * frame of its own (its normal, its longest edge), so that turning the mesh or numbering it anew changes nothing but by
 * rounding; where rays are few, every facet takes a different part of them, and values are averaged over neighbours
 * that face alike, so numbering matters a little. A facet without area has 1. visibility: nf. SL_BAD_INPUT (an option
 * out of range), SL_OUT_OF_MEMORY, SL_CANCELLED. Same bytes for any number of threads. O(rays log nf). Source: Sheffer,
 * Hart 2002, "Seamster"; rays in place of its pictures. */
SL_NODISCARD sl_status sl_ambient_compute(const sl_mesh *mesh, const sl_ambient_def *def, const sl_context *context,
                                          double *visibility);

#endif
