/* The studio: lights around a scene and the ground under it.
 * Layer: render, private. */
#ifndef SL_RENDER_STUDIO_INTERNAL_H
#define SL_RENDER_STUDIO_INTERNAL_H

#include "draw/camera.h"
#include "draw/light.h"
#include "draw/shade.h"

/* A large soft key light from the upper left of the camera, a fill light from the right, a rim light from behind, a sky
 * of `sky_lights` weak lights (0: no shadows at all). up_axis as in sl_view. The rig is owned by the caller. */
SL_NODISCARD sl_status sl_studio_create(const sl_camera *camera, int32_t up_axis, int32_t sky_lights, int32_t nv,
                                        const double *xyz, int32_t nt, const int32_t *tri, const sl_context *context,
                                        sl_light_rig **out);

/* The ground under the lowest vertex in use; *out is NULL when nothing stands on it. */
SL_NODISCARD sl_status sl_studio_ground(const sl_light_rig *rig, int32_t up_axis, const double *xyz, int32_t nt,
                                        const int32_t *tri, const sl_context *context, sl_ground **out);

#endif
