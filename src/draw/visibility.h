/* The visibility buffer: at each sample the nearest triangle, depth and number in one word. It serves shading, picking
 * and hidden-line removal alike.
 * Layer: draw. */
#ifndef SL_DRAW_VISIBILITY_H
#define SL_DRAW_VISIBILITY_H

#include "draw/screen.h"

/* Where no triangle is. */
#define SL_NOTHING UINT64_MAX

/* A window of the picture: samples [x0, x0 + width) x [y0, y0 + height). zid = key << 32 | triangle, the key quantised
 * to 32 bits, so the least word is the nearest triangle, and of equally near ones the one of lowest number. */
typedef struct sl_visibility {
    int32_t x0, y0, width, height;
    uint64_t *zid; /* width * height, row-major; borrowed */
} sl_visibility;

/* Empties the window, then draws what of the screen falls into it. A sample is inside a triangle by the top-left rule
 * on the snapped corners: each sample under a mesh of edge-sharing triangles on one side of the picture belongs to
 * exactly one. The result does not depend on the window. Allocates nothing, cannot fail. One thread. */
void sl_visibility_draw(const sl_screen *screen, sl_visibility *window);

/* Triangle of a word, -1 = none. */
static inline int32_t sl_visible_triangle(uint64_t zid)
{
    return zid == SL_NOTHING ? -1 : (int32_t)(zid & 0x7fffffffu);
}

/* Key of a word in [0, 1]; 2 where nothing is. */
static inline double sl_visible_key(uint64_t zid)
{
    return zid == SL_NOTHING ? 2.0 : (double)(zid >> 32) * 0x1p-32;
}

#endif
