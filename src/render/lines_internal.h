/* Lines and dots of a scene, as segments in eye space.
 * Layer: render, private. */
#ifndef SL_RENDER_LINES_INTERNAL_H
#define SL_RENDER_LINES_INTERNAL_H

#include "render/stage_internal.h"

/* Layers in the order they are drawn: hairlines, seams or outlines, the scene's edges, the scene's dots. Owned. */
typedef struct sl_line_set {
    int32_t layers;
    sl_line_layer *layer;
    double **segment; /* of each layer */
} sl_line_set;

/* On the model: the screen's points are the mesh's vertices; seams are drawn, borders are not. */
SL_NODISCARD sl_status sl_lines_on_model(const sl_scene *scene, const sl_dressing *dressing, const sl_screen *screen,
                                         sl_line_set *set);

/* In the atlas: the screen's points are the corners; charts are outlined, an edge or dot shows in every chart it is in.
 */
SL_NODISCARD sl_status sl_lines_in_atlas(const sl_scene *scene, const sl_screen *screen, sl_line_set *set);

void sl_line_set_clear(sl_line_set *set);

#endif
