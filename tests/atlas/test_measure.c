#include "atlas/measure.h"
#include "support/test_support.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { GRID = 7, FACETS = GRID * GRID, CORNERS = 4 * FACETS };

/* A bumpy grid of quads over [0, 1]^2 with the UVs of a known linear map, facets of columns >= cut moved aside by 2. */
typedef struct grid {
    double xyz[3 * (GRID + 1) * (GRID + 1)];
    int32_t first[FACETS + 1], index[CORNERS];
    double uv[2 * CORNERS];
    sl_polygons polygons;
} grid;

static void grid_make(grid *g, const double map[4], int32_t cut)
{
    for (int32_t j = 0; j <= GRID; j++) {
        for (int32_t i = 0; i <= GRID; i++) {
            double *x = g->xyz + 3 * (j * (GRID + 1) + i);
            x[0] = 3.0 + (i + 0.2 * (i > 0 && i < GRID) * sin(3.0 * j)) / GRID;
            x[1] = -1.0 + (j + 0.2 * (j > 0 && j < GRID) * cos(2.0 * i)) / GRID;
            x[2] = 0.0;
        }
    }
    for (int32_t f = 0; f < FACETS; f++) {
        const int32_t i = f % GRID, j = f / GRID, v = j * (GRID + 1) + i;
        const int32_t corner[4] = {v, v + 1, v + GRID + 2, v + GRID + 1};
        g->first[f] = 4 * f;
        memcpy(g->index + 4 * f, corner, sizeof corner);
        for (int k = 0; k < 4; k++) {
            const double *x = g->xyz + 3 * corner[k];
            g->uv[2 * (4 * f + k)] = map[0] * x[0] + map[1] * x[1] + (i >= cut ? 2.0 : 0.0);
            g->uv[2 * (4 * f + k) + 1] = map[2] * x[0] + map[3] * x[1];
        }
    }
    g->first[FACETS] = CORNERS;
    g->polygons = (sl_polygons){(GRID + 1) * (GRID + 1), FACETS, g->xyz, g->first, g->index};
}

static sl_atlas_measure measure(const grid *g)
{
    sl_atlas_measure m;
    sl_diag diag = sl_diag_none();
    assert_int_equal(sl_measure_atlas(&g->polygons, g->uv, 512, NULL, &m, &diag), SL_OK);
    return m;
}

static void a_linear_map_has_its_singular_values_everywhere(void **state)
{
    (void)state;
    grid *g = malloc(sizeof *g);
    const double map[] = {1.5, 0.0, 0.0, 0.5};
    grid_make(g, map, GRID);
    const sl_atlas_measure m = measure(g);
    assert_int_equal(m.charts, 1);
    assert_int_equal(m.triangles, 2 * FACETS);
    assert_true(m.seam_length == 0.0 && m.overlap_inside == 0.0 && m.overlap_across == 0.0);
    assert_true(test_near(m.global.angle_mean, 3.0, 1e-9) && test_near(m.global.angle_max, 3.0, 1e-9));
    /* after the scale that makes areas equal: s1 = sqrt 3, s2 = 1 / sqrt 3 */
    assert_true(test_near(m.global.l2, sqrt(0.5 * (3.0 + 1.0 / 3.0)), 1e-9));
    assert_true(test_near(m.global.linf, sqrt(3.0), 1e-9));
    assert_true(test_near(m.chart_l2_worst, m.global.l2, 1e-12));
    assert_true(test_near(m.fill, 1.0 / 3.0, 0.01));
    free(g);
}

static void a_cut_is_a_seam_of_its_own_length(void **state)
{
    (void)state;
    grid *g = malloc(sizeof *g);
    const double map[] = {0.9, 0.3, -0.2, 1.1};
    grid_make(g, map, 3);
    const sl_atlas_measure m = measure(g);
    double length = 0.0;
    for (int32_t j = 0; j < GRID; j++) {
        const double *a = g->xyz + 3 * (j * (GRID + 1) + 3), *b = a + 3 * (GRID + 1);
        length += hypot(a[0] - b[0], a[1] - b[1]);
    }
    assert_int_equal(m.charts, 2);
    assert_true(test_near(m.seam_length, length, 1e-9)); /* the grid's area is 1 */
    assert_true(test_near(m.seam_diagonal, length / sqrt(2.0), 1e-9));
    free(g);
}

static void mirrored_charts_are_not_flipped_but_a_turned_facet_is(void **state)
{
    (void)state;
    grid *g = malloc(sizeof *g);
    const double mirror[] = {-1.0, 0.1, 0.0, 1.0};
    grid_make(g, mirror, GRID);
    assert_int_equal(measure(g).global.flipped, 0);
    const double plain[] = {1.0, 0.1, 0.0, 1.0};
    grid_make(g, plain, GRID);
    const int32_t middle = (GRID / 2) * GRID + GRID / 2; /* its far corner drawn across the opposite one */
    for (int32_t c = 0; c < CORNERS; c++) {
        if (g->index[c] == g->index[4 * middle + 2]) {
            g->uv[2 * c] -= 1.9 / GRID;
            g->uv[2 * c + 1] -= 1.9 / GRID;
        }
    }
    const sl_atlas_measure m = measure(g);
    assert_true(m.global.flipped > 0 && m.overlap_inside > 0.0);
    assert_int_equal(m.charts, 1);
    free(g);
}

static void charts_on_top_of_one_another_overlap_across(void **state)
{
    (void)state;
    grid *g = malloc(sizeof *g);
    const double map[] = {1.0, 0.0, 0.0, 1.0};
    grid_make(g, map, 3);
    for (int32_t f = 0; f < FACETS; f++) { /* the right part slides over the left */
        for (int32_t c = 4 * f; c < 4 * f + 4 && f % GRID >= 3; c++) {
            g->uv[2 * c] -= 2.0 + 0.4 * 1.03;
        }
    }
    const sl_atlas_measure m = measure(g);
    assert_int_equal(m.charts, 2);
    assert_true(m.overlap_across > 0.3 && m.overlap_inside == 0.0);
    assert_true(m.overlap_across < 0.9);
    free(g);
}

static void a_facet_written_the_other_way_round_is_not_a_flip(void **state)
{
    (void)state;
    grid *g = malloc(sizeof *g);
    const double map[] = {1.0, 0.2, 0.1, 1.0};
    grid_make(g, map, GRID);
    for (int k = 0; k < 2; k++) { /* facet 9: corners reversed with their UVs */
        const int32_t a = 36 + k, b = 39 - k, kept = g->index[a];
        g->index[a] = g->index[b];
        g->index[b] = kept;
        for (int i = 0; i < 2; i++) {
            const double uv = g->uv[2 * a + i];
            g->uv[2 * a + i] = g->uv[2 * b + i];
            g->uv[2 * b + i] = uv;
        }
    }
    assert_int_equal(measure(g).global.flipped, 0);
    free(g);
}

static void a_missing_uv_is_named(void **state)
{
    (void)state;
    grid *g = malloc(sizeof *g);
    const double map[] = {1.0, 0.2, 0.1, 1.0};
    sl_atlas_measure m;
    sl_diag diag = sl_diag_none();
    grid_make(g, map, GRID);
    g->uv[2 * 4 * 5 + 1] = NAN;
    assert_int_equal(sl_measure_atlas(&g->polygons, g->uv, 64, NULL, &m, &diag), SL_BAD_INPUT);
    assert_int_equal(diag.element, 5);
    free(g);
}

/* A chevron whose fan from the first corner turns over: laid flat as it is, nothing is flipped. */
static void a_concave_facet_is_not_a_flip(void **state)
{
    (void)state;
    const double xyz[] = {2.1, 1.0, 0, 0, 2.0, 0, 0.7, 1.05, 0, 0.1, 0, 0};
    const int32_t first[] = {0, 4};
    for (int32_t turn = 0; turn < 4; turn++) {
        int32_t index[4];
        double uv[8];
        for (int k = 0; k < 4; k++) {
            index[k] = (k + turn) % 4;
            uv[2 * k] = 0.3 * xyz[3 * index[k]];
            uv[2 * k + 1] = 0.3 * xyz[3 * index[k] + 1];
        }
        const sl_polygons polygons = {4, 1, xyz, first, index};
        sl_atlas_measure m;
        assert_int_equal(sl_measure_atlas(&polygons, uv, 256, NULL, &m, NULL), SL_OK);
        assert_true(m.global.flipped == 0 && m.overlap_inside == 0.0 && test_near(m.chart_l2_worst, 1.0, 1e-9));
    }
}

static void a_mesh_of_one_point_has_no_seams(void **state)
{
    (void)state;
    const double xyz[] = {1, 2, 3, 1, 2, 3, 1, 2, 3}, uv[] = {0.1, 0.1, 0.2, 0.1, 0.1, 0.3};
    const int32_t first[] = {0, 3}, index[] = {0, 1, 2};
    const sl_polygons polygons = {3, 1, xyz, first, index};
    sl_atlas_measure m;
    assert_int_equal(sl_measure_atlas(&polygons, uv, 256, NULL, &m, NULL), SL_OK);
    assert_true(m.seam_diagonal == 0.0 && m.seam_length == 0.0);
}

/* Facets that the builder isolates, with UVs of their own far away: the atlas is what it was without them. */
static void duplicate_and_degenerate_facets_stand_apart(void **state)
{
    (void)state;
    enum { EXTRA = 4, ALL = FACETS + EXTRA };
    grid *g = malloc(sizeof *g);
    const double map[] = {0.9, 0.3, -0.2, 1.1};
    grid_make(g, map, 3);
    const sl_atlas_measure without = measure(g);
    int32_t first[ALL + 1], *index = malloc((CORNERS + 3 * EXTRA + 2) * sizeof *index);
    double *uv = malloc(2 * (CORNERS + 3 * EXTRA + 2) * sizeof *uv);
    memcpy(first, g->first, sizeof g->first);
    memcpy(index, g->index, sizeof g->index);
    memcpy(uv, g->uv, sizeof g->uv);
    int32_t corners = CORNERS;
    test_rng rng = test_rng_seed(0xd0b1);
    for (int32_t k = 0; k < EXTRA; k++) { /* two copies of quads, the second with its corners turned; two slivers */
        const int32_t copied = 11 + 17 * k, n = k < 2 ? 4 : 3, v = 3 * k;
        const int32_t sliver[3] = {v, v + GRID + 1, v};
        for (int32_t c = 0; c < n; c++) {
            index[corners] = k < 2 ? g->index[4 * copied + (c + k) % 4] : sliver[c];
            uv[2 * corners] = test_uniform(&rng, 0.2, 0.4);
            uv[2 * corners + 1] = test_uniform(&rng, 0.2, 0.4);
            corners++;
        }
        first[FACETS + k + 1] = corners;
    }
    const sl_polygons polygons = {g->polygons.nv, ALL, g->xyz, first, index};
    sl_atlas_measure with;
    assert_int_equal(sl_measure_atlas(&polygons, uv, 512, NULL, &with, NULL), SL_OK);
    assert_int_equal(without.duplicate_facets + without.degenerate_facets, 0);
    assert_int_equal(with.duplicate_facets, 2);
    assert_int_equal(with.degenerate_facets, 2);
    assert_int_equal(with.charts, without.charts);
    assert_int_equal(with.charts10, without.charts10);
    assert_true(test_near(with.seam_length, without.seam_length, 1e-12));
    assert_true(test_near(with.chart_l2_worst, without.chart_l2_worst, 1e-12));
    assert_int_equal(with.worst_chart, without.worst_chart);
    assert_int_equal(with.triangles, without.triangles + 2 * 2 + 2);
    free(index);
    free(uv);
    free(g);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_linear_map_has_its_singular_values_everywhere),
        cmocka_unit_test(a_cut_is_a_seam_of_its_own_length),
        cmocka_unit_test(mirrored_charts_are_not_flipped_but_a_turned_facet_is),
        cmocka_unit_test(charts_on_top_of_one_another_overlap_across),
        cmocka_unit_test(a_facet_written_the_other_way_round_is_not_a_flip),
        cmocka_unit_test(a_concave_facet_is_not_a_flip),
        cmocka_unit_test(a_mesh_of_one_point_has_no_seams),
        cmocka_unit_test(a_missing_uv_is_named),
        cmocka_unit_test(duplicate_and_degenerate_facets_stand_apart),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
