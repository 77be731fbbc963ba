#include "render/render.h"
#include "base/memory.h"
#include "render/view_internal.h"

#include <math.h>
#include <stdio.h>

static const float black[3] = {0.0f, 0.0f, 0.0f};

sl_status sl_render_3d(const sl_scene *scene, const sl_view *view, const sl_picture *picture, const sl_context *context,
                       sl_image **out, sl_diag *diag)
{
    sl_status status = SL_OK;
    sl_dressing dressing = {0};
    sl_canvas *canvas = NULL;
    const sl_view plain = sl_view_default();
    *out = NULL;
    SL_TRY(sl_scene_check(scene, picture, diag));
    SL_TRY(sl_dress(scene, true, &dressing));
    SL_TRY(sl_canvas_create(picture->width, picture->height, black, &canvas));
    SL_TRY(sl_view_3d(scene, view != NULL ? view : &plain, picture, &dressing, context, canvas, diag));
    SL_TRY(sl_canvas_develop(canvas, out));
cleanup:
    sl_canvas_free(canvas);
    sl_undress(&dressing);
    return status;
}

static sl_status check_uv(const sl_scene *scene, sl_diag *diag)
{
    if (scene->corner_uv != NULL) {
        return SL_OK;
    }
    if (diag != NULL) {
        *diag = sl_diag_none();
        sl_diag_reason(diag, "the scene has no UVs to show");
        sl_diag_hint(diag, "unwrap the mesh first");
    }
    return SL_BAD_INPUT;
}

sl_status sl_render_uv(const sl_scene *scene, const sl_picture *picture, const sl_context *context, sl_image **out,
                       sl_diag *diag)
{
    sl_status status = SL_OK;
    sl_dressing dressing = {0};
    sl_canvas *canvas = NULL;
    *out = NULL;
    SL_TRY(sl_scene_check(scene, picture, diag));
    SL_TRY(check_uv(scene, diag));
    SL_TRY(sl_dress(scene, false, &dressing));
    SL_TRY(sl_canvas_create(picture->width, picture->height, black, &canvas));
    SL_TRY(sl_view_uv(scene, picture, &dressing, context, canvas));
    SL_TRY(sl_canvas_develop(canvas, out));
cleanup:
    sl_canvas_free(canvas);
    sl_undress(&dressing);
    return status;
}

/* The panel's columns of a picture cut in equal parts. */
static int32_t panel_start(const sl_picture *picture, int32_t panel, int32_t panels)
{
    return (int32_t)((int64_t)picture->width * panel / panels);
}

static sl_status render_panel(const sl_scene *scene, const sl_view *view, const sl_picture *picture, int32_t panel,
                              int32_t panels, const sl_context *context, sl_image *sheet, sl_diag *diag)
{
    sl_image *image = NULL;
    sl_picture part = *picture;
    sl_view from = *view;
    const int32_t x = panel_start(picture, panel, panels);
    part.width = panel_start(picture, panel + 1, panels) - x;
    if (part.width == 0) {
        return SL_OK;
    }
    if (panel == 1 && panels == 3) { /* the other side, without repeating the title */
        from.azimuth += 180.0;
        part.title = NULL;
    }
    part.legend = part.legend && panel == 0; /* one is enough */
    const sl_status status = panel == panels - 1 ? sl_render_uv(scene, &part, context, &image, diag)
                                                 : sl_render_3d(scene, &from, &part, context, &image, diag);
    if (status == SL_OK) {
        sl_image_paste(sheet, image, x, 0);
    }
    sl_image_free(image);
    return status;
}

sl_status sl_render_pair(const sl_scene *scene, const sl_view *view, const sl_picture *picture,
                         const sl_context *context, sl_image **out, sl_diag *diag)
{
    sl_status status = SL_OK;
    sl_image *sheet = NULL;
    const sl_view plain = sl_view_default();
    const int32_t panels = picture->back_view ? 3 : 2;
    *out = NULL;
    SL_TRY(sl_scene_check(scene, picture, diag));
    SL_TRY(check_uv(scene, diag));
    SL_TRY(sl_image_create(picture->width, picture->height, 3, &sheet));
    for (int32_t p = 0; p < panels; p++) {
        SL_TRY(sl_report_progress(context, "render", (double)p / panels));
        SL_TRY(render_panel(scene, view != NULL ? view : &plain, picture, p, panels, context, sheet, diag));
    }
    *out = sheet;
    sheet = NULL;
cleanup:
    sl_image_free(sheet);
    return status;
}
