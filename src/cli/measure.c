/* seamlab measure: the columns by which atlases are compared. */
#include "atlas/sidecar.h"
#include "cli/cli.h"

#include <jansson.h>
#include <math.h>
#include <stdio.h>

static const cli_verb verb = {
    .name = "measure",
    .usage = "seamlab measure FILE... [--resolution N] [--json]",
    .summary = "Measures the UVs of any mesh: charts, seams, distortion, overlap, fill. Where a sidecar stands\n"
               "beside a file, charts that it says are shared do not count as overlap.",
    .examples = "  seamlab measure model-uv.obj\n  seamlab measure ours.obj theirs.obj --json\n",
    .min_files = 1,
    .max_files = CLI_MAX_FILES,
};

static void print_row(const char *name, const sl_atlas_measure *m)
{
    const sl_distortion *d = &m->global;
    printf("%s\n", name);
    printf("  triangles %d   charts %d (%d of at most 10 triangles)\n", m->triangles, m->charts, m->charts10);
    printf("  seams      %.4f of sqrt(area)   %.4f of the diagonal\n", m->seam_length, m->seam_diagonal);
    printf("  stretch    L2 %.4f   Linf %.4g   per chart: mean %.4f, worst %.4f (chart %d)\n", d->l2, d->linf,
           m->chart_l2_mean, m->chart_l2_worst, m->worst_chart);
    printf("  angle      s1/s2 mean %.4f   95 %% %.4f   max %.4g\n", d->angle_mean, d->angle_p95, d->angle_max);
    printf("  area       mean %.4f   max %.4g\n", d->area_mean, d->area_max);
    printf("  flipped %d   degenerate %d   overlap inside %.5f, across %.5f\n", d->flipped, d->degenerate,
           m->overlap_inside, m->overlap_across);
    if (m->copies > 0) {
        printf("  shared     %d charts are copies; they lie on %.5f of the texels covered, by intent\n", m->copies,
               m->shared);
    }
    printf("  fill       %.4f of the bounding square at %d^2\n", m->fill, m->resolution);
}

static json_t *number(double value)
{
    return isfinite(value) ? json_real(value) : json_null();
}

/* Column names are those of the comparison tables of other tools. */
static json_t *row_json(const char *name, const sl_atlas_measure *m)
{
    const sl_distortion *d = &m->global;
    json_t *j = json_pack("{s:i, s:s, s:i, s:i, s:i}", "schema", 1, "file", name, "tri", m->triangles, "charts",
                          m->charts, "charts10", m->charts10);
    json_object_set_new(j, "seamLen", number(m->seam_length));
    json_object_set_new(j, "seamDiag", number(m->seam_diagonal));
    json_object_set_new(j, "flip", json_integer(d->flipped));
    json_object_set_new(j, "deg", json_integer(d->degenerate));
    json_object_set_new(j, "ovIn", number(m->overlap_inside));
    json_object_set_new(j, "ovX", number(m->overlap_across));
    json_object_set_new(j, "copies", json_integer(m->copies));
    json_object_set_new(j, "shared", number(m->shared));
    json_object_set_new(j, "angMean", number(d->angle_mean));
    json_object_set_new(j, "ang95", number(d->angle_p95));
    json_object_set_new(j, "angMax", number(d->angle_max));
    json_object_set_new(j, "L2", number(d->l2));
    json_object_set_new(j, "Linf", number(d->linf));
    json_object_set_new(j, "areaMean", number(d->area_mean));
    json_object_set_new(j, "areaMax", number(d->area_max));
    json_object_set_new(j, "pack", number(m->fill));
    json_object_set_new(j, "chartL2Mean", number(m->chart_l2_mean));
    json_object_set_new(j, "chartL2Worst", number(m->chart_l2_worst));
    json_object_set_new(j, "worstChart", json_integer(m->worst_chart));
    return j;
}

/* What the sidecar beside the file says of shared charts; NULL without one, or where it is of another mesh. */
static const sl_sharing_table *read_sharing(cli_run *run, const char *path, int32_t nf, sl_sharing_table *table)
{
    char sidecar[4096];
    sl_diag diag = sl_diag_none();
    sl_sidecar_path(path, sidecar, sizeof sidecar);
    const sl_status status = sl_sidecar_read(sidecar, nf, table, &diag);
    if (status != SL_OK && status != SL_IO) {
        cli_note(run, "note: the sidecar is not used: %s", diag.reason);
    }
    return status == SL_OK ? table : NULL;
}

static int measure_file(cli_run *run, const char *path, int32_t resolution)
{
    sl_diag diag = sl_diag_none();
    sl_meshfile *file = NULL;
    sl_polygons polygons;
    sl_sharing_table table = {0};
    sl_atlas_measure m;
    int code = cli_read_mesh(run, path, &file);
    if (code != CLI_DONE) {
        return code;
    }
    if (file->corner_uv == NULL) {
        sl_diag_reason(&diag, "%s has no UVs to measure", path);
        sl_diag_hint(&diag, "seamlab unwrap makes some");
        code = cli_fail(run, SL_BAD_INPUT, &diag);
    } else {
        sl_meshfile_polygons(file, &polygons);
        snprintf(diag.file, sizeof diag.file, "%s", path);
        const sl_sharing_table *shared = read_sharing(run, path, polygons.nf, &table);
        code = cli_fail(
            run, sl_measure_shared(&polygons, file->corner_uv, shared, resolution, &run->context, &m, &diag), &diag);
    }
    sl_sharing_table_clear(&table);
    sl_meshfile_free(file);
    if (code == CLI_DONE && run->json) {
        json_t *j = row_json(path, &m);
        json_dumpf(j, stdout, JSON_COMPACT | JSON_REAL_PRECISION(9));
        putchar('\n');
        json_decref(j);
    } else if (code == CLI_DONE) {
        print_row(path, &m);
    }
    return code;
}

int cli_measure(int argc, char **argv)
{
    cli_run run = {.verb = verb.name};
    int32_t resolution = 2048, file_count = 0;
    const char *files[CLI_MAX_FILES];
    cli_option options[CLI_COMMON_OPTIONS + 1];
    cli_common_options(&run, options);
    options[CLI_COMMON_OPTIONS] = (cli_option){
        "resolution", 0, CLI_INT, &resolution, 1, 16384, NULL, "N", "texels a side for overlap and fill (2048)"};
    int code = cli_parse(&verb, options, (int32_t)SL_COUNTOF(options), argc, argv, 2, files, &file_count);
    if (code >= 0 || (code = cli_begin(&run)) >= 0) {
        return code;
    }
    code = CLI_DONE;
    for (int32_t k = 0; k < file_count && code == CLI_DONE; k++) {
        code = measure_file(&run, files[k], resolution);
    }
    return cli_end(&run, code);
}
