/* Figures 3, 4 and 5 as sessions: the thumbs that cross, sewn; the same untangled by an angle; a line made straight. */
#include "generators.h"
#include "support/main.h"
#include "support/pictures.h"
#include "support/session.h"
#include "support/zipper.h"

#include <math.h>
#include <stdio.h>

enum { WIDTH = 1400, HEIGHT = 640, MOST_TURNS = 24 };

static const double root = 0.42, turn = 10.0; /* how far the zipper is closed first; degrees a turn */

/* What all three begin with. */
typedef struct hand {
    sl_generated *generated;
    sl_polygons polygons;
    sl_atlas_def def;
    int32_t start[3];                /* side [v, w, facet] at the wrist, to zip from */
    int32_t root_vertex, tip_vertex; /* where the zipper stops */
} hand;

/* Vertices along the zipper, from the wrist up. */
static int32_t vertex_at(const zipper *zip, int32_t k)
{
    const sl_mesh *m = zip->mesh;
    const int32_t h = zip->halfedge[k], other = zip->halfedge[k + 1 < zip->count ? k + 1 : k - 1];
    const bool meets = m->origin[other] == sl_target(m, h) || sl_target(m, other) == sl_target(m, h);
    const bool last = k + 1 == zip->count;
    return m->input_vertex[meets != last ? sl_target(m, h) : m->origin[h]];
}

static sl_status find_zipper(exp_run *run, hand *h)
{
    sl_status status = SL_OK;
    sl_mesh *mesh = NULL;
    sl_triangulation *t = NULL;
    zipper zip = {0};
    SL_TRY(sl_mesh_build(&h->polygons, &mesh, NULL, &run->diag));
    SL_TRY(sl_triangulation_create(mesh, &t));
    SL_TRY(zipper_open(mesh, t, &run->context, &zip));
    const int32_t first = zip.halfedge[0], second = vertex_at(&zip, 0);
    const int32_t a = mesh->input_vertex[mesh->origin[first]], b = mesh->input_vertex[sl_target(mesh, first)];
    h->start[0] = a == second ? b : a;
    h->start[1] = second;
    h->start[2] = mesh->face[first];
    for (int32_t k = 0; k < zip.count; k++) {
        if (zip.height[k] <= root) {
            h->root_vertex = vertex_at(&zip, k);
        }
    }
    h->tip_vertex = vertex_at(&zip, zip.count - 1);
cleanup:
    zipper_clear(&zip);
    sl_triangulation_free(t);
    sl_mesh_free(mesh);
    return status;
}

static sl_status open_session(exp_run *run, const hand *h, sl_session **session)
{
    const sl_action open = sl_action_default(SL_ACTION_OPEN);
    return sl_session_create(&h->polygons, NULL, &open, &h->def, &run->context, session, &run->diag);
}

static sl_status zip_to(exp_run *run, sl_session *session, const hand *h, int32_t vertex)
{
    sl_action sew = sl_action_default(SL_ACTION_SEW);
    sew.to = vertex;
    sl_status status = sl_action_set_items(&sew, 3, h->start);
    if (status == SL_OK) {
        status = sl_session_apply(session, &sew, &run->context, &run->diag);
    }
    sl_action_clear(&sew);
    return status;
}

static sl_status show_state(exp_run *run, exp_page *page, const sl_session *session, const char *file,
                            const char *caption, exp_state *state)
{
    const sl_picture picture = exp_picture(run, WIDTH, HEIGHT);
    sl_view view = exp_view_of("hand");
    view.azimuth -= 50.0;
    *state = exp_session_state(session);
    const sl_status status = exp_session_draw(run, session, &view, &picture, file);
    if (status == SL_OK) {
        exp_page_figure(page, state->red == 0 ? "yes" : "", file, "the hand and its atlas", caption);
    }
    return status;
}

/* Figure 3: from the root of the thumb on to its tip. The seam goes on where it was left: the start stays the wrist's.
 */
static sl_status sew_thumbs(exp_run *run, exp_page *page, exp_claims *claims, const hand *h)
{
    sl_status status = SL_OK;
    sl_session *session = NULL;
    sl_action undo = sl_action_default(SL_ACTION_UNDO);
    exp_state state[3];
    SL_TRY(open_session(run, h, &session));
    SL_TRY(show_state(run, page, session, "automatic.png", "<b>The automatic atlas</b>: palm and back.", &state[0]));
    SL_TRY(zip_to(run, session, h, h->root_vertex));
    SL_TRY(
        show_state(run, page, session, "crossing.png",
                   "<b>Figure 3</b>, sewn from the wrist to the root of the thumb: the two thumbs cross, red in both "
                   "views.",
                   &state[1]));
    SL_TRY(sl_session_apply(session, &undo, &run->context, &run->diag)); /* one zip from the wrist, further */
    SL_TRY(zip_to(run, session, h, h->tip_vertex));
    SL_TRY(show_state(run, page, session, "glued.png", "<b>Sewn to the tip</b>: nothing is red.", &state[2]));
    SL_TRY(exp_session_finish(run, session, &h->polygons, "figure 3", &h->def, claims));
    exp_claims_measure(claims, "figure 3", "red facets before", state[1].red);
    exp_claims_measure(claims, "figure 3", "red facets after", state[2].red);
    exp_session_table(page, 3, (const char *const[]){"automatic", "sewn to the root", "sewn to the tip"}, state);
cleanup:
    sl_session_free(session);
    return status;
}

/* A corner of the vertex on the border, with its angle. */
static int32_t border_corner(const sl_session *session, int32_t vertex, double *degrees)
{
    const sl_mesh *mesh = sl_session_mesh(session);
    for (int32_t h = 0; h < mesh->nh; h++) {
        if (mesh->input_vertex[mesh->origin[h]] == vertex && mesh->twin[h] < 0) {
            *degrees = sl_session_planar_angle(session, h);
            return h;
        }
    }
    return -1;
}

/* Turns the angle at a corner until nothing is red; how many turns it took, -1 = it does not help. The session is as
 * it was then. */
static int32_t turn_until_clear(exp_run *run, sl_session *session, const int32_t corner[2], double from, double step)
{
    for (int32_t k = 1; k <= MOST_TURNS; k++) {
        sl_action angle = sl_action_default(SL_ACTION_ANGLE);
        angle.number = from + step * k;
        const bool done = sl_action_set_items(&angle, 2, corner) == SL_OK && exp_session_try(run, session, &angle);
        sl_action_clear(&angle);
        if (!done) {
            return -1;
        }
        if (exp_session_state(session).red == 0) {
            return k;
        }
        sl_action undo = sl_action_default(SL_ACTION_UNDO);
        if (!exp_session_try(run, session, &undo)) {
            return -1;
        }
    }
    return -1;
}

/* Figure 4: the same overlap, untangled by the angle between the thumbs. */
static sl_status turn_thumbs(exp_run *run, exp_page *page, exp_claims *claims, const hand *h)
{
    sl_status status = SL_OK;
    sl_session *session = NULL;
    exp_state state[2];
    double degrees = 0.0;
    int32_t corner[2], turns;
    char caption[200];
    SL_TRY(open_session(run, h, &session));
    SL_TRY(zip_to(run, session, h, h->root_vertex));
    state[0] = exp_session_state(session);
    const int32_t at = border_corner(session, h->root_vertex, &degrees);
    SL_TRY(at >= 0 ? SL_OK : SL_CHECK_FAILED);
    sl_session_name_corner(session, at, corner);
    turns = turn_until_clear(run, session, corner, degrees, -turn);
    turns = turns >= 0 ? turns : turn_until_clear(run, session, corner, degrees, turn);
    snprintf(caption, sizeof caption,
             "<b>Figure 4</b>: the angle at the yellow dot was %.0f&deg;, and is turned in steps of %.0f&deg; until "
             "nothing is red.",
             degrees, turn);
    SL_TRY(show_state(run, page, session, "turned.png", caption, &state[1]));
    SL_TRY(exp_session_finish(run, session, &h->polygons, "figure 4", &h->def, claims));
    exp_claims_measure(claims, "figure 4", "red facets before", state[0].red);
    exp_claims_measure(claims, "figure 4", "red facets after", state[1].red);
    exp_session_table(page, 2, (const char *const[]){"sewn to the root", "angle turned"}, state);
cleanup:
    sl_session_free(session);
    return status;
}

/* Figure 5: the border at the wrist of the palm, made straight. */
static sl_status straighten(exp_run *run, exp_page *page, exp_claims *claims, const hand *h)
{
    sl_status status = SL_OK;
    sl_session *session = NULL;
    sl_action line = sl_action_default(SL_ACTION_STRAIGHTEN_BORDER);
    exp_state state;
    int32_t ends[4], *arc = NULL, count = 0;
    SL_TRY(open_session(run, h, &session));
    const int32_t side = sl_session_find_side(session, h->start[0], h->start[1], h->start[2]);
    SL_TRY(side >= 0 ? SL_OK : SL_CHECK_FAILED);
    SL_TRY(sl_session_arc(session, side, &arc, &count));
    sl_session_name_corner(session, arc[0], ends);
    sl_session_name_corner(session, arc[count / 8], ends + 2);
    SL_TRY(sl_action_set_items(&line, 4, ends));
    SL_TRY(sl_session_apply(session, &line, &run->context, &run->diag));
    SL_TRY(show_state(run, page, session, "straight.png",
                      "<b>Figure 5</b>: a stretch of the seam made straight (blue).", &state));
    SL_TRY(exp_session_finish(run, session, &h->polygons, "figure 5", &h->def, claims));
    exp_claims_measure(claims, "figure 5", "constraints", state.constraints);
cleanup:
    sl_action_clear(&line);
    sl_free(arc);
    sl_session_free(session);
    return status;
}

static sl_status show(exp_run *run, exp_page *page, exp_claims *claims)
{
    sl_status status = SL_OK;
    hand h = {.def = sl_atlas_default()};
    h.def.segment = sl_segment_paper();
    h.def.segment.symmetry = SL_SYMMETRY_USE_OFF;
    SL_TRY(sl_generator_find("hand")->make(1, 1, &h.generated));
    sl_generated_polygons(h.generated, &h.polygons);
    SL_TRY(find_zipper(run, &h));
    SL_TRY(sew_thumbs(run, page, claims, &h));
    SL_TRY(turn_thumbs(run, page, claims, &h));
    SL_TRY(straighten(run, page, claims, &h));
cleanup:
    sl_generated_free(h.generated);
    return status;
}

int main(int argc, char **argv)
{
    return exp_main(
        argc, argv, "hand-sessions", "Figures 3 to 5 as sessions",
        "What the paper's user does by mouse, as lines of a session's script: \"the user can glue the two "
        "thumbs and resolve the overlaps\" (Fig. 3); \"to untangle overlap, besides sewing the sides of the "
        "overlap, the user can also install an angle constraint (yellow dot)\" (Fig. 4); \"seams can be "
        "constrained to be straight in UV space\" (Fig. 5). Each session is replayed and must give the same.",
        EXPECTED_CSV, show);
}
