#include "atlas/seams.h"
#include "base/memory.h"
#include "mesh/build.h"
#include "mesh/topology.h"
#include "support/test_support.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

/* A strip of four quads: vertices 2 i and 2 i + 1 at x = i. */
static const double strip_xyz[] = {0, 0, 0,   0, 1, 0.1, 1, 0,   0.2, 1, 1.1, 0, 2.1, 0, 0,
                                   2, 1, 0.3, 3, 0, 0.1, 3, 0.9, 0,   4, 0,   0, 4,   1, 0.2};
static const int32_t strip_first[] = {0, 4, 8, 12, 16};
static const int32_t strip_index[] = {0, 2, 3, 1, 2, 4, 5, 3, 4, 6, 7, 5, 6, 8, 9, 7};

static sl_mesh *strip(void)
{
    const sl_polygons polygons = {10, 4, strip_xyz, strip_first, strip_index};
    sl_mesh *mesh = NULL;
    assert_int_equal(sl_mesh_build(&polygons, &mesh, NULL, NULL), SL_OK);
    return mesh;
}

static int32_t component_count(const sl_mesh *mesh)
{
    int32_t label[4], count = 0;
    assert_int_equal(sl_mesh_components(mesh, label, &count), SL_OK);
    return count;
}

static void edges_by_their_vertices_are_cut(void **state)
{
    (void)state;
    sl_mesh *mesh = strip();
    const int32_t edge[] = {5, 4, 6, 7};
    const sl_seam_input input = {.edge_count = 2, .edge = edge};
    assert_int_equal(sl_seams_cut(mesh, SL_SEAMS_EDGES, &input, NULL), SL_OK);
    assert_int_equal(component_count(mesh), 3);
    sl_mesh_free(mesh);
}

static void an_edge_that_does_not_exist_is_named(void **state)
{
    (void)state;
    sl_mesh *mesh = strip();
    const int32_t edge[] = {2, 3, 0, 9};
    const sl_seam_input input = {.edge_count = 2, .edge = edge};
    sl_diag diag = sl_diag_none();
    assert_int_equal(sl_seams_cut(mesh, SL_SEAMS_EDGES, &input, &diag), SL_BAD_INPUT);
    assert_int_equal(diag.element, 1);
    sl_mesh_free(mesh);
}

static void labels_cut_where_they_differ(void **state)
{
    (void)state;
    sl_mesh *mesh = strip();
    const int32_t label[] = {7, 7, -2, 7};
    const sl_seam_input input = {.label = label};
    assert_int_equal(sl_seams_cut(mesh, SL_SEAMS_LABELS, &input, NULL), SL_OK);
    assert_int_equal(component_count(mesh), 3);
    sl_mesh_free(mesh);
}

static void kept_uv_seams_are_where_the_two_sides_differ(void **state)
{
    (void)state;
    sl_mesh *mesh = strip();
    double uv[32];
    for (int c = 0; c < 16; c++) {
        const double *x = strip_xyz + 3 * strip_index[c];
        uv[2 * c] = 0.1 * x[0] + (c >= 12 ? 0.5 : 0.0);
        uv[2 * c + 1] = 0.1 * x[1];
    }
    sl_seam_input input = {.corner_uv = uv};
    assert_int_equal(sl_seams_cut(mesh, SL_SEAMS_KEEP_UV, &input, NULL), SL_OK);
    assert_int_equal(component_count(mesh), 2);
    uv[9] = NAN;
    sl_diag diag = sl_diag_none();
    assert_int_equal(sl_seams_cut(mesh, SL_SEAMS_KEEP_UV, &input, &diag), SL_BAD_INPUT);
    assert_non_null(strstr(diag.reason, "facet 2"));
    sl_mesh_free(mesh);
}

static const char *file_of(const char *text)
{
    const char *path = test_scratch("lines.csv");
    FILE *f = fopen(path, "wb");
    assert_non_null(f);
    fputs(text, f);
    fclose(f);
    return path;
}

static void edge_files_allow_headers_comments_and_commas(void **state)
{
    (void)state;
    int32_t *edge = NULL, count = 0;
    const char *path = file_of("vertex,vertex\n3,5\r\n\n# none here\n 12 7 # trailing\n0\t1");
    assert_int_equal(sl_seams_read_edges(path, &edge, &count, NULL), SL_OK);
    const int32_t expected[] = {3, 5, 12, 7, 0, 1};
    assert_int_equal(count, 3);
    assert_memory_equal(edge, expected, sizeof expected);
    sl_free(edge);
}

static void broken_edge_files_name_their_line(void **state)
{
    (void)state;
    static const char *const texts[] = {"1 2\n3\n", "1 2\n3 4 5\n", "1 2\n3 x\n", "1 2\n-1 4\n",
                                        "1 2\n99999999999 4\n"};
    for (size_t k = 0; k < SL_COUNTOF(texts); k++) {
        int32_t *edge = NULL, count = 0;
        sl_diag diag = sl_diag_none();
        assert_int_equal(sl_seams_read_edges(file_of(texts[k]), &edge, &count, &diag), SL_BAD_INPUT);
        assert_int_equal(diag.line, 2);
        assert_null(edge);
    }
    int32_t *edge = NULL, count = 0;
    assert_int_equal(sl_seams_read_edges("/nowhere/at/all", &edge, &count, NULL), SL_IO);
}

static void label_files_hold_one_label_a_facet(void **state)
{
    (void)state;
    int32_t *label = NULL;
    const int32_t expected[] = {4, 4, -1};
    assert_int_equal(sl_seams_read_labels(file_of("facet,chart\n0,4\n1,4\n2,-1\n"), 3, &label, NULL), SL_OK);
    assert_memory_equal(label, expected, sizeof expected);
    sl_free(label);
    assert_int_equal(sl_seams_read_labels(file_of("4\n4\n-1\n"), 3, &label, NULL), SL_OK);
    assert_memory_equal(label, expected, sizeof expected);
    sl_free(label);
    static const char *const broken[] = {"4\n4\n", "4\n4\n4\n4\n", "0,1\n2,1\n1,1\n", "1 2 3\n", "4\n5000000000\n1\n"};
    for (size_t k = 0; k < SL_COUNTOF(broken); k++) {
        label = NULL;
        assert_int_equal(sl_seams_read_labels(file_of(broken[k]), 3, &label, NULL), SL_BAD_INPUT);
        assert_null(label);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(edges_by_their_vertices_are_cut),
        cmocka_unit_test(an_edge_that_does_not_exist_is_named),
        cmocka_unit_test(labels_cut_where_they_differ),
        cmocka_unit_test(kept_uv_seams_are_where_the_two_sides_differ),
        cmocka_unit_test(edge_files_allow_headers_comments_and_commas),
        cmocka_unit_test(broken_edge_files_name_their_line),
        cmocka_unit_test(label_files_hold_one_label_a_facet),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
