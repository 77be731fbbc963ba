/* Figure 11: a network of straight lines and prescribed angles, all at once. */
#include "support/failures.h"
#include "support/sheet.h"

#include <math.h>
#include <stdio.h>

enum { LINES = 12, ANGLES = 8, CLEARANCE = 36 };

static const double degrees = 57.29577951308232;
static const double step = 30.0; /* degrees: angles asked for are multiples of this */

/* Does the last line end near another one (or itself)? position: of a vertex on the border, -1 = inside. */
static bool crowded(const exp_wish *wish, const int32_t *position, int32_t count)
{
    const sl_constraint *last = &wish->item[wish->count - 1];
    const int32_t room = count / CLEARANCE;
    for (int32_t k = 0; k < wish->count; k++) {
        const sl_constraint *other = &wish->item[k];
        for (int i = 0; i < 2; i++) {
            for (int j = 0; j < 2; j++) {
                const int32_t a = position[last->vertex[i == 0 ? 0 : last->count - 1]],
                              b = position[other->vertex[j == 0 ? 0 : other->count - 1]];
                const int32_t gap = a > b ? a - b : b - a;
                if ((gap < room || count - gap < room) && !(other == last && i == j)) {
                    return true;
                }
            }
        }
    }
    return false;
}

/* Lines along the quads' edges from border vertices spread over the border, as many as can be together. */
static sl_status add_lines(exp_run *run, const exp_sheet *sheet, const int32_t *border, int32_t count, exp_wish *wish)
{
    sl_status status = SL_OK;
    int32_t *position = sl_alloc(sheet->patch->nv, sizeof *position);
    if (position == NULL) {
        return SL_OUT_OF_MEMORY;
    }
    for (int32_t k = 0; k < count; k++) {
        position[border[k]] = k;
    }
    for (int32_t k = 0; k < count && wish->count < LINES && status == SL_OK; k++) {
        const bool made = exp_wish_loop(sheet, border[k], wish, &status);
        bool kept = made && !crowded(wish, position, count);
        if (kept) {
            status = exp_wish_good(run, sheet, wish, &kept);
        }
        if (made && !kept) {
            exp_wish_drop(wish);
        }
    }
    sl_free(position);
    return status;
}

static double border_angle(const sl_patch *p, int32_t v, const double *alpha, int32_t *triangles)
{
    double sum = 0.0;
    *triangles = 0;
    for (int32_t c = 0; c < 3 * p->nt; c++) {
        if (p->tri[c] == v) {
            sum += alpha[c];
            ++*triangles;
        }
    }
    return sum;
}

/* Angles at border vertices between the lines: the multiple of 30 degrees next to the free chart's, and not that angle.
 */
static sl_status add_angles(exp_run *run, const exp_sheet *sheet, const int32_t *border, int32_t count,
                            const double *alpha, exp_wish *wish)
{
    const int32_t most = wish->count + ANGLES, stride = count / (2 * ANGLES) > 1 ? count / (2 * ANGLES) : 1;
    for (int32_t k = stride / 2; k < count && wish->count < most; k += stride) {
        int32_t triangles;
        const double now = border_angle(sheet->patch, border[k], alpha, &triangles) * degrees;
        const double low = step * floor(now / step), high = low + step;
        const double asked = (now - low > high - now ? low : high) / degrees;
        if (triangles < 2 || asked <= 0.0) {
            continue;
        }
        bool kept = false;
        sl_status status = exp_wish_angle(wish, border[k], asked);
        if (status == SL_OK) {
            status = exp_wish_good(run, sheet, wish, &kept);
        }
        if (status != SL_OK) {
            return status;
        }
        if (!kept) {
            exp_wish_drop(wish);
        }
    }
    return SL_OK;
}

static sl_status show(exp_run *run, exp_page *page, exp_claims *claims, const char *model, int32_t charts)
{
    sl_status status = SL_OK;
    exp_sheet sheet = {0};
    exp_wish wish = {0};
    const exp_wish none = {0};
    sl_sector_table table = {0}, plain = {0};
    sl_abf_chart *chart = NULL, *free_chart = NULL;
    exp_solution solution, unconstrained;
    int32_t *border = NULL, count = 0, lines;
    char caption[200];
    SL_TRY(exp_sheet_open(run, model, charts, -1, &sheet));
    SL_TRY(exp_sheet_border(&sheet, &border, &count));
    SL_TRY(exp_sheet_solve(run, &sheet, &none, &plain, &free_chart, &unconstrained));
    SL_TRY(add_lines(run, &sheet, border, count, &wish));
    lines = wish.count;
    SL_TRY(add_angles(run, &sheet, border, count, sl_abf_chart_angles(free_chart), &wish));
    SL_TRY(exp_sheet_solve(run, &sheet, &wish, &table, &chart, &solution));
    snprintf(caption, sizeof caption, "%d lines straight, crossings even, %d angles as asked.", lines,
             wish.count - lines);
    SL_TRY(
        exp_show_pair(run, page, &sheet, &wish, model, sl_abf_chart_uv(free_chart), sl_abf_chart_uv(chart), caption));
    exp_claims_measure(claims, model, "crossings of the border", solution.crossings);
    exp_claims_measure(claims, model, "lines", lines);
    exp_claims_measure(claims, model, "angles", wish.count - lines);
    exp_solution_header(page, "chart");
    exp_solution_row(page, claims, "free", "free", &none, &unconstrained);
    exp_solution_row(page, claims, model, "network", &wish, &solution);
    exp_page_table_end(page);
cleanup:
    sl_abf_chart_free(chart);
    sl_abf_chart_free(free_chart);
    sl_sectors_clear(&table);
    sl_sectors_clear(&plain);
    exp_wish_clear(&wish);
    sl_free(border);
    exp_sheet_close(&sheet);
    return status;
}

static sl_status show_all(exp_run *run, exp_page *page, exp_claims *claims)
{
    sl_status status = SL_OK;
    SL_TRY(exp_row(run, "pullover", show(run, page, claims, "pullover", 0)));
    SL_TRY(exp_row(run, "starfish", show(run, page, claims, "starfish", 0)));
cleanup:
    return status;
}

int main(int argc, char **argv)
{
    return exp_main(
        argc, argv, "fig11-network", "Figure 11: a network of constraints",
        "The paper: \"With our two simple modifications, ABF++ takes a network of geometric constraints into account. "
        "Complex relations between constrained angles (yellow dots) and straight seams (blue edges) are satisfied.\" "
        "Lines follow the quads' edges from border to border; where two cross, they do so at right angles. Lines and "
        "angles are tried one after another; one that contradicts the others or makes the chart overlap is left out.",
        EXPECTED_CSV, show_all);
}
