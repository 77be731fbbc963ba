#include "view/state.h"

#include "base/memory.h"

#include <jansson.h>
#include <math.h>
#include <string.h>

static json_t *numbers(const double *value, int32_t count)
{
    json_t *array = json_array();
    for (int32_t k = 0; k < count; k++) {
        json_array_append_new(array, json_real(isfinite(value[k]) ? value[k] : 0.0));
    }
    return array;
}

static json_t *wholes(const int32_t *value, int32_t count)
{
    json_t *array = json_array();
    for (int32_t k = 0; k < count; k++) {
        json_array_append_new(array, json_integer(value[k]));
    }
    return array;
}

static char *dump(json_t *object)
{
    char *text = json_dumps(object, JSON_COMPACT | JSON_REAL_PRECISION(12));
    json_decref(object);
    return text;
}

static json_t *number_or_null(double value)
{
    return isfinite(value) ? json_real(value) : json_null();
}

static json_t *charts(const sl_session *session)
{
    json_t *array = json_array();
    for (int32_t s = 0; s < sl_session_slots(session); s++) {
        sl_session_chart chart;
        sl_session_chart_info(session, s, &chart);
        if (chart.faces == 0) {
            continue;
        }
        json_array_append_new(
            array, json_pack("{s:i, s:i, s:i, s:i, s:i, s:o, s:o, s:o, s:o, s:s, s:b}", "slot", (int)s, "facet",
                             (int)chart.face[0], "facets", (int)chart.faces, "copy_of", (int)chart.copy_of, "red",
                             (int)chart.red, "l2", number_or_null(chart.distortion.l2), "angle",
                             number_or_null(chart.distortion.angle_mean), "low", numbers(chart.low, 2), "high",
                             numbers(chart.high, 2), "method", sl_flatten_method_name(chart.method), "minimised",
                             (int)chart.minimised));
    }
    return array;
}

static json_t *history(const sl_session *session, int32_t *cursor)
{
    json_t *array = json_array();
    const int32_t count = sl_session_history(session, cursor);
    for (int32_t k = 0; k < count; k++) {
        json_array_append_new(array, json_string(sl_session_history_line(session, k)));
    }
    return array;
}

/* Where a corner is, in both panes. */
static json_t *place_of(const sl_session *session, int32_t h)
{
    const sl_mesh *mesh = sl_session_mesh(session);
    return json_pack("{s:o, s:o}", "xyz", numbers(mesh->xyz + 3 * (int64_t)mesh->origin[h], 3), "uv",
                     numbers(sl_session_corner_uv(session) + 2 * (int64_t)h, 2));
}

static json_t *constraints(const sl_session *session)
{
    json_t *array = json_array();
    for (int32_t k = 0; k < sl_session_constraints(session); k++) {
        sl_session_constraint c;
        sl_session_constraint_at(session, k, &c);
        json_t *places = json_array();
        for (int32_t i = 0; i < c.count; i++) {
            json_array_append_new(places, place_of(session, c.corner[i]));
        }
        json_array_append_new(array, json_pack("{s:i, s:s, s:f, s:i, s:o}", "id", (int)c.id, "kind",
                                               sl_action_name(c.kind), "degrees", isfinite(c.degrees) ? c.degrees : 0.0,
                                               "slot", (int)c.slot, "at", places));
    }
    return array;
}

static json_t *notes(const sl_session *session)
{
    json_t *array = json_array();
    for (int32_t k = 0; k < sl_session_notes(session); k++) {
        json_array_append_new(array, json_string(sl_session_note(session, k)));
    }
    return array;
}

char *sl_state_text(const sl_session *session, const sl_scene_view *view, bool can_save, bool texture)
{
    int32_t cursor = 0;
    json_t *lines = history(session, &cursor);
    return dump(json_pack("{s:s, s:I, s:i, s:i, s:i, s:b, s:b, s:o, s:o, s:o, s:o}", "t", "state", "revision",
                          (json_int_t)sl_session_revision(session), "facets", (int)sl_session_mesh(session)->nf, "red",
                          (int)sl_scene_view_red(view), "cursor", (int)cursor, "can_save", (int)can_save, "texture",
                          (int)texture, "history", lines, "charts", charts(session), "constraints",
                          constraints(session), "notes", notes(session)));
}

char *sl_state_hit(const sl_session *session, sl_pane pane, const sl_scene_hit *hit)
{
    const sl_mesh *mesh = sl_session_mesh(session);
    const char *name = pane == SL_PANE_3D ? "3d" : "uv";
    if (hit->facet < 0) {
        return dump(json_pack("{s:s, s:s, s:i}", "t", "at", "pane", name, "facet", -1));
    }
    int32_t corner[2], side[3];
    sl_session_chart chart;
    const int32_t slot = sl_session_face_chart(session)[hit->facet];
    sl_session_name_corner(session, hit->corner, corner);
    sl_session_name_side(session, hit->side, side);
    sl_session_chart_info(session, slot, &chart);
    return dump(json_pack("{s:s, s:s, s:i, s:i, s:o, s:o, s:o, s:o, s:o, s:b, s:b, s:o, s:o, s:i, s:o}", "t", "at",
                          "pane", name, "facet", (int)side[2], "slot", (int)slot, "corner", wholes(corner, 2), "place",
                          place_of(session, hit->corner), "side", wholes(side, 3), "from", place_of(session, hit->side),
                          "to", place_of(session, sl_next(mesh, hit->side)), "seam", mesh->sew[hit->side] >= 0,
                          "border", mesh->twin[hit->side] < 0, "angle",
                          number_or_null(sl_session_planar_angle(session, hit->corner)), "uv", numbers(hit->uv, 2),
                          "facets", (int)chart.faces, "l2", number_or_null(chart.distortion.l2)));
}

char *sl_state_arc(const sl_session *session, const int32_t side[3])
{
    const sl_mesh *mesh = sl_session_mesh(session);
    const int32_t h = sl_session_find_side(session, side[0], side[1], side[2]);
    int32_t *arc = NULL, count = 0, at = 0, first[3] = {0}, last[3] = {0};
    json_t *vertices = json_array(), *places = json_array();
    if (h >= 0 && mesh->sew[h] >= 0 && sl_session_arc(session, h, &arc, &count) == SL_OK && count > 0) {
        for (int32_t k = 0; k <= count; k++) {
            const int32_t corner = k < count ? arc[k] : sl_next(mesh, arc[count - 1]);
            json_array_append_new(vertices, json_integer(mesh->input_vertex[mesh->origin[corner]]));
            json_array_append_new(places, place_of(session, corner));
            at = k < count && arc[k] == h ? k : at;
        }
        sl_session_name_side(session, arc[0], first);
        sl_session_name_side(session, arc[count - 1], last);
    }
    sl_free(arc);
    const int32_t back[3] = {last[1], last[0], last[2]};
    return dump(json_pack("{s:s, s:o, s:o, s:i, s:o, s:o}", "t", "arc", "vertices", vertices, "places", places, "edge",
                          (int)at, "first", wholes(first, 3), "last", wholes(back, 3)));
}

char *sl_state_refused(const sl_diag *diag, sl_status status)
{
    char text[1024] = "";
    if (diag->reason[0] != '\0') {
        sl_diag_format(diag, text, sizeof text);
    }
    return dump(json_pack("{s:s, s:s}", "t", "refused", "why", text[0] != '\0' ? text : sl_status_name(status)));
}

char *sl_state_said(const char *text)
{
    return dump(json_pack("{s:s, s:s}", "t", "said", "text", text));
}

char *sl_state_progress(const char *stage, double fraction)
{
    return dump(json_pack("{s:s, s:s, s:f}", "t", "progress", "stage", stage, "fraction", fraction));
}

char *sl_state_frame(sl_pane pane, const sl_look *look, const sl_camera *camera, bool png)
{
    return dump(json_pack("{s:s, s:i, s:i, s:s, s:o, s:o, s:o, s:o, s:o, s:f, s:f, s:b}", "pane",
                          pane == SL_PANE_3D ? "3d" : "uv", "w", (int)look->width, "h", (int)look->height, "type",
                          png ? "image/png" : "image/jpeg", "eye", numbers(camera->eye, 3), "right",
                          numbers(camera->right, 3), "up", numbers(camera->up, 3), "forward",
                          numbers(camera->forward, 3), "centre", numbers(camera->centre, 2), "focal", camera->focal,
                          "near", camera->near_depth, "perspective", (int)camera->perspective));
}
