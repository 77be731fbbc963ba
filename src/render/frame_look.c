/* Single pixels: barycentrics for picking, and colours where sight has to be followed into space. */
#include "draw/camera.h"
#include "geom/vec3.h"
#include "render/frame_internal.h"
#include "render/frame_lanes.h"
#include "render/frame_light.h"

#include <math.h>

void sl_frame_barycentrics(const sl_frame *f, int32_t t, double x, double y, double bary[3])
{
    double p[3][3], origin[3], direction[3], n[3], sum = 0.0;
    sl_camera_ray(&f->camera, f->width, f->height, x + 0.5, y + 0.5, origin, direction);
    for (int k = 0; k < 3; k++) {
        sl_camera_to_eye(&f->camera, f->xyz + 3 * (int64_t)f->tri[3 * (int64_t)t + k], p[k]);
    }
    for (int k = 0; k < 3; k++) { /* Source: Olano and Greer 1997 */
        const double *a = p[(k + 1) % 3], *b = p[(k + 2) % 3];
        sl_vec3_cross(a, b, n);
        bary[k] = f->camera.perspective
                      ? sl_vec3_dot(direction, n)
                      : (a[0] - origin[0]) * (b[1] - origin[1]) - (b[0] - origin[0]) * (a[1] - origin[1]);
        sum += bary[k];
    }
    double positive = 0.0;
    for (int k = 0; k < 3; k++) {
        bary[k] = bary[k] / sum > 0.0 ? bary[k] / sum : 0.0; /* false for NaN */
        positive += bary[k];
    }
    for (int k = 0; k < 3; k++) {
        bary[k] = positive > 0.0 && positive < INFINITY ? bary[k] / positive : 1.0 / 3.0;
    }
}

static void facet_normal(const sl_frame *f, int32_t t, double normal[3])
{
    const int32_t *tri = f->tri + 3 * (int64_t)t;
    const double *p = f->xyz + 3 * (int64_t)tri[0];
    double a[3], b[3];
    sl_vec3_sub(f->xyz + 3 * (int64_t)tri[1], p, a);
    sl_vec3_sub(f->xyz + 3 * (int64_t)tri[2], p, b);
    sl_vec3_cross(a, b, normal);
}

float sl_frame_facet_cosine(const sl_frame *f, int32_t t)
{
    double normal[3];
    facet_normal(f, t, normal);
    const double length = sl_vec3_norm(normal);
    return length > 0.0 && length < INFINITY ? (float)(sl_vec3_dot(normal, f->light) / length) : 0.0f;
}

/* Is the viewer behind the triangle? In space, whatever is on the picture. */
static bool seen_from_behind(const sl_frame *f, int32_t t)
{
    double normal[3], to[3];
    facet_normal(f, t, normal);
    sl_vec3_sub(f->xyz + 3 * (int64_t)f->tri[3 * (int64_t)t], f->camera.eye, to);
    return sl_vec3_dot(normal, f->camera.perspective ? to : f->camera.forward) > 0.0;
}

static float surface_light(float cosine, bool behind)
{
    const float toward = light_wrap + (1.0f - light_wrap) * (behind ? -cosine : cosine);
    return (light_ambient + light_direct * (toward > 0.0f ? toward : 0.0f)) * (behind ? light_behind : 1.0f);
}

static float light_at(const sl_frame *f, int32_t t, const double bary[3])
{
    const bool behind = seen_from_behind(f, t);
    float light = 0.0f;
    if (!f->style.lit) {
        return 1.0f;
    }
    if (f->style.flat) {
        return surface_light(sl_frame_facet_cosine(f, t), behind);
    }
    for (int k = 0; k < 3; k++) {
        light += (float)bary[k] * surface_light(f->vertex[f->tri[3 * (int64_t)t + k]].cosine, behind);
    }
    return light;
}

/* Integral of the square wave of the checkerboard, as in the kernels. */
static float wave(float x)
{
    const float nearest = (0.5f * x + check_rounding) - check_rounding;
    return fabsf(x - (nearest + nearest));
}

/* Mean of the wave over a pixel, in one direction, by its UVs here, to the right and below. */
static float wave_mean(const float at[3])
{
    const float larger = fmaxf(fabsf(at[1] - at[0]), fabsf(at[2] - at[0])), width = fmaxf(larger, check_least);
    const float mean = (wave(at[0] + 0.5f * width) - wave(at[0] - 0.5f * width)) / width;
    return width < check_widest ? fminf(fmaxf(mean, -1.0f), 1.0f) : 0.0f;
}

/* What the checkerboard makes of light. */
static float check_at(const sl_frame *f, int32_t t, double bary[3][3])
{
    float at[2][3] = {{0.0f, 0.0f, 0.0f}, {0.0f, 0.0f, 0.0f}};
    if (f->uv == NULL || !(f->style.checks > 0.0)) {
        return 1.0f;
    }
    for (int k = 0; k < 6; k++) {
        const float square = (float)f->style.checks * f->uv[6 * (int64_t)t + k];
        if (!(fabsf(square) < check_farthest)) {
            return 1.0f;
        }
        for (int i = 0; i < 3; i++) {
            at[k % 2][i] += (float)bary[i][k / 2] * square;
        }
    }
    return check_middle + check_half * wave_mean(at[0]) * wave_mean(at[1]);
}

uint32_t sl_frame_look_odd(const sl_frame *f, int32_t t, int32_t x, int32_t y)
{
    double bary[3][3];
    for (int i = 0; i < 3; i++) {
        sl_frame_barycentrics(f, t, x + (i == 1), y + (i == 2), bary[i]);
    }
    const float light = fminf(fmaxf(light_at(f, t, bary[0]) * check_at(f, t, bary), 0.0f), 1.0f);
    const float d = sqrtf(light) - 1.0f, power = 1.0f + d * (power_1 + d * (power_2 + d * power_3));
    return tint(f->color[t], (uint32_t)fminf(power * 65536.0f, 65535.0f));
}
