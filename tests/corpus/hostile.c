/* Meshes made to break the pipeline, unwrapped in memory. Whatever comes in, what goes out is an atlas that passes
 * its own check and is judged well by `measure`, or a status that says why there is none. */
#include "atlas/atlas.h"
#include "atlas/measure.h"
#include "base/memory.h"
#include "support/test_support.h"

#include <cblas.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { MAX_VERTICES = 20000, MAX_FACES = 20000, MAX_CORNERS = 80000 };

typedef struct soup {
    int32_t nv, nf;
    double xyz[3 * MAX_VERTICES];
    int32_t first[MAX_FACES + 1], index[MAX_CORNERS];
} soup;

static soup *soup_new(void)
{
    return calloc(1, sizeof(soup));
}

static int32_t put_vertex(soup *s, double x, double y, double z)
{
    const double p[3] = {x, y, z};
    memcpy(s->xyz + 3 * s->nv, p, sizeof p);
    return s->nv++;
}

static void put_face(soup *s, int32_t n, const int32_t *corner)
{
    memcpy(s->index + s->first[s->nf], corner, (size_t)n * sizeof *corner);
    s->first[s->nf + 1] = s->first[s->nf] + n;
    s->nf++;
}

/* Quads over nu x nv cells of shape(u, v), u closed on itself when `ring`. */
static void put_grid(soup *s, int32_t nu, int32_t nv, bool ring, bool flip, void (*shape)(double, double, double *))
{
    const int32_t start = s->nv, columns = ring ? nu : nu + 1;
    for (int32_t i = 0; i < columns; i++) {
        for (int32_t j = 0; j <= nv; j++) {
            double p[3];
            shape((double)i / nu, (double)j / nv, p);
            put_vertex(s, p[0], p[1], p[2]);
        }
    }
    for (int32_t i = 0; i < nu; i++) {
        for (int32_t j = 0; j < nv; j++) {
            const bool seam = ring && i + 1 == nu;
            const int32_t a = start + i * (nv + 1) + j, next = start + (seam ? 0 : i + 1) * (nv + 1);
            const int32_t b = next + (seam && flip ? nv - j : j), c = next + (seam && flip ? nv - j - 1 : j + 1);
            const int32_t quad[4] = {a, b, c, a + 1};
            put_face(s, 4, quad);
        }
    }
}

/* Slivers of bent facets may turn over when a texel count rounds them to 1/256 texel: a texel or two is no overlap
 * where the exact certificate holds. */
static const double sliver_texels = 2e-6;

/* Which facets share texels on purpose, as the sidecar says it. Owned by the caller. */
static sl_sharing_table sharing_of(const sl_atlas *atlas)
{
    const sl_segmentation *seg = atlas->segmentation;
    sl_sharing_table table = {.nf = atlas->mesh->nf, .nchart = seg->nchart};
    table.face_chart = sl_copy(seg->face_chart, table.nf, sizeof *table.face_chart);
    table.copy_of = sl_alloc(table.nchart, sizeof *table.copy_of);
    assert_true(table.face_chart != NULL && table.copy_of != NULL);
    for (int32_t c = 0; c < table.nchart; c++) {
        table.copy_of[c] = seg->chart[c].copy_of;
    }
    return table;
}

/* Unwraps and checks; gives the number of charts and the worst stretch. */
static int32_t unwrap_as(const soup *s, sl_symmetry_use symmetry, double *worst)
{
    const sl_polygons polygons = {s->nv, s->nf, s->xyz, s->first, s->index};
    sl_atlas_def def = sl_atlas_default();
    sl_diag diag = sl_diag_none();
    sl_atlas *atlas = NULL;
    sl_atlas_measure m;
    def.segment.symmetry = symmetry;
    assert_int_equal(sl_unwrap(&polygons, &def, NULL, &atlas, &diag), SL_OK);
    assert_true(atlas->check.passed);
    sl_sharing_table table = sharing_of(atlas);
    assert_int_equal(sl_measure_shared(&polygons, atlas->input_corner_uv,
                                       symmetry == SL_SYMMETRY_USE_OFF ? NULL : &table, 2048, NULL, &m, &diag),
                     SL_OK);
    assert_int_equal(m.global.flipped, 0);
    assert_true(m.overlap_inside <= sliver_texels && m.overlap_across == 0.0);
    assert_true(isfinite(m.seam_diagonal) && isfinite(sl_atlas_seam_diagonals(atlas->mesh)));
    for (int32_t h = 0; h < 2 * atlas->mesh->nh; h++) {
        assert_true(atlas->input_corner_uv[h] >= 0.0 && atlas->input_corner_uv[h] <= 1.0);
    }
    const int32_t charts = atlas->segmentation->nchart;
    *worst = m.chart_l2_worst;
    sl_sharing_table_clear(&table);
    sl_atlas_free(atlas);
    return charts;
}

/* With what symmetry allows, and without: charts and worst stretch are the latter's. Frees s. */
static int32_t unwrap_well(soup *s, int32_t expected_charts, double *worst)
{
    double stretch;
    unwrap_as(s, SL_SYMMETRY_USE_AUTO, &stretch);
    const int32_t charts = unwrap_as(s, SL_SYMMETRY_USE_OFF, &stretch);
    if (expected_charts > 0) {
        assert_int_equal(charts, expected_charts);
    }
    if (worst != NULL) {
        *worst = stretch;
    }
    free(s);
    return charts;
}

static void annulus(double u, double v, double *p)
{
    const double x = (1.0 + v) * cos(2.0 * TEST_PI * u), y = (1.0 + v) * sin(2.0 * TEST_PI * u);
    p[0] = 0.8 * x - 0.36 * y + 3.0; /* on a plane askew: nothing is exact */
    p[1] = 0.6 * x + 0.48 * y - 2.0;
    p[2] = 0.8 * y + 0.3;
}

static void a_flat_ring_is_one_flat_chart(void **state)
{
    (void)state;
    double worst;
    soup *s = soup_new();
    put_grid(s, 64, 4, true, false, annulus);
    unwrap_well(s, 1, &worst);
    assert_true(worst < 1.0 + 1e-6);
}

/* A plate of 50 x 50 quads with 144 holes on the same plane. */
static void a_flat_plate_with_many_holes_is_one_flat_chart(void **state)
{
    (void)state;
    enum { N = 50 };
    double worst;
    soup *s = soup_new();
    for (int32_t i = 0; i <= N; i++) {
        for (int32_t j = 0; j <= N; j++) {
            put_vertex(s, 0.8 * i - 0.36 * j, 0.6 * i + 0.48 * j, 0.8 * j);
        }
    }
    for (int32_t i = 0; i < N; i++) {
        for (int32_t j = 0; j < N; j++) {
            const int32_t a = i * (N + 1) + j, quad[4] = {a, a + N + 1, a + N + 2, a + 1};
            if (i % 4 != 2 || j % 4 != 2) {
                put_face(s, 4, quad);
            }
        }
    }
    unwrap_well(s, 1, &worst);
    assert_true(worst < 1.0 + 1e-6);
}

static void folded(double u, double v, double *p)
{
    p[0] = fabs(fmod(3.0 * u, 2.0) - 1.0);
    p[1] = v;
    p[2] = 0.0;
}

static void a_plane_folded_on_itself_does_not_overlap(void **state)
{
    (void)state;
    soup *s = soup_new();
    put_grid(s, 30, 10, false, false, folded);
    unwrap_well(s, 0, NULL);
}

static void three_turns(double u, double v, double *p)
{
    p[0] = (1.0 + v) * cos(6.0 * TEST_PI * u);
    p[1] = (1.0 + v) * sin(6.0 * TEST_PI * u);
    p[2] = 0.0;
}

static void a_plane_covered_three_times_does_not_overlap(void **state)
{
    (void)state;
    soup *s = soup_new();
    put_grid(s, 120, 4, false, false, three_turns);
    unwrap_well(s, 0, NULL);
}

static void graded(double u, double v, double *p)
{
    const double r = pow(10.0, -12.0 * u);
    p[0] = r * cos(v);
    p[1] = r * sin(v);
    p[2] = r;
}

static void facets_smaller_than_the_quantum_keep_their_digits(void **state)
{
    (void)state;
    soup *s = soup_new();
    put_grid(s, 100, 20, false, false, graded);
    unwrap_well(s, 0, NULL);
}

static void strip(double u, double v, double *p)
{
    p[0] = 4000.0 * u;
    p[1] = v;
    p[2] = 0.3 * sin(40.0 * u);
}

static void a_strip_4000_times_as_long_as_wide_is_laid_flat(void **state)
{
    (void)state;
    soup *s = soup_new();
    put_grid(s, 4000, 1, false, false, strip);
    unwrap_well(s, 0, NULL);
}

static void moebius(double u, double v, double *p)
{
    const double r = 1.0 + 0.6 * (v - 0.5) * cos(TEST_PI * u);
    p[0] = r * cos(2.0 * TEST_PI * u);
    p[1] = r * sin(2.0 * TEST_PI * u);
    p[2] = 0.6 * (v - 0.5) * sin(TEST_PI * u);
}

static void a_one_sided_band_is_cut(void **state)
{
    (void)state;
    soup *s = soup_new();
    put_grid(s, 60, 6, true, true, moebius);
    unwrap_well(s, 0, NULL);
}

/* Polygons of 3 to 7 random corners, some repeated: non-manifold, self-crossing, bent. */
static void random_polygons_end_in_a_valid_atlas(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0xbad5eed);
    for (int trial = 0; trial < 6; trial++) {
        soup *s = soup_new();
        const int32_t n = 8 + 22 * trial;
        for (int32_t v = 0; v < n; v++) {
            put_vertex(s, test_uniform(&rng, 0, 1), test_uniform(&rng, 0, 1), test_uniform(&rng, 0, 1));
        }
        for (int32_t f = 0; f < 3 * n; f++) {
            int32_t corner[7];
            const int32_t degree = 3 + test_index(&rng, 5);
            for (int32_t k = 0; k < degree; k++) {
                corner[k] = test_index(&rng, n);
            }
            put_face(s, degree, corner);
        }
        unwrap_well(s, 0, NULL);
    }
}

/* The surface of a random half of a cube of voxels: touching edges and corners, right angles everywhere. */
static void random_voxels_end_in_a_valid_atlas(void **state)
{
    (void)state;
    enum { N = 6, SIDE = N + 2 };
    static const int32_t quad[6][4][3] = {
        {{1, 0, 0}, {1, 1, 0}, {1, 1, 1}, {1, 0, 1}}, {{0, 0, 0}, {0, 0, 1}, {0, 1, 1}, {0, 1, 0}},
        {{0, 1, 0}, {0, 1, 1}, {1, 1, 1}, {1, 1, 0}}, {{0, 0, 0}, {1, 0, 0}, {1, 0, 1}, {0, 0, 1}},
        {{0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}}, {{0, 0, 0}, {0, 1, 0}, {1, 1, 0}, {1, 0, 0}}};
    test_rng rng = test_rng_seed(0x70e1);
    for (int trial = 0; trial < 3; trial++) {
        bool solid[SIDE][SIDE][SIDE] = {0};
        soup *s = soup_new();
        for (int32_t v = 0; v < SIDE * SIDE * SIDE; v++) {
            put_vertex(s, v / (SIDE * SIDE), v / SIDE % SIDE, v % SIDE);
        }
        for (int32_t k = 0; k < N * N * N; k++) {
            solid[1 + k / (N * N)][1 + k / N % N][1 + k % N] = test_index(&rng, 2) == 0;
        }
        for (int32_t k = 0; k < N * N * N; k++) {
            const int32_t x[3] = {1 + k / (N * N), 1 + k / N % N, 1 + k % N};
            for (int side = 0; side < 6 && solid[x[0]][x[1]][x[2]]; side++) {
                int32_t y[3] = {x[0], x[1], x[2]}, corner[4];
                y[side / 2] += side % 2 == 0 ? 1 : -1;
                for (int c = 0; c < 4; c++) {
                    const int32_t *q = quad[side][c];
                    corner[c] = ((x[0] + q[0]) * SIDE + x[1] + q[1]) * SIDE + x[2] + q[2];
                }
                if (!solid[y[0]][y[1]][y[2]]) {
                    put_face(s, 4, corner);
                }
            }
        }
        unwrap_well(s, 0, NULL);
    }
}

static void a_thousand_loose_triangles_are_a_thousand_charts(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(77);
    soup *s = soup_new();
    for (int32_t f = 0; f < 1000; f++) {
        int32_t corner[3];
        for (int k = 0; k < 3; k++) {
            corner[k] = put_vertex(s, f + test_uniform(&rng, 0, 1), test_uniform(&rng, 0, 1), test_uniform(&rng, 0, 1));
        }
        put_face(s, 3, corner);
    }
    unwrap_well(s, 1000, NULL);
}

static void what_has_no_extent_gets_a_texel_a_facet(void **state)
{
    (void)state;
    soup *s = soup_new();
    for (int32_t v = 0; v < 30; v++) {
        put_vertex(s, 1.0, 2.0, 3.0);
    }
    for (int32_t f = 0; f < 28; f++) {
        const int32_t corner[3] = {f, f + 1, f + 2};
        put_face(s, 3, corner);
    }
    unwrap_well(s, 28, NULL);
}

static void one_bent_facet_beyond_the_bound_is_named(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(3);
    soup *s = soup_new();
    int32_t corner[40];
    for (int32_t k = 0; k < 40; k++) {
        corner[k] = put_vertex(s, test_uniform(&rng, 0, 1), test_uniform(&rng, 0, 1), test_uniform(&rng, 0, 1));
    }
    put_face(s, 40, corner);
    const sl_polygons polygons = {s->nv, s->nf, s->xyz, s->first, s->index};
    const sl_atlas_def def = sl_atlas_default();
    sl_atlas *atlas = NULL;
    assert_int_equal(sl_unwrap(&polygons, &def, NULL, &atlas, NULL), SL_OK);
    assert_true(atlas->segmentation->chart[0].flat.distortion.l2 > def.segment.flatten.max_stretch);
    assert_int_equal(atlas->nwarning, 1);
    assert_int_equal(atlas->warning[0].chart, 0);
    sl_atlas_free(atlas);
    free(s);
}

static void margins_wider_than_the_page_are_infeasible(void **state)
{
    (void)state;
    soup *s = soup_new();
    put_grid(s, 20, 6, true, false, moebius);
    const sl_polygons polygons = {s->nv, s->nf, s->xyz, s->first, s->index};
    sl_atlas_def def = sl_atlas_default();
    sl_atlas *atlas = NULL;
    sl_diag diag = sl_diag_none();
    def.pack.margin = def.pack.resolution;
    assert_int_equal(sl_unwrap(&polygons, &def, NULL, &atlas, &diag), SL_INFEASIBLE);
    assert_true(atlas == NULL && strstr(diag.reason, "do not fit") != NULL);
    free(s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_flat_ring_is_one_flat_chart),
        cmocka_unit_test(a_flat_plate_with_many_holes_is_one_flat_chart),
        cmocka_unit_test(a_plane_folded_on_itself_does_not_overlap),
        cmocka_unit_test(a_plane_covered_three_times_does_not_overlap),
        cmocka_unit_test(facets_smaller_than_the_quantum_keep_their_digits),
        cmocka_unit_test(a_strip_4000_times_as_long_as_wide_is_laid_flat),
        cmocka_unit_test(a_one_sided_band_is_cut),
        cmocka_unit_test(random_polygons_end_in_a_valid_atlas),
        cmocka_unit_test(random_voxels_end_in_a_valid_atlas),
        cmocka_unit_test(a_thousand_loose_triangles_are_a_thousand_charts),
        cmocka_unit_test(what_has_no_extent_gets_a_texel_a_facet),
        cmocka_unit_test(one_bent_facet_beyond_the_bound_is_named),
        cmocka_unit_test(margins_wider_than_the_page_are_infeasible),
    };
    openblas_set_num_threads(1); /* the program's rule: ours are the only workers */
    return cmocka_run_group_tests(tests, NULL, NULL);
}
