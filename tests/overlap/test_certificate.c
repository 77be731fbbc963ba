/* The border certificate against all pairs of edges. */
#include "overlap/certificate.h"

#include "base/memory.h"
#include "geom/predicates.h"
#include "support/test_support.h"

#include <math.h>
#include <string.h>

enum { MAX_BORDER = 4000 };

static double uv[2 * MAX_BORDER];
static int32_t border[2 * MAX_BORDER];

/* border = the closed polygon 0, 1, ..., n - 1, its edges shuffled and turned at random. */
static void close_polygon(test_rng *rng, int32_t n)
{
    for (int32_t b = 0; b < n; b++) {
        const int32_t to = test_index(rng, b + 1), turn = test_index(rng, 2);
        border[2 * b] = border[2 * to];
        border[2 * b + 1] = border[2 * to + 1];
        border[2 * to + turn] = b;
        border[2 * to + 1 - turn] = (b + 1) % n;
    }
}

/* What the two edges have in common beyond the ends they share by index: the ends themselves of a corner are all that
 * is allowed. */
static bool clash_by_definition(int32_t i, int32_t j)
{
    const int32_t *e = border + 2 * i, *f = border + 2 * j;
    const bool adjacent = e[0] == f[0] || e[0] == f[1] || e[1] == f[0] || e[1] == f[1];
    const sl_crossing crossing = sl_segments_cross(uv + 2 * e[0], uv + 2 * e[1], uv + 2 * f[0], uv + 2 * f[1]);
    return adjacent ? crossing == SL_CROSS_OVERLAP : crossing != SL_CROSS_NONE;
}

/* Returns the number of clashes, not cut off. */
static int32_t check_against_all_pairs(int32_t n)
{
    sl_certificate found;
    int32_t count = 0, first[2] = {-1, -1};
    for (int32_t i = 0; i < n; i++) {
        for (int32_t j = i + 1; j < n; j++) {
            if (clash_by_definition(i, j)) {
                first[0] = count == 0 ? i : first[0];
                first[1] = count == 0 ? j : first[1];
                count++;
            }
        }
    }
    assert_int_equal(sl_certify_embedding(uv, 0, NULL, n, border, &found), SL_OK);
    assert_int_equal(found.border_crossings,
                     count < SL_CERTIFICATE_MAX_CROSSINGS ? count : SL_CERTIFICATE_MAX_CROSSINGS);
    assert_int_equal(found.first_edge[0], first[0]);
    assert_int_equal(found.first_edge[1], first[1]);
    assert_int_equal(found.embedded, count == 0);
    return count;
}

static void random_polygons_agree_with_all_pairs(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0x9014);
    for (int trial = 0; trial < 300 * test_multiplier(); trial++) {
        const int32_t n = 3 + test_index(&rng, 60);
        const double size = ldexp(1.0, test_index(&rng, 40) - 20);
        for (int32_t v = 0; v < n; v++) {
            uv[2 * v] = size * test_uniform(&rng, -1.0, 1.0);
            uv[2 * v + 1] = size * test_uniform(&rng, 5.0, 5.3);
        }
        close_polygon(&rng, n);
        (void)check_against_all_pairs(n);
    }
}

/* Whole coordinates in a small box: touches, repeated points and overlaps abound. */
static void polygons_on_a_lattice_agree_with_all_pairs(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0x1a77);
    for (int trial = 0; trial < 2000 * test_multiplier(); trial++) {
        const int32_t n = 3 + test_index(&rng, 10), box = 2 + test_index(&rng, 12);
        for (int32_t v = 0; v < 2 * n; v++) {
            uv[v] = test_index(&rng, box) - 1.0;
        }
        close_polygon(&rng, n);
        (void)check_against_all_pairs(n);
    }
}

/* Star-shaped about the origin: simple whatever the radii, though these differ a thousandfold. */
static void star_shaped_polygons_are_simple_until_two_corners_are_swapped(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0x57a4);
    for (int trial = 0; trial < 100 * test_multiplier(); trial++) {
        const int32_t n = 8 + test_index(&rng, 300);
        for (int32_t v = 0; v < n; v++) {
            const double turn = 2.0 * TEST_PI * (v + test_uniform(&rng, 0.0, 0.9)) / n;
            const double radius = pow(10.0, test_uniform(&rng, -3.0, 0.0));
            uv[2 * v] = radius * cos(turn);
            uv[2 * v + 1] = radius * sin(turn);
        }
        close_polygon(&rng, n);
        assert_int_equal(check_against_all_pairs(n), 0);
        const int32_t v = test_index(&rng, n - 3);
        for (int k = 0; k < 2; k++) { /* the middle two of four corners in turn */
            const double held = uv[2 * (v + 1) + k];
            uv[2 * (v + 1) + k] = uv[2 * (v + 2) + k];
            uv[2 * (v + 2) + k] = held;
        }
        (void)check_against_all_pairs(n);
    }
}

/* A band wound `turns` times about a point, the gap between two turns `gap` of the pitch. */
static int32_t spiral(int32_t half, double turns, double gap)
{
    for (int32_t s = 0; s < half; s++) {
        const double t = (double)s / (half - 1), turn = 2.0 * TEST_PI * turns * t, pitch = 0.45 / (turns + 2.0);
        const double inner = pitch * (1.0 + turns * t), outer = inner + (1.0 - gap) * pitch;
        uv[2 * s] = 0.5 + outer * cos(turn);
        uv[2 * s + 1] = 0.5 + outer * sin(turn);
        uv[2 * (2 * half - 1 - s)] = 0.5 + inner * cos(turn);
        uv[2 * (2 * half - 1 - s) + 1] = 0.5 + inner * sin(turn);
    }
    return 2 * half;
}

static void spirals_are_simple_until_their_turns_meet(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0x5914);
    for (int trial = 0; trial < 6 * test_multiplier(); trial++) {
        const double turns = 2.0 + 3.0 * trial + test_uniform(&rng, 0.0, 0.9);
        const int32_t n = spiral(300 + 100 * trial, turns, 0.3);
        close_polygon(&rng, n);
        assert_int_equal(check_against_all_pairs(n), 0);
        (void)spiral(n / 2, turns, -0.2);
        assert_true(check_against_all_pairs(n) > 0);
    }
}

/* Two combs with interlocking teeth; one tooth is then made just long enough. */
static void a_tooth_that_touches_the_other_side_is_found(void **state)
{
    (void)state;
    enum { TEETH = 40 };
    test_rng rng = test_rng_seed(0x7007);
    int32_t n = 0;
    const double top = 1.75;
    for (int32_t t = 0; t < TEETH; t++) { /* the lower side: teeth upward */
        const double point[4][2] = {{t, 0.0}, {t + 0.375, 0.0}, {t + 0.5, 1.5 + 0.125 * (t % 2)}, {t + 0.625, 0.0}};
        memcpy(uv + 2 * n, point, sizeof point);
        n += 4;
    }
    const double rim[4][2] = {{TEETH, 0.0}, {TEETH + 0.25, 0.875}, {TEETH, top}, {0.0, top}};
    memcpy(uv + 2 * n, rim, sizeof rim);
    n += 4;
    close_polygon(&rng, n);
    assert_int_equal(check_against_all_pairs(n), 0);
    const int32_t tip = 4 * test_index(&rng, TEETH) + 2;
    uv[2 * tip + 1] = nextafter(top, 0.0);
    assert_int_equal(check_against_all_pairs(n), 0);
    uv[2 * tip + 1] = top; /* both edges of the tooth touch the upper side */
    assert_int_equal(check_against_all_pairs(n), 2);
    uv[2 * tip + 1] = nextafter(top, 2.0);
    assert_int_equal(check_against_all_pairs(n), 2);
}

static void neighbours_that_fold_back_overlap(void **state)
{
    (void)state;
    const double folded[] = {0.0, 0.0, 3.0, 1.0, 1.5, 0.5, 0.25, 2.0};
    const double straight[] = {0.0, 0.0, 1.5, 0.5, 3.0, 1.0, 0.25, 2.0};
    const int32_t closed[] = {0, 1, 1, 2, 2, 3, 3, 0};
    sl_certificate found;
    assert_int_equal(sl_certify_embedding(straight, 0, NULL, 4, closed, &found), SL_OK);
    assert_true(found.embedded);
    assert_int_equal(sl_certify_embedding(folded, 0, NULL, 4, closed, &found), SL_OK);
    assert_int_equal(found.border_crossings, 2); /* with its neighbour, and corner 2 touches edge 0 by edge 2 */
    assert_int_equal(found.first_edge[0], 0);
    assert_int_equal(found.first_edge[1], 1);
}

static void counting_stops_at_the_limit(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0x11a1);
    for (int32_t v = 0; v < 2 * MAX_BORDER; v++) {
        uv[v] = test_uniform(&rng, 0.0, 1.0);
    }
    close_polygon(&rng, 600);
    assert_true(check_against_all_pairs(600) > 10 * SL_CERTIFICATE_MAX_CROSSINGS);
}

static void triangles_are_judged_by_exact_orientation(void **state)
{
    (void)state;
    const double point[] = {0.1, 0.1, 0.9, 0.3, 0.7, 0.8, 0.2, 0.6, 0.3, 0.3, 0.7, 0.7};
    const int32_t good[] = {0, 1, 2, 0, 2, 3}, closed[] = {0, 1, 1, 2, 2, 3, 3, 0};
    const int32_t mixed[] = {0, 1, 2, 0, 3, 2, 0, 4, 5, 2, 1, 0}; /* points 0, 4, 5 are on the line y = x */
    sl_certificate found;
    assert_int_equal(sl_certify_embedding(point, 2, good, 4, closed, &found), SL_OK);
    assert_true(found.embedded && found.flipped == 0 && found.degenerate == 0 && found.border_crossings == 0);
    assert_true(found.first_edge[0] == -1 && found.first_edge[1] == -1);
    assert_int_equal(sl_certify_embedding(point, 4, mixed, 4, closed, &found), SL_OK);
    assert_true(!found.embedded && found.flipped == 2 && found.degenerate == 1 && found.border_crossings == 0);
    assert_int_equal(sl_certify_embedding(point, 3, mixed + 3, 4, closed, &found), SL_OK);
    assert_false(found.embedded);
}

static void coordinates_of_any_finite_size_are_certified(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0xb16);
    static const double sizes[] = {1e-310, 1e-160, 1e150, 1.7e308, 0.0};
    for (int k = 0; k < 5; k++) {
        for (int trial = 0; trial < 20; trial++) {
            const int32_t n = 3 + test_index(&rng, 20);
            for (int32_t v = 0; v < 2 * n; v++) {
                uv[v] = sizes[k] * test_uniform(&rng, -1.0, 1.0);
            }
            close_polygon(&rng, n);
            (void)check_against_all_pairs(n);
        }
    }
}

static void a_long_edge_beside_many_short_ones_is_met(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0x1049);
    const int32_t n = 1500;
    for (int32_t v = 0; v < n; v++) { /* a fine row with corners just above the chord that closes it */
        uv[2 * v] = v + test_uniform(&rng, 0.0, 0.4);
        uv[2 * v + 1] = 0.3 * uv[2 * v] + (v > 0 && v < n - 1 ? test_uniform(&rng, 1e-9, 1e-3) : 0.0);
    }
    close_polygon(&rng, n);
    assert_int_equal(check_against_all_pairs(n), 0);
    uv[2 * 700 + 1] -= 0.01;
    assert_int_equal(check_against_all_pairs(n), 2);
}

static void what_is_not_finite_is_refused(void **state)
{
    (void)state;
    static const double bad[] = {NAN, INFINITY, -INFINITY};
    const int32_t tri[] = {0, 1, 2}, closed[] = {0, 1, 1, 2, 2, 0};
    for (int k = 0; k < 3; k++) {
        double point[] = {0.1, 0.2, 0.8, 0.3, 0.4, 0.9};
        point[2 * k + 1] = bad[k];
        sl_certificate found = {.flipped = 77};
        assert_int_equal(sl_certify_embedding(point, 1, tri, 0, NULL, &found), SL_BAD_INPUT);
        assert_int_equal(sl_certify_embedding(point, 0, NULL, 3, closed, &found), SL_BAD_INPUT);
        assert_int_equal(found.flipped, 77);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(random_polygons_agree_with_all_pairs),
        cmocka_unit_test(polygons_on_a_lattice_agree_with_all_pairs),
        cmocka_unit_test(star_shaped_polygons_are_simple_until_two_corners_are_swapped),
        cmocka_unit_test(spirals_are_simple_until_their_turns_meet),
        cmocka_unit_test(a_tooth_that_touches_the_other_side_is_found),
        cmocka_unit_test(neighbours_that_fold_back_overlap),
        cmocka_unit_test(counting_stops_at_the_limit),
        cmocka_unit_test(triangles_are_judged_by_exact_orientation),
        cmocka_unit_test(coordinates_of_any_finite_size_are_certified),
        cmocka_unit_test(a_long_edge_beside_many_short_ones_is_met),
        cmocka_unit_test(what_is_not_finite_is_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
