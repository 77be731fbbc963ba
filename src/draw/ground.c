#include "draw/ground.h"
#include "base/memory.h"
#include "draw/light_internal.h"
#include "geom/vec3.h"

#include <string.h>

enum {
    SIDE = 384,  /* cells */
    LEVELS = 6,  /* blurs: none, then boxes of twice the radius each */
    PASSES = 3,  /* a box blurred thrice is nearly a Gaussian */
    SPREAD = 16, /* radius in cells over which distances of blockers are spread */
    CELL_ROWS = 16
};

static const double extent = 2.6;    /* half side of the map, in radii of the scene */
static const double fade_from = 1.0; /* radii from the centre where the shadow begins to fade; gone at `extent` */
static const double softness = 0.09; /* blur radius per distance of the blocker: half the angle between sky lights */
static const double bias = 2.0;      /* of a blocker, in texels of a light's map */

struct sl_ground {
    double up[3], right[3], back[3], centre[3];
    double cell; /* scene units */
    float *dark; /* SIDE x SIDE, light lost */
};

typedef struct ground_task {
    const sl_light_rig *rig;
    sl_ground *ground;
    float *distance; /* blocked light times distance of its blocker, in cells */
    double strength;
} ground_task;

static void set_plane(sl_ground *g, const sl_light_rig *rig, const double point[3])
{
    double to_plane[3], axis[3] = {0.0, 0.0, 0.0};
    memcpy(g->up, rig->scene_up, sizeof g->up);
    sl_vec3_sub(point, rig->centre, to_plane);
    const double drop = sl_vec3_dot(to_plane, g->up);
    const int least = fabs(g->up[0]) < fabs(g->up[1]) ? (fabs(g->up[0]) < fabs(g->up[2]) ? 0 : 2)
                                                      : (fabs(g->up[1]) < fabs(g->up[2]) ? 1 : 2);
    axis[least] = 1.0;
    sl_vec3_cross(g->up, axis, g->right);
    const double length = sl_vec3_norm(g->right);
    for (int k = 0; k < 3; k++) {
        g->right[k] /= length;
        g->centre[k] = rig->centre[k] + drop * g->up[k];
    }
    sl_vec3_cross(g->right, g->up, g->back);
    g->cell = 2.0 * extent * rig->radius / SIDE;
}

/* Light lost at one cell, and how far away what takes it is. */
static void look_up(const ground_task *task, const double point[3], float *dark, float *distance)
{
    const sl_light_rig *rig = task->rig;
    const double unit = 2.0 * rig->radius / 65534.0;
    double lost = 0.0, total = 0.0, far = 0.0;
    for (int32_t i = 0; i < rig->lights; i++) {
        const sl_mapped_light *m = &rig->light[i];
        const double cosine = sl_vec3_dot(rig->scene_up, m->light.direction);
        if (cosine <= 0.0 || !m->light.sky || m->depth == NULL) {
            continue;
        }
        const double amount = cosine * (double)sl_brightness(m->light.rgb);
        uint16_t texel;
        double depth;
        total += amount;
        if (sl_map_texel(rig, m, point, &texel, &depth) && texel != UINT16_MAX &&
            (depth - texel) * unit > bias * rig->texel) {
            lost += amount;
            far += amount * (depth - texel) * unit;
        }
    }
    *dark = total > 0.0 ? (float)(lost / total) : 0.0f;
    *distance = total > 0.0 ? (float)(far / total / task->ground->cell) : 0.0f;
}

static void fill_rows(void *user, int64_t begin, int64_t end, int32_t chunk)
{
    (void)chunk;
    const ground_task *task = user;
    const sl_ground *g = task->ground;
    for (int64_t j = begin; j < end; j++) {
        for (int64_t i = 0; i < SIDE; i++) {
            const double x = ((double)i + 0.5 - SIDE / 2) * g->cell, y = ((double)j + 0.5 - SIDE / 2) * g->cell;
            double point[3];
            for (int k = 0; k < 3; k++) {
                point[k] = g->centre[k] + x * g->right[k] + y * g->back[k];
            }
            look_up(task, point, &g->dark[j * SIDE + i], &task->distance[j * SIDE + i]);
        }
    }
}

/* Box blur of one line of `count` values `stride` apart; nothing is dark outside. */
static void blur_line(float *line, int64_t stride, int32_t radius, float *copy)
{
    for (int32_t i = 0; i < SIDE; i++) {
        copy[i] = line[i * stride];
    }
    double sum = 0.0;
    for (int32_t i = 0; i < radius && i < SIDE; i++) {
        sum += (double)copy[i];
    }
    for (int32_t i = 0; i < SIDE; i++) {
        sum += i + radius < SIDE ? (double)copy[i + radius] : 0.0;
        line[i * stride] = (float)(sum / (2.0 * radius + 1.0));
        sum -= i - radius >= 0 ? (double)copy[i - radius] : 0.0;
    }
}

static void blur(float *map, int32_t radius)
{
    float copy[SIDE];
    for (int pass = 0; pass < PASSES; pass++) {
        for (int64_t k = 0; k < SIDE; k++) {
            blur_line(map + k * SIDE, 1, radius, copy);
            blur_line(map + k, SIDE, radius, copy);
        }
    }
}

/* Weight of a blur level for a wanted radius: linear between the radii 0, 1, 2, 4, 8, ... of the levels. */
static double level_weight(int level, double radius)
{
    const double at = radius < 1.0 ? radius : 1.0 + log2(radius);
    const double off = fabs(fmin(at, LEVELS - 1) - level);
    return off < 1.0 ? 1.0 - off : 0.0;
}

static double fade(const sl_ground *g, const sl_light_rig *rig, int64_t i, int64_t j)
{
    const double x = ((double)i + 0.5 - SIDE / 2) * g->cell, y = ((double)j + 0.5 - SIDE / 2) * g->cell;
    const double t = (sqrt(x * x + y * y) / rig->radius - fade_from) / (extent - fade_from);
    const double s = fmin(fmax(t, 0.0), 1.0);
    return 1.0 - s * s * (3.0 - 2.0 * s);
}

/* dark: blurred by as much as the blockers are far. level: scratch, holds the blurs one after the other. */
static void soften(const ground_task *task, float *spread, float *level, float *result)
{
    sl_ground *g = task->ground;
    memcpy(spread, g->dark, sizeof(float) * SIDE * SIDE);
    memcpy(level, g->dark, sizeof(float) * SIDE * SIDE);
    blur(spread, SPREAD);
    blur(task->distance, SPREAD);
    for (int k = 0; k < LEVELS; k++) {
        if (k > 0) {
            blur(level, k == 1 ? 1 : 1 << (k - 2)); /* on top of the blurs before */
        }
        for (int64_t c = 0; c < (int64_t)SIDE * SIDE; c++) {
            const double far = spread[c] > 1e-6f ? (double)(task->distance[c] / spread[c]) : 0.0;
            result[c] += (float)level_weight(k, softness * far) * level[c];
        }
    }
    for (int64_t c = 0; c < (int64_t)SIDE * SIDE; c++) {
        g->dark[c] = (float)(task->strength * fade(g, task->rig, c % SIDE, c / SIDE)) * result[c];
    }
}

sl_status sl_ground_create(const sl_light_rig *rig, const double point[3], double strength, const sl_context *context,
                           sl_ground **out)
{
    const int64_t cells = (int64_t)SIDE * SIDE;
    sl_status status = SL_OUT_OF_MEMORY;
    *out = NULL;
    sl_ground *ground = sl_calloc(1, sizeof *ground);
    float *distance = sl_alloc(cells, sizeof *distance), *spread = sl_alloc(cells, sizeof *spread);
    float *level = sl_alloc(cells, sizeof *level), *result = sl_calloc(cells, sizeof *result);
    if (ground != NULL && distance != NULL && spread != NULL && level != NULL && result != NULL) {
        ground->dark = sl_alloc(cells, sizeof *ground->dark);
        status = ground->dark != NULL ? SL_OK : SL_OUT_OF_MEMORY;
    }
    if (status == SL_OK) {
        ground_task task = {rig, ground, distance, strength};
        set_plane(ground, rig, point);
        sl_parallel_for(context, SIDE, CELL_ROWS, fill_rows, &task);
        soften(&task, spread, level, result);
        *out = ground;
        ground = NULL;
    }
    sl_ground_free(ground);
    sl_free(distance);
    sl_free(spread);
    sl_free(level);
    sl_free(result);
    return status;
}

void sl_ground_free(sl_ground *ground)
{
    if (ground != NULL) {
        sl_free(ground->dark);
        sl_free(ground);
    }
}

float sl_ground_seen(const sl_ground *g, const double origin[3], const double direction[3])
{
    double from[3];
    sl_vec3_sub(g->centre, origin, from);
    const double slope = sl_vec3_dot(direction, g->up), height = sl_vec3_dot(from, g->up);
    if (!(slope < 0.0 && height < 0.0)) {
        return 1.0f;
    }
    const double t = height / slope;
    const double x = (t * sl_vec3_dot(direction, g->right) - sl_vec3_dot(from, g->right)) / g->cell + SIDE / 2 - 0.5;
    const double y = (t * sl_vec3_dot(direction, g->back) - sl_vec3_dot(from, g->back)) / g->cell + SIDE / 2 - 0.5;
    if (!(x >= 0.0 && y >= 0.0 && x < SIDE - 1.0 && y < SIDE - 1.0)) {
        return 1.0f;
    }
    const int32_t i = (int32_t)x, j = (int32_t)y;
    const float fx = (float)(x - i), fy = (float)(y - j), *row = g->dark + (int64_t)j * SIDE + i, *next = row + SIDE;
    const float top = row[0] + fx * (row[1] - row[0]), bottom = next[0] + fx * (next[1] - next[0]);
    return 1.0f - (top + fy * (bottom - top));
}
