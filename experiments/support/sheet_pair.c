#include "support/sheet.h"

#include <stdio.h>
#include <string.h>

enum { WIDTH = 1500, HEIGHT = 700 };

sl_status exp_show_pair(exp_run *run, exp_page *page, const exp_sheet *sheet, const exp_wish *wish, const char *stem,
                        const double *before, const double *after, const char *caption)
{
    sl_status status = SL_OK;
    char file[2][96], text[200];
    snprintf(file[0], sizeof file[0], "%s-before.png", stem);
    snprintf(file[1], sizeof file[1], "%s-after.png", stem);
    SL_TRY(exp_sheet_draw(run, sheet, before, wish,
                          &(exp_drawing){.width = WIDTH, .height = HEIGHT, .model = true, .file = file[0]}));
    SL_TRY(exp_sheet_draw(run, sheet, after, wish,
                          &(exp_drawing){.width = WIDTH, .height = HEIGHT, .model = true, .file = file[1]}));
    snprintf(text, sizeof text, "<b>%s</b>: what is picked, in the free chart.", sheet->name);
    exp_page_html(page, "<div class=\"duo\" style=\"grid-template-columns:1fr 1fr\">\n");
    exp_page_figure(page, "", file[0], "the chart before", text);
    exp_page_figure(page, "", file[1], "the chart after", caption);
    exp_page_html(page, "</div>\n");
cleanup:
    return status;
}

sl_status exp_show_lines(exp_run *run, exp_page *page, exp_claims *claims, const char *model, const exp_lines *lines)
{
    sl_status status = SL_OK;
    exp_sheet sheet = {0};
    exp_wish wish = {0};
    sl_sector_table table[4];
    sl_abf_chart *chart[4] = {NULL};
    memset(table, 0, sizeof table);
    exp_solution solution;
    int32_t *border = NULL, count = 0;
    SL_TRY(exp_sheet_open(run, model, 0, -1, &sheet));
    SL_TRY(exp_sheet_border(&sheet, &border, &count));
    exp_solution_header(page, model);
    for (int k = 0; k < 4; k++) {
        if (k > 0) {
            SL_TRY(exp_wish_line(run, &sheet, border, count, lines->mode[k], &wish));
        }
        SL_TRY(exp_sheet_solve(run, &sheet, &wish, &table[k], &chart[k], &solution));
        exp_solution_row(page, claims, model, lines->what[k], &wish, &solution);
    }
    exp_page_table_end(page);
    SL_TRY(exp_show_pair(run, page, &sheet, &wish, model, sl_abf_chart_uv(chart[0]), sl_abf_chart_uv(chart[3]),
                         lines->caption));
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
