#include <stdio.h>
#include <string.h>

#include "base/memory.h"
#include "edit_support.h"
#include "sheet.h"

static int32_t charts(const sl_session *s)
{
    int32_t n = 0;
    for (int32_t i = 0; i < sl_session_slots(s); i++) {
        sl_session_chart c;
        sl_session_chart_info(s, i, &c);
        n += c.faces > 0;
    }
    return n;
}

static int32_t seam_edges(const sl_session *s)
{
    const sl_mesh *m = sl_session_mesh(s);
    int32_t n = 0;
    for (int32_t h = 0; h < m->nh; h++) {
        n += m->sew[h] > h;
    }
    return n;
}

static bool is_seam(const sl_session *s, int32_t v, int32_t w)
{
    const sl_mesh *m = sl_session_mesh(s);
    for (int32_t h = 0; h < m->nh; h++) {
        if (m->sew[h] >= 0 && m->input_vertex[m->origin[h]] == v && m->input_vertex[sl_target(m, h)] == w) {
            return true;
        }
    }
    return false;
}

static double distance(const sheet *t, int32_t v, int32_t w)
{
    double sum = 0.0;
    for (int k = 0; k < 3; k++) {
        sum += (t->xyz[3 * v + k] - t->xyz[3 * w + k]) * (t->xyz[3 * v + k] - t->xyz[3 * w + k]);
    }
    return sqrt(sum);
}

/* Shortest paths along edges by relaxing them all, again and again. */
static double bellman_ford(const sheet *t, int32_t from, int32_t to)
{
    double best[SHEET_V];
    for (int32_t v = 0; v < SHEET_V; v++) {
        best[v] = v == from ? 0.0 : HUGE_VAL;
    }
    for (int32_t round = 0; round < SHEET_V; round++) {
        for (int32_t c = 0; c < 4 * SHEET_F; c++) {
            const int32_t v = t->index[c], w = t->index[c % 4 == 3 ? c - 3 : c + 1];
            best[w] = fmin(best[w], best[v] + distance(t, v, w));
            best[v] = fmin(best[v], best[w] + distance(t, v, w));
        }
    }
    return best[to];
}

static void opening_without_actions_gives_the_bytes_of_unwrap(void **state)
{
    (void)state;
    sheet t;
    sheet_make(&t);
    const sl_atlas_def def = small_def();
    sl_atlas *plain = NULL, *atlas = NULL;
    sl_session *s = open_polygons(&t.polygons, "{\"do\":\"open\"}", NULL);
    assert_int_equal(sl_unwrap(&t.polygons, &def, NULL, &plain, NULL), SL_OK);
    assert_int_equal(sl_session_export(s, NULL, &atlas, NULL), SL_OK);
    assert_memory_equal(plain->input_corner_uv, atlas->input_corner_uv, 2 * sizeof(double) * 4 * SHEET_F);
    assert_true(atlas->check.passed);
    assert_null(edit_broken(s));
    sl_atlas_free(plain);
    sl_atlas_free(atlas);
    sl_session_free(s);
}

static void kept_uvs_are_kept_bit_for_bit(void **state)
{
    (void)state;
    sheet t;
    sheet_make(&t);
    sl_session *s = open_polygons(&t.polygons, "{\"do\":\"open\",\"start\":\"uv\"}", t.uv);
    assert_memory_equal(sl_session_corner_uv(s), t.uv, sizeof t.uv);
    assert_int_equal(sl_session_notes(s), 0);
    sl_session_free(s);
    t.uv[0] = 7.5; /* the corner of facet 0 alone: that is a flip */
    s = open_polygons(&t.polygons, "{\"do\":\"open\",\"start\":\"uv\"}", t.uv);
    assert_null(edit_broken(s));
    assert_int_equal(sl_session_notes(s), 1);
    sl_session_free(s);
    sl_action open = sl_action_default(SL_ACTION_OPEN);
    memcpy(open.name, "uv", 3);
    sl_diag diag = sl_diag_none();
    assert_int_equal(sl_session_create(&t.polygons, NULL, &open, NULL, NULL, &s, &diag), SL_BAD_INPUT);
    assert_null(s);
}

static void a_cut_path_is_the_shortest(void **state)
{
    (void)state;
    sheet t;
    sheet_make(&t);
    sl_session *s = open_polygons(&t.polygons, "{\"do\":\"open\"}", NULL);
    const int32_t from = sheet_v(0, 2), to = sheet_v(SHEET_X, 3);
    assert_int_equal(charts(s), 1);
    char line[96];
    snprintf(line, sizeof line, "{\"do\":\"cut-path\",\"vertices\":[%d,%d]}", from, to);
    do_line(s, line);
    assert_int_equal(charts(s), 2);
    const double length = sl_atlas_seam_length(sl_session_mesh(s)) / sl_session_mesh(s)->scale;
    assert_true(test_near_rel(length, bellman_ford(&t, from, to), 1e-12));
    assert_null(edit_broken(s));
    int32_t count;
    sl_session_changed(s, &count);
    assert_true(count >= 2);
    refuse_line(s, line, SL_BAD_INPUT); /* they are seams already */
    refuse_line(s, "{\"do\":\"cut-path\",\"vertices\":[3,3]}", SL_BAD_INPUT);
    refuse_line(s, "{\"do\":\"cut-path\",\"vertices\":[3,99999]}", SL_BAD_INPUT);
    sl_session_free(s);
}

static void a_deleted_seam_gives_the_old_shape(void **state)
{
    (void)state;
    sheet t;
    sheet_make(&t);
    sl_session *s = open_polygons(&t.polygons, "{\"do\":\"open\"}", NULL);
    double *before = sl_copy(sl_session_corner_uv(s), 4 * SHEET_F, 2 * sizeof(double));
    do_line(s, "{\"do\":\"cut-loop\",\"at\":[4,14,4]}"); /* the column i = 4, from border to border */
    assert_int_equal(charts(s), 2);
    assert_int_equal(seam_edges(s), SHEET_Y);
    for (int32_t j = 0; j < SHEET_Y; j++) {
        assert_true(is_seam(s, sheet_v(4, j), sheet_v(4, j + 1)));
    }
    do_line(s, "{\"do\":\"delete-seam\",\"at\":[34,24,22]}");
    assert_int_equal(charts(s), 1);
    assert_int_equal(seam_edges(s), 0);
    const double *after = sl_session_corner_uv(s);
    for (int32_t c = 1; c < 4 * SHEET_F; c++) { /* one minimum, however one comes to it; placed where it was */
        assert_true(test_near(hypot(after[2 * c] - after[0], after[2 * c + 1] - after[1]),
                              hypot(before[2 * c] - before[0], before[2 * c + 1] - before[1]), 1e-6));
    }
    refuse_line(s, "{\"do\":\"delete-seam\",\"at\":[34,24,22]}", SL_BAD_INPUT);
    refuse_line(s, "{\"do\":\"delete-seam\",\"at\":[34,25,23]}", SL_BAD_INPUT);
    refuse_line(s, "{\"do\":\"delete-seam\",\"at\":[0,1,0]}", SL_BAD_INPUT); /* the surface's border */
    sl_free(before);
    sl_session_free(s);
}

static void the_zipper_goes_back_and_forth(void **state)
{
    (void)state;
    sheet t;
    sheet_make(&t);
    sl_session *s = open_polygons(&t.polygons, "{\"do\":\"open\"}", NULL);
    char line[128];
    /* from the lower border up the column i = 4, three edges */
    snprintf(line, sizeof line, "{\"do\":\"unsew\",\"at\":[%d,%d,%d],\"length\":%.3f}", sheet_v(4, 0), sheet_v(4, 1),
             sheet_f(4, 0), distance(&t, 4, 14) + distance(&t, 14, 24) + 0.9 * distance(&t, 24, 34));
    do_line(s, line);
    assert_int_equal(seam_edges(s), 3);
    assert_int_equal(charts(s), 1);
    assert_null(edit_broken(s));
    /* back from the tip to (4, 1) */
    snprintf(line, sizeof line, "{\"do\":\"sew\",\"at\":[34,24,%d],\"to\":14}", sheet_f(3, 2));
    do_line(s, line);
    assert_int_equal(seam_edges(s), 1);
    assert_true(is_seam(s, 4, 14));
    /* open again: along what was a seam, and no further */
    snprintf(line, sizeof line, "{\"do\":\"unsew\",\"at\":[14,24,%d]}", sheet_f(4, 1));
    do_line(s, line);
    assert_int_equal(seam_edges(s), 3);
    assert_true(is_seam(s, 24, 34));
    /* to a vertex off the line: the shortest way there */
    do_line(s, "{\"do\":\"unsew\",\"at\":[34,44,31],\"to\":45}");
    assert_int_equal(seam_edges(s), 5);
    assert_true(is_seam(s, 44, 45));
    /* the arc from the tip ends at the border only */
    do_line(s, "{\"do\":\"sew\",\"at\":[45,44,31]}");
    assert_int_equal(seam_edges(s), 0);
    /* by length: at least one edge, and the half that is longer decides */
    do_line(s, "{\"do\":\"unsew\",\"at\":[4,14,4],\"to\":34}");
    snprintf(line, sizeof line, "{\"do\":\"sew\",\"at\":[34,24,22],\"length\":%.4f}",
             distance(&t, 34, 24) + 0.45 * distance(&t, 24, 14));
    do_line(s, line);
    assert_int_equal(seam_edges(s), 2);
    do_line(s, "{\"do\":\"undo\"}");
    snprintf(line, sizeof line, "{\"do\":\"sew\",\"at\":[34,24,22],\"length\":%.4f}",
             distance(&t, 34, 24) + 0.6 * distance(&t, 24, 14));
    do_line(s, line);
    assert_int_equal(seam_edges(s), 1);
    do_line(s, "{\"do\":\"undo\",\"steps\":1}");
    do_line(s, "{\"do\":\"sew\",\"at\":[34,24,22],\"to\":24}");
    refuse_line(s, "{\"do\":\"sew\",\"at\":[24,14,13],\"to\":77}", SL_BAD_INPUT);
    refuse_line(s, "{\"do\":\"sew\",\"at\":[34,24,22]}", SL_BAD_INPUT);
    refuse_line(s, "{\"do\":\"unsew\",\"at\":[24,14,13]}", SL_BAD_INPUT);
    assert_null(edit_broken(s));
    sl_session_free(s);
}

static void what_would_be_no_disk_is_refused_with_the_reason(void **state)
{
    (void)state;
    sheet t;
    sheet_make(&t);
    sl_session *s = open_polygons(&t.polygons, "{\"do\":\"open\"}", NULL);
    sl_diag diag = sl_diag_none();
    refuse_line(s, "{\"do\":\"cut-edges\",\"edges\":[[44,45]]}", SL_INFEASIBLE); /* a slit inside: a second border */
    assert_int_equal(try_line(s, "{\"do\":\"cut-edges\",\"edges\":[[44,45]]}", &diag), SL_INFEASIBLE);
    assert_non_null(strstr(diag.reason, "2 borders"));
    /* a facet cut out leaves a ring */
    refuse_line(s, "{\"do\":\"cut-edges\",\"edges\":[[44,45],[45,55],[55,54],[54,44]]}", SL_INFEASIBLE);
    refuse_line(s, "{\"do\":\"cut-edges\",\"edges\":[[44,46]]}", SL_BAD_INPUT);
    /* two halves sewn at both ends, open in the middle */
    do_line(s, "{\"do\":\"cut-loop\",\"at\":[4,14,4]}");
    do_line(s, "{\"do\":\"sew\",\"at\":[4,14,4],\"to\":14}");
    refuse_line(s, "{\"do\":\"sew\",\"at\":[74,64,57],\"to\":64}", SL_INFEASIBLE);
    refuse_line(s, "{\"do\":\"merge\",\"facets\":[0,8]}", SL_BAD_INPUT); /* one chart since */
    refuse_line(s, "{\"do\":\"open\"}", SL_BAD_INPUT);
    sl_session_free(s);
}

static void merging_sews_the_longest_arc(void **state)
{
    (void)state;
    sheet t;
    sheet_make(&t);
    sl_session *s = open_polygons(&t.polygons, "{\"do\":\"open\"}", NULL);
    /* a strip cut out of the left border: arcs below, beside, above; three charts afterwards where column 2 is cut too
     */
    do_line(s, "{\"do\":\"cut-path\",\"vertices\":[20,23,53,50]}");
    assert_int_equal(charts(s), 2);
    const int32_t cut = seam_edges(s);
    do_line(s, "{\"do\":\"merge\",\"facets\":[18,8]}");
    assert_int_equal(charts(s), 1);
    assert_true(seam_edges(s) < cut); /* one arc from border to border: gone whole */
    assert_int_equal(seam_edges(s), 0);
    refuse_line(s, "{\"do\":\"merge\",\"facets\":[18,999]}", SL_BAD_INPUT);
    do_line(s, "{\"do\":\"cut-loop\",\"at\":[3,13,3]}");
    do_line(s, "{\"do\":\"cut-loop\",\"at\":[6,16,6]}");
    refuse_line(s, "{\"do\":\"merge\",\"facets\":[0,8]}", SL_BAD_INPUT); /* no seam in common */
    assert_int_equal(charts(s), 3);
    sl_session_free(s);
}

static void arcs_end_where_three_seams_meet(void **state)
{
    (void)state;
    sheet t;
    sheet_make(&t);
    sl_session *s = open_polygons(&t.polygons, "{\"do\":\"open\"}", NULL);
    do_line(s, "{\"do\":\"cut-loop\",\"at\":[4,14,4]}");
    do_line(s, "{\"do\":\"cut-edges\",\"edges\":[[30,31],[31,32],[32,33],[33,34]]}"); /* a T at 34 */
    assert_int_equal(charts(s), 3);
    do_line(s, "{\"do\":\"delete-seam\",\"at\":[14,24,13]}");
    assert_int_equal(charts(s), 2);
    assert_int_equal(seam_edges(s), SHEET_Y + 4 - 3);
    assert_true(is_seam(s, 34, 44) && is_seam(s, 33, 34) && !is_seam(s, 24, 34));
    int32_t *arc = NULL, count = 0;
    assert_int_equal(sl_session_arc(s, sl_session_find_side(s, 34, 44, 30), &arc, &count), SL_OK);
    assert_int_equal(count, SHEET_Y - 3 + 4); /* one line now, round the corner */
    sl_free(arc);
    assert_int_equal(sl_session_arc(s, sl_session_find_side(s, 4, 14, 4), &arc, &count), SL_BAD_INPUT);
    sl_session_free(s);
}

static void of_two_arcs_the_longer_is_sewn(void **state)
{
    (void)state;
    sheet t;
    sheet_make(&t);
    sl_session *s = open_polygons(&t.polygons, "{\"do\":\"open\"}", NULL);
    do_line(s, "{\"do\":\"cut-loop\",\"at\":[4,14,4]}");
    /* a piece across the column takes its two halves apart: two edges below it, four above */
    do_line(s, "{\"do\":\"cut-edges\",\"edges\":[[23,24],[24,25],[25,35],[35,34],[34,33],[33,23]]}");
    const int32_t before = seam_edges(s);
    assert_int_equal(charts(s), 4);
    do_line(s, "{\"do\":\"merge\",\"facets\":[0,8]}");
    assert_int_equal(charts(s), 3);
    assert_int_equal(seam_edges(s), before - 4);
    assert_true(is_seam(s, 4, 14) && !is_seam(s, 34, 44));
    assert_null(edit_broken(s));
    sl_session_free(s);
}

static void a_nodal_line_cuts_a_chart_in_two_disks(void **state)
{
    (void)state;
    sheet t;
    sheet_make(&t);
    sl_session *s = open_polygons(&t.polygons, "{\"do\":\"open\"}", NULL);
    do_line(s, "{\"do\":\"cut-chart\",\"facet\":30}");
    assert_int_equal(charts(s), 2);
    assert_null(edit_broken(s));
    for (int32_t i = 0; i < 40; i++) { /* until facets stand alone; those cannot be cut */
        sl_diag diag = sl_diag_none();
        const sl_status status = try_line(s, "{\"do\":\"cut-chart\",\"facet\":30}", &diag);
        assert_true(status == SL_OK || status == SL_INFEASIBLE);
        assert_null(edit_broken(s));
        if (status == SL_INFEASIBLE) {
            break;
        }
        assert_true(i < 39);
    }
    refuse_line(s, "{\"do\":\"cut-chart\",\"facet\":63}", SL_BAD_INPUT);
    sl_session_free(s);
}

static void undo_redo_and_checkpoints_give_the_bytes_back(void **state)
{
    (void)state;
    sheet t;
    sheet_make(&t);
    sl_session *s = open_polygons(&t.polygons, "{\"do\":\"open\"}", NULL);
    uint64_t hash[4];
    int32_t cursor;
    hash[0] = sl_session_hash(s);
    do_line(s, "{\"do\":\"cut-loop\",\"at\":[4,14,4]}");
    hash[1] = sl_session_hash(s);
    do_line(s, "{\"do\":\"checkpoint\",\"name\":\"halves\"}");
    do_line(s, "{\"do\":\"angle\",\"corner\":[0,0],\"degrees\":70}");
    hash[2] = sl_session_hash(s);
    do_line(s, "{\"do\":\"pack\"}");
    hash[3] = sl_session_hash(s);
    assert_true(hash[0] != hash[1] && hash[1] != hash[2] && hash[2] != hash[3]);
    do_line(s, "{\"do\":\"undo\"}");
    assert_true(sl_session_hash(s) == hash[2]);
    do_line(s, "{\"do\":\"undo\",\"to\":\"halves\"}");
    assert_true(sl_session_hash(s) == hash[1]);
    assert_int_equal(sl_session_history(s, &cursor), 4);
    assert_int_equal(cursor, 2);
    refuse_line(s, "{\"do\":\"undo\",\"to\":\"halves\"}", SL_INFEASIBLE);
    refuse_line(s, "{\"do\":\"undo\",\"to\":\"quarters\"}", SL_INFEASIBLE);
    refuse_line(s, "{\"do\":\"redo\",\"steps\":3}", SL_INFEASIBLE);
    do_line(s, "{\"do\":\"redo\",\"steps\":2}");
    assert_true(sl_session_hash(s) == hash[3]);
    do_line(s, "{\"do\":\"undo\",\"steps\":4}");
    assert_true(sl_session_hash(s) == hash[0]);
    refuse_line(s, "{\"do\":\"undo\"}", SL_INFEASIBLE);
    do_line(s, "{\"do\":\"rotate\",\"facet\":3,\"degrees\":10}"); /* another branch: nothing to redo */
    refuse_line(s, "{\"do\":\"redo\"}", SL_INFEASIBLE);
    assert_int_equal(sl_session_history(s, &cursor), 1);
    assert_string_equal(sl_session_history_line(s, 0), "{\"do\":\"rotate\",\"facet\":3,\"degrees\":10}");
    assert_int_equal(sl_session_lines(s), 10);
    sl_session_free(s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(opening_without_actions_gives_the_bytes_of_unwrap),
        cmocka_unit_test(kept_uvs_are_kept_bit_for_bit),
        cmocka_unit_test(a_cut_path_is_the_shortest),
        cmocka_unit_test(a_deleted_seam_gives_the_old_shape),
        cmocka_unit_test(the_zipper_goes_back_and_forth),
        cmocka_unit_test(what_would_be_no_disk_is_refused_with_the_reason),
        cmocka_unit_test(merging_sews_the_longest_arc),
        cmocka_unit_test(arcs_end_where_three_seams_meet),
        cmocka_unit_test(of_two_arcs_the_longer_is_sewn),
        cmocka_unit_test(a_nodal_line_cuts_a_chart_in_two_disks),
        cmocka_unit_test(undo_redo_and_checkpoints_give_the_bytes_back),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
