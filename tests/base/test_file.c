#define _POSIX_C_SOURCE 200809L
#define _XOPEN_SOURCE 700
#include "base/file.h"
#include "base/memory.h"
#include "support/test_support.h"

#include <dirent.h>
#include <fcntl.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

typedef struct path_text {
    char text[512];
} path_text;

static path_text scratch(const char *name)
{
    path_text path;
    snprintf(path.text, sizeof path.text, "%s", test_scratch(name));
    return path;
}

static void write_whole(const char *path, const void *data, int64_t size)
{
    sl_writer *writer;
    assert_int_equal(sl_writer_create(path, &writer, NULL), SL_OK);
    sl_writer_bytes(writer, data, size);
    assert_int_equal(sl_writer_commit(writer, NULL), SL_OK);
}

static void assert_holds(const char *path, const void *data, int64_t size)
{
    char *read;
    int64_t n;
    assert_int_equal(sl_file_read(path, &read, &n, NULL), SL_OK);
    assert_int_equal(n, size);
    assert_memory_equal(read, data, (size_t)size);
    assert_int_equal(read[size], 0);
    sl_free(read);
}

/* Files in the scratch folder, hidden ones too. */
static int count_files(void)
{
    path_text path = scratch("x");
    *strrchr(path.text, '/') = '\0';
    DIR *dir = opendir(path.text);
    assert_non_null(dir);
    int n = 0;
    for (const struct dirent *e = readdir(dir); e != NULL; e = readdir(dir)) {
        n += strcmp(e->d_name, ".") != 0 && strcmp(e->d_name, "..") != 0;
    }
    closedir(dir);
    return n;
}

static void what_is_written_is_read_back_for_any_size(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(300);
    const path_text path = scratch("bytes.bin");
    static const int64_t sizes[] = {0, 1, 17, 65535, 65536, 65537, 262143, 262144, 262145, 1000003};
    static char data[1000003];
    for (size_t k = 0; k < sizeof data; k++) {
        data[k] = (char)test_bits(&rng);
    }
    for (size_t s = 0; s < SL_COUNTOF(sizes); s++) {
        write_whole(path.text, data, sizes[s]);
        assert_holds(path.text, data, sizes[s]);
    }
    sl_writer *writer; /* and in pieces of any size, around the buffer's */
    assert_int_equal(sl_writer_create(path.text, &writer, NULL), SL_OK);
    for (int64_t done = 0; done < (int64_t)sizeof data;) {
        int64_t n = test_index(&rng, done % 3 == 0 ? 300000 : 700);
        n = n < (int64_t)sizeof data - done ? n : (int64_t)sizeof data - done;
        sl_writer_bytes(writer, data + done, n);
        done += n;
    }
    assert_int_equal(sl_writer_commit(writer, NULL), SL_OK);
    assert_holds(path.text, data, sizeof data);
    unlink(path.text);
}

static void texts_and_numbers_are_written_as_expected(void **state)
{
    (void)state;
    const path_text path = scratch("text.txt");
    static char longer[3000], expected[4000];
    memset(longer, 'w', sizeof longer - 1);
    sl_writer *writer;
    assert_int_equal(sl_writer_create(path.text, &writer, NULL), SL_OK);
    sl_writer_text(writer, "a,");
    sl_writer_int(writer, 0);
    sl_writer_text(writer, ",");
    sl_writer_int(writer, INT64_MIN);
    sl_writer_text(writer, ",");
    sl_writer_int(writer, INT64_MAX);
    sl_writer_text(writer, ",");
    sl_writer_double(writer, -0.1);
    sl_writer_format(writer, ",%s-%d,%s", "b", 1234, longer);
    assert_int_equal(sl_writer_commit(writer, NULL), SL_OK);
    const int n =
        snprintf(expected, sizeof expected, "a,0,-9223372036854775808,9223372036854775807,-0.1,b-1234,%s", longer);
    assert_holds(path.text, expected, n);
    unlink(path.text);
}

static void nothing_changes_before_commit_and_nothing_stays_behind(void **state)
{
    (void)state;
    const path_text path = scratch("target.txt");
    const int before = count_files();
    write_whole(path.text, "old contents", 12);
    sl_writer *writer;
    assert_int_equal(sl_writer_create(path.text, &writer, NULL), SL_OK);
    for (int k = 0; k < 100000; k++) { /* more than the buffer, so bytes are on the disk by now */
        sl_writer_text(writer, "new contents\n");
    }
    assert_holds(path.text, "old contents", 12);
    assert_int_equal(count_files(), before + 2);
    sl_writer_abandon(writer);
    assert_holds(path.text, "old contents", 12);
    assert_int_equal(count_files(), before + 1);
    write_whole(path.text, "newer", 5);
    assert_holds(path.text, "newer", 5);
    assert_int_equal(count_files(), before + 1);
    unlink(path.text);
    sl_writer_abandon(NULL);
}

static void two_writers_of_one_file_do_not_mix(void **state)
{
    (void)state;
    const path_text path = scratch("twice.txt");
    sl_writer *a, *b;
    assert_int_equal(sl_writer_create(path.text, &a, NULL), SL_OK);
    assert_int_equal(sl_writer_create(path.text, &b, NULL), SL_OK);
    sl_writer_text(a, "first");
    sl_writer_text(b, "second");
    assert_int_equal(sl_writer_commit(b, NULL), SL_OK);
    assert_holds(path.text, "second", 6);
    assert_int_equal(sl_writer_commit(a, NULL), SL_OK);
    assert_holds(path.text, "first", 5);
    unlink(path.text);
}

static void a_link_is_followed_and_permissions_are_kept(void **state)
{
    (void)state;
    const path_text path = scratch("real.txt"), link = scratch("link.txt");
    struct stat info;
    write_whole(path.text, "one", 3);
    assert_int_equal(chmod(path.text, 0640), 0);
    assert_int_equal(symlink(path.text, link.text), 0);
    write_whole(link.text, "two", 3);
    assert_holds(path.text, "two", 3);
    assert_int_equal(lstat(link.text, &info), 0);
    assert_true(S_ISLNK(info.st_mode));
    assert_int_equal(stat(path.text, &info), 0);
    assert_int_equal(info.st_mode & 0777, 0640);
    unlink(link.text);
    unlink(path.text);
}

static void a_full_disk_is_an_error_that_names_the_file(void **state)
{
    (void)state;
    if (access("/dev/full", W_OK) != 0) {
        skip();
    }
    sl_writer *writer;
    sl_diag diag = sl_diag_none();
    assert_int_equal(sl_writer_create("/dev/full", &writer, &diag), SL_OK);
    for (int k = 0; k < 100000; k++) {
        sl_writer_int(writer, k);
    }
    assert_int_equal(sl_writer_commit(writer, &diag), SL_IO);
    assert_string_equal(diag.file, "/dev/full");
    assert_non_null(strstr(diag.reason, "No space left"));
    assert_true(diag.hint[0] != '\0');
}

static void a_failed_write_leaves_the_old_file(void **state)
{
    (void)state;
    const path_text path = scratch("limited.txt");
    const int before = count_files();
    write_whole(path.text, "precious", 8);
    struct rlimit old, small;
    assert_int_equal(getrlimit(RLIMIT_FSIZE, &old), 0);
    small = old;
    small.rlim_cur = 300000;
    signal(SIGXFSZ, SIG_IGN);
    assert_int_equal(setrlimit(RLIMIT_FSIZE, &small), 0);
    sl_writer *writer;
    sl_diag diag = sl_diag_none();
    assert_int_equal(sl_writer_create(path.text, &writer, &diag), SL_OK);
    for (int k = 0; k < 200000; k++) {
        sl_writer_text(writer, "filling");
    }
    const sl_status status = sl_writer_commit(writer, &diag);
    setrlimit(RLIMIT_FSIZE, &old);
    signal(SIGXFSZ, SIG_DFL);
    assert_int_equal(status, SL_IO);
    assert_string_equal(diag.file, path.text);
    assert_holds(path.text, "precious", 8);
    assert_int_equal(count_files(), before + 1);
    unlink(path.text);
}

static void a_target_that_became_a_folder_fails_on_commit(void **state)
{
    (void)state;
    const path_text path = scratch("late");
    const int before = count_files();
    sl_writer *writer;
    sl_diag diag = sl_diag_none();
    assert_int_equal(sl_writer_create(path.text, &writer, &diag), SL_OK);
    sl_writer_text(writer, "x");
    assert_int_equal(mkdir(path.text, 0755), 0);
    assert_int_equal(sl_writer_commit(writer, &diag), SL_IO);
    assert_int_equal(count_files(), before + 1);
    assert_int_equal(rmdir(path.text), 0);
}

static void folders_and_missing_files_are_refused_with_a_reason(void **state)
{
    (void)state;
    path_text folder = scratch("x");
    *strrchr(folder.text, '/') = '\0';
    const path_text missing = scratch("missing/file.obj");
    char *data = (char *)1;
    int64_t size = 5;
    sl_writer *writer;
    sl_diag diag = sl_diag_none();
    assert_int_equal(sl_file_read(folder.text, &data, &size, &diag), SL_IO);
    assert_null(data);
    assert_non_null(strstr(diag.reason, "folder"));
    assert_string_equal(diag.file, folder.text);
    assert_int_equal(sl_file_read(missing.text, &data, &size, &diag), SL_IO);
    assert_non_null(strstr(diag.reason, "No such file"));
    assert_int_equal(sl_file_read(missing.text, &data, &size, NULL), SL_IO);
    assert_int_equal(sl_writer_create(missing.text, &writer, &diag), SL_IO);
    assert_null(writer);
    assert_int_equal(sl_writer_create(folder.text, &writer, &diag), SL_IO);
    assert_null(writer);
    assert_non_null(strstr(diag.reason, "directory"));
}

static void a_dash_reads_standard_input_and_writes_standard_output(void **state)
{
    (void)state;
    const path_text path = scratch("stream.bin");
    static char data[400000];
    test_rng rng = test_rng_seed(301);
    for (size_t k = 0; k < sizeof data; k++) {
        data[k] = (char)test_bits(&rng);
    }
    fflush(stdout);
    const int saved_out = dup(STDOUT_FILENO), saved_in = dup(STDIN_FILENO);
    const int out = open(path.text, O_WRONLY | O_CREAT | O_TRUNC, 0600);
    assert_true(saved_out >= 0 && out >= 0);
    assert_true(dup2(out, STDOUT_FILENO) >= 0);
    sl_writer *writer;
    sl_status status = sl_writer_create("-", &writer, NULL);
    if (status == SL_OK) {
        sl_writer_bytes(writer, data, sizeof data);
        status = sl_writer_commit(writer, NULL);
    }
    dup2(saved_out, STDOUT_FILENO);
    close(out);
    assert_int_equal(status, SL_OK);
    const int in = open(path.text, O_RDONLY);
    assert_true(dup2(in, STDIN_FILENO) >= 0);
    assert_holds("-", data, sizeof data);
    if (saved_in >= 0) {
        dup2(saved_in, STDIN_FILENO);
        close(saved_in);
    }
    close(in);
    close(saved_out);
    unlink(path.text);
}

static void a_pipe_is_read_to_its_end(void **state)
{
    (void)state;
    int ends[2];
    assert_int_equal(pipe(ends), 0);
    assert_int_equal(write(ends[1], "through a pipe", 14), 14);
    close(ends[1]);
    char path[64];
    snprintf(path, sizeof path, "/dev/fd/%d", ends[0]);
    if (access(path, R_OK) == 0) {
        assert_holds(path, "through a pipe", 14);
    }
    close(ends[0]);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(what_is_written_is_read_back_for_any_size),
        cmocka_unit_test(texts_and_numbers_are_written_as_expected),
        cmocka_unit_test(nothing_changes_before_commit_and_nothing_stays_behind),
        cmocka_unit_test(two_writers_of_one_file_do_not_mix),
        cmocka_unit_test(a_link_is_followed_and_permissions_are_kept),
        cmocka_unit_test(a_full_disk_is_an_error_that_names_the_file),
        cmocka_unit_test(a_failed_write_leaves_the_old_file),
        cmocka_unit_test(a_target_that_became_a_folder_fails_on_commit),
        cmocka_unit_test(folders_and_missing_files_are_refused_with_a_reason),
        cmocka_unit_test(a_dash_reads_standard_input_and_writes_standard_output),
        cmocka_unit_test(a_pipe_is_read_to_its_end),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
