#define _POSIX_C_SOURCE 200809L
/* Failures as rows, the command line, claims. */
#include "support/claims.h"
#include "support/failures.h"
#include "support/test_support.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static char folder[64];

static int make_folder(void **state)
{
    (void)state;
    strcpy(folder, "/tmp/seamlab-rows-XXXXXX");
    return mkdtemp(folder) != NULL ? 0 : -1;
}

static int remove_folder(void **state)
{
    (void)state;
    char command[96];
    snprintf(command, sizeof command, "rm -r %s", folder);
    return system(command);
}

static const char *path_of(const char *name)
{
    static char path[128];
    snprintf(path, sizeof path, "%s/%s", folder, name);
    return path;
}

static void write_text(const char *name, const char *text)
{
    FILE *file = fopen(path_of(name), "w");
    assert_non_null(file);
    fputs(text, file);
    assert_int_equal(fclose(file), 0);
}

static char *section_of(exp_run *run)
{
    char *text = NULL;
    int64_t size = 0;
    exp_page page = {0};
    run->out = folder;
    assert_int_equal(exp_page_open(run, "somewhere", "a heading", &page), SL_OK);
    exp_failures_show(run, &page);
    assert_int_equal(exp_page_close(run, &page), SL_OK);
    assert_int_equal(sl_file_read(path_of("section.html"), &text, &size, NULL), SL_OK);
    return text;
}

static void a_failed_model_is_kept_with_its_reason_and_the_loop_goes_on(void **state)
{
    (void)state;
    exp_run *run = calloc(1, sizeof *run);
    sl_status status = SL_BAD_INPUT;
    run->diag = sl_diag_none();
    sl_diag_reason(&run->diag, "a corner <of %d> has no UV", 17);
    assert_true(exp_failed(run, "mug & spoon", &status));
    assert_int_equal(status, SL_OK);
    assert_int_equal(run->failed, 1);
    assert_string_equal(run->diag.reason, "");
    assert_non_null(strstr(run->failure[0].reason, sl_status_name(SL_BAD_INPUT)));
    assert_int_equal(exp_row(run, "nobody said why", SL_INTERNAL), SL_OK);
    assert_string_equal(run->failure[1].reason, sl_status_name(SL_INTERNAL));
    char *text = section_of(run);
    assert_non_null(strstr(text, "mug &amp; spoon"));
    assert_non_null(strstr(text, "a corner &lt;of 17&gt; has no UV"));
    assert_non_null(strstr(text, "nobody said why"));
    sl_free(text);
    free(run);
}

static void what_ends_a_run_is_no_failure_of_a_model(void **state)
{
    (void)state;
    static const sl_status through[] = {SL_OK, SL_CANCELLED, SL_IO};
    exp_run *run = calloc(1, sizeof *run);
    for (size_t k = 0; k < SL_COUNTOF(through); k++) {
        sl_status status = through[k];
        assert_false(exp_failed(run, "mug", &status));
        assert_int_equal(status, through[k]);
        assert_int_equal(exp_row(run, "mug", through[k]), through[k]);
    }
    assert_int_equal(run->failed, 0);
    char *text = section_of(run);
    assert_null(strstr(text, "What failed"));
    sl_free(text);
    free(run);
}

static void more_failures_than_are_kept_are_counted(void **state)
{
    (void)state;
    exp_run *run = calloc(1, sizeof *run);
    char name[200];
    memset(name, 'x', sizeof name - 1);
    name[sizeof name - 1] = '\0';
    for (int k = 0; k < EXP_MAX_FAILURES + 9; k++) {
        assert_int_equal(exp_row(run, name, SL_LIMIT), SL_OK);
    }
    assert_int_equal(run->failed, EXP_MAX_FAILURES + 9);
    assert_int_equal(strlen(run->failure[EXP_MAX_FAILURES - 1].name), sizeof run->failure[0].name - 1);
    char *text = section_of(run);
    assert_non_null(strstr(text, "265 failed"));
    sl_free(text);
    free(run);
}

static void a_mesh_file_that_cannot_be_read_is_the_meshs_fault(void **state)
{
    (void)state;
    exp_source source = {.name = "nowhere"};
    exp_mesh mesh;
    snprintf(source.path, sizeof source.path, "%s/nowhere.obj", folder);
    assert_int_equal(exp_mesh_load(&source, &mesh, NULL), SL_BAD_INPUT);
    exp_mesh_clear(&mesh);
    source.generated = true;
    assert_int_equal(exp_mesh_load(&source, &mesh, NULL), SL_BAD_INPUT);
    exp_mesh_clear(&mesh);
}

/* Starts a run with up to five arguments and ends it. */
static bool begins(exp_run *run, const char *a, const char *b, const char *c, const char *d, const char *e)
{
    char *argv[] = {(char *)"experiment", (char *)a, (char *)b, (char *)c, (char *)d, (char *)e, NULL};
    int argc = 0;
    while (argv[argc] != NULL) {
        argc++;
    }
    const bool good = exp_begin(run, argc, argv);
    if (good) {
        assert_int_equal(exp_end(run, SL_OK, 0), 0);
    }
    return good;
}

static void added_files_are_named_and_readable(void **state)
{
    (void)state;
    exp_run *run = calloc(1, sizeof *run);
    char one[160], two[160];
    write_text("a=b.obj", "v 0 0 0\n");
    write_text("empty.obj", "");
    snprintf(one, sizeof one, "xatlas-2.0_x=%s", path_of("a=b.obj"));
    assert_true(begins(run, "--quick", "--add", one, folder, NULL));
    assert_true(run->quick);
    assert_int_equal(run->added, 1);
    assert_string_equal(run->add[0].name, "xatlas-2.0_x");
    assert_string_equal(run->add[0].path, path_of("a=b.obj"));
    assert_true(begins(run, folder, "--add", one, "--add", one));
    assert_int_equal(run->added, 2);
    snprintf(two, sizeof two, "x=%s", path_of("empty.obj"));
    static const char *const wrong[] = {"x", "=y", "x=", "", "a/b=/dev/null", "a b=/dev/null", "x=/nowhere/at/all.obj"};
    for (size_t k = 0; k < SL_COUNTOF(wrong); k++) {
        assert_false(begins(run, folder, "--add", wrong[k], NULL, NULL));
    }
    assert_false(begins(run, folder, "--add", two, NULL, NULL)); /* empty */
    snprintf(two, sizeof two, "x=%s", folder);
    assert_false(begins(run, folder, "--add", two, NULL, NULL)); /* a folder */
    assert_false(begins(run, folder, "--add", NULL, NULL, NULL));
    assert_false(begins(run, "--add", one, NULL, NULL, NULL));
    assert_false(begins(run, folder, folder, folder, NULL, NULL));
    free(run);
}

static void too_many_added_files_are_refused(void **state)
{
    (void)state;
    exp_run *run = calloc(1, sizeof *run);
    char text[160], *argv[2 * EXP_MAX_ADDED + 5] = {(char *)"experiment", folder};
    write_text("uv.obj", "v 0 0 0\n");
    snprintf(text, sizeof text, "x=%s", path_of("uv.obj"));
    for (int k = 0; k <= EXP_MAX_ADDED; k++) {
        argv[2 + 2 * k] = (char *)"--add";
        argv[3 + 2 * k] = text;
    }
    assert_false(exp_begin(run, 2 * EXP_MAX_ADDED + 4, argv));
    assert_true(exp_begin(run, 2 * EXP_MAX_ADDED + 2, argv));
    assert_int_equal(run->added, EXP_MAX_ADDED);
    assert_int_equal(exp_end(run, SL_OK, 0), 0);
    free(run);
}

static void claims_hold_against_their_worst_measurement(void **state)
{
    (void)state;
    exp_claims claims;
    write_text("claims.csv", "# a comment\nmug,charts,<=,3.5,always,\"Short\" (Sec. 1)\n*,fill,>=,0.25,always\n"
                             "mug,axis,=,1,corpus\nmug,never,<=,1,always\n");
    assert_int_equal(exp_claims_read(path_of("claims.csv"), &claims, NULL), SL_OK);
    assert_int_equal(claims.count, 4);
    assert_true(exp_claims_measure(&claims, "mug", "charts", 2.0));
    assert_true(exp_claims_measure(&claims, "spoon", "charts", 9.0)); /* of another mesh */
    assert_true(exp_claims_measure(&claims, "spoon", "fill", 0.31));
    assert_true(exp_claims_measure(&claims, "mug", "fill", 0.26));
    assert_string_equal(claims.claim[1].worst_mesh, "mug");
    assert_false(exp_claim_broken(&claims.claim[0]) || exp_claim_broken(&claims.claim[1]));
    assert_true(exp_claim_broken(&claims.claim[3]));
    assert_false(exp_claims_measure(&claims, "mug", "charts", nextafter(3.5, 4.0)));
    assert_false(exp_claims_measure(&claims, "fork", "fill", (double)NAN));
    assert_true(exp_claim_broken(&claims.claim[0]) && exp_claim_broken(&claims.claim[1]));
    assert_string_equal(claims.claim[1].worst_mesh, "fork");
    assert_string_equal(claims.claim[0].says, "\"Short\" (Sec. 1)");
    exp_claims_clear(&claims);
}

static void a_line_that_is_no_claim_is_named(void **state)
{
    (void)state;
    static const char *const wrong[] = {"mug,charts,<,3,always\n", "mug,charts,<=,3x,always\n", "mug,charts,<=,3\n",
                                        "mug,charts,<=,3,sometimes\n"};
    for (size_t k = 0; k < SL_COUNTOF(wrong); k++) {
        exp_claims claims;
        sl_diag diag = sl_diag_none();
        char text[128];
        snprintf(text, sizeof text, "# first\nmug,charts,<=,3,always\n%s", wrong[k]);
        write_text("claims.csv", text);
        assert_int_equal(exp_claims_read(path_of("claims.csv"), &claims, &diag), SL_BAD_INPUT);
        assert_non_null(strstr(diag.reason, "line 3"));
        exp_claims_clear(&claims);
    }
    exp_claims claims;
    assert_int_equal(exp_claims_read(path_of("nowhere.csv"), &claims, NULL), SL_IO);
    exp_claims_clear(&claims);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_failed_model_is_kept_with_its_reason_and_the_loop_goes_on),
        cmocka_unit_test(what_ends_a_run_is_no_failure_of_a_model),
        cmocka_unit_test(more_failures_than_are_kept_are_counted),
        cmocka_unit_test(a_mesh_file_that_cannot_be_read_is_the_meshs_fault),
        cmocka_unit_test(added_files_are_named_and_readable),
        cmocka_unit_test(too_many_added_files_are_refused),
        cmocka_unit_test(claims_hold_against_their_worst_measurement),
        cmocka_unit_test(a_line_that_is_no_claim_is_named),
    };
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
