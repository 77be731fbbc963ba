#include "support/session.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "image/png.h"

sl_atlas_def exp_session_def(void)
{
    sl_atlas_def def = sl_atlas_default();
    def.segment.sew = false;
    def.segment.symmetry = SL_SYMMETRY_USE_OFF;
    return def;
}

exp_state exp_session_state(const sl_session *session)
{
    exp_state state = {.constraints = sl_session_constraints(session),
                       .seam = sl_atlas_seam_diagonals(sl_session_mesh(session)),
                       .stretch = 1.0};
    for (int32_t i = 0; i < sl_session_slots(session); i++) {
        sl_session_chart chart;
        sl_session_chart_info(session, i, &chart);
        if (chart.faces > 0) {
            state.charts++;
            state.red += chart.red;
            state.stretch = fmax(state.stretch, chart.distortion.l2);
        }
    }
    return state;
}

bool exp_session_try(exp_run *run, sl_session *session, const sl_action *action)
{
    sl_diag diag = sl_diag_none();
    return sl_session_apply(session, action, &run->context, &diag) == SL_OK;
}

/* A seam between two charts. */
typedef struct candidate {
    int32_t facet[2];
    double length;
} candidate;

static int longest_first(const void *a, const void *b)
{
    const candidate *x = a, *y = b;
    return x->length > y->length   ? -1
           : x->length < y->length ? 1
                                   : (x->facet[0] > y->facet[0]) - (x->facet[0] < y->facet[0]);
}

/* All arcs between different charts; *list owned by the caller. */
static sl_status find_arcs(const sl_session *session, candidate **list, int32_t *count)
{
    const sl_mesh *mesh = sl_session_mesh(session);
    const int32_t *chart = sl_session_face_chart(session);
    sl_status status = SL_OK;
    int32_t *arc = NULL;
    int64_t room = 0;
    uint8_t *seen = sl_calloc(mesh->nh, 1);
    SL_TRY(seen != NULL ? SL_OK : SL_OUT_OF_MEMORY);
    for (int32_t h = 0; h < mesh->nh; h++) {
        const int32_t other = mesh->sew[h];
        int32_t n = 0;
        if (other < 0 || seen[h] != 0 || chart[mesh->face[h]] == chart[mesh->face[other]]) {
            continue;
        }
        candidate c = {{mesh->face[h], mesh->face[other]}, 0.0};
        SL_TRY(sl_session_arc(session, h, &arc, &n));
        for (int32_t k = 0; k < n; k++) {
            seen[arc[k]] = seen[mesh->sew[arc[k]]] = 1;
            c.length += sl_mesh_edge_length(mesh, arc[k]);
        }
        sl_free(arc);
        arc = NULL;
        SL_TRY(sl_reserve((void **)list, &room, (int64_t)*count + 1, sizeof **list));
        (*list)[(*count)++] = c;
    }
    if (*count > 1) {
        qsort(*list, (size_t)*count, sizeof **list, longest_first);
    }
cleanup:
    sl_free(seen);
    return status;
}

static bool is_good(const sl_session *session, int32_t facet, double stretch)
{
    sl_session_chart chart;
    sl_session_chart_info(session, sl_session_face_chart(session)[facet], &chart);
    return chart.red == 0 && chart.embedded && chart.distortion.l2 <= stretch;
}

/* Tries one merge as a drag would; what looks good is done. */
static bool glue_one(exp_run *run, sl_session *session, const candidate *c, double stretch)
{
    sl_action merge = sl_action_default(SL_ACTION_MERGE), undo = sl_action_default(SL_ACTION_UNDO);
    bool done = false;
    if (sl_action_set_items(&merge, 2, c->facet) == SL_OK &&
        sl_session_drag(session, &merge, &run->context, NULL) == SL_OK) {
        done = is_good(session, c->facet[0], stretch) && exp_session_try(run, session, &merge);
        if (done && !is_good(session, c->facet[0], stretch)) {
            done = !exp_session_try(run, session, &undo);
        }
    }
    sl_session_cancel_drag(session);
    sl_action_clear(&merge);
    return done;
}

int32_t exp_session_glue(exp_run *run, sl_session *session, int32_t count, double stretch)
{
    return exp_session_glue_where(run, session, count, stretch, NULL);
}

int32_t exp_session_glue_where(exp_run *run, sl_session *session, int32_t count, double stretch, exp_facet_fn *of)
{
    int32_t glued = 0;
    for (bool any = true; any && glued < count;) {
        candidate *list = NULL;
        int32_t n = 0;
        any = false;
        if (find_arcs(session, &list, &n) == SL_OK) {
            for (int32_t k = 0; k < n && !any; k++) {
                const sl_mesh *mesh = sl_session_mesh(session);
                any = (of == NULL || (of(mesh, list[k].facet[0]) && of(mesh, list[k].facet[1]))) &&
                      glue_one(run, session, &list[k], stretch);
            }
        }
        glued += any;
        sl_free(list);
    }
    return glued;
}

sl_status exp_session_draw(exp_run *run, const sl_session *session, const sl_view *view, const sl_picture *picture,
                           const char *file)
{
    char path[EXP_PATH];
    sl_image *image = NULL;
    sl_status status = SL_OK;
    SL_TRY(sl_session_picture(session, view, picture, &run->context, &image, &run->diag));
    SL_TRY(exp_path(run, file, path));
    SL_TRY(sl_png_write(path, image, &run->diag));
cleanup:
    sl_image_free(image);
    return status;
}

sl_status exp_session_finish(exp_run *run, sl_session *session, const sl_polygons *polygons, const char *name,
                             const sl_atlas_def *def, exp_claims *claims)
{
    char path[EXP_PATH];
    sl_script script = {0};
    sl_session *again = NULL;
    sl_atlas *atlas = NULL;
    sl_status status = SL_OK;
    SL_TRY(exp_path(run, "session.jsonl", path));
    SL_TRY(sl_session_log_to(session, path, name, &run->diag));
    SL_TRY(sl_script_read(path, false, &script, &run->diag));
    SL_TRY(sl_script_run(&script, -1, polygons, NULL, def, NULL, NULL, &run->context, &again, &run->diag));
    exp_claims_measure(claims, name, "replayed", sl_session_hash(again) == sl_session_hash(session));
    SL_TRY(sl_session_export(session, &run->context, &atlas, &run->diag));
    exp_claims_measure(claims, name, "certified", atlas->check.passed);
cleanup:
    sl_script_clear(&script);
    sl_session_free(again);
    sl_atlas_free(atlas);
    return status;
}

void exp_session_table(exp_page *page, int32_t count, const char *const *name, const exp_state *state)
{
    exp_page_table_begin(page, "state|charts|seam (diagonals)|constraints|red facets|worst L2");
    for (int32_t k = 0; k < count; k++) {
        exp_page_row_begin(page, false);
        exp_page_cell(page, "%s", name[k]);
        exp_page_cell(page, "%d", state[k].charts);
        exp_page_cell(page, "%.2f", state[k].seam);
        exp_page_cell(page, "%d", state[k].constraints);
        exp_page_cell(page, "%d", state[k].red);
        exp_page_cell(page, "%.3f", state[k].stretch);
        exp_page_row_end(page);
    }
    exp_page_table_end(page);
}
