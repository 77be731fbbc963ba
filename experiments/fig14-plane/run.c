/* Figure 14: a plane; after the automatic segmentation eight seams are glued. */
#include "generators.h"
#include "support/main.h"
#include "support/pictures.h"
#include "support/session.h"

enum { WIDTH = 1600, HEIGHT = 700, SEAMS = 8 };

static const double bound = 1.5; /* L2 that a glued chart may reach */

static sl_status edit(exp_run *run, exp_page *page, exp_claims *claims, const sl_polygons *polygons)
{
    sl_status status = SL_OK;
    sl_session *session = NULL;
    sl_action open = sl_action_default(SL_ACTION_OPEN), pack = sl_action_default(SL_ACTION_PACK);
    const sl_atlas_def def = exp_session_def();
    const sl_view view = exp_view_of("airplane");
    const sl_picture picture = exp_picture(run, WIDTH, HEIGHT);
    exp_state state[2];
    SL_TRY(sl_session_create(polygons, NULL, &open, &def, &run->context, &session, &run->diag));
    state[0] = exp_session_state(session);
    SL_TRY(exp_session_draw(run, session, &view, &picture, "automatic.png"));
    const int32_t glued = exp_session_glue(run, session, SEAMS, bound);
    SL_TRY(sl_session_apply(session, &pack, &run->context, &run->diag));
    state[1] = exp_session_state(session);
    SL_TRY(exp_session_draw(run, session, &view, &picture, "refined.png"));
    SL_TRY(exp_session_finish(run, session, polygons, "airplane", &def, claims));
    exp_claims_measure(claims, "airplane", "seams glued", glued);
    exp_claims_measure(claims, "airplane", "red facets", state[1].red);
    exp_claims_measure(claims, "airplane", "worst L2", state[1].stretch);
    exp_claims_measure(claims, "airplane", "seam left", state[1].seam / state[0].seam);
    exp_page_figure(page, "", "automatic.png", "the plane and its automatic atlas",
                    "The automatic segmentation, and the atlas that the user starts with.");
    exp_page_figure(page, "yes", "refined.png", "the plane after eight seams were glued",
                    "Eight seams glued: model and parameterization, packed anew.");
    exp_session_table(page, 2, (const char *const[]){"automatic", "eight seams glued"}, state);
cleanup:
    sl_session_free(session);
    return status;
}

static sl_status show(exp_run *run, exp_page *page, exp_claims *claims)
{
    sl_status status = SL_OK;
    sl_generated *plane = NULL;
    sl_polygons polygons;
    SL_TRY(sl_generator_find("airplane")->make(1, run->quick ? 0 : 1, &plane));
    sl_generated_polygons(plane, &polygons);
    SL_TRY(edit(run, page, claims, &polygons));
cleanup:
    sl_generated_free(plane);
    return status;
}

int main(int argc, char **argv)
{
    return exp_main(argc, argv, "fig14-plane", "Figure 14: a plane, eight seams glued",
                    "The paper: \"After the initial automatic segmentation was obtained (in less than 2 minutes), the "
                    "user glued 8 seams.\" Here a rule stands for the user: the longest seam between two charts first, "
                    "passed over where the glued chart would overlap itself or stretch beyond L2 1.5. The session is "
                    "<code>session.jsonl</code>, to be replayed by <code>seamlab replay</code>.",
                    EXPECTED_CSV, show);
}
