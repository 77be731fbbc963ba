/* seamlab demo: the whole way without any mesh at hand. */
#include "atlas/sidecar.h"
#include "base/text.h"
#include "cli/cli.h"
#include "cli/preview.h"
#include "generators.h"

#include <stdio.h>
#include <string.h>

static const cli_verb verb = {
    .name = "demo",
    .usage = "seamlab demo [MODEL] [-o DIR] [--list]",
    .summary = "Generates a mesh, unwraps it and writes mesh, sidecar and pictures into a folder.",
    .examples = "  seamlab demo\n  seamlab demo airplane -o airplane\n  seamlab demo --list\n",
    .min_files = 0,
    .max_files = 1,
};

static void print_list(void)
{
    int32_t count = 0;
    const sl_generator *generator = sl_generators(&count);
    for (int32_t k = 0; k < count; k++) {
        printf("%-14s %s\n", generator[k].name, generator[k].what);
    }
}

static sl_status write_demo(const char *folder, const char *name, const sl_polygons *polygons, const sl_atlas *atlas,
                            const sl_atlas_def *def, sl_diag *diag)
{
    char file_name[128], path[4096], sidecar[4096];
    sl_meshfile *file = NULL;
    sl_status status = SL_OK;
    snprintf(file_name, sizeof file_name, "%s.obj", name);
    if (!cli_join_path(folder, file_name, path, sizeof path)) {
        sl_diag_reason(diag, "the folder's name is too long");
        return SL_IO;
    }
    SL_TRY(sl_meshfile_from_polygons(polygons, &file, diag));
    SL_TRY(sl_meshfile_write(path, file, atlas->input_corner_uv, diag));
    sl_sidecar_path(path, sidecar, sizeof sidecar);
    status = sl_sidecar_write(sidecar, atlas, def, diag);
cleanup:
    sl_meshfile_free(file);
    return status;
}

static int run_demo(cli_run *run, const sl_generator *generator, const char *folder)
{
    const sl_atlas_def def = sl_atlas_default();
    sl_diag diag = sl_diag_none();
    sl_generated *mesh = NULL;
    sl_atlas *atlas = NULL;
    sl_polygons polygons;
    cli_pictures pictures = {0};
    sl_status status = SL_OK;
    int code = CLI_DONE;
    if (!cli_make_folder(run, folder)) {
        return CLI_INTERNAL;
    }
    SL_TRY(generator->make(1, 1, &mesh));
    sl_generated_polygons(mesh, &polygons);
    cli_note(run, "a generated %s: %d facets, %d vertices", generator->name, mesh->nf, mesh->nv);
    SL_TRY(sl_unwrap(&polygons, &def, &run->context, &atlas, &diag));
    if (!atlas->check.passed) {
        SL_TRY(SL_CHECK_FAILED);
    }
    code = cli_pictures_draw(run, atlas, &pictures);
    if (code == CLI_DONE) {
        SL_TRY(write_demo(folder, generator->name, &polygons, atlas, &def, &diag));
        code = cli_pictures_write(run, folder, &pictures);
    }
    if (code == CLI_DONE) {
        cli_note(run, "%d chart%s, seams %.2f diagonals, fill %.2f\n%s/%s.obj, %s/%s.atlas.json, pictures beside them",
                 atlas->segmentation->nchart, sl_plural(atlas->segmentation->nchart),
                 sl_atlas_seam_diagonals(atlas->mesh), atlas->pack.fill, folder, generator->name, folder,
                 generator->name);
    }
cleanup:
    cli_pictures_clear(&pictures);
    sl_atlas_free(atlas);
    sl_generated_free(mesh);
    return status != SL_OK ? cli_fail(run, status, &diag) : code;
}

int cli_demo(int argc, char **argv)
{
    cli_run run = {.verb = verb.name};
    const char *folder = "seamlab-demo", *model = "hand", *files[1];
    bool list = false;
    int32_t file_count = 0;
    cli_option options[CLI_COMMON_OPTIONS + 3] = {
        {"output", 'o', CLI_TEXT, &folder, 0, 0, NULL, "DIR", "folder to write into (seamlab-demo)"},
        {"model", 0, CLI_TEXT, &model, 0, 0, NULL, "NAME", "which generated mesh (hand)"},
        {"list", 0, CLI_FLAG, &list, 0, 0, NULL, NULL, "name the generated meshes"},
    };
    cli_common_options(&run, options + 3);
    int code = cli_parse(&verb, options, (int32_t)SL_COUNTOF(options), argc, argv, 2, files, &file_count);
    if (code >= 0) {
        return code;
    }
    if (list) {
        print_list();
        return CLI_DONE;
    }
    model = file_count > 0 ? files[0] : model;
    const sl_generator *generator = sl_generator_find(model);
    if (generator == NULL) {
        return cli_usage(verb.name, "there is no model '%s'; --list names them", model);
    }
    code = cli_begin(&run);
    return code >= 0 ? code : cli_end(&run, run_demo(&run, generator, folder));
}
