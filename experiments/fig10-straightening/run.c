/* Figure 10: lines that cross. g2 splits in two where a line passes, in four where two do. */
#include "support/failures.h"
#include "support/sheet.h"

#include <stdio.h>
#include <string.h>

enum { SIDE = 420, MOST_CORNERS = 64 };

static const double degrees = 57.29577951308232;

static const exp_lines lines = {
    .what = {"free", "one line", "two lines that cross", "and one that ends on the first"},
    .mode = {EXP_LINE_APART, EXP_LINE_APART, EXP_LINE_CROSS, EXP_LINE_STOP},
    .caption = "Two lines cross in four right angles; the third ends on the first in a T.",
};

/* The charts around the mesh vertex where three meet, each once, the vertex of the most facets; -1 = there is none. */
static int32_t find_meeting(const exp_sheet *sheet, int32_t charts[3])
{
    const sl_mesh *m = sheet->mesh;
    const int32_t *chart_of = sheet->segmentation->face_chart;
    int32_t best = -1, most = 0;
    for (int32_t start = 0; start < m->nh; start++) {
        int32_t met[3] = {-1, -1, -1}, changes = 0, count = 0, h = start;
        bool good = true;
        do { /* around the vertex, across seams */
            const int32_t c = chart_of[m->face[h]], before = sl_opposite(m, h);
            int32_t k = 0;
            while (k < 3 && met[k] != c && met[k] >= 0) {
                k++;
            }
            good = good && k < 3 && before >= 0 && ++count < MOST_CORNERS;
            if (good) {
                met[k] = c;
                changes += chart_of[m->face[before]] != c;
                h = sl_next(m, before);
            }
        } while (good && h != start);
        if (good && met[2] >= 0 && changes == 3 && count > most) {
            most = count;
            best = m->origin[start];
            memcpy(charts, met, sizeof met);
        }
    }
    return best;
}

static int32_t find_vertex(const exp_sheet *sheet, int32_t point)
{
    for (int32_t c = 0; c < 3 * sheet->patch->nt; c++) {
        if (sheet->mesh->origin[sheet->patch->corner[c]] == point) {
            return sheet->patch->tri[c];
        }
    }
    return -1;
}

/* One chart of three with its share of the turn. */
static sl_status show_share(exp_run *run, exp_page *page, exp_claims *claims, const exp_sheet *sheet,
                            const sl_constraint *share, int32_t number)
{
    sl_status status = SL_OK;
    exp_wish wish = {0};
    sl_sector_table table = {0};
    sl_abf_chart *chart = NULL;
    exp_solution solution;
    char what[64], file[96];
    snprintf(what, sizeof what, "chart %d, %.0f degrees", sheet->chart, share->angle * degrees);
    snprintf(file, sizeof file, "%.60s-meeting-%d.png", sheet->name, number);
    SL_TRY(exp_wish_angle(&wish, share->vertex[0], share->angle));
    SL_TRY(exp_sheet_solve(run, sheet, &wish, &table, &chart, &solution));
    exp_solution_row(page, claims, sheet->name, what, &wish, &solution);
    SL_TRY(exp_sheet_draw(run, sheet, sl_abf_chart_uv(chart), &wish,
                          &(exp_drawing){.width = SIDE, .height = SIDE, .file = file}));
cleanup:
    sl_abf_chart_free(chart);
    sl_sectors_clear(&table);
    exp_wish_clear(&wish);
    return status;
}

/* Seams that meet in a T between three charts. */
static sl_status show_meeting(exp_run *run, exp_page *page, exp_claims *claims, const char *model)
{
    sl_status status = SL_OK;
    exp_sheet sheet[3];
    const sl_patch *patch[3];
    sl_constraint share[3];
    int32_t charts[3] = {0}, vertex[3], point;
    char file[96], caption[96], title[96];
    memset(sheet, 0, sizeof sheet);
    SL_TRY(exp_sheet_open(run, model, 0, -1, &sheet[0]));
    point = find_meeting(&sheet[0], charts);
    exp_sheet_close(&sheet[0]);
    SL_TRY(point >= 0 ? SL_OK : SL_INFEASIBLE);
    for (int k = 0; k < 3; k++) {
        SL_TRY(exp_sheet_open(run, model, 0, charts[k], &sheet[k]));
        patch[k] = sheet[k].patch;
        vertex[k] = find_vertex(&sheet[k], point);
    }
    SL_TRY(sl_constraints_cross_seams(3, patch, vertex, share, &run->diag));
    snprintf(title, sizeof title, "%s, seams between three charts", model);
    exp_solution_header(page, title);
    for (int k = 0; k < 3; k++) {
        SL_TRY(show_share(run, page, claims, &sheet[k], &share[k], k));
    }
    exp_page_table_end(page);
    exp_page_html(page, "<div class=\"grid\">\n");
    for (int k = 0; k < 3; k++) {
        snprintf(file, sizeof file, "%s-meeting-%d.png", model, k);
        snprintf(caption, sizeof caption, "%.0f&deg; at the vertex where the seams meet", share[k].angle * degrees);
        exp_page_figure(page, "", file, "a chart", caption);
    }
    exp_page_html(page, "</div>\n");
cleanup:
    for (int k = 0; k < 3; k++) {
        exp_sheet_close(&sheet[k]);
    }
    return status;
}

static sl_status show_all(exp_run *run, exp_page *page, exp_claims *claims)
{
    sl_status status = SL_OK;
    SL_TRY(exp_row(run, "rock", exp_show_lines(run, page, claims, "rock", &lines)));
    SL_TRY(exp_row(run, "airplane", exp_show_lines(run, page, claims, "airplane", &lines)));
    SL_TRY(exp_row(run, "pullover", exp_show_lines(run, page, claims, "pullover", &lines)));
    SL_TRY(exp_row(run, "bird", show_meeting(run, page, claims, "bird")));
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
        "charts: a line, a second one across it, and a third that ends on the first (&pi;, &pi;/2, &pi;/2); and the "
        "same "
        "between three charts whose seams meet at a vertex.",
        EXPECTED_CSV, show_all);
}
