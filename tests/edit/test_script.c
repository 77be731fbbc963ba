#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/file.h"
#include "base/memory.h"
#include "edit/script.h"
#include "edit_support.h"
#include "sheet.h"

static const char *const text = "{\"seamlab\":\"session\",\"version\":1,\"mesh\":\"sheet.obj\",\"vertices\":80,"
                                "\"facets\":63}\n"
                                "# the sheet in halves\n"
                                "{\"do\":\"open\",\"margin\":8}\n"
                                "\n"
                                "{\"do\":\"cut-loop\",\"at\":[4,14,4]}\n"
                                "{\"do\":\"angle\",\"corner\":[0,0],\"degrees\":75}\r\n"
                                "{\"do\":\"undo\"}\n"
                                "{\"do\":\"pack\"}\n";

static sl_status parse(const char *data, int64_t size, bool tolerant, sl_script *script, sl_diag *diag)
{
    *diag = sl_diag_none();
    return sl_script_parse("session.jsonl", data, size, tolerant, script, diag);
}

static void a_script_runs_to_the_state_of_its_actions(void **state)
{
    (void)state;
    sheet t;
    sheet_make(&t);
    sl_script script;
    sl_diag diag;
    sl_session *s = NULL;
    const sl_atlas_def def = small_def();
    assert_int_equal(parse(text, (int64_t)strlen(text), false, &script, &diag), SL_OK);
    assert_int_equal(script.count, 5);
    assert_int_equal(script.line[0], 3);
    assert_int_equal(script.line[4], 8);
    assert_string_equal(script.mesh, "sheet.obj");
    assert_int_equal(sl_script_run(&script, -1, &t.polygons, NULL, &def, NULL, NULL, NULL, &s, &diag), SL_OK);
    sl_session *plain = open_polygons(&t.polygons, "{\"do\":\"open\",\"margin\":8}", NULL);
    do_line(plain, "{\"do\":\"cut-loop\",\"at\":[4,14,4]}");
    do_line(plain, "{\"do\":\"angle\",\"corner\":[0,0],\"degrees\":75}");
    do_line(plain, "{\"do\":\"undo\"}");
    do_line(plain, "{\"do\":\"pack\"}");
    assert_true(sl_session_hash(s) == sl_session_hash(plain));
    sl_session_free(s);
    assert_int_equal(sl_script_run(&script, 2, &t.polygons, NULL, &def, NULL, NULL, NULL, &s, &diag), SL_OK);
    assert_int_equal(sl_session_lines(s), 2);
    sl_session_free(s);
    sl_session_free(plain);
    sl_script_clear(&script);
}

static bool stop_at_two(void *user, const sl_session *session, const sl_script *script, int32_t index)
{
    (void)session;
    (void)script;
    *(int32_t *)user = index;
    return index < 2;
}

static void what_is_wrong_is_said_with_its_line(void **state)
{
    (void)state;
    static const struct {
        const char *text;
        int line;
    } broken[] = {
        {"", 0},
        {"# nothing\n\n", 2},
        {"{\"do\":\"open\"}\n", 1},
        {"{\"seamlab\":\"song\",\"version\":1}\n", 1},
        {"{\"seamlab\":\"session\",\"version\":2}\n", 1},
        {"{\"seamlab\":\"session\",\"version\":1,\"facets\":-3}\n", 1},
        {"{\"seamlab\":\"session\",\"version\":1}\n{\"do\":\"pack\"}\n\n{\"do\":\"dance\"}\n", 4},
        {"{\"seamlab\":\"session\",\"version\":1}\n{\"do\":\"pack\"}\n{\"do\":\"open\"}\n", 3},
        {"{\"seamlab\":\"session\",\"version\":1}\n{\"do\":\"pack\"}\n{\"do\":\"pack", 3},
    };
    sl_script script;
    sl_diag diag;
    for (size_t i = 0; i < SL_COUNTOF(broken); i++) {
        assert_int_equal(parse(broken[i].text, (int64_t)strlen(broken[i].text), false, &script, &diag), SL_BAD_INPUT);
        assert_int_equal(diag.line, broken[i].line);
        assert_int_equal(script.count, 0);
        assert_true(diag.reason[0] != '\0');
    }
    sheet t;
    sheet_make(&t);
    const char *refused = "{\"seamlab\":\"session\",\"version\":1}\n\n{\"do\":\"cut-edges\",\"edges\":[[44,45]]}\n";
    const char *other = "{\"seamlab\":\"session\",\"version\":1,\"facets\":64}\n";
    sl_session *s = NULL;
    int32_t last = -1;
    assert_int_equal(parse(refused, (int64_t)strlen(refused), false, &script, &diag), SL_OK);
    assert_int_equal(sl_script_run(&script, -1, &t.polygons, NULL, NULL, NULL, NULL, NULL, &s, &diag), SL_INFEASIBLE);
    assert_int_equal(diag.line, 3);
    assert_null(s);
    sl_script_clear(&script);
    assert_int_equal(parse(other, (int64_t)strlen(other), false, &script, &diag), SL_OK);
    assert_int_equal(sl_script_run(&script, -1, &t.polygons, NULL, NULL, NULL, NULL, NULL, &s, &diag), SL_BAD_INPUT);
    sl_script_clear(&script);
    assert_int_equal(parse(text, (int64_t)strlen(text), false, &script, &diag), SL_OK);
    assert_int_equal(sl_script_run(&script, -1, &t.polygons, NULL, NULL, stop_at_two, &last, NULL, &s, &diag),
                     SL_CANCELLED);
    assert_int_equal(last, 2);
    sl_script_clear(&script);
    assert_int_equal(sl_script_read("/nowhere/session.jsonl", true, &script, &diag), SL_IO);
}

/* A log may end anywhere: what is whole before that is read, nothing else. */
static void a_log_cut_off_anywhere_gives_its_whole_actions(void **state)
{
    (void)state;
    sl_script script;
    sl_diag diag;
    int32_t before = 0;
    const int64_t size = (int64_t)strlen(text), header = strchr(text, '\n') - text + 1;
    for (int64_t n = header; n <= size; n++) {
        assert_int_equal(parse(text, n, true, &script, &diag), SL_OK);
        int32_t whole = 0;
        for (int64_t i = header; i < n; i++) {
            whole += text[i] == '\n' && text[i - 1] != '\n' && text[i - 1] != 's';
        }
        whole = whole > 1 ? whole : 1; /* without any there is the default open */
        assert_int_equal(script.count, whole);
        assert_int_equal(script.cut_off, text[n - 1] != '\n');
        assert_true(script.count >= before);
        before = script.count;
        sl_script_clear(&script);
    }
    assert_int_equal(before, 5);
}

static void the_log_has_each_line_at_once(void **state)
{
    (void)state;
    sheet t;
    sheet_make(&t);
    char path[512], *data = NULL;
    int64_t size = 0;
    sl_diag diag = sl_diag_none();
    sl_session *s = open_polygons(&t.polygons, "{\"do\":\"open\"}", NULL);
    do_line(s, "{\"do\":\"cut-loop\",\"at\":[4,14,4]}");
    snprintf(path, sizeof path, "%s", test_scratch("log.jsonl"));
    assert_int_equal(sl_session_log_to(s, path, "a \"sheet\"", &diag), SL_OK);
    refuse_line(s, "{\"do\":\"cut-edges\",\"edges\":[[56,57]]}", SL_INFEASIBLE);
    do_line(s, "{\"do\":\"angle\",\"corner\":[0,0],\"degrees\":75.5}");
    do_line(s, "{\"do\":\"undo\"}");
    assert_int_equal(sl_file_read(path, &data, &size, NULL), SL_OK);
    assert_string_equal(data, "{\"seamlab\":\"session\",\"version\":1,\"mesh\":\"a sheet\",\"vertices\":80,\"facets\":"
                              "63}\n{\"do\":\"open\"}\n{\"do\":\"cut-loop\",\"at\":[4,14,4]}\n{\"do\":\"angle\","
                              "\"corner\":[0,0],\"degrees\":75.5}\n{\"do\":\"undo\"}\n");
    sl_free(data);
    assert_int_equal(sl_session_log_to(s, "/nowhere/log.jsonl", "", &diag), SL_IO);
    sl_session_free(s);
    s = open_polygons(&t.polygons, "{\"do\":\"open\"}", NULL);
    if (sl_session_log_to(s, "/dev/full", "", &diag) == SL_OK) { /* the disk is full: the action is taken back */
        refuse_line(s, "{\"do\":\"cut-loop\",\"at\":[4,14,4]}", SL_IO);
    }
    sl_session_free(s);
}

static void bytes_changed_at_random_never_crash(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0x5c21);
    char copy[512];
    const size_t n = strlen(text);
    for (int trial = 0; trial < 4000 * test_multiplier(); trial++) {
        sl_script script;
        sl_diag diag;
        memcpy(copy, text, n);
        for (int k = test_index(&rng, 6); k >= 0; k--) {
            copy[test_index(&rng, (int32_t)n)] = (char)test_index(&rng, 256);
        }
        if (parse(copy, test_index(&rng, (int32_t)n + 1), test_index(&rng, 2) == 0, &script, &diag) == SL_OK) {
            assert_true(script.count >= 1);
            sl_script_clear(&script);
        } else {
            assert_true(diag.reason[0] != '\0');
        }
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_script_runs_to_the_state_of_its_actions),
        cmocka_unit_test(what_is_wrong_is_said_with_its_line),
        cmocka_unit_test(a_log_cut_off_anywhere_gives_its_whole_actions),
        cmocka_unit_test(the_log_has_each_line_at_once),
        cmocka_unit_test(bytes_changed_at_random_never_crash),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
