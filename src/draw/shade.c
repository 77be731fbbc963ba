#include "draw/shade.h"
#include "draw/shade_internal.h"
#include "geom/vec3.h"

#include <string.h>

static const double same_normal = 0.985; /* light of one sample serves another whose normal is this near ... */
static const double same_depth = 4.0;    /* ... and whose depth is within this many pixels' size */
static const float shoulder = 0.80f;     /* brighter light is compressed, so that nothing burns out */

sl_material sl_material_default(void)
{
    return (sl_material){.base_rgb = {0.52f, 0.52f, 0.51f},
                         .missing_rgb = {0.35f, 0.35f, 0.35f},
                         .contour = (double)NAN,
                         .checks = 32.0,
                         .tiles = 1.0,
                         .check_shade = 0.68f,
                         .flag_rgb = {0.80f, 0.02f, 0.02f},
                         .back_rgb = {0.20f, 0.21f, 0.24f},
                         .value_hi = 1.0,
                         .lit = true};
}

/* Light kept from the last sample that was lit. */
typedef struct lit_sample {
    bool valid;
    double normal[3], depth;
    float rgb[3];
} lit_sample;

/* The state of one call. */
typedef struct shader {
    const sl_screen *screen;
    const sl_material *material;
    const sl_light_rig *rig;
    const sl_ground *ground;
    const float *background;
    int32_t scale;
    lit_sample cache;
} shader;

static void to_scene_vector(const sl_camera *c, const double eye[3], double out[3])
{
    for (int k = 0; k < 3; k++) {
        out[k] = eye[0] * c->right[k] + eye[1] * c->up[k] + eye[2] * c->forward[k];
    }
}

static bool normalise(double v[3])
{
    const double length = sl_vec3_norm(v);
    if (!(length > 0.0) || !isfinite(length)) {
        return false;
    }
    for (int k = 0; k < 3; k++) {
        v[k] /= length;
    }
    return true;
}

/* Compresses brightness above the shoulder smoothly towards 1. */
static float compress(float x)
{
    if (!(x > shoulder)) {
        return x > 0.0f ? x : 0.0f;
    }
    const float room = 1.0f - shoulder, over = (x - shoulder) / room;
    return shoulder + room * over / (1.0f + over);
}

/* Normals of a hit: `facing` of the facet and `normal` smooth, both turned to the viewer. */
static void orient(const shader *s, const sl_hit *hit, double facing[3], double normal[3])
{
    to_scene_vector(&s->screen->camera, hit->facing, facing);
    if (!normalise(facing)) {
        for (int k = 0; k < 3; k++) {
            facing[k] = -s->screen->camera.forward[k];
        }
    }
    memcpy(normal, facing, 3 * sizeof *normal);
    if (s->material->normal != NULL) {
        double smooth[3];
        sl_hit_normal(s->material, hit, smooth);
        const bool usable = normalise(smooth);
        const double sign = hit->back ? -1.0 : 1.0;
        for (int k = 0; k < 3 && usable; k++) {
            normal[k] = sign * smooth[k];
        }
    }
}

static void light(shader *s, const sl_hit *hit, float rgb[3])
{
    double facing[3], normal[3], point[3];
    orient(s, hit, facing, normal);
    const sl_camera *c = &s->screen->camera;
    const double pixel = s->scale * (c->perspective ? hit->point[2] : 1.0) / (s->screen->height * c->focal);
    lit_sample *cache = &s->cache;
    if (cache->valid && sl_vec3_dot(cache->normal, normal) > same_normal &&
        fabs(cache->depth - hit->point[2]) < same_depth * pixel) {
        memcpy(rgb, cache->rgb, sizeof cache->rgb);
        return;
    }
    to_scene_vector(c, hit->point, point);
    sl_vec3_add(point, c->eye, point);
    sl_light_rig_shine(s->rig, point, normal, facing, rgb);
    cache->valid = true;
    cache->depth = hit->point[2];
    memcpy(cache->normal, normal, sizeof cache->normal);
    memcpy(cache->rgb, rgb, sizeof cache->rgb);
}

/* What the ground's shadow leaves of the background at a sample. */
static float ground_part(const shader *s, double sx, double sy)
{
    const sl_screen *screen = s->screen;
    double origin[3], direction[3], o[3], d[3];
    sl_camera_ray(&screen->camera, screen->width, screen->height, sx, sy, origin, direction);
    to_scene_vector(&screen->camera, origin, o);
    to_scene_vector(&screen->camera, direction, d);
    sl_vec3_add(o, screen->camera.eye, o);
    return sl_ground_seen(s->ground, o, d);
}

static void shade_sample(shader *s, uint64_t zid, int32_t x, int32_t y, float rgb[3])
{
    const int32_t t = sl_visible_triangle(zid);
    sl_hit hit;
    if (t < 0 || !sl_hit_at(s->screen, t, x + 0.5, y + 0.5, &hit)) {
        const float part = s->ground != NULL ? ground_part(s, x + 0.5, y + 0.5) : 1.0f;
        for (int k = 0; k < 3; k++) {
            rgb[k] = part * s->background[k];
        }
        return;
    }
    sl_hit_color(s->material, &hit, rgb);
    if (s->material->lit) {
        float irradiance[3];
        light(s, &hit, irradiance);
        for (int k = 0; k < 3; k++) {
            rgb[k] = compress(rgb[k] * irradiance[k]);
        }
    }
}

void sl_shade(const sl_screen *screen, const sl_visibility *window, const sl_material *material,
              const sl_light_rig *rig, const sl_ground *ground, const float background[3], int32_t scale,
              float *samples)
{
    shader s = {
        .screen = screen, .material = material, .rig = rig, .ground = ground, .background = background, .scale = scale};
    for (int32_t py = 0; py < window->height; py += scale) {
        for (int32_t px = 0; px < window->width; px += scale) {
            s.cache.valid = false;
            for (int32_t k = 0; k < scale * scale; k++) {
                const int32_t x = px + k % scale, y = py + k / scale;
                if (x < window->width && y < window->height) {
                    const int64_t at = (int64_t)y * window->width + x;
                    shade_sample(&s, window->zid[at], window->x0 + x, window->y0 + y, samples + 3 * at);
                }
            }
        }
    }
}
