/* A chart as the packer sees it: the edges around what it covers.
 * Layer: pack. */
#ifndef SL_PACK_OUTLINE_H
#define SL_PACK_OUTLINE_H

#include "pack/pack.h"

/* One directed edge of an outline. */
typedef struct sl_outline_edge {
    double from[2], to[2];
} sl_outline_edge;

/* With every triangle turned to positive area, the sum of its edges' crossings along a ray is the number of triangles
 * over a point. Edges that two triangles run along in opposite directions cancel; what is left is kept: borders of the
 * chart and of its holes, and folds. */
typedef struct sl_outline {
    int32_t count;
    sl_outline_edge *edge; /* owned */
    double area;           /* of the triangles */
    double extent;         /* longer side of the smallest enclosing rectangle */
    double angle;          /* turns that rectangle upright [rad] */
    double centre[2];      /* of the bounding box; edges are relative to it */
    double radius;         /* farthest outline point from the centre */
} sl_outline;

/* SL_BAD_INPUT (a UV of the chart not finite), SL_OUT_OF_MEMORY. *out is cleared by the caller in any case.
 * O(nt log nt). */
SL_NODISCARD sl_status sl_outline_init(const sl_pack_chart *chart, sl_outline *out);

void sl_outline_clear(sl_outline *outline);

#endif
