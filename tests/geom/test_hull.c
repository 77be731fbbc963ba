/* Hulls and tightest rectangles against their definitions. */
#include "geom/hull.h"
#include "geom/predicates.h"
#include "support/test_support.h"

#include <math.h>

enum { MAX_POINTS = 64 };

/* A polygon whose corners are points, with every point left of or on every side and none but its corners' own positions
 * straight, is the hull: nothing else has these properties. */
static void check_hull(const double *point, int32_t n, const int32_t *hull, int32_t count)
{
    for (int32_t k = 0; k < count; k++) {
        const double *p = point + 2 * hull[k], *q = point + 2 * hull[(k + 1) % count];
        const double *r = point + 2 * hull[(k + 2) % count];
        assert_in_range(hull[k], 0, n - 1);
        assert_true(p[0] != q[0] || p[1] != q[1]);
        assert_true(count == 2 || sl_orient2d(p, q, r) > 0);
        assert_true(p[0] > point[2 * hull[0]] || (p[0] == point[2 * hull[0]] && p[1] >= point[2 * hull[0] + 1]));
        for (int32_t i = 0; i < n; i++) {
            assert_true(sl_orient2d(p, q, point + 2 * i) >= 0);
            assert_true(i >= hull[k] || point[2 * i] != p[0] || point[2 * i + 1] != p[1]);
        }
    }
}

static void hull_of_random_points_keeps_all_on_its_left(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0x4a11);
    for (int trial = 0; trial < 3000 * test_multiplier(); trial++) {
        double point[2 * MAX_POINTS];
        int32_t hull[MAX_POINTS], count = -1;
        const int32_t n = 3 + test_index(&rng, MAX_POINTS - 2);
        const bool lattice = trial % 2 == 0; /* a coarse lattice: repeated and collinear points */
        for (int32_t k = 0; k < 2 * n; k++) {
            point[k] = lattice ? 0.1 * test_index(&rng, 7) : test_uniform(&rng, -3.0, 5.0);
        }
        assert_int_equal(sl_convex_hull_2d(point, n, hull, &count), SL_OK);
        assert_true(count >= 1);
        if (count > 1) {
            check_hull(point, n, hull, count);
        }
    }
}

static void hull_of_points_on_a_circle_has_them_all(void **state)
{
    (void)state;
    double point[2 * MAX_POINTS];
    int32_t hull[MAX_POINTS], count = -1;
    for (int32_t i = 0; i < MAX_POINTS; i++) {
        const double turn = 2.0 * TEST_PI * ((i * 37) % MAX_POINTS + 0.3) / MAX_POINTS;
        point[2 * i] = 0.7 + 1.3 * cos(turn);
        point[2 * i + 1] = -0.4 + 1.3 * sin(turn);
    }
    assert_int_equal(sl_convex_hull_2d(point, MAX_POINTS, hull, &count), SL_OK);
    assert_int_equal(count, MAX_POINTS);
    check_hull(point, MAX_POINTS, hull, count);
}

static void hull_of_degenerate_points_has_two_corners_or_fewer(void **state)
{
    (void)state;
    const double line[] = {0.3, 0.9, 0.1, 0.3, 0.2, 0.6, 0.1, 0.3, 0.0, 0.0};
    const double same[] = {0.7, -0.2, 0.7, -0.2, 0.7, -0.2};
    const double zeros[] = {0.0, -0.0, -0.0, 0.0};
    int32_t hull[5], count = -1;
    assert_int_equal(sl_convex_hull_2d(line, 0, hull, &count), SL_OK);
    assert_int_equal(count, 0);
    assert_int_equal(sl_convex_hull_2d(same, 3, hull, &count), SL_OK);
    assert_int_equal(count, 1);
    assert_int_equal(hull[0], 0);
    assert_int_equal(sl_convex_hull_2d(zeros, 2, hull, &count), SL_OK);
    assert_int_equal(count, 1);
    const double upright[] = {0.3, 0.9, 0.3, 0.1, 0.3, 0.4};
    assert_int_equal(sl_convex_hull_2d(upright, 3, hull, &count), SL_OK);
    assert_int_equal(count, 2);
    assert_int_equal(hull[0], 1);
    assert_int_equal(hull[1], 0);
    assert_int_equal(sl_convex_hull_2d(line, 5, hull, &count), SL_OK);
    check_hull(line, 5, hull, count);
}

/* Extents about the direction (x, y) of unit length. */
static void extents(const double *point, int32_t n, double x, double y, double low[2], double size[2])
{
    double high[2] = {-INFINITY, -INFINITY};
    low[0] = low[1] = INFINITY;
    for (int32_t i = 0; i < n; i++) {
        const double along[2] = {point[2 * i] * x + point[2 * i + 1] * y, point[2 * i + 1] * x - point[2 * i] * y};
        for (int k = 0; k < 2; k++) {
            low[k] = fmin(low[k], along[k]);
            high[k] = fmax(high[k], along[k]);
        }
    }
    size[0] = high[0] - low[0];
    size[1] = high[1] - low[1];
}

/* A tightest rectangle has a side on a hull edge, so trying the directions of all pairs of points finds it. */
static double area_by_all_pairs(const double *point, int32_t n)
{
    double best = INFINITY;
    for (int32_t i = 0; i < n; i++) {
        for (int32_t j = 0; j < i; j++) {
            const double x = point[2 * i] - point[2 * j], y = point[2 * i + 1] - point[2 * j + 1], r = hypot(x, y);
            double low[2], size[2];
            if (r > 0.0) {
                extents(point, n, x / r, y / r, low, size);
                best = fmin(best, size[0] * size[1]);
            }
        }
    }
    return best;
}

static void rectangle_has_the_smallest_area_and_holds_all_points(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0x4ec7);
    for (int trial = 0; trial < 2000 * test_multiplier(); trial++) {
        double point[2 * MAX_POINTS], low[2], size[2];
        const int32_t n = 3 + test_index(&rng, 20);
        const double stretch = test_uniform(&rng, 0.01, 3.0), turn = test_uniform(&rng, 0.0, 2.0 * TEST_PI);
        for (int32_t i = 0; i < n; i++) {
            const double x = test_uniform(&rng, -1.0, 1.0), y = stretch * test_uniform(&rng, -1.0, 1.0);
            point[2 * i] = 0.3 + x * cos(turn) - y * sin(turn);
            point[2 * i + 1] = -0.6 + x * sin(turn) + y * cos(turn);
        }
        sl_rectangle box;
        assert_int_equal(sl_min_area_rectangle(point, n, &box), SL_OK);
        assert_true(test_near_rel(box.width * box.height, area_by_all_pairs(point, n), 64 * TEST_EPS));
        assert_true(box.angle >= 0.0 && box.angle < TEST_PI / 2.0);
        assert_true(test_near(cos(box.angle), box.axis[0], 4 * TEST_EPS));
        assert_true(test_near(sin(box.angle), box.axis[1], 4 * TEST_EPS));
        extents(point, n, box.axis[0], box.axis[1], low, size);
        assert_true(test_near(box.low[0], low[0], 16 * TEST_EPS) && test_near(box.low[1], low[1], 16 * TEST_EPS));
        assert_true(test_near(box.width, size[0], 16 * TEST_EPS) && test_near(box.height, size[1], 16 * TEST_EPS));
    }
}

static void rectangle_of_a_turned_rectangle_is_that_rectangle(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0x7074);
    for (int trial = 0; trial < 500 * test_multiplier(); trial++) {
        const double angle = test_uniform(&rng, 0.001, TEST_PI / 2.0 - 0.001);
        const double w = test_uniform(&rng, 0.5, 2.0), h = test_uniform(&rng, 0.1, 0.4);
        const int quarter = test_index(&rng, 4); /* names the corners differently: the answer must not change */
        double point[40];
        for (int i = 0; i < 20; i++) { /* four corners, then points inside */
            const int k = (i + quarter) % 4;
            const double x = i < 4 ? (k == 1 || k == 2 ? w : 0.0) : test_uniform(&rng, 0.1 * w, 0.9 * w);
            const double y = i < 4 ? (k >= 2 ? h : 0.0) : test_uniform(&rng, 0.1 * h, 0.9 * h);
            point[2 * i] = x * cos(angle) - y * sin(angle);
            point[2 * i + 1] = x * sin(angle) + y * cos(angle);
        }
        sl_rectangle box;
        assert_int_equal(sl_min_area_rectangle(point, 20, &box), SL_OK);
        assert_true(test_near(box.angle, angle, 64 * TEST_EPS));
        assert_true(test_near(box.width, w, 64 * TEST_EPS) && test_near(box.height, h, 64 * TEST_EPS));
        assert_true(test_near(box.low[0], 0.0, 64 * TEST_EPS) && test_near(box.low[1], 0.0, 64 * TEST_EPS));
    }
}

static void rectangle_of_collinear_points_is_flat(void **state)
{
    (void)state;
    const double line[] = {0.5, 1.0, 0.125, 0.25, 0.25, 0.5};
    const double one[] = {0.3, -0.7};
    sl_rectangle box;
    assert_int_equal(sl_min_area_rectangle(line, 3, &box), SL_OK);
    assert_true(test_near(fmin(box.width, box.height), 0.0, 4 * TEST_EPS));
    assert_true(test_near(fmax(box.width, box.height), hypot(0.375, 0.75), 4 * TEST_EPS));
    assert_int_equal(sl_min_area_rectangle(one, 1, &box), SL_OK);
    assert_true(box.width == 0.0 && box.height == 0.0 && box.low[0] == 0.3 && box.low[1] == -0.7);
}

static void hull_and_rectangle_refuse_what_is_not_finite(void **state)
{
    (void)state;
    const double bad[][6] = {{0.1, 0.2, NAN, 0.4, 0.7, 0.3}, {0.1, 0.2, 0.6, 0.4, 0.7, -INFINITY}};
    int32_t hull[3], count;
    sl_rectangle box;
    for (int k = 0; k < 2; k++) {
        assert_int_equal(sl_convex_hull_2d(bad[k], 3, hull, &count), SL_BAD_INPUT);
        assert_int_equal(sl_min_area_rectangle(bad[k], 3, &box), SL_BAD_INPUT);
    }
    assert_int_equal(sl_min_area_rectangle(bad[0], 0, &box), SL_BAD_INPUT);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(hull_of_random_points_keeps_all_on_its_left),
        cmocka_unit_test(hull_of_points_on_a_circle_has_them_all),
        cmocka_unit_test(hull_of_degenerate_points_has_two_corners_or_fewer),
        cmocka_unit_test(rectangle_has_the_smallest_area_and_holds_all_points),
        cmocka_unit_test(rectangle_of_a_turned_rectangle_is_that_rectangle),
        cmocka_unit_test(rectangle_of_collinear_points_is_flat),
        cmocka_unit_test(hull_and_rectangle_refuse_what_is_not_finite),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
