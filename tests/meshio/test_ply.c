#include "meshio_support.h"

typedef enum encoding { ASCII, LITTLE, BIG, ENCODINGS } encoding;

static const char *const encoding_names[] = {"ascii", "binary_little_endian", "binary_big_endian"};
static const char *const names[] = {"char", "uint8", "int16", "ushort", "int", "uint32", "float", "float64"};

enum { NF = 41, MAX_CORNERS = 9 };

/* A random mesh and the types it is written with; the same numbers in every encoding. */
typedef struct sample {
    int32_t nv, first[NF + 1], index[NF * MAX_CORNERS];
    double xyz[3 * 60], extra[60], uv[2 * NF * MAX_CORNERS];
    int xyz_type, count_type, index_type, extra_type;
} sample;

/* Appends a number of the type names[type]: text, or bytes in either order. */
static void put_value(test_bytes *to, encoding e, int type, double value)
{
    static const int sizes[] = {1, 1, 2, 2, 4, 4, 4, 8};
    unsigned char bytes[8], swapped[8];
    if (e == ASCII) {
        put_text(to, "%.17g ", value);
        return;
    }
    if (type == 7) {
        memcpy(bytes, &value, 8);
    } else if (type == 6) {
        const float single = (float)value;
        memcpy(bytes, &single, 4);
    } else {
        const int64_t whole = (int64_t)value;
        memcpy(bytes, &whole, 8);
    }
    for (int k = 0; k < sizes[type]; k++) {
        swapped[k] = bytes[sizes[type] - 1 - k];
    }
    put_bytes(to, e == BIG ? swapped : bytes, sizes[type]);
}

static sample random_sample(test_rng *rng)
{
    sample s = {.nv = 3 + test_index(rng, 57)};
    s.xyz_type = test_index(rng, 2) != 0 ? 7 : 6;
    s.count_type = test_index(rng, 6);
    s.index_type = test_index(rng, 6);
    s.extra_type = test_index(rng, 6);
    for (int32_t k = 0; k < 3 * s.nv; k++) {
        s.xyz[k] = test_uniform(rng, -50, 50);
        s.xyz[k] = s.xyz_type == 6 ? (double)(float)s.xyz[k] : s.xyz[k];
    }
    for (int32_t v = 0; v < s.nv; v++) {
        s.extra[v] = test_index(rng, 127);
    }
    for (int f = 0; f < NF; f++) {
        s.first[f + 1] = s.first[f] + 3 + test_index(rng, MAX_CORNERS - 2);
    }
    for (int32_t c = 0; c < s.first[NF]; c++) {
        s.index[c] = test_index(rng, s.nv);
        s.uv[2 * c] = sl_uv_quantise(test_uniform(rng, -1, 2));
        s.uv[2 * c + 1] = sl_uv_quantise(test_uniform(rng, -1, 2));
    }
    return s;
}

typedef enum uv_place { NO_UV, VERTEX_UV, FACE_UV, OUR_UV } uv_place;

/* The file of a sample; with OUR_UV it is what the library shall write: UVs at the end of each face, as doubles. */
static test_bytes sample_file(const sample *s, encoding e, uv_place uv)
{
    test_bytes to = {0};
    put_text(&to, "ply\nformat %s 1.0\ncomment made by hand, 1 of 2\n", encoding_names[e]);
    put_text(&to, "element vertex %d\nproperty %s quality\nproperty %s z\nproperty %s x\n", s->nv, names[s->extra_type],
             names[s->xyz_type], names[s->xyz_type]);
    put_text(&to, "%sproperty list uchar %s friends\nproperty %s y\n", uv == VERTEX_UV ? "property double s\n" : "",
             names[s->extra_type], names[s->xyz_type]);
    put_text(&to, "%s", uv == VERTEX_UV ? "property double t\n" : "");
    put_text(&to, "obj_info more\nelement camera 2\nproperty float view\nproperty list int uchar name\n");
    put_text(&to, "element face %d\n%sproperty ushort label\nproperty list %s %s vertex_indices\nproperty uchar red\n",
             NF, uv == FACE_UV ? "property list int float64 texcoord\n" : "", names[s->count_type],
             names[s->index_type]);
    put_text(&to, "%s", uv == OUR_UV ? "property list uchar double texcoord\n" : "");
    put_text(&to, "element last 1\nproperty int end\nend_header\n");
    for (int32_t v = 0; v < s->nv; v++) {
        put_value(&to, e, s->extra_type, s->extra[v]);
        put_value(&to, e, s->xyz_type, s->xyz[3 * v + 2]);
        put_value(&to, e, s->xyz_type, s->xyz[3 * v]);
        if (uv == VERTEX_UV) {
            put_value(&to, e, 7, 0.01 * v);
        }
        put_value(&to, e, 1, v % 3);
        for (int32_t k = 0; k < v % 3; k++) {
            put_value(&to, e, s->extra_type, 100 - k);
        }
        put_value(&to, e, s->xyz_type, s->xyz[3 * v + 1]);
        if (uv == VERTEX_UV) {
            put_value(&to, e, 7, 1.0 - 0.003 * v);
        }
        to.size -= e == ASCII; /* the blank after the last number of a row */
        put_text(&to, "%s", e == ASCII ? "\n" : "");
    }
    for (int k = 0; k < 2; k++) {
        put_value(&to, e, 6, 0.5 + k);
        put_value(&to, e, 4, 2);
        put_value(&to, e, 1, 201);
        put_value(&to, e, 1, 77 + k);
        to.size -= e == ASCII;
        put_text(&to, "%s", e == ASCII ? "\n" : "");
    }
    for (int32_t f = 0; f < NF; f++) {
        const int32_t degree = s->first[f + 1] - s->first[f];
        for (int32_t k = 0; uv == FACE_UV && k <= 2 * degree; k++) {
            put_value(&to, e, k == 0 ? 4 : 7, k == 0 ? 2 * degree : s->uv[2 * s->first[f] + k - 1]);
        }
        put_value(&to, e, 3, 1000 + f);
        put_value(&to, e, s->count_type, degree);
        for (int32_t c = s->first[f]; c < s->first[f + 1]; c++) {
            put_value(&to, e, s->index_type, s->index[c]);
        }
        put_value(&to, e, 1, 200 - f);
        for (int32_t k = 0; uv == OUR_UV && k <= 2 * degree; k++) {
            const double x = k == 0 ? 2 * degree : s->uv[2 * s->first[f] + k - 1];
            if (e == ASCII) { /* twelve decimals at most, no zeros at the end */
                char text[64];
                int n = snprintf(text, sizeof text, "%.12f", x);
                while (text[n - 1] == '0') {
                    n--;
                }
                put_text(&to, "%.*s ", n - (text[n - 1] == '.'), text);
            } else {
                put_value(&to, e, k == 0 ? 1 : 7, x);
            }
        }
        to.size -= e == ASCII;
        put_text(&to, "%s", e == ASCII ? "\n" : "");
    }
    put_value(&to, e, 4, -12345);
    to.size -= e == ASCII;
    put_text(&to, "%s", e == ASCII ? "\n" : "");
    return to;
}

static void assert_is_sample(const sl_meshfile *file, const sample *s)
{
    assert_int_equal(file->nv, s->nv);
    assert_int_equal(file->nf, NF);
    assert_memory_equal(file->face_first, s->first, sizeof s->first);
    assert_memory_equal(file->index, s->index, (size_t)s->first[NF] * sizeof *s->index);
    assert_memory_equal(file->xyz, s->xyz, 3 * (size_t)s->nv * sizeof *s->xyz);
}

static void all_encodings_and_types_give_the_same_mesh(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(600);
    for (int trial = 0; trial < 60 * test_multiplier(); trial++) {
        const sample s = random_sample(&rng);
        for (encoding e = ASCII; e < ENCODINGS; e++) {
            for (uv_place place = NO_UV; place <= FACE_UV; place++) {
                test_bytes bytes = sample_file(&s, e, place);
                sl_meshfile *file = parse_bytes("sample.ply", bytes.data, bytes.size);
                assert_is_sample(file, &s);
                assert_int_equal(file->extras.properties, 4);
                assert_int_equal(file->extras.others, 3);
                if (place == NO_UV) {
                    assert_null(file->corner_uv);
                } else if (place == FACE_UV) {
                    assert_same_doubles(file->corner_uv, s.uv, 2 * s.first[NF]);
                } else {
                    for (int32_t c = 0; c < s.first[NF]; c++) {
                        const double expected[2] = {0.01 * s.index[c], 1.0 - 0.003 * s.index[c]};
                        assert_same_doubles(file->corner_uv + 2 * c, expected, 2);
                    }
                }
                sl_meshfile_free(file);
                sl_free(bytes.data);
            }
        }
    }
}

/* Whatever UVs the input had, the output is byte for byte what a writer of our own, above, makes of the same numbers.
 */
static void rewriting_adds_uvs_and_copies_the_rest_byte_for_byte(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(601);
    for (int trial = 0; trial < 8 * test_multiplier(); trial++) {
        const sample s = random_sample(&rng);
        for (encoding e = ASCII; e < ENCODINGS; e++) {
            test_bytes expected = sample_file(&s, e, OUR_UV);
            for (uv_place place = NO_UV; place <= OUR_UV; place++) {
                int64_t size;
                test_bytes bytes = sample_file(&s, e, place);
                sl_meshfile *file = parse_bytes("sample.ply", bytes.data, bytes.size);
                char *written = write_and_load("with_uv.ply", file, s.uv, &size);
                assert_int_equal(size, expected.size);
                assert_memory_equal(written, expected.data, (size_t)size);
                sl_free(written);
                written = write_and_load("same.ply", file, NULL, &size);
                assert_int_equal(size, bytes.size);
                assert_memory_equal(written, bytes.data, (size_t)size);
                sl_free(written);
                sl_meshfile_free(file);
                sl_free(bytes.data);
            }
            sl_free(expected.data);
        }
    }
}

static void normals_and_colours_of_vertices_are_understood(void **state)
{
    (void)state;
    sl_meshfile *file =
        parse_text("n.ply", "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
                            "property float z\nproperty uchar red\nproperty uchar green\n"
                            "property uchar blue\nproperty float nx\nproperty float ny\n"
                            "property float nz\nelement face 1\nproperty list uchar int vertex_index\n"
                            "end_header\n1 2 3 255 51 0 0.5 0.25 -1\n4 5 6 0 102 153 0 1 0\n"
                            "7 8 10 1 2 3 1 0 0\n3 2 0 1\n");
    static const int32_t corner_normal[] = {2, 0, 1};
    assert_int_equal(file->normals, 3);
    assert_memory_equal(file->corner_normal, corner_normal, sizeof corner_normal);
    assert_true(file->normal[0] == 0.5 && file->normal[2] == -1.0 && file->normal[6] == 1.0);
    assert_true(test_near(file->vertex_rgb[0], 1.0, 1e-15) && test_near(file->vertex_rgb[1], 0.2, 1e-15));
    assert_true(test_near(file->vertex_rgb[5], 0.6, 1e-15));
    assert_int_equal(file->extras.properties, 0);
    sl_meshfile_free(file);
}

static const char *const strip_head = "element vertex 6\nproperty float x\nproperty float y\nproperty float z\n"
                                      "element tristrips 2\nproperty list int int vertex_indices\nend_header\n";
static const double strip_xyz[] = {0.5, 1.5, 2, 3, 4.25, 5, 6, 7, 8.5, 9, 10, 11, 12, 13, 15, 16, 17, 19.5};
static const int32_t strips[] = {10, 0, 1, 2, 3, -1, 2, 1, 4, 4, 5, 3, 5, 4, 3};

static void triangle_strips_become_faces_of_one_orientation(void **state)
{
    (void)state;
    static const int32_t expected[] = {0, 1, 2, 2, 1, 3, 2, 1, 4, 5, 4, 3};
    for (encoding e = ASCII; e < ENCODINGS; e++) {
        test_bytes bytes = {0};
        put_text(&bytes, "ply\nformat %s 1.0\n%s", encoding_names[e], strip_head);
        for (int k = 0; k < 18; k++) {
            put_value(&bytes, e, 6, strip_xyz[k]);
        }
        for (size_t k = 0; k < SL_COUNTOF(strips); k++) {
            put_value(&bytes, e, 4, k == 0 ? 10 : strips[k]);
        }
        sl_meshfile *file = parse_bytes("strips.ply", bytes.data, bytes.size);
        assert_int_equal(file->nf, 4);
        assert_memory_equal(file->index, expected, sizeof expected);
        double uv[24];
        for (int k = 0; k < 24; k++) {
            uv[k] = k < 6 ? (double)NAN : 0.0625 * k;
        }
        int64_t size;
        char *written = write_and_load("faces.ply", file, uv, &size);
        sl_meshfile *again = parse_bytes("faces.ply", written, size);
        assert_same_polygons(file, again);
        assert_same_doubles(again->corner_uv, uv, 24);
        assert_non_null(strstr(written, "element face 4\n"));
        assert_null(strstr(written, "tristrips"));
        sl_meshfile_free(again);
        sl_free(written);
        sl_meshfile_free(file);
        sl_free(bytes.data);
    }
}

static void header_lines_may_end_in_any_way(void **state)
{
    (void)state;
    static const char *const ends[] = {"\n", "\r\n", "\r"};
    static const char *const lines[] = {"ply",
                                        "format binary_little_endian 1.0",
                                        "comment x",
                                        "element face 1",
                                        "property list uchar uchar vertex_indices",
                                        "element vertex 3",
                                        "property uchar x",
                                        "property uchar y",
                                        "property uchar z",
                                        "end_header"};
    /* the first byte of a body may look like a line end: ten corners */
    static const unsigned char body[] = {10, 0, 1, 2, 0, 1, 2, 0, 1, 2, 0, 5, 6, 7, 10, 13, 9, 1, 2, 250};
    for (size_t k = 0; k < SL_COUNTOF(ends); k++) {
        test_bytes bytes = {0};
        for (size_t l = 0; l < SL_COUNTOF(lines); l++) {
            put_text(&bytes, "%s%s", lines[l], ends[k]);
        }
        put_bytes(&bytes, body, sizeof body);
        sl_meshfile *file = parse_bytes("ends.ply", bytes.data, bytes.size);
        assert_int_equal(file->face_first[1], 10);
        assert_true(file->xyz[3] == 10.0 && file->xyz[8] == 250.0);
        sl_meshfile_free(file);
        sl_free(bytes.data);
    }
}

#define VERTICES "element vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
#define FACES "element face 1\nproperty list uchar int vertex_indices\n"
#define HEAD "ply\nformat ascii 1.0\n" VERTICES FACES "end_header\n"

static void every_error_names_its_line(void **state)
{
    (void)state;
    static const struct {
        const char *text;
        int64_t line;
        const char *words;
    } cases[] = {
        {"plx\n", 1, "not 'ply'"},
        {"ply\nformat ascii 1.0\n", 2, "no end_header"},
        {"ply\n" VERTICES FACES "end_header\n", 8, "no format"},
        {"ply\nformat utf8 1.0\n", 2, "format is not"},
        {"ply\nformat ascii 1.0\nelement vertex\n", 3, "a name and a number"},
        {"ply\nformat ascii 1.0\nelement vertex -4\n", 3, "a name and a number"},
        {"ply\nformat ascii 1.0\nelement vertex 99999999999999999999999\n", 3, "a name and a number"},
        {"ply\nformat ascii 1.0\nproperty int x\n", 3, "before any element"},
        {"ply\nformat ascii 1.0\nelement face 1\nproperty list float int a\n", 4, "length of a list"},
        {"ply\nformat ascii 1.0\nelement face 1\nproperty quad x\n", 4, "'quad' is not a type"},
        {"ply\nformat ascii 1.0\nelement face 1\nproperty int\n", 4, "no name"},
        {"ply\nformat ascii 1.0\nelement face 1\nproperty list uchar float vertex_indices\n", 4, "integer type"},
        {"ply\nformat ascii 1.0\nwhatever\n", 3, "not a line of a PLY header"},
        {"ply\nformat ascii 1.0\n" VERTICES VERTICES, 7, "declared twice"},
        {"ply\nformat ascii 1.0\n" VERTICES "end_header\n", 7, "no faces"},
        {"ply\nformat ascii 1.0\n" FACES "end_header\n", 5, "no x, y and z"},
        {HEAD "1 2 3\n4 5 6\n7 8 x\n", 12, "vertex 2: there is no number of the declared type"},
        {HEAD "1 2 3\n4 5 6\n7 8 9\n3 0 1 3\n", 13, "face 0: uses vertex 3, but the file has 3"},
        {HEAD "1 2 3\n4 5 6\n7 8 9\n3 0 1 -1\n", 13, "face 0: uses vertex -1"},
        {HEAD "1 2 3\n4 5 6\n7 8 9\n3 0 1 1.5\n", 13, "no number of the declared type"},
        {HEAD "1 2 3\n4 5 6\n7 8 9\n2 0 1\n", 13, "fewer than 3 corners"},
        {HEAD "1 2 3\n4 5 6\n7 8 9\n300 0 1\n", 13, "no number of the declared type"},
        {HEAD "1 2 3\n4 5 6\n7 8 9\n3 0 1", 13, "ends too early"},
        {HEAD "1 2 3\n4 nan 6\n7 8 9\n3 0 1 2", 11, "vertex 1: a coordinate is not finite"},
        {HEAD, 10, "more than the file holds"},
        {"ply\nformat ascii 1.0\n" VERTICES "element face 0\nproperty list uchar int vertex_indices\nend_header\n"
         "1 2 3\n4 5 6\n7 8 9\n",
         9, "no face"},
    };
    for (size_t k = 0; k < SL_COUNTOF(cases); k++) {
        expect_failure("wrong.ply", cases[k].text, (int64_t)strlen(cases[k].text), SL_BAD_INPUT, cases[k].line,
                       cases[k].words);
    }
    static const char *const uv =
        "ply\nformat ascii 1.0\n" VERTICES FACES "property list uchar float texcoord\nend_header\n"
        "1 2 3\n4 5 6\n7 8 9\n3 0 1 2 4 0 0 1 1\n";
    expect_failure("uv.ply", uv, (int64_t)strlen(uv), SL_BAD_INPUT, 14, "2 numbers a corner");
    static const char *const both = "ply\nformat ascii 1.0\n" VERTICES FACES
                                    "element tristrips 1\nproperty list int int vertex_indices\nend_header\n";
    expect_failure("both.ply", both, (int64_t)strlen(both), SL_UNSUPPORTED, 11, "faces and triangle strips");
}

static void a_binary_file_cut_anywhere_names_a_byte_and_never_a_number_it_promises(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(602);
    const sample s = random_sample(&rng);
    for (encoding e = LITTLE; e <= BIG; e++) {
        test_bytes bytes = sample_file(&s, e, FACE_UV);
        const int64_t header = strstr(bytes.data, "end_header\n") + 11 - bytes.data;
        for (int64_t size = 0; size < bytes.size; size++) {
            sl_meshfile *file;
            sl_diag diag;
            assert_int_equal(sl_meshfile_parse("cut.ply", bytes.data, size, &file, &diag), SL_BAD_INPUT);
            if (size >= header) {
                assert_true(diag.byte >= header && diag.byte <= size && diag.line == 0);
            }
        }
        sl_free(bytes.data);
    }
}

static void rows_promised_by_the_billion_cost_nothing(void **state)
{
    (void)state;
    static const char *const texts[] = {
        "ply\nformat binary_little_endian 1.0\nelement vertex 2147483647\nproperty double x\nproperty double y\n"
        "property double z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\nabcdefgh",
        "ply\nformat binary_big_endian 1.0\nelement nothing 9000000000000000000\nelement vertex 1\nproperty uchar x\n"
        "property uchar y\nproperty uchar z\nelement face 1\nproperty list int uchar vertex_indices\nend_header\n"
        "abc\x7f\xff\xff\xff",
        "ply\nformat binary_big_endian 1.0\nelement vertex 1\nproperty uchar x\nproperty uchar y\nproperty uchar z\n"
        "property list uint double a\nelement face 1\nproperty list int uchar vertex_indices\nend_header\n"
        "abc\xff\xff\xff\xff",
        "ply\nformat binary_big_endian 1.0\nelement vertex 1\nproperty uchar x\nproperty uchar y\nproperty uchar z\n"
        "element face 1\nproperty list uint double texcoord\nproperty list uchar uchar vertex_indices\nend_header\n"
        "abc\xff\xff\xff\xf0",
    };
    for (size_t k = 0; k < SL_COUNTOF(texts); k++) {
        const sl_diag diag = expect_failure("lies.ply", texts[k], (int64_t)strlen(texts[k]), SL_BAD_INPUT, 0, "");
        assert_true(diag.byte > 0);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(all_encodings_and_types_give_the_same_mesh),
        cmocka_unit_test(rewriting_adds_uvs_and_copies_the_rest_byte_for_byte),
        cmocka_unit_test(normals_and_colours_of_vertices_are_understood),
        cmocka_unit_test(triangle_strips_become_faces_of_one_orientation),
        cmocka_unit_test(header_lines_may_end_in_any_way),
        cmocka_unit_test(every_error_names_its_line),
        cmocka_unit_test(a_binary_file_cut_anywhere_names_a_byte_and_never_a_number_it_promises),
        cmocka_unit_test(rows_promised_by_the_billion_cost_nothing),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
