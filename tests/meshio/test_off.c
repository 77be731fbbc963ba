#include "meshio_support.h"

/* A pyramid on a pentagon: the same polygons in every variant. */
static const double xyz[] = {0.5, 0, -1, 2, 0.25, -1, 2.5, 1.5, -1.125, 1, 2.75, -1, -0.5, 1.5, -1, 1, 1, 3e2};
static const int32_t first[] = {0, 5, 8, 11, 14, 17, 20};
static const int32_t corners[] = {4, 3, 2, 1, 0, 0, 1, 5, 1, 2, 5, 2, 3, 5, 3, 4, 5, 4, 0, 5};

static void assert_pyramid(const sl_meshfile *file)
{
    assert_int_equal(file->nv, 6);
    assert_int_equal(file->nf, 6);
    assert_memory_equal(file->xyz, xyz, sizeof xyz);
    assert_memory_equal(file->face_first, first, sizeof first);
    assert_memory_equal(file->index, corners, sizeof corners);
}

/* Vertices with whatever numbers stand after the position, then the faces with whatever stands after them. */
static test_bytes pyramid(const char *head, const char *before_color, const char *color, const char *after,
                          const char *face_tail, const char *end)
{
    test_bytes to = {0};
    put_text(&to, "%s", head);
    for (int v = 0; v < 6; v++) {
        put_text(&to, " %.17g\t%.17g %.17g %s%s%s%s%s", xyz[3 * v], xyz[3 * v + 1], xyz[3 * v + 2], before_color, color,
                 after, v == 2 ? " # third" : "", end);
    }
    put_text(&to, "%s# faces%s", end, end);
    for (int f = 0; f < 6; f++) {
        put_text(&to, "%d", first[f + 1] - first[f]);
        for (int c = first[f]; c < first[f + 1]; c++) {
            put_text(&to, " %d", corners[c]);
        }
        put_text(&to, "%s%s", face_tail, end);
    }
    return to;
}

static void all_variants_give_the_same_polygons(void **state)
{
    (void)state;
    static const struct {
        const char *head, *before, *color, *after, *tail, *end;
    } cases[] = {
        {"OFF\n6 6 0\n", "", "", "", "", "\n"},
        {"OFF 6 6 10\n", "", "", "", "  ", "\n"},
        {"# hello\n\nOFF # there\n# counts\n6 6\n\n", "", "", "", " 255 0 128", "\r\n"},
        {"6 6 0\r", "", "", "", " 0.5 0.5 0.5 1", "\r"},
        {"COFF\n6 6 0\n", "", " 10 20 30 255", "", " 7", "\n"},
        {"NOFF\n6 6 0\n", " 0.1 0.2 0.3", "", "", "", "\n"},
        {"STOFF\n6 6 0\n", "", "", " 0.25 0.75", "", "\n"},
        {"STCNOFF\n6 6 0\n", " 0.1 0.2 0.3", " 0.5 0.25 0.125 1", " 0.25 0.75", " 1 2 3", "\n"},
        {"\xef\xbb\xbfOFF\r\n6 6 0\r\n", "", "", "", "", "\r\n"},
    };
    for (size_t k = 0; k < SL_COUNTOF(cases); k++) {
        test_bytes bytes =
            pyramid(cases[k].head, cases[k].before, cases[k].color, cases[k].after, cases[k].tail, cases[k].end);
        sl_meshfile *file = parse_bytes("pyramid.off", bytes.data, bytes.size);
        assert_pyramid(file);
        assert_int_equal(file->normals, strchr(cases[k].head, 'N') != NULL ? 6 : 0);
        assert_true((file->corner_uv != NULL) == (strstr(cases[k].head, "ST") != NULL));
        assert_true((file->vertex_rgb != NULL) == (strchr(cases[k].head, 'C') != NULL));
        assert_int_equal(file->extras.face_colors, strspn(cases[k].tail, " ") < strlen(cases[k].tail) ? 6 : 0);
        for (int c = 0; c < 20 && file->corner_uv != NULL; c++) {
            assert_true(file->corner_uv[2 * c] == 0.25 && file->corner_uv[2 * c + 1] == 0.75);
        }
        for (int c = 0; c < 20 && file->normals > 0; c++) {
            assert_int_equal(file->corner_normal[c], corners[c]);
            assert_true(file->normal[3 * corners[c] + 1] == 0.2);
        }
        sl_meshfile_free(file);
        sl_free(bytes.data);
    }
}

static void colours_of_both_scales_are_understood(void **state)
{
    (void)state;
    sl_meshfile *file = parse_text("c.off", "COFF\n3 1 0\n1 2 3 51 102 255 255\n4 5 6 0.25 0.5 1 1\n7 8 10\n3 0 1 2\n");
    assert_true(test_near(file->vertex_rgb[0], 0.2, 1e-15) && test_near(file->vertex_rgb[1], 0.4, 1e-15));
    assert_true(file->vertex_rgb[3] == 0.25 && file->vertex_rgb[5] == 1.0 && isnan(file->vertex_rgb[6]));
    sl_meshfile_free(file);
}

static void every_error_names_its_line(void **state)
{
    (void)state;
    static const struct {
        const char *text;
        sl_status status;
        int64_t line;
        const char *words;
    } cases[] = {
        {"# nothing\n\n", SL_BAD_INPUT, 2, "nothing but comments"},
        {"solid x\n", SL_BAD_INPUT, 1, "keyword OFF is missing"},
        {"OFFX\n3 1 0\n", SL_BAD_INPUT, 1, "keyword OFF is missing"},
        {"OFF\n", SL_BAD_INPUT, 1, "numbers of vertices and faces are missing"},
        {"4OFF\n3 1 0\n", SL_UNSUPPORTED, 1, "not read"},
        {"nOFF\n3 1 0\n", SL_UNSUPPORTED, 1, "not read"},
        {"OFF BINARY\n3 1 0\n", SL_UNSUPPORTED, 1, "not read"},
        {"OFF\nx 1 0\n", SL_BAD_INPUT, 2, "number of vertices is not"},
        {"OFF\n3 1.5 0\n", SL_BAD_INPUT, 2, "number of faces is not"},
        {"OFF\n-3 1 0\n", SL_BAD_INPUT, 2, "cannot stand in"},
        {"OFF\n4000000000000 1 0\n1 2 3\n", SL_BAD_INPUT, 2, "cannot stand in"},
        {"OFF\n3 9000000000000000000 0\n1 2 3\n4 5 6\n7 8 9\n", SL_BAD_INPUT, 2, "cannot stand in"},
        {"OFF\n3 1 0\n1 2 3\n4 5\n7 8 9\n3 0 1 2\n", SL_BAD_INPUT, 4, "needs 3 numbers, this one has 2"},
        {"NOFF\n3 1 0\n1 2 3 4 5\n4 5 6\n7 8 9\n3 0 1 2\n", SL_BAD_INPUT, 3, "needs 6 numbers, this one has 5"},
        {"OFF\n3 1 0\n1 2 3\n4 5 six\n7 8 9\n3 0 1 2\n", SL_BAD_INPUT, 4, "not a number"},
        {"OFF\n3 1 0\n1 2 3\n4 5 inf\n7 8 9\n3 0 1 2\n", SL_BAD_INPUT, 4, "not finite"},
        {"OFF\n3 1 0\n1 2 3\n4 5 6\n7 8 9\n\n3 0 1 3\n", SL_BAD_INPUT, 7, "uses vertex 3, but the file has 3"},
        {"OFF\n3 1 0\n1 2 3\n4 5 6\n7 8 9\n3 0 -1 2\n", SL_BAD_INPUT, 6, "uses vertex -1"},
        {"OFF\n3 1 0\n1 2 3\n4 5 6\n7 8 9\n4 0 1 2\n", SL_BAD_INPUT, 6, "of 4 corners names only 3"},
        {"OFF\n3 1 0\n1 2 3\n4 5 6\n7 8 9\n2 0 1\n", SL_BAD_INPUT, 6, "needs 3 corners, this one has 2"},
        {"OFF\n3 1 0\n1 2 3\n4 5 6\n7 8 9\n3 0 1.0 2\n", SL_BAD_INPUT, 6, "not a whole number"},
        {"OFF\n3 2 0\n1 2 3\n4 5 6\n7 8 9\n3 0 1 2\n", SL_BAD_INPUT, 6, "ends after 3 vertices and 1 faces"},
        {"OFF\n3 1 0\n1 2 3\n4 5 6", SL_BAD_INPUT, 4, "ends after 2 vertices"},
        {"OFF\n3 0 0\n1 2 3\n4 5 6\n7 8 9\n", SL_BAD_INPUT, 5, "no face"},
    };
    for (size_t k = 0; k < SL_COUNTOF(cases); k++) {
        expect_failure("wrong.off", cases[k].text, (int64_t)strlen(cases[k].text), cases[k].status, cases[k].line,
                       cases[k].words);
    }
}

static void a_random_file_is_read_as_it_was_meant(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(700);
    for (int trial = 0; trial < 100 * test_multiplier(); trial++) {
        test_bytes text = {0};
        double points[3 * 40];
        int32_t index[50 * 8], begin[51] = {0};
        const int32_t nv = 3 + test_index(&rng, 37);
        put_text(&text, "OFF\n%d 50 0\n", nv);
        for (int32_t k = 0; k < 3 * nv; k++) {
            points[k] = test_uniform(&rng, -1, 1) * pow(10.0, test_index(&rng, 60) - 30);
            put_text(&text, "%.17g%s", points[k], k % 3 == 2 ? "\n" : " ");
        }
        for (int f = 0; f < 50; f++) {
            begin[f + 1] = begin[f] + 3 + test_index(&rng, 5);
            put_text(&text, "%d", begin[f + 1] - begin[f]);
            for (int32_t c = begin[f]; c < begin[f + 1]; c++) {
                index[c] = test_index(&rng, nv);
                put_text(&text, " %d", index[c]);
            }
            put_text(&text, "\n");
        }
        sl_meshfile *file = parse_bytes("random.off", text.data, text.size);
        assert_int_equal(file->nv, nv);
        assert_memory_equal(file->xyz, points, 3 * (size_t)nv * sizeof *points);
        assert_memory_equal(file->face_first, begin, sizeof begin);
        assert_memory_equal(file->index, index, (size_t)begin[50] * sizeof *index);
        sl_meshfile_free(file);
        sl_free(text.data);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(all_variants_give_the_same_polygons),
        cmocka_unit_test(colours_of_both_scales_are_understood),
        cmocka_unit_test(every_error_names_its_line),
        cmocka_unit_test(a_random_file_is_read_as_it_was_meant),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
