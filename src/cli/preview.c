#include "cli/preview.h"

#include "image/png.h"
#include "render/render.h"

#include <stdio.h>

/* Checkerboard squares across the atlas: about 48 of its texel rows a square at the default resolution. */
static const double preview_checks = 48.0;

static sl_status write_picture(const char *folder, const char *name, const sl_image *image, sl_diag *diag)
{
    char path[4096];
    if (!cli_join_path(folder, name, path, sizeof path)) {
        sl_diag_reason(diag, "the folder's name is too long");
        return SL_IO;
    }
    return sl_png_write(path, image, diag);
}

static sl_status draw(const char *folder, const sl_atlas *atlas, const sl_context *context, sl_diag *diag)
{
    sl_scene scene = sl_scene_default();
    sl_picture picture = sl_picture_default();
    sl_image *image = NULL;
    sl_status status = SL_OK;
    scene.mesh = atlas->mesh;
    scene.triangulation = atlas->triangulation;
    scene.corner_uv = atlas->corner_uv;
    scene.chart = atlas->segmentation->face_chart;
    scene.checks = preview_checks;
    picture.back_view = true;
    picture.width = 2160;
    picture.height = 760;
    SL_TRY(sl_render_pair(&scene, NULL, &picture, context, &image, diag));
    SL_TRY(write_picture(folder, "both.png", image, diag));
    sl_image_free(image);
    image = NULL;
    picture = sl_picture_default();
    SL_TRY(sl_render_3d(&scene, NULL, &picture, context, &image, diag));
    SL_TRY(write_picture(folder, "model.png", image, diag));
    sl_image_free(image);
    image = NULL;
    picture.width = 1280;
    picture.height = 1280;
    SL_TRY(sl_render_uv(&scene, &picture, context, &image, diag));
    SL_TRY(write_picture(folder, "atlas.png", image, diag));
cleanup:
    sl_image_free(image);
    return status;
}

int cli_preview(cli_run *run, const char *folder, const sl_atlas *atlas)
{
    sl_diag diag = sl_diag_none();
    if (!cli_make_folder(run, folder)) {
        return CLI_INTERNAL;
    }
    return cli_fail(run, draw(folder, atlas, &run->context, &diag), &diag);
}
