/* Shared by the files of this room.
 * Layer: atlas. */
#ifndef SL_ATLAS_ATLAS_INTERNAL_H
#define SL_ATLAS_ATLAS_INTERNAL_H

#include "atlas/atlas.h"

/* Packs the charts that are no copies: atlas->placement and atlas->pack, and room for the UVs. SL_INFEASIBLE (they do
 * not fit: diag says so), SL_OUT_OF_MEMORY, SL_CANCELLED, SL_BAD_INPUT (a UV is not finite). */
SL_NODISCARD sl_status sl_atlas_pack(sl_atlas *atlas, const sl_atlas_def *def, const sl_context *context,
                                     sl_diag *diag);

/* Judges atlas->corner_uv, as it will be written, and fills atlas->check: each chart's certificate by exact predicates,
 * then texel counts over every page. SL_OUT_OF_MEMORY, SL_BAD_INPUT (a UV is not finite). */
SL_NODISCARD sl_status sl_atlas_verify(sl_atlas *atlas, const sl_atlas_def *def, const sl_context *context);

/* Makes room where a chart's border comes closer to itself on the page than a texel count can tell, where the chart
 * stays an embedding. Before sl_atlas_verify. SL_OUT_OF_MEMORY, SL_BAD_INPUT (a UV is not finite). */
SL_NODISCARD sl_status sl_atlas_clear_borders(sl_atlas *atlas, const sl_context *context);

#endif
