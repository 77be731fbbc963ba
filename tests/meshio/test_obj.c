#include "meshio_support.h"

static const char *const all_forms = "# a comment\n"
                                     "mtllib some materials.mtl\n"
                                     "o thing\n"
                                     "v 0.125 -7.5e-1 3.25\n"
                                     "v 1.5 2.5 -3.5 1.0\n"
                                     "  v\t-1 .5 +2. 0.25 0.5 0.75\n"
                                     "v 11 13 17\n"
                                     "v 1e-30 1e30 -0.0\n"
                                     "vt 0.1 0.2\n"
                                     "vt 0.3 0.4 0.9\n"
                                     "vt 0.7\n"
                                     "vn 0.6 0 0.8\n"
                                     "vn 0 -1 0\n"
                                     "g left\n"
                                     "s 1\n"
                                     "usemtl red paint\n"
                                     "f 1 2 3\n"
                                     "f 2/1 3/2 4/3 5/1\n"
                                     "f 1//2 3//1 5//2 # told apart\n"
                                     "fo 4/3/2 \t2/2/1 1/1/1\n"
                                     "f -1/-1/-1 -2/-2/-2 -3/-3/-2\n"
                                     "l 1 2 3\n"
                                     "p 4\n"
                                     "cstype bezier\n"
                                     "f 1 2/1/ 3//1 4/\n";

static const double forms_xyz[] = {0.125, -0.75, 3.25, 1.5, 2.5, -3.5, -1, 0.5, 2, 11, 13, 17, 1e-30, 1e30, -0.0};
static const int32_t forms_first[] = {0, 3, 7, 10, 13, 16, 20};
static const int32_t forms_index[] = {0, 1, 2, 1, 2, 3, 4, 0, 2, 4, 3, 1, 0, 4, 3, 2, 0, 1, 2, 3};
static const int32_t forms_texture[] = {-1, -1, -1, 0, 1, 2, 0, -1, -1, -1, 2, 1, 0, 2, 1, 0, -1, 0, -1, -1};
static const int32_t forms_normal[] = {-1, -1, -1, -1, -1, -1, -1, 1, 0, 1, 1, 0, 0, 1, 0, 0, -1, -1, 0, -1};
static const double forms_uv[] = {0.1, 0.2, 0.3, 0.4, 0.7, 0.0};

static void assert_all_forms(const sl_meshfile *file)
{
    assert_int_equal(file->nv, 5);
    assert_int_equal(file->nf, 6);
    assert_memory_equal(file->face_first, forms_first, sizeof forms_first);
    assert_memory_equal(file->index, forms_index, sizeof forms_index);
    assert_memory_equal(file->xyz, forms_xyz, sizeof forms_xyz);
    assert_memory_equal(file->corner_normal, forms_normal, sizeof forms_normal);
    assert_int_equal(file->normals, 2);
    assert_true(file->normal[2] == 0.8 && file->normal[4] == -1.0);
    for (int c = 0; c < 20; c++) {
        const int32_t t = forms_texture[c];
        const double none[2] = {(double)NAN, (double)NAN};
        assert_same_doubles(file->corner_uv + 2 * c, t >= 0 ? forms_uv + 2 * t : none, 2);
    }
    assert_int_equal(file->extras.names, 5);
    assert_int_equal(file->extras.lines, 1);
    assert_int_equal(file->extras.points, 1);
    assert_int_equal(file->extras.others, 1);
}

static void every_form_of_statement_is_read(void **state)
{
    (void)state;
    sl_meshfile *file = parse_text("forms.obj", all_forms);
    assert_all_forms(file);
    assert_non_null(file->vertex_rgb);
    assert_true(isnan(file->vertex_rgb[0]) && isnan(file->vertex_rgb[5]) && isnan(file->vertex_rgb[14]));
    assert_true(file->vertex_rgb[6] == 0.25 && file->vertex_rgb[7] == 0.5 && file->vertex_rgb[8] == 0.75);
    sl_meshfile_free(file);
}

/* The same statements with other line ends, a byte order mark, or every gap of a face continued on the next line. */
static void line_ends_marks_and_continuations_make_no_difference(void **state)
{
    (void)state;
    static const char *const ends[] = {"\n", "\r\n", "\r"};
    for (int variant = 0; variant < 12; variant++) {
        test_bytes text = {0};
        const char *end = ends[variant % 3];
        const bool continued = variant / 3 % 2 != 0;
        bool keyword = false, comment = false;
        put_text(&text, "%s", variant >= 6 ? "\xef\xbb\xbf" : "");
        for (const char *p = all_forms; *p != '\0'; p++) {
            comment = *p == '#' || (comment && *p != '\n');
            keyword = *p == 'f' || *p == 'v' || (keyword && *p != '\n');
            if (*p == '\n') {
                put_text(&text, "%s", end);
            } else if (*p == ' ' && continued && keyword && !comment) {
                put_text(&text, " \\%s  ", end);
            } else {
                put_bytes(&text, p, 1);
            }
        }
        if (variant % 2 != 0) { /* without the last line end, too */
            text.size -= (int64_t)strlen(end);
        }
        sl_meshfile *file = parse_bytes("variant.obj", text.data, text.size);
        assert_all_forms(file);
        sl_meshfile_free(file);
        sl_free(text.data);
    }
}

static void a_random_file_is_read_as_it_was_meant(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(500);
    for (int trial = 0; trial < 300 * test_multiplier(); trial++) {
        test_bytes text = {0};
        const int32_t nv = 3 + test_index(&rng, 40), nf = 1 + test_index(&rng, 60);
        double xyz[43 * 3], uv[43 * 2];
        int32_t index[60 * 7], texture[60 * 7], first[61] = {0};
        for (int32_t v = 0; v < nv; v++) {
            for (int k = 0; k < 3; k++) {
                xyz[3 * v + k] = test_uniform(&rng, -1.0, 1.0) * pow(10.0, test_index(&rng, 60) - 30);
            }
            uv[2 * v] = test_uniform(&rng, -2, 2);
            uv[2 * v + 1] = test_uniform(&rng, -2, 2);
            put_text(&text, "v %.17g %.17g %.17g\nvt %.17g %.17g\n", xyz[3 * v], xyz[3 * v + 1], xyz[3 * v + 2],
                     uv[2 * v], uv[2 * v + 1]);
        }
        for (int32_t f = 0; f < nf; f++) {
            const int32_t degree = 3 + test_index(&rng, 5);
            put_text(&text, "f");
            for (int32_t c = first[f]; c < first[f] + degree; c++) {
                index[c] = test_index(&rng, nv);
                texture[c] = test_index(&rng, nv);
                const int32_t i = test_index(&rng, 2) != 0 ? index[c] + 1 : index[c] - nv;
                const int32_t t = test_index(&rng, 2) != 0 ? texture[c] + 1 : texture[c] - nv;
                put_text(&text, "%*s%d/%d%s", 1 + test_index(&rng, 3), "", i, t,
                         test_index(&rng, 9) == 0 ? " \\\n" : "");
            }
            first[f + 1] = first[f] + degree;
            put_text(&text, "%s", test_index(&rng, 3) == 0 ? " # no matter\n\n" : "\n");
        }
        sl_meshfile *file = parse_bytes("random.obj", text.data, text.size);
        assert_int_equal(file->nv, nv);
        assert_int_equal(file->nf, nf);
        assert_memory_equal(file->xyz, xyz, 3 * (size_t)nv * sizeof *xyz);
        assert_memory_equal(file->face_first, first, ((size_t)nf + 1) * sizeof *first);
        assert_memory_equal(file->index, index, (size_t)first[nf] * sizeof *index);
        for (int32_t c = 0; c < first[nf]; c++) {
            assert_same_doubles(file->corner_uv + 2 * c, uv + 2 * texture[c], 2);
        }
        assert_null(file->normal);
        assert_null(file->vertex_rgb);
        sl_meshfile_free(file);
        sl_free(text.data);
    }
}

static void every_error_names_its_line(void **state)
{
    (void)state;
    static const struct {
        const char *text;
        int64_t line;
        const char *words;
    } cases[] = {
        {"v 1 2\nf 1 1 1\n", 1, "needs 3 numbers, this one has 2"},
        {"v 1 2 3\nv 1 2 x7\n", 2, "'x7' is not a number"},
        {"v 1,5 2 3\n", 1, "'1,5' is not a number"},
        {"v 1 2 3e\n", 1, "is not a number"},
        {"v 1 2 nan\n", 1, "not finite"},
        {"v 1 2 3\n\n# c\nv 1 -inf 3\n", 4, "not finite"},
        {"v 1 2 1e999\n", 1, "not finite"},
        {"v 1 2 3\nf 1 1 0\n", 2, "vertex 0"},
        {"v 1 2 3\nf 1 1 -2\n", 2, "uses vertex -2 where there are 1"},
        {"v 1 2 3\nf 1 1\n", 2, "needs 3 corners, this one has 2"},
        {"v 1 2 3\nf\n", 2, "needs 3 corners, this one has 0"},
        {"v 1 2 3\nf 1 1 2\nf 1 1 1\nv 4 5 6\nf 1 4 1\nf 3 1 1\n", 5, "uses vertex 4, but the file has 2"},
        {"v 1 2 3\nf 1/1 1/1 1/1\n", 2, "texture vertex 1, but the file has 0"},
        {"v 1 2 3\nvn 1 0 0\nf 1//1 1//2 1//1\n", 3, "normal 2, but the file has 1"},
        {"v 1 2 3\nf 1 1 1x\n", 2, "'x' is not a corner"},
        {"v 1 2 3\nf 1/2/3/4 1 1\n", 2, "'/4' is not a corner"},
        {"v 1 2 3\nf 1 /1 1\n", 2, "'/1' is not the number of a vertex"},
        {"v 1 2 3\nf 1 1 99999999999999999999\n", 2, "is not the number of a vertex"},
        {"v 1 2 3\nf 1 1 4294967297\n", 2, "uses vertex 4294967297"},
        {"v 1 2 3\nvn 1 2\n", 2, "a normal needs 3 numbers"},
        {"vt\n", 1, "a texture vertex needs 1"},
        {"v 1 \\\n 2 \\\r\n y\n", 3, "'y' is not a number"},
        {"v 1 2 3\nv 4 5 6\n", 0, "no face"},
        {"hello world\n", 0, "no face"},
    };
    for (size_t k = 0; k < SL_COUNTOF(cases); k++) {
        expect_failure("wrong.obj", cases[k].text, (int64_t)strlen(cases[k].text), SL_BAD_INPUT, cases[k].line,
                       cases[k].words);
    }
    const sl_diag diag = expect_failure("comma.obj", "v 1,5 2 3\n", 10, SL_BAD_INPUT, 1, "1,5");
    assert_non_null(strstr(diag.hint, "point"));
}

static void vertices_may_follow_the_faces_that_use_them(void **state)
{
    (void)state;
    sl_meshfile *file = parse_text("late.obj", "f 3 1/2 2\nv 1 2 3\nv 4 5 6\nv 7 8 10\nvt 0 0\nvt 0.25 0.75\n");
    static const int32_t expected[] = {2, 0, 1};
    assert_memory_equal(file->index, expected, sizeof expected);
    assert_true(file->corner_uv[2] == 0.25 && file->corner_uv[3] == 0.75 && isnan(file->corner_uv[0]));
    sl_meshfile_free(file);
}

static void a_comment_that_ends_in_a_backslash_is_one_line(void **state)
{
    (void)state;
    sl_meshfile *file = parse_text("path.obj", "# C:\\models\\\nv 1 2 3\nv 3 4 5 # \\\nv 0 1 5\nf 1 2 3\n");
    assert_int_equal(file->nv, 3);
    sl_meshfile_free(file);
}

static void writing_changes_faces_and_texture_vertices_only(void **state)
{
    (void)state;
    static const char *const before = "\xef\xbb\xbf# kept\r\nmtllib a b.mtl\r\no n\r\nv 1.50 2 3\r\nvt 9 9\r\n"
                                      "v 4 5 6e0\r\nvt 8 8 \\\r\n 8\r\nv 7 8 10\r\nvn 0 0 1\r\n"
                                      "usemtl m\r\nf 1/1/1 2/2/1 \\\r\n 3/1/1 # x\r\ng late\r\nl 1/1 3/2 # a/b\r\n"
                                      "f -1 -2 1//1\r\nl 2 3";
    static const char *const after = "# kept\r\nmtllib a b.mtl\r\no n\r\nv 1.50 2 3\r\n"
                                     "v 4 5 6e0\r\nv 7 8 10\r\nvn 0 0 1\r\n"
                                     "usemtl m\r\nvt 0.5 0.25\r\nvt 0.125 -1\r\nvt 0.5 0.25\r\n"
                                     "f 1/1/1 2/2/1 3/3/1\r\ng late\r\nl 1 3 # a/b\r\n"
                                     "f 3/3 2 1/1/1\r\nl 2 3";
    static const double uv[] = {0.5, 0.25, 0.125, -1, 0.5, 0.25, 0.5, 0.25, (double)NAN, 3, 0.5, 0.25};
    int64_t size;
    sl_meshfile *file = parse_text("in.obj", before);
    char *text = write_and_load("out.obj", file, uv, &size);
    assert_string_equal(text, after);
    sl_free(text);
    text = write_and_load("same.obj", file, NULL, &size);
    assert_string_equal(text, before + 3);
    sl_free(text);
    sl_meshfile_free(file);
}

static void uvs_written_are_read_back_exactly_and_shared_by_vertex(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(501);
    for (int trial = 0; trial < 100 * test_multiplier(); trial++) {
        test_bytes text = {0};
        const int32_t nv = 3 + test_index(&rng, 30);
        for (int32_t v = 0; v < nv; v++) {
            put_text(&text, "v %.17g %.17g %.17g\n", test_uniform(&rng, -9, 9), test_uniform(&rng, -9, 9),
                     test_uniform(&rng, -9, 9));
        }
        for (int f = 0; f < 50; f++) {
            put_text(&text, "f %d %d %d\n", 1 + test_index(&rng, nv), 1 + test_index(&rng, nv),
                     1 + test_index(&rng, nv));
        }
        sl_meshfile *file = parse_bytes("a.obj", text.data, text.size);
        double *uv = random_uv(&rng, file);
        for (int k = 0; k < 300 && trial % 4 == 0; k++) {
            uv[k] = 0.375; /* one UV everywhere is still a texture vertex a vertex */
        }
        int64_t size;
        char *written = write_and_load("b.obj", file, uv, &size);
        sl_meshfile *again = parse_bytes("b.obj", written, size);
        assert_same_polygons(file, again);
        assert_same_doubles(again->corner_uv, uv, 2 * (int64_t)file->face_first[file->nf]);
        int expected = 0, found = 0; /* distinct pairs of vertex and UV, by brute force */
        for (int c = 0; c < 150; c++) {
            bool fresh = !isnan(uv[2 * c]);
            for (int d = 0; d < c && fresh; d++) {
                fresh = !(file->index[c] == file->index[d] && uv[2 * c] == uv[2 * d] && uv[2 * c + 1] == uv[2 * d + 1]);
            }
            expected += fresh;
        }
        for (const char *p = strstr(written, "vt "); p != NULL; p = strstr(p + 3, "vt ")) {
            found++;
        }
        assert_int_equal(found, expected);
        sl_meshfile_free(again);
        sl_free(written);
        sl_free(uv);
        sl_meshfile_free(file);
        sl_free(text.data);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_form_of_statement_is_read),
        cmocka_unit_test(line_ends_marks_and_continuations_make_no_difference),
        cmocka_unit_test(a_random_file_is_read_as_it_was_meant),
        cmocka_unit_test(every_error_names_its_line),
        cmocka_unit_test(vertices_may_follow_the_faces_that_use_them),
        cmocka_unit_test(a_comment_that_ends_in_a_backslash_is_one_line),
        cmocka_unit_test(writing_changes_faces_and_texture_vertices_only),
        cmocka_unit_test(uvs_written_are_read_back_exactly_and_shared_by_vertex),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
