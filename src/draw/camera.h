/* Cameras: where a point of the scene lands on a picture.
 * Layer: draw (may include geom, base). */
#ifndef SL_DRAW_CAMERA_H
#define SL_DRAW_CAMERA_H

#include "base/status.h"

/* Eye space: x to the right, y up, z forward (the depth, positive in front of the eye). Picture space: samples, origin
 * at the top left corner, y down; the centre of sample (i, j) is (i + 1/2, j + 1/2).
 *
 *     perspective    sx = W cx + H focal x / z     sy = H cy - H focal y / z
 *     orthographic   sx = W cx + H focal x         sy = H cy - H focal y
 *
 * so a camera does not depend on the number of samples, only on the picture's aspect. */
typedef struct sl_camera {
    double eye[3];                      /* scene units */
    double right[3], up[3], forward[3]; /* orthonormal; right x up = -forward */
    double centre[2];                   /* cx, cy: where the axis of sight meets the picture, in [0, 1] */
    double focal;                       /* picture heights per unit of tangent (perspective) or of length */
    double near_depth;                  /* nothing nearer is drawn; > 0 for perspective */
    bool perspective;
} sl_camera;

/* From where to look. */
typedef struct sl_view {
    double azimuth;   /* degrees around the up axis, 0 = from +z (y up) or from -y (z up), 90 = from +x; default 35 */
    double elevation; /* degrees above the horizon, [-90, 90]; default 20 */
    double fov;       /* vertical field of view in degrees, [0, 120], 0 = orthographic; default 24 */
    double margin;    /* free border on each side as a fraction of the picture, [0, 0.4]; default 0.05 */
    double top;       /* more free border at the top, fraction of the height, [0, 0.4]; default 0 */
    double bottom;    /* at the bottom; margins and these leave at least a twentieth of the height */
    int32_t up_axis;  /* 0 = x, 1 = y, 2 = z; default 1 */
} sl_view;

sl_view sl_view_default(void);

/* The camera of that view that shows all points as large as the margin allows (exactly: two opposite sides touch,
 * unless the eye would come nearer to a point than a tenth of the scene's depth), centred in what the margins leave.
 * index: `count` numbers of points in xyz (3 doubles each), or NULL for the first `count` points; points that are not
 * finite are left out. With no point left, the unit box is framed. aspect = width / height > 0. SL_BAD_INPUT: a field
 * of the view out of its range or not finite. O(count). */
SL_NODISCARD sl_status sl_camera_frame(const sl_view *view, double aspect, int64_t count, const int32_t *index,
                                       const double *xyz, sl_camera *camera);

/* An orthographic camera that looks straight down on the xy-plane, x to the right and y up, with the window
 * [x0, x0 + span * aspect] x [y0, y0 + span] filling the picture. For UV space. */
sl_camera sl_camera_plan(double x0, double y0, double span, double aspect);

/* Eye-space coordinates of a point. */
void sl_camera_to_eye(const sl_camera *camera, const double point[3], double eye[3]);

/* Picture coordinates, in samples of a width x height picture, of a point in eye space (in front of the eye). */
void sl_camera_project(const sl_camera *camera, int32_t width, int32_t height, const double eye[3], double sample[2]);

/* The ray through picture position (sx, sy): origin and direction in eye space, direction[2] = 1, so that
 * origin + z direction has depth z. */
void sl_camera_ray(const sl_camera *camera, int32_t width, int32_t height, double sx, double sy, double origin[3],
                   double direction[3]);

#endif
