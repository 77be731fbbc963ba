/* Colours of a band of rows. */
#include "geom/vec3.h"
#include "render/frame_internal.h"

#include <math.h>
#include <string.h>

static const float check_shade = 0.68f;    /* light of a dark square */
static const float rounding = 12582912.0f; /* 1.5 * 2^23: sums with it are whole */
static const float widest_filter = 4.0f;   /* squares; beyond, the mean */
static const float least_filter = 1e-4f;
static const float farthest_check = 1e6f; /* squares; beyond, floats cannot tell them apart */

enum { KEPT = 256, TILE = 32 }; /* triangles kept ready; columns of a tile, few enough that its triangles are */

/* c + dx (x - x0) + dy (y - y0) over the picture. */
typedef struct plane {
    float c, dx, dy;
} plane;

/* A triangle ready to be coloured. Numbers over depth are linear on the picture. Source: Heckbert and Moreton 1991,
 * "Interpolation for polygon texture mapping and shading". */
typedef struct paint {
    int32_t triangle;
    bool slow, checked; /* slow: a corner is not on the picture, sight is followed into space */
    float x, y;
    plane weight, light, u, v;
    float half[2], scale[2]; /* of the checkerboard's filter: half its width in squares, 1 / width; 0 = the mean */
    float rgb[3];            /* times 4095 */
} paint;

/* Numbers at the three corners. */
typedef struct corners {
    float light[3], u[3], v[3];
} corners;

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

/* Is the viewer behind the triangle? In space, whatever is on the picture. */
static bool seen_from_behind(const sl_frame *f, const int32_t *tri, double normal[3])
{
    double a[3], b[3], to[3];
    const double *p = f->xyz + 3 * (int64_t)tri[0];
    sl_vec3_sub(f->xyz + 3 * (int64_t)tri[1], p, a);
    sl_vec3_sub(f->xyz + 3 * (int64_t)tri[2], p, b);
    sl_vec3_cross(a, b, normal);
    sl_vec3_sub(p, f->camera.eye, to);
    return sl_vec3_dot(normal, f->camera.perspective ? to : f->camera.forward) > 0.0;
}

static void flat_light(const sl_frame *f, const int32_t *tri, bool behind, float light[3])
{
    double normal[3];
    float front, back;
    (void)seen_from_behind(f, tri, normal);
    const double length = sl_vec3_norm(normal);
    sl_frame_light(length > 0.0 ? (float)(sl_vec3_dot(normal, f->light) / length) : 0.0f, &front, &back);
    light[0] = light[1] = light[2] = behind ? back : front;
}

static void corner_light(const sl_frame *f, const int32_t *tri, bool behind, float light[3])
{
    if (!f->style.lit) {
        light[0] = light[1] = light[2] = 1.0f;
    } else if (f->style.flat) {
        flat_light(f, tri, behind, light);
    } else {
        for (int k = 0; k < 3; k++) {
            light[k] = behind ? f->vertex[tri[k]].behind : f->vertex[tri[k]].front;
        }
    }
}

/* UVs in squares; false where there is no checkerboard. */
static bool corner_checks(const sl_frame *f, int32_t t, corners *at)
{
    if (f->uv == NULL || !(f->style.checks > 0.0)) {
        return false;
    }
    const float *uv = f->uv + 6 * (int64_t)t, scale = (float)f->style.checks;
    bool usable = true;
    for (int k = 0; k < 3; k++) {
        at->u[k] = scale * uv[2 * k];
        at->v[k] = scale * uv[2 * k + 1];
        usable = usable && fabsf(at->u[k]) < farthest_check && fabsf(at->v[k]) < farthest_check;
    }
    return usable;
}

static plane make_plane(const float value[3], const float weight[3], const float b[2], const float c[2])
{
    const float a = value[0] * weight[0], p = value[1] * weight[1] - a, q = value[2] * weight[2] - a;
    return (plane){a, p * b[0] + q * c[0], p * b[1] + q * c[1]};
}

/* The filter of one direction: how far its UV runs over a pixel, by the gradient at the middle of the triangle. */
static void set_filter(const float value[3], const float b[2], const float c[2], float *half, float *scale)
{
    const float p = value[1] - value[0], q = value[2] - value[0];
    const float across = fabsf(p * b[0] + q * c[0]), down = fabsf(p * b[1] + q * c[1]);
    const float larger = across > down ? across : down, width = larger > least_filter ? larger : least_filter;
    *half = 0.5f * width;
    *scale = width < widest_filter ? 1.0f / width : 0.0f; /* 0 for NaN, too */
}

static void set_planes(const sl_frame *f, const sl_frame_vertex *const v[3], paint *p)
{
    static const float one[3] = {1.0f, 1.0f, 1.0f};
    const int32_t *tri = f->tri + 3 * (int64_t)p->triangle;
    const float bx = (float)(v[1]->x - v[0]->x), by = (float)(v[1]->y - v[0]->y), cx = (float)(v[2]->x - v[0]->x),
                cy = (float)(v[2]->y - v[0]->y);
    const int64_t area = ((int64_t)v[1]->x - v[0]->x) * ((int64_t)v[2]->y - v[0]->y) -
                         ((int64_t)v[2]->x - v[0]->x) * ((int64_t)v[1]->y - v[0]->y);
    const float scale = (float)SL_SUBPIXELS / (float)area, weight[3] = {v[0]->weight, v[1]->weight, v[2]->weight};
    const float b[2] = {cy * scale, -cx * scale}, c[2] = {-by * scale, bx * scale};
    corners at;
    p->x = (float)v[0]->x / (float)SL_SUBPIXELS;
    p->y = (float)v[0]->y / (float)SL_SUBPIXELS;
    corner_light(f, tri, area > 0, at.light);
    p->weight = make_plane(one, weight, b, c);
    p->light = make_plane(at.light, weight, b, c);
    p->checked = corner_checks(f, p->triangle, &at);
    if (p->checked) {
        p->u = make_plane(at.u, weight, b, c);
        p->v = make_plane(at.v, weight, b, c);
        set_filter(at.u, b, c, &p->half[0], &p->scale[0]);
        set_filter(at.v, b, c, &p->half[1], &p->scale[1]);
    }
}

static void set_paint(const sl_frame *f, int32_t t, paint *p)
{
    const int32_t *tri = f->tri + 3 * (int64_t)t;
    const sl_frame_vertex *const v[3] = {&f->vertex[tri[0]], &f->vertex[tri[1]], &f->vertex[tri[2]]};
    p->triangle = t;
    p->slow = v[0]->x == SL_FRAME_FAR || v[1]->x == SL_FRAME_FAR || v[2]->x == SL_FRAME_FAR;
    for (int k = 0; k < 3; k++) {
        p->rgb[k] = 4095.0f * f->linear[f->rgb[3 * (int64_t)t + k]];
    }
    if (!p->slow) {
        set_planes(f, v, p);
    }
}

/* Integral of the square wave that is +1 on [0, 1), -1 on [1, 2): the distance to the nearest even number, found by
 * letting the addition round (|x| below 2^22). Without branches: where squares end, they could not be predicted. */
static float wave(float x)
{
    const float nearest = (0.5f * x + rounding) - rounding;
    return fabsf(x - 2.0f * nearest);
}

/* Mean of the wave over a box, [-1, 1]. */
static float check_mean(float at, float half, float scale)
{
    float mean = (wave(at + half) - wave(at - half)) * scale;
    mean = mean < 1.0f ? mean : 1.0f;
    return mean > -1.0f ? mean : -1.0f;
}

static float plane_at(const plane *p, float dx, float dy)
{
    return p->c + (p->dx * dx + p->dy * dy);
}

/* Light and place on the checkerboard of a pixel. */
static void look(const paint *p, int32_t x, int32_t y, float *light, float uv[2])
{
    const float dx = (float)x - p->x, dy = (float)y - p->y;
    const float depth = 1.0f / plane_at(&p->weight, dx, dy);
    *light = depth * plane_at(&p->light, dx, dy);
    if (p->checked) {
        uv[0] = depth * plane_at(&p->u, dx, dy);
        uv[1] = depth * plane_at(&p->v, dx, dy);
    }
}

/* The same by the ray; the filter by that of the next pixels. */
static void look_into_space(const sl_frame *f, int32_t x, int32_t y, paint *p, float *light, float uv[2])
{
    double bary[3][3], normal[3];
    corners at;
    float u[3] = {0.0f, 0.0f, 0.0f}, v[3] = {0.0f, 0.0f, 0.0f};
    const int32_t *tri = f->tri + 3 * (int64_t)p->triangle;
    corner_light(f, tri, seen_from_behind(f, tri, normal), at.light);
    p->checked = corner_checks(f, p->triangle, &at);
    *light = 0.0f;
    for (int i = 0; i < 3; i++) {
        sl_frame_barycentrics(f, p->triangle, x + (i == 1), y + (i == 2), bary[i]);
        for (int k = 0; k < 3; k++) {
            *light += i == 0 ? (float)bary[0][k] * at.light[k] : 0.0f;
            u[i] += p->checked ? (float)bary[i][k] * at.u[k] : 0.0f;
            v[i] += p->checked ? (float)bary[i][k] * at.v[k] : 0.0f;
        }
    }
    static const float right[2] = {1.0f, 0.0f}, below[2] = {0.0f, 1.0f};
    set_filter(u, right, below, &p->half[0], &p->scale[0]);
    set_filter(v, right, below, &p->half[1], &p->scale[1]);
    uv[0] = u[0];
    uv[1] = v[0];
}

static void shade_pixel(const sl_frame *f, paint *p, int32_t x, int32_t y, uint8_t *out)
{
    float light, uv[2];
    if (p->slow) {
        look_into_space(f, x, y, p, &light, uv);
    } else {
        look(p, x, y, &light, uv);
    }
    if (p->checked) {
        const float mean = check_mean(uv[0], p->half[0], p->scale[0]) * check_mean(uv[1], p->half[1], p->scale[1]);
        light *= 0.5f * (1.0f + check_shade) + 0.5f * (1.0f - check_shade) * mean;
    }
    for (int k = 0; k < 3; k++) {
        float value = p->rgb[k] * light + 0.5f;
        value = value < 4095.0f ? value : 4095.0f; /* NaN, too */
        out[k] = f->encoded[(int32_t)(value > 0.0f ? value : 0.0f)];
    }
    out[3] = 255;
}

static void shade_row(const sl_frame *f, int32_t y, int32_t x0, int32_t x1, paint *kept, uint8_t *rgba)
{
    const uint8_t sheet[4] = {f->style.background[0], f->style.background[1], f->style.background[2], 255};
    const uint64_t *zid = f->zid + (int64_t)y * f->width;
    for (int32_t x = x0; x < x1; x++) {
        uint8_t *out = rgba + 4 * ((int64_t)y * f->width + x);
        const int32_t t = sl_visible_triangle(zid[x]);
        if (t < 0) {
            memcpy(out, sheet, 4);
            continue;
        }
        paint *p = &kept[t % KEPT];
        if (t != p->triangle) {
            set_paint(f, t, p);
        }
        shade_pixel(f, p, x, y, out);
    }
}

void sl_frame_shade(const sl_frame *f, int32_t row, int32_t row_end, uint8_t *rgba)
{
    paint kept[KEPT];
    for (int k = 0; k < KEPT; k++) {
        kept[k].triangle = -1;
    }
    for (int32_t x = 0; x < f->width; x += TILE) {
        for (int32_t y = row; y < row_end; y++) {
            shade_row(f, y, x, x + TILE < f->width ? x + TILE : f->width, kept, rgba);
        }
    }
}
