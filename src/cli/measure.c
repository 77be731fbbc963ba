/* seamlab measure: the columns by which atlases are compared. */
#include "cli/measured.h"

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
    if (m->duplicate_facets + m->degenerate_facets > 0) {
        printf("  apart      %d duplicate and %d degenerate facets: neither charts nor seams\n", m->duplicate_facets,
               m->degenerate_facets);
    }
    printf("  seams      %.4f of sqrt(area)   %.4f of the diagonal\n", m->seam_length, m->seam_diagonal);
    printf("  stretch    L2 %.4f   Linf %.4g   per chart: mean %.4f, worst %.4f (chart %d)\n", d->l2, d->linf,
           m->chart_l2_mean, m->chart_l2_worst, m->worst_chart);
    printf("  angle      s1/s2 mean %.4f   95 %% %.4f   max %.4g\n", d->angle_mean, d->angle_p95, d->angle_max);
    printf("  area       mean %.4f   max %.4g\n", d->area_mean, d->area_max);
    printf("  flipped %d   degenerate %d   overlap inside %.5f, across %.5f\n", d->flipped, d->degenerate,
           m->overlap_inside, m->overlap_across);
    if (m->copies > 0) {
        printf("  shared     %d chart%s on %.5f of the texels covered, by intent\n", m->copies,
               m->copies == 1 ? " is a copy and lies" : "s are copies and lie", m->shared);
    }
    printf("  fill       %.4f of the bounding square at %d^2\n", m->fill, m->resolution);
}

static int measure_file(cli_run *run, const char *path, int32_t resolution)
{
    sl_atlas_measure m;
    const int code = cli_measure_path(run, path, resolution, &m);
    if (code == CLI_DONE && run->json) {
        json_t *j = cli_measure_json(path, &m);
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
