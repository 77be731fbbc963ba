/* The atlas in UV space. */
#include "base/memory.h"
#include "image/color.h"
#include "render/lines_internal.h"
#include "render/overlay_internal.h"
#include "render/render.h"
#include "render/stage_internal.h"
#include "render/view_internal.h"

#include <math.h>

static const uint8_t frame_rgb[3] = {150, 150, 150};
static const uint8_t sheet_rgb[3] = {255, 255, 255};
static const double frame_width = 1.0; /* pixels */
static const double margin = 0.04;     /* around the window, fraction of the shorter side */
static const double outside = 1e-6;    /* UVs this far beyond the unit square widen the window */

/* The part of UV space shown: [x0, x0 + wide] x [y0, y0 + high]. */
typedef struct uv_window {
    double x0, y0, wide, high;
} uv_window;

static uv_window find_window(const sl_scene *scene)
{
    double lo[2] = {0.0, 0.0}, hi[2] = {1.0, 1.0};
    bool beyond = false;
    for (int64_t h = 0; h < scene->mesh->nh; h++) {
        const double *uv = scene->corner_uv + 2 * h;
        beyond = beyond || fmin(uv[0], uv[1]) < -outside || fmax(uv[0], uv[1]) > 1.0 + outside;
    }
    if (beyond) {
        for (int k = 0; k < 2; k++) {
            lo[k] = INFINITY;
            hi[k] = -INFINITY;
            for (int64_t h = 0; h < scene->mesh->nh; h++) {
                const double u = scene->corner_uv[2 * h + k];
                if (fabs(u) < 1e15) { /* false for NaN */
                    lo[k] = fmin(lo[k], u);
                    hi[k] = fmax(hi[k], u);
                }
            }
        }
    }
    for (int k = 0; k < 2; k++) {
        if (!(hi[k] > lo[k])) {
            lo[k] = isfinite(lo[k]) ? lo[k] - 0.5 : 0.0;
            hi[k] = lo[k] + 1.0;
        }
    }
    return (uv_window){lo[0], lo[1], hi[0] - lo[0], hi[1] - lo[1]};
}

/* A camera that shows the window with a margin, centred between a title and a colour bar that take `top` and `bottom`
 * of the height. box: left, top, right, bottom of the window in pixels. */
static sl_camera frame_window(const uv_window *win, int32_t width, int32_t height, double top, double bottom,
                              double box[4])
{
    const double aspect = (double)width / height, shorter = width < height ? width : height;
    const double usable_w = width - 2.0 * margin * shorter,
                 usable_h = height * (1.0 - top - bottom) - 2.0 * margin * shorter;
    const double per_pixel = fmax(win->wide / usable_w, win->high / usable_h);
    const double span = per_pixel * height;
    const double x0 = win->x0 + 0.5 * win->wide - 0.5 * span * aspect,
                 y0 = win->y0 + 0.5 * win->high - (bottom + 0.5 * (1.0 - top - bottom)) * span;
    box[0] = (win->x0 - x0) / per_pixel;
    box[1] = height - (win->y0 + win->high - y0) / per_pixel;
    box[2] = box[0] + win->wide / per_pixel;
    box[3] = box[1] + win->high / per_pixel;
    return sl_camera_plan(x0, y0, span, aspect);
}

/* Corners as points of the plane z = 0. */
static double *lift_corners(const sl_scene *scene)
{
    double *xyz = sl_alloc(scene->mesh->nh, 3 * sizeof *xyz);
    for (int64_t h = 0; xyz != NULL && h < scene->mesh->nh; h++) {
        xyz[3 * h] = scene->corner_uv[2 * h];
        xyz[3 * h + 1] = scene->corner_uv[2 * h + 1];
        xyz[3 * h + 2] = 0.0;
    }
    return xyz;
}

static sl_status draw_charts(const sl_scene *scene, const sl_picture *picture, const sl_dressing *dressing,
                             const sl_camera *camera, const double *xyz, const sl_context *context, sl_canvas *canvas)
{
    sl_status status = SL_OK;
    sl_screen *screen = NULL;
    sl_line_set lines = {0};
    const int32_t scale = picture->samples;
    const sl_triangulation *tri = scene->triangulation;
    SL_TRY(sl_screen_create(camera, picture->width * scale, picture->height * scale, scene->mesh->nh, xyz, tri->nt,
                            tri->corner, SL_BAND_PIXELS * scale, context, &screen));
    SL_TRY(sl_lines_in_atlas(scene, screen, &lines));
    sl_material material = sl_dressed_material(scene, dressing);
    material.lit = false;
    sl_stage stage = {
        .screen = screen, .material = &material, .scale = scale, .layers = lines.layers, .layer = lines.layer};
    sl_rgb_to_linear(sheet_rgb, stage.background);
    SL_TRY(sl_stage_draw(&stage, context, canvas));
cleanup:
    sl_line_set_clear(&lines);
    sl_screen_free(screen);
    return status;
}

/* The unit square or the grown window: its surroundings in the picture's background, a thin frame. */
static sl_status draw_frame(const sl_picture *picture, const double box[4], sl_canvas *canvas)
{
    sl_status status = SL_OK;
    sl_overlay *overlay = NULL;
    SL_TRY(sl_overlay_create(canvas, &overlay));
    const double w = canvas->width, h = canvas->height;
    sl_mask_rectangle(&overlay->mask, 0.0, 0.0, w, box[1]);
    sl_mask_rectangle(&overlay->mask, 0.0, box[3], w, h);
    sl_mask_rectangle(&overlay->mask, 0.0, box[1], box[0], box[3]);
    sl_mask_rectangle(&overlay->mask, box[2], box[1], w, box[3]);
    sl_overlay_blend(overlay, picture->background, 1.0f);
    for (int k = 0; k < 4; k++) {
        static const int from[4][2] = {{0, 1}, {2, 1}, {2, 3}, {0, 3}};
        const double a[2] = {box[from[k][0]], box[from[k][1]]};
        const double b[2] = {box[from[(k + 1) % 4][0]], box[from[(k + 1) % 4][1]]};
        sl_mask_segment(&overlay->mask, a, b, frame_width);
    }
    sl_overlay_blend(overlay, frame_rgb, 1.0f);
cleanup:
    sl_overlay_free(overlay);
    return status;
}

sl_status sl_view_uv(const sl_scene *scene, const sl_picture *picture, const sl_dressing *dressing,
                     const sl_context *context, sl_canvas *canvas)
{
    sl_status status = SL_OK;
    const uv_window window = find_window(scene);
    double box[4];
    const bool legend = picture->legend && dressing->value != NULL;
    const sl_camera camera =
        frame_window(&window, picture->width, picture->height, sl_title_room(canvas, picture->uv_title),
                     legend ? sl_legend_room(canvas) : 0.0, box);
    double *xyz = lift_corners(scene);
    if (xyz == NULL) {
        return SL_OUT_OF_MEMORY;
    }
    SL_TRY(draw_charts(scene, picture, dressing, &camera, xyz, context, canvas));
    SL_TRY(draw_frame(picture, box, canvas));
    SL_TRY(sl_overlay_title(canvas, picture->uv_title));
    if (legend) {
        SL_TRY(sl_overlay_legend(canvas, dressing, picture->value_name));
    }
cleanup:
    sl_free(xyz);
    return status;
}
