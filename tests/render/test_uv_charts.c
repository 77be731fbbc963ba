#include "render/render_support.h"

#include "render/uv_charts.h"

static void each_side_of_a_cube_laid_apart_is_a_chart(void **state)
{
    (void)state;
    sl_mesh *mesh = cube();
    double uv[48];
    int32_t chart[6], count = 0;
    cube_uv(mesh, uv);
    assert_int_equal(sl_uv_charts(mesh, uv, chart, &count), SL_OK);
    assert_int_equal(count, 6);
    for (int f = 0; f < 6; f++) {
        assert_int_equal(chart[f], f);
    }
    sl_mesh_free(mesh);
}

/* UVs that are a function of the vertex join everything; moved facets are islands, found again by their movement. */
static void facets_moved_apart_are_charts_of_those_that_moved_alike(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0xc4a2);
    for (int trial = 0; trial < 30 * test_multiplier(); trial++) {
        sl_mesh *mesh = torus(12, 9);
        double *uv = sl_alloc(mesh->nh, 2 * sizeof *uv);
        int32_t *chart = sl_alloc(mesh->nf, sizeof *chart), count = 0;
        const int32_t bands = 1 + test_index(&rng, 5);
        assert_true(uv != NULL && chart != NULL);
        for (int32_t h = 0; h < mesh->nh; h++) {
            uv[2 * h] = 0.1 * mesh->xyz[3 * mesh->origin[h]] + mesh->face[h] * bands / mesh->nf;
            uv[2 * h + 1] = 0.1 * mesh->xyz[3 * mesh->origin[h] + 1];
        }
        assert_int_equal(sl_uv_charts(mesh, uv, chart, &count), SL_OK);
        assert_int_equal(count, bands);
        for (int32_t f = 0; f < mesh->nf; f++) {
            assert_int_equal(chart[f], f * bands / mesh->nf);
        }
        sl_free(uv);
        sl_free(chart);
        sl_mesh_free(mesh);
    }
}

static void facets_without_uv_are_in_no_chart(void **state)
{
    (void)state;
    sl_mesh *mesh = cube();
    double uv[48];
    int32_t chart[6], count = 0;
    cube_uv(mesh, uv);
    uv[2 * mesh->face_first[2] + 3] = (double)NAN;
    uv[2 * mesh->face_first[4]] = INFINITY;
    assert_int_equal(sl_uv_charts(mesh, uv, chart, &count), SL_OK);
    assert_int_equal(count, 4);
    static const int32_t expected[6] = {0, 1, -1, 2, -1, 3};
    assert_memory_equal(chart, expected, sizeof expected);
    sl_mesh_free(mesh);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(each_side_of_a_cube_laid_apart_is_a_chart),
        cmocka_unit_test(facets_moved_apart_are_charts_of_those_that_moved_alike),
        cmocka_unit_test(facets_without_uv_are_in_no_chart),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
