/* What is seen at one sample.
 * Layer: draw, private. */
#ifndef SL_DRAW_SHADE_INTERNAL_H
#define SL_DRAW_SHADE_INTERNAL_H

#include "draw/shade.h"

typedef struct sl_hit {
    int32_t triangle;
    bool back;      /* seen from behind */
    double bary[3]; /* of the sample, and one sample to the right and below */
    double right[3], below[3];
    double point[3];  /* eye space */
    double facing[3]; /* normal of the triangle in eye space, any length, towards the viewer */
} sl_hit;

/* Where the ray through a picture position meets the plane of triangle t. False for a triangle seen edge-on. */
bool sl_hit_at(const sl_screen *screen, int32_t t, double sx, double sy, sl_hit *hit);

/* Interpolated normal, not of unit length. */
void sl_hit_normal(const sl_material *material, const sl_hit *hit, double normal[3]);

/* Colour without light. */
void sl_hit_color(const sl_material *material, const sl_hit *hit, float rgb[3]);

#endif
