/* Colours of the surface at a sample: interpolation that is linear in the scene, not on the picture. */
#include "draw/shade_internal.h"
#include "geom/vec3.h"

#include <string.h>

static const double least_width = 1e-9;  /* of a filter, in squares */
static const double contour_half = 0.75; /* half width of a contour line, samples */
static const float contour_shade = 0.25f;
static const double farthest_bary = 4.0; /* neighbours across a silhouette are held near the triangle */

/* Edge functions in homogeneous form: with d the ray, b_k is proportional to d . (P_i x P_j); for parallel rays the
 * corners are seen from the ray's origin along z. Source: Olano and Greer 1997. */
typedef struct triangle_rays {
    double n[3][3];
    bool perspective;
    double p[3][3];
} triangle_rays;

static void set_rays(const sl_screen *s, int32_t t, triangle_rays *r)
{
    r->perspective = s->camera.perspective;
    for (int k = 0; k < 3; k++) {
        memcpy(r->p[k], s->eye + 3 * (int64_t)s->tri[3 * (int64_t)t + k], sizeof r->p[0]);
    }
    for (int k = 0; k < 3 && r->perspective; k++) {
        sl_vec3_cross(r->p[(k + 1) % 3], r->p[(k + 2) % 3], r->n[k]);
    }
}

static double cross2(const double a[3], const double b[3], double x, double y)
{
    return (a[0] - x) * (b[1] - y) - (b[0] - x) * (a[1] - y);
}

static bool barycentrics(const triangle_rays *r, const double origin[3], const double direction[3], double bary[3])
{
    for (int k = 0; k < 3; k++) {
        bary[k] = r->perspective ? sl_vec3_dot(direction, r->n[k])
                                 : cross2(r->p[(k + 1) % 3], r->p[(k + 2) % 3], origin[0], origin[1]);
    }
    const double sum = bary[0] + bary[1] + bary[2];
    if (sum == 0.0 || !isfinite(1.0 / sum)) {
        return false;
    }
    for (int k = 0; k < 3; k++) {
        bary[k] /= sum;
    }
    return isfinite(bary[0] + bary[1] + bary[2]);
}

/* Inside the triangle: the sample may lie a snapping error outside. */
static void clamp_bary(double bary[3])
{
    double sum = 0.0;
    for (int k = 0; k < 3; k++) {
        bary[k] = bary[k] > 0.0 ? bary[k] : 0.0;
        sum += bary[k];
    }
    for (int k = 0; k < 3; k++) {
        bary[k] /= sum; /* the three add up to 1 before, so the sum is at least 1 */
    }
}

static void neighbour(const sl_screen *s, const triangle_rays *r, double sx, double sy, const double bary[3],
                      double out[3])
{
    double origin[3], direction[3];
    sl_camera_ray(&s->camera, s->width, s->height, sx, sy, origin, direction);
    bool usable = barycentrics(r, origin, direction, out);
    for (int k = 0; k < 3; k++) {
        usable = usable && fabs(out[k] - bary[k]) < farthest_bary;
    }
    for (int k = 0; k < 3 && !usable; k++) { /* past the horizon of the plane: spread over the whole triangle */
        out[k] = bary[k] + (k == 0 ? 1.0 : k == 1 ? -1.0 : 0.0);
    }
}

bool sl_hit_at(const sl_screen *s, int32_t t, double sx, double sy, sl_hit *hit)
{
    triangle_rays rays;
    double origin[3], direction[3], e1[3], e2[3];
    set_rays(s, t, &rays);
    sl_camera_ray(&s->camera, s->width, s->height, sx, sy, origin, direction);
    hit->triangle = t;
    if (!barycentrics(&rays, origin, direction, hit->bary)) {
        return false;
    }
    clamp_bary(hit->bary);
    neighbour(s, &rays, sx + 1.0, sy, hit->bary, hit->right);
    neighbour(s, &rays, sx, sy + 1.0, hit->bary, hit->below);
    for (int k = 0; k < 3; k++) {
        hit->point[k] = hit->bary[0] * rays.p[0][k] + hit->bary[1] * rays.p[1][k] + hit->bary[2] * rays.p[2][k];
    }
    sl_vec3_sub(rays.p[1], rays.p[0], e1);
    sl_vec3_sub(rays.p[2], rays.p[0], e2);
    sl_vec3_cross(e2, e1, hit->facing); /* eye space is left-handed */
    hit->back = sl_vec3_dot(hit->facing, s->camera.perspective ? rays.p[0] : direction) > 0.0;
    for (int k = 0; k < 3; k++) {
        hit->facing[k] = hit->back ? -hit->facing[k] : hit->facing[k];
    }
    return true;
}

void sl_hit_normal(const sl_material *m, const sl_hit *hit, double normal[3])
{
    const int32_t *corner = m->corner + 3 * (int64_t)hit->triangle;
    for (int k = 0; k < 3; k++) {
        normal[k] = 0.0;
        for (int c = 0; c < 3; c++) {
            normal[k] += hit->bary[c] * (double)m->normal[3 * (int64_t)corner[c] + k];
        }
    }
}

static double interpolate(const double *array, int stride, int offset, const int32_t corner[3], const double bary[3])
{
    double sum = 0.0;
    for (int c = 0; c < 3; c++) {
        sum += bary[c] * array[stride * (int64_t)corner[c] + offset];
    }
    return sum;
}

static void map_value(const sl_material *m, const sl_hit *hit, const int32_t corner[3], float rgb[3])
{
    const double v = interpolate(m->value, 1, 0, corner, hit->bary);
    const double t = (v - m->value_lo) / (m->value_hi - m->value_lo);
    if (isnan(t)) {
        memcpy(rgb, m->missing_rgb, sizeof m->missing_rgb);
        return;
    }
    const double place = fmin(fmax(t, 0.0), 1.0) * (m->map_count - 1);
    const int32_t i = place < m->map_count - 1 ? (int32_t)place : m->map_count - 2;
    const float f = (float)(place - i), *a = m->map_rgb + 3 * (int64_t)i;
    for (int k = 0; k < 3; k++) {
        rgb[k] = a[k] + f * (a[3 + k] - a[k]);
    }
    const double dx = interpolate(m->value, 1, 0, corner, hit->right) - v;
    const double dy = interpolate(m->value, 1, 0, corner, hit->below) - v;
    const double distance = fabs(v - m->contour) / sqrt(dx * dx + dy * dy);
    if (distance < contour_half + 0.5) { /* false for NaN: no contour, or a constant value */
        const float amount = (float)fmin(contour_half + 0.5 - distance, 1.0);
        for (int k = 0; k < 3; k++) {
            rgb[k] *= 1.0f - amount * (1.0f - contour_shade);
        }
    }
}

/* Integral of the square wave that is +1 on [0, 1) and -1 on [1, 2). */
static double wave_integral(double x)
{
    const double r = x - 2.0 * floor(0.5 * x);
    return r < 1.0 ? r : 2.0 - r;
}

double sl_checkerboard(const double uv[2], const double width[2])
{
    double mean[2];
    for (int k = 0; k < 2; k++) {
        const double w = fmax(width[k], least_width);
        mean[k] = (wave_integral(uv[k] + 0.5 * w) - wave_integral(uv[k] - 0.5 * w)) / w;
        mean[k] = fmin(fmax(mean[k], -1.0), 1.0);
    }
    return 0.5 + 0.5 * mean[0] * mean[1];
}

/* A vector of UV: its value at the hit, its change to the right and below. */
static void uv_footprint(const sl_material *m, const sl_hit *hit, const int32_t corner[3], double scale, double at[2],
                         double right[2], double below[2])
{
    for (int k = 0; k < 2; k++) {
        at[k] = scale * interpolate(m->uv, 2, k, corner, hit->bary);
        right[k] = scale * interpolate(m->uv, 2, k, corner, hit->right) - at[k];
        below[k] = scale * interpolate(m->uv, 2, k, corner, hit->below) - at[k];
    }
}

static void map_texture(const sl_material *m, const sl_hit *hit, const int32_t corner[3], float rgb[3])
{
    double at[2], right[2], below[2];
    uv_footprint(m, hit, corner, m->tiles, at, right, below);
    sl_texture_sample(m->texture, at, right, below, rgb);
}

static float check_factor(const sl_material *m, const sl_hit *hit, const int32_t corner[3])
{
    double at[2], right[2], below[2], width[2];
    uv_footprint(m, hit, corner, m->checks, at, right, below);
    for (int k = 0; k < 2; k++) {
        width[k] = fmax(fabs(right[k]), fabs(below[k]));
    }
    if (!isfinite(at[0] + at[1] + width[0] + width[1]) || fabs(at[0]) > 1e9 || fabs(at[1]) > 1e9) {
        return 1.0f;
    }
    return m->check_shade + (1.0f - m->check_shade) * (float)sl_checkerboard(at, width);
}

void sl_hit_color(const sl_material *m, const sl_hit *hit, float rgb[3])
{
    const int32_t *corner = m->corner + 3 * (int64_t)hit->triangle;
    const int64_t facet = m->facet != NULL ? m->facet[hit->triangle] : hit->triangle;
    memcpy(rgb, m->facet_rgb != NULL ? m->facet_rgb + 3 * facet : m->base_rgb, 3 * sizeof *rgb);
    if (m->uv != NULL && m->texture != NULL && m->value == NULL) {
        map_texture(m, hit, corner, rgb);
    }
    if (m->value != NULL) {
        map_value(m, hit, corner, rgb);
    }
    if (m->flag != NULL && m->flag[facet] != 0) {
        memcpy(rgb, m->flag_rgb, sizeof m->flag_rgb);
    }
    if (m->uv != NULL && m->checks > 0.0) {
        const float factor = check_factor(m, hit, corner);
        for (int k = 0; k < 3; k++) {
            rgb[k] *= factor;
        }
    }
    for (int k = 0; k < 3 && hit->back && m->lit; k++) {
        rgb[k] = 0.5f * (rgb[k] + m->back_rgb[k]);
    }
}
