#include "draw/camera.h"
#include "geom/vec3.h"

#include <float.h>
#include <string.h>

static const double degree = 0.017453292519943295;
static const double least_usable = 0.05;  /* of the picture's height */
static const double least_distance = 0.1; /* from the eye to the nearest point, fraction of the scene's depth */
static const double near_fraction = 1e-3; /* near plane, in distances from the eye to the nearest point */

sl_view sl_view_default(void)
{
    return (sl_view){.azimuth = 35.0, .elevation = 20.0, .fov = 24.0, .margin = 0.05, .up_axis = 1};
}

void sl_camera_to_eye(const sl_camera *camera, const double point[3], double eye[3])
{
    double d[3];
    sl_vec3_sub(point, camera->eye, d);
    eye[0] = sl_vec3_dot(d, camera->right);
    eye[1] = sl_vec3_dot(d, camera->up);
    eye[2] = sl_vec3_dot(d, camera->forward);
}

void sl_camera_project(const sl_camera *camera, int32_t width, int32_t height, const double eye[3], double sample[2])
{
    const double scale = height * camera->focal / (camera->perspective ? eye[2] : 1.0);
    sample[0] = camera->centre[0] * width + scale * eye[0];
    sample[1] = camera->centre[1] * height - scale * eye[1];
}

void sl_camera_ray(const sl_camera *camera, int32_t width, int32_t height, double sx, double sy, double origin[3],
                   double direction[3])
{
    const double unit = 1.0 / (height * camera->focal);
    const double x = (sx - camera->centre[0] * width) * unit, y = (camera->centre[1] * height - sy) * unit;
    const bool perspective = camera->perspective;
    origin[0] = perspective ? 0.0 : x;
    origin[1] = perspective ? 0.0 : y;
    origin[2] = 0.0;
    direction[0] = perspective ? x : 0.0;
    direction[1] = perspective ? y : 0.0;
    direction[2] = 1.0;
}

/* The axes of a view: `forward` points from the eye into the scene. */
static void orient(const sl_view *view, sl_camera *camera)
{
    const int up = view->up_axis, side = (up + 2) % 3, front = (up + 1) % 3;
    const double a = view->azimuth * degree, e = view->elevation * degree;
    /* With y up: front = z, side = x. With z up: the front is -y, as modellers have it. */
    const double sign = up == 2 ? -1.0 : 1.0;
    const int f = up == 2 ? side : front, s = up == 2 ? front : side;
    memset(camera->right, 0, sizeof camera->right);
    camera->forward[up] = -sin(e);
    camera->forward[f] = -sign * cos(a) * cos(e);
    camera->forward[s] = -sin(a) * cos(e);
    camera->right[f] = -sign * sin(a);
    camera->right[s] = cos(a);
    sl_vec3_cross(camera->right, camera->forward, camera->up);
}

/* Largest value over the points of each of the four sides' support functions, and the least depth. */
typedef struct extent {
    double side[4]; /* right, left, top, bottom */
    double nearest, farthest;
    bool any;
} extent;

static void extend(extent *box, const double eye[3], double tx, double ty)
{
    const double value[4] = {eye[0] - tx * eye[2], -eye[0] - tx * eye[2], eye[1] - ty * eye[2], -eye[1] - ty * eye[2]};
    for (int k = 0; k < 4; k++) {
        box->side[k] = fmax(box->side[k], value[k]);
    }
    box->nearest = fmin(box->nearest, eye[2]);
    box->farthest = fmax(box->farthest, eye[2]);
    box->any = true;
}

/* tx, ty: tangents of the half angles (0 = orthographic). */
static extent measure(const sl_camera *camera, int64_t count, const int32_t *index, const double *xyz, double tx,
                      double ty)
{
    extent box = {{-DBL_MAX, -DBL_MAX, -DBL_MAX, -DBL_MAX}, DBL_MAX, -DBL_MAX, false};
    for (int64_t i = 0; i < count; i++) {
        const double *p = xyz + 3 * (index != NULL ? index[i] : i);
        if (isfinite(p[0]) && isfinite(p[1]) && isfinite(p[2])) {
            double eye[3];
            sl_camera_to_eye(camera, p, eye);
            extend(&box, eye, tx, ty);
        }
    }
    const int corners = box.any ? 0 : 8;
    for (int c = 0; c < corners; c++) {
        const double corner[3] = {(c & 1) - 0.5, ((c >> 1) & 1) - 0.5, ((c >> 2) & 1) - 0.5};
        double eye[3];
        sl_camera_to_eye(camera, corner, eye);
        extend(&box, eye, tx, ty);
    }
    return box;
}

/* A point lies inside the frustum of an eye at (ex, ey, ez) when x - tx z <= ex - tx ez and so on for the four sides;
 * the farthest-forward eye that satisfies all of them is found in closed form. */
static void place_perspective(sl_camera *camera, const extent *box, double tx, double ty)
{
    const double ez_x = -(box->side[0] + box->side[1]) / (2.0 * tx);
    const double ez_y = -(box->side[2] + box->side[3]) / (2.0 * ty);
    double depth = fmin(ez_x, ez_y);
    const double range = box->farthest - box->nearest;
    depth = fmin(depth, box->nearest - (range > 0.0 ? least_distance * range : 1.0));
    const double ex = 0.5 * (box->side[0] - box->side[1]), ey = 0.5 * (box->side[2] - box->side[3]);
    for (int k = 0; k < 3; k++) {
        camera->eye[k] += ex * camera->right[k] + ey * camera->up[k] + depth * camera->forward[k];
    }
    camera->near_depth = near_fraction * (box->nearest - depth);
}

static void place_orthographic(sl_camera *camera, const extent *box, double usable_width, double usable_height)
{
    const double width = box->side[0] + box->side[1], height = box->side[2] + box->side[3];
    const double span = fmax(height / usable_height, width / usable_width); /* of the whole picture's height */
    const double ex = 0.5 * (box->side[0] - box->side[1]), ey = 0.5 * (box->side[2] - box->side[3]);
    const double depth = box->nearest - (span > 0.0 ? span : 1.0);
    for (int k = 0; k < 3; k++) {
        camera->eye[k] += ex * camera->right[k] + ey * camera->up[k] + depth * camera->forward[k];
    }
    camera->focal = span > 0.0 ? 1.0 / span : 1.0;
    camera->near_depth = 0.0;
}

static bool in_range(double value, double lo, double hi)
{
    return value >= lo && value <= hi; /* false for NaN */
}

sl_status sl_camera_frame(const sl_view *view, double aspect, int64_t count, const int32_t *index, const double *xyz,
                          sl_camera *camera)
{
    if (!in_range(view->azimuth, -1e6, 1e6) || !in_range(view->elevation, -90.0, 90.0) ||
        !in_range(view->fov, 0.0, 120.0) || !in_range(view->margin, 0.0, 0.4) || view->up_axis < 0 ||
        view->up_axis > 2 || !in_range(aspect, 1e-5, 1e5)) {
        return SL_BAD_INPUT;
    }
    const double usable_height = 1.0 - 2.0 * view->margin - view->top - view->bottom;
    const double usable_width = aspect * (1.0 - 2.0 * view->margin); /* in picture heights */
    if (!in_range(view->top, 0.0, 0.4) || !in_range(view->bottom, 0.0, 0.4) || !(usable_height >= least_usable)) {
        return SL_BAD_INPUT;
    }
    *camera = (sl_camera){.perspective = view->fov > 0.0, .centre = {0.5, 0.5 + 0.5 * (view->top - view->bottom)}};
    orient(view, camera);
    if (!camera->perspective) {
        const extent box = measure(camera, count, index, xyz, 0.0, 0.0);
        place_orthographic(camera, &box, usable_width, usable_height);
        return SL_OK;
    }
    const double half = tan(0.5 * view->fov * degree);
    const double ty = half * usable_height, tx = half * usable_width;
    camera->focal = 0.5 / half;
    const extent box = measure(camera, count, index, xyz, tx, ty);
    place_perspective(camera, &box, tx, ty);
    return SL_OK;
}

sl_camera sl_camera_plan(double x0, double y0, double span, double aspect)
{
    return (sl_camera){.eye = {x0 + 0.5 * span * aspect, y0 + 0.5 * span, 1.0},
                       .right = {1.0, 0.0, 0.0},
                       .up = {0.0, 1.0, 0.0},
                       .forward = {0.0, 0.0, -1.0},
                       .centre = {0.5, 0.5},
                       .focal = 1.0 / span,
                       .near_depth = 0.0,
                       .perspective = false};
}
