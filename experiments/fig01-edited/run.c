/* Figure 1: the automatic atlas, and what a user makes of it: charts glued, seams straight (blue). */
#include <math.h>
#include <stdlib.h>

#include "support/edited.h"
#include "support/main.h"

enum { WIDTH = 1600, HEIGHT = 700, SEAMS = 6, LINES = 4, TRIED = 60, LEAST_EDGES = 6 };

static const double bound = 1.4;       /* L2 that a chart may reach */
static const double line_share = 0.25; /* of an arc of seam, from its middle, is made straight */

/* An arc of seam and one of its edges. */
typedef struct line {
    int32_t halfedge, edges;
} line;

static int longest_first(const void *a, const void *b)
{
    const line *x = a, *y = b;
    return x->edges != y->edges ? y->edges - x->edges : x->halfedge - y->halfedge;
}

/* The longest arcs of seam, one halfedge each; returns how many. */
static int32_t find_lines(const sl_session *session, line *list)
{
    const sl_mesh *mesh = sl_session_mesh(session);
    line *all = sl_alloc(mesh->nh, sizeof *all);
    uint8_t *seen = sl_calloc(mesh->nh, 1);
    int32_t n = 0, kept;
    for (int32_t h = 0; all != NULL && seen != NULL && h < mesh->nh; h++) {
        int32_t *arc = NULL, count = 0;
        if (mesh->sew[h] >= 0 && seen[h] == 0 && sl_session_arc(session, h, &arc, &count) == SL_OK) {
            for (int32_t k = 0; k < count; k++) {
                seen[arc[k]] = seen[mesh->sew[arc[k]]] = 1;
            }
            all[n++] = (line){arc[0], count};
        }
        sl_free(arc);
    }
    if (n > 1) {
        qsort(all, (size_t)n, sizeof *all, longest_first);
    }
    for (kept = 0; kept < n && kept < TRIED; kept++) {
        list[kept] = all[kept];
    }
    sl_free(all);
    sl_free(seen);
    return kept;
}

/* A part of an arc, straight on both its sides. */
static bool straighten(exp_run *run, sl_session *session, const line *l)
{
    int32_t *arc = NULL, count = 0, item[4];
    bool done = false;
    sl_action a = sl_action_default(SL_ACTION_STRAIGHTEN_BORDER), undo = sl_action_default(SL_ACTION_UNDO);
    if (sl_session_arc(session, l->halfedge, &arc, &count) != SL_OK || count < LEAST_EDGES) {
        sl_free(arc);
        return false;
    }
    const int32_t half = 1 + (int32_t)(0.5 * line_share * count), from = count / 2 - half, to = count / 2 + half;
    int sides = 0;
    bool good = true;
    for (int side = 0; side < 2 && good; side++) {
        const sl_mesh *mesh = sl_session_mesh(session);
        const int32_t start = side == 0 ? arc[from] : mesh->sew[arc[to - 1]];
        const int32_t end = side == 0 ? arc[to] : mesh->sew[arc[from - 1]];
        sl_session_name_corner(session, start, item);
        sl_session_name_corner(session, end, item + 2);
        good = sl_action_set_items(&a, 4, item) == SL_OK && exp_session_try(run, session, &a);
        sides += good;
        sl_session_chart chart;
        sl_session_chart_info(session, sl_session_face_chart(session)[mesh->face[start]], &chart);
        good = good && chart.red == 0 && chart.distortion.l2 <= bound;
    }
    undo.steps = sides;
    if (!good && sides > 0 && !exp_session_try(run, session, &undo)) {
        good = false;
    }
    done = good;
    sl_action_clear(&a);
    sl_free(arc);
    return done;
}

/* The longest arcs that take it, until there are enough lines. */
static int32_t straighten_longest(exp_run *run, sl_session *session)
{
    line lines[TRIED];
    const int32_t found = find_lines(session, lines);
    int32_t straight = 0;
    for (int32_t k = 0; k < found && straight < LINES; k++) {
        straight += straighten(run, session, &lines[k]);
    }
    return straight;
}

static sl_status edit(exp_editing *e)
{
    exp_claims_measure(e->claims, "quadruped", "seams glued", exp_session_glue(e->run, e->session, SEAMS, bound));
    exp_claims_measure(e->claims, "quadruped", "seams straightened", straighten_longest(e->run, e->session));
    return SL_OK;
}

static sl_status finish(exp_editing *e)
{
    exp_claims_measure(e->claims, "quadruped", "charts saved", e->before.charts - e->after.charts);
    return SL_OK;
}

static sl_status show(exp_run *run, exp_page *page, exp_claims *claims)
{
    const exp_edited figure = {
        .model = "quadruped",
        .width = WIDTH,
        .height = HEIGHT,
        .edit = edit,
        .finish = finish,
        .before = {"automatic.png", "the model and its automatic atlas",
                   "<b>Left</b> of the paper's figure: the seams proposed (black) and a valid texture mapping."},
        .after = {"edited.png", "the model after editing",
                  "<b>Right</b>: charts sewn, parts of the seams constrained to be straight (blue)."},
        .row = "edited"};
    return exp_edited_show(run, page, claims, &figure);
}

int main(int argc, char **argv)
{
    return exp_main(
        argc, argv, "fig01-edited", "Figure 1: where the user starts, and where one gets",
        "The paper: \"our system automatically proposes an initial set of seams (black lines) and a valid "
        "texture mapping that the user starts with. Right: the user can interactively improve the mapping, "
        "by sewing charts and constraining seams (blue lines).\" Rules stand for the user here; the session "
        "is <code>session.jsonl</code>.",
        EXPECTED_CSV, show);
}
