#include "render_support.h"

#include "render/normals.h"

static double length(const float *n)
{
    return sqrt((double)(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]));
}

static void a_cube_keeps_its_facets_normals_until_the_crease_angle_passes_ninety(void **state)
{
    (void)state;
    sl_mesh *mesh = cube();
    float normal[72];
    assert_int_equal(sl_corner_normals(mesh, 40.0, normal), SL_OK);
    for (int32_t h = 0; h < 24; h++) {
        double n[3];
        sl_mesh_face_vector_area(mesh, mesh->face[h], n);
        const double size = sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
        for (int k = 0; k < 3; k++) {
            assert_true(test_near((double)normal[3 * h + k], n[k] / size, 1e-6));
        }
    }
    assert_int_equal(sl_corner_normals(mesh, 91.0, normal), SL_OK);
    for (int32_t h = 0; h < 24; h++) {
        const double *p = mesh->xyz + 3 * mesh->origin[h];
        for (int k = 0; k < 3; k++) { /* along the cube's diagonal */
            assert_true(test_near((double)normal[3 * h + k], (p[k] > 0.0 ? 1.0 : -1.0) / sqrt(3.0), 1e-6));
        }
    }
    sl_mesh_free(mesh);
}

static void cutting_an_edge_does_not_change_the_light(void **state)
{
    (void)state;
    sl_mesh *mesh = torus(14, 11);
    float *before = sl_alloc(mesh->nh, 3 * sizeof *before), *after = sl_alloc(mesh->nh, 3 * sizeof *after);
    assert_true(before != NULL && after != NULL);
    assert_int_equal(sl_corner_normals(mesh, 60.0, before), SL_OK);
    for (int32_t h = 0; h < mesh->nh; h += 7) {
        sl_mesh_cut_edge(mesh, h);
    }
    assert_int_equal(sl_corner_normals(mesh, 60.0, after), SL_OK);
    for (int64_t i = 0; i < 3 * (int64_t)mesh->nh; i++) {
        assert_true(test_near((double)before[i], (double)after[i], 1e-6));
    }
    sl_free(before);
    sl_free(after);
    sl_mesh_free(mesh);
}

/* Oracle: the angle-weighted sum over all corners at the vertex, by brute force. */
static void smooth_normals_are_the_angle_weighted_mean(void **state)
{
    (void)state;
    sl_mesh *mesh = torus(16, 9);
    float *normal = sl_alloc(mesh->nh, 3 * sizeof *normal);
    assert_non_null(normal);
    assert_int_equal(sl_corner_normals(mesh, 180.0, normal), SL_OK);
    for (int32_t h = 0; h < mesh->nh; h += 5) {
        double sum[3] = {0, 0, 0};
        for (int32_t g = 0; g < mesh->nh; g++) {
            if (mesh->origin[g] != mesh->origin[h]) {
                continue;
            }
            const double *o = mesh->xyz + 3 * mesh->origin[g], *a = mesh->xyz + 3 * sl_target(mesh, g);
            const double *b = mesh->xyz + 3 * mesh->origin[sl_prev(mesh, g)];
            double dot = 0, aa = 0, bb = 0, n[3];
            for (int k = 0; k < 3; k++) {
                dot += (a[k] - o[k]) * (b[k] - o[k]);
                aa += (a[k] - o[k]) * (a[k] - o[k]);
                bb += (b[k] - o[k]) * (b[k] - o[k]);
            }
            sl_mesh_face_vector_area(mesh, mesh->face[g], n);
            const double size = sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
            for (int k = 0; k < 3; k++) {
                sum[k] += acos(dot / sqrt(aa * bb)) * n[k] / size;
            }
        }
        const double size = sqrt(sum[0] * sum[0] + sum[1] * sum[1] + sum[2] * sum[2]);
        for (int k = 0; k < 3; k++) {
            assert_true(test_near((double)normal[3 * h + k], sum[k] / size, 1e-5));
        }
    }
    sl_free(normal);
    sl_mesh_free(mesh);
}

static void facets_without_area_get_normals_that_are_numbers(void **state)
{
    (void)state;
    const double xyz[15] = {0, 0, 0, 1, 0, 0.2, 0.3, 1, 0, 0.5, 0.5, 0.1, 0.5, 0.5, 0.1};
    const int32_t first[4] = {0, 3, 6, 9}, index[9] = {0, 1, 2, 0, 0, 1, 3, 4, 2};
    const sl_polygons polygons = {5, 3, xyz, first, index};
    sl_mesh *mesh = NULL;
    float normal[27];
    assert_int_equal(sl_mesh_build(&polygons, &mesh, NULL, NULL), SL_OK);
    assert_int_equal(sl_corner_normals(mesh, 40.0, normal), SL_OK);
    for (int32_t h = 0; h < mesh->nh; h++) {
        const double size = length(normal + 3 * h);
        assert_true(test_near(size, size < 0.5 ? 0.0 : 1.0, 1e-6));
    }
    sl_mesh_free(mesh);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_cube_keeps_its_facets_normals_until_the_crease_angle_passes_ninety),
        cmocka_unit_test(cutting_an_edge_does_not_change_the_light),
        cmocka_unit_test(smooth_normals_are_the_angle_weighted_mean),
        cmocka_unit_test(facets_without_area_get_normals_that_are_numbers),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
