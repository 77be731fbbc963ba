/* A segmentation as an animation: its splits one after the other.
 * Layer: cli. */
#ifndef SL_CLI_RENDER_ANIMATE_H
#define SL_CLI_RENDER_ANIMATE_H

#include "atlas/atlas.h"
#include "image/apng.h"

/* The model turning once while it is cut, split by split, and beside it the charts that are finished where they lie in
 * the atlas; the last pictures show the atlas as it is, sewn. Charts keep their colours while they are cut, the largest
 * part its parent's. *out is owned by the caller. SL_OUT_OF_MEMORY, SL_CANCELLED, SL_INTERNAL. */
SL_NODISCARD sl_status cli_animate_segmentation(const sl_atlas *atlas, const sl_context *context, sl_apng **out);

#endif
