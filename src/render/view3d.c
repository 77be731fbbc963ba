/* The model in 3D. */
#include "image/color.h"
#include "render/lines_internal.h"
#include "render/overlay_internal.h"
#include "render/studio_internal.h"
#include "render/view_internal.h"

sl_status sl_view_3d(const sl_scene *scene, const sl_view *view, const sl_picture *picture, const sl_dressing *dressing,
                     const sl_context *context, sl_canvas *canvas, sl_diag *diag)
{
    sl_status status = SL_OK;
    sl_screen *screen = NULL;
    sl_light_rig *rig = NULL;
    sl_ground *ground = NULL;
    sl_line_set lines = {0};
    sl_camera camera;
    const int32_t scale = picture->samples, width = picture->width * scale, height = picture->height * scale;
    const sl_mesh *m = scene->mesh;
    const bool legend = picture->legend && dressing->value != NULL;
    sl_view roomy = *view;
    roomy.top += sl_title_room(canvas, picture->title);
    roomy.bottom += legend ? sl_legend_room(canvas) : 0.0;
    status = sl_camera_frame(&roomy, (double)width / height, 3 * (int64_t)dressing->nt, dressing->triangle_vertex,
                             m->xyz, &camera);
    if (status != SL_OK) {
        sl_diag_reason(diag, "the camera's azimuth, elevation, field of view, margin or up axis is out of range");
        goto cleanup;
    }
    SL_TRY(sl_screen_create(&camera, width, height, m->nv, m->xyz, dressing->nt, dressing->triangle_vertex,
                            SL_BAND_PIXELS * scale, context, &screen));
    SL_TRY(sl_studio_create(&camera, view->up_axis, picture->sky_lights, m->nv, m->xyz, dressing->nt,
                            dressing->triangle_vertex, context, &rig));
    SL_TRY(sl_lines_on_model(scene, dressing, screen, &lines));
    if (picture->ground && picture->sky_lights > 0) {
        SL_TRY(sl_studio_ground(rig, view->up_axis, m->xyz, dressing->nt, dressing->triangle_vertex, context, &ground));
    }
    const sl_material material = sl_dressed_material(scene, dressing);
    sl_stage stage = {.screen = screen,
                      .material = &material,
                      .rig = rig,
                      .ground = ground,
                      .scale = scale,
                      .layers = lines.layers,
                      .layer = lines.layer};
    sl_rgb_to_linear(picture->background, stage.background);
    SL_TRY(sl_stage_draw(&stage, context, canvas));
    SL_TRY(sl_overlay_title(canvas, picture->title));
    if (legend) {
        SL_TRY(sl_overlay_legend(canvas, dressing, picture->value_name));
    }
cleanup:
    sl_line_set_clear(&lines);
    sl_ground_free(ground);
    sl_light_rig_free(rig);
    sl_screen_free(screen);
    return status;
}
