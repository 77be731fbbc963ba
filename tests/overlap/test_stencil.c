/* Counts against OpenGL's stencil increment on Mesa's llvmpipe, every texel. Built where Mesa's headers are installed.
 */
#include "atlas/atlas.h"
#include "generators.h"
#include "overlap/coverage.h"
#include "overlap/edge_raster.h"
#include "overlap/stencil.h"

#include "base/memory.h"
#include "support/test_support.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

enum { MOST_VERTICES = 200000, MOST_TRIANGLES = 100000 };

typedef struct soup {
    int32_t nv, nt;
    double *uv;
    float *narrow;
    int32_t *tri;
} soup;

static soup s;

static int setup(void **state)
{
    (void)state;
    s.uv = sl_alloc(2 * MOST_VERTICES, sizeof *s.uv);
    s.narrow = sl_alloc(2 * MOST_VERTICES, sizeof *s.narrow);
    s.tri = sl_alloc(3 * MOST_TRIANGLES, sizeof *s.tri);
    return s.uv != NULL && s.narrow != NULL && s.tri != NULL ? 0 : -1;
}

static int teardown(void **state)
{
    (void)state;
    sl_free(s.uv);
    sl_free(s.narrow);
    sl_free(s.tri);
    return 0;
}

/* llvmpipe fuses the viewport's multiply and add only where the processor can; without, the two roundings agree for
 * powers of two alone. */
static bool can_compare(int32_t width, int32_t height)
{
    const bool powers = (width & (width - 1)) == 0 && (height & (height - 1)) == 0;
#if defined(__x86_64__) || defined(__i386__)
    return powers || __builtin_cpu_supports("fma");
#else
    return powers;
#endif
}

static int64_t differing(const uint8_t *a, const uint8_t *b, int64_t n)
{
    int64_t count = 0;
    for (int64_t i = 0; i < n; i++) {
        count += a[i] != b[i];
    }
    return count;
}

/* The edge raster's counts and the triangle-by-triangle ones against the stencil buffer, the driver clipping by a
 * viewport that is larger than the window by so many doublings. */
static void compare_widened(const char *what, int32_t width, int32_t height, int doublings)
{
    if (!can_compare(width, height)) {
        print_message("no fused multiply-add here: %s is not compared at %d x %d\n", what, width, height);
        return;
    }
    const int64_t texels = (int64_t)width * height;
    test_stencil *stencil = test_stencil_create(width, height, 0);
    if (stencil == NULL) {
        print_message("no llvmpipe here\n");
        skip();
    }
    uint8_t *expected = sl_alloc(texels, 1), *narrowed = sl_alloc(texels, 1);
    const sl_edge_raster_def def = {.width = width, .height = height, .depth = 8};
    sl_edge_raster *raster = NULL;
    sl_coverage *coverage = NULL;
    assert_true(expected != NULL && narrowed != NULL);
    for (int32_t i = 0; i < 2 * s.nv; i++) {
        s.narrow[i] = (float)s.uv[i];
    }
    assert_true(test_stencil_widen(stencil, doublings));
    assert_true(test_stencil_draw(stencil, s.nv, s.narrow, s.nt, s.tri, expected));
    assert_int_equal(sl_edge_raster_create(s.nv, s.nt, s.tri, &def, &raster), SL_OK);
    assert_int_equal(sl_edge_raster_draw(raster, s.uv, NULL), SL_OK);
    assert_int_equal(sl_coverage_create(width, height, &coverage), SL_OK);
    assert_int_equal(sl_coverage_add(coverage, s.uv, s.nt, s.tri, NULL), SL_OK);
    for (int64_t i = 0; i < texels; i++) {
        narrowed[i] = (uint8_t)(coverage->count[i] < 255 ? coverage->count[i] : 255);
    }
    const int64_t by_edges = differing(sl_edge_raster_counts8(raster), expected, texels);
    const int64_t by_triangles = differing(narrowed, expected, texels);
    const int64_t covered = sl_coverage_covered(coverage);
    sl_coverage_free(coverage);
    sl_edge_raster_free(raster);
    sl_free(expected);
    sl_free(narrowed);
    test_stencil_free(stencil);
    if (by_edges + by_triangles > 0) {
        print_message("%s at %d x %d: %lld and %lld texels differ\n", what, width, height, (long long)by_edges,
                      (long long)by_triangles);
    }
    assert_true(covered > 0 && by_edges == 0 && by_triangles == 0);
}

static void compare_at(const char *what, int32_t width, int32_t height)
{
    compare_widened(what, width, height, 0);
}

static void compare(const char *what)
{
    static const int32_t size[][2] = {{1024, 1024}, {512, 2048}, {1000, 1000}, {777, 1231}, {1920, 1080}};
    for (int k = 0; k < 5; k++) {
        compare_at(what, size[k][0], size[k][1]);
    }
}

static void random_triangles(test_rng *rng, int32_t nt, double size)
{
    s.nt = nt;
    s.nv = 3 * nt;
    for (int32_t t = 0; t < nt; t++) {
        const double x = test_uniform(rng, size, 1.0 - size), y = test_uniform(rng, size, 1.0 - size);
        for (int k = 0; k < 3; k++) {
            s.tri[3 * t + k] = 3 * t + k;
            s.uv[2 * (3 * t + k)] = x + test_uniform(rng, -size, size);
            s.uv[2 * (3 * t + k) + 1] = y + test_uniform(rng, -size, size);
        }
    }
}

static void random_triangles_of_all_sizes_are_counted_alike(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0x57e);
    static const double size[] = {0.5, 0.05, 0.005, 0.0005};
    for (int k = 0; k < 4; k++) {
        random_triangles(&rng, k == 0 ? 100 : 9000, size[k]);
        compare("random triangles");
    }
}

static void slivers_are_counted_alike(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0x511);
    random_triangles(&rng, 5000, 0.2);
    for (int32_t t = 0; t < s.nt; t++) { /* the third corner close to the line of the others */
        double *p = s.uv + 6 * t;
        const double along = test_uniform(&rng, 0.0, 1.0);
        for (int a = 0; a < 2; a++) {
            p[4 + a] = p[a] + along * (p[2 + a] - p[a]) + test_uniform(&rng, -1e-3, 1e-3);
            p[4 + a] = fmin(fmax(p[4 + a], 0.0), 1.0);
        }
    }
    compare("slivers");
}

/* Corners on texel centres, corners and edges of the window of this size, in both orientations, some without area. */
static void ties_and_degenerate_triangles_are_counted_alike(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0x71e5);
    static const int32_t size[][2] = {{64, 64}, {128, 32}, {100, 100}, {1000, 1000}, {96, 1024}};
    for (int k = 0; k < 5; k++) {
        random_triangles(&rng, 3000, 0.2);
        for (int32_t v = 0; v < s.nv; v++) {
            for (int a = 0; a < 2; a++) {
                s.uv[2 * v + a] =
                    floor(s.uv[2 * v + a] * size[k][a]) / size[k][a] + 0.5 / size[k][a] * test_index(&rng, 2);
                s.uv[2 * v + a] = fmin(s.uv[2 * v + a], 1.0);
            }
        }
        for (int32_t t = 0; t < s.nt; t += 7) {
            s.tri[3 * t + 1] = s.tri[3 * t + test_index(&rng, 3)];
        }
        compare_at("ties", size[k][0], size[k][1]);
    }
}

static void make_grid(test_rng *rng, int32_t n, double noise)
{
    s.nv = (n + 1) * (n + 1);
    s.nt = 2 * n * n;
    for (int32_t v = 0; v < s.nv; v++) {
        const int32_t i = v % (n + 1), j = v / (n + 1);
        const bool inner = i > 0 && j > 0 && i < n && j < n;
        s.uv[2 * v] = ((double)i + (inner ? test_uniform(rng, -noise, noise) : 0.0)) / n;
        s.uv[2 * v + 1] = ((double)j + (inner ? test_uniform(rng, -noise, noise) : 0.0)) / n;
    }
    for (int32_t q = 0; q < n * n; q++) {
        const int32_t a = q / n * (n + 1) + q % n, corner[6] = {a, a + 1, a + n + 2, a, a + n + 2, a + n + 1};
        memcpy(s.tri + 6 * q, corner, sizeof corner);
    }
}

static void grids_flat_and_folded_are_counted_alike(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0x96d);
    static const double noise[] = {0.0, 0.3, 0.9};
    for (int k = 0; k < 3; k++) {
        make_grid(&rng, 17 + 50 * k, noise[k]);
        compare("a grid");
    }
}

/* A fan around a centre: watertight only if every edge is rounded alike from both sides. */
static void disks_are_counted_alike_and_once(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0xd15c);
    const int32_t n = 4999;
    s.nv = n + 1;
    s.nt = n;
    s.uv[0] = 0.47;
    s.uv[1] = 0.52;
    for (int32_t k = 0; k < n; k++) {
        const double turn = 2.0 * TEST_PI * (k + test_uniform(&rng, 0.0, 0.8)) / n;
        s.uv[2 * (k + 1)] = 0.47 + 0.4 * cos(turn);
        s.uv[2 * (k + 1) + 1] = 0.52 + 0.4 * sin(turn);
        s.tri[3 * k] = 0;
        s.tri[3 * k + 1] = k + 1;
        s.tri[3 * k + 2] = (k + 1) % n + 1;
    }
    compare("a disk");
}

static void saturated_counts_are_alike(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0x5a7);
    random_triangles(&rng, 3000, 0.5); /* most texels are hit hundreds of times */
    compare("saturated counts");
}

static void charts_of_an_atlas_are_counted_alike(void **state)
{
    (void)state;
    static const char *const names[] = {"mug", "hand"};
    for (int k = 0; k < 2; k++) {
        const sl_generator *generator = sl_generator_find(names[k]);
        sl_generated *mesh = NULL;
        sl_polygons polygons;
        sl_atlas *atlas = NULL;
        sl_atlas_def def = sl_atlas_default();
        def.check_resolution = 512;
        assert_non_null(generator);
        assert_int_equal(generator->make(7, 1, &mesh), SL_OK);
        sl_generated_polygons(mesh, &polygons);
        assert_int_equal(sl_unwrap(&polygons, &def, NULL, &atlas, NULL), SL_OK);
        assert_true(atlas->mesh->nh <= MOST_VERTICES && atlas->triangulation->nt <= MOST_TRIANGLES);
        s.nv = atlas->mesh->nh;
        s.nt = atlas->triangulation->nt;
        memcpy(s.uv, atlas->corner_uv, 2 * (size_t)s.nv * sizeof *s.uv);
        memcpy(s.tri, atlas->triangulation->corner, 3 * (size_t)s.nt * sizeof *s.tri);
        compare(names[k]);
        compare_at(names[k], 4096, 4096);
        sl_atlas_free(atlas);
        sl_generated_free(mesh);
    }
}

/* Corners up to `reach` window sizes from the middle of the window, most triangles partly in it. */
static void triangles_around_the_window(test_rng *rng, int32_t nt, double reach)
{
    random_triangles(rng, nt, 0.5);
    for (int32_t t = 0; t < nt; t++) {
        const int32_t out = test_index(rng, 4); /* so many corners are anywhere, the rest stay near the window */
        for (int32_t k = 0; k < 3; k++) {
            double *p = s.uv + 6 * t + 2 * k;
            const double by = k < out ? reach : 0.6;
            p[0] = 0.5 + test_uniform(rng, -by, by);
            p[1] = 0.5 + test_uniform(rng, -by, by);
        }
    }
}

/* Triangles partly or wholly outside of the window, where the driver does not clip them: bit for bit. */
static void triangles_beyond_the_window_are_counted_alike(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0xbe0);
    static const int32_t size[][2] = {{1024, 1024}, {512, 256}, {1000, 600}, {34, 1024}};
    for (int k = 0; k < 4; k++) {
        for (int doublings = 1; doublings <= 4; doublings++) {
            triangles_around_the_window(&rng, 1500, 0.49 * (1 << doublings));
            compare_widened("triangles beyond the window", size[k][0], size[k][1], doublings);
        }
    }
}

/* How far texel centres in which the counts differ are from the nearest edge of a triangle that leaves the window, at
 * most [texels]; how many there are. */
static int64_t differ_by(const uint8_t *expected, const uint8_t *got, int32_t width, int32_t height, double *farthest)
{
    int64_t count = 0;
    for (int64_t i = 0; i < (int64_t)width * height; i++) {
        const double x = (double)(i % width) + 0.5, y = (double)(i / width) + 0.5;
        double nearest = HUGE_VAL;
        if (expected[i] == got[i]) {
            continue;
        }
        count++;
        for (int32_t t = 0; t < s.nt; t++) {
            for (int k = 0; k < 3; k++) {
                const double *p = s.uv + 2 * s.tri[3 * t + k], *q = s.uv + 2 * s.tri[3 * t + (k + 1) % 3];
                const double px = p[0] * width, py = p[1] * height, dx = q[0] * width - px, dy = q[1] * height - py;
                const double length = hypot(dx, dy);
                const double off = length > 0.0 ? fabs(dx * (y - py) - dy * (x - px)) / length : hypot(x - px, y - py);
                nearest = fmin(nearest, off);
            }
        }
        *farthest = fmax(*farthest, nearest);
    }
    return count;
}

/* Where the driver clips by the window it rounds the points of the clipped edges, and we do not: the counts differ in
 * few texels, all of them at an edge. (Triangles that do not leave the window are not clipped.) */
static void clipping_by_the_window_moves_edges_by_less_than_a_sub_pixel(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0xc11);
    const int32_t size = 512;
    static const double reach[] = {0.6, 2.0, 16.0, 1000.0, 16000.0};
    test_stencil *stencil = test_stencil_create(size, size, 0);
    if (stencil == NULL) {
        skip();
    }
    uint8_t *expected = sl_alloc(size * size, 1);
    assert_non_null(expected);
    const sl_edge_raster_def def = {.width = size, .height = size, .depth = 8};
    for (int k = 0; k < 5; k++) {
        sl_edge_raster *raster = NULL;
        double farthest = 0.0;
        triangles_around_the_window(&rng, 400, reach[k]);
        for (int32_t i = 0; i < 2 * s.nv; i++) {
            s.narrow[i] = (float)s.uv[i];
            s.uv[i] = s.narrow[i];
        }
        assert_true(test_stencil_draw(stencil, s.nv, s.narrow, s.nt, s.tri, expected));
        assert_int_equal(sl_edge_raster_create(s.nv, s.nt, s.tri, &def, &raster), SL_OK);
        assert_int_equal(sl_edge_raster_draw(raster, s.uv, NULL), SL_OK);
        const int64_t count = differ_by(expected, sl_edge_raster_counts8(raster), size, size, &farthest);
        if (count > size * size / 1000 || farthest >= 1.0 / 256.0) {
            print_message("corners up to %g windows away: %lld texels differ, up to %.4f texels from an edge\n",
                          reach[k], (long long)count, farthest);
        }
        assert_true(count <= size * size / 1000 && farthest < 1.0 / 256.0);
        sl_edge_raster_free(raster);
    }
    sl_free(expected);
    test_stencil_free(stencil);
}

/* What the window does not show at all counts nowhere, however far it is. */
static void triangles_outside_of_the_window_count_nothing(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0x07);
    const int32_t size = 256;
    test_stencil *stencil = test_stencil_create(size, size, 0);
    if (stencil == NULL) {
        skip();
    }
    static uint8_t expected[256 * 256];
    const sl_edge_raster_def def = {.width = size, .height = size, .depth = 8};
    sl_edge_raster *raster = NULL;
    random_triangles(&rng, 2000, 0.3);
    for (int32_t t = 0; t < s.nt; t++) {
        const int32_t axis = test_index(&rng, 2);
        const double far = exp(test_uniform(&rng, 0.1, 9.6)), side = test_index(&rng, 2) == 0 ? 1.0 : -1.0;
        for (int k = 0; k < 3; k++) {
            s.uv[6 * t + 2 * k + axis] += side * far;
            s.uv[6 * t + 2 * k + 1 - axis] *= test_uniform(&rng, -far, far);
        }
    }
    for (int32_t i = 0; i < 2 * s.nv; i++) {
        s.narrow[i] = (float)s.uv[i];
    }
    assert_true(test_stencil_draw(stencil, s.nv, s.narrow, s.nt, s.tri, expected));
    assert_int_equal(sl_edge_raster_create(s.nv, s.nt, s.tri, &def, &raster), SL_OK);
    assert_int_equal(sl_edge_raster_draw(raster, s.uv, NULL), SL_OK);
    assert_int_equal(sl_edge_raster_result(raster).covered, 0);
    assert_int_equal(differing(expected, sl_edge_raster_counts8(raster), size * size), 0);
    sl_edge_raster_free(raster);
    test_stencil_free(stencil);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(random_triangles_of_all_sizes_are_counted_alike),
        cmocka_unit_test(slivers_are_counted_alike),
        cmocka_unit_test(ties_and_degenerate_triangles_are_counted_alike),
        cmocka_unit_test(grids_flat_and_folded_are_counted_alike),
        cmocka_unit_test(disks_are_counted_alike_and_once),
        cmocka_unit_test(saturated_counts_are_alike),
        cmocka_unit_test(charts_of_an_atlas_are_counted_alike),
        cmocka_unit_test(triangles_beyond_the_window_are_counted_alike),
        cmocka_unit_test(clipping_by_the_window_moves_edges_by_less_than_a_sub_pixel),
        cmocka_unit_test(triangles_outside_of_the_window_count_nothing),
    };
    return cmocka_run_group_tests(tests, setup, teardown);
}
