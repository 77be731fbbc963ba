/* The two pictures of a session that a page shows: in space, and in UV space.
 * Layer: view. */
#ifndef SL_VIEW_SCENE_H
#define SL_VIEW_SCENE_H

#include "edit/session.h"
#include "image/image.h"
#include "render/frame.h"
#include "view/message.h"

typedef struct sl_scene_view sl_scene_view; /* opaque; borrows the session */

SL_NODISCARD sl_status sl_scene_view_create(const sl_session *session, sl_scene_view **out);
void sl_scene_view_free(sl_scene_view *view); /* NULL is a no-op */

/* Takes over what the session is now: UVs, seams, overlaps, lines. After every change. SL_OUT_OF_MEMORY. */
SL_NODISCARD sl_status sl_scene_view_update(sl_scene_view *view, sl_shown shown, const sl_context *context);

/* What SL_SHOW_TEXTURE shows: a picture over [0, 1]^2, its top row at v = 1, repeated; taken over, NULL = none. */
void sl_scene_view_set_texture(sl_scene_view *view, sl_image *image);

/* The camera of a pane. */
sl_camera sl_scene_view_camera(const sl_scene_view *view, sl_pane pane, const sl_look *look);

/* Draws a pane: rgba, 4 width height bytes. SL_BAD_INPUT, SL_OUT_OF_MEMORY. */
SL_NODISCARD sl_status sl_scene_view_draw(sl_scene_view *view, sl_pane pane, const sl_look *look,
                                          const sl_context *context, uint8_t *rgba);

/* What is under a pixel of the pane drawn last. */
typedef struct sl_scene_hit {
    int32_t facet;  /* -1 = nothing; the rest has no meaning then */
    int32_t corner; /* halfedge that leaves the nearest vertex, in that facet */
    int32_t side;   /* halfedge of the nearest edge, in that facet */
    double uv[2];   /* of the point */
} sl_scene_hit;

sl_scene_hit sl_scene_view_pick(const sl_scene_view *view, sl_pane pane, int32_t x, int32_t y);

/* Facets that are red: overlapping any other on the page. */
int32_t sl_scene_view_red(const sl_scene_view *view);

#endif
