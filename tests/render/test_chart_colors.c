#include "render_support.h"

#include "image/color.h"
#include "render/chart_colors.h"

/* Charts grown from random seeds: neighbours across an edge look different, a chart has one colour. */
static void neighbouring_charts_differ_clearly(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0xc01);
    sl_mesh *mesh = torus(60, 40);
    int32_t *chart = sl_alloc(mesh->nf, sizeof *chart);
    uint8_t *rgb = sl_alloc(mesh->nf, 3);
    assert_true(chart != NULL && rgb != NULL);
    for (int trial = 0; trial < 20; trial++) {
        const int32_t charts = 2 + test_index(&rng, 60);
        double seed[60 + 2][2];
        for (int c = 0; c < charts; c++) {
            seed[c][0] = test_uniform(&rng, 0, 60);
            seed[c][1] = test_uniform(&rng, 0, 40);
        }
        for (int32_t f = 0; f < mesh->nf; f++) {
            double best = 1e9;
            for (int c = 0; c < charts; c++) {
                const double d = hypot(f % 60 - seed[c][0], f / 60 - seed[c][1]);
                chart[f] = d < best ? c : chart[f];
                best = fmin(best, d);
            }
        }
        assert_int_equal(sl_chart_colors(mesh, chart, rgb), SL_OK);
        for (int32_t h = 0; h < mesh->nh; h++) {
            const int32_t f = mesh->face[h], g = mesh->face[mesh->twin[h]];
            const double distance = sl_color_distance(rgb + 3 * f, rgb + 3 * g);
            assert_true(chart[f] == chart[g] ? distance == 0.0 : distance > 0.04);
        }
    }
    sl_free(chart);
    sl_free(rgb);
    sl_mesh_free(mesh);
}

static void few_charts_all_have_their_own_color(void **state)
{
    (void)state;
    sl_mesh *mesh = cube();
    const int32_t chart[6] = {5, 0, 3, 9, -1, 2};
    uint8_t rgb[18];
    assert_int_equal(sl_chart_colors(mesh, chart, rgb), SL_OK);
    for (int i = 0; i < 6; i++) {
        for (int j = 0; j < i; j++) {
            assert_true(sl_color_distance(rgb + 3 * i, rgb + 3 * j) > 0.04);
        }
    }
    assert_true(abs(rgb[12] - rgb[13]) < 8 && abs(rgb[13] - rgb[14]) < 8); /* no chart: grey */
    sl_mesh_free(mesh);
}

static void chart_numbers_out_of_range_are_refused(void **state)
{
    (void)state;
    sl_mesh *mesh = cube();
    int32_t chart[6] = {0, 1, 2, -2, 4, 5};
    uint8_t rgb[18];
    assert_int_equal(sl_chart_colors(mesh, chart, rgb), SL_BAD_INPUT);
    chart[3] = INT32_MAX;
    assert_int_equal(sl_chart_colors(mesh, chart, rgb), SL_BAD_INPUT);
    sl_mesh_free(mesh);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(neighbouring_charts_differ_clearly),
        cmocka_unit_test(few_charts_all_have_their_own_color),
        cmocka_unit_test(chart_numbers_out_of_range_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
