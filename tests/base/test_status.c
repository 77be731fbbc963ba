#include "base/status.h"
#include "support/test_support.h"

#include <stdio.h>
#include <string.h>

static void every_status_has_a_name_of_its_own(void **state)
{
    (void)state;
    for (int a = SL_OK; a <= SL_INTERNAL; a++) {
        assert_non_null(sl_status_name((sl_status)a));
        assert_string_not_equal(sl_status_name((sl_status)a), "unknown status");
        for (int b = SL_OK; b < a; b++) {
            assert_string_not_equal(sl_status_name((sl_status)a), sl_status_name((sl_status)b));
        }
    }
    assert_string_equal(sl_status_name((sl_status)977), "unknown status");
}

static void a_diagnostic_prints_what_is_known_and_nothing_else(void **state)
{
    (void)state;
    char text[1024];
    sl_diag diag = sl_diag_none();
    sl_diag_reason(&diag, "%d corners", 17);
    sl_diag_format(&diag, text, sizeof text);
    assert_string_equal(text, "17 corners");
    snprintf(diag.file, sizeof diag.file, "a b.obj");
    sl_diag_format(&diag, text, sizeof text);
    assert_string_equal(text, "a b.obj: 17 corners");
    diag.byte = 4242;
    sl_diag_format(&diag, text, sizeof text);
    assert_string_equal(text, "a b.obj: byte 4242: 17 corners");
    diag.line = 391;
    diag.element = 0;
    sl_diag_hint(&diag, "try %s", "again");
    sl_diag_format(&diag, text, sizeof text);
    assert_string_equal(text, "a b.obj:391: 17 corners (element 0); try again");
}

static void a_diagnostic_too_long_for_its_buffer_is_cut_and_terminated(void **state)
{
    (void)state;
    char whole[1024], part[1024];
    sl_diag diag = sl_diag_none();
    snprintf(diag.file, sizeof diag.file, "folder/mesh.ply");
    diag.line = 12345;
    diag.element = 678;
    sl_diag_reason(&diag, "something is wrong");
    sl_diag_hint(&diag, "do something");
    sl_diag_format(&diag, whole, sizeof whole);
    for (size_t size = 1; size <= strlen(whole) + 1; size++) {
        memset(part, 'x', sizeof part);
        sl_diag_format(&diag, part, size);
        assert_int_equal(strlen(part), size - 1);
        assert_memory_equal(part, whole, size - 1);
        assert_int_equal(part[size], 'x');
    }
    part[0] = 'x';
    sl_diag_format(&diag, part, 0);
    assert_int_equal(part[0], 'x');
}

static void a_long_reason_is_cut_and_a_missing_diagnostic_is_ignored(void **state)
{
    (void)state;
    char longer[900];
    memset(longer, 'q', sizeof longer - 1);
    longer[sizeof longer - 1] = '\0';
    sl_diag diag = sl_diag_none();
    sl_diag_reason(&diag, "%s", longer);
    sl_diag_hint(&diag, "%s", longer);
    assert_int_equal(strlen(diag.reason), sizeof diag.reason - 1);
    assert_int_equal(strlen(diag.hint), sizeof diag.hint - 1);
    sl_diag_reason(NULL, "%s", longer);
    sl_diag_hint(NULL, "%s", longer);
}

static sl_status leave_early(sl_status first, int *reached)
{
    sl_status status;
    SL_TRY(first);
    *reached = 1;
    SL_TRY(SL_OK);
    *reached = 2;
cleanup:
    return status;
}

static void try_leaves_at_the_first_failure(void **state)
{
    (void)state;
    int reached = 0;
    assert_int_equal(leave_early(SL_SINGULAR, &reached), SL_SINGULAR);
    assert_int_equal(reached, 0);
    assert_int_equal(leave_early(SL_OK, &reached), SL_OK);
    assert_int_equal(reached, 2);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_status_has_a_name_of_its_own),
        cmocka_unit_test(a_diagnostic_prints_what_is_known_and_nothing_else),
        cmocka_unit_test(a_diagnostic_too_long_for_its_buffer_is_cut_and_terminated),
        cmocka_unit_test(a_long_reason_is_cut_and_a_missing_diagnostic_is_ignored),
        cmocka_unit_test(try_leaves_at_the_first_failure),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
