/* Lines that a user might draw across a chart, picked by rule: along the quads' edges, or shortest paths on triangles.
 */
#include "support/sheet.h"

enum { MODES_SHORTEST = 8, TRIES = 60 };

static const double golden = 0.6180339887498949; /* spreads the tries over the border */

static bool on_line(const sl_constraint *line, int32_t v)
{
    for (int32_t k = 0; k < line->count; k++) {
        if (line->vertex[k] == v) {
            return true;
        }
    }
    return false;
}

/* Does the last line do what is wanted with regard to the first (CROSS, STOP) or to all (APART)? STOP cuts it off where
 * it meets the first. */
static bool fits(exp_wish *wish, exp_line_mode mode)
{
    sl_constraint *last = &wish->item[wish->count - 1];
    bool meets = false;
    for (int32_t k = 0; k + 1 < wish->count; k++) {
        for (int32_t i = 0; i < last->count; i++) {
            if (on_line(&wish->item[k], last->vertex[i])) {
                if (k > 0 || i == 0 || mode == EXP_LINE_APART) {
                    return false;
                }
                meets = true;
                last->count = mode == EXP_LINE_STOP ? i + 1 : last->count;
            }
        }
    }
    return last->count >= MODES_SHORTEST && meets == (mode != EXP_LINE_APART);
}

/* A line from a border vertex: along the quads, else the shortest path to the other side. */
static sl_status make_line(const exp_sheet *sheet, const int32_t *border, int32_t count, int32_t from,
                           exp_line_mode mode, exp_wish *wish, bool *made)
{
    sl_status status;
    *made = exp_wish_loop(sheet, border[from], wish, &status);
    if (status != SL_OK || *made) {
        return status;
    }
    const int32_t share = mode == EXP_LINE_APART && wish->count > 0 ? 4 : 2; /* beside a line across: a corner */
    const int32_t to = border[(from + count / share) % count];
    status = exp_wish_path(sheet, border[from], to, mode != EXP_LINE_APART, wish);
    *made = status == SL_OK;
    return status == SL_INFEASIBLE ? SL_OK : status;
}

sl_status exp_wish_line(exp_run *run, const exp_sheet *sheet, const int32_t *border, int32_t count, exp_line_mode mode,
                        exp_wish *wish)
{
    for (int k = 0; k < TRIES; k++) {
        const double share = golden * (k + 1 + 7 * wish->count);
        const int32_t from = (int32_t)((share - (double)(int32_t)share) * count);
        bool made = false, kept = false;
        sl_status status = make_line(sheet, border, count, from, mode, wish, &made);
        if (status == SL_OK && made && fits(wish, mode)) {
            status = exp_wish_good(run, sheet, wish, &kept);
        }
        if (status != SL_OK || kept) {
            return status;
        }
        if (made) {
            exp_wish_drop(wish);
        }
    }
    return SL_INFEASIBLE;
}
