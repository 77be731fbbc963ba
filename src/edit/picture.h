/* What a session looks like: model and atlas side by side, overlaps red, straight lines blue, angles yellow.
 * Layer: edit. */
#ifndef SL_EDIT_PICTURE_H
#define SL_EDIT_PICTURE_H

#include "edit/session.h"
#include "render/render.h"

/* title: nullable, ASCII. view: nullable. Facets are red that overlap any other on the page. *out owned by the caller.
 * Statuses as of sl_render_pair. */
SL_NODISCARD sl_status sl_session_picture(const sl_session *session, const sl_view *view, const sl_picture *picture,
                                          const sl_context *context, sl_image **out, sl_diag *diag);

#endif
