/* seamlab spectrum: eigenvalues, residuals, vectors, and which of them propose a cut. */
#include "spectral/spectrum.h"

#include "base/file.h"
#include "base/memory.h"
#include "cli/cli.h"
#include "mesh/topology.h"
#include "meshio/ply_export.h"

#include <jansson.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

static const cli_verb verb = {
    .name = "spectrum",
    .usage = "seamlab spectrum IN [--vectors N] [-o OUT.ply|OUT.csv] [options]",
    .summary = "The smallest eigenpairs of the facet graph's Laplacian D - A, and for each vector the\n"
               "cut between its positive and negative facets. The largest component is taken.",
    .examples = "  seamlab spectrum model.obj\n"
                "  seamlab spectrum model.obj --vectors 60 -o vectors.ply\n"
                "  seamlab spectrum model.obj -o vectors.csv --json\n"
                "  seamlab spectrum model.obj --bands --vectors 500 --tolerance 1e-10\n"
                "  seamlab spectrum model.obj --signs --memory-limit 2G\n",
    .min_files = 1,
    .max_files = 1,
};

typedef struct spectrum_options {
    cli_run run;
    sl_spectrum_def def;
    bool pair, signs;
    const char *output;
} spectrum_options;

/* Everything between the file and the printed table. */
typedef struct spectrum_work {
    sl_meshfile *file;
    sl_polygons polygons;
    sl_mesh *mesh;
    int32_t *faces, face_count, *partner;
    sl_facet_graph *graph;
    sl_spectrum *spectrum;
    sl_cut_candidate *candidate;
} spectrum_work;

static void work_clear(spectrum_work *w)
{
    sl_meshfile_free(w->file);
    sl_mesh_free(w->mesh);
    sl_free(w->faces);
    sl_free(w->partner);
    sl_facet_graph_free(w->graph);
    sl_spectrum_free(w->spectrum);
    sl_free(w->candidate);
}

/* Facets of the component with the most of them, ascending. */
static sl_status largest_component(spectrum_work *w)
{
    int32_t *label = sl_alloc(w->mesh->nf, sizeof *label), *size = NULL, count = 0, best = 0;
    sl_status status = label != NULL ? SL_OK : SL_OUT_OF_MEMORY;
    SL_TRY(status);
    SL_TRY(sl_mesh_components(w->mesh, label, &count));
    size = sl_calloc(count, sizeof *size);
    w->faces = sl_alloc(w->mesh->nf, sizeof *w->faces);
    if (size == NULL || w->faces == NULL) {
        status = SL_OUT_OF_MEMORY;
        goto cleanup;
    }
    for (int32_t f = 0; f < w->mesh->nf; f++) {
        size[label[f]]++;
    }
    for (int32_t c = 1; c < count; c++) {
        best = size[c] > size[best] ? c : best;
    }
    for (int32_t f = 0; f < w->mesh->nf; f++) {
        if (label[f] == best) {
            w->faces[w->face_count++] = f;
        }
    }
cleanup:
    sl_free(label);
    sl_free(size);
    return status;
}

/* In megabytes: limits are given so. */
static double megabytes(int64_t bytes)
{
    return (double)bytes / 0x1p20;
}

static sl_status solve(spectrum_work *w, const spectrum_options *o, sl_diag *diag)
{
    const sl_status status = sl_spectrum_solve(w->graph, &o->def, &o->run.context, &w->spectrum);
    if (status == SL_LIMIT) {
        sl_diag_reason(diag, "%d eigenpairs of %d nodes need more than the %.1f MB of --memory-limit", o->def.count,
                       w->graph->graph.n, megabytes(o->def.memory_limit));
        sl_diag_hint(diag, "ask for fewer --vectors, or for --signs only, or raise the limit");
    }
    return status;
}

static sl_status compute(spectrum_work *w, const spectrum_options *o, sl_diag *diag)
{
    double fraction = 0.0;
    sl_status status = SL_OK;
    sl_meshfile_polygons(w->file, &w->polygons);
    SL_TRY(sl_mesh_build(&w->polygons, &w->mesh, NULL, diag));
    SL_TRY(largest_component(w));
    if (o->pair) {
        w->partner = sl_alloc(w->mesh->nf, sizeof *w->partner);
        SL_TRY(w->partner != NULL ? SL_OK : SL_OUT_OF_MEMORY);
        SL_TRY(sl_pair_triangles(w->mesh, w->partner, &fraction));
    }
    SL_TRY(sl_facet_graph_create(w->mesh, w->faces, w->face_count, w->partner, &w->graph));
    SL_TRY(solve(w, o, diag));
    w->candidate = sl_calloc(w->spectrum->count, sizeof *w->candidate);
    SL_TRY(w->candidate != NULL ? SL_OK : SL_OUT_OF_MEMORY);
    if (w->spectrum->count > 0) {
        SL_TRY(sl_cut_candidates(w->mesh, w->graph, w->spectrum, w->candidate));
    }
cleanup:
    return status;
}

/* Value of vector k on facets[i]. */
static double vector_value(const spectrum_work *w, int32_t k, int32_t i)
{
    return w->spectrum->vectors[(int64_t)k * w->spectrum->n + w->graph->node[i]];
}

static sl_status write_csv(const spectrum_work *w, const char *path, sl_diag *diag)
{
    sl_writer *writer = NULL;
    const sl_status status = sl_writer_create(path, &writer, diag);
    if (status != SL_OK) {
        return status;
    }
    sl_writer_text(writer, "facet");
    for (int32_t k = 0; k < w->spectrum->count; k++) {
        sl_writer_format(writer, ",v%d", k);
    }
    for (int32_t i = 0; i < w->face_count; i++) {
        sl_writer_format(writer, "\n%d", w->faces[i]);
        for (int32_t k = 0; k < w->spectrum->count; k++) {
            sl_writer_text(writer, ",");
            sl_writer_double(writer, vector_value(w, k, i));
        }
    }
    sl_writer_text(writer, "\n");
    return sl_writer_commit(writer, diag);
}

static sl_status write_ply(const spectrum_work *w, const char *path, sl_diag *diag)
{
    const int32_t columns = w->spectrum->count;
    double *value = sl_alloc((int64_t)columns * w->polygons.nf, sizeof *value);
    const double **column = sl_alloc(columns, sizeof *column);
    char(*name)[16] = sl_alloc(columns, sizeof *name);
    const char **names = sl_alloc(columns, sizeof *names);
    sl_status status = SL_OUT_OF_MEMORY;
    if (value == NULL || column == NULL || name == NULL || names == NULL) {
        goto cleanup;
    }
    for (int64_t i = 0; i < (int64_t)columns * w->polygons.nf; i++) {
        value[i] = NAN; /* facets of other components */
    }
    for (int32_t k = 0; k < columns; k++) {
        double *v = value + (int64_t)k * w->polygons.nf;
        for (int32_t i = 0; i < w->face_count; i++) {
            v[w->faces[i]] = vector_value(w, k, i);
        }
        snprintf(name[k], sizeof name[k], "v%d", k);
        names[k] = name[k];
        column[k] = v;
    }
    status = sl_ply_write_values(path, &w->polygons, columns, names, column, diag);
cleanup:
    sl_free(value);
    sl_free(column);
    sl_free(name);
    sl_free(names);
    return status;
}

static void print_table(const spectrum_work *w)
{
    printf("vector  lambda          residual   F+ parts  F- parts  seam edges  seam length  passes\n");
    printf("%6d  %-14.8g  %8.2e\n", 0, w->spectrum->lambda[0], w->spectrum->residual[0]);
    const double extent = sl_mesh_diagonal(w->mesh), diagonal = extent > 0.0 ? extent : 1.0;
    for (int32_t k = 1; k < w->spectrum->count; k++) {
        const sl_cut_candidate *c = &w->candidate[k - 1];
        printf("%6d  %-14.8g  %8.2e  %8d  %8d  %10d  %11.4f  %s\n", k, w->spectrum->lambda[k], w->spectrum->residual[k],
               c->positive_parts, c->negative_parts, c->seam_edges, c->seam_length / diagonal,
               c->passes ? "yes" : "no");
    }
}

static void print_summary(const spectrum_work *w, cli_run *run)
{
    const sl_lanczos_info *info = &w->spectrum->info;
    cli_note(run, "%d pairs, %s, largest residual %.2e, %d solves, %.1f MB estimated", w->spectrum->count,
             info->certified ? "certified complete by inertia counts" : "not certified complete", info->max_residual,
             info->solves + info->skeleton_solves, megabytes(w->spectrum->memory));
}

static void print_json(const spectrum_work *w)
{
    json_t *list = json_array();
    const double extent = sl_mesh_diagonal(w->mesh), diagonal = extent > 0.0 ? extent : 1.0;
    for (int32_t k = 0; k < w->spectrum->count; k++) {
        json_t *row = json_pack("{s:i, s:f, s:f}", "vector", k, "lambda", w->spectrum->lambda[k], "residual",
                                w->spectrum->residual[k]);
        if (k > 0) {
            const sl_cut_candidate *c = &w->candidate[k - 1];
            json_object_set_new(row, "positive_parts", json_integer(c->positive_parts));
            json_object_set_new(row, "negative_parts", json_integer(c->negative_parts));
            json_object_set_new(row, "seam_edges", json_integer(c->seam_edges));
            json_object_set_new(row, "seamDiag", json_real(c->seam_length / diagonal));
            json_object_set_new(row, "passes", json_boolean(c->passes));
        }
        json_array_append_new(list, row);
    }
    const sl_lanczos_info *info = &w->spectrum->info;
    json_t *j = json_pack("{s:i, s:i, s:i, s:b, s:b, s:f, s:f, s:i, s:i, s:i, s:i, s:b, s:o}", "schema", 1, "facets",
                          w->face_count, "nodes", w->spectrum->n, "converged", info->converged, "certified",
                          info->certified, "max_residual", info->max_residual, "max_relative", info->max_relative,
                          "solves", info->solves + info->skeleton_solves, "block", info->block, "restarts",
                          info->restarts, "inertia_counts", info->counts, "dense", info->dense, "vectors", list);
    if (w->spectrum->bands.bands > 0) {
        json_object_set_new(j, "bands", json_integer(w->spectrum->bands.bands));
        json_object_set_new(j, "factors", json_integer(w->spectrum->bands.factors));
    }
    json_object_set_new(j, "memory_estimate", json_integer(w->spectrum->memory));
    json_dumpf(j, stdout, JSON_COMPACT | JSON_REAL_PRECISION(15));
    putchar('\n');
    json_decref(j);
}

enum { SPECTRUM_OPTIONS = 7 };

static void option_table(spectrum_options *o, cli_option *table)
{
    const cli_option own[SPECTRUM_OPTIONS] = {
        {"vectors", 0, CLI_INT, &o->def.count, 1, 10000, NULL, "N", "pairs, the constant vector included (30)"},
        {"output", 'o', CLI_TEXT, &o->output, 0, 0, NULL, "OUT", "vectors on the facets: .ply or .csv"},
        {"pair", 0, CLI_ON_OFF, &o->pair, 0, 0, NULL, NULL, "pair triangles back into quads (off)"},
        {"bands", 0, CLI_FLAG, &o->def.bands, 0, 0, NULL, NULL, "band by band, for hundreds of vectors"},
        {"tolerance", 0, CLI_REAL, &o->def.tolerance, 1e-14, 0.1, NULL, "TOL",
         "|L v - lambda v| over |L|_1, at most (1e-8)"},
        {"signs", 0, CLI_FLAG, &o->signs, 0, 0, NULL, NULL, "only as precise as the vectors' signs need, for cuts"},
        {"memory-limit", 0, CLI_SIZE, &o->def.memory_limit, 1, 0x1p60, NULL, "SIZE",
         "refuse (exit 6) what would need more, such as 2G"},
    };
    memcpy(table, own, sizeof own);
    cli_common_options(&o->run, table + SPECTRUM_OPTIONS);
}

int cli_spectrum(int argc, char **argv)
{
    spectrum_options o = {.run = {.verb = verb.name}, .def = sl_spectrum_default()};
    const char *files[1];
    int32_t file_count = 0;
    cli_option options[CLI_COMMON_OPTIONS + SPECTRUM_OPTIONS];
    option_table(&o, options);
    int code = cli_parse(&verb, options, (int32_t)SL_COUNTOF(options), argc, argv, 2, files, &file_count);
    if (code >= 0) {
        return code;
    }
    if (o.signs && o.def.bands) {
        return cli_usage(verb.name, "--signs and --bands exclude one another");
    }
    o.def.mode = o.signs ? SL_LANCZOS_SIGNS : SL_LANCZOS_TOLERANCE;
    const bool csv = o.output != NULL && cli_has_extension(o.output, ".csv");
    if (o.output != NULL && !csv && !cli_has_extension(o.output, ".ply")) {
        return cli_usage(verb.name, "-o writes .ply or .csv, not %s", o.output);
    }
    code = cli_begin(&o.run);
    if (code >= 0) {
        return code;
    }
    spectrum_work work = {0};
    sl_diag diag = sl_diag_none();
    code = cli_read_mesh(&o.run, files[0], &work.file);
    if (code == CLI_DONE) {
        code = cli_fail(&o.run, compute(&work, &o, &diag), &diag);
    }
    if (code == CLI_DONE && o.output != NULL) {
        const sl_status status = csv ? write_csv(&work, o.output, &diag) : write_ply(&work, o.output, &diag);
        code = cli_fail(&o.run, status, &diag);
    }
    if (code == CLI_DONE && o.run.json) {
        print_json(&work);
    } else if (code == CLI_DONE) {
        print_table(&work);
        print_summary(&work, &o.run);
    }
    if (code == CLI_DONE && !work.spectrum->info.converged) {
        cli_note(&o.run, "the solver stopped before every pair converged: %d of %d, largest residual %.2e",
                 work.spectrum->info.converged_count, o.def.count, work.spectrum->info.max_residual);
        code = CLI_INFEASIBLE;
    }
    work_clear(&work);
    return cli_end(&o.run, code);
}
