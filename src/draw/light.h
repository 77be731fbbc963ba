/* Light: directional lights, each with a depth map of the scene as it sees it, and a hemisphere of ambient light. Many
 * weak lights over the sky give soft shadows and ambient occlusion in one.
 * Layer: draw. */
#ifndef SL_DRAW_LIGHT_H
#define SL_DRAW_LIGHT_H

#include "base/context.h"

typedef struct sl_light {
    double direction[3]; /* unit, from the scene towards the light */
    float rgb[3];        /* irradiance on a surface facing it, linear */
    bool shadow;         /* hidden by what is in its way */
    bool sky;            /* counts as sky: where the sky is hidden, ambient light is dimmed too */
} sl_light;

typedef struct sl_light_rig_def {
    int32_t lights;
    const sl_light *light;           /* borrowed during creation */
    double up[3];                    /* unit: where the hemisphere's top is */
    float top_rgb[3], bottom_rgb[3]; /* ambient irradiance of surfaces facing up and down */
    int32_t map_side;                /* texels of a depth map's side, [16, 4096]; default 208 */
} sl_light_rig_def;

typedef struct sl_light_rig sl_light_rig; /* opaque */

/* Renders the depth maps of nt triangles over nv points. Points that are not finite and their triangles cast no shadow.
 * SL_BAD_INPUT (map_side), SL_OUT_OF_MEMORY. O(lights (nv + nt + map_side^2)) time, 2 bytes per texel and light. */
SL_NODISCARD sl_status sl_light_rig_create(const sl_light_rig_def *def, int32_t nv, const double *xyz, int32_t nt,
                                           const int32_t *tri, const sl_context *context, sl_light_rig **out);

void sl_light_rig_free(sl_light_rig *rig); /* NULL is a no-op */

/* Irradiance at a point of a surface. normal: unit, shading; facing: unit, of the facet itself, on the same side: the
 * point is lifted along it before shadows are looked up. */
void sl_light_rig_shine(const sl_light_rig *rig, const double point[3], const double normal[3], const double facing[3],
                        float rgb[3]);

#endif
