/* seamlab compare: the pictures. */
#include "cli/compare.h"

#include "base/text.h"
#include "cli/render_scene.h"
#include "image/png.h"
#include "render/render.h"

#include <math.h>
#include <stdio.h>

enum { ACROSS = 4 }; /* atlases in a row of the picture */

/* Squares of the checkerboard along the root of the surface's area. */
static const double squares = 36.0;
static const uint8_t gap_rgb[3] = {246, 246, 244};

/* Moves the UVs into the unit square and sets the checkerboard, so that its squares have one size on every surface. */
static void normalise(cli_scene *s, const sl_atlas_measure *m)
{
    double lo[2] = {HUGE_VAL, HUGE_VAL}, side = 0.0;
    for (int64_t i = 0; i < 2 * (int64_t)s->mesh->nh; i++) {
        lo[i % 2] = fmin(lo[i % 2], s->corner_uv[i]);
    }
    for (int64_t i = 0; i < 2 * (int64_t)s->mesh->nh; i++) {
        side = fmax(side, s->corner_uv[i] - lo[i % 2]);
    }
    for (int64_t i = 0; i < 2 * (int64_t)s->mesh->nh && side > 0.0; i++) {
        s->corner_uv[i] = (s->corner_uv[i] - lo[i % 2]) / side;
    }
    if (side > 0.0 && m->global.area_uv > 0.0) {
        s->scene.checks = fmin(fmax(squares * side / sqrt(m->global.area_uv), 1.0), 1e4);
    }
}

/* Model above, atlas below. */
static sl_status draw_one(cli_run *run, cli_scene *scene, const cli_contender *c, const cli_compare_pictures *how,
                          sl_image **out, sl_diag *diag)
{
    sl_status status = SL_OK;
    sl_image *model = NULL, *atlas = NULL, *both = NULL;
    sl_picture picture = sl_picture_default();
    char numbers[160];
    const sl_atlas_measure *m = &c->measure;
    snprintf(numbers, sizeof numbers, "%d chart%s  seams %.2f  L2 %.3f  angle %.3f", m->charts, sl_plural(m->charts),
             m->seam_length, m->global.l2, m->global.angle_mean);
    normalise(scene, m);
    picture.width = how->side;
    picture.height = how->side * 3 / 4;
    picture.title = c->name;
    picture.uv_title = numbers;
    picture.sky_lights = how->fast ? 0 : picture.sky_lights;
    SL_TRY(sl_render_3d(&scene->scene, &how->view, &picture, &run->context, &model, diag));
    picture.height = how->side;
    SL_TRY(sl_render_uv(&scene->scene, &picture, &run->context, &atlas, diag));
    SL_TRY(sl_image_create(how->side, model->height + atlas->height, 3, &both));
    sl_image_paste(both, model, 0, 0);
    sl_image_paste(both, atlas, 0, model->height);
    *out = both;
    both = NULL;
cleanup:
    sl_image_free(model);
    sl_image_free(atlas);
    sl_image_free(both);
    return status;
}

static int draw_contender(cli_run *run, const cli_contender *c, const cli_compare_pictures *how, sl_image **out)
{
    sl_diag diag = sl_diag_none();
    const cli_scene_options options = {.path = c->path,
                                       .tiles = 1.0,
                                       .checks = squares,
                                       .resolution = 1024,
                                       .charts_if_uv = true,
                                       .show = {.seams = true, .checker = true}};
    cli_scene scene;
    int code = cli_scene_open(run, &options, &scene);
    if (code == CLI_DONE) {
        code = cli_fail(run, draw_one(run, &scene, c, how, out, &diag), &diag);
    }
    cli_scene_clear(&scene);
    return code;
}

static int write_picture(cli_run *run, const char *path, const sl_image *image)
{
    sl_diag diag = sl_diag_none();
    return cli_fail(run, sl_png_write(path, image, &diag), &diag);
}

static int write_into(cli_run *run, const char *folder, const char *name, const sl_image *image)
{
    char path[4096], file[128];
    snprintf(file, sizeof file, "%s.png", name);
    if (!cli_join_path(folder, file, path, sizeof path)) {
        return cli_usage("compare", "the folder's name is too long");
    }
    return write_picture(run, path, image);
}

/* Pastes the pictures row by row. */
static sl_status assemble(sl_image *const *part, int32_t count, sl_image **out)
{
    const int32_t across = count < ACROSS ? count : ACROSS, rows = (count + ACROSS - 1) / ACROSS;
    const sl_status status = sl_image_create(across * part[0]->width, rows * part[0]->height, 3, out);
    if (status != SL_OK) {
        return status;
    }
    sl_image_fill(*out, gap_rgb);
    for (int32_t i = 0; i < count; i++) {
        sl_image_paste(*out, part[i], i % ACROSS * part[0]->width, i / ACROSS * part[0]->height);
    }
    return SL_OK;
}

int cli_compare_draw(cli_run *run, const cli_contender *contender, int32_t count, const cli_compare_pictures *how)
{
    sl_image *part[CLI_MAX_FILES] = {NULL}, *all = NULL;
    const bool one_file = cli_has_extension(how->output, ".png");
    int code = CLI_DONE;
    for (int32_t i = 0; i < count && code == CLI_DONE; i++) {
        code = draw_contender(run, &contender[i], how, &part[i]);
    }
    if (code == CLI_DONE) {
        code = cli_fail(run, assemble(part, count, &all), NULL);
    }
    if (code == CLI_DONE && one_file) {
        code = write_picture(run, how->output, all);
    } else if (code == CLI_DONE) {
        code = cli_make_folder(run, how->output) ? write_into(run, how->output, "compare", all) : CLI_INTERNAL;
        for (int32_t i = 0; i < count && code == CLI_DONE; i++) {
            code = write_into(run, how->output, contender[i].name, part[i]);
        }
    }
    for (int32_t i = 0; i < count; i++) {
        sl_image_free(part[i]);
    }
    sl_image_free(all);
    return code;
}
