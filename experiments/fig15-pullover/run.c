/* Figure 15: the pullover. The front is opened along a straight line for a zipper, hems and cuffs are straight, and
 * wool is laid along them. */
#include <math.h>
#include <stdio.h>

#include "knit.h"
#include "support/bake.h"
#include "support/edited.h"
#include "support/main.h"

enum { WIDTH = 1600, HEIGHT = 760, TEXELS = 2048, ROWS_A_PAGE = 150, SEAMS = 6 };

static const double bound = 1.5; /* L2 that a chart may reach */

/* An edge of the front's middle, where the zipper will be. */
static bool on_front_line(const sl_mesh *mesh, int32_t h)
{
    const double *a = mesh->xyz + 3 * (int64_t)mesh->origin[h], *b = mesh->xyz + 3 * (int64_t)sl_target(mesh, h);
    const double at = -mesh->centre[0] * mesh->scale; /* x = 0 of the input */
    return fabs(a[0] - at) < 1e-9 && fabs(b[0] - at) < 1e-9 && a[2] + b[2] > -2.0 * mesh->centre[2] * mesh->scale;
}

/* Does the border run on in the same way: along the zipper, or along a hem? */
typedef bool border_kind(const sl_mesh *mesh, int32_t h);

static bool is_zipper(const sl_mesh *mesh, int32_t h)
{
    return mesh->sew[h] >= 0 && on_front_line(mesh, h);
}

static bool is_hem(const sl_mesh *mesh, int32_t h)
{
    return mesh->sew[h] < 0 && mesh->twin[h] < 0;
}

static int32_t border_next(const sl_mesh *mesh, int32_t h)
{
    int32_t g = sl_next(mesh, h);
    while (mesh->twin[g] >= 0) {
        g = sl_next(mesh, mesh->twin[g]);
    }
    return g;
}

static bool cut_front(exp_run *run, sl_session *session)
{
    const sl_mesh *mesh = sl_session_mesh(session);
    sl_action cut = sl_action_default(SL_ACTION_CUT_EDGES);
    int32_t *item = sl_alloc(2 * (int64_t)mesh->nh, sizeof *item), n = 0;
    for (int32_t h = 0; item != NULL && h < mesh->nh; h++) {
        if (mesh->twin[h] > h && on_front_line(mesh, h)) {
            item[n++] = mesh->input_vertex[mesh->origin[h]];
            item[n++] = mesh->input_vertex[sl_target(mesh, h)];
        }
    }
    const bool done = n > 0 && sl_action_set_items(&cut, n, item) == SL_OK && exp_session_try(run, session, &cut);
    sl_action_clear(&cut);
    sl_free(item);
    return done;
}

/* What makes a chart overlap itself is taken back. */
static bool try_straight(exp_run *run, sl_session *session, const sl_action *a, int32_t h)
{
    const sl_action undo = sl_action_default(SL_ACTION_UNDO);
    sl_session_chart chart;
    if (!exp_session_try(run, session, a)) {
        return false;
    }
    sl_session_chart_info(session, sl_session_face_chart(session)[sl_session_mesh(session)->face[h]], &chart);
    return chart.embedded || !exp_session_try(run, session, &undo);
}

/* Makes each run of border of a kind straight, from its first to its last vertex; returns how many. */
static int32_t straighten_runs(exp_run *run, sl_session *session, border_kind *kind)
{
    const sl_mesh *mesh = sl_session_mesh(session);
    int32_t done = 0;
    for (int32_t h = 0; h < mesh->nh; h++) {
        if (mesh->twin[h] >= 0 || !kind(mesh, h)) {
            continue;
        }
        int32_t before = h, last, edges = 1; /* is h the first of its run? */
        for (before = sl_prev(mesh, h); mesh->twin[before] >= 0; before = sl_prev(mesh, mesh->twin[before])) {
        }
        if (kind(mesh, before)) {
            continue;
        }
        for (last = border_next(mesh, h); kind(mesh, last); last = border_next(mesh, last)) {
            edges++;
        }
        int32_t item[4];
        sl_action a = sl_action_default(SL_ACTION_STRAIGHTEN_BORDER);
        sl_session_name_corner(session, h, item);
        sl_session_name_corner(session, last, item + 2);
        if (edges > 1 && sl_action_set_items(&a, 4, item) == SL_OK && try_straight(run, session, &a, h)) {
            done++;
        }
        sl_action_clear(&a);
    }
    return done;
}

/* The worst distance of a vertex of a straight line from its chord, over the chord. */
static double worst_bend(const sl_session *session)
{
    double worst = 0.0;
    for (int32_t i = 0; i < sl_session_constraints(session); i++) {
        sl_session_constraint c;
        sl_session_constraint_at(session, i, &c);
        const double *a = sl_session_corner_uv(session) + 2 * (int64_t)c.corner[0];
        const double *b = sl_session_corner_uv(session) + 2 * (int64_t)c.corner[c.count - 1];
        const double d[2] = {b[0] - a[0], b[1] - a[1]}, square = d[0] * d[0] + d[1] * d[1];
        for (int32_t k = 1; k + 1 < c.count; k++) {
            const double *p = sl_session_corner_uv(session) + 2 * (int64_t)c.corner[k];
            worst = fmax(worst, fabs(d[0] * (p[1] - a[1]) - d[1] * (p[0] - a[0])) / square);
        }
    }
    return worst;
}

/* A frame for each chart from its first straight line; the zipper's from the collar (its higher end) down. */
static void hang_up(const sl_session *session, knit_frame *frame)
{
    const sl_mesh *mesh = sl_session_mesh(session);
    for (int32_t i = 0; i < sl_session_slots(session); i++) {
        frame[i] = (knit_frame){{0.0, 0.0}, {0.0, 1.0}, 0.0};
    }
    for (int32_t i = sl_session_constraints(session) - 1; i >= 0; i--) {
        sl_session_constraint c;
        sl_session_constraint_at(session, i, &c);
        const int32_t from = c.corner[0], to = c.corner[c.count - 1];
        const bool zipper = is_zipper(mesh, c.corner[0]);
        const bool down =
            mesh->xyz[3 * (int64_t)mesh->origin[from] + 1] >= mesh->xyz[3 * (int64_t)mesh->origin[to] + 1];
        const double *a = sl_session_corner_uv(session) + 2 * (int64_t)(down ? from : to);
        const double *b = sl_session_corner_uv(session) + 2 * (int64_t)(down ? to : from);
        const double d[2] = {b[0] - a[0], b[1] - a[1]}, length = hypot(d[0], d[1]);
        knit_frame *f = &frame[c.slot];
        if (zipper) { /* rows at right angles to it */
            *f = (knit_frame){{a[0], a[1]}, {d[0] / length, d[1] / length}, length};
        } else if (f->length == 0.0) { /* rows along the hem */
            *f = (knit_frame){{a[0], a[1]}, {-d[1] / length, d[0] / length}, 0.0};
        }
    }
}

static sl_status dress(exp_run *run, const sl_session *session, const sl_view *view, const sl_picture *picture)
{
    sl_status status = SL_OK;
    sl_image *texture = NULL;
    knit_frame *frame = sl_alloc(sl_session_slots(session), sizeof *frame);
    SL_TRY(frame != NULL ? SL_OK : SL_OUT_OF_MEMORY);
    hang_up(session, frame);
    knit k = {sl_session_face_chart(session), frame, 1.0 / ROWS_A_PAGE};
    SL_TRY(exp_bake(session, TEXELS, knit_paint, &k, &texture));
    SL_TRY(exp_draw_textured(run, session, texture, view, picture, "wool.png"));
cleanup:
    sl_image_free(texture);
    sl_free(frame);
    return status;
}

static sl_status edit(exp_editing *e)
{
    exp_claims_measure(e->claims, "pullover", "seams glued", exp_session_glue(e->run, e->session, SEAMS, bound));
    exp_claims_measure(e->claims, "pullover", "front opened", cut_front(e->run, e->session));
    exp_claims_measure(e->claims, "pullover", "sides of the zipper straight",
                       straighten_runs(e->run, e->session, is_zipper));
    exp_claims_measure(e->claims, "pullover", "hems straight", straighten_runs(e->run, e->session, is_hem));
    return SL_OK;
}

static sl_status finish(exp_editing *e)
{
    exp_claims_measure(e->claims, "pullover", "off the lines", worst_bend(e->session));
    return dress(e->run, e->session, &e->view, &e->picture);
}

static sl_status show(exp_run *run, exp_page *page, exp_claims *claims)
{
    const exp_edited figure = {
        .model = "pullover",
        .width = WIDTH,
        .height = HEIGHT,
        .edit = edit,
        .finish = finish,
        .before = {"automatic.png", "the pullover and its automatic atlas", "The automatic atlas."},
        .after = {"straightened.png", "the pullover with straight lines",
                  "The front opened and straight on both sides, hems and cuffs straight (blue)."},
        .more = {"wool.png", "the pullover knitted, with a zipper",
                 "A repetitive pattern (wool) in rows along the lines, and a zipper in its place."},
        .row = "edited"};
    return exp_edited_show(run, page, claims, &figure);
}

int main(int argc, char **argv)
{
    return exp_main(argc, argv, "fig15-pullover", "Figure 15: the pullover, wool and a zipper",
                    "The paper: \"Our structure-aware unwrapping and straightness constraints facilitate using "
                    "repetitive patterns (wool) and placing structured elements (zipper).\" Here charts are glued by a "
                    "rule that stands for the user, the front is opened along its middle, and both sides of it, the "
                    "hem, the cuffs and the collar are made straight. The session is <code>session.jsonl</code>.",
                    EXPECTED_CSV, show);
}
