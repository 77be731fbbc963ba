/* Angles, lines, pins: what the user asks of a chart's shape. */
#include <stdio.h>

#include "base/memory.h"
#include "edit_support.h"
#include "sheet.h"

/* Angle at a by the law of cosines. */
static double wedge(const double *a, const double *b, const double *c)
{
    const double x = hypot(b[0] - a[0], b[1] - a[1]), y = hypot(c[0] - a[0], c[1] - a[1]);
    const double z = hypot(c[0] - b[0], c[1] - b[1]);
    return acos(fmax(-1.0, fmin(1.0, (x * x + y * y - z * z) / (2.0 * x * y)))) * 180.0 / TEST_PI;
}

static void an_angle_at_the_border_is_what_was_asked_for(void **state)
{
    (void)state;
    sheet t;
    sheet_make(&t);
    sl_session *s = open_polygons(&t.polygons, "{\"do\":\"open\"}", NULL);
    char line[96];
    test_rng rng = test_rng_seed(0xa461e);
    for (int trial = 0; trial < 12; trial++) {
        const double degrees = test_uniform(&rng, 60.0, 120.0);
        snprintf(line, sizeof line, "{\"do\":\"angle\",\"corner\":[0,0],\"degrees\":%.17g}", degrees);
        do_line(s, line);
        const double *a = uv_at(s, 0, 0);
        assert_true(test_near(wedge(a, uv_at(s, 1, 0), uv_at(s, 10, 0)), degrees, 1e-6));
        assert_true(test_near(sl_session_planar_angle(s, sl_session_find_corner(s, 0, 0)), degrees, 1e-6));
        assert_int_equal(sl_session_constraints(s), 1); /* one takes the other's place */
        assert_null(edit_broken(s));
    }
    sl_session_constraint c;
    sl_session_constraint_at(s, 0, &c);
    assert_int_equal(c.id, 1);
    assert_int_equal(c.kind, SL_ACTION_ANGLE);
    assert_true(isnan(sl_session_planar_angle(s, sl_session_find_corner(s, sheet_v(3, 3), sheet_f(3, 3)))));
    refuse_line(s, "{\"do\":\"angle\",\"corner\":[33,33],\"degrees\":90}", SL_BAD_INPUT); /* facet 33 lacks it */
    refuse_line(s, "{\"do\":\"angle\",\"corner\":[33,30],\"degrees\":90}", SL_BAD_INPUT); /* inside */
    refuse_line(s, "{\"do\":\"angle\",\"corner\":[0,0],\"degrees\":400}", SL_INFEASIBLE);
    refuse_line(s, "{\"do\":\"angle\",\"corner\":[0,0],\"degrees\":0}", SL_INFEASIBLE);
    sl_session_free(s);
}

static void dropping_a_constraint_gives_the_free_shape_back(void **state)
{
    (void)state;
    sheet t;
    sheet_make(&t);
    sl_session *s = open_polygons(&t.polygons, "{\"do\":\"open\"}", NULL);
    double *before = sl_copy(sl_session_corner_uv(s), 4 * SHEET_F, 2 * sizeof(double));
    do_line(s, "{\"do\":\"angle\",\"corner\":[0,0],\"degrees\":50}");
    do_line(s, "{\"do\":\"drop\",\"constraint\":1}");
    const double *after = sl_session_corner_uv(s);
    for (int32_t c = 1; c < 4 * SHEET_F; c++) {
        assert_true(test_near(hypot(after[2 * c] - after[0], after[2 * c + 1] - after[1]),
                              hypot(before[2 * c] - before[0], before[2 * c + 1] - before[1]), 1e-6));
    }
    refuse_line(s, "{\"do\":\"drop\",\"constraint\":1}", SL_BAD_INPUT);
    sl_free(before);
    sl_session_free(s);
}

/* The new layout lies as near to the old one as a rotation and a translation can bring it. */
static void a_chart_solved_again_stays_where_it_was(void **state)
{
    (void)state;
    sheet t;
    sheet_make(&t);
    sl_session *s = open_polygons(&t.polygons, "{\"do\":\"open\"}", NULL);
    do_line(s, "{\"do\":\"rotate\",\"facet\":0,\"degrees\":77}");
    double *before = sl_copy(sl_session_corner_uv(s), 4 * SHEET_F, 2 * sizeof(double));
    do_line(s, "{\"do\":\"angle\",\"corner\":[0,0],\"degrees\":60}");
    const double *after = sl_session_corner_uv(s);
    double p[2] = {0}, q[2] = {0}, dot = 0.0, cross = 0.0;
    for (int32_t i = 0; i < 8 * SHEET_F; i++) {
        p[i % 2] += before[i] / (4 * SHEET_F);
        q[i % 2] += after[i] / (4 * SHEET_F);
    }
    assert_true(test_near(p[0], q[0], 1e-12) && test_near(p[1], q[1], 1e-12));
    for (int32_t c = 0; c < 4 * SHEET_F; c++) {
        const double a[2] = {before[2 * c] - p[0], before[2 * c + 1] - p[1]};
        const double b[2] = {after[2 * c] - q[0], after[2 * c + 1] - q[1]};
        dot += a[0] * b[0] + a[1] * b[1];
        cross += a[0] * b[1] - a[1] * b[0];
    }
    assert_true(dot > 0.0 && fabs(cross) < 1e-12 * dot);
    sl_free(before);
    sl_session_free(s);
}

/* Largest distance of the vertices from the chord, over its length. path: vertex, facet, ... */
static double bend(const sl_session *s, const int32_t *path, int32_t n)
{
    const double *a = uv_at(s, path[0], path[1]), *b = uv_at(s, path[2 * n - 2], path[2 * n - 1]);
    const double length = hypot(b[0] - a[0], b[1] - a[1]);
    double most = 0.0;
    for (int32_t k = 1; k + 1 < n; k++) {
        const double *p = uv_at(s, path[2 * k], path[2 * k + 1]);
        most = fmax(most, fabs((b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0])) / length);
    }
    return most / length;
}

static void straight_paths_are_straight_and_cross_at_right_angles(void **state)
{
    (void)state;
    sheet t;
    sheet_make(&t);
    sl_session *s = open_polygons(&t.polygons, "{\"do\":\"open\"}", NULL);
    const int32_t row[] = {31, 27, 32, 28, 33, 29, 34, 30, 35, 31, 36, 32};
    const int32_t column[] = {13, 3, 23, 12, 33, 21, 43, 30, 53, 39};
    assert_true(bend(s, row, 6) > 1e-4);
    do_line(s, "{\"do\":\"straighten\",\"path\":[[31,27],[32,28],[33,29],[34,30],[35,31],[36,32]]}");
    assert_true(bend(s, row, 6) < 1e-9);
    do_line(s, "{\"do\":\"straighten\",\"path\":[[13,3],[23,12],[33,21],[43,30],[53,39]]}");
    assert_true(bend(s, row, 6) < 1e-9 && bend(s, column, 5) < 1e-9);
    assert_true(test_near(wedge(uv_at(s, 33, 29), uv_at(s, 34, 30), uv_at(s, 43, 30)), 90.0, 1e-6));
    assert_int_equal(sl_session_constraints(s), 2);
    int32_t *edge = NULL, count = 0;
    assert_int_equal(sl_session_constraint_edges(s, 1, &edge, &count), SL_OK);
    assert_int_equal(count, 4);
    sl_free(edge);
    refuse_line(s, "{\"do\":\"straighten\",\"path\":[[13,3],[33,21]]}", SL_BAD_INPUT);   /* no edge */
    refuse_line(s, "{\"do\":\"straighten\",\"path\":[[32,28],[33,29]]}", SL_INFEASIBLE); /* shares an edge */
    assert_null(edit_broken(s));
    sl_session_free(s);
}

static void four_corners_make_a_rectangle(void **state)
{
    (void)state;
    sheet t;
    sheet_make(&t);
    sl_session *s = open_polygons(&t.polygons, "{\"do\":\"open\"}", NULL);
    do_line(s, "{\"do\":\"rectangle\",\"corners\":[[0,0],[9,8],[79,62],[70,54]]}");
    const double *a = uv_at(s, 0, 0), *b = uv_at(s, 9, 8), *c = uv_at(s, 79, 62), *d = uv_at(s, 70, 54);
    assert_true(test_near(wedge(a, b, d), 90.0, 1e-6) && test_near(wedge(b, a, c), 90.0, 1e-6));
    assert_true(test_near(hypot(b[0] - a[0], b[1] - a[1]), hypot(c[0] - d[0], c[1] - d[1]), 1e-8));
    for (int32_t i = 1; i < SHEET_X; i++) {
        assert_true(test_near(wedge(uv_at(s, i, i), a, b), 180.0, 1e-3));
    }
    sl_session_free(s);
    s = open_polygons(&t.polygons, "{\"do\":\"open\"}", NULL); /* one side alone, named by its ends */
    do_line(s, "{\"do\":\"straighten-border\",\"ends\":[[0,0],[9,8]]}");
    const int32_t side[] = {0, 0, 1, 0, 2, 1, 3, 2, 4, 3, 5, 4, 6, 5, 7, 6, 8, 7, 9, 8};
    assert_true(bend(s, side, 10) < 1e-9);
    do_line(s, "{\"do\":\"right\",\"corner\":[0,0]}");
    assert_true(test_near(sl_session_planar_angle(s, sl_session_find_corner(s, 0, 0)), 90.0, 1e-6));
    refuse_line(s, "{\"do\":\"straighten-border\",\"ends\":[[0,0],[33,30]]}", SL_BAD_INPUT);
    sl_session_free(s);
}

static void constraints_live_through_sewing_where_they_can(void **state)
{
    (void)state;
    sheet t;
    sheet_make(&t);
    sl_session *s = open_polygons(&t.polygons, "{\"do\":\"open\"}", NULL);
    do_line(s, "{\"do\":\"cut-loop\",\"at\":[4,14,4]}");
    do_line(s, "{\"do\":\"angle\",\"corner\":[0,0],\"degrees\":75}");      /* far from the seam */
    do_line(s, "{\"do\":\"angle\",\"corner\":[34,30],\"degrees\":170}");   /* on it */
    do_line(s, "{\"do\":\"straighten-border\",\"ends\":[[74,58],[4,4]]}"); /* the seam itself, from one side */
    do_line(s, "{\"do\":\"angle\",\"corner\":[4,4],\"degrees\":80}"); /* at its end: a border vertex afterwards, too */
    do_line(s, "{\"do\":\"delete-seam\",\"at\":[4,14,4]}");
    assert_int_equal(sl_session_constraints(s), 2);
    assert_int_equal(sl_session_notes(s), 2);
    assert_non_null(strstr(sl_session_note(s, 0), "constraint 2"));
    assert_non_null(strstr(sl_session_note(s, 1), "constraint 4"));
    const double *a = uv_at(s, 0, 0);
    assert_true(test_near(wedge(a, uv_at(s, 1, 0), uv_at(s, 10, 0)), 75.0, 1e-6));
    const int32_t line[] = {4, 4, 14, 4, 24, 13, 34, 22, 44, 31, 54, 40, 64, 49, 74, 58};
    assert_true(bend(s, line, 8) < 1e-9);
    do_line(s, "{\"do\":\"cut-path\",\"vertices\":[30,39]}"); /* across the line: it falls in two */
    assert_int_equal(sl_session_constraints(s), 1);
    do_line(s, "{\"do\":\"undo\"}");
    assert_int_equal(sl_session_constraints(s), 2);
    assert_null(edit_broken(s));
    sl_session_free(s);
}

static void pins_hold_their_places(void **state)
{
    (void)state;
    sheet t;
    sheet_make(&t);
    sl_session *s = open_polygons(&t.polygons, "{\"do\":\"open\"}", NULL);
    do_line(s, "{\"do\":\"pin\",\"corner\":[0,0],\"uv\":[0.25,0.125]}");
    assert_true(test_near(uv_at(s, 0, 0)[0], 0.25, 1e-14) && test_near(uv_at(s, 0, 0)[1], 0.125, 1e-14));
    refuse_line(s, "{\"do\":\"move\",\"facet\":7,\"by\":[0.1,0]}", SL_INFEASIBLE);
    do_line(s, "{\"do\":\"pin\",\"corner\":[79,62],\"uv\":[0.75,0.625]}");
    do_line(s, "{\"do\":\"angle\",\"corner\":[9,8],\"degrees\":80}"); /* the pins stand */
    assert_true(test_near(uv_at(s, 0, 0)[0], 0.25, 1e-12) && test_near(uv_at(s, 79, 62)[1], 0.625, 1e-12));
    refuse_line(s, "{\"do\":\"pin\",\"corner\":[9,8],\"uv\":[0.1,0.2]}", SL_INFEASIBLE);
    refuse_line(s, "{\"do\":\"pin\",\"corner\":[79,62],\"uv\":[0.25,0.125]}", SL_INFEASIBLE); /* where the other is */
    do_line(s, "{\"do\":\"pack\"}");
    assert_int_equal(sl_session_constraints(s), 1);
    assert_int_equal(sl_session_notes(s), 2);
    sl_session_free(s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(an_angle_at_the_border_is_what_was_asked_for),
        cmocka_unit_test(dropping_a_constraint_gives_the_free_shape_back),
        cmocka_unit_test(a_chart_solved_again_stays_where_it_was),
        cmocka_unit_test(straight_paths_are_straight_and_cross_at_right_angles),
        cmocka_unit_test(four_corners_make_a_rectangle),
        cmocka_unit_test(constraints_live_through_sewing_where_they_can),
        cmocka_unit_test(pins_hold_their_places),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
