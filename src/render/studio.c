#include "base/memory.h"
#include "geom/vec3.h"
#include "render/studio_internal.h"

#include <string.h>

enum { KEY_LIGHTS = 20, PLAIN_LIGHTS = 2, MAP_SIDE = 208 };

static const double degree = 0.017453292519943295;
static const double golden_angle = 2.399963229728653;
static const double key_spread = 0.20;  /* radius of the key light's disc, seen from the scene [rad] */
static const double lowest_sky = -0.15; /* sine of the elevation where the sky ends */
static const float key_rgb[3] = {0.86f, 0.83f, 0.79f};
static const float fill_rgb[3] = {0.10f, 0.11f, 0.13f};
static const float rim_rgb[3] = {0.22f, 0.22f, 0.23f};
static const float sky_rgb[3] = {0.40f, 0.42f, 0.45f}; /* irradiance on a surface facing up under the open sky */
static const double ground_strength = 0.78;

/* Axes of the scene and the camera's direction on the ground. */
typedef struct stage_axes {
    double up[3], right[3], back[3]; /* right of the camera, towards the camera, both horizontal */
} stage_axes;

static stage_axes find_axes(const sl_camera *camera, int32_t up_axis)
{
    stage_axes a = {.up = {0.0, 0.0, 0.0}};
    a.up[up_axis] = 1.0;
    memcpy(a.right, camera->right, sizeof a.right); /* horizontal by construction of the view */
    sl_vec3_cross(a.right, a.up, a.back);
    return a;
}

/* The direction `azimuth` degrees to the right of the camera (0 = from the camera) and `elevation` degrees up. */
static void aim(const stage_axes *a, double azimuth, double elevation, double out[3])
{
    const double c = cos(elevation * degree), s = sin(elevation * degree);
    for (int k = 0; k < 3; k++) {
        out[k] = s * a->up[k] + c * (sin(azimuth * degree) * a->right[k] + cos(azimuth * degree) * a->back[k]);
    }
}

static sl_light make_light(const double direction[3], const float rgb[3], float amount, bool shadow)
{
    sl_light light = {.shadow = shadow, .sky = shadow};
    const double length = sl_vec3_norm(direction);
    for (int k = 0; k < 3; k++) {
        light.direction[k] = direction[k] / length;
        light.rgb[k] = amount * rgb[k];
    }
    return light;
}

/* The sky evenly by solid angle along a spiral. */
static void add_sky(const stage_axes *a, int32_t count, sl_light *light)
{
    float facing_up = 0.0f;
    for (int32_t i = 0; i < count; i++) {
        const double height = lowest_sky + (1.0 - lowest_sky) * (i + 0.5) / count;
        const double across = sqrt(1.0 - height * height), turn = golden_angle * i;
        double d[3];
        for (int k = 0; k < 3; k++) {
            d[k] = height * a->up[k] + across * (cos(turn) * a->right[k] + sin(turn) * a->back[k]);
        }
        light[i] = make_light(d, sky_rgb, 1.0f, true);
        facing_up += (float)fmax(height, 0.0);
    }
    for (int32_t i = 0; i < count; i++) {
        for (int k = 0; k < 3; k++) {
            light[i].rgb[k] /= facing_up;
        }
    }
}

/* A disc of lights around the key direction: its shadows have soft edges. */
static void add_key(const stage_axes *a, int32_t count, sl_light *light)
{
    double centre[3], side[3], top[3];
    aim(a, -42.0, 54.0, centre);
    aim(a, 48.0, 0.0, side);
    sl_vec3_cross(centre, side, top);
    for (int32_t i = 0; i < count; i++) {
        const double radius = count > 1 ? key_spread * sqrt((i + 0.5) / count) : 0.0, turn = golden_angle * i;
        double d[3];
        for (int k = 0; k < 3; k++) {
            d[k] = centre[k] + radius * (cos(turn) * side[k] + sin(turn) * top[k]);
        }
        light[i] = make_light(d, key_rgb, 1.0f / (float)count, count > 1);
    }
}

sl_status sl_studio_create(const sl_camera *camera, int32_t up_axis, int32_t sky_lights, int32_t nv, const double *xyz,
                           int32_t nt, const int32_t *tri, const sl_context *context, sl_light_rig **out)
{
    *out = NULL;
    const stage_axes axes = find_axes(camera, up_axis);
    const int32_t keys = sky_lights > 0 ? KEY_LIGHTS : 1, count = sky_lights + keys + PLAIN_LIGHTS;
    sl_light *light = sl_calloc(count, sizeof *light);
    if (light == NULL) {
        return SL_OUT_OF_MEMORY;
    }
    add_sky(&axes, sky_lights, light);
    add_key(&axes, keys, light + sky_lights);
    double fill[3], rim[3];
    aim(&axes, 60.0, 15.0, fill);
    aim(&axes, 155.0, 35.0, rim);
    light[sky_lights + keys] = make_light(fill, fill_rgb, 1.0f, false);
    light[sky_lights + keys + 1] = make_light(rim, rim_rgb, 1.0f, false);
    sl_light_rig_def def = {.lights = count, .light = light, .map_side = MAP_SIDE};
    const float top = sky_lights > 0 ? 0.06f : 0.42f, bottom = sky_lights > 0 ? 0.15f : 0.20f;
    for (int k = 0; k < 3; k++) {
        def.up[k] = axes.up[k];
        def.top_rgb[k] = top;
        def.bottom_rgb[k] = bottom;
    }
    const sl_status status = sl_light_rig_create(&def, nv, xyz, nt, tri, context, out);
    sl_free(light);
    return status;
}

sl_status sl_studio_ground(const sl_light_rig *rig, int32_t up_axis, const double *xyz, int32_t nt, const int32_t *tri,
                           const sl_context *context, sl_ground **out)
{
    double point[3] = {0.0, 0.0, 0.0};
    *out = NULL;
    point[up_axis] = INFINITY;
    for (int64_t k = 0; k < 3 * (int64_t)nt; k++) {
        point[up_axis] = fmin(point[up_axis], xyz[3 * (int64_t)tri[k] + up_axis]);
    }
    return isfinite(point[up_axis]) ? sl_ground_create(rig, point, ground_strength, context, out) : SL_OK;
}
