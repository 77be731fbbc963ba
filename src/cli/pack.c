/* seamlab pack: existing UVs packed anew. */
#include "atlas/repack.h"
#include "atlas/sidecar.h"
#include "base/file.h"
#include "base/text.h"
#include "cli/cli.h"
#include "cli/pack_options.h"

#include <jansson.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const cli_verb verb = {
    .name = "pack",
    .usage = "seamlab pack IN -o OUT [options]",
    .summary = "Packs the charts of any mesh with UVs anew, by their shapes: they are turned, nested in bays and\n"
               "holes, a margin apart, at one scale; their form stays. Charts that lie exactly on one another\n"
               "stay together. The result is checked: no chart overlaps another, all keep the margin.\n"
               "Page p of several is the UDIM tile 1001 + p.",
    .examples = "  seamlab pack model-uv.obj -o packed.obj\n"
                "  seamlab pack model-uv.obj -o packed.obj --resolution 1024 --margin 8 --effort 8\n"
                "  seamlab pack model-uv.obj -o tiles.obj --pages 4\n"
                "  seamlab pack model-uv.obj -o tiles.obj --density 512 --pages 100\n"
                "  seamlab pack model-uv.obj -o strip.obj --resolution 4096 --height 1024\n"
                "  seamlab pack model-uv.obj -o upright.obj --rotations none --up y\n",
    .min_files = 1,
    .max_files = 1,
};

enum { OWN_OPTIONS = 2, ALL_OPTIONS = OWN_OPTIONS + CLI_PACK_OPTIONS + CLI_COMMON_OPTIONS, DEFAULT_EFFORT = 6 };

typedef struct pack_options {
    cli_run run;
    cli_pack_options pack;
    sl_repack_def def;
    int32_t up;
    const char *output;
} pack_options;

static void option_table(pack_options *o, cli_option *table)
{
    const cli_option own[OWN_OPTIONS] = {
        {"output", 'o', CLI_TEXT, &o->output, 0, 0, NULL, "OUT", "OBJ or PLY to write"},
        {"up", 0, CLI_CHOICE, &o->up, 0, 0, "as-is|x|y|z", NULL,
         "where charts are not turned freely, this axis of space points up"},
    };
    memcpy(table, own, sizeof own);
    cli_pack_table(&o->pack, table + OWN_OPTIONS);
    cli_common_options(&o->run, table + OWN_OPTIONS + CLI_PACK_OPTIONS);
}

static json_t *options_json(const pack_options *o)
{
    static const char *const turns[] = {"free", "right", "none"}, *const axes[] = {"as-is", "x", "y", "z"};
    const sl_pack_def *p = &o->def.pack;
    return json_pack("{s:i, s:i, s:f, s:s, s:s, s:i, s:f, s:i}", "resolution", p->resolution, "height",
                     p->height > 0 ? p->height : p->resolution, "margin", p->margin, "rotations", turns[p->rotations],
                     "up", axes[o->up], "pages", p->pages, "density", p->density, "effort", p->effort);
}

static json_t *certificate_json(const sl_repacked *r)
{
    return json_pack("{s:b, s:f, s:i, s:i}", "passed", r->passed, "clearance", r->clearance, "overlapping_triangles",
                     r->red, "overlapping_inside_charts", r->red_inside);
}

/* What stands beside the output: read by measure, overlap and pack itself. */
static char *sidecar_text(const pack_options *o, const sl_repacked *r)
{
    json_t *charts = json_array(), *facets = json_array();
    for (int32_t c = 0; c < r->table.nchart; c++) {
        json_t *copy_of = r->table.copy_of[c] >= 0 ? json_integer(r->table.copy_of[c]) : json_null();
        json_array_append_new(charts, json_pack("{s:i, s:o}", "page", r->page[c], "copy_of", copy_of));
    }
    for (int32_t f = 0; f < r->table.nf; f++) {
        json_array_append_new(facets, json_integer(r->table.face_chart[f]));
    }
    json_t *j = json_pack("{s:s, s:i, s:s, s:o, s:o, s:f, s:f, s:i, s:f, s:o, s:o}", "format", "seamlab atlas",
                          "schema", SL_SIDECAR_SCHEMA, "made_by", "pack", "options", options_json(o), "certificate",
                          certificate_json(r), "scale", r->pack.scale, "fill", r->pack.fill, "pages", r->pack.pages,
                          "texels_a_unit", r->texels_a_unit, "charts", charts, "face_chart", facets);
    char *text = j != NULL ? json_dumps(j, JSON_COMPACT | JSON_REAL_PRECISION(15)) : NULL;
    json_decref(j);
    return text;
}

/* The sidecar is renamed into place after the mesh: neither is ever half there. */
static int write_output(pack_options *o, const sl_meshfile *file, const sl_repacked *r)
{
    sl_diag diag = sl_diag_none();
    char path[4096], *text = NULL;
    sl_writer *sidecar = NULL;
    sl_status status = SL_OK;
    const bool to_stdout = strcmp(o->output, "-") == 0;
    if (!to_stdout) {
        sl_sidecar_path(o->output, path, sizeof path);
        text = sidecar_text(o, r);
        SL_TRY(text != NULL ? SL_OK : SL_OUT_OF_MEMORY);
        SL_TRY(sl_writer_create(path, &sidecar, &diag));
        sl_writer_text(sidecar, text);
        sl_writer_text(sidecar, "\n");
    }
    SL_TRY(sl_meshfile_write(o->output, file, r->corner_uv, &diag));
    if (!to_stdout) {
        status = sl_writer_commit(sidecar, &diag);
        sidecar = NULL;
    }
cleanup:
    sl_writer_abandon(sidecar);
    free(text); /* jansson's */
    return cli_fail(&o->run, status, &diag);
}

static void print_summary(pack_options *o, const sl_repacked *r)
{
    if (o->run.json) {
        FILE *out = strcmp(o->output, "-") == 0 ? stderr : stdout;
        json_t *j = json_pack("{s:i, s:s, s:i, s:i, s:i, s:f, s:f, s:f, s:f, s:b}", "schema", 1, "output", o->output,
                              "charts", r->charts, "copies", r->copies, "pages", r->pack.pages, "fill", r->pack.fill,
                              "scale", r->pack.scale, "texelsAUnit", r->texels_a_unit, "clearance", r->clearance,
                              "certified", r->passed);
        json_dumpf(j, out, JSON_COMPACT | JSON_REAL_PRECISION(9));
        fputc('\n', out);
        json_decref(j);
        return;
    }
    cli_note(&o->run, "%d chart%s, %d of them %s, on %d page%s: fill %.3f, %.4g texels a unit; proven %g apart",
             r->charts, sl_plural(r->charts), r->copies, r->copies == 1 ? "a copy" : "copies", r->pack.pages,
             sl_plural(r->pack.pages), r->pack.fill, r->texels_a_unit, o->def.pack.margin);
}

static int deliver(pack_options *o, const sl_meshfile *file, const sl_repacked *r)
{
    char losses[256];
    if (!r->passed) {
        fprintf(stderr,
                "seamlab pack: the result failed its own check and is not written: %d triangles overlap others, %d of "
                "them inside their own chart; charts are %.6g texels apart\n",
                r->red, r->red_inside, r->clearance);
        return CLI_CHECK_FAILED;
    }
    if (r->red_inside > 0) {
        cli_note(&o->run, "note: %d triangles overlap others of their own chart, as they did before", r->red_inside);
    }
    if (sl_meshfile_losses(file, o->output, losses, sizeof losses)) {
        cli_note(&o->run, "note: the output's format does not hold %s", losses);
    }
    const int code = write_output(o, file, r);
    if (code == CLI_DONE) {
        print_summary(o, r);
    }
    return code;
}

static int pack_file(pack_options *o, const char *path)
{
    sl_diag diag = sl_diag_none();
    sl_meshfile *file = NULL;
    sl_polygons polygons;
    sl_sharing_table table = {0};
    sl_repacked repacked = {0};
    int code = cli_read_mesh(&o->run, path, &file);
    if (code != CLI_DONE) {
        return code;
    }
    snprintf(diag.file, sizeof diag.file, "%s", path);
    if (file->corner_uv == NULL) {
        sl_diag_reason(&diag, "there are no UVs to pack");
        sl_diag_hint(&diag, "seamlab unwrap makes some");
        code = cli_fail(&o->run, SL_BAD_INPUT, &diag);
    } else {
        sl_meshfile_polygons(file, &polygons);
        const sl_sharing_table *shared = cli_read_sharing(&o->run, path, polygons.nf, &table);
        code = cli_fail(
            &o->run, sl_repack(&polygons, file->corner_uv, shared, &o->def, &o->run.context, &repacked, &diag), &diag);
    }
    if (code == CLI_DONE) {
        code = deliver(o, file, &repacked);
    }
    sl_repacked_clear(&repacked);
    sl_sharing_table_clear(&table);
    sl_meshfile_free(file);
    return code;
}

int cli_pack(int argc, char **argv)
{
    pack_options o = {.run = {.verb = verb.name}, .pack = {.def = sl_pack_default()}, .def = sl_repack_default()};
    cli_option options[ALL_OPTIONS];
    const char *files[1];
    int32_t file_count = 0;
    o.pack.def.effort = DEFAULT_EFFORT;
    option_table(&o, options);
    int code = cli_parse(&verb, options, ALL_OPTIONS, argc, argv, 2, files, &file_count);
    if (code >= 0 || (code = cli_check_output(verb.name, o.output, true)) >= 0 || (code = cli_begin(&o.run)) >= 0) {
        return code;
    }
    cli_pack_apply(&o.pack);
    o.def.pack = o.pack.def;
    o.def.up = (sl_up_axis)o.up;
    code = pack_file(&o, files[0]);
    return cli_end(&o.run, code);
}
