/* Pictures: the model in 3D, its atlas, or both side by side.
 * Layer: render. */
#ifndef SL_RENDER_RENDER_H
#define SL_RENDER_RENDER_H

#include "base/context.h"
#include "render/scene.h"

/* The model: framed by itself, in soft studio light, smooth normals split at creases, seams as dark lines with hidden
 * ones removed. view is nullable (sl_view_default).
 *
 * Of all three: *out is an RGB picture owned by the caller, NULL on failure. SL_BAD_INPUT (an option out of range, an
 * edge or vertex number of a layer out of range; diag, nullable, says which), SL_OUT_OF_MEMORY, SL_CANCELLED. Arrays
 * may hold NaN; an empty mesh gives an empty stage. Memory: 16 bytes a pixel, and for each worker 24 a sample of 32
 * rows. The same bytes for any number of threads. */
SL_NODISCARD sl_status sl_render_3d(const sl_scene *scene, const sl_view *view, const sl_picture *picture,
                                    const sl_context *context, sl_image **out, sl_diag *diag);

/* The atlas: charts in their colours or values with the checkerboard, their outlines, the unit square. Where UVs leave
 * the unit square the window grows to hold them. Without corner_uv: SL_BAD_INPUT. */
SL_NODISCARD sl_status sl_render_uv(const sl_scene *scene, const sl_picture *picture, const sl_context *context,
                                    sl_image **out, sl_diag *diag);

/* Model left, atlas right (between them the model from behind where picture->back_view), in panels of equal width.
 * Colours and checkerboard are those of one scene, so squares of one size on the model are squares of one size on the
 * atlas. */
SL_NODISCARD sl_status sl_render_pair(const sl_scene *scene, const sl_view *view, const sl_picture *picture,
                                      const sl_context *context, sl_image **out, sl_diag *diag);

#endif
