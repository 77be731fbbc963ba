#include "cli/preview.h"

#include "base/memory.h"
#include "image/png.h"
#include "render/render.h"

#include <stdio.h>

/* Checkerboard squares across the atlas: about 48 of its texel rows a square at the default resolution. */
static const double preview_checks = 48.0;

static const char *const picture_names[CLI_PICTURES] = {"both.png", "model.png", "atlas.png"};

/* The chart a facet shows: copies have their sources' colours. Owned by the caller; NULL: out of memory. */
static int32_t *shown_charts(const sl_atlas *atlas)
{
    const sl_segmentation *seg = atlas->segmentation;
    int32_t *shown = sl_alloc(atlas->mesh->nf, sizeof *shown);
    for (int32_t f = 0; shown != NULL && f < atlas->mesh->nf; f++) {
        shown[f] = sl_chart_shown(seg, seg->face_chart[f]);
    }
    return shown;
}

static sl_status draw(const sl_atlas *atlas, const sl_context *context, cli_pictures *out, sl_diag *diag)
{
    sl_scene scene = sl_scene_default();
    sl_picture picture = sl_picture_default();
    sl_status status = SL_OK;
    const sl_sharing_info *sharing = &atlas->segmentation->sharing;
    char title[128];
    int32_t *shown = shown_charts(atlas);
    snprintf(title, sizeof title, "%d chart%s: %.0f %% saved", sharing->copies,
             sharing->copies == 1 ? " is a copy" : "s are copies", 100.0 * sharing->area);
    SL_TRY(shown != NULL ? SL_OK : SL_OUT_OF_MEMORY);
    scene.mesh = atlas->mesh;
    scene.triangulation = atlas->triangulation;
    scene.corner_uv = atlas->corner_uv;
    scene.chart = shown;
    scene.checks = preview_checks;
    picture.back_view = true;
    picture.uv_title = sharing->copies > 0 ? title : NULL;
    picture.width = 2160;
    picture.height = 760;
    SL_TRY(sl_render_pair(&scene, NULL, &picture, context, &out->image[0], diag));
    picture = sl_picture_default();
    SL_TRY(sl_render_3d(&scene, NULL, &picture, context, &out->image[1], diag));
    picture.width = 1280;
    picture.height = 1280;
    picture.uv_title = sharing->copies > 0 ? title : NULL;
    SL_TRY(sl_render_uv(&scene, &picture, context, &out->image[2], diag));
cleanup:
    sl_free(shown);
    return status;
}

int cli_pictures_draw(cli_run *run, const sl_atlas *atlas, cli_pictures *out)
{
    sl_diag diag = sl_diag_none();
    *out = (cli_pictures){0};
    return cli_fail(run, draw(atlas, &run->context, out, &diag), &diag);
}

int cli_pictures_write(cli_run *run, const char *folder, const cli_pictures *pictures)
{
    if (!cli_make_folder(run, folder)) {
        return CLI_INTERNAL;
    }
    for (int k = 0; k < CLI_PICTURES; k++) {
        char path[4096];
        sl_diag diag = sl_diag_none();
        sl_status status = SL_IO;
        if (!cli_join_path(folder, picture_names[k], path, sizeof path)) {
            sl_diag_reason(&diag, "the folder's name is too long");
        } else {
            status = sl_png_write(path, pictures->image[k], &diag);
        }
        if (status != SL_OK) {
            return cli_fail(run, status, &diag);
        }
    }
    return CLI_DONE;
}

void cli_pictures_clear(cli_pictures *pictures)
{
    for (int k = 0; k < CLI_PICTURES; k++) {
        sl_image_free(pictures->image[k]);
        pictures->image[k] = NULL;
    }
}
