/* The two views on a canvas of the picture's size.
 * Layer: render, private. */
#ifndef SL_RENDER_VIEW_INTERNAL_H
#define SL_RENDER_VIEW_INTERNAL_H

#include "render/stage_internal.h"

/* The model. The dressing must be smooth. SL_BAD_INPUT: the view. */
SL_NODISCARD sl_status sl_view_3d(const sl_scene *scene, const sl_view *view, const sl_picture *picture,
                                  const sl_dressing *dressing, const sl_context *context, sl_canvas *canvas,
                                  sl_diag *diag);

/* The atlas; scene->corner_uv is not NULL. */
SL_NODISCARD sl_status sl_view_uv(const sl_scene *scene, const sl_picture *picture, const sl_dressing *dressing,
                                  const sl_context *context, sl_canvas *canvas);

#endif
