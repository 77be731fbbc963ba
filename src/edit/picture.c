#include "edit/picture.h"

#include "base/memory.h"

static const uint8_t blue[3] = {40, 90, 235}, yellow[3] = {245, 190, 20}, violet[3] = {150, 60, 200};
static const double line_width = 3.0, dot_radius = 5.0; /* pixels */
static const double checks = 48.0;

/* Edges and vertices of the constraints. */
typedef struct marks {
    int32_t *edge, *angle, *pin;
    int64_t edge_room, angle_room, pin_room;
    int32_t edges, angles, pins;
} marks;

static sl_status push(int32_t **list, int64_t *room, int32_t *count, int32_t value)
{
    const sl_status status = sl_reserve((void **)list, room, (int64_t)*count + 1, sizeof **list);
    if (status == SL_OK) {
        (*list)[(*count)++] = value;
    }
    return status;
}

static sl_status gather(const sl_session *session, marks *m)
{
    const sl_mesh *mesh = sl_session_mesh(session);
    sl_status status = SL_OK;
    int32_t *edge = NULL, count = 0;
    for (int32_t i = 0; i < sl_session_constraints(session); i++) {
        sl_session_constraint c;
        sl_session_constraint_at(session, i, &c);
        if (c.kind == SL_ACTION_STRAIGHTEN) {
            SL_TRY(sl_session_constraint_edges(session, i, &edge, &count));
            for (int32_t k = 0; k < count; k++) {
                SL_TRY(push(&m->edge, &m->edge_room, &m->edges, edge[k]));
            }
            sl_free(edge);
            edge = NULL;
            continue;
        }
        for (int32_t k = 0; k < c.count; k++) {
            const int32_t v = mesh->origin[c.corner[k]];
            SL_TRY(c.kind == SL_ACTION_PIN ? push(&m->pin, &m->pin_room, &m->pins, v)
                                           : push(&m->angle, &m->angle_room, &m->angles, v));
        }
    }
cleanup:
    sl_free(edge);
    return status;
}

/* Copies have the colours of what they show. */
static void shown_charts(const sl_session *session, int32_t *chart)
{
    for (int32_t f = 0; f < sl_session_mesh(session)->nf; f++) {
        chart[f] = sl_session_face_chart(session)[f];
    }
    for (int32_t i = 0; i < sl_session_slots(session); i++) {
        sl_session_chart c;
        sl_session_chart_info(session, i, &c);
        for (int32_t k = 0; k < c.faces && c.copy_of >= 0; k++) {
            chart[c.face[k]] = c.copy_of;
        }
    }
}

sl_status sl_session_picture(const sl_session *session, const sl_view *view, const sl_picture *picture,
                             const sl_context *context, sl_image **out, sl_diag *diag)
{
    sl_status status = SL_OK;
    const sl_mesh *mesh = sl_session_mesh(session);
    marks m = {0};
    int32_t *chart = sl_alloc(mesh->nf, sizeof *chart), red_count = 0;
    uint8_t *red = sl_alloc(mesh->nf, 1);
    *out = NULL;
    SL_TRY(chart != NULL && red != NULL ? SL_OK : SL_OUT_OF_MEMORY);
    SL_TRY(gather(session, &m));
    SL_TRY(sl_session_page_red(session, context, red, &red_count));
    shown_charts(session, chart);
    const sl_edge_layer lines = {m.edges, m.edge, {blue[0], blue[1], blue[2]}, line_width};
    const sl_dot_layer dots[2] = {{m.angles, m.angle, {yellow[0], yellow[1], yellow[2]}, dot_radius},
                                  {m.pins, m.pin, {violet[0], violet[1], violet[2]}, dot_radius}};
    sl_scene scene = sl_scene_default();
    scene.mesh = mesh;
    scene.triangulation = sl_session_triangulation(session);
    scene.corner_uv = sl_session_corner_uv(session);
    scene.chart = chart;
    scene.facet_flag = red;
    scene.checks = checks;
    scene.edge_layers = m.edges > 0;
    scene.edge_layer = &lines;
    scene.dot_layers = 2;
    scene.dot_layer = dots;
    SL_TRY(sl_render_pair(&scene, view, picture, context, out, diag));
cleanup:
    sl_free(chart);
    sl_free(red);
    sl_free(m.edge);
    sl_free(m.angle);
    sl_free(m.pin);
    return status;
}
