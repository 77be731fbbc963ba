/* seamlab front: what can be had for what: charts and seams against stretch. */
#include "atlas/atlas.h"
#include "atlas/measure.h"
#include "base/file.h"
#include "base/memory.h"
#include "base/text.h"
#include "cli/cli.h"
#include "cli/segment_options.h"

#include <jansson.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { MOST_TARGETS = 32, MEASURE_RESOLUTION = 256 };

static const cli_verb verb = {
    .name = "front",
    .usage = "seamlab front MESH [--targets L2,L2,...] [-o PLOT.svg] [options]",
    .summary = "Says what is reachable: the fewest charts and shortest seams by search (--preset best) for each of\n"
               "several targets of stretch, as a table and a plot.",
    .examples = "  seamlab front model.obj\n"
                "  seamlab front model.obj --targets 1.1,1.02,1.005 -o front.svg\n"
                "  seamlab front model.obj --symmetry off --protect none --target-angle 1.1 --json\n",
    .min_files = 1,
    .max_files = 1,
};

/* What one target led to. */
typedef struct front_row {
    double target;
    int32_t charts, missed;
    double seam, l2, angle, fill;
    bool passed;
} front_row;

/* "1.1,1.05" into targets, falling; false: no such list. */
static bool parse_targets(const char *text, double *target, int32_t *count)
{
    *count = 0;
    while (*text != '\0') {
        const size_t length = strcspn(text, ",");
        const char *end = text + length;
        double value = 0.0;
        if (*count == MOST_TARGETS || sl_parse_double(text, end, &value) != end || length == 0 || !(value >= 1.0) ||
            !(value <= 1e6) || (*count > 0 && value >= target[*count - 1])) {
            return false;
        }
        target[(*count)++] = value;
        text = *end == ',' ? end + 1 : end;
    }
    return *count > 0;
}

static sl_status reach(cli_run *run, const sl_polygons *polygons, sl_atlas_def *def, double target, front_row *row,
                       sl_diag *diag)
{
    sl_status status = SL_OK;
    sl_atlas *atlas = NULL;
    sl_atlas_measure measure;
    sl_sharing_table table = {0};
    def->optimize.target_stretch = target;
    SL_TRY(sl_unwrap(polygons, def, &run->context, &atlas, diag));
    const sl_segmentation *seg = atlas->segmentation;
    table = (sl_sharing_table){polygons->nf, seg->nchart, seg->face_chart, sl_alloc(seg->nchart, sizeof(int32_t))};
    SL_TRY(table.copy_of != NULL ? SL_OK : SL_OUT_OF_MEMORY);
    for (int32_t c = 0; c < seg->nchart; c++) { /* an axis is a seam, though both its sides have the same UVs */
        table.copy_of[c] = seg->chart[c].copy_of;
    }
    SL_TRY(
        sl_measure_shared(polygons, atlas->input_corner_uv, &table, MEASURE_RESOLUTION, &run->context, &measure, diag));
    *row = (front_row){target,
                       atlas->segmentation->nchart,
                       atlas->optimized.missed,
                       measure.seam_length,
                       measure.global.l2,
                       measure.global.angle_mean,
                       measure.fill,
                       atlas->check.passed};
cleanup:
    sl_free(table.copy_of);
    sl_atlas_free(atlas);
    return status;
}

static void print_rows(const front_row *row, int32_t count)
{
    printf("%-10s %6s %12s %8s %12s %6s\n", "target L2", "charts", "seams/sqrtA", "L2", "mean s1/s2", "fill");
    for (int32_t k = 0; k < count; k++) {
        printf("%-10.4f %6d %12.3f %8.4f %12.3f %6.2f%s%s\n", row[k].target, row[k].charts, row[k].seam, row[k].l2,
               row[k].angle, row[k].fill, row[k].missed > 0 ? "  missed" : "", row[k].passed ? "" : "  not valid");
    }
}

static void print_json(const front_row *row, int32_t count)
{
    json_t *rows = json_array();
    for (int32_t k = 0; k < count; k++) {
        json_array_append_new(rows, json_pack("{s:f, s:i, s:f, s:f, s:f, s:f, s:b, s:b}", "target", row[k].target,
                                              "charts", (int)row[k].charts, "seam_length", row[k].seam, "l2", row[k].l2,
                                              "angle_mean", row[k].angle, "fill", row[k].fill, "reached",
                                              row[k].missed == 0, "passed", (int)row[k].passed));
    }
    json_t *all = json_pack("{s:i, s:o}", "schema", 1, "front", rows);
    json_dumpf(all, stdout, JSON_INDENT(2) | JSON_REAL_PRECISION(12));
    putchar('\n');
    json_decref(all);
}

static const double plot_width = 720.0, plot_height = 420.0, left = 70.0, right = 40.0, top = 20.0, bottom = 54.0;

static double x_of(double l2, double low, double high)
{
    const double at = log10(fmax(l2 - 1.0, 1e-6));
    return left + (at - low) / (high - low) * (plot_width - left - right);
}

static double y_of(double seam, double most)
{
    return plot_height - bottom - seam / most * (plot_height - top - bottom);
}

static void svg_axes(sl_writer *w, double low, double high, double most)
{
    sl_writer_format(w,
                     "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 %.0f %.0f\" font-family=\"system-ui, "
                     "sans-serif\" font-size=\"13\">\n<rect width=\"100%%\" height=\"100%%\" fill=\"#fff\"/>\n",
                     plot_width, plot_height);
    for (double decade = ceil(low); decade <= high; decade += 1.0) {
        const double x = left + (decade - low) / (high - low) * (plot_width - left - right);
        sl_writer_format(w,
                         "<path d=\"M%.1f %.1fV%.1f\" stroke=\"#e3e6ea\"/><text x=\"%.1f\" y=\"%.1f\" "
                         "text-anchor=\"middle\" fill=\"#333840\">1 + 10<tspan dy=\"-5\" font-size=\"10\">%.0f</tspan>"
                         "</text>\n",
                         x, top, plot_height - bottom, x, plot_height - bottom + 18.0, decade);
    }
    for (int k = 0; k <= 4; k++) {
        const double y = y_of(most * k / 4.0, most);
        sl_writer_format(w,
                         "<path d=\"M%.1f %.1fH%.1f\" stroke=\"#e3e6ea\"/><text x=\"%.1f\" y=\"%.1f\" "
                         "text-anchor=\"end\" fill=\"#333840\">%.1f</text>\n",
                         left, y, plot_width - right, left - 8.0, y + 4.0, most * k / 4.0);
    }
    sl_writer_format(w,
                     "<text x=\"%.1f\" y=\"%.1f\" text-anchor=\"middle\" fill=\"#333840\">L2 stretch</text>"
                     "<text transform=\"translate(18 %.1f) rotate(-90)\" text-anchor=\"middle\" fill=\"#333840\">seams "
                     "over the square root of the area</text>\n",
                     0.5 * (left + plot_width), plot_height - 12.0, 0.5 * plot_height);
}

static sl_status write_plot(const char *path, const front_row *row, int32_t count, sl_diag *diag)
{
    sl_writer *w = NULL;
    double low = HUGE_VAL, high = -HUGE_VAL, most = 0.0;
    for (int32_t k = 0; k < count; k++) {
        const double at = log10(fmax(row[k].l2 - 1.0, 1e-6));
        low = fmin(low, floor(at));
        high = fmax(high, ceil(at));
        most = fmax(most, 1.15 * row[k].seam);
    }
    high = fmax(high, low + 1.0);
    most = fmax(most, 1e-9);
    const sl_status status = sl_writer_create(path, &w, diag);
    if (status != SL_OK) {
        return status;
    }
    svg_axes(w, low, high, most);
    sl_writer_text(w, "<path fill=\"none\" stroke=\"#1a7f4b\" stroke-width=\"2\" d=\"");
    for (int32_t k = 0; k < count; k++) {
        sl_writer_format(w, "%s%.1f %.1f", k == 0 ? "M" : "L", x_of(row[k].l2, low, high), y_of(row[k].seam, most));
    }
    sl_writer_text(w, "\"/>\n");
    for (int32_t k = 0; k < count; k++) {
        const double x = x_of(row[k].l2, low, high), y = y_of(row[k].seam, most);
        sl_writer_format(w,
                         "<circle cx=\"%.1f\" cy=\"%.1f\" r=\"4.5\" fill=\"%s\"/><text x=\"%.1f\" y=\"%.1f\" "
                         "text-anchor=\"middle\" fill=\"#1c1e21\">%d chart%s</text>\n",
                         x, y, row[k].missed > 0 || !row[k].passed ? "#b3261e" : "#1a7f4b", x, y - 10.0,
                         (int)row[k].charts, sl_plural((int)row[k].charts));
    }
    sl_writer_text(w, "</svg>\n");
    return sl_writer_commit(w, diag);
}

static int walk_front(cli_run *run, const char *path, sl_atlas_def *def, const double *target, int32_t count,
                      const char *plot)
{
    sl_diag diag = sl_diag_none();
    sl_meshfile *file = NULL;
    sl_polygons polygons;
    front_row row[MOST_TARGETS];
    int code = cli_read_mesh(run, path, &file);
    if (code == CLI_DONE) {
        sl_meshfile_polygons(file, &polygons);
        for (int32_t k = 0; k < count && code == CLI_DONE; k++) {
            code = cli_fail(run, reach(run, &polygons, def, target[k], &row[k], &diag), &diag);
            if (code == CLI_DONE) {
                cli_note(run, "L2 %.4g: %d chart%s", target[k], (int)row[k].charts, sl_plural((int)row[k].charts));
            }
        }
    }
    if (code == CLI_DONE && run->json) {
        print_json(row, count);
    } else if (code == CLI_DONE) {
        print_rows(row, count);
    }
    if (code == CLI_DONE && plot != NULL) {
        code = cli_fail(run, write_plot(plot, row, count, &diag), &diag);
    }
    sl_meshfile_free(file);
    return code;
}

int cli_front(int argc, char **argv)
{
    enum { OWN = 2, ALL = OWN + CLI_SEGMENT_OPTIONS + CLI_COMMON_OPTIONS };
    cli_run run = {.verb = verb.name};
    cli_segment_options segment = {0};
    sl_atlas_def def = sl_atlas_default();
    const char *targets = "1.2,1.1,1.05,1.02,1.01,1.005", *plot = NULL, *files[1];
    double target[MOST_TARGETS];
    int32_t count = 0, file_count = 0;
    cli_option options[ALL] = {
        {"targets", 0, CLI_TEXT, &targets, 0, 0, NULL, "LIST", "L2 stretches, falling (1.2,1.1,1.05,1.02,1.01,1.005)"},
        {"output", 'o', CLI_TEXT, &plot, 0, 0, NULL, "PLOT.svg", "a plot of the front"},
    };
    cli_segment_preset(&segment, CLI_PRESET_BEST, argc, argv);
    cli_segment_table(&segment, options + OWN);
    cli_common_options(&run, options + OWN + CLI_SEGMENT_OPTIONS);
    int code = cli_parse(&verb, options, ALL, argc, argv, 2, files, &file_count);
    if (code >= 0) {
        return code;
    }
    if (!parse_targets(targets, target, &count)) {
        return cli_usage(verb.name, "--targets needs numbers of at least 1, each smaller than the one before, such as "
                                    "1.1,1.02");
    }
    if (plot != NULL && !cli_has_extension(plot, ".svg")) {
        return cli_usage(verb.name, "the plot is an SVG; name it so");
    }
    if ((code = cli_begin(&run)) >= 0) {
        return code;
    }
    cli_segment_apply(&segment);
    def.segment = segment.def;
    def.optimize = segment.optimize;
    def.best = true;
    return cli_end(&run, walk_front(&run, files[0], &def, target, count, plot));
}
