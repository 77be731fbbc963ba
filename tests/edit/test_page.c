/* Charts on the page: moved, overlapping, dragged, cancelled, shared. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "edit_support.h"
#include "generators.h"
#include "meshio/meshfile.h"
#include "overlap/exact.h"
#include "sheet.h"

static void charts_move_turn_and_grow_about_their_boxes(void **state)
{
    (void)state;
    sheet t;
    sheet_make(&t);
    sl_session *s = open_polygons(&t.polygons, "{\"do\":\"open\"}", NULL);
    sl_session_chart info;
    sl_session_chart_info(s, 0, &info);
    const double x = 0.5 * (info.low[0] + info.high[0]), y = 0.5 * (info.low[1] + info.high[1]);
    double *before = sl_copy(sl_session_corner_uv(s), 4 * SHEET_F, 2 * sizeof(double));
    do_line(s, "{\"do\":\"rotate\",\"facet\":5,\"degrees\":37}");
    const double *uv = sl_session_corner_uv(s), c = cos(37.0 * TEST_PI / 180.0), z = sin(37.0 * TEST_PI / 180.0);
    for (int32_t i = 0; i < 4 * SHEET_F; i++) {
        const double dx = before[2 * i] - x, dy = before[2 * i + 1] - y;
        assert_true(test_near(uv[2 * i], x + c * dx - z * dy, 1e-13));
        assert_true(test_near(uv[2 * i + 1], y + z * dx + c * dy, 1e-13));
    }
    do_line(s, "{\"do\":\"undo\"}");
    do_line(s, "{\"do\":\"scale\",\"facet\":5,\"factor\":1.5}");
    do_line(s, "{\"do\":\"move\",\"facet\":5,\"by\":[-0.125,0.5]}");
    for (int32_t i = 0; i < 4 * SHEET_F; i++) {
        assert_true(test_near(uv[2 * i], x + 1.5 * (before[2 * i] - x) - 0.125, 1e-13));
    }
    refuse_line(s, "{\"do\":\"move\",\"facet\":63,\"by\":[0,0]}", SL_BAD_INPUT);
    for (int i = 0; i < 12; i++) { /* however far: refused before it is lost */
        sl_diag diag = sl_diag_none();
        const sl_status status = try_line(s, "{\"do\":\"move\",\"facet\":5,\"by\":[1e4,1e4]}", &diag);
        assert_true(status == (i < 4 ? SL_OK : SL_INFEASIBLE));
    }
    sl_free(before);
    sl_session_free(s);
}

static void red_facets_on_the_page_are_those_of_all_pairs(void **state)
{
    (void)state;
    sheet t;
    sheet_make(&t);
    sl_session *s = open_polygons(&t.polygons, "{\"do\":\"open\"}", NULL);
    do_line(s, "{\"do\":\"cut-loop\",\"at\":[4,14,4]}");
    do_line(s, "{\"do\":\"cut-path\",\"vertices\":[30,34]}");
    test_rng rng = test_rng_seed(0x9ed);
    for (int trial = 0; trial < 10; trial++) {
        char line[96];
        uint8_t red[SHEET_F], all[2 * SHEET_F];
        int32_t count = 0, expected = 0;
        sl_exact_overlap exact;
        snprintf(line, sizeof line, "{\"do\":\"move\",\"facet\":%d,\"by\":[%.6f,%.6f]}", test_index(&rng, SHEET_F),
                 test_uniform(&rng, -0.3, 0.3), test_uniform(&rng, -0.3, 0.3));
        do_line(s, line);
        assert_int_equal(sl_session_page_red(s, NULL, red, &count), SL_OK);
        const sl_triangulation *tri = sl_session_triangulation(s);
        assert_int_equal(sl_overlap_exact(sl_session_corner_uv(s), tri->nt, tri->corner, NULL, all, &exact), SL_OK);
        for (int32_t f = 0; f < SHEET_F; f++) {
            const bool hit = all[2 * f] != 0 || all[2 * f + 1] != 0;
            assert_int_equal(red[f], hit);
            expected += hit;
        }
        assert_int_equal(count, expected);
    }
    sl_session_free(s);
}

static void what_overlaps_is_saved_only_when_that_is_allowed(void **state)
{
    (void)state;
    sheet t;
    sheet_make(&t);
    sl_meshfile *file = NULL, *back = NULL;
    sl_atlas_check check;
    sl_diag diag = sl_diag_none();
    char path[512];
    assert_int_equal(sl_meshfile_from_polygons(&t.polygons, &file, &diag), SL_OK);
    sl_session *s = open_polygons(&t.polygons, "{\"do\":\"open\"}", NULL);
    snprintf(path, sizeof path, "%s", test_scratch("out.obj"));
    do_line(s, "{\"do\":\"cut-loop\",\"at\":[4,14,4]}");
    do_line(s, "{\"do\":\"pack\"}");
    do_line(s, "{\"do\":\"checkpoint\",\"name\":\"packed\"}");
    char line[96]; /* a corner of one half into the middle of the other */
    snprintf(line, sizeof line, "{\"do\":\"pin\",\"corner\":[8,8],\"uv\":[%.6f,%.6f]}", uv_at(s, 32, 28)[0],
             uv_at(s, 32, 28)[1]);
    do_line(s, line);
    uint8_t red[SHEET_F];
    int32_t count;
    assert_int_equal(sl_session_page_red(s, NULL, red, &count), SL_OK);
    assert_true(count > 0);
    assert_int_equal(sl_session_save(s, file, path, false, NULL, &check, &diag), SL_CHECK_FAILED);
    assert_false(check.passed);
    assert_int_equal(sl_meshfile_read(path, &back, NULL), SL_IO);
    assert_int_equal(sl_session_save(s, file, path, true, NULL, &check, &diag), SL_OK);
    do_line(s, "{\"do\":\"undo\",\"to\":\"packed\"}");
    assert_int_equal(sl_session_save(s, file, path, false, NULL, &check, &diag), SL_OK);
    assert_true(check.passed);
    assert_int_equal(sl_meshfile_read(path, &back, &diag), SL_OK);
    for (int32_t c = 0; c < 4 * SHEET_F; c++) {
        const int32_t h = c; /* nothing was reversed */
        assert_true(test_near(back->corner_uv[2 * c], sl_session_corner_uv(s)[2 * h], 1e-12));
    }
    sl_meshfile_free(back);
    sl_meshfile_free(file);
    sl_session_free(s);
}

static void a_drag_ends_where_the_plain_action_does(void **state)
{
    (void)state;
    sheet t;
    sheet_make(&t);
    sl_session *s = open_polygons(&t.polygons, "{\"do\":\"open\"}", NULL);
    sl_session *plain = open_polygons(&t.polygons, "{\"do\":\"open\"}", NULL);
    sl_diag diag = sl_diag_none();
    sl_action a = sl_action_default(SL_ACTION_ANGLE), bad;
    assert_int_equal(sl_action_set_items(&a, 2, (const int32_t[]){9, 8}), SL_OK);
    const uint64_t before = sl_session_hash(s);
    const double start = sl_session_planar_angle(s, sl_session_find_corner(s, 9, 8));
    for (int k = 1; k <= 10; k++) {
        a.number = start - 2.0 * k;
        assert_int_equal(sl_session_drag(s, &a, NULL, &diag), SL_OK);
        assert_true(sl_session_dragging(s));
        assert_null(edit_broken(s));
        assert_true(fabs(sl_session_planar_angle(s, sl_session_find_corner(s, 9, 8)) - a.number) < 1.5);
    }
    const uint64_t shown = sl_session_hash(s);
    assert_int_equal(sl_action_copy(&a, &bad), SL_OK);
    bad.number = 500.0;
    assert_int_equal(sl_session_drag(s, &bad, NULL, &diag), SL_INFEASIBLE); /* what was shown stays */
    assert_true(sl_session_hash(s) == shown && sl_session_dragging(s));
    assert_int_equal(sl_session_lines(s), 1);
    assert_int_equal(sl_session_release(s, &a, NULL, &diag), SL_OK);
    assert_int_equal(sl_session_apply(plain, &a, NULL, &diag), SL_OK);
    assert_true(sl_session_hash(s) == sl_session_hash(plain));
    do_line(s, "{\"do\":\"undo\"}");
    assert_true(sl_session_hash(s) == before);
    sl_action sew = sl_action_default(SL_ACTION_UNSEW); /* a zipper dragged, then let go of */
    assert_int_equal(sl_action_set_items(&sew, 3, (const int32_t[]){4, 14, 4}), SL_OK);
    for (int k = 1; k < 5; k++) {
        sew.number = 1.0 * k;
        assert_int_equal(sl_session_drag(s, &sew, NULL, &diag), SL_OK);
        assert_null(edit_broken(s));
    }
    sl_session_cancel_drag(s);
    assert_true(sl_session_hash(s) == before && !sl_session_dragging(s));
    bad.kind = SL_ACTION_UNDO;
    assert_int_equal(sl_session_drag(s, &bad, NULL, &diag), SL_BAD_INPUT);
    sl_action_clear(&a);
    sl_action_clear(&bad);
    sl_action_clear(&sew);
    sl_session_free(s);
    sl_session_free(plain);
}

static bool never(void *user, const char *stage, double fraction)
{
    (void)stage;
    (void)fraction;
    ++*(int32_t *)user;
    return false;
}

static void a_cancelled_action_leaves_no_trace(void **state)
{
    (void)state;
    sheet t;
    sheet_make(&t);
    sl_session *s = open_polygons(&t.polygons, "{\"do\":\"open\"}", NULL);
    int32_t asked = 0;
    const sl_context context = {.progress = never, .progress_user = &asked};
    const uint64_t before = sl_session_hash(s);
    sl_action a = sl_action_default(SL_ACTION_ANGLE);
    assert_int_equal(sl_action_set_items(&a, 2, (const int32_t[]){0, 0}), SL_OK);
    a.number = 70.0;
    assert_int_equal(sl_session_apply(s, &a, &context, NULL), SL_CANCELLED);
    assert_true(asked > 0 && sl_session_hash(s) == before);
    assert_int_equal(sl_session_lines(s), 1);
    assert_int_equal(sl_session_apply(s, &a, NULL, NULL), SL_OK);
    sl_action_clear(&a);
    sl_session_free(s);
}

static void the_number_of_workers_changes_no_byte(void **state)
{
    (void)state;
    uint64_t hash[3];
    static const int32_t workers[3] = {1, 2, 5};
    for (int k = 0; k < 3; k++) {
        sl_generated *hand = NULL;
        sl_polygons polygons;
        sl_thread_pool *pool = NULL;
        assert_int_equal(sl_generator_find("hand")->make(5, 0, &hand), SL_OK);
        sl_generated_polygons(hand, &polygons);
        assert_int_equal(sl_thread_pool_create(workers[k], &pool), SL_OK);
        const sl_context context = {.executor = sl_thread_pool_executor(pool)};
        sl_session *s = NULL;
        const sl_atlas_def def = small_def();
        sl_action open = sl_action_default(SL_ACTION_OPEN);
        assert_int_equal(sl_session_create(&polygons, NULL, &open, &def, &context, &s, NULL), SL_OK);
        test_rng rng = test_rng_seed(0x77);
        for (int i = 0; i < 25; i++) {
            sl_action a = edit_random_action(s, &rng);
            const sl_status status = sl_session_apply(s, &a, &context, NULL);
            assert_true(status == SL_OK || status == SL_BAD_INPUT || status == SL_INFEASIBLE);
            sl_action_clear(&a);
        }
        hash[k] = sl_session_hash(s);
        sl_session_free(s);
        sl_thread_pool_free(pool);
        sl_generated_free(hand);
    }
    assert_true(hash[0] == hash[1] && hash[0] == hash[2]);
}

/* A facet of a copy, and of what it shows; how many copies there are. */
static int32_t find_copy(const sl_session *s, int32_t *copy, int32_t *shown)
{
    int32_t n = 0;
    for (int32_t i = 0; i < sl_session_slots(s); i++) {
        sl_session_chart c, d;
        sl_session_chart_info(s, i, &c);
        if (c.faces > 0 && c.copy_of >= 0) {
            sl_session_chart_info(s, c.copy_of, &d);
            *copy = c.face[0];
            *shown = d.face[0];
            n++;
        }
    }
    return n;
}

static void copies_follow_part_and_are_made_again(void **state)
{
    (void)state;
    sl_generated *body = NULL;
    sl_polygons polygons;
    assert_int_equal(sl_generator_find("body")->make(3, 0, &body), SL_OK);
    sl_generated_polygons(body, &polygons);
    sl_session *s = open_polygons(&polygons, "{\"do\":\"open\"}", NULL);
    int32_t copy = -1, shown = -1, h = 0;
    const int32_t copies = find_copy(s, &copy, &shown);
    assert_true(copies > 0);
    const sl_mesh *m = sl_session_mesh(s);
    const sl_planted *mirror = NULL;
    for (int32_t k = 0; k < body->nplanted; k++) {
        mirror = body->planted[k].mirror ? &body->planted[k] : mirror;
    }
    assert_non_null(mirror);
    /* an angle asked of the copy bends what it shows, and the copy with it */
    while (m->sew[h] < 0 || sl_session_face_chart(s)[m->face[h]] != sl_session_face_chart(s)[copy]) {
        h++;
    }
    char line[160];
    int32_t corner[2];
    sl_session_name_corner(s, h, corner);
    snprintf(line, sizeof line, "{\"do\":\"angle\",\"corner\":[%d,%d],\"degrees\":%.3f}", corner[0], corner[1],
             sl_session_planar_angle(s, h) + 8.0);
    const double asked = sl_session_planar_angle(s, h) + 8.0;
    do_line(s, line);
    assert_true(test_near(sl_session_planar_angle(s, h), asked, 1e-3));
    assert_null(edit_broken(s));
    assert_int_equal(find_copy(s, &copy, &shown), copies);
    sl_atlas *atlas = NULL;
    assert_int_equal(sl_session_export(s, NULL, &atlas, NULL), SL_OK);
    assert_int_equal(atlas->check.unlike, 0);
    assert_int_equal(atlas->segmentation->sharing.copies, copies);
    sl_atlas_free(atlas);
    /* off: UVs of its own, not mirrored, in the same box */
    sl_session_chart turned[2];
    const int32_t slot = sl_session_face_chart(s)[copy];
    snprintf(line, sizeof line, "{\"do\":\"rotate\",\"facet\":%d,\"degrees\":21}", copy);
    do_line(s, line);
    sl_session_chart_info(s, slot, &turned[0]);
    snprintf(line, sizeof line, "{\"do\":\"symmetry\",\"facet\":%d,\"on\":false}", copy);
    do_line(s, line);
    sl_session_chart_info(s, slot, &turned[1]);
    for (int k = 0; k < 2; k++) {
        assert_true(test_near(turned[0].low[k], turned[1].low[k], 1e-12));
        assert_true(test_near(turned[0].high[k], turned[1].high[k], 1e-12));
    }
    const int32_t alone = copy, first = shown;
    assert_int_equal(find_copy(s, &copy, &shown), copies - 1);
    assert_null(edit_broken(s));
    refuse_line(s, line, SL_BAD_INPUT);
    /* cut a slit into the one that was shown, then make the other its copy again: it is cut alike */
    for (h = 0; m->twin[h] < 0 || m->sew[sl_prev(m, h)] < 0 ||
                sl_session_face_chart(s)[m->face[h]] != sl_session_face_chart(s)[first];
         h++) {
    }
    int32_t side[3];
    sl_session_name_side(s, h, side);
    snprintf(line, sizeof line, "{\"do\":\"cut-edges\",\"edges\":[[%d,%d]]}", side[0], side[1]);
    do_line(s, line);
    const int32_t corner_of_first = m->face_first[first];
    const int32_t v = m->input_vertex[m->origin[corner_of_first]];
    snprintf(line, sizeof line, "{\"do\":\"symmetry\",\"facet\":%d,\"on\":true,\"corners\":[[%d,%d],[%d,%d]]}", first,
             v, first, mirror->vertex[v], mirror->face[first]);
    do_line(s, line);
    assert_null(edit_broken(s));
    assert_int_equal(find_copy(s, &copy, &shown), copies);
    const double *a = uv_at(s, v, first), *b = uv_at(s, mirror->vertex[v], mirror->face[first]);
    assert_true(a[0] == b[0] && a[1] == b[1]);
    assert_int_equal(sl_session_face_chart(s)[mirror->face[first]], sl_session_face_chart(s)[alone]);
    sl_session_free(s);
    sl_generated_free(body);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(charts_move_turn_and_grow_about_their_boxes),
        cmocka_unit_test(red_facets_on_the_page_are_those_of_all_pairs),
        cmocka_unit_test(what_overlaps_is_saved_only_when_that_is_allowed),
        cmocka_unit_test(a_drag_ends_where_the_plain_action_does),
        cmocka_unit_test(a_cancelled_action_leaves_no_trace),
        cmocka_unit_test(the_number_of_workers_changes_no_byte),
        cmocka_unit_test(copies_follow_part_and_are_made_again),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
