/* Figure 4: the angle at a border vertex turned through 180 degrees, 5 degrees and two iterations a drag. */
#include "support/csv.h"
#include "support/failures.h"
#include "support/sheet.h"

#include <math.h>
#include <stdio.h>

enum { DRAGS = 36, SHOWN = 4, SIDE = 420 };

static const double degrees = 57.29577951308232, per_drag = 5.0;

/* What a drag left behind. */
typedef struct drag {
    double asked; /* degrees */
    exp_solution solution;
    sl_abf_chart_info released; /* what a release at this angle gives, tried with another chart in hand */
} drag;

/* Drags from the angle held, back by 5 degrees each; after each: two iterations and reconstruction. `other` is released
 * at every angle, so that the drags go on as if it were not there. */
static sl_status turn(exp_run *run, const exp_sheet *sheet, const exp_wish *wish, const sl_sector_table *table,
                      sl_abf_chart *chart, sl_abf_chart *other, int32_t sector, double from, drag *drags,
                      const char *stem)
{
    sl_status status = SL_OK;
    double *theta = sl_copy(table->view.theta, table->view.count, sizeof *theta);
    double window[3];
    char file[96];
    SL_TRY(theta != NULL ? SL_OK : SL_OUT_OF_MEMORY);
    for (int32_t k = 0; k <= DRAGS; k++) {
        drag *d = &drags[k];
        d->asked = from - per_drag * k;
        theta[sector] = d->asked / degrees;
        const double before = exp_cpu_seconds();
        if (k > 0) {
            SL_TRY(sl_abf_chart_move(chart, theta, &run->context));
        }
        d->solution.cpu = exp_cpu_seconds() - before;
        SL_TRY(exp_sheet_measure(sheet, wish, table, chart, &d->solution));
        SL_TRY(sl_abf_chart_release(other, theta, &run->context));
        d->released = *sl_abf_chart_info_of(other);
        if (k % (DRAGS / SHOWN) == 0) {
            snprintf(file, sizeof file, "%s-%d.png", stem, k / (DRAGS / SHOWN));
            exp_sheet_window(sheet, sl_abf_chart_uv(chart), window);
            SL_TRY(exp_sheet_draw(run, sheet, sl_abf_chart_uv(chart), wish,
                                  &(exp_drawing){.width = SIDE, .height = SIDE, .file = file}));
        }
    }
    const double before = exp_cpu_seconds();
    SL_TRY(sl_abf_chart_release(chart, theta, &run->context));
    drags[DRAGS + 1].solution.cpu = exp_cpu_seconds() - before;
    SL_TRY(exp_sheet_measure(sheet, wish, table, chart, &drags[DRAGS + 1].solution));
    drags[DRAGS + 1].asked = drags[DRAGS].asked;
    drags[DRAGS + 1].released = drags[DRAGS + 1].solution.info;
cleanup:
    sl_free(theta);
    return status;
}

static void table_of(exp_page *page, exp_claims *claims, const char *name, const drag *drags)
{
    exp_page_table_begin(page, "drag|angle asked|angle held|iterations|&#124;&nabla;L&#124;|worst &#124;g&#124;|"
                               "flipped|border crossings|mean &sigma;1/&sigma;2|CPU [ms]|released: iterations|"
                               "&#124;&nabla;L&#124;|worst &#124;g&#124;");
    for (int32_t k = 0; k <= DRAGS + 1; k++) {
        const exp_solution *s = &drags[k].solution;
        const sl_abf_info *abf = &s->info.abf;
        const sl_abf_info *rest = &drags[k].released.abf;
        const double residual = fmax(fmax(abf->g1, abf->g2), abf->g3);
        const double rest_residual = fmax(fmax(rest->g1, rest->g2), rest->g3);
        bool kept = exp_claims_measure(claims, name, "flipped", s->info.quality.flipped);
        kept = exp_claims_measure(claims, name, "gradient at rest", rest->gradient) && kept;
        kept = exp_claims_measure(claims, name, "residual at rest", rest_residual) && kept;
        kept = exp_claims_measure(claims, name, "reached at rest", drags[k].released.reached) && kept;
        if (k > 0 && k <= DRAGS) {
            kept = exp_claims_measure(claims, name, "gradient of a drag", abf->gradient) && kept;
            kept = exp_claims_measure(claims, name, "residual of a drag", residual) && kept;
            kept = exp_claims_measure(claims, name, "rolled back", s->info.rolled_back) && kept;
        }
        if (k > 0 && k < DRAGS && k % 3 != 0 && kept) {
            continue;
        }
        exp_page_row_begin(page, !kept);
        exp_page_cell(page, k == 0 ? "held" : k > DRAGS ? "released" : "%d", k);
        exp_page_cell(page, "%.0f&deg;", drags[k].asked);
        exp_page_cell(page, "%.9f&deg;", drags[k].asked - s->info.distance * degrees);
        exp_page_cell(page, "%d", abf->iterations);
        exp_page_cell(page, "%.1e", abf->gradient);
        exp_page_cell(page, "%.1e", residual);
        exp_page_cell(page, "%d", s->info.quality.flipped);
        exp_page_cell(page, "%d", s->crossings);
        exp_page_cell(page, "%.3f", s->distortion.angle_mean);
        exp_page_time(page, "%.1f", 1e3 * s->cpu);
        exp_page_cell(page, "%d", drags[k].released.iterations);
        exp_page_cell(page, rest->floor ? "%.1e (rounding floor)" : "%.1e", rest->gradient);
        exp_page_cell(page, "%.1e", rest_residual);
        exp_page_row_end(page);
    }
    exp_page_table_end(page);
}

static sl_status write_csv(exp_run *run, const char *name, const drag *drags)
{
    sl_status status = SL_OK;
    sl_writer *csv = NULL;
    char file[96];
    snprintf(file, sizeof file, "%s.csv", name);
    SL_TRY(exp_csv_open(run, file,
                        "drag,asked,gradient,g2,g3,crossings,distortion,gradient_released,iterations_released", &csv));
    for (int32_t k = 0; k <= DRAGS; k++) {
        const exp_solution *s = &drags[k].solution;
        const double row[] = {drags[k].asked,
                              s->info.abf.gradient,
                              s->info.abf.g2,
                              s->info.abf.g3,
                              s->crossings,
                              s->distortion.angle_mean,
                              drags[k].released.abf.gradient,
                              drags[k].released.iterations};
        sl_writer_int(csv, k);
        exp_csv_numbers(csv, row, SL_COUNTOF(row));
        sl_writer_text(csv, "\n");
    }
    SL_TRY(exp_csv_close(run, &csv));
cleanup:
    sl_writer_abandon(csv);
    return status;
}

static sl_status show(exp_run *run, exp_page *page, exp_claims *claims, const char *model, int32_t charts, double from)
{
    sl_status status = SL_OK;
    exp_sheet sheet = {0};
    exp_wish wish = {0};
    sl_sector_table table = {0}, plain = {0}, again = {0};
    sl_abf_chart *chart = NULL, *free_chart = NULL, *other = NULL;
    exp_solution free_solution, other_solution;
    drag drags[DRAGS + 2] = {{.asked = from}};
    int32_t sector = 0, vertex;
    char file[96], caption[160];
    SL_TRY(exp_sheet_open(run, model, charts, -1, &sheet));
    SL_TRY(exp_sheet_solve(run, &sheet, &wish, &plain, &free_chart, &free_solution));
    vertex = exp_sheet_widest(&sheet, sl_abf_chart_angles(free_chart));
    SL_TRY(vertex >= 0 ? SL_OK : SL_INFEASIBLE);
    SL_TRY(exp_wish_angle(&wish, vertex, from / degrees));
    SL_TRY(exp_sheet_solve(run, &sheet, &wish, &table, &chart, &drags[0].solution));
    while (table.origin[sector] != 0) {
        sector++;
    }
    SL_TRY(exp_sheet_solve(run, &sheet, &wish, &again, &other, &other_solution));
    SL_TRY(turn(run, &sheet, &wish, &table, chart, other, sector, from, drags, model));
    exp_page_html(page, "<h3>%s, %d triangles</h3>\n<div class=\"grid\">\n", model, sheet.patch->nt);
    for (int32_t k = 0; k <= SHOWN; k++) {
        snprintf(file, sizeof file, "%s-%d.png", model, k);
        snprintf(caption, sizeof caption, "%.0f&deg;", drags[k * (DRAGS / SHOWN)].asked);
        exp_page_figure(page, "", file, "the chart", caption);
    }
    exp_page_html(page, "</div>\n");
    table_of(page, claims, model, drags);
    SL_TRY(write_csv(run, model, drags));
    fprintf(stderr, "%s: crossings %d -> %d, last |g| %.1e, reached %.2f\n", model, drags[0].solution.crossings,
            drags[DRAGS].solution.crossings, drags[DRAGS].solution.info.abf.gradient,
            drags[DRAGS + 1].solution.info.reached);
    exp_claims_measure(claims, model, "crossings at the start", drags[0].solution.crossings);
    exp_claims_measure(claims, model, "crossings at the end", drags[DRAGS + 1].solution.crossings);
cleanup:
    sl_abf_chart_free(chart);
    sl_abf_chart_free(other);
    sl_sectors_clear(&table);
    sl_sectors_clear(&again);
    exp_wish_clear(&wish);
    sl_abf_chart_free(free_chart);
    sl_sectors_clear(&plain);
    exp_sheet_close(&sheet);
    return status;
}

static sl_status show_all(exp_run *run, exp_page *page, exp_claims *claims)
{
    sl_status status = SL_OK;
    SL_TRY(exp_row(run, "snowflake", show(run, page, claims, "snowflake", 6, 390.0)));
    SL_TRY(exp_row(run, "starfish", show(run, page, claims, "starfish", 0, 390.0)));
    SL_TRY(exp_row(run, "hand", show(run, page, claims, "hand", 2, 390.0)));
    exp_page_figure(page, "", "drags.svg", "gradient over the drags",
                    "|&nabla;L| left by the two iterations of each drag; the angle itself is met to rounding.");
cleanup:
    return status;
}

int main(int argc, char **argv)
{
    return exp_main(
        argc, argv, "fig04-border-angle", "Figure 4: an angle on the border untangles an overlap",
        "The paper: \"An alternative way of untangling an overlap is to constrain an angle on the boundary\", and "
        "\"each time the user moves the mouse [...] two iterations of ABF++ are applied to update the result. It "
        "generally suffices to get a good result. When the user releases the mouse, the regular stopping criterion is "
        "used instead.\" Here the angle at one border vertex (yellow) is turned through 180 degrees by 36 drags of 5: "
        "at the widest place between two limbs, from 390, where they overlap, to 210. The last columns show what a "
        "release at that angle gives: there the gradient is below 1e-6.",
        EXPECTED_CSV, show_all);
}
