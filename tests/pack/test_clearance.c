#include "pack/clearance.h"
#include "pack/outline.h"
#include "support/test_support.h"

#include <math.h>
#include <stdlib.h>

enum { CHARTS = 12, POINTS = 9 };

/* Fans around a centre. */
typedef struct fans {
    sl_pack_chart chart[CHARTS];
    double uv[CHARTS][2 * (POINTS + 1)];
    int32_t tri[CHARTS][3 * POINTS];
} fans;

static void random_fans(test_rng *rng, double spread, fans *f)
{
    for (int32_t c = 0; c < CHARTS; c++) {
        const double x = test_uniform(rng, 0, spread), y = test_uniform(rng, 0, spread);
        f->uv[c][0] = x;
        f->uv[c][1] = y;
        for (int32_t k = 0; k < POINTS; k++) {
            const double angle = 2.0 * TEST_PI * (k + test_uniform(rng, 0.2, 0.8)) / POINTS;
            const double radius = test_uniform(rng, 0.3, 1.0);
            f->uv[c][2 * k + 2] = x + radius * cos(angle);
            f->uv[c][2 * k + 3] = y + radius * sin(angle);
            f->tri[c][3 * k] = 0;
            f->tri[c][3 * k + 1] = 1 + k;
            f->tri[c][3 * k + 2] = 1 + (k + 1) % POINTS;
        }
        f->chart[c] = (sl_pack_chart){POINTS + 1, POINTS, f->uv[c], f->tri[c], 0.0};
    }
}

static double point_segment(const double p[2], const double a[2], const double b[2])
{
    const double d[2] = {b[0] - a[0], b[1] - a[1]};
    const double t = ((p[0] - a[0]) * d[0] + (p[1] - a[1]) * d[1]) / (d[0] * d[0] + d[1] * d[1]);
    const double s = fmin(1.0, fmax(0.0, t));
    return hypot(p[0] - a[0] - s * d[0], p[1] - a[1] - s * d[1]);
}

/* By points along one border against the other's edges: never below the true distance, and at most a step above it. */
static double sampled_distance(const fans *f, int32_t c, int32_t d, int32_t steps)
{
    double least = HUGE_VAL;
    for (int32_t i = 0; i < POINTS; i++) {
        const double *a = &f->uv[c][2 + 2 * i], *b = &f->uv[c][2 + 2 * ((i + 1) % POINTS)];
        for (int32_t s = 0; s < steps; s++) {
            const double t = (double)s / steps, p[2] = {a[0] + t * (b[0] - a[0]), a[1] + t * (b[1] - a[1])};
            for (int32_t j = 0; j < POINTS; j++) {
                least = fmin(least, point_segment(p, &f->uv[d][2 + 2 * j], &f->uv[d][2 + 2 * ((j + 1) % POINTS)]));
            }
        }
    }
    return least;
}

static void clearance_is_the_least_distance_of_two_outlines(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0xc1ea);
    for (int trial = 0; trial < 40 * test_multiplier(); trial++) {
        fans f;
        double found, near, expected = HUGE_VAL;
        random_fans(&rng, trial % 3 == 0 ? 9.0 : 25.0, &f);
        for (int32_t c = 0; c < CHARTS; c++) {
            for (int32_t d = 0; d < c; d++) {
                expected = fmin(expected, sampled_distance(&f, c, d, 100));
            }
        }
        assert_int_equal(sl_pack_clearance(CHARTS, f.chart, 100.0, &found), SL_OK);
        assert_true(found <= expected && found >= expected - 0.03);
        assert_int_equal(sl_pack_clearance(CHARTS, f.chart, 1.1 * found + 1e-3, &near), SL_OK);
        assert_true(near == found);
        assert_int_equal(sl_pack_clearance(CHARTS, f.chart, 0.5 * expected + 1e-3, &found), SL_OK);
        assert_true(expected < 0.1 || found == 0.5 * expected + 1e-3);
    }
}

static void charts_that_cross_have_no_clearance(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0xc1eb);
    fans f;
    double found;
    random_fans(&rng, 0.3, &f);
    assert_int_equal(sl_pack_clearance(CHARTS, f.chart, 3.0, &found), SL_OK);
    assert_true(found == 0.0);
    assert_int_equal(sl_pack_clearance(1, f.chart, 3.0, &found), SL_OK);
    assert_true(found == 3.0);
    assert_int_equal(sl_pack_clearance(0, NULL, 3.0, &found), SL_OK);
    assert_true(found == 3.0);
    f.uv[4][5] = INFINITY;
    assert_int_equal(sl_pack_clearance(CHARTS, f.chart, 3.0, &found), SL_BAD_INPUT);
}

/* Points of their own at every triangle, one triangle turned over: the outline is the border all the same. */
static void outlines_weld_equal_points_and_keep_folds(void **state)
{
    (void)state;
    const double uv[] = {0.1, 0.2, 1.3, 0.1,      1.1, 0.9, /**/ 0.1, 0.2, 1.1,
                         0.9, 0.2, 1.4, /**/ 0.1, 0.2, 1.1, 0.9,      0.7, 0.3};
    const int32_t tri[] = {0, 1, 2, 5, 4, 3, 6, 7, 8};
    const sl_pack_chart two = {6, 2, uv, tri, 0.0}, folded = {9, 3, uv, tri, 0.0};
    sl_outline outline;
    assert_int_equal(sl_outline_init(&two, &outline), SL_OK);
    assert_int_equal(outline.count, 4);
    assert_true(test_near(outline.area, 0.5 * (1.2 * 0.7 + 0.1 * 1.0) + 0.5 * (1.0 * 1.2 - 0.1 * 0.7), 1e-15));
    sl_outline_clear(&outline);
    assert_int_equal(sl_outline_init(&folded, &outline), SL_OK);
    assert_int_equal(outline.count, 7);
    sl_outline_clear(&outline);
}

/* Without area, but not without extent: nothing cancels out. */
static void outlines_of_flat_triangles_are_kept(void **state)
{
    (void)state;
    const double uv[] = {0.5, 0.25, 1.5, 0.75, 1.5, 0.75};
    const int32_t tri[] = {0, 1, 2};
    const sl_pack_chart needle = {3, 1, uv, tri, 0.0};
    sl_outline outline;
    assert_int_equal(sl_outline_init(&needle, &outline), SL_OK);
    assert_true(outline.count >= 2 && test_near(outline.radius, 0.5 * hypot(1.0, 0.5), 1e-15));
    assert_true(outline.area == 0.0);
    sl_outline_clear(&outline);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(clearance_is_the_least_distance_of_two_outlines),
        cmocka_unit_test(charts_that_cross_have_no_clearance),
        cmocka_unit_test(outlines_weld_equal_points_and_keep_folds),
        cmocka_unit_test(outlines_of_flat_triangles_are_kept),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
