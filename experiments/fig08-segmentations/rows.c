#include "segmentations.h"
#include "support/csv.h"
#include "support/turning.h"

#include <math.h>

const char *const preset_name[PRESETS] = {"fast", "paper", "best"};

static bool warned(const sl_atlas *atlas, int32_t chart)
{
    for (int32_t k = 0; k < atlas->nwarning; k++) {
        if (atlas->warning[k].chart == chart) {
            return true;
        }
    }
    return false;
}

/* Means over the charts, those of angle and area weighed by area; the worst. */
static void take_distortion(const sl_atlas *atlas, atlas_row *row)
{
    const sl_segmentation *seg = atlas->segmentation;
    double area = 0.0;
    int32_t measured = 0;
    for (int32_t c = 0; c < seg->nchart; c++) {
        const sl_flatten_result *flat = &seg->chart[c].flat;
        row->invalid += flat->verdict != SL_CHART_VALID;
        if (flat->distortion.measured > 0 && isfinite(flat->distortion.l2)) {
            row->l2_mean += flat->distortion.l2;
            row->l2_worst = fmax(row->l2_worst, flat->distortion.l2);
            row->l2_unwarned = fmax(row->l2_unwarned, warned(atlas, c) ? 0.0 : flat->distortion.l2);
            row->angle += flat->distortion.area_3d * flat->distortion.angle_mean;
            row->area += flat->distortion.area_3d * flat->distortion.area_mean;
            area += flat->distortion.area_3d;
            measured++;
        }
    }
    row->l2_mean = measured > 0 ? row->l2_mean / measured : 0.0;
    row->angle = area > 0.0 ? row->angle / area : 0.0;
    row->area = area > 0.0 ? row->area / area : 0.0;
}

atlas_row row_of(const sl_atlas *atlas, const sl_polygons *polygons, const sl_generated *made, double seconds)
{
    const sl_segmentation *seg = atlas->segmentation;
    atlas_row row = {.made = true,
                     .passed = atlas->check.passed,
                     .facets = atlas->mesh->nf,
                     .charts = seg->nchart,
                     .splits = seg->nsplit,
                     .copies = seg->sharing.copies,
                     .overlapping = atlas->check.overlapping_texels,
                     .seam = sl_atlas_seam_diagonals(atlas->mesh),
                     .turning = exp_seam_turning(atlas->mesh),
                     .axis = exp_axis_kept(atlas->mesh, polygons, made, true),
                     .fill = atlas->pack.fill,
                     .seconds = seconds};
    take_distortion(atlas, &row);
    return row;
}

static void show_row(exp_page *page, const char *mesh, const char *preset, const atlas_row *row)
{
    exp_page_row_begin(page, !row->passed);
    exp_page_cell(page, "%s", mesh);
    exp_page_cell(page, "%s", preset);
    exp_page_cell(page, "%d", row->facets);
    exp_page_cell(page, "%d", row->charts);
    exp_page_cell(page, "%d", row->copies);
    exp_page_cell(page, "%.2f", row->seam);
    exp_page_cell(page, "%.3f", row->l2_mean);
    exp_page_cell(page, "%.3f", row->l2_worst);
    exp_page_cell(page, "%.3f", row->angle);
    exp_page_cell(page, "%.3f", row->area);
    exp_page_cell(page, "%.1f", row->turning);
    exp_page_cell(page, row->axis >= 0.0 ? "%.0f %%" : "-", 100.0 * row->axis);
    exp_page_cell(page, "%lld", (long long)row->overlapping);
    exp_page_cell(page, "%.3f", row->fill);
    exp_page_row_end(page);
}

void show_rows(exp_page *page, const results *r)
{
    exp_page_table_begin(page, "mesh|preset|facets|charts|copies|seam|L2 mean|worst|&sigma;<sub>1</sub>/"
                               "&sigma;<sub>2</sub>|area|turning [&deg;]|axis kept|texels overlapping|fill");
    for (int32_t k = 0; k < r->count; k++) {
        for (int p = 0; p < PRESETS; p++) {
            if (r->row[k][p].made) {
                show_row(page, r->source[k].name, preset_name[p], &r->row[k][p]);
            }
        }
    }
    exp_page_table_end(page);
}

sl_status write_csvs(exp_run *run, const results *r)
{
    sl_status status = SL_OK;
    sl_writer *numbers = NULL, *timings = NULL;
    SL_TRY(exp_csv_open(run, "segmentations.csv",
                        "number,mesh,preset,made,facets,charts,copies,splits,overlapping,seam_over_diagonal,l2_mean,"
                        "l2_worst,angle_mean,area_mean,turning,axis,fill",
                        &numbers));
    SL_TRY(exp_csv_open(run, "timings.csv", "mesh,preset,cpu_seconds", &timings));
    for (int32_t k = 0; k < PRESETS * r->count; k++) {
        const atlas_row *row = &r->row[k / PRESETS][k % PRESETS];
        const char *name = r->source[k / PRESETS].name, *preset = preset_name[k % PRESETS];
        const double number[] = {row->seam, row->l2_mean, row->l2_worst, row->angle,
                                 row->area, row->turning, row->axis,     row->fill};
        sl_writer_format(numbers, "%d,%s,%s,%d,%d,%d,%d,%d,%lld", k / PRESETS, name, preset, row->made, row->facets,
                         row->charts, row->copies, row->splits, (long long)row->overlapping);
        exp_csv_numbers(numbers, number, SL_COUNTOF(number));
        sl_writer_text(numbers, "\n");
        sl_writer_format(timings, "%s,%s,%.3f\n", name, preset, row->seconds);
    }
    SL_TRY(exp_csv_close(run, &numbers));
    SL_TRY(exp_csv_close(run, &timings));
cleanup:
    sl_writer_abandon(numbers);
    sl_writer_abandon(timings);
    return status;
}
