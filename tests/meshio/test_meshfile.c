#include "meshio/ply_export.h"
#include "meshio_support.h"

#define TRIANGLE_OBJ "v 0.5 1.5 2.5\nv 3 4.75 5\nv 6 7 8.125\nf 3 1 2\n"
#define TRIANGLE_OFF "OFF\n3 1 0\n0.5 1.5 2.5\n3 4.75 5\n6 7 8.125\n3 2 0 1\n"
#define TRIANGLE_PLY                                                                                                   \
    "ply\nformat ascii 1.0\nelement vertex 3\nproperty double x\nproperty double y\nproperty double z\n"               \
    "element face 1\nproperty list uchar int vertex_indices\nend_header\n0.5 1.5 2.5\n3 4.75 5\n6 7 8.125\n3 2 0 1\n"

static void the_format_is_told_by_extension_and_else_by_content(void **state)
{
    (void)state;
    static const struct {
        const char *name, *text;
        sl_meshformat format;
    } cases[] = {
        {"a.obj", TRIANGLE_OBJ, SL_FORMAT_OBJ},
        {"a.PLY", TRIANGLE_PLY, SL_FORMAT_PLY},
        {"a.Off", TRIANGLE_OFF, SL_FORMAT_OFF},
        {"-", TRIANGLE_OBJ, SL_FORMAT_OBJ},
        {"-", TRIANGLE_PLY, SL_FORMAT_PLY},
        {"mesh", TRIANGLE_OFF, SL_FORMAT_OFF},
        {"a.txt", "# c\n  " TRIANGLE_OBJ, SL_FORMAT_OBJ},
        {"a.obj.bak", "# x\nC" TRIANGLE_OFF, SL_FORMAT_OFF},
    };
    for (size_t k = 0; k < SL_COUNTOF(cases); k++) {
        sl_meshfile *file = parse_text(cases[k].name, cases[k].text);
        assert_int_equal(file->format, cases[k].format);
        assert_int_equal(file->nf, 1);
        assert_int_equal(file->index[0], 2);
        assert_true(file->xyz[8] == 8.125);
        sl_meshfile_free(file);
    }
    expect_failure("x.stl", "solid x\nendsolid x\n", 19, SL_UNSUPPORTED, 0, "neither the name nor the content");
    expect_failure("x", "\0\1\2v 1 2 3\n", 11, SL_UNSUPPORTED, 0, "neither the name nor the content");
    expect_failure("x.ply", TRIANGLE_OBJ, 12, SL_BAD_INPUT, 1, "not 'ply'");
    expect_failure("x.obj", "", 0, SL_BAD_INPUT, 0, "empty");
    expect_failure("x", "", 0, SL_BAD_INPUT, 0, "empty");
}

static void missing_files_and_folders_are_io_errors(void **state)
{
    (void)state;
    char path[512];
    sl_meshfile *file = (sl_meshfile *)1;
    sl_diag diag = sl_diag_none();
    snprintf(path, sizeof path, "%s", test_scratch("no such file.obj"));
    assert_int_equal(sl_meshfile_read(path, &file, &diag), SL_IO);
    assert_null(file);
    assert_string_equal(diag.file, path);
    *strrchr(path, '/') = '\0';
    assert_int_equal(sl_meshfile_read(path, &file, &diag), SL_IO);
    sl_meshfile_free(NULL);
}

static void quantised_numbers_are_multiples_and_survive_their_text(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(800);
    for (int trial = 0; trial < 100000 * test_multiplier(); trial++) {
        const double u = test_uniform(&rng, -1, 1) * pow(10.0, test_index(&rng, 8) - 4);
        const double q = sl_uv_quantise(u);
        char text[64];
        assert_true(fabs(q - u) <= 0.5e-12 + 2 * TEST_EPS * fabs(u));
        assert_true(sl_uv_quantise(q) == q);
        if (fabs(u) < 9000) {
            snprintf(text, sizeof text, "%.12f", q); /* twelve decimals say it all */
            assert_true(strtod(text, NULL) == q);
        }
    }
    assert_true(isnan(sl_uv_quantise((double)NAN)));
}

/* OBJ with its richest contents, for the conversions. */
static const char *const rich =
    "mtllib a.mtl\no x\nv 0.1 0.2 0.3 0.2 0.4 1\nv 1e-30 1e30 -7.25\nv 3 4 5 1 0 0.6\nv 7 8 9.5\n"
    "vt 0.5 0.25\nvt 9999.123456789012 1e-17\nvn 0 0 1\nusemtl m\nf 1/1/1 2/2/1 3/1/1 4\n"
    "f 4/2 2/1 1/2\nl 1 2\np 3\nfoo bar\n";

static void conversions_keep_polygons_and_uvs_exactly(void **state)
{
    (void)state;
    static const char *const outs[] = {"out.obj", "out.ply"};
    static const struct {
        const char *name, *text;
    } ins[] = {{"in.obj", rich}, {"in.ply", TRIANGLE_PLY}, {"in.off", TRIANGLE_OFF}};
    test_rng rng = test_rng_seed(801);
    for (size_t i = 0; i < SL_COUNTOF(ins); i++) {
        sl_meshfile *file = parse_text(ins[i].name, ins[i].text);
        for (size_t o = 0; o < SL_COUNTOF(outs); o++) {
            for (int own = 0; own < 2; own++) {
                double *uv = own ? NULL : random_uv(&rng, file);
                int64_t size;
                char *data = write_and_load(outs[o], file, uv, &size);
                sl_meshfile *again = parse_bytes(outs[o], data, size);
                assert_same_polygons(file, again);
                const double *expected = own ? file->corner_uv : uv;
                assert_true((expected != NULL) == (again->corner_uv != NULL));
                if (expected != NULL) {
                    assert_same_doubles(again->corner_uv, expected, 2 * (int64_t)file->face_first[file->nf]);
                }
                assert_true((again->vertex_rgb != NULL) == (file->vertex_rgb != NULL));
                for (int k = 0; file->vertex_rgb != NULL && k < 12;
                     k++) { /* a vertex without a colour is white in PLY */
                    const double c = isnan(file->vertex_rgb[k]) && o == 1 ? 1.0 : file->vertex_rgb[k];
                    assert_true((isnan(c) && isnan(again->vertex_rgb[k])) || test_near(again->vertex_rgb[k], c, 1e-15));
                }
                sl_meshfile_free(again);
                sl_free(data);
                sl_free(uv);
            }
        }
        sl_meshfile_free(file);
    }
}

static void normals_and_colours_of_ply_reach_obj(void **state)
{
    (void)state;
    int64_t size;
    sl_meshfile *file =
        parse_text("n.ply", "ply\nformat ascii 1.0\nelement vertex 3\nproperty double x\nproperty double y\n"
                            "property double z\nproperty double nx\nproperty double ny\nproperty double nz\n"
                            "property float red\nproperty float green\nproperty float blue\nproperty int id\n"
                            "element face 1\nproperty list uchar int vertex_indices\nend_header\n"
                            "1 2 3 0.6 0 0.8 0.5 0.25 0\n7\n4 5 6 1 0 0 0 1 0.125 8\n7 8 10 0 1 0 1 1 1 9\n3 0 2 1\n");
    char *data = write_and_load("n.obj", file, NULL, &size);
    assert_string_equal(data,
                        "v 1 2 3 0.5 0.25 0\nv 4 5 6 0 1 0.125\nv 7 8 10 1 1 1\nvn 0.6 0 0.8\nvn 1 0 0\nvn 0 1 0\n"
                        "f 1//1 3//3 2//2\n");
    sl_free(data);
    char text[200];
    assert_true(sl_meshfile_losses(file, "n.obj", text, sizeof text));
    assert_string_equal(text, "1 extra property");
    sl_meshfile_free(file);
}

static void losses_are_told_and_only_they(void **state)
{
    (void)state;
    char text[300], tiny[9];
    sl_meshfile *file = parse_text("in.obj", rich);
    assert_false(sl_meshfile_losses(file, "out.obj", text, sizeof text));
    assert_string_equal(text, "");
    assert_false(sl_meshfile_losses(file, "-", text, sizeof text));
    assert_true(sl_meshfile_losses(file, "out.ply", text, sizeof text));
    assert_string_equal(text,
                        "3 names and materials, 1 line element, 1 point element, 1 other statement or row, 1 normal");
    assert_true(sl_meshfile_losses(file, "out.ply", tiny, sizeof tiny));
    assert_string_equal(tiny, "3 names ");
    sl_meshfile_free(file);
}

static void what_cannot_hold_uvs_is_refused_before_anything_is_written(void **state)
{
    (void)state;
    static const char *const names[] = {"a.off", "a.stl", "a", "a.obj.gz"};
    char path[512];
    sl_meshfile *file = parse_text("in.obj", TRIANGLE_OBJ);
    for (size_t k = 0; k < SL_COUNTOF(names); k++) {
        sl_diag diag = sl_diag_none();
        snprintf(path, sizeof path, "%s", test_scratch(names[k]));
        assert_false(sl_meshfile_can_hold_uv(path));
        assert_int_equal(sl_meshfile_write(path, file, NULL, &diag), SL_UNSUPPORTED);
        assert_non_null(strstr(diag.hint, ".obj"));
        assert_non_null(strstr(diag.hint, ".ply"));
        assert_null(fopen(path, "r"));
    }
    assert_true(sl_meshfile_can_hold_uv("x.OBJ") && sl_meshfile_can_hold_uv("x.ply") && sl_meshfile_can_hold_uv("-"));
    const double infinite[6] = {0, 0, 0, (double)INFINITY, 0, 0};
    sl_diag diag = sl_diag_none();
    snprintf(path, sizeof path, "%s", test_scratch("a.obj"));
    assert_int_equal(sl_meshfile_write(path, file, infinite, &diag), SL_BAD_INPUT);
    assert_int_equal(diag.element, 1);
    assert_null(fopen(path, "r"));
    snprintf(path, sizeof path, "%s", test_scratch("nowhere/a.obj"));
    assert_int_equal(sl_meshfile_write(path, file, NULL, &diag), SL_IO);
    assert_string_equal(diag.file, path);
    sl_meshfile_free(file);
}

static void coloured_and_valued_faces_are_written_as_ply(void **state)
{
    (void)state;
    enum { COUNT = 300 };
    test_rng rng = test_rng_seed(802);
    for (int large = 0; large < 2; large++) { /* over 255 corners, the length of a list needs more than a byte */
        double xyz[3 * COUNT], a[2], b[2];
        int32_t index[3 + COUNT];
        const int32_t first[] = {0, 3, large ? 3 + COUNT : 7};
        uint8_t rgb[6];
        for (int k = 0; k < 3 * COUNT; k++) {
            xyz[k] = test_uniform(&rng, -4, 4);
        }
        for (int k = 0; k < 3 + COUNT; k++) {
            index[k] = test_index(&rng, COUNT);
        }
        for (int k = 0; k < 6; k++) {
            rgb[k] = (uint8_t)test_bits(&rng);
            (k % 2 == 0 ? a : b)[k / 2 % 2] = test_uniform(&rng, -1, 1);
        }
        const sl_polygons polygons = {COUNT, 2, xyz, first, index};
        const char *const names[] = {"lambda_1", "psi2"};
        const double *const values[] = {a, b};
        char path[512];
        for (int kind = 0; kind < 2; kind++) {
            char *data;
            int64_t size;
            snprintf(path, sizeof path, "%s", test_scratch("export.ply"));
            assert_int_equal(kind == 0 ? sl_ply_write_colored(path, &polygons, rgb, NULL)
                                       : sl_ply_write_values(path, &polygons, 2, names, values, NULL),
                             SL_OK);
            assert_int_equal(sl_file_read(path, &data, &size, NULL), SL_OK);
            sl_meshfile *file = parse_bytes(path, data, size);
            assert_int_equal(file->nv, COUNT);
            assert_memory_equal(file->xyz, xyz, sizeof xyz);
            assert_memory_equal(file->face_first, first, sizeof first);
            assert_memory_equal(file->index, index, (size_t)first[2] * sizeof *index);
            if (kind == 0) { /* the last face's colour ends the file */
                assert_memory_equal(data + size - 3, rgb + 3, 3);
                assert_int_equal(file->extras.properties, 3);
            } else {
                const double last[2] = {a[1], b[1]};
                assert_memory_equal(data + size - 16, last, sizeof last);
                assert_non_null(strstr(data, "property double lambda_1\nproperty double psi2\nend_header\n"));
            }
            sl_meshfile_free(file);
            sl_free(data);
        }
        sl_diag diag = sl_diag_none();
        snprintf(path, sizeof path, "%s", test_scratch("nowhere/export.ply"));
        assert_int_equal(sl_ply_write_colored(path, &polygons, rgb, &diag), SL_IO);
        assert_int_equal(sl_ply_write_values(path, &polygons, 2, names, values, &diag), SL_IO);
    }
}

static void polygons_are_a_view_of_the_file(void **state)
{
    (void)state;
    sl_polygons polygons;
    sl_meshfile *file = parse_text("in.obj", rich);
    sl_meshfile_polygons(file, &polygons);
    assert_true(polygons.nv == 4 && polygons.nf == 2 && polygons.xyz == file->xyz && polygons.index == file->index &&
                polygons.face_first == file->face_first);
    sl_meshfile_free(file);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_format_is_told_by_extension_and_else_by_content),
        cmocka_unit_test(missing_files_and_folders_are_io_errors),
        cmocka_unit_test(quantised_numbers_are_multiples_and_survive_their_text),
        cmocka_unit_test(conversions_keep_polygons_and_uvs_exactly),
        cmocka_unit_test(normals_and_colours_of_ply_reach_obj),
        cmocka_unit_test(losses_are_told_and_only_they),
        cmocka_unit_test(what_cannot_hold_uvs_is_refused_before_anything_is_written),
        cmocka_unit_test(coloured_and_valued_faces_are_written_as_ply),
        cmocka_unit_test(polygons_are_a_view_of_the_file),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
