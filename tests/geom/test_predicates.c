/* Orientation and crossing against integer arithmetic wide enough to be exact. */
#include "geom/predicates.h"
#include "support/test_support.h"

#include <math.h>

__extension__ typedef __int128 wide;

static int sign_of(wide v)
{
    return (v > 0) - (v < 0);
}

/* Points with integer coordinates below 2^58: the determinant fits 118 bits. */
static int integer_orientation(int64_t p[3][2])
{
    const wide left = (wide)(p[0][0] - p[2][0]) * (p[1][1] - p[2][1]);
    const wide right = (wide)(p[0][1] - p[2][1]) * (p[1][0] - p[2][0]);
    return sign_of(left - right);
}

static int64_t random_integer(test_rng *rng, int bits)
{
    const int64_t magnitude = (int64_t)(test_bits(rng) >> (64 - bits));
    return (test_bits(rng) & 1) != 0 ? magnitude : -magnitude;
}

/* The orientation of integer points whose x and y were scaled by powers of two. */
static int scaled_orientation(int64_t p[3][2], int ex, int ey)
{
    double q[3][2];
    for (int k = 0; k < 3; k++) {
        q[k][0] = ldexp((double)p[k][0], ex);
        q[k][1] = ldexp((double)p[k][1], ey);
    }
    return sl_orient2d(q[0], q[1], q[2]);
}

static void orientation_of_random_integer_points_is_exact(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0x0ead1);
    for (int trial = 0; trial < 200000 * test_multiplier(); trial++) {
        int64_t p[3][2];
        for (int k = 0; k < 3; k++) {
            p[k][0] = random_integer(&rng, 1 + test_index(&rng, 53));
            p[k][1] = random_integer(&rng, 1 + test_index(&rng, 53));
        }
        assert_int_equal(scaled_orientation(p, 0, 0), integer_orientation(p));
    }
}

/* Points a + 0 g, a + i g, a + j g of a line, one of them moved by at most a unit: the filter cannot tell. */
static void near_collinear(test_rng *rng, int64_t p[3][2])
{
    const int bits = 20 + test_index(rng, 12);
    const int64_t multiple[3] = {0, random_integer(rng, 20), random_integer(rng, 20)};
    const int moved = test_index(rng, 3);
    for (int k = 0; k < 2; k++) {
        const int64_t start = random_integer(rng, 52), g = random_integer(rng, bits);
        for (int i = 0; i < 3; i++) {
            p[i][k] = start + multiple[i] * g + (i == moved ? test_index(rng, 3) - 1 : 0);
        }
    }
}

static void orientation_of_nearly_collinear_points_is_exact_at_every_scale(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0xc011);
    static const int exponents[] = {0, -53, 300, -400, -575, -1074, 940}; /* products and numbers that underflow */
    int seen[3] = {0};
    for (int trial = 0; trial < 100000 * test_multiplier(); trial++) {
        int64_t p[3][2];
        near_collinear(&rng, p);
        const int expected = integer_orientation(p);
        const int ex = exponents[test_index(&rng, 7)], ey = exponents[test_index(&rng, 7)];
        assert_int_equal(scaled_orientation(p, ex, ey), expected);
        seen[expected + 1]++;
    }
    assert_true(seen[0] > 1000 && seen[1] > 1000 && seen[2] > 1000);
}

/* The filter may be unsure but never wrong; where it is unsure, the exact sign stands in. */
static void the_filter_is_unsure_rather_than_wrong(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0xf117);
    int sure_of = 0, unsure = 0;
    for (int trial = 0; trial < 200000 * test_multiplier(); trial++) {
        int64_t p[3][2];
        double q[3][2];
        if (trial % 4 != 0) {
            near_collinear(&rng, p);
        }
        for (int k = 0; k < 3; k++) {
            for (int a = 0; a < 2; a++) {
                p[k][a] = trial % 4 == 0 ? random_integer(&rng, 53) : p[k][a];
                q[k][a] = ldexp((double)p[k][a], trial % 3 == 0 ? -520 : -53); /* products that underflow, too */
            }
        }
        const int expected = integer_orientation(p), sure = sl_orient2d_sure(q[0], q[1], q[2]);
        assert_true(sure == 0 || sure == expected);
        assert_int_equal(sl_orient2d_quick(q[0], q[1], q[2]), expected);
        sure_of += sure != 0;
        unsure += sure == 0 && expected != 0;
    }
    assert_true(sure_of > 1000 && unsure > 1000);
    const double bad[3][2] = {{0.1, 0.2}, {NAN, 0.7}, {0.4, INFINITY}}, good[2] = {0.9, -0.4};
    assert_int_equal(sl_orient2d_sure(bad[0], bad[1], good), 0);
    assert_int_equal(sl_orient2d_sure(bad[2], good, bad[0]), 0);
    assert_int_equal(sl_orient2d_sure(good, bad[0], bad[2]), 0);
}

/* Kettner et al. 2008, "Classroom examples of robustness problems": points one ulp apart beside the line y = x. */
static void orientation_on_a_lattice_of_ulps_is_exact(void **state)
{
    (void)state;
    int disagree = 0;
    for (int64_t i = 0; i < 256; i++) {
        for (int64_t j = 0; j < 256; j++) {
            int64_t p[3][2] = {{(INT64_C(1) << 52) + i, (INT64_C(1) << 52) + j},
                               {INT64_C(12) << 53, INT64_C(12) << 53},
                               {INT64_C(24) << 53, INT64_C(24) << 53}};
            disagree += scaled_orientation(p, -53, -53) != integer_orientation(p);
        }
    }
    assert_int_equal(disagree, 0);
}

/* With a at the origin the sign is that of bx cy - by cx, whatever powers of two b and c carry. */
static void orientation_is_exact_for_points_of_very_different_size(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0xd1ff);
    for (int trial = 0; trial < 50000 * test_multiplier(); trial++) {
        const int64_t bx = random_integer(&rng, 50), by = random_integer(&rng, 50);
        const int64_t cx = bx + test_index(&rng, 3) - 1, cy = by + test_index(&rng, 3) - 1;
        const int eb = test_index(&rng, 800) - 400, ec = test_index(&rng, 800) - 400;
        const double a[2] = {0.0, 0.0};
        const double b[2] = {ldexp((double)bx, eb), ldexp((double)by, eb)};
        const double c[2] = {ldexp((double)cx, ec), ldexp((double)cy, ec)};
        assert_int_equal(sl_orient2d(a, b, c), sign_of((wide)bx * cy - (wide)by * cx));
    }
}

static void orientation_changes_sign_when_two_points_are_swapped(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0x5a5a);
    for (int trial = 0; trial < 50000 * test_multiplier(); trial++) {
        double a[2], b[2], c[2];
        for (int k = 0; k < 2; k++) {
            a[k] = test_uniform(&rng, -1.0, 1.0);
            b[k] = test_uniform(&rng, -1.0, 1.0);
            c[k] = a[k] + (b[k] - a[k]) * 0.25; /* collinear but for rounding */
        }
        const int s = sl_orient2d(a, b, c);
        assert_int_equal(sl_orient2d(b, c, a), s);
        assert_int_equal(sl_orient2d(c, a, b), s);
        assert_int_equal(sl_orient2d(b, a, c), -s);
        assert_int_equal(sl_orient2d(a, c, b), -s);
    }
}

typedef struct lattice_point {
    int64_t x, y;
} lattice_point;

static int64_t cross(lattice_point o, lattice_point p, lattice_point q)
{
    return (p.x - o.x) * (q.y - o.y) - (p.y - o.y) * (q.x - o.x);
}

static bool on_segment(lattice_point a, lattice_point b, lattice_point p)
{
    return cross(a, b, p) == 0 && (p.x - a.x) * (p.x - b.x) + (p.y - a.y) * (p.y - b.y) <= 0;
}

static bool same_point(lattice_point p, lattice_point q)
{
    return p.x == q.x && p.y == q.y;
}

/* Parallel or pointlike segments: count the different ends that both have. */
static sl_crossing crossing_of_parallels(lattice_point a, lattice_point b, lattice_point c, lattice_point d)
{
    const lattice_point end[4] = {a, b, c, d};
    int common = 0;
    for (int k = 0; k < 4; k++) {
        bool fresh = on_segment(a, b, end[k]) && on_segment(c, d, end[k]);
        for (int m = 0; m < k; m++) {
            fresh = fresh && !same_point(end[m], end[k]);
        }
        common += fresh;
    }
    return common == 0 ? SL_CROSS_NONE : common == 1 ? SL_CROSS_TOUCH : SL_CROSS_OVERLAP;
}

/* By the parameters a + t (b - a) = c + u (d - c), as fractions. */
static sl_crossing crossing_by_fractions(lattice_point a, lattice_point b, lattice_point c, lattice_point d)
{
    int64_t den = (b.x - a.x) * (d.y - c.y) - (b.y - a.y) * (d.x - c.x);
    if (den == 0) {
        return crossing_of_parallels(a, b, c, d);
    }
    int64_t t = (c.x - a.x) * (d.y - c.y) - (c.y - a.y) * (d.x - c.x);
    int64_t u = (c.x - a.x) * (b.y - a.y) - (c.y - a.y) * (b.x - a.x);
    if (den < 0) {
        den = -den;
        t = -t;
        u = -u;
    }
    if (t < 0 || t > den || u < 0 || u > den) {
        return SL_CROSS_NONE;
    }
    return t > 0 && t < den && u > 0 && u < den ? SL_CROSS_PROPER : SL_CROSS_TOUCH;
}

/* An exact affine map with entries of 40 bits: what was on a line stays on it, but no difference is a round number. */
static void skew(lattice_point p, double out[2])
{
    out[0] = (double)(p.x * INT64_C(1048581234567) - p.y * INT64_C(733212345671) + INT64_C(98765432123)) * 0x1p-40;
    out[1] = (double)(p.x * INT64_C(512345678913) + p.y * INT64_C(971234567899) - INT64_C(12345678901)) * 0x1p-40;
}

static void crossing_of_all_segments_on_a_small_lattice_is_right(void **state)
{
    (void)state;
    int seen[4] = {0};
    for (int code = 0; code < 1 << 16; code++) {
        lattice_point p[4];
        double q[4][2];
        for (int k = 0; k < 4; k++) {
            p[k] = (lattice_point){code >> 4 * k & 3, code >> (4 * k + 2) & 3};
            skew(p[k], q[k]);
        }
        const sl_crossing expected = crossing_by_fractions(p[0], p[1], p[2], p[3]);
        assert_int_equal(sl_segments_cross(q[0], q[1], q[2], q[3]), expected);
        seen[expected]++;
    }
    assert_true(seen[SL_CROSS_TOUCH] > 1000 && seen[SL_CROSS_PROPER] > 1000 && seen[SL_CROSS_OVERLAP] > 1000);
}

static void crossing_of_random_segments_is_right(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0x5e65);
    for (int trial = 0; trial < 100000 * test_multiplier(); trial++) {
        lattice_point p[4];
        double q[4][2];
        for (int k = 0; k < 4; k++) {
            p[k] = (lattice_point){test_index(&rng, 12), test_index(&rng, 12)};
            skew(p[k], q[k]);
        }
        assert_int_equal(sl_segments_cross(q[0], q[1], q[2], q[3]), crossing_by_fractions(p[0], p[1], p[2], p[3]));
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(orientation_of_random_integer_points_is_exact),
        cmocka_unit_test(orientation_of_nearly_collinear_points_is_exact_at_every_scale),
        cmocka_unit_test(the_filter_is_unsure_rather_than_wrong),
        cmocka_unit_test(orientation_on_a_lattice_of_ulps_is_exact),
        cmocka_unit_test(orientation_is_exact_for_points_of_very_different_size),
        cmocka_unit_test(orientation_changes_sign_when_two_points_are_swapped),
        cmocka_unit_test(crossing_of_all_segments_on_a_small_lattice_is_right),
        cmocka_unit_test(crossing_of_random_segments_is_right),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
