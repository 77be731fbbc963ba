/* What a rig is made of, for the ground's shadow.
 * Layer: draw, private. */
#ifndef SL_DRAW_LIGHT_INTERNAL_H
#define SL_DRAW_LIGHT_INTERNAL_H

#include "draw/light.h"

/* A light and its view of the scene: depth in 1/65535 of the scene's diameter, 65535 = nothing. */
typedef struct sl_mapped_light {
    sl_light light;
    double right[3], up[3];
    uint16_t *depth; /* NULL without shadow */
} sl_mapped_light;

struct sl_light_rig {
    int32_t lights;
    sl_mapped_light *light;
    double scene_up[3];
    float top_rgb[3], bottom_rgb[3];
    int32_t side;
    double centre[3], radius;
    double texel; /* scene units */
    uint16_t *depth;
};

/* Mean of a colour's channels. */
float sl_brightness(const float rgb[3]);

/* Texel of a light's map under a point: false outside the map. *depth is the point's own depth in the map's unit. */
bool sl_map_texel(const sl_light_rig *rig, const sl_mapped_light *light, const double point[3], uint16_t *texel,
                  double *depth);

#endif
