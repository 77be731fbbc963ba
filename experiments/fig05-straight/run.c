/* Figure 5: the straightening tool, on sequences of edges inside a chart. */
#include "support/failures.h"
#include "support/sheet.h"

static const exp_lines lines = {
    .what = {"free", "one line", "two lines", "three lines"},
    .mode = {EXP_LINE_APART, EXP_LINE_APART, EXP_LINE_APART, EXP_LINE_APART},
    .caption = "The same edges straightened.",
};

static sl_status show_all(exp_run *run, exp_page *page, exp_claims *claims)
{
    sl_status status = SL_OK;
    SL_TRY(exp_row(run, "rock", exp_show_lines(run, page, claims, "rock", &lines)));
    SL_TRY(exp_row(run, "turtle", exp_show_lines(run, page, claims, "turtle", &lines)));
    SL_TRY(exp_row(run, "pullover", exp_show_lines(run, page, claims, "pullover", &lines)));
cleanup:
    return status;
}

int main(int argc, char **argv)
{
    return exp_main(
        argc, argv, "fig05-straight", "Figure 5: straightening",
        "The paper: \"When the user selects a sequence of edges with this tool, all the selected edges will be "
        "aligned.\" Here one, two and three lines that do not meet: shortest "
        "paths on a scan of irregular triangles, lines of edges on two quad meshes.",
        EXPECTED_CSV, show_all);
}
