/* Vertices onto the picture. Included by the kernels, in lanes.
 * Layer: render, private. */
#ifndef SL_RENDER_FRAME_KERNEL_PROJECT_H
#define SL_RENDER_FRAME_KERNEL_PROJECT_H

#include "render/frame_internal.h"
#include "render/frame_lanes.h"

#include <float.h>
#include <string.h>

LANES_CALL d8 along(const d8 d[3], const double axis[3])
{
    const d8 sum = d8_add(d8_mul(d[0], d8_all(axis[0])), d8_mul(d[1], d8_all(axis[1])));
    return d8_add(sum, d8_mul(d[2], d8_all(axis[2])));
}

/* Of eight points. */
LANES_CALL void from_eye(const sl_frame *f, const double *xyz, d8 d[3])
{
    d8_points(xyz, d);
    for (int k = 0; k < 3; k++) {
        d[k] = d8_sub(d[k], d8_all(f->camera.eye[k]));
    }
}

/* Eight normals. */
LANES_CALL void load_cosines(const sl_frame *f, const float *n, float cosine[8])
{
    const float light[3] = {(float)f->light[0], (float)f->light[1], (float)f->light[2]};
    for (int k = 0; k < 8; k++) {
        cosine[k] = n[3 * k] * light[0] + n[3 * k + 1] * light[1] + n[3 * k + 2] * light[2];
    }
}

/* sl_frame_snap of eight points, and their cosines. */
LANES_CALL void project_eight(const sl_frame *f, const double *xyz, const float *normal, sl_frame_vertex *vertex)
{
    const sl_camera *camera = &f->camera;
    const d8 one = d8_all(1.0), most = d8_all(SL_FRAME_FARTHEST), least = d8_all(-SL_FRAME_FARTHEST);
    const d8 half = d8_all(0.5), fine = d8_all(SL_SUBPIXELS);
    d8 d[3];
    float cosine[8];
    from_eye(f, xyz, d);
    const d8 ex = along(d, camera->right), ey = along(d, camera->up), ez = along(d, camera->forward);
    const d8 near = d8_all(camera->perspective ? camera->near_depth : -DBL_MAX);
    const d8 inverse = camera->perspective ? d8_div(one, ez) : one;
    const d8 scale = d8_mul(d8_all(f->height * camera->focal), inverse);
    const d8 sx = d8_add(d8_all(camera->centre[0] * f->width), d8_mul(scale, ex));
    const d8 sy = d8_sub(d8_all(camera->centre[1] * f->height), d8_mul(scale, ey));
    const d8 x = d8_mul(fine, d8_sub(sx, half)), y = d8_mul(fine, d8_sub(sy, half));
    const d8 depth = camera->perspective ? inverse : ez;
    const d8 key = d8_add(d8_all(f->key_offset), d8_mul(d8_all(f->key_scale), depth));
    const d8 bounded = d8_min(d8_max(key, d8_all(0.0)), one);
    const i8 finite = d8_less(d8_add(d8_add(d8_abs(ex), d8_abs(ey)), d8_abs(ez)), d8_all(DBL_MAX));
    const i8 behind = i8_and(finite, d8_less(ez, near));
    const i8 close = i8_and(d8_less(d8_abs(x), most), d8_less(d8_abs(y), most));
    const i8 on = i8_without(i8_and(finite, close), behind);
    const i8 why = i8_select(behind, i8_all(SL_FRAME_BEHIND), i8_all(SL_FRAME_UNUSABLE));
    const f8 words[4] = {f8_select(on, d8_float(bounded), f8_all(1.0f)),
                         i8_bits(i8_select(on, d8_round(d8_max(d8_min(x, most), least)), i8_all(SL_FRAME_FAR))),
                         i8_bits(i8_select(on, d8_round(d8_max(d8_min(y, most), least)), why)),
                         f8_select(on, d8_float(inverse), f8_all(1.0f))};
    put_four_words((char *)vertex, sizeof *vertex, words);
    load_cosines(f, normal, cosine);
    for (int k = 0; k < 8; k++) {
        vertex[k].cosine = cosine[k];
    }
}

LANES_TARGET static void project(const sl_frame *f, int64_t begin, int64_t end)
{
    int64_t v = begin;
    for (; v + 8 <= end; v += 8) {
        project_eight(f, f->xyz + 3 * v, f->normal + 3 * v, f->vertex + v);
    }
    if (v < end) {
        double xyz[24] = {0.0};
        float normal[24] = {0.0f};
        sl_frame_vertex eight[8];
        memcpy(xyz, f->xyz + 3 * v, (size_t)(end - v) * 3 * sizeof *xyz);
        memcpy(normal, f->normal + 3 * v, (size_t)(end - v) * 3 * sizeof *normal);
        project_eight(f, xyz, normal, eight);
        memcpy(f->vertex + v, eight, (size_t)(end - v) * sizeof *eight);
    }
}

LANES_CALL void widen(const sl_frame *f, const double *xyz, d8 *lo, d8 *hi)
{
    d8 d[3];
    from_eye(f, xyz, d);
    const d8 z = along(d, f->camera.forward);
    *lo = d8_min(d8_finite_or(z, d8_all(DBL_MAX)), *lo);
    *hi = d8_max(d8_finite_or(z, d8_all(-DBL_MAX)), *hi);
}

LANES_TARGET static void range(const sl_frame *f, int64_t begin, int64_t end, double *nearest, double *farthest)
{
    double least[8], most[8];
    d8 lo = d8_all(DBL_MAX), hi = d8_all(-DBL_MAX);
    int64_t v = begin;
    for (; v + 8 <= end; v += 8) {
        widen(f, f->xyz + 3 * v, &lo, &hi);
    }
    if (v < end) {
        double xyz[24];
        for (int64_t k = 0; k < 24; k++) {
            xyz[k] = f->xyz[3 * v + (3 * v + k < 3 * end ? k : k % 3)];
        }
        widen(f, xyz, &lo, &hi);
    }
    d8_store(least, lo);
    d8_store(most, hi);
    for (int k = 1; k < 8; k++) {
        least[0] = least[k] < least[0] ? least[k] : least[0];
        most[0] = most[k] > most[0] ? most[k] : most[0];
    }
    *nearest = least[0];
    *farthest = most[0];
}

#endif
