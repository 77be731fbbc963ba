/* Figure 8: segmentations of all meshes at hand, by the default and by the paper's settings. */
#include "support/main.h"
#include "support/pictures.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

enum { PAIR_WIDTH = 900, PAIR_HEIGHT = 420, PAPER_WIDTH = 560, PAPER_HEIGHT = 262 };

/* What --quick runs: some of every kind, and those that expected.csv names. */
static const char *const quick_set[] = {"hand",  "body", "octopus", "airplane", "sphere",
                                        "torus", "box",  "bracket", "mug"};

/* The numbers of one atlas. */
typedef struct atlas_row {
    int32_t facets, charts, splits, invalid;
    double seam, l2_mean, l2_worst, l2_unwarned, angle, fill, seconds;
    bool passed;
} atlas_row;

/* One of the two ways every mesh is cut. */
typedef struct preset {
    const char *name;
    sl_atlas_def def;
    int32_t width, height;
} preset;

static bool warned(const sl_atlas *atlas, int32_t chart)
{
    for (int32_t k = 0; k < atlas->nwarning; k++) {
        if (atlas->warning[k].chart == chart) {
            return true;
        }
    }
    return false;
}

static atlas_row row_of(const sl_atlas *atlas, double seconds)
{
    const sl_segmentation *seg = atlas->segmentation;
    atlas_row row = {.facets = atlas->mesh->nf, .charts = seg->nchart, .splits = seg->nsplit, .seconds = seconds};
    double area = 0.0;
    int32_t measured = 0;
    row.passed = atlas->check.passed;
    row.fill = atlas->pack.fill;
    row.seam = sl_atlas_seam_length(atlas->mesh) / sl_mesh_diagonal(atlas->mesh);
    for (int32_t c = 0; c < seg->nchart; c++) {
        const sl_flatten_result *flat = &seg->chart[c].flat;
        row.invalid += flat->verdict != SL_CHART_VALID;
        if (flat->distortion.measured > 0 && isfinite(flat->distortion.l2)) {
            row.l2_mean += flat->distortion.l2;
            row.l2_worst = fmax(row.l2_worst, flat->distortion.l2);
            row.l2_unwarned = fmax(row.l2_unwarned, warned(atlas, c) ? 0.0 : flat->distortion.l2);
            row.angle += flat->distortion.area_3d * flat->distortion.angle_mean;
            area += flat->distortion.area_3d;
            measured++;
        }
    }
    row.l2_mean = measured > 0 ? row.l2_mean / measured : 0.0;
    row.angle = area > 0.0 ? row.angle / area : 0.0;
    return row;
}

static int32_t facets_without_chart(const sl_atlas *atlas)
{
    int32_t lost = 0;
    for (int32_t f = 0; f < atlas->mesh->nf; f++) {
        const int32_t c = atlas->segmentation->face_chart[f];
        lost += c < 0 || c >= atlas->segmentation->nchart;
    }
    return lost;
}

/* Those that --quick leaves out are taken from the list. */
static int32_t keep_quick_ones(exp_source *source, int32_t count)
{
    int32_t kept = 0;
    for (int32_t k = 0; k < count; k++) {
        bool listed = false;
        for (size_t i = 0; source[k].generated && i < SL_COUNTOF(quick_set); i++) {
            listed = listed || strcmp(quick_set[i], source[k].name) == 0;
        }
        if (listed) {
            source[kept++] = source[k];
        }
    }
    return kept;
}

/* Unwraps, draws, measures. */
static sl_status make_atlas(exp_run *run, const exp_source *source, const sl_polygons *polygons, const preset *p,
                            exp_claims *claims, atlas_row *row, char *file, size_t size)
{
    sl_status status = SL_OK;
    sl_atlas *atlas = NULL;
    const sl_view view = exp_view_of(source->name);
    const sl_picture picture = exp_picture(run, p->width, p->height);
    const bool paper = p->def.segment.rule == SL_RULE_LONGEST;
    snprintf(file, size, "%s%s-%s.png", source->generated ? "" : "corpus-", source->name, p->name);
    const double start = exp_cpu_seconds();
    SL_TRY(sl_unwrap(polygons, &p->def, &run->context, &atlas, &run->diag));
    *row = row_of(atlas, exp_cpu_seconds() - start);
    SL_TRY(exp_draw_atlas(run, atlas, &view, &picture, file));
    if (paper) {
        exp_claims_measure(claims, source->name, "invalid charts (paper preset)", row->invalid);
    } else {
        exp_claims_measure(claims, source->name, "check passed", row->passed);
        exp_claims_measure(claims, source->name, "flipped triangles", atlas->check.flipped);
        exp_claims_measure(claims, source->name, "worst L2 of charts without a warning", row->l2_unwarned);
        exp_claims_measure(claims, source->name, "facets without a chart", facets_without_chart(atlas));
        exp_claims_measure(claims, source->name, "fill of the page", row->fill);
        if (source->generated) {
            exp_claims_measure(claims, source->name, "charts", row->charts);
        }
    }
cleanup:
    sl_atlas_free(atlas);
    return status;
}

static void figure(exp_page *page, const exp_source *source, const preset *p, const atlas_row *row, const char *file)
{
    char alt[160], caption[320];
    snprintf(alt, sizeof alt, "%s cut into %d charts, its atlas beside it", source->name, row->charts);
    snprintf(caption, sizeof caption, "<b>%s</b>%s, %s: %d charts, seams %.2f diagonals, L2 %.3f, worst %.3f",
             source->name, source->generated ? "" : " (corpus)", p->name, row->charts, row->seam, row->l2_mean,
             row->l2_worst);
    exp_page_figure(page, row->passed ? "" : "no", file, alt, caption);
}

static void table_row(exp_page *page, const exp_source *source, const preset *p, const atlas_row *row)
{
    exp_page_row_begin(page, !row->passed);
    exp_page_cell(page, "%s", source->name);
    exp_page_cell(page, "%s", p->name);
    exp_page_cell(page, "%d", row->facets);
    exp_page_cell(page, "%d", row->charts);
    exp_page_cell(page, "%.2f", row->seam);
    exp_page_cell(page, "%.3f", row->l2_mean);
    exp_page_cell(page, "%.3f", row->l2_worst);
    exp_page_cell(page, "%.3f", row->angle);
    exp_page_cell(page, "%.3f", row->fill);
    exp_page_cell(page, "%d", row->splits);
    exp_page_row_end(page);
}

/* Results of everything, for the tables after the pictures. */
typedef struct results {
    int32_t count;
    exp_source *source;
    atlas_row (*row)[2];
} results;

static sl_status write_csvs(exp_run *run, const results *r, const preset presets[2])
{
    sl_status status = SL_OK;
    sl_writer *numbers = NULL, *timings = NULL;
    char path[EXP_PATH];
    SL_TRY(exp_path(run, "segmentations.csv", path));
    SL_TRY(sl_writer_create(path, &numbers, &run->diag));
    SL_TRY(exp_path(run, "timings.csv", path));
    SL_TRY(sl_writer_create(path, &timings, &run->diag));
    sl_writer_text(numbers, "mesh,preset,facets,charts,seam_over_diagonal,l2_mean,l2_worst,angle_mean,fill,splits\n");
    sl_writer_text(timings, "mesh,preset,cpu_seconds\n");
    for (int32_t k = 0; k < 2 * r->count; k++) {
        const atlas_row *row = &r->row[k / 2][k % 2];
        const double number[] = {row->seam, row->l2_mean, row->l2_worst, row->angle, row->fill};
        sl_writer_format(numbers, "%s,%s,%d,%d", r->source[k / 2].name, presets[k % 2].name, row->facets, row->charts);
        for (size_t i = 0; i < SL_COUNTOF(number); i++) {
            sl_writer_text(numbers, ",");
            sl_writer_double(numbers, number[i]);
        }
        sl_writer_format(numbers, ",%d\n", row->splits);
        sl_writer_format(timings, "%s,%s,%.3f\n", r->source[k / 2].name, presets[k % 2].name, row->seconds);
    }
    status = sl_writer_commit(numbers, &run->diag);
    numbers = NULL;
    if (status == SL_OK) {
        status = sl_writer_commit(timings, &run->diag);
        timings = NULL;
    }
cleanup:
    sl_writer_abandon(numbers);
    sl_writer_abandon(timings);
    return status;
}

static void introduce(exp_page *page)
{
    exp_page_html(
        page,
        "<p>The paper's Figure 8 shows segmentations of some of 36 models, not public either. Here: every "
        "generated mesh, and every mesh of the corpus folder where one is given (a few with <code>--quick</code>). "
        "The large picture is the "
        "default (lookahead, loops joined, cuts smoothed, neighbours sewn while they stay valid); the small one "
        "is the paper as printed (longest seam, nothing after it). Charts have one colour on the model and in the "
        "atlas; the checkerboard is the same on both. L2 is Sander's stretch per chart, 1 = isometric; "
        "&sigma;<sub>1</sub>/&sigma;<sub>2</sub> the mean angular distortion; seams are divided by the bounding "
        "box's diagonal.</p>\n");
}

static void tables(exp_page *page, const results *r, const preset presets[2])
{
    exp_page_table_begin(
        page, "mesh|preset|facets|charts|seam|L2 mean|worst|&sigma;<sub>1</sub>/&sigma;<sub>2</sub>|fill|splits");
    for (int32_t k = 0; k < 2 * r->count; k++) {
        table_row(page, &r->source[k / 2], &presets[k % 2], &r->row[k / 2][k % 2]);
    }
    exp_page_table_end(page);
}

static sl_status show_mesh(exp_run *run, exp_page *page, exp_claims *claims, const exp_source *source,
                           const preset presets[2], atlas_row row[2])
{
    sl_status status = SL_OK;
    exp_mesh mesh;
    char file[128];
    SL_TRY(exp_mesh_load(source, &mesh, &run->diag));
    exp_page_html(page, "<div class=\"duo\">\n");
    for (int k = 0; k < 2; k++) {
        SL_TRY(make_atlas(run, source, &mesh.polygons, &presets[k], claims, &row[k], file, sizeof file));
        figure(page, source, &presets[k], &row[k], file);
    }
    exp_page_html(page, "</div>\n");
    fprintf(stderr, "%s: %d charts, %.1f s; as the paper: %d charts, %.1f s\n", source->name, row[0].charts,
            row[0].seconds, row[1].charts, row[1].seconds);
cleanup:
    exp_mesh_clear(&mesh);
    return status;
}

static sl_status show_all(exp_run *run, exp_page *page, exp_claims *claims)
{
    sl_status status = SL_OK;
    preset presets[2] = {{"default", sl_atlas_default(), PAIR_WIDTH, PAIR_HEIGHT},
                         {"paper", sl_atlas_default(), PAPER_WIDTH, PAPER_HEIGHT}};
    results r = {.source = sl_alloc(EXP_MAX_MESHES, sizeof *r.source), .row = sl_calloc(EXP_MAX_MESHES, sizeof *r.row)};
    presets[1].def.segment = sl_segment_paper();
    if (r.source == NULL || r.row == NULL) {
        SL_TRY(SL_OUT_OF_MEMORY);
    }
    r.count = exp_list_sources(run, r.source);
    r.count = run->quick ? keep_quick_ones(r.source, r.count) : r.count;
    introduce(page);
    for (int32_t k = 0; k < r.count; k++) {
        SL_TRY(show_mesh(run, page, claims, &r.source[k], presets, r.row[k]));
    }
    exp_page_html(page, "<div class=\"plot\">\n");
    exp_page_figure(page, "", "charts.svg", "charts by mesh and settings", "Charts a mesh is cut into.");
    exp_page_html(page, "</div>\n");
    tables(page, &r, presets);
    SL_TRY(write_csvs(run, &r, presets));
cleanup:
    sl_free(r.source);
    sl_free(r.row);
    return status;
}

int main(int argc, char **argv)
{
    return exp_main(argc, argv, "fig08-segmentations", "Figure 8: segmentations", NULL, EXPECTED_CSV, show_all);
}
