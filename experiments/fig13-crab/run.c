/* Figure 13: the crab. One half's charts are glued, then cloned to the other half; the texture is painted once. */
#include <math.h>
#include <stdio.h>

#include "generators.h"
#include "support/bake.h"
#include "support/edited.h"
#include "support/main.h"

enum { WIDTH = 1600, HEIGHT = 700, SEAMS = 10, TEXELS = 1024 };

static const double bound = 1.5; /* L2 that a glued chart may reach */

/* Shell in orange with darker rings, pale below. */
static void paint_crab(void *user, int32_t facet, const double uv[2], const double xyz[3], uint8_t rgb[3])
{
    static const uint8_t shell[3] = {226, 98, 40}, ring[3] = {150, 36, 22}, belly[3] = {250, 214, 170};
    (void)user;
    (void)facet;
    (void)uv;
    const double r = sqrt(xyz[0] * xyz[0] + xyz[2] * xyz[2]);
    const double wave = 0.5 + 0.5 * sin(90.0 * r + 6.0 * sin(14.0 * xyz[2]));
    const double pale = xyz[1] < -0.02 ? 0.7 : 0.0;
    for (int k = 0; k < 3; k++) {
        const double top = shell[k] + (wave > 0.75 ? 1.0 : 0.0) * (ring[k] - shell[k]);
        rgb[k] = (uint8_t)(top + pale * (belly[k] - top));
    }
}

/* Does the facet lie on the side that is edited? */
static bool is_left(const sl_mesh *mesh, int32_t f)
{
    double c[3];
    sl_mesh_face_centroid(mesh, f, c);
    return c[0] > 0.0;
}

static const sl_planted *find_mirror(const sl_generated *crab)
{
    for (int32_t k = 0; k < crab->nplanted; k++) {
        if (crab->planted[k].mirror) {
            return &crab->planted[k];
        }
    }
    return NULL;
}

/* Every chart of the left side that has room for its image: the image is cut alike and shares its UVs. */
static int32_t clone(exp_run *run, sl_session *session, const sl_planted *mirror)
{
    const sl_mesh *mesh = sl_session_mesh(session);
    int32_t clones = 0;
    for (int32_t i = 0; i < sl_session_slots(session); i++) {
        sl_session_chart chart;
        sl_session_chart_info(session, i, &chart);
        if (chart.faces == 0 || chart.copy_of >= 0 || !is_left(mesh, chart.face[0])) {
            continue;
        }
        const int32_t f = chart.face[0], v = mesh->input_vertex[mesh->origin[mesh->face_first[f]]];
        const int32_t item[4] = {v, f, mirror->vertex[v], mirror->face[f]};
        sl_action a = sl_action_default(SL_ACTION_SYMMETRY);
        a.facet = f;
        if (sl_action_set_items(&a, 4, item) == SL_OK) {
            clones += exp_session_try(run, session, &a);
        }
        sl_action_clear(&a);
    }
    return clones;
}

/* The axis first: a seam all around where the mirror's halves meet. */
static sl_status cut_axis(exp_run *run, sl_session *session, const sl_planted *mirror)
{
    const sl_mesh *mesh = sl_session_mesh(session);
    sl_status status = SL_OK;
    sl_action cut = sl_action_default(SL_ACTION_CUT_EDGES);
    int32_t *item = sl_alloc(2 * (int64_t)mesh->nh, sizeof *item), n = 0;
    SL_TRY(item != NULL ? SL_OK : SL_OUT_OF_MEMORY);
    for (int32_t h = 0; h < mesh->nh; h++) {
        const int32_t g = mesh->twin[h];
        if (g > h && mirror->face[mesh->face[h]] == mesh->face[g]) {
            item[n++] = mesh->input_vertex[mesh->origin[h]];
            item[n++] = mesh->input_vertex[sl_target(mesh, h)];
        }
    }
    if (n > 0) {
        SL_TRY(sl_action_set_items(&cut, n, item));
        SL_TRY(sl_session_apply(session, &cut, &run->context, &run->diag));
    }
cleanup:
    sl_action_clear(&cut);
    sl_free(item);
    return status;
}

static double share_of_copies(const sl_session *session)
{
    double copies = 0.0, all = 0.0;
    for (int32_t i = 0; i < sl_session_slots(session); i++) {
        sl_session_chart chart;
        sl_session_chart_info(session, i, &chart);
        all += chart.faces > 0 ? chart.distortion.area_3d : 0.0;
        copies += chart.faces > 0 && chart.copy_of >= 0 ? chart.distortion.area_3d : 0.0;
    }
    return copies / all;
}

static sl_status edit(exp_editing *e)
{
    sl_status status = SL_OK;
    const sl_planted *mirror = find_mirror(e->generated);
    SL_TRY(mirror != NULL ? SL_OK : SL_INTERNAL);
    SL_TRY(cut_axis(e->run, e->session, mirror));
    exp_claims_measure(e->claims, "crab", "seams glued",
                       exp_session_glue_where(e->run, e->session, SEAMS, bound, is_left));
    exp_claims_measure(e->claims, "crab", "charts cloned", clone(e->run, e->session, mirror));
cleanup:
    return status;
}

static sl_status paint(exp_editing *e)
{
    sl_status status = SL_OK;
    sl_image *texture = NULL;
    exp_claims_measure(e->claims, "crab", "texture saved", share_of_copies(e->session));
    SL_TRY(exp_bake(e->session, TEXELS, paint_crab, NULL, &texture));
    SL_TRY(exp_draw_textured(e->run, e->session, texture, &e->view, &e->picture, "textured.png"));
cleanup:
    sl_image_free(texture);
    return status;
}

static sl_status show(exp_run *run, exp_page *page, exp_claims *claims)
{
    const exp_edited figure = {
        .model = "crab",
        .width = WIDTH,
        .height = HEIGHT,
        .edit = edit,
        .finish = paint,
        .before = {"automatic.png", "the crab and its automatic atlas", "The automatic atlas."},
        .after = {"edited.png", "the crab after editing",
                  "One half edited, then cloned: what has one colour shares its UVs."},
        .more = {"textured.png", "the crab textured", "Painted on one half in 2D, seen on both."},
        .row = "edited and cloned"};
    return exp_edited_show(run, page, claims, &figure);
}

int main(int argc, char **argv)
{
    return exp_main(argc, argv, "fig13-crab", "Figure 13: the crab, edited on one side and mirror-cloned",
                    "The paper: \"This surface is a topological sphere. The legs make it impossible to select seams "
                    "with traditional tools.\" and \"texture can be edited, copy-pasted, mirror-cloned in 2D\". Here "
                    "the axis of symmetry is cut, seams of one half are glued by a rule that stands for the user, and "
                    "each chart of that half is cloned: its mirror image is cut alike and shares its UVs. The session "
                    "is <code>session.jsonl</code>.",
                    EXPECTED_CSV, show);
}
