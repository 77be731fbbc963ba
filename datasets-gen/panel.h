/* Square panels with a round hole.
 * Layer: datasets-gen. */
#ifndef SL_GENERATORS_PANEL_H
#define SL_GENERATORS_PANEL_H

#include "grid.h"

/* A panel in space: its middle, its two half sides and its thickness as vectors; half[0] x half[1] points along depth,
 * which runs from the face at `middle` to the other one. */
typedef struct gen_panel {
    double middle[3];
    double half[2][3], depth[3];
    double hole;   /* radius */
    int32_t side;  /* facets along a side of the square, even */
    int32_t rings; /* of facets around the hole on each face */
    int32_t wall;  /* facets along the hole's wall */
} gen_panel;

/* Both faces and the hole's wall; the panel's rim is left open. Weld afterwards. */
void gen_panel_into(gen_builder *b, const gen_panel *panel);

#endif
