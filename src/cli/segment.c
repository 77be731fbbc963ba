/* seamlab segment: the charts without an atlas. */
#include "atlas/atlas.h"
#include "base/file.h"
#include "base/memory.h"
#include "base/text.h"
#include "cli/cli.h"
#include "cli/render_animate.h"
#include "cli/segment_options.h"
#include "image/colormap.h"
#include "meshio/ply_export.h"

#include <jansson.h>
#include <stdio.h>
#include <string.h>

static const cli_verb verb = {
    .name = "segment",
    .usage = "seamlab segment IN [-o OUT.ply] [--labels OUT.csv] [--seams OUT.csv] [--animate OUT.png] [options]",
    .summary = "Cuts a mesh into charts that can be laid flat. Without a file to write, the labels\n"
               "(facet,chart) go to standard output.",
    .examples = "  seamlab segment model.obj -o charts.ply\n"
                "  seamlab segment model.obj --labels charts.csv --seams seams.csv\n"
                "  seamlab segment model.obj --preset paper --json\n"
                "  seamlab segment model.obj --animate splits.png\n",
    .min_files = 1,
    .max_files = 1,
};

typedef struct segment_outputs {
    const char *ply, *labels, *seams, *animation;
} segment_outputs;

static sl_status write_labels(const char *path, const sl_segmentation *seg, int32_t nf, sl_diag *diag)
{
    sl_writer *writer = NULL;
    const sl_status status = sl_writer_create(path, &writer, diag);
    if (status != SL_OK) {
        return status;
    }
    sl_writer_text(writer, "facet,chart\n");
    for (int32_t f = 0; f < nf; f++) {
        sl_writer_format(writer, "%d,%d\n", f, seg->face_chart[f]);
    }
    return sl_writer_commit(writer, diag);
}

/* The format that `unwrap --seams` reads. */
static sl_status write_seams(const char *path, const sl_mesh *mesh, sl_diag *diag)
{
    sl_writer *writer = NULL;
    const sl_status status = sl_writer_create(path, &writer, diag);
    if (status != SL_OK) {
        return status;
    }
    sl_writer_text(writer, "vertex,vertex\n");
    for (int32_t h = 0; h < mesh->nh; h++) {
        if (mesh->sew[h] > h) {
            sl_writer_format(writer, "%d,%d\n", mesh->input_vertex[mesh->origin[h]],
                             mesh->input_vertex[sl_target(mesh, h)]);
        }
    }
    return sl_writer_commit(writer, diag);
}

static sl_status write_colored(const char *path, const sl_polygons *polygons, const sl_segmentation *seg, sl_diag *diag)
{
    uint8_t *rgb = sl_alloc(polygons->nf, 3);
    if (rgb == NULL) {
        return SL_OUT_OF_MEMORY;
    }
    for (int32_t f = 0; f < polygons->nf; f++) {
        sl_palette_color(seg->face_chart[f], rgb + 3 * (int64_t)f);
    }
    const sl_status status = sl_ply_write_colored(path, polygons, rgb, diag);
    sl_free(rgb);
    return status;
}

static sl_status write_outputs(const segment_outputs *out, const sl_polygons *polygons, const sl_mesh *mesh,
                               const sl_segmentation *seg, bool json, sl_diag *diag)
{
    sl_status status = SL_OK;
    if (out->ply != NULL) {
        SL_TRY(write_colored(out->ply, polygons, seg, diag));
    }
    if (out->seams != NULL) {
        SL_TRY(write_seams(out->seams, mesh, diag));
    }
    if (out->labels != NULL || (out->ply == NULL && out->seams == NULL && out->animation == NULL && !json)) {
        SL_TRY(write_labels(out->labels != NULL ? out->labels : "-", seg, polygons->nf, diag));
    }
cleanup:
    return status;
}

static void print_summary(cli_run *run, const sl_mesh *mesh, const sl_segmentation *seg)
{
    const double seam = sl_atlas_seam_diagonals(mesh);
    int32_t invalid = 0;
    for (int32_t c = 0; c < seg->nchart; c++) {
        invalid += seg->chart[c].flat.verdict != SL_CHART_VALID;
    }
    if (run->json) {
        json_t *j = json_pack("{s:i, s:i, s:f, s:i, s:i, s:i}", "schema", 1, "charts", seg->nchart, "seamDiag", seam,
                              "splits", seg->nsplit, "merges", seg->merges, "invalid", invalid);
        json_dumpf(j, stdout, JSON_COMPACT | JSON_REAL_PRECISION(9));
        putchar('\n');
        json_decref(j);
    } else {
        cli_note(run, "%d chart%s, %d split%s, %d merge%s, seams %.2f diagonals", seg->nchart, sl_plural(seg->nchart),
                 seg->nsplit, sl_plural(seg->nsplit), seg->merges, sl_plural(seg->merges), seam);
    }
}

/* The animation shows the atlas that grows, so the whole way is gone. */
static int animate_file(cli_run *run, const sl_polygons *polygons, const cli_segment_options *options,
                        const segment_outputs *out)
{
    sl_diag diag = sl_diag_none();
    sl_atlas *atlas = NULL;
    sl_apng *apng = NULL;
    sl_status status = SL_OK;
    sl_atlas_def whole = sl_atlas_default();
    whole.segment = options->def;
    whole.best = options->best;
    whole.optimize = options->optimize;
    SL_TRY(sl_unwrap(polygons, &whole, &run->context, &atlas, &diag));
    SL_TRY(cli_animate_segmentation(atlas, &run->context, &apng));
    SL_TRY(write_outputs(out, polygons, atlas->mesh, atlas->segmentation, run->json, &diag));
    SL_TRY(sl_apng_write(out->animation, apng, &diag));
    print_summary(run, atlas->mesh, atlas->segmentation);
cleanup:
    sl_apng_free(apng);
    sl_atlas_free(atlas);
    return cli_fail(run, status, &diag);
}

static int segment_file(cli_run *run, const char *path, const cli_segment_options *options, const segment_outputs *out)
{
    sl_diag diag = sl_diag_none();
    sl_meshfile *file = NULL;
    sl_mesh *mesh = NULL;
    sl_triangulation *triangulation = NULL;
    sl_segmentation *seg = NULL;
    sl_polygons polygons;
    sl_status status = SL_OK;
    const int code = cli_read_mesh(run, path, &file);
    if (code != CLI_DONE) {
        return code;
    }
    sl_meshfile_polygons(file, &polygons);
    if (out->animation != NULL) {
        const int animated = animate_file(run, &polygons, options, out);
        sl_meshfile_free(file);
        return animated;
    }
    SL_TRY(sl_mesh_build(&polygons, &mesh, NULL, &diag));
    SL_TRY(sl_triangulation_create(mesh, &triangulation));
    if (options->best) {
        SL_TRY(sl_optimize_segment(mesh, triangulation, &options->def, &options->optimize, &run->context, &seg, NULL));
    } else {
        SL_TRY(sl_segment(mesh, triangulation, &options->def, &run->context, &seg));
    }
    SL_TRY(write_outputs(out, &polygons, mesh, seg, run->json, &diag));
    print_summary(run, mesh, seg);
cleanup:
    sl_segmentation_free(seg);
    sl_triangulation_free(triangulation);
    sl_mesh_free(mesh);
    sl_meshfile_free(file);
    return cli_fail(run, status, &diag);
}

int cli_segment(int argc, char **argv)
{
    enum { OWN = 4, ALL = OWN + CLI_SEGMENT_OPTIONS + CLI_COMMON_OPTIONS };
    cli_run run = {.verb = verb.name};
    cli_segment_options segment;
    segment_outputs out = {0};
    const char *files[1];
    int32_t file_count = 0;
    const cli_option own[OWN] = {
        {"output", 'o', CLI_TEXT, &out.ply, 0, 0, NULL, "OUT.ply", "the mesh with a colour a chart"},
        {"labels", 0, CLI_TEXT, &out.labels, 0, 0, NULL, "OUT.csv", "facet,chart"},
        {"seams", 0, CLI_TEXT, &out.seams, 0, 0, NULL, "OUT.csv", "the cut edges by their vertices"},
        {"animate", 0, CLI_TEXT, &out.animation, 0, 0, NULL, "OUT.png", "an animated PNG: split by split"},
    };
    cli_option options[ALL];
    cli_segment_preset(&segment, CLI_PRESET_FAST, argc, argv);
    memcpy(options, own, sizeof own);
    cli_segment_table(&segment, options + OWN);
    cli_common_options(&run, options + OWN + CLI_SEGMENT_OPTIONS);
    int code = cli_parse(&verb, options, ALL, argc, argv, 2, files, &file_count);
    if (code >= 0) {
        return code;
    }
    if (out.ply != NULL && !cli_has_extension(out.ply, ".ply")) {
        return cli_usage(verb.name, "-o writes a coloured .ply, not %s; `unwrap` writes .obj", out.ply);
    }
    if (out.animation != NULL && strcmp(out.animation, "-") != 0 && !cli_has_extension(out.animation, ".png")) {
        return cli_usage(verb.name, "--animate writes an animated .png, not %s", out.animation);
    }
    code = cli_begin(&run);
    if (code >= 0) {
        return code;
    }
    cli_segment_apply(&segment);
    return cli_end(&run, segment_file(&run, files[0], &segment, &out));
}
