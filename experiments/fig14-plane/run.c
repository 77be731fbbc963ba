/* Figure 14: a plane; after the automatic segmentation eight seams are glued. */
#include "support/edited.h"
#include "support/main.h"

enum { WIDTH = 1600, HEIGHT = 700, SEAMS = 8 };

static const double bound = 1.5; /* L2 that a glued chart may reach */

static sl_status edit(exp_editing *e)
{
    exp_claims_measure(e->claims, "airplane", "seams glued", exp_session_glue(e->run, e->session, SEAMS, bound));
    return SL_OK;
}

static sl_status finish(exp_editing *e)
{
    exp_claims_measure(e->claims, "airplane", "worst L2", e->after.stretch);
    exp_claims_measure(e->claims, "airplane", "seam left", e->after.seam / e->before.seam);
    return SL_OK;
}

static sl_status show(exp_run *run, exp_page *page, exp_claims *claims)
{
    const exp_edited figure = {.model = "airplane",
                               .width = WIDTH,
                               .height = HEIGHT,
                               .edit = edit,
                               .finish = finish,
                               .before = {"automatic.png", "the plane and its automatic atlas",
                                          "The automatic segmentation, and the atlas that the user starts with."},
                               .after = {"refined.png", "the plane after eight seams were glued",
                                         "Eight seams glued: model and parameterization, packed anew."},
                               .row = "eight seams glued"};
    return exp_edited_show(run, page, claims, &figure);
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
