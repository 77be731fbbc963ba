#include "support/sheet.h"

#include <stdio.h>

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
