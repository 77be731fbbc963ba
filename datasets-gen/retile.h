/* Low-polygon facets out of quads.
 * Layer: datasets-gen. */
#ifndef SL_GENERATORS_RETILE_H
#define SL_GENERATORS_RETILE_H

#include "generators.h"

/* Splits quads that are bent into two triangles, and joins two neighbours that are flat together into a hexagon. The
 * mesh, quads only, is one that gen_cage_finish joined from a mirrored cage; its halves are tiled alike, so that the
 * mirror maps facets to facets. Facets keep their order, those of the half modelled before their images, and vertices
 * stay. Frees `quads`; on failure *out is NULL. SL_OUT_OF_MEMORY. O(nf log nf). */
SL_NODISCARD sl_status gen_retile(sl_generated *quads, sl_generated **out);

#endif
