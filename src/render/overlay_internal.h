/* What is laid over a finished view: dots, titles, the colour bar.
 * Layer: render, private. */
#ifndef SL_RENDER_OVERLAY_INTERNAL_H
#define SL_RENDER_OVERLAY_INTERNAL_H

#include "draw/canvas.h"
#include "render/stage_internal.h"

/* A mask over a whole canvas, blended and emptied again by sl_overlay_blend. */
typedef struct sl_overlay {
    sl_canvas *canvas; /* borrowed */
    sl_mask mask;
} sl_overlay;

SL_NODISCARD sl_status sl_overlay_create(sl_canvas *canvas, sl_overlay **out);
void sl_overlay_free(sl_overlay *overlay);

/* Blends what was masked since, in an sRGB colour, and empties the mask. */
void sl_overlay_blend(sl_overlay *overlay, const uint8_t rgb[3], float opacity);

/* A title in the top left corner; NULL or "" = none. */
SL_NODISCARD sl_status sl_overlay_title(sl_canvas *canvas, const char *title);

/* A horizontal colour bar in the bottom right corner, with the numbers at its ends and the name under it. */
SL_NODISCARD sl_status sl_overlay_legend(sl_canvas *canvas, const sl_dressing *dressing, const char *name);

/* Parts of the picture's height that a title takes at the top and a colour bar at the bottom. */
double sl_title_room(const sl_canvas *canvas, const char *title);
double sl_legend_room(const sl_canvas *canvas);

#endif
