#include "edit_support.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "geom/predicates.h"
#include "mesh/topology.h"

static const char *broken_pointers(const sl_mesh *m)
{
    for (int32_t h = 0; h < m->nh; h++) {
        if (m->twin[h] >= 0 && m->sew[h] >= 0) {
            return "an edge is cut and whole at once";
        }
        if ((m->twin[h] >= 0 && m->twin[m->twin[h]] != h) || (m->sew[h] >= 0 && m->sew[m->sew[h]] != h)) {
            return "an opposite's opposite is another";
        }
    }
    return NULL;
}

/* By page UVs: finite, equal along uncut edges. */
static const char *broken_uvs(const sl_session *s)
{
    const sl_mesh *m = sl_session_mesh(s);
    const double *uv = sl_session_corner_uv(s);
    for (int64_t h = 0; h < m->nh; h++) {
        if (!isfinite(uv[2 * h]) || !isfinite(uv[2 * h + 1])) {
            return "a UV is not finite";
        }
        const int32_t t = m->twin[h];
        if (t >= 0 && (memcmp(uv + 2 * h, uv + 2 * (int64_t)sl_next(m, t), 2 * sizeof *uv) != 0)) {
            return "UVs differ along an edge that is no seam";
        }
    }
    return NULL;
}

static const char *broken_triangles(const sl_session *s)
{
    const sl_triangulation *t = sl_session_triangulation(s);
    const sl_mesh *m = sl_session_mesh(s);
    const double *uv = sl_session_corner_uv(s);
    sl_session_chart chart;
    int32_t slot = -1;
    for (int32_t k = 0; k < t->nt; k++) {
        const int32_t f = m->face[t->corner[3 * k]];
        if (sl_session_face_chart(s)[f] != slot) {
            slot = sl_session_face_chart(s)[f];
            sl_session_chart_info(s, slot, &chart);
        }
        const double sign = sl_orient2d(uv + 2 * (int64_t)t->corner[3 * k], uv + 2 * (int64_t)t->corner[3 * k + 1],
                                        uv + 2 * (int64_t)t->corner[3 * k + 2]);
        if ((m->face_flags[f] & SL_FACE_DEGENERATE) == 0 && !(chart.mirrored ? sign < 0.0 : sign > 0.0)) {
            return "a triangle is flipped";
        }
    }
    return NULL;
}

static const char *broken_charts(const sl_session *s)
{
    const sl_mesh *m = sl_session_mesh(s);
    const char *what = NULL;
    int32_t *label = sl_alloc(m->nf, sizeof *label), count = 0, charts = 0, faces = 0;
    if (label == NULL || sl_mesh_components(m, label, &count) != SL_OK) {
        return "out of memory";
    }
    for (int32_t i = 0; i < sl_session_slots(s) && what == NULL; i++) {
        sl_session_chart chart;
        sl_topology topology;
        sl_session_chart_info(s, i, &chart);
        charts += chart.faces > 0;
        faces += chart.faces;
        for (int32_t k = 0; k < chart.faces; k++) {
            const int32_t f = chart.face[k];
            what = sl_session_face_chart(s)[f] != i   ? "a facet's chart is another"
                   : label[f] != label[chart.face[0]] ? "a chart is in two parts"
                   : k > 0 && chart.face[k - 1] >= f  ? "facets are not in order"
                                                      : what;
        }
        if (chart.faces > 0 && what == NULL) {
            what = sl_mesh_topology(m, chart.face, chart.faces, &topology) != SL_OK ? "out of memory"
                   : topology.loops != 1 || topology.genus != 0                     ? "a chart is no disk"
                   : chart.distortion.flipped > 0                                   ? "a chart has flips"
                   : chart.copy_of >= 0 && sl_session_corner_uv(s) == NULL          ? "a copy has no UVs"
                                                                                    : NULL;
        }
        if (chart.faces > 0 && what == NULL && chart.embedded && chart.red > 0) {
            what = "an embedding has red facets";
        }
    }
    what = what == NULL && (charts != count || faces != m->nf) ? "charts are not the parts between seams" : what;
    sl_free(label);
    return what;
}

const char *edit_broken(const sl_session *s)
{
    const char *what = broken_pointers(sl_session_mesh(s));
    what = what == NULL ? broken_uvs(s) : what;
    what = what == NULL ? broken_triangles(s) : what;
    return what == NULL ? broken_charts(s) : what;
}

/* A halfedge whose edge is a seam (or not), by trial; -1 = none was found. */
static int32_t random_edge(const sl_mesh *m, test_rng *rng, bool seam)
{
    for (int trial = 0; trial < 4000; trial++) {
        const int32_t h = test_index(rng, m->nh);
        if (seam ? m->sew[h] >= 0 : m->twin[h] >= 0) {
            return h;
        }
    }
    return -1;
}

/* The tip of a slit: a seam edge whose other side follows it along the border. */
static int32_t random_tip(const sl_mesh *m, test_rng *rng)
{
    for (int trial = 0; trial < 400; trial++) {
        const int32_t h = random_edge(m, rng, true);
        int32_t g = h >= 0 ? sl_next(m, h) : -1;
        while (g >= 0 && m->twin[g] >= 0) {
            g = sl_next(m, m->twin[g]);
        }
        if (g >= 0 && g == m->sew[h]) {
            return g;
        }
    }
    return -1;
}

/* Vertices along a walk of edges from a halfedge on, as corners in one chart. */
static void random_path(const sl_session *s, test_rng *rng, sl_action *a)
{
    const sl_mesh *m = sl_session_mesh(s);
    int32_t item[24], n = 0, h = test_index(rng, m->nh);
    const int32_t length = 2 + test_index(rng, 6);
    while (n < length && n < 12) {
        sl_session_name_corner(s, h, item + 2 * n++);
        int32_t g = sl_next(m, h);
        for (int k = 0; k < 1 + (sl_degree(m, m->face[h]) == 3); k++) {
            g = m->twin[g] >= 0 ? sl_next(m, m->twin[g]) : g;
        }
        h = g;
    }
    assert_int_equal(sl_action_set_items(a, 2 * n, item), SL_OK);
}

static void set_corners(const sl_session *s, test_rng *rng, sl_action *a, int32_t count, bool border)
{
    const sl_mesh *m = sl_session_mesh(s);
    int32_t item[8];
    for (int32_t i = 0; i < count; i++) {
        int32_t h = border ? random_edge(m, rng, true) : test_index(rng, m->nh);
        if (i > 0) { /* further along the same border */
            h = sl_session_find_corner(s, item[2 * i - 2], item[2 * i - 1]);
            for (int32_t k = 1 + test_index(rng, 9); k > 0; k--) {
                int32_t g = sl_next(m, h);
                while (m->twin[g] >= 0 && border) {
                    g = sl_next(m, m->twin[g]);
                }
                h = g;
            }
        }
        h = h >= 0 ? h : 0;
        sl_session_name_corner(s, h, item + 2 * i);
    }
    assert_int_equal(sl_action_set_items(a, 2 * count, item), SL_OK);
}

static void set_side(const sl_session *s, sl_action *a, int32_t h)
{
    int32_t name[3] = {0, 1, 0};
    if (h >= 0) {
        sl_session_name_side(s, h, name);
    }
    assert_int_equal(sl_action_set_items(a, 3, name), SL_OK);
}

sl_action edit_random_action(const sl_session *s, test_rng *rng)
{
    static const sl_action_kind often[] = {
        SL_ACTION_UNDO,  SL_ACTION_UNDO,      SL_ACTION_REDO,  SL_ACTION_SEW,       SL_ACTION_SEW,
        SL_ACTION_UNSEW, SL_ACTION_UNSEW,     SL_ACTION_ANGLE, SL_ACTION_ANGLE,     SL_ACTION_STRAIGHTEN,
        SL_ACTION_MERGE, SL_ACTION_CUT_CHART, SL_ACTION_MOVE,  SL_ACTION_CUT_EDGES, SL_ACTION_DROP,
    };
    const sl_mesh *m = sl_session_mesh(s);
    const int32_t pick = test_index(rng, 40);
    const sl_action_kind kind =
        pick < (int32_t)SL_COUNTOF(often) ? often[pick] : (sl_action_kind)(1 + test_index(rng, SL_ACTION_KINDS - 1));
    sl_action a = sl_action_default(kind);
    a.facet = test_index(rng, m->nf);
    int32_t h = -1;
    switch (kind) {
    case SL_ACTION_DELETE_SEAM:
        set_side(s, &a, random_edge(m, rng, true));
        break;
    case SL_ACTION_CUT_PATH: {
        const int32_t item[2] = {m->input_vertex[m->origin[test_index(rng, m->nh)]],
                                 m->input_vertex[m->origin[test_index(rng, m->nh)]]};
        assert_int_equal(sl_action_set_items(&a, 2, item), SL_OK);
        break;
    }
    case SL_ACTION_CUT_LOOP:
        set_side(s, &a, random_edge(m, rng, false));
        break;
    case SL_ACTION_CUT_EDGES: { /* a slit that begins at a border, or any edge */
        int32_t item[4], side[3];
        h = random_edge(m, rng, test_index(rng, 3) > 0);
        h = h >= 0 ? sl_next(m, h) : 0;
        sl_session_name_side(s, h, side);
        memcpy(item, side, 2 * sizeof *item);
        assert_int_equal(sl_action_set_items(&a, 2, item), SL_OK);
        break;
    }
    case SL_ACTION_SEW:
        h = test_index(rng, 2) == 0 ? random_tip(m, rng) : -1;
        set_side(s, &a, h >= 0 ? h : random_edge(m, rng, true));
        a.number = test_index(rng, 2) == 0 ? test_uniform(rng, 0.0, 0.4) / m->scale : 0.0;
        break;
    case SL_ACTION_UNSEW:
        h = random_edge(m, rng, true);
        h = h >= 0 ? sl_next(m, h) : 0;
        set_side(s, &a, h);
        a.number = test_index(rng, 2) == 0 ? test_uniform(rng, 0.0, 0.3) / m->scale : 0.0;
        if (test_index(rng, 3) == 0) {
            a.number = 0.0;
            a.to = m->input_vertex[m->origin[test_index(rng, m->nh)]];
        }
        break;
    case SL_ACTION_MERGE: {
        h = random_edge(m, rng, true);
        const int32_t item[2] = {m->face[h >= 0 ? h : 0], m->face[h >= 0 ? m->sew[h] : 0]};
        assert_int_equal(sl_action_set_items(&a, 2, item), SL_OK);
        break;
    }
    case SL_ACTION_ANGLE:
        set_corners(s, rng, &a, 1, true);
        h = sl_session_find_corner(s, a.item[0], a.item[1]);
        a.number = sl_session_planar_angle(s, h) + test_uniform(rng, -30.0, 30.0);
        a.number = a.number > 5.0 ? a.number : 45.0;
        break;
    case SL_ACTION_STRAIGHTEN:
        random_path(s, rng, &a);
        break;
    case SL_ACTION_STRAIGHTEN_BORDER:
        set_corners(s, rng, &a, 2, true);
        break;
    case SL_ACTION_RECTANGLE:
        set_corners(s, rng, &a, 4, true);
        break;
    case SL_ACTION_RIGHT:
        set_corners(s, rng, &a, 1, test_index(rng, 2) == 0);
        break;
    case SL_ACTION_DROP:
        if (sl_session_constraints(s) > 0) {
            sl_session_constraint c;
            sl_session_constraint_at(s, test_index(rng, sl_session_constraints(s)), &c);
            a.id = c.id;
        }
        break;
    case SL_ACTION_PIN:
        set_corners(s, rng, &a, 1, false);
        a.uv[0] = test_uniform(rng, 0.0, 1.0);
        a.uv[1] = test_uniform(rng, 0.0, 1.0);
        break;
    case SL_ACTION_MOVE:
        a.uv[0] = test_uniform(rng, -0.2, 0.2);
        a.uv[1] = test_uniform(rng, -0.2, 0.2);
        break;
    case SL_ACTION_ROTATE:
        a.number = test_uniform(rng, -180.0, 180.0);
        break;
    case SL_ACTION_SCALE:
        a.number = test_uniform(rng, 0.8, 1.25);
        break;
    case SL_ACTION_SYMMETRY:
        a.on = test_index(rng, 2) == 0;
        if (a.on) {
            int32_t item[4];
            sl_session_name_corner(s, m->face_first[a.facet], item);
            sl_session_name_corner(s, test_index(rng, m->nh), item + 2);
            a.mirrored = test_index(rng, 2) == 0;
            assert_int_equal(sl_action_set_items(&a, 4, item), SL_OK);
        }
        break;
    case SL_ACTION_UNDO:
    case SL_ACTION_REDO:
        a.steps = 1 + test_index(rng, 3);
        if (kind == SL_ACTION_UNDO && test_index(rng, 8) == 0) {
            a.steps = 1;
            memcpy(a.name, "here", 5);
        }
        break;
    case SL_ACTION_CHECKPOINT:
        memcpy(a.name, "here", 5);
        break;
    default:
        break;
    }
    return a;
}
