/* Colours of charts.
 * Layer: render. */
#ifndef SL_RENDER_CHART_COLORS_H
#define SL_RENDER_CHART_COLORS_H

#include "mesh/mesh.h"

/* An sRGB colour per facet (3 nf bytes) from its chart (nf numbers, -1 = none: light grey): charts take, in the order
 * of their numbers, the palette's colour that differs most from their neighbours' and is least used so far, so that
 * neighbours differ however many charts there are. SL_BAD_INPUT (a chart below -1 or over 2^24), SL_OUT_OF_MEMORY.
 * Deterministic. O(corners + charts). */
SL_NODISCARD sl_status sl_chart_colors(const sl_mesh *mesh, const int32_t *chart, uint8_t *facet_rgb);

#endif
