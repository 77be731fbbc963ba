/* seamlab theorem: does the symmetric-graph theorem hold, as far as numbers can say? */
#include "base/memory.h"
#include "cli/cli.h"
#include "cli/theorem_report.h"
#include "generators.h"
#include "mesh/facet_graph.h"
#include "theorem/meshes.h"

#include <inttypes.h>
#include <stdio.h>
#include <string.h>

static const cli_verb verb = {
    .name = "theorem",
    .usage = "seamlab theorem [--graphs N] [--seed S] [--mesh FILE...] [--graph FILE] [--json|--tap]",
    .summary = "Checks the theorem on symmetric graphs (paper, Appendix A; reports/design/symmetry-theorem.md),\n"
               "statement by statement: on random graphs of twelve families (whole spectra up to 192 nodes, the\n"
               "lowest 30 pairs of one graph in a hundred, up to 4096 nodes) and generated meshes, or on the\n"
               "files named. A graph that violates one is written to theorem-SEED-INDEX.graph. Exit 0: holds;\n"
               "5: violated, or over 0.1 % of the signs undecided, but for one vector's; 3: bad input.\n\n"
               "A graph file: 'seamlab-theorem-graph 1', 'pairs N', 'fixed M', 'edges E', E lines 'A B', 'end';\n"
               "the mirror exchanges nodes i and i + N for i < N and fixes nodes 2N and up; '#' begins a comment.",
    .examples = "  seamlab theorem\n"
                "  seamlab theorem --tap --seed 2026\n"
                "  seamlab theorem --mesh model.obj other.ply --json\n"
                "  seamlab theorem --graph theorem-1-17.graph\n",
    .min_files = 0,
    .max_files = CLI_MAX_FILES,
};

/* Involutions checked on a mesh's component. */
enum { MOST_MIRRORS = 4, DEFAULT_GRAPHS = 10000 };

/* Generated meshes beyond this many facets are left to --mesh: the default run is to stay under a minute. */
enum { MOST_FACETS = 20000 };

/* Triangles are paired back into quads where this share of them pairs well (as `--pair auto` does). */
static const double pair_share = 0.9;

typedef struct theorem_options {
    cli_run run;
    int32_t graphs; /* -1: as many as usual, none where files are named */
    int32_t seed, sabotage;
    bool tap, mesh;
    const char *graph;
    const char *files[CLI_MAX_FILES];
    int32_t file_count;
} theorem_options;

static sl_status add_row(theorem_report *report, const char *name, theorem_row **row)
{
    void *grown = sl_realloc(report->row, (int64_t)report->count + 1, sizeof *report->row);
    if (grown == NULL) {
        return SL_OUT_OF_MEMORY;
    }
    report->row = grown;
    *row = &report->row[report->count++];
    **row = (theorem_row){.result = {.failed = SL_THEOREM_STATEMENTS, .lowest_index = -1}};
    snprintf((*row)->name, sizeof(*row)->name, "%s", name);
    return SL_OK;
}

/* The graph of an index into a file that --graph reads. */
static sl_status write_replay(const sl_theorem_run_def *def, int32_t index, const char *reason, char *path, size_t size,
                              sl_diag *diag)
{
    sl_theorem_graph *graph = NULL;
    int32_t family, families;
    char comment[280];
    sl_status status = SL_OK;
    SL_TRY(sl_theorem_graph_of(def, index, &family, &graph));
    snprintf(path, size, "theorem-%" PRIu64 "-%d.graph", def->seed, index);
    snprintf(comment, sizeof comment, "family %s, seed %" PRIu64 ", graph %d: %s",
             sl_theorem_families(&families)[family].name, def->seed, index, reason);
    status = sl_theorem_graph_write(path, graph, comment, diag);
cleanup:
    sl_theorem_graph_free(graph);
    return status;
}

static sl_status run_families(theorem_options *o, theorem_report *report, sl_diag *diag)
{
    sl_theorem_run_def def = sl_theorem_run_default();
    sl_theorem_run *run = NULL;
    theorem_row *row;
    int32_t families;
    const sl_theorem_family *family = sl_theorem_families(&families);
    sl_status status = SL_OK;
    def.graphs = o->graphs;
    def.seed = (uint64_t)o->seed;
    def.check.sabotage = (sl_theorem_break)o->sabotage;
    SL_TRY(sl_theorem_run_all(&def, &o->run.context, &run));
    for (int32_t k = 0; k < families; k++) {
        SL_TRY(add_row(report, family[k].name, &row));
        row->built_in = true;
        row->result = run->family[k];
        row->skipped = run->family[k].graphs == 0 ? "no graph of this family among so few" : NULL;
    }
    SL_TRY(add_row(report, "figure-17", &row));
    row->built_in = true;
    SL_TRY(sl_theorem_check_figure17(&row->result));
    if (run->violated >= 0) {
        SL_TRY(write_replay(&def, run->violated, run->evidence.reason, report->replay, sizeof report->replay, diag));
    }
cleanup:
    sl_theorem_run_free(run);
    return status;
}

/* A mesh's mirrors: in one row, or in one each. */
static sl_status add_mirrors(theorem_report *report, const char *name, bool built_in, const sl_theorem_mesh *checked)
{
    static const char *const kind[] = {"exact", "near", "topological"};
    theorem_row *row;
    char text[280];
    if (built_in || checked->count == 0) {
        const sl_status status = add_row(report, name, &row);
        if (status == SL_OK) {
            row->built_in = built_in;
            row->result = checked->total;
            row->skipped = checked->count == 0 ? "no mirror" : NULL;
        }
        return status;
    }
    for (int32_t k = 0; k < checked->count; k++) {
        const sl_theorem_mirror *m = &checked->mirror[k];
        snprintf(text, sizeof text, "%.200s %d: %s %s", name, k + 1, kind[m->kind],
                 m->mirror ? "mirror" : "involution");
        const sl_status status = add_row(report, text, &row);
        if (status != SL_OK) {
            return status;
        }
        row->result = m->result;
    }
    return SL_OK;
}

static sl_status run_mesh(theorem_options *o, const sl_polygons *polygons, const char *name, bool built_in,
                          theorem_report *report, sl_diag *diag)
{
    const sl_theorem_def def = sl_theorem_default();
    sl_mesh *mesh = NULL;
    sl_theorem_mesh *checked = NULL;
    double share = 0.0;
    int32_t *partner = NULL;
    sl_status status = SL_OK;
    SL_TRY(sl_mesh_build(polygons, &mesh, NULL, diag));
    partner = sl_alloc(mesh->nf, sizeof *partner);
    SL_TRY(partner != NULL ? SL_OK : SL_OUT_OF_MEMORY);
    SL_TRY(sl_pair_triangles(mesh, partner, &share));
    SL_TRY(sl_theorem_check_mesh(mesh, share >= pair_share ? partner : NULL, MOST_MIRRORS, &def, &o->run.context,
                                 &checked));
    SL_TRY(add_mirrors(report, name, built_in, checked));
    if (checked->left_out > 0 && !built_in) {
        cli_note(&o->run, "%s: %d of its %d involutions are checked", name, checked->count,
                 checked->count + checked->left_out);
    }
cleanup:
    sl_theorem_mesh_free(checked);
    sl_free(partner);
    sl_mesh_free(mesh);
    return status;
}

static bool has_involution(const sl_generated *mesh)
{
    bool any = false;
    for (int32_t k = 0; k < mesh->nplanted; k++) {
        any = any || mesh->planted[k].mirror;
    }
    return any;
}

static sl_status run_generated(theorem_options *o, theorem_report *report, sl_diag *diag)
{
    int32_t count = 0;
    const sl_generator *generator = sl_generators(&count);
    for (int32_t k = 0; k < count; k++) {
        sl_generated *mesh = NULL;
        char name[96];
        snprintf(name, sizeof name, "mesh %s", generator[k].name);
        sl_status status = generator[k].make(1, 1, &mesh);
        if (status == SL_OK && has_involution(mesh) && mesh->nf <= MOST_FACETS) {
            sl_polygons polygons;
            sl_generated_polygons(mesh, &polygons);
            status = run_mesh(o, &polygons, name, true, report, diag);
        }
        sl_generated_free(mesh);
        if (status != SL_OK) {
            return status;
        }
    }
    return SL_OK;
}

/* The files named. Returns an exit code. */
static int run_files(theorem_options *o, theorem_report *report)
{
    for (int32_t k = 0; k < o->file_count; k++) {
        sl_meshfile *file = NULL;
        sl_polygons polygons;
        sl_diag diag = sl_diag_none();
        int code = cli_read_mesh(&o->run, o->files[k], &file);
        if (code == CLI_DONE) {
            snprintf(diag.file, sizeof diag.file, "%s", o->files[k]);
            sl_meshfile_polygons(file, &polygons);
            code = cli_fail(&o->run, run_mesh(o, &polygons, o->files[k], false, report, &diag), &diag);
        }
        sl_meshfile_free(file);
        if (code != CLI_DONE) {
            return code;
        }
    }
    return CLI_DONE;
}

static int run_graph(theorem_options *o, theorem_report *report)
{
    sl_theorem_def def = sl_theorem_default();
    sl_theorem_graph *graph = NULL;
    sl_diag diag = sl_diag_none();
    theorem_row *row;
    sl_status status = sl_theorem_graph_read(o->graph, &graph, &diag);
    if (status != SL_OK) {
        const int code = cli_fail(&o->run, status, &diag);
        return status == SL_IO ? CLI_BAD_INPUT : code;
    }
    def.sabotage = (sl_theorem_break)o->sabotage;
    SL_TRY(add_row(report, o->graph, &row));
    SL_TRY(sl_theorem_check(graph, &def, &o->run.context, &row->result));
cleanup:
    sl_theorem_graph_free(graph);
    return cli_fail(&o->run, status, &diag);
}

static int run_all(theorem_options *o, theorem_report *report)
{
    sl_diag diag = sl_diag_none();
    const bool usual = o->graphs < 0 && o->file_count == 0 && o->graph == NULL;
    int code = CLI_DONE;
    o->graphs = o->graphs >= 0 ? o->graphs : usual ? DEFAULT_GRAPHS : 0;
    if (o->graph != NULL) {
        code = run_graph(o, report);
    }
    if (code == CLI_DONE && o->graphs > 0) {
        code = cli_fail(&o->run, run_families(o, report, &diag), &diag);
    }
    if (code == CLI_DONE && usual) {
        code = cli_fail(&o->run, run_generated(o, report, &diag), &diag);
    }
    return code == CLI_DONE ? run_files(o, report) : code;
}

int cli_theorem(int argc, char **argv)
{
    theorem_options o = {.run = {.verb = verb.name}, .graphs = -1, .seed = 1};
    cli_option options[CLI_COMMON_OPTIONS + 6] = {
        {"graphs", 0, CLI_INT, &o.graphs, 0, 10000000, NULL, "N", "random graphs (10000; none where files are named)"},
        {"seed", 0, CLI_INT, &o.seed, 0, 2147483647, NULL, "S", "of the random graphs (1)"},
        {"mesh", 0, CLI_FLAG, &o.mesh, 0, 0, NULL, NULL, "the files that follow are meshes; their mirrors are checked"},
        {"graph", 0, CLI_TEXT, &o.graph, 0, 0, NULL, "FILE", "check the graph in a file"},
        {"tap", 0, CLI_FLAG, &o.tap, 0, 0, NULL, NULL, "TAP version 13 on stdout, a line a family and statement"},
        {"break", 0, CLI_CHOICE, &o.sabotage, 0, 0, "nothing|graph|vector|sign", NULL,
         "break the first graph's symmetry, a solver's vector or a sign, to see the check fail"},
    };
    theorem_report report = {.undecided_share = sl_theorem_run_default().undecided_share};
    cli_common_options(&o.run, options + 6);
    int code = cli_parse(&verb, options, (int32_t)SL_COUNTOF(options), argc, argv, 2, o.files, &o.file_count);
    if (code >= 0) {
        return code;
    }
    if (o.mesh && o.file_count == 0) {
        return cli_usage(verb.name, "--mesh needs a file");
    }
    if (o.tap && o.run.json) {
        return cli_usage(verb.name, "--tap and --json exclude one another");
    }
    code = cli_begin(&o.run);
    if (code >= 0) {
        return code;
    }
    report.seed = (uint64_t)o.seed;
    code = run_all(&o, &report);
    if (code == CLI_DONE) {
        theorem_report_close(&report);
        if (o.tap) {
            theorem_print_tap(&report);
        } else if (o.run.json) {
            theorem_print_json(&report);
        } else {
            theorem_print_table(&report);
        }
        code = report.violated || !report.decided ? CLI_CHECK_FAILED : CLI_DONE;
    }
    sl_free(report.row);
    return cli_end(&o.run, code);
}
