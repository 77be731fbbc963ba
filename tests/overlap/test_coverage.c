/* Coverage counts against the fill rule applied texel by texel. */
#include "overlap/coverage.h"

#include "base/memory.h"
#include "overlap/fill_rule.h"
#include "overlap/raster_internal.h"
#include "support/test_support.h"

#include <string.h>

static sl_coverage *make_coverage(int32_t width, int32_t height)
{
    sl_coverage *coverage = NULL;
    assert_int_equal(sl_coverage_create(width, height, &coverage), SL_OK);
    assert_non_null(coverage);
    return coverage;
}

/* Compares every texel with the count of triangles that have it inside, and both sums. */
static void check_counts(const sl_coverage *coverage, const double *uv, int32_t nt, const int32_t *tri)
{
    int64_t covered = 0, overlapping = 0;
    for (int32_t y = 0; y < coverage->height; y++) {
        for (int32_t x = 0; x < coverage->width; x++) {
            int32_t expected = 0;
            for (int32_t t = 0; t < nt; t++) {
                const test_snapped s = test_snap_triangle(uv, tri + 3 * t, coverage->width, coverage->height);
                expected += test_inside(&s, x, y);
            }
            assert_int_equal(coverage->count[(int64_t)y * coverage->width + x], expected);
            covered += expected >= 1;
            overlapping += expected >= 2;
        }
    }
    assert_int_equal(sl_coverage_covered(coverage), covered);
    assert_int_equal(sl_coverage_overlapping(coverage), overlapping);
}

static void snapping_is_the_fused_float_transform(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0x5a9);
    for (int trial = 0; trial < 500000 * test_multiplier(); trial++) {
        const int32_t size = 1 + test_index(&rng, SL_RASTER_MAX_SIZE);
        const double reach = ldexp(1.0, test_index(&rng, 16) - 1);
        const double u = test_index(&rng, 4) > 0 ? test_uniform(&rng, 0.0, 1.0) : test_uniform(&rng, -reach, reach);
        assert_int_equal(sl_raster_snap(u, size), test_snap(u, size));
    }
    assert_int_equal(sl_raster_snap(0.5, 8), 3 * 256 + 128); /* centre of texel x is at lattice 256 x */
    assert_int_equal(sl_raster_snap(0.5625, 8), 4 * 256);
}

enum { CORNERS = 24, TRIANGLES = 12 };

/* Random triangles; kind 0: anywhere in the window; 1: beyond its border; 2: slivers; 3: corners on texel centres and
 * borders, where the top-left rule decides. */
static void random_triangles(test_rng *rng, int kind, int32_t width, int32_t height, double *uv, int32_t *tri)
{
    for (int32_t v = 0; v < CORNERS; v++) {
        uv[2 * v] = kind == 1 ? test_uniform(rng, -3.0, 4.0) : test_uniform(rng, 0.0, 1.0);
        uv[2 * v + 1] = kind == 1 ? test_uniform(rng, -3.0, 4.0) : test_uniform(rng, 0.0, 1.0);
        if (kind == 2 && v % 3 == 2) {
            for (int k = 0; k < 2; k++) {
                uv[2 * v + k] = 0.3 * uv[2 * v + k - 2] + 0.7 * uv[2 * v + k - 4] + test_uniform(rng, -2e-3, 2e-3);
            }
        }
        if (kind == 3) {
            uv[2 * v] = 0.5 * test_index(rng, 2 * width + 1) / width;
            uv[2 * v + 1] = 0.5 * test_index(rng, 2 * height + 1) / height;
        }
    }
    for (int32_t t = 0; t < TRIANGLES; t++) {
        const int32_t first = test_index(rng, CORNERS / 3) * 3;
        for (int k = 0; k < 3; k++) {
            tri[3 * t + k] = kind == 2 ? first + k : test_index(rng, CORNERS);
        }
    }
}

static void counts_are_those_of_the_fill_rule(void **state)
{
    (void)state;
    static const int32_t sizes[][2] = {{1, 1}, {2, 3}, {8, 8}, {7, 5}, {64, 64}, {31, 70}, {100, 37}, {128, 256}};
    test_rng rng = test_rng_seed(0xf111);
    for (int trial = 0; trial < 240 * test_multiplier(); trial++) {
        const int32_t width = sizes[trial % 8][0], height = sizes[trial % 8][1];
        double uv[2 * CORNERS];
        int32_t tri[3 * TRIANGLES];
        random_triangles(&rng, trial / 8 % 4, width, height, uv, tri);
        sl_coverage *coverage = make_coverage(width, height);
        assert_int_equal(sl_coverage_add(coverage, uv, TRIANGLES, tri, NULL), SL_OK);
        check_counts(coverage, uv, TRIANGLES, tri);
        sl_coverage_free(coverage);
    }
}

/* Corners up to 2^14 windows away: 128-bit arithmetic in the set-up. */
static void counts_of_far_corners_are_exact(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0xfa4);
    int64_t covered = 0;
    for (int trial = 0; trial < 1500 * test_multiplier(); trial++) {
        const int32_t width = 1 + test_index(&rng, 40), height = trial % 10 == 0 ? 1000 : 1 + test_index(&rng, 40);
        const double reach = ldexp(1.0, test_index(&rng, 15));
        double uv[6];
        const int32_t tri[3] = {2, 0, 1};
        for (int k = 0; k < 6; k++) {
            uv[k] = test_uniform(&rng, -reach, reach);
        }
        if (trial % 2 == 0) { /* an edge that passes through the window */
            uv[4] = test_uniform(&rng, 0.0, 1.0) * (1.0 - uv[0]) + uv[0];
            uv[2] = -uv[0] * 0.9;
            uv[3] = -uv[1] * 0.9;
        }
        sl_coverage *coverage = make_coverage(width, height);
        assert_int_equal(sl_coverage_add(coverage, uv, 1, tri, NULL), SL_OK);
        check_counts(coverage, uv, 1, tri);
        covered += sl_coverage_covered(coverage);
        sl_coverage_free(coverage);
    }
    assert_true(covered > 10000);
}

/* Large windows with the largest coordinates: single texels along the spans' ends are compared. */
static void spans_of_far_corners_in_a_large_window_are_exact(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0x1a46e);
    const int32_t size = SL_RASTER_MAX_SIZE;
    for (int trial = 0; trial < 40 * test_multiplier(); trial++) {
        double uv[6];
        const int32_t tri[3] = {0, 1, 2};
        const double reach = trial % 2 == 0 ? 16384.0 : 2.0;
        for (int k = 0; k < 6; k++) {
            uv[k] = test_uniform(&rng, -reach, reach);
        }
        sl_raster_triangle triangle;
        sl_raster_walk walk;
        int32_t row_begin, row_end, row, begin, end;
        const test_snapped s = test_snap_triangle(uv, tri, size, size);
        if (!sl_raster_triangle_set(uv, tri, size, size, &triangle)) {
            continue;
        }
        sl_raster_rows(&triangle, size, &row_begin, &row_end);
        sl_raster_walk_start(&triangle, size, row_begin, row_end, &walk);
        while (sl_raster_walk_next(&walk, &row, &begin, &end)) {
            const int32_t x[4] = {begin - 1, begin, end - 1, end};
            for (int k = 0; k < 4; k++) {
                if (x[k] >= 0 && x[k] < size) {
                    assert_int_equal(test_inside(&s, x[k], row), x[k] >= begin && x[k] < end);
                }
            }
        }
    }
}

enum { GRID = 23 };

/* A jittered grid over the window [0, 1]^2 with random diagonals; jitter below 0.3 of a cell keeps all triangles
 * positive. Returns the number of triangles. */
static int32_t jittered_grid(test_rng *rng, double *uv, int32_t *tri)
{
    for (int32_t i = 0; i <= GRID; i++) {
        for (int32_t j = 0; j <= GRID; j++) {
            const bool inner_x = j > 0 && j<GRID, inner_y = i> 0 && i < GRID;
            uv[2 * (i * (GRID + 1) + j)] = (j + (inner_x ? test_uniform(rng, -0.24, 0.24) : 0.0)) / GRID;
            uv[2 * (i * (GRID + 1) + j) + 1] = (i + (inner_y ? test_uniform(rng, -0.24, 0.24) : 0.0)) / GRID;
        }
    }
    int32_t nt = 0;
    for (int32_t i = 0; i < GRID; i++) {
        for (int32_t j = 0; j < GRID; j++) {
            const int32_t a = i * (GRID + 1) + j, b = a + 1, c = b + GRID + 1, d = a + GRID + 1;
            const bool main_diagonal = test_index(rng, 2) == 0;
            const int32_t cell[6] = {a, b, main_diagonal ? c : d, main_diagonal ? a : b, c, d};
            memcpy(tri + 3 * nt, cell, sizeof cell);
            nt += 2;
        }
    }
    return nt;
}

static void triangulated_square_covers_each_texel_exactly_once(void **state)
{
    (void)state;
    static const int32_t sizes[][2] = {{64, 64}, {512, 512}, {1000, 1000}, {333, 77}, {2048, 64}};
    test_rng rng = test_rng_seed(0x6e1d);
    double uv[2 * (GRID + 1) * (GRID + 1)];
    int32_t tri[6 * GRID * GRID];
    for (int trial = 0; trial < 20 * test_multiplier(); trial++) {
        const int32_t nt = jittered_grid(&rng, uv, tri);
        sl_coverage *coverage = make_coverage(sizes[trial % 5][0], sizes[trial % 5][1]);
        assert_int_equal(sl_coverage_add(coverage, uv, nt, tri, NULL), SL_OK);
        for (int64_t k = 0; k < (int64_t)coverage->width * coverage->height; k++) {
            assert_int_equal(coverage->count[k], 1);
        }
        sl_coverage_free(coverage);
    }
}

enum { RINGS = 9, SPOKES = 41 };

/* Rings around a centre off the lattice, turned from ring to ring. */
static int32_t disk(test_rng *rng, double centre_x, double centre_y, double radius, double *uv, int32_t *tri)
{
    int32_t nt = 0;
    uv[0] = centre_x;
    uv[1] = centre_y;
    for (int32_t r = 0; r < RINGS; r++) {
        for (int32_t s = 0; s < SPOKES; s++) {
            const int32_t v = 1 + r * SPOKES + s, next = 1 + r * SPOKES + (s + 1) % SPOKES;
            const double wobble = r + 1 < RINGS ? test_uniform(rng, -0.2, 0.2) : 0.0;
            const double turn = 2.0 * TEST_PI * (s + 0.3 * r) / SPOKES, rho = radius * (r + 1 + wobble) / RINGS;
            uv[2 * v] = centre_x + rho * cos(turn);
            uv[2 * v + 1] = centre_y + rho * sin(turn);
            const int32_t fan[3] = {0, v, next}, strip[6] = {v - SPOKES, v, next, v - SPOKES, next, next - SPOKES};
            memcpy(tri + 3 * nt, r == 0 ? fan : strip, (r == 0 ? 3 : 6) * sizeof(int32_t));
            nt += r == 0 ? 1 : 2;
        }
    }
    return nt;
}

static void triangulated_disk_covers_its_inside_exactly_once(void **state)
{
    (void)state;
    static const int32_t sizes[] = {128, 256, 1000, 777, 1024};
    test_rng rng = test_rng_seed(0xd15c);
    double uv[2 * (1 + RINGS * SPOKES)];
    int32_t tri[6 * RINGS * SPOKES];
    for (int trial = 0; trial < 10 * test_multiplier(); trial++) {
        const int32_t size = sizes[trial % 5];
        const double cx = test_uniform(&rng, 0.45, 0.55), cy = test_uniform(&rng, 0.45, 0.55), radius = 0.43;
        const double inner = radius * cos(TEST_PI / SPOKES) - 0.01 / size; /* of the inscribed circle, less a snap */
        const int32_t nt = disk(&rng, cx, cy, radius, uv, tri);
        sl_coverage *coverage = make_coverage(size, size);
        assert_int_equal(sl_coverage_add(coverage, uv, nt, tri, NULL), SL_OK);
        for (int32_t y = 0; y < size; y++) {
            for (int32_t x = 0; x < size; x++) {
                const double r = hypot((x + 0.5) / size - cx, (y + 0.5) / size - cy);
                const int32_t count = coverage->count[(int64_t)y * size + x];
                assert_in_range(count, r < inner ? 1 : 0, r > radius + 0.01 / size ? 0 : 1);
            }
        }
        assert_int_equal(sl_coverage_overlapping(coverage), 0);
        sl_coverage_free(coverage);
    }
}

static void counts_saturate_instead_of_wrapping(void **state)
{
    (void)state;
    enum { COPIES = 33000 };
    const double uv[] = {-0.3, -0.2, 1.9, -0.1, 0.2, 2.7, 0.61, 0.57, 0.96, 0.62, 0.63, 0.94};
    int32_t *tri = sl_alloc(6 * COPIES, sizeof *tri);
    assert_non_null(tri);
    for (int32_t t = 0; t < 2 * COPIES; t++) {
        const int32_t big = t < COPIES + 7; /* 33007 big ones, 32993 small ones: 66000 where both are */
        for (int32_t k = 0; k < 3; k++) {
            tri[3 * t + k] = big ? k : 5 - k;
        }
    }
    sl_coverage *coverage = make_coverage(5, 6);
    assert_int_equal(sl_coverage_add(coverage, uv, 2 * COPIES, tri, NULL), SL_OK);
    int32_t saturated = 0, plain = 0;
    for (int32_t k = 0; k < 30; k++) {
        saturated += coverage->count[k] == 65535;
        plain += coverage->count[k] == COPIES + 7;
        assert_true(coverage->count[k] == 0 || coverage->count[k] == 65535 || coverage->count[k] == COPIES + 7);
    }
    assert_true(saturated > 0 && plain > 0);
    sl_coverage_free(coverage);
    sl_free(tri);
}

static void calls_add_up_whatever_the_orientation(void **state)
{
    (void)state;
    const double uv[] = {0.13, 0.21, 0.88, 0.17, 0.52, 0.91};
    const int32_t forth[] = {0, 1, 2}, back[] = {2, 1, 0};
    sl_coverage *coverage = make_coverage(48, 40);
    assert_int_equal(sl_coverage_add(coverage, uv, 1, forth, NULL), SL_OK);
    const int64_t covered = sl_coverage_covered(coverage);
    assert_true(covered > 400);
    assert_int_equal(sl_coverage_overlapping(coverage), 0);
    assert_int_equal(sl_coverage_add(coverage, uv, 1, back, NULL), SL_OK);
    assert_int_equal(sl_coverage_covered(coverage), covered);
    assert_int_equal(sl_coverage_overlapping(coverage), covered);
    sl_coverage_free(coverage);
}

static void counts_are_the_same_for_any_number_of_threads(void **state)
{
    (void)state;
    enum { MANY = 9000 };
    test_rng rng = test_rng_seed(0x7417);
    double *uv = sl_alloc(6 * MANY, sizeof *uv);
    int32_t *tri = sl_alloc(3 * MANY, sizeof *tri);
    assert_true(uv != NULL && tri != NULL);
    for (int32_t t = 0; t < MANY; t++) {
        const double x = test_uniform(&rng, -0.1, 1.1), y = test_uniform(&rng, -0.1, 1.1);
        const double r = t % 50 == 0 ? 0.5 : 0.02;
        for (int32_t k = 0; k < 3; k++) {
            uv[6 * t + 2 * k] = x + test_uniform(&rng, -r, r);
            uv[6 * t + 2 * k + 1] = y + test_uniform(&rng, -r, r);
            tri[3 * t + k] = 3 * t + k;
        }
    }
    sl_coverage *serial = make_coverage(700, 530);
    assert_int_equal(sl_coverage_add(serial, uv, MANY, tri, NULL), SL_OK);
    static const int32_t workers[] = {1, 2, 5};
    for (int w = 0; w < 3; w++) {
        sl_thread_pool *pool = NULL;
        assert_int_equal(sl_thread_pool_create(workers[w], &pool), SL_OK);
        const sl_context context = {.executor = sl_thread_pool_executor(pool)};
        sl_coverage *parallel = make_coverage(700, 530);
        assert_int_equal(sl_coverage_add(parallel, uv, MANY, tri, &context), SL_OK);
        assert_memory_equal(parallel->count, serial->count, 700 * 530 * sizeof *serial->count);
        sl_coverage_free(parallel);
        sl_thread_pool_free(pool);
    }
    sl_coverage_free(serial);
    sl_free(tri);
    sl_free(uv);
}

static void red_triangles_are_those_on_a_texel_covered_twice(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0x4ed);
    int seen[2] = {0};
    for (int trial = 0; trial < 200 * test_multiplier(); trial++) {
        const int32_t width = 20 + test_index(&rng, 30), height = 20 + test_index(&rng, 30);
        const int32_t nt = 1 + test_index(&rng, TRIANGLES);
        double uv[2 * CORNERS];
        int32_t tri[3 * TRIANGLES];
        uint8_t red[TRIANGLES];
        random_triangles(&rng, trial % 4, width, height, uv, tri);
        for (int32_t v = 0; v < CORNERS; v++) { /* smaller, so that some stay apart */
            const int32_t anchor = v / 3 * 3;
            uv[2 * v] = trial % 4 == 0 ? 0.8 * uv[2 * anchor] + 0.2 * uv[2 * v] : uv[2 * v];
        }
        sl_coverage *coverage = make_coverage(width, height);
        assert_int_equal(sl_coverage_add(coverage, uv, nt, tri, NULL), SL_OK);
        assert_int_equal(sl_coverage_red_triangles(coverage, uv, nt, tri, red), SL_OK);
        for (int32_t t = 0; t < nt; t++) {
            const test_snapped s = test_snap_triangle(uv, tri + 3 * t, width, height);
            uint8_t expected = 0;
            for (int32_t k = 0; k < width * height; k++) {
                expected |= coverage->count[k] >= 2 && test_inside(&s, k % width, k / width);
            }
            assert_int_equal(red[t], expected);
            seen[expected]++;
        }
        sl_coverage_free(coverage);
    }
    assert_true(seen[0] > 50 && seen[1] > 50);
}

static void coverage_refuses_wild_coordinates_and_counts_nothing(void **state)
{
    (void)state;
    static const double wild[] = {NAN, INFINITY, -INFINITY, 16384.5, -16385.0};
    const int32_t tri[] = {0, 1, 2, 1, 2, 3};
    for (int k = 0; k < 5; k++) {
        double uv[] = {0.1, 0.2, 0.7, 0.3, 0.4, 0.9, 0.8, 0.8};
        uint8_t red[2];
        uv[7 - k % 2] = wild[k]; /* in the second triangle: the first must not be counted either */
        sl_coverage *coverage = make_coverage(16, 16);
        assert_int_equal(sl_coverage_add(coverage, uv, 2, tri, NULL), SL_BAD_INPUT);
        assert_int_equal(sl_coverage_covered(coverage), 0);
        assert_int_equal(sl_coverage_red_triangles(coverage, uv, 2, tri, red), SL_BAD_INPUT);
        sl_coverage_free(coverage);
    }
}

static void coverage_refuses_sizes_out_of_range(void **state)
{
    (void)state;
    static const int32_t sizes[][2] = {{0, 5}, {5, 0}, {-3, 7}, {32769, 1}, {1, 32769}};
    for (int k = 0; k < 5; k++) {
        sl_coverage *coverage = NULL;
        assert_int_equal(sl_coverage_create(sizes[k][0], sizes[k][1], &coverage), SL_BAD_INPUT);
        assert_null(coverage);
    }
    sl_coverage_free(NULL);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(snapping_is_the_fused_float_transform),
        cmocka_unit_test(counts_are_those_of_the_fill_rule),
        cmocka_unit_test(counts_of_far_corners_are_exact),
        cmocka_unit_test(spans_of_far_corners_in_a_large_window_are_exact),
        cmocka_unit_test(triangulated_square_covers_each_texel_exactly_once),
        cmocka_unit_test(triangulated_disk_covers_its_inside_exactly_once),
        cmocka_unit_test(counts_saturate_instead_of_wrapping),
        cmocka_unit_test(calls_add_up_whatever_the_orientation),
        cmocka_unit_test(counts_are_the_same_for_any_number_of_threads),
        cmocka_unit_test(red_triangles_are_those_on_a_texel_covered_twice),
        cmocka_unit_test(coverage_refuses_wild_coordinates_and_counts_nothing),
        cmocka_unit_test(coverage_refuses_sizes_out_of_range),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
