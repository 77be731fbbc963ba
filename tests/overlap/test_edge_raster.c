/* Counts from active edges against counts triangle by triangle. */
#include "overlap/coverage.h"
#include "overlap/edge_raster.h"

#include "base/memory.h"
#include "support/test_support.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { MAX_VERTICES = 4000, MAX_TRIANGLES = 8000 };

static double uv[2 * MAX_VERTICES];
static int32_t tri[3 * MAX_TRIANGLES];

/* A grid of n x n quads with shuffled diagonals, its inner vertices moved by `noise` quads; nv, nt. */
static void make_grid(test_rng *rng, int32_t n, double noise, int32_t *nv, int32_t *nt)
{
    *nv = (n + 1) * (n + 1);
    *nt = 0;
    for (int32_t v = 0; v < *nv; v++) {
        uv[2 * v] = (v % (n + 1) + test_uniform(rng, -noise, noise)) / n * 0.8 + 0.1;
        uv[2 * v + 1] = ((double)v / (n + 1) + test_uniform(rng, -noise, noise)) / n * 0.8 + 0.08;
    }
    for (int32_t q = 0; q < n * n; q++) {
        const int32_t a = q / n * (n + 1) + q % n, b = a + 1, c = a + n + 2, d = a + n + 1;
        const int32_t one[6] = {a, b, c, a, c, d}, other[6] = {b, c, d, b, d, a};
        memcpy(tri + 3 * *nt, test_index(rng, 2) == 0 ? one : other, sizeof one);
        *nt += 2;
    }
}

/* Triangles on random vertices: any number may meet in an edge, some repeat a vertex. */
static void make_tangle(test_rng *rng, int32_t nv, int32_t nt, double size)
{
    for (int32_t v = 0; v < 2 * nv; v++) {
        uv[v] = test_uniform(rng, 0.5 - size, 0.5 + size);
    }
    for (int32_t c = 0; c < 3 * nt; c++) {
        tri[c] = test_index(rng, nv);
    }
}

static void check_counts(const sl_edge_raster *raster, int32_t nt, int32_t width, int32_t height)
{
    sl_coverage *expected = NULL;
    assert_int_equal(sl_coverage_create(width, height, &expected), SL_OK);
    assert_int_equal(sl_coverage_add(expected, uv, nt, tri, NULL), SL_OK);
    const uint8_t *count8 = sl_edge_raster_counts8(raster);
    const uint16_t *count16 = sl_edge_raster_counts16(raster);
    int64_t different = 0;
    assert_true((count8 == NULL) != (count16 == NULL));
    for (int64_t i = 0; i < (int64_t)width * height; i++) {
        const int32_t e = expected->count[i];
        different += count8 != NULL ? count8[i] != (e < 255 ? e : 255) : count16[i] != e;
    }
    assert_int_equal(different, 0);
    const sl_edge_raster_info info = sl_edge_raster_result(raster);
    assert_int_equal(info.covered, sl_coverage_covered(expected));
    assert_int_equal(info.overlapping, sl_coverage_overlapping(expected));
    uint8_t red[MAX_TRIANGLES], expected_red[MAX_TRIANGLES];
    int32_t found, sum = 0;
    assert_int_equal(sl_edge_raster_red_triangles(raster, uv, NULL, red, &found), SL_OK);
    assert_int_equal(sl_coverage_red_triangles(expected, uv, nt, tri, expected_red), SL_OK);
    for (int32_t t = 0; t < nt; t++) {
        assert_int_equal(red[t], expected_red[t]);
        sum += red[t];
    }
    assert_int_equal(found, sum);
    sl_coverage_free(expected);
}

static sl_edge_raster *make_raster(int32_t nv, int32_t nt, int32_t width, int32_t height, int32_t depth, bool portable)
{
    sl_edge_raster_def def = sl_edge_raster_default();
    sl_edge_raster *raster = NULL;
    def.width = width;
    def.height = height;
    def.depth = depth;
    def.portable = portable;
    assert_int_equal(sl_edge_raster_create(nv, nt, tri, &def, &raster), SL_OK);
    return raster;
}

static void check_drawing(test_rng *rng, int32_t nv, int32_t nt)
{
    const int32_t width = 1 + test_index(rng, 300), height = 1 + test_index(rng, 300);
    for (int k = 0; k < 4; k++) {
        sl_edge_raster *raster = make_raster(nv, nt, width, height, k % 2 == 0 ? 8 : 16, k / 2 == 0);
        assert_int_equal(sl_edge_raster_draw(raster, uv, NULL), SL_OK);
        check_counts(raster, nt, width, height);
        sl_edge_raster_free(raster);
    }
}

static void counts_of_meshes_with_and_without_folds_are_those_of_their_triangles(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0xed6e);
    static const double noise[] = {0.0, 0.2, 0.6, 3.0};
    for (int trial = 0; trial < 60 * test_multiplier(); trial++) {
        int32_t nv, nt;
        make_grid(&rng, 1 + test_index(&rng, 40), noise[trial % 4], &nv, &nt);
        check_drawing(&rng, nv, nt);
    }
}

static void counts_of_tangles_are_those_of_their_triangles(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0x7a61);
    for (int trial = 0; trial < 80 * test_multiplier(); trial++) {
        const int32_t nv = 3 + test_index(&rng, 200), nt = test_index(&rng, 400);
        make_tangle(&rng, nv, nt, trial % 3 == 0 ? 3.0 : 0.5);
        for (int32_t v = 0; v < 2 * nv && trial % 2 == 1; v++) { /* ties: on texel centres and corners */
            uv[v] = (floor(uv[v] * 64.0) + 0.5 * test_index(&rng, 2)) / 64.0;
        }
        check_drawing(&rng, nv, nt);
    }
}

static void an_unfolded_mesh_is_drawn_from_its_border_alone(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0xb0d3);
    int32_t nv, nt;
    make_grid(&rng, 40, 0.2, &nv, &nt);
    sl_edge_raster *raster = make_raster(nv, nt, 512, 512, 16, false);
    assert_int_equal(sl_edge_raster_draw(raster, uv, NULL), SL_OK);
    sl_edge_raster_info info = sl_edge_raster_result(raster);
    assert_true(info.active_edges <= 4 * 40 && info.folded == 0 && info.overlapping == 0 && !info.far);
    for (int32_t v = 0; v < nv; v++) { /* seen from behind: every triangle has the other orientation */
        uv[2 * v] = 1.0 - uv[2 * v];
    }
    assert_int_equal(sl_edge_raster_draw(raster, uv, NULL), SL_OK);
    info = sl_edge_raster_result(raster);
    assert_true(info.active_edges <= 4 * 40 && info.folded == 0 && info.overlapping == 0);
    uv[2 * (20 * 41 + 20)] += 0.1;
    assert_int_equal(sl_edge_raster_draw(raster, uv, NULL), SL_OK);
    info = sl_edge_raster_result(raster);
    assert_true(info.active_edges > 4 * 30 && info.folded > 0 && info.overlapping > 0);
    sl_edge_raster_free(raster);
}

static void moving_a_few_vertices_counts_as_drawing_anew(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0x307e);
    for (int trial = 0; trial < 12 * test_multiplier(); trial++) {
        const int32_t width = 1 + test_index(&rng, 400), height = 1 + test_index(&rng, 400);
        int32_t nv, nt, moved[20];
        make_grid(&rng, 3 + test_index(&rng, 30), 0.3, &nv, &nt);
        sl_edge_raster *raster = make_raster(nv, nt, width, height, trial % 2 == 0 ? 8 : 16, trial % 3 == 0);
        if (trial % 4 != 0) { /* else the first move has to draw everything */
            assert_int_equal(sl_edge_raster_draw(raster, uv, NULL), SL_OK);
        }
        for (int step = 0; step < 20; step++) {
            const int32_t count = test_index(&rng, 20);
            for (int32_t k = 0; k < count; k++) {
                moved[k] = test_index(&rng, nv);
                for (int a = 0; a < 2; a++) {
                    const double far = step == 10 ? 3000.0 : 0.0;
                    uv[2 * moved[k] + a] = test_uniform(&rng, -0.2, 1.2) + far * test_index(&rng, 2);
                }
            }
            assert_int_equal(sl_edge_raster_move(raster, uv, count, moved, NULL), SL_OK);
            check_counts(raster, nt, width, height);
        }
        sl_edge_raster_free(raster);
    }
}

/* Vertex by vertex the mesh is turned over: in between another orientation becomes that of most. What is told of it,
 * and the edges that count, are those of a raster drawn at once. */
static void turning_a_mesh_over_by_moves_tells_what_drawing_it_anew_does(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0x307f);
    for (int trial = 0; trial < 4 * test_multiplier(); trial++) {
        int32_t nv, nt, moved[3], turns = 0;
        int64_t folded = 0;
        make_grid(&rng, 4 + test_index(&rng, 12), 0.25, &nv, &nt);
        sl_edge_raster *raster = make_raster(nv, nt, 257, 190, 16, false);
        assert_int_equal(sl_edge_raster_draw(raster, uv, NULL), SL_OK);
        for (int32_t v = 0; v + 2 < nv; v += 3) {
            for (int k = 0; k < 3; k++) {
                moved[k] = v + k;
                uv[2 * moved[k]] = 1.0 - uv[2 * moved[k]];
            }
            assert_int_equal(sl_edge_raster_move(raster, uv, 3, moved, NULL), SL_OK);
            sl_edge_raster *fresh = make_raster(nv, nt, 257, 190, 16, false);
            assert_int_equal(sl_edge_raster_draw(fresh, uv, NULL), SL_OK);
            const sl_edge_raster_info a = sl_edge_raster_result(raster), b = sl_edge_raster_result(fresh);
            assert_true(a.folded == b.folded && a.active_edges == b.active_edges && a.covered == b.covered &&
                        a.overlapping == b.overlapping);
            assert_memory_equal(sl_edge_raster_counts16(raster), sl_edge_raster_counts16(fresh), 2 * 257 * 190);
            turns += a.folded < folded;
            folded = a.folded;
            sl_edge_raster_free(fresh);
        }
        assert_true(turns > 0);
        sl_edge_raster_free(raster);
    }
}

static void counts_beyond_65535_compare_and_saturate_rightly(void **state)
{
    (void)state;
    enum { SMALL = 70001 };
    static const int32_t layers[] = {254, 255, 256, 32767, 32768, 40000, 65535, 65536, SMALL};
    const double corner[] = {0.1, 0.1, 0.9, 0.2, 0.4, 0.8};
    int32_t *same = sl_alloc(3 * SMALL, sizeof *same);
    assert_non_null(same);
    for (int32_t c = 0; c < 3 * SMALL; c++) {
        same[c] = c / 3 % 2 == 0 ? c % 3 : 2 - c % 3; /* either orientation */
    }
    for (int k = 0; k < 9; k++) {
        for (int portable = 0; portable < 2; portable++) {
            sl_edge_raster_def def = {.width = 70, .height = 33, .depth = k % 2 == 0 ? 8 : 16, .portable = portable};
            sl_edge_raster *raster = NULL;
            assert_int_equal(sl_edge_raster_create(3, layers[k], same, &def, &raster), SL_OK);
            assert_int_equal(sl_edge_raster_draw(raster, corner, NULL), SL_OK);
            const sl_edge_raster_info info = sl_edge_raster_result(raster);
            assert_true(info.covered == info.overlapping && info.covered > 300);
            const int64_t inside = 13 * 70 + 32;
            const int32_t most = def.depth == 8 ? 255 : 65535;
            const int32_t count =
                def.depth == 8 ? sl_edge_raster_counts8(raster)[inside] : sl_edge_raster_counts16(raster)[inside];
            assert_int_equal(count, layers[k] < most ? layers[k] : most);
            sl_edge_raster_free(raster);
        }
    }
    sl_free(same);
}

static void counts_are_the_same_bytes_for_any_number_of_threads(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0x7ead);
    int32_t nv, nt;
    make_grid(&rng, 60, 0.7, &nv, &nt);
    sl_edge_raster *serial = make_raster(nv, nt, 700, 531, 16, false);
    assert_int_equal(sl_edge_raster_draw(serial, uv, NULL), SL_OK);
    for (int32_t workers = 2; workers <= 16; workers *= 2) {
        sl_thread_pool *pool = NULL;
        assert_int_equal(sl_thread_pool_create(workers + 1, &pool), SL_OK);
        const sl_context context = {.executor = sl_thread_pool_executor(pool)};
        sl_edge_raster *parallel = make_raster(nv, nt, 700, 531, 16, workers == 4);
        assert_int_equal(sl_edge_raster_draw(parallel, uv, &context), SL_OK);
        assert_memory_equal(sl_edge_raster_counts16(parallel), sl_edge_raster_counts16(serial), 700 * 531 * 2);
        uint8_t red[2][MAX_TRIANGLES];
        int32_t count[2];
        assert_int_equal(sl_edge_raster_red_triangles(serial, uv, NULL, red[0], &count[0]), SL_OK);
        assert_int_equal(sl_edge_raster_red_triangles(parallel, uv, &context, red[1], &count[1]), SL_OK);
        assert_int_equal(count[0], count[1]);
        assert_memory_equal(red[0], red[1], (size_t)nt);
        sl_edge_raster_free(parallel);
        sl_thread_pool_free(pool);
    }
    sl_edge_raster_free(serial);
}

static void wild_coordinates_are_refused_and_far_ones_counted(void **state)
{
    (void)state;
    static const double wild[] = {NAN, INFINITY, -INFINITY, 16384.5, -16385.0, 1e300};
    static const double far[] = {16384.0, -16384.0, 4000.25, -130.5};
    test_rng rng = test_rng_seed(0x71d);
    int32_t nv, nt;
    make_grid(&rng, 9, 0.3, &nv, &nt);
    for (int32_t size = 1; size <= 128; size *= 2) { /* small windows, whose lattice would hold more */
        sl_edge_raster *small = make_raster(nv, nt, size, 129 - size, 8, size == 4 || size == 128);
        const double held = uv[74];
        uv[74] = 16384.5;
        assert_int_equal(sl_edge_raster_draw(small, uv, NULL), SL_BAD_INPUT);
        uv[74] = -16384.0;
        assert_int_equal(sl_edge_raster_draw(small, uv, NULL), SL_OK);
        check_counts(small, nt, size, 129 - size);
        uv[74] = held;
        sl_edge_raster_free(small);
    }
    sl_edge_raster *raster = make_raster(nv, nt, 300, 200, 16, false);
    assert_int_equal(sl_edge_raster_draw(raster, uv, NULL), SL_OK);
    const int64_t covered = sl_edge_raster_result(raster).covered;
    for (int k = 0; k < 6; k++) {
        for (int32_t v = 37; v <= nv - 1; v += nv - 38) { /* the last one is that of an odd number */
            const double held = uv[2 * v + k % 2];
            uv[2 * v + k % 2] = wild[k];
            assert_int_equal(sl_edge_raster_draw(raster, uv, NULL), SL_BAD_INPUT);
            assert_int_equal(sl_edge_raster_move(raster, uv, 1, &v, NULL), SL_BAD_INPUT);
            assert_int_equal(sl_edge_raster_result(raster).covered, covered);
            uv[2 * v + k % 2] = held;
        }
    }
    for (int k = 0; k < 4; k++) {
        const double held = uv[74];
        uv[74] = far[k];
        assert_int_equal(sl_edge_raster_draw(raster, uv, NULL), SL_OK);
        check_counts(raster, nt, 300, 200);
        uv[74] = held;
    }
    sl_edge_raster_free(raster);
}

static void any_size_behaves_and_others_are_refused(void **state)
{
    (void)state;
    static const int32_t good[][2] = {{1, 1}, {1, 3000}, {3000, 1}, {16384, 16384}, {17, 15}};
    static const int32_t bad[][3] = {{0, 5, 8}, {5, 0, 16}, {-3, 7, 8}, {32769, 1, 8}, {1, 32769, 8}, {4, 4, 32}};
    test_rng rng = test_rng_seed(0x512e);
    int32_t nv, nt;
    make_grid(&rng, 5, 0.3, &nv, &nt);
    for (int k = 0; k < 5; k++) {
        sl_edge_raster *raster = make_raster(nv, nt, good[k][0], good[k][1], 8, false);
        assert_int_equal(sl_edge_raster_draw(raster, uv, NULL), SL_OK);
        if (k != 3) {
            check_counts(raster, nt, good[k][0], good[k][1]);
        }
        assert_true(k != 3 || llabs(sl_edge_raster_result(raster).covered - 171798692) < 40000000);
        sl_edge_raster_free(raster);
        raster = make_raster(0, 0, good[k][0], good[k][1], 8, false); /* no triangles, no vertices */
        assert_int_equal(sl_edge_raster_draw(raster, NULL, NULL), SL_OK);
        assert_int_equal(sl_edge_raster_result(raster).covered, 0);
        sl_edge_raster_free(raster);
    }
    for (int k = 0; k < 6; k++) {
        const sl_edge_raster_def def = {.width = bad[k][0], .height = bad[k][1], .depth = bad[k][2]};
        sl_edge_raster *raster = NULL;
        assert_int_equal(sl_edge_raster_create(nv, nt, tri, &def, &raster), SL_BAD_INPUT);
        assert_null(raster);
    }
    sl_edge_raster_free(NULL);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(counts_of_meshes_with_and_without_folds_are_those_of_their_triangles),
        cmocka_unit_test(counts_of_tangles_are_those_of_their_triangles),
        cmocka_unit_test(an_unfolded_mesh_is_drawn_from_its_border_alone),
        cmocka_unit_test(moving_a_few_vertices_counts_as_drawing_anew),
        cmocka_unit_test(turning_a_mesh_over_by_moves_tells_what_drawing_it_anew_does),
        cmocka_unit_test(counts_beyond_65535_compare_and_saturate_rightly),
        cmocka_unit_test(counts_are_the_same_bytes_for_any_number_of_threads),
        cmocka_unit_test(wild_coordinates_are_refused_and_far_ones_counted),
        cmocka_unit_test(any_size_behaves_and_others_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
