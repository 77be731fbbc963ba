/* seamlab check: the repair report. */
#include "cli/cli.h"

#include "atlas/sidecar.h"
#include "base/memory.h"
#include "base/text.h"
#include "mesh/build.h"

#include <jansson.h>
#include <stdio.h>
#include <stdlib.h>

static const cli_verb verb = {
    .name = "check",
    .usage = "seamlab check IN [--json] [--strict]",
    .summary = "Says what is wrong with a mesh and how seamlab repairs it while reading.",
    .examples = "  seamlab check model.obj\n  seamlab check scan.ply --json\n",
    .min_files = 1,
    .max_files = 1,
};

static bool needs_repair(const sl_repair_report *r)
{
    return r->nonmanifold_edges > 0 || r->bowtie_vertices > 0 || r->reversed_faces > 0 || r->one_sided_components > 0 ||
           r->duplicate_faces > 0 || r->degenerate_faces > 0;
}

static void print_list(const char *what, int32_t count, const int32_t *list, int32_t width)
{
    enum { SHOWN = 8 };
    if (count == 0) {
        return;
    }
    printf("%-28s %d:", what, count);
    for (int32_t k = 0; k < count && k < SHOWN; k++) {
        if (width == 2) {
            printf(" %d-%d", list[2 * k], list[2 * k + 1]);
        } else {
            printf(" %d", list[k]);
        }
    }
    printf("%s\n", count > SHOWN ? " ..." : "");
}

static void print_report(const sl_repair_report *r)
{
    printf("%-28s %d (%d unused)\n", "vertices", r->vertices, r->unused_vertices);
    printf("%-28s %d (%d triangles, %d quads, %d others)\n", "facets", r->faces, r->triangles, r->quads, r->ngons);
    printf("%-28s %d\n", "components", r->components);
    printf("%-28s %d\n", "border loops", r->border_loops);
    printf("%-28s %lld\n", "genus", (long long)r->genus);
    print_list("non-manifold edges, cut", r->nonmanifold_edges, r->nonmanifold, 2);
    print_list("bowtie vertices, split", r->bowtie_vertices, r->bowtie, 1);
    print_list("facets turned round", r->reversed_faces, r->reversed, 1);
    print_list("duplicate facets, isolated", r->duplicate_faces, r->duplicate, 1);
    print_list("facets without area, isolated", r->degenerate_faces, r->degenerate, 1);
    if (r->one_sided_components > 0) {
        printf("%-28s %d, cut along %d edges\n", "one-sided components", r->one_sided_components, r->one_sided_cuts);
    }
    printf("%s\n", needs_repair(r) ? "repaired while reading; the file is untouched" : "nothing to repair");
}

/* What the sidecar beside the file says of shared charts; false: there is none, or of another mesh. */
static bool count_copies(const char *path, int32_t nf, int32_t *charts, int32_t *copies)
{
    char sidecar[4096];
    sl_sharing_table table;
    sl_sidecar_path(path, sidecar, sizeof sidecar);
    *copies = 0;
    if (sl_sidecar_read(sidecar, nf, &table, NULL) != SL_OK) {
        return false;
    }
    *charts = table.nchart;
    for (int32_t c = 0; c < table.nchart; c++) {
        *copies += table.copy_of[c] >= 0;
    }
    sl_sharing_table_clear(&table);
    return true;
}

static json_t *integers(const int32_t *value, int32_t count)
{
    json_t *list = json_array();
    for (int32_t k = 0; k < count; k++) {
        json_array_append_new(list, json_integer(value[k]));
    }
    return list;
}

static void print_json(const sl_repair_report *r)
{
    json_t *j = json_pack("{s:i, s:i, s:i, s:i, s:i, s:i, s:i, s:i, s:i, s:I}", "schema", 1, "vertices", r->vertices,
                          "unused_vertices", r->unused_vertices, "facets", r->faces, "triangles", r->triangles, "quads",
                          r->quads, "ngons", r->ngons, "components", r->components, "border_loops", r->border_loops,
                          "genus", (json_int_t)r->genus);
    json_object_set_new(j, "isolated_facets", json_integer(r->isolated_faces));
    json_object_set_new(j, "nonmanifold_edges", integers(r->nonmanifold, 2 * r->nonmanifold_edges));
    json_object_set_new(j, "bowtie_vertices", integers(r->bowtie, r->bowtie_vertices));
    json_object_set_new(j, "reversed_facets", integers(r->reversed, r->reversed_faces));
    json_object_set_new(j, "duplicate_facets", integers(r->duplicate, r->duplicate_faces));
    json_object_set_new(j, "degenerate_facets", integers(r->degenerate, r->degenerate_faces));
    json_object_set_new(j, "one_sided_components", json_integer(r->one_sided_components));
    json_object_set_new(j, "one_sided_cuts", json_integer(r->one_sided_cuts));
    json_dumpf(j, stdout, JSON_COMPACT);
    putchar('\n');
    json_decref(j);
}

int cli_check(int argc, char **argv)
{
    cli_run run = {.verb = verb.name};
    cli_option options[CLI_COMMON_OPTIONS + 1];
    cli_common_options(&run, options);
    options[CLI_COMMON_OPTIONS] =
        (cli_option){"strict", 0, CLI_FLAG, &run.strict, 0, 0, NULL, NULL, "exit 4 when there is something to repair"};
    const char *files[1];
    int32_t file_count = 0;
    int code = cli_parse(&verb, options, (int32_t)SL_COUNTOF(options), argc, argv, 2, files, &file_count);
    if (code >= 0 || (code = cli_begin(&run)) >= 0) {
        return code;
    }
    sl_diag diag = sl_diag_none();
    sl_meshfile *file = NULL;
    sl_mesh *mesh = NULL;
    sl_repair_report report = {0};
    sl_polygons polygons;
    code = cli_read_mesh(&run, files[0], &file);
    if (code == CLI_DONE) {
        sl_meshfile_polygons(file, &polygons);
        code = cli_fail(&run, sl_mesh_build(&polygons, &mesh, &report, &diag), &diag);
    }
    if (code == CLI_DONE) {
        int32_t charts, copies;
        if (run.json) {
            print_json(&report);
        } else {
            print_report(&report);
        }
        if (!run.json && count_copies(files[0], polygons.nf, &charts, &copies)) {
            printf("%-28s %d chart%s, %d of them %s\n", "by its sidecar", charts, sl_plural(charts), copies,
                   copies == 1 ? "a copy that shares its texture" : "copies that share their texture");
        }
        code = run.strict && needs_repair(&report) ? CLI_INFEASIBLE : CLI_DONE;
    }
    sl_mesh_free(mesh);
    sl_repair_report_clear(&report);
    sl_meshfile_free(file);
    return cli_end(&run, code);
}
