/* Figure 10: lines that cross. g2 splits in two where a line passes, in four where two do. */
#include "support/sheet.h"

#include <stdio.h>
#include <string.h>

static sl_status show(exp_run *run, exp_page *page, exp_claims *claims, const char *model, int32_t charts)
{
    static const char *const what[] = {"free", "one line", "two lines that cross", "and one that ends on the first"};
    static const exp_line_mode mode[] = {EXP_LINE_APART, EXP_LINE_APART, EXP_LINE_CROSS, EXP_LINE_STOP};
    sl_status status = SL_OK;
    exp_sheet sheet = {0};
    exp_wish wish = {0};
    sl_sector_table table[4];
    sl_abf_chart *chart[4] = {NULL};
    memset(table, 0, sizeof table);
    exp_solution solution;
    int32_t *border = NULL, count = 0;
    SL_TRY(exp_sheet_open(run, model, charts, -1, &sheet));
    SL_TRY(exp_sheet_border(&sheet, &border, &count));
    exp_solution_header(page, model);
    for (int k = 0; k < 4; k++) {
        if (k > 0) {
            SL_TRY(exp_wish_line(run, &sheet, border, count, mode[k], &wish));
        }
        SL_TRY(exp_sheet_solve(run, &sheet, &wish, &table[k], &chart[k], &solution));
        exp_solution_row(page, claims, model, what[k], &wish, &solution);
    }
    exp_page_table_end(page);
    SL_TRY(exp_show_pair(run, page, &sheet, &wish, model, sl_abf_chart_uv(chart[0]), sl_abf_chart_uv(chart[3]),
                         "Two lines cross in four right angles; the third ends on the first in a T."));
cleanup:
    for (int k = 0; k < 4; k++) {
        sl_abf_chart_free(chart[k]);
        sl_sectors_clear(&table[k]);
    }
    exp_wish_clear(&wish);
    sl_free(border);
    exp_sheet_close(&sheet);
    return status;
}

static sl_status show_all(exp_run *run, exp_page *page, exp_claims *claims)
{
    sl_status status = SL_OK;
    SL_TRY(show(run, page, claims, "rock", 0));
    SL_TRY(show(run, page, claims, "airplane", 0));
    SL_TRY(show(run, page, claims, "pullover", 0));
cleanup:
    return status;
}

int main(int argc, char **argv)
{
    return exp_main(
        argc, argv, "fig10-straightening", "Figure 10: straightening lines that cross",
        "The paper: \"Blue edges are aligned by splitting the constraint g<sub>2</sub> into 2 constraints "
        "g<sub>2</sub><sup>1</sup> and g<sub>2</sub><sup>2</sup>. If two straightening lines cross, "
        "g<sub>2</sub><sup>1</sup> and g<sub>2</sub><sup>2</sup> are split again into 4 constraints.\" Here on three "
        "charts: a line, a second one across it, and a third that ends on the first (&pi;, &pi;/2, &pi;/2).",
        EXPECTED_CSV, show_all);
}
