/* Figure 9: the angle-on-border tool. The sum of the angles at a border vertex is one more row of g2. */
#include "support/failures.h"
#include "support/sheet.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

enum { ANGLES = 4, SIDE = 560, DOT = 3 };

static const double degrees = 57.29577951308232;
static const double asked[ANGLES] = {0.0, 210.0, 300.0, 360.0}; /* the first one: free */

/* Facets around a vertex. */
static void tint_fan(const exp_sheet *sheet, int32_t v, uint8_t *tint)
{
    const sl_patch *p = sheet->patch;
    memset(tint, 0, (size_t)sheet->mesh->nf);
    for (int32_t c = 0; c < 3 * p->nt; c++) {
        if (p->tri[c] == v) {
            tint[p->facet[c / 3]] = 1;
        }
    }
}

static sl_status show_angle(exp_run *run, exp_page *page, exp_claims *claims, const exp_sheet *sheet, int32_t v,
                            const uint8_t *tint, int k)
{
    sl_status status = SL_OK;
    exp_wish wish = {0};
    sl_sector_table table = {0};
    sl_abf_chart *chart = NULL;
    exp_solution solution;
    char file[96], what[64];
    double sum = 0.0;
    if (k > 0) {
        SL_TRY(exp_wish_angle(&wish, v, asked[k] / degrees));
    }
    SL_TRY(exp_sheet_solve(run, sheet, &wish, &table, &chart, &solution));
    for (int32_t c = 0; c < 3 * sheet->patch->nt; c++) {
        sum += sheet->patch->tri[c] == v ? sl_abf_chart_angles(chart)[c] : 0.0;
    }
    snprintf(file, sizeof file, "%s-%d.png", sheet->name, k);
    SL_TRY(exp_sheet_draw(run, sheet, sl_abf_chart_uv(chart), &wish,
                          &(exp_drawing){.tint = tint, .width = SIDE, .height = SIDE, .radius = DOT, .file = file}));
    snprintf(what, sizeof what, k == 0 ? "free: %.4f degrees" : "asked for: %.4f degrees", sum * degrees);
    exp_solution_row(page, claims, sheet->name, what, &wish, &solution);
cleanup:
    sl_abf_chart_free(chart);
    sl_sectors_clear(&table);
    exp_wish_clear(&wish);
    return status;
}

static sl_status show(exp_run *run, exp_page *page, exp_claims *claims, const char *model, int32_t charts)
{
    sl_status status = SL_OK;
    exp_sheet sheet = {0};
    exp_wish none = {0};
    sl_sector_table table = {0};
    sl_abf_chart *chart = NULL;
    exp_solution solution;
    uint8_t *tint = NULL;
    SL_TRY(exp_sheet_open(run, model, charts, -1, &sheet));
    SL_TRY(exp_sheet_solve(run, &sheet, &none, &table, &chart, &solution));
    const int32_t v = exp_sheet_widest(&sheet, sl_abf_chart_angles(chart));
    tint = sl_alloc(sheet.mesh->nf, sizeof *tint);
    SL_TRY(v >= 0 ? SL_OK : SL_INFEASIBLE);
    SL_TRY(tint != NULL ? SL_OK : SL_OUT_OF_MEMORY);
    tint_fan(&sheet, v, tint);
    exp_solution_header(page, model);
    for (int k = 0; k < ANGLES; k++) {
        SL_TRY(show_angle(run, page, claims, &sheet, v, tint, k));
    }
    exp_page_table_end(page);
    exp_page_html(page, "<div class=\"grid\">\n");
    for (int k = 0; k < ANGLES; k++) {
        char file[96], caption[64];
        snprintf(file, sizeof file, "%s-%d.png", model, k);
        snprintf(caption, sizeof caption, k == 0 ? "free" : "%.0f&deg;", asked[k]);
        exp_page_figure(page, "", file, "the chart", caption);
    }
    exp_page_html(page, "</div>\n");
cleanup:
    sl_abf_chart_free(chart);
    sl_sectors_clear(&table);
    sl_free(tint);
    exp_sheet_close(&sheet);
    return status;
}

static sl_status show_all(exp_run *run, exp_page *page, exp_claims *claims)
{
    sl_status status = SL_OK;
    SL_TRY(exp_row(run, "snowflake", show(run, page, claims, "snowflake", 6)));
    SL_TRY(exp_row(run, "starfish", show(run, page, claims, "starfish", 0)));
cleanup:
    return status;
}

int main(int argc, char **argv)
{
    return exp_main(argc, argv, "fig09-angle", "Figure 9: the angle-on-border tool",
                    "The paper: \"The border angle at vertex b is constrained through the sum of angles incident "
                    "to b (purple).\" Here the free chart, then the same vertex at 210, 300 and 360 degrees.",
                    EXPECTED_CSV, show_all);
}
