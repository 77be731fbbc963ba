/* Animations: a segmentation split by split, a solve iteration by iteration.
 * Layer: cli. */
#ifndef SL_CLI_RENDER_ANIMATE_H
#define SL_CLI_RENDER_ANIMATE_H

#include "atlas/atlas.h"
#include "cli/abf_trace.h"
#include "image/apng.h"

/* The model turning once while it is cut, split by split, and beside it the charts that are finished where they lie in
 * the atlas; the last pictures show the atlas as it is, sewn. Charts keep their colours while they are cut, the largest
 * part its parent's. *out is owned by the caller. SL_OUT_OF_MEMORY, SL_CANCELLED, SL_INTERNAL. */
SL_NODISCARD sl_status cli_animate_segmentation(const sl_atlas *atlas, const sl_context *context, sl_apng **out);

/* The chart as it lies after every iteration, all laid onto the last by similarities, in one window; flipped triangles
 * red. Written as an animated PNG. SL_CHECK_FAILED (no iteration could be laid out), SL_IO, SL_OUT_OF_MEMORY,
 * SL_CANCELLED. */
SL_NODISCARD sl_status cli_animate_solve(const abf_trace *trace, const char *path, const sl_context *context,
                                         sl_diag *diag);

#endif
