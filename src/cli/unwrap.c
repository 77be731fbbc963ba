/* seamlab unwrap: a mesh in, a checked atlas out. */
#include "atlas/sidecar.h"
#include "base/file.h"
#include "base/memory.h"
#include "base/text.h"
#include "cli/cli.h"
#include "cli/pack_options.h"
#include "cli/preview.h"
#include "cli/segment_options.h"

#include <jansson.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

static const cli_verb verb = {
    .name = "unwrap",
    .usage = "seamlab unwrap IN -o OUT [options]",
    .summary = "Cuts a mesh into charts, lays them flat, packs them, checks the result and writes it\n"
               "with a sidecar OUT.atlas.json that says what was done. Page p of several is the UDIM tile 1001 + p.",
    .examples = "  seamlab unwrap model.obj -o model-uv.obj\n"
                "  seamlab unwrap model.ply -o model-uv.ply --preview pictures --max-stretch 1.2\n"
                "  seamlab unwrap model.obj -o paper.obj --preset paper\n"
                "  seamlab unwrap model.obj -o finer.obj --target-stretch 1.02\n"
                "  seamlab unwrap model.obj -o mine.obj --seams edges.csv\n"
                "  seamlab unwrap model.obj -o own.obj --symmetry off\n"
                "  seamlab unwrap model.obj -o tiles.obj --density 512 --pages 100\n",
    .min_files = 1,
    .max_files = 1,
};

typedef struct unwrap_options {
    cli_run run;
    cli_segment_options segment;
    cli_pack_options pack;
    sl_atlas_def def;
    const char *output, *preview, *seams, *labels;
    bool keep_seams, allow_overlap;
} unwrap_options;

enum { OWN_OPTIONS = 7, ALL_OPTIONS = OWN_OPTIONS + CLI_PACK_OPTIONS + CLI_SEGMENT_OPTIONS + CLI_COMMON_OPTIONS };

static void option_table(unwrap_options *o, cli_option *table)
{
    const cli_option own[OWN_OPTIONS] = {
        {"output", 'o', CLI_TEXT, &o->output, 0, 0, NULL, "OUT", "OBJ or PLY to write"},
        {"preview", 0, CLI_TEXT, &o->preview, 0, 0, NULL, "DIR", "pictures of the model and the atlas"},
        {"seams", 0, CLI_TEXT, &o->seams, 0, 0, NULL, "FILE", "your seams: a line of two vertex numbers an edge"},
        {"labels", 0, CLI_TEXT, &o->labels, 0, 0, NULL, "FILE", "your charts: a line with a number a facet"},
        {"keep-seams", 0, CLI_FLAG, &o->keep_seams, 0, 0, NULL, NULL, "the input's own UV seams"},
        {"allow-overlap", 0, CLI_FLAG, &o->allow_overlap, 0, 0, NULL, NULL,
         "write an atlas whose charts overlap, marked uncertified"},
        {"strict", 0, CLI_FLAG, &o->run.strict, 0, 0, NULL, NULL, "exit 4 when there is a warning"},
    };
    memcpy(table, own, sizeof own);
    cli_pack_table(&o->pack, table + OWN_OPTIONS);
    cli_segment_table(&o->segment, table + OWN_OPTIONS + CLI_PACK_OPTIONS);
    cli_common_options(&o->run, table + OWN_OPTIONS + CLI_PACK_OPTIONS + CLI_SEGMENT_OPTIONS);
}

static int check_options(const unwrap_options *o)
{
    if ((o->seams != NULL) + (o->labels != NULL) + o->keep_seams > 1) {
        return cli_usage(verb.name, "--seams, --labels and --keep-seams exclude one another");
    }
    return cli_check_output(verb.name, o->output, true);
}

/* Reads the user's seams, if any. *owned is freed by the caller. */
static int read_seams(unwrap_options *o, const sl_meshfile *file, int32_t **owned)
{
    sl_diag diag = sl_diag_none();
    sl_seam_input *input = &o->def.seam_input;
    sl_status status = SL_OK;
    if (o->seams != NULL) {
        status = sl_seams_read_edges(o->seams, owned, &input->edge_count, &diag);
        input->edge = *owned;
        o->def.seams = SL_SEAMS_EDGES;
    } else if (o->labels != NULL) {
        status = sl_seams_read_labels(o->labels, file->nf, owned, &diag);
        input->label = *owned;
        o->def.seams = SL_SEAMS_LABELS;
    } else if (o->keep_seams) {
        input->corner_uv = file->corner_uv;
        o->def.seams = SL_SEAMS_KEEP_UV;
        if (file->corner_uv == NULL) {
            sl_diag_reason(&diag, "the input has no UVs whose seams could be kept");
            status = SL_BAD_INPUT;
        }
    }
    const int code = cli_fail(&o->run, status, &diag);
    return status == SL_IO ? CLI_BAD_INPUT : code;
}

/* The sidecar is renamed into place after the mesh: neither is ever half there. */
static int write_atlas(unwrap_options *o, const sl_meshfile *file, const sl_atlas *atlas)
{
    sl_diag diag = sl_diag_none();
    char path[4096], *text = NULL;
    sl_writer *sidecar = NULL;
    sl_status status = SL_OK;
    const bool to_stdout = strcmp(o->output, "-") == 0;
    if (!to_stdout) {
        sl_sidecar_path(o->output, path, sizeof path);
        SL_TRY(sl_sidecar_text(atlas, &o->def, &text));
        SL_TRY(sl_writer_create(path, &sidecar, &diag));
        sl_writer_text(sidecar, text);
    }
    SL_TRY(sl_meshfile_write(o->output, file, atlas->input_corner_uv, &diag));
    if (!to_stdout) {
        status = sl_writer_commit(sidecar, &diag);
        sidecar = NULL;
    }
cleanup:
    sl_writer_abandon(sidecar);
    sl_free(text);
    return cli_fail(&o->run, status, &diag);
}

static double worst_stretch(const sl_segmentation *seg)
{
    double worst = 1.0;
    for (int32_t c = 0; c < seg->nchart; c++) {
        worst = fmax(worst, seg->chart[c].flat.distortion.l2);
    }
    return worst;
}

static void print_summary(unwrap_options *o, const sl_atlas *atlas)
{
    const sl_segmentation *seg = atlas->segmentation;
    const double seam = sl_atlas_seam_diagonals(atlas->mesh);
    if (o->run.json) {
        json_t *j =
            json_pack("{s:i, s:s, s:i, s:f, s:f, s:f, s:b, s:i, s:I, s:i, s:i}", "schema", 1, "output", o->output,
                      "charts", seg->nchart, "seamDiag", seam, "worstL2", worst_stretch(seg), "fill", atlas->pack.fill,
                      "certified", atlas->check.passed, "flipped", atlas->check.flipped, "overlapping_texels",
                      (json_int_t)atlas->check.overlapping_texels, "warnings", atlas->nwarning, "splits", seg->nsplit);
        json_object_set_new(j, "pages", json_integer(atlas->pack.pages));
        json_object_set_new(j, "texelsAUnit", json_real(atlas->texels_a_unit));
        json_object_set_new(j, "copies", json_integer(seg->sharing.copies));
        json_object_set_new(j, "axes", json_integer(seg->sharing.axes));
        json_object_set_new(j, "textureSaved", json_real(seg->sharing.area));
        json_dumpf(j, strcmp(o->output, "-") == 0 ? stderr : stdout, JSON_COMPACT | JSON_REAL_PRECISION(9));
        fputc('\n', strcmp(o->output, "-") == 0 ? stderr : stdout);
        json_decref(j);
        return;
    }
    cli_note(&o->run, "%d chart%s, seams %.2f diagonals, worst stretch L2 %.3f, fill %.2f, %s", seg->nchart,
             sl_plural(seg->nchart), seam, worst_stretch(seg), atlas->pack.fill,
             atlas->check.passed ? "no flip, no overlap: proven" : "uncertified: charts overlap");
    if (atlas->pack.pages > 1 || o->def.pack.density > 0.0) {
        cli_note(&o->run, "on %d page%s, %.4g texels a unit", atlas->pack.pages, sl_plural(atlas->pack.pages),
                 atlas->texels_a_unit);
    }
    if (seg->sharing.copies > 0) {
        cli_note(&o->run, "%d of them %s: %.0f %% of it is saved", seg->sharing.copies,
                 seg->sharing.copies == 1 ? "is a mirror image or copy that shares its texture"
                                          : "are mirror images or copies that share their texture",
                 100.0 * seg->sharing.area);
    }
}

static int deliver(unwrap_options *o, const sl_meshfile *file, const sl_atlas *atlas)
{
    char losses[256];
    const sl_atlas_check *check = &atlas->check;
    for (int32_t k = 0; k < atlas->nwarning; k++) {
        cli_note(&o->run, "warning: %s", atlas->warning[k].text);
    }
    if (!check->passed) {
        const bool written = o->allow_overlap && check->unlike == 0;
        fprintf(stderr,
                "seamlab unwrap: the atlas failed its own check and is %s: %d flipped, %d degenerate "
                "triangles, %d chart%s not proven free of overlap, %lld texels hit twice\n",
                written ? "written all the same, uncertified" : "not written", check->flipped, check->degenerate,
                check->uncertified_charts, sl_plural(check->uncertified_charts), (long long)check->overlapping_texels);
        if (!written) {
            return CLI_CHECK_FAILED;
        }
    }
    if (sl_meshfile_losses(file, o->output, losses, sizeof losses)) {
        cli_note(&o->run, "note: the output's format does not hold %s", losses);
    }
    cli_pictures pictures = {0};
    int code = o->preview != NULL ? cli_pictures_draw(&o->run, atlas, &pictures) : CLI_DONE;
    if (code == CLI_DONE) {
        code = write_atlas(o, file, atlas);
    }
    if (code == CLI_DONE && o->preview != NULL) {
        code = cli_pictures_write(&o->run, o->preview, &pictures);
    }
    cli_pictures_clear(&pictures);
    if (code == CLI_DONE) {
        print_summary(o, atlas);
    }
    return code == CLI_DONE && o->run.strict && atlas->nwarning > 0 ? CLI_INFEASIBLE : code;
}

int cli_unwrap(int argc, char **argv)
{
    unwrap_options o = {.run = {.verb = verb.name}, .pack = {.def = sl_pack_default()}, .def = sl_atlas_default()};
    cli_option options[ALL_OPTIONS];
    const char *files[1];
    int32_t file_count = 0, *owned = NULL;
    cli_segment_preset(&o.segment, CLI_PRESET_BEST, argc, argv);
    option_table(&o, options);
    int code = cli_parse(&verb, options, ALL_OPTIONS, argc, argv, 2, files, &file_count);
    if (code >= 0 || (code = check_options(&o)) >= 0 || (code = cli_begin(&o.run)) >= 0) {
        return code;
    }
    cli_segment_apply(&o.segment);
    cli_pack_apply(&o.pack);
    o.def.pack = o.pack.def;
    o.def.segment = o.segment.def;
    o.def.best = o.segment.best;
    o.def.optimize = o.segment.optimize;
    sl_diag diag = sl_diag_none();
    sl_meshfile *file = NULL;
    sl_atlas *atlas = NULL;
    sl_polygons polygons;
    code = cli_read_mesh(&o.run, files[0], &file);
    if (code == CLI_DONE) {
        code = read_seams(&o, file, &owned);
    }
    if (code == CLI_DONE) {
        sl_meshfile_polygons(file, &polygons);
        snprintf(diag.file, sizeof diag.file, "%s", files[0]);
        code = cli_fail(&o.run, sl_unwrap(&polygons, &o.def, &o.run.context, &atlas, &diag), &diag);
    }
    if (code == CLI_DONE) {
        code = deliver(&o, file, atlas);
    }
    sl_atlas_free(atlas);
    sl_meshfile_free(file);
    sl_free(owned);
    return cli_end(&o.run, code);
}
