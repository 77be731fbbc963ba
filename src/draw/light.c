#include "draw/light.h"
#include "base/memory.h"
#include "draw/light_internal.h"
#include "draw/visibility.h"
#include "geom/vec3.h"

#include <string.h>

static const double lift_texels = 1.5; /* a point is lifted off its own facet by this many texels of a map */
static const double bias_texels = 1.0; /* and may be this much deeper than what the map shows */
static const double map_margin = 2.0;  /* texels around the scene */
static const double golden_angle = 2.399963229728653;
static const float dimmed = 0.75f; /* part of the ambient light that the sky's openness scales */

typedef struct map_task {
    sl_light_rig *rig;
    int32_t nv, nt;
    const double *xyz;
    const int32_t *tri;
    sl_status *status; /* per light */
} map_task;

static void bound(sl_light_rig *rig, int32_t nv, const double *xyz)
{
    double lo[3] = {INFINITY, INFINITY, INFINITY}, hi[3] = {-INFINITY, -INFINITY, -INFINITY};
    for (int64_t v = 0; v < nv; v++) {
        const double *p = xyz + 3 * v;
        for (int k = 0; k < 3 && isfinite(p[0] + p[1] + p[2]); k++) {
            lo[k] = fmin(lo[k], p[k]);
            hi[k] = fmax(hi[k], p[k]);
        }
    }
    for (int k = 0; k < 3; k++) {
        rig->centre[k] = lo[k] <= hi[k] ? 0.5 * (lo[k] + hi[k]) : 0.0;
    }
    double radius2 = 0.0;
    for (int64_t v = 0; v < nv; v++) {
        const double d = sl_vec3_distance(xyz + 3 * v, rig->centre);
        radius2 = d * d > radius2 ? d * d : radius2; /* NaN compares false */
    }
    rig->radius = radius2 > 0.0 && isfinite(radius2) ? sqrt(radius2) : 1.0;
    rig->texel = 2.0 * rig->radius / (rig->side - 2.0 * map_margin);
}

/* Two axes across the light's direction, turned by another angle for each light, so that the steps of their shadows'
 * edges do not add up. */
static void set_axes(sl_mapped_light *m, int32_t number)
{
    const double *d = m->light.direction;
    const int least = fabs(d[0]) < fabs(d[1]) ? (fabs(d[0]) < fabs(d[2]) ? 0 : 2) : (fabs(d[1]) < fabs(d[2]) ? 1 : 2);
    double axis[3] = {0.0, 0.0, 0.0}, side[3], top[3], forward[3];
    axis[least] = 1.0;
    sl_vec3_cross(axis, d, side);
    sl_vec3_cross(d, side, top);
    const double length = sl_vec3_norm(side), c = cos(golden_angle * number), n = sin(golden_angle * number);
    for (int k = 0; k < 3; k++) {
        m->right[k] = (c * side[k] + n * top[k]) / length;
        forward[k] = -d[k];
    }
    sl_vec3_cross(m->right, forward, m->up);
}

static sl_camera map_camera(const sl_light_rig *rig, const sl_mapped_light *m)
{
    sl_camera c = {
        .centre = {0.5, 0.5}, .focal = 1.0 / (rig->side * rig->texel), .near_depth = 0.0, .perspective = false};
    for (int k = 0; k < 3; k++) {
        c.right[k] = m->right[k];
        c.up[k] = m->up[k];
        c.forward[k] = -m->light.direction[k];
        c.eye[k] = rig->centre[k] + rig->radius * m->light.direction[k];
    }
    return c;
}

/* Depth along the light of a point, in [0, 65534]. */
static double map_depth(const sl_light_rig *rig, const sl_mapped_light *m, const double point[3])
{
    double d[3];
    sl_vec3_sub(point, rig->centre, d);
    return (rig->radius - sl_vec3_dot(d, m->light.direction)) / (2.0 * rig->radius) * 65534.0;
}

static sl_status render_map(const map_task *task, sl_mapped_light *m)
{
    sl_status status = SL_OK;
    const sl_light_rig *rig = task->rig;
    const int64_t texels = (int64_t)rig->side * rig->side;
    const sl_camera camera = map_camera(rig, m);
    sl_screen *screen = NULL;
    sl_visibility window = {0, 0, rig->side, rig->side, sl_alloc(texels, sizeof *window.zid)};
    if (window.zid == NULL) {
        return SL_OUT_OF_MEMORY;
    }
    SL_TRY(sl_screen_create(&camera, rig->side, rig->side, task->nv, task->xyz, task->nt, task->tri, rig->side, NULL,
                            &screen));
    sl_visibility_draw(screen, &window);
    for (int64_t i = 0; i < texels; i++) {
        const double key = sl_visible_key(window.zid[i]);
        const double z = (key - screen->key_offset) / screen->key_scale / (2.0 * rig->radius) * 65534.0;
        m->depth[i] = key > 1.0 ? UINT16_MAX : (uint16_t)fmin(fmax(z, 0.0), 65534.0);
    }
cleanup:
    sl_free(window.zid);
    sl_screen_free(screen);
    return status;
}

static void render_maps(void *user, int64_t begin, int64_t end, int32_t chunk)
{
    (void)chunk;
    const map_task *task = user;
    for (int64_t i = begin; i < end; i++) {
        sl_mapped_light *m = &task->rig->light[i];
        task->status[i] = m->depth != NULL ? render_map(task, m) : SL_OK;
    }
}

static sl_status allocate(sl_light_rig *rig, const sl_light_rig_def *def)
{
    const int64_t texels = (int64_t)rig->side * rig->side;
    int64_t shadows = 0;
    for (int32_t i = 0; i < def->lights; i++) {
        shadows += def->light[i].shadow ? 1 : 0;
    }
    rig->light = sl_calloc(def->lights, sizeof *rig->light);
    rig->depth = sl_alloc(shadows * texels, sizeof *rig->depth);
    if (rig->light == NULL || rig->depth == NULL) {
        return SL_OUT_OF_MEMORY;
    }
    uint16_t *next = rig->depth;
    for (int32_t i = 0; i < def->lights; i++) {
        sl_mapped_light *m = &rig->light[i];
        m->light = def->light[i];
        set_axes(m, i);
        if (m->light.shadow) {
            m->depth = next;
            next += texels;
        }
    }
    return SL_OK;
}

float sl_brightness(const float rgb[3])
{
    return (rgb[0] + rgb[1] + rgb[2]) / 3.0f;
}

sl_status sl_light_rig_create(const sl_light_rig_def *def, int32_t nv, const double *xyz, int32_t nt,
                              const int32_t *tri, const sl_context *context, sl_light_rig **out)
{
    sl_status status = SL_OK;
    *out = NULL;
    if (def->map_side < 16 || def->map_side > 4096) {
        return SL_BAD_INPUT;
    }
    sl_light_rig *rig = sl_calloc(1, sizeof *rig);
    map_task task = {rig, nv, nt, xyz, tri, sl_calloc(def->lights, sizeof *task.status)};
    if (rig == NULL || task.status == NULL) {
        status = SL_OUT_OF_MEMORY;
        goto cleanup;
    }
    rig->lights = def->lights;
    rig->side = def->map_side;
    memcpy(rig->scene_up, def->up, sizeof rig->scene_up);
    memcpy(rig->top_rgb, def->top_rgb, sizeof rig->top_rgb);
    memcpy(rig->bottom_rgb, def->bottom_rgb, sizeof rig->bottom_rgb);
    SL_TRY(allocate(rig, def));
    bound(rig, nv, xyz);
    sl_parallel_for(context, rig->lights, 1, render_maps, &task);
    for (int32_t i = 0; i < rig->lights; i++) {
        SL_TRY(task.status[i]);
    }
    *out = rig;
    rig = NULL;
cleanup:
    sl_free(task.status);
    sl_light_rig_free(rig);
    return status;
}

void sl_light_rig_free(sl_light_rig *rig)
{
    if (rig != NULL) {
        sl_free(rig->light);
        sl_free(rig->depth);
        sl_free(rig);
    }
}

/* Position in texels, relative to texel centres. */
static void map_position(const sl_light_rig *rig, const sl_mapped_light *m, const double point[3], double *x, double *y)
{
    double d[3];
    sl_vec3_sub(point, rig->centre, d);
    *x = 0.5 * rig->side + sl_vec3_dot(d, m->right) / rig->texel - 0.5;
    *y = 0.5 * rig->side - sl_vec3_dot(d, m->up) / rig->texel - 0.5;
}

/* Part of a light that reaches the point: the four nearest texels compared, weighted bilinearly.
 * Source: Reeves, Salesin, Cook 1987, "Rendering antialiased shadows with depth maps". */
static float reaching(const sl_light_rig *rig, const sl_mapped_light *m, const double point[3])
{
    double x, y;
    map_position(rig, m, point, &x, &y);
    if (!(x >= 0.0 && y >= 0.0 && x < rig->side - 1.0 && y < rig->side - 1.0)) {
        return 1.0f;
    }
    const double bias = bias_texels * rig->texel / (2.0 * rig->radius) * 65534.0;
    const double limit = fmin(map_depth(rig, m, point) - bias, UINT16_MAX); /* nothing there hides nothing */
    const int32_t i = (int32_t)x, j = (int32_t)y;
    const float fx = (float)(x - i), fy = (float)(y - j);
    const uint16_t *row = m->depth + (int64_t)j * rig->side + i, *below = row + rig->side;
    const float top = (row[0] >= limit ? 1.0f - fx : 0.0f) + (row[1] >= limit ? fx : 0.0f);
    const float bottom = (below[0] >= limit ? 1.0f - fx : 0.0f) + (below[1] >= limit ? fx : 0.0f);
    return top + fy * (bottom - top);
}

void sl_light_rig_shine(const sl_light_rig *rig, const double point[3], const double normal[3], const double facing[3],
                        float rgb[3])
{
    double lifted[3];
    for (int k = 0; k < 3; k++) {
        lifted[k] = point[k] + lift_texels * rig->texel * facing[k];
        rgb[k] = 0.0f;
    }
    float sky = 0.0f, open = 0.0f;
    for (int32_t i = 0; i < rig->lights; i++) {
        const sl_mapped_light *m = &rig->light[i];
        const float cosine = (float)sl_vec3_dot(normal, m->light.direction);
        if (cosine <= 0.0f) {
            continue;
        }
        const float part = cosine * (m->depth != NULL ? reaching(rig, m, lifted) : 1.0f);
        for (int k = 0; k < 3; k++) {
            rgb[k] += part * m->light.rgb[k];
        }
        sky += m->light.sky ? cosine : 0.0f;
        open += m->light.sky ? part : 0.0f;
    }
    const float openness = 1.0f - dimmed + dimmed * (sky > 0.0f ? open / sky : 1.0f);
    const float height = 0.5f + 0.5f * (float)sl_vec3_dot(normal, rig->scene_up);
    for (int k = 0; k < 3; k++) {
        rgb[k] += openness * (rig->bottom_rgb[k] + height * (rig->top_rgb[k] - rig->bottom_rgb[k]));
    }
}

bool sl_map_texel(const sl_light_rig *rig, const sl_mapped_light *m, const double point[3], uint16_t *texel,
                  double *depth)
{
    double x, y;
    map_position(rig, m, point, &x, &y);
    if (!(x >= -0.5 && y >= -0.5 && x < rig->side - 0.5 && y < rig->side - 0.5)) {
        return false;
    }
    *texel = m->depth[(int64_t)(y + 0.5) * rig->side + (int64_t)(x + 0.5)];
    *depth = map_depth(rig, m, point);
    return true;
}
