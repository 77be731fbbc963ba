/* What scanning does to a surface: irregular triangles and noise.
 * Layer: datasets-gen. */
#ifndef SL_GENERATORS_ROUGHEN_H
#define SL_GENERATORS_ROUGHEN_H

#include "base/rng.h"
#include "builder.h"

/* Splits every quad into two triangles, along a diagonal drawn from rng; other facets must be triangles already. */
void gen_split_quads(gen_builder *b, sl_rng *rng);

/* Passes over all edges in random order, turning those whose two triangles stay well shaped (no angle below about 23
 * degrees, no fold). Triangles only, closed. The connectivity loses whatever symmetry it had. O(nf log nf) a pass. */
void gen_flip_edges(gen_builder *b, sl_rng *rng, int32_t passes);

/* Moves each vertex at random by up to `amount` times the mean length of its edges: all of it along the normal, half of
 * it sideways. */
void gen_add_noise(gen_builder *b, sl_rng *rng, double amount);

#endif
