/* What the server says to its pages, as JSON text.
 * Layer: view. */
#ifndef SL_VIEW_STATE_H
#define SL_VIEW_STATE_H

#include "view/scene.h"

/* All of these are terminated and owned by the caller (free, since jansson makes them); NULL when memory is out. */

/* {"t":"state",...}: revision, charts, history with its cursor, constraints with places, notes, red facets. */
char *sl_state_text(const sl_session *session, const sl_scene_view *view, bool can_save, bool texture);

/* {"t":"at",...}: what is under the pointer, with the ends of the edge in both panes. */
char *sl_state_hit(const sl_session *session, sl_pane pane, const sl_scene_hit *hit);

/* {"t":"arc",...}: the seam through a side [v, w, f]: its vertices in walking order with places, and the sides to zip
 * from at either end; no vertices where that is no seam. */
char *sl_state_arc(const sl_session *session, const int32_t side[3]);

/* {"t":"refused","why":...}; {"t":"said","text":...}; {"t":"progress","stage":...,"fraction":...} */
char *sl_state_refused(const sl_diag *diag, sl_status status);
char *sl_state_said(const char *text);
char *sl_state_progress(const char *stage, double fraction);

/* The head of a frame: pane and camera, so that a page can draw over it. */
char *sl_state_frame(sl_pane pane, const sl_look *look, const sl_camera *camera, bool png);

#endif
