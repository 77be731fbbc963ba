/* The exact test against all pairs, and pairs against clipping in fractions. */
#include "overlap/exact.h"

#include "base/memory.h"
#include "geom/predicates.h"
#include "support/test_support.h"

#include <math.h>
#include <string.h>
#include <time.h>

enum { MOST = 3000 };

static double uv[6 * MOST];
static int32_t tri[3 * MOST];

static int64_t gcd(int64_t a, int64_t b)
{
    while (b != 0) {
        const int64_t r = a % b;
        a = b;
        b = r;
    }
    return a < 0 ? -a : a;
}

/* A point (x / w, y / w) with w > 0, in lowest terms. */
typedef struct fraction_point {
    int64_t x, y, w;
} fraction_point;

static fraction_point lowest(int64_t x, int64_t y, int64_t w)
{
    const int64_t g = gcd(gcd(x, y), w) * (w < 0 ? -1 : 1);
    return (fraction_point){x / g, y / g, w / g};
}

static int64_t side_of(const int64_t a[2], const int64_t b[2], fraction_point p)
{
    return (b[0] - a[0]) * (p.y - a[1] * p.w) - (b[1] - a[1]) * (p.x - a[0] * p.w);
}

static int64_t area_sign(fraction_point a, fraction_point b, fraction_point c)
{
    return a.x * (b.y * c.w - c.y * b.w) - a.y * (b.x * c.w - c.x * b.w) + a.w * (b.x * c.y - c.x * b.y);
}

/* Clips triangle p by the edges of q (both counter-clockwise, small integers): is what is left more than a segment? */
static bool overlap_by_clipping(int64_t p[3][2], int64_t q[3][2])
{
    fraction_point now[12], next[12];
    int n = 3;
    for (int k = 0; k < 3; k++) {
        now[k] = (fraction_point){p[k][0], p[k][1], 1};
    }
    for (int e = 0; e < 3; e++) {
        int m = 0;
        for (int k = 0; k < n; k++) {
            const fraction_point a = now[k], b = now[(k + 1) % n];
            const int64_t sa = side_of(q[e], q[(e + 1) % 3], a), sb = side_of(q[e], q[(e + 1) % 3], b);
            if (sa >= 0) {
                next[m++] = a;
            }
            if ((sa > 0 && sb < 0) || (sa < 0 && sb > 0)) {
                next[m++] = lowest(b.x * sa - a.x * sb, b.y * sa - a.y * sb, b.w * sa - a.w * sb);
            }
        }
        memcpy(now, next, sizeof now);
        n = m;
    }
    for (int k = 2; k < n; k++) {
        if (area_sign(now[0], now[k - 1], now[k]) != 0) {
            return true;
        }
    }
    return false;
}

/* An exact affine map with entries of 40 bits: collinear stays collinear, but no difference is a round number. */
static void skew(const int64_t p[2], double out[2])
{
    out[0] = (double)(p[0] * INT64_C(1048581234567) - p[1] * INT64_C(733212345671) + INT64_C(98765432123)) * 0x1p-40;
    out[1] = (double)(p[0] * INT64_C(512345678913) + p[1] * INT64_C(971234567899) - INT64_C(12345678901)) * 0x1p-40;
}

static void random_lattice_triangle(test_rng *rng, int64_t p[3][2], int32_t box)
{
    int64_t area;
    do {
        for (int k = 0; k < 3; k++) {
            p[k][0] = test_index(rng, box);
            p[k][1] = test_index(rng, box);
        }
        area = (p[1][0] - p[0][0]) * (p[2][1] - p[0][1]) - (p[2][0] - p[0][0]) * (p[1][1] - p[0][1]);
    } while (area <= 0);
}

static void pairs_of_triangles_are_ordered_as_clipping_in_fractions_says(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0xc11b);
    int seen[4] = {0};
    for (int trial = 0; trial < 100000 * test_multiplier(); trial++) {
        int64_t p[2][3][2];
        double q[2][6];
        for (int i = 0; i < 2; i++) {
            random_lattice_triangle(&rng, p[i], trial % 2 == 0 ? 5 : 14);
            for (int k = 0; k < 3; k++) {
                skew(p[i][k], q[i] + 2 * k);
            }
        }
        const sl_triangle_order order = sl_triangles_order(q[0], q[1]), back = sl_triangles_order(q[1], q[0]);
        assert_int_equal(order == SL_TRIANGLES_OVERLAP, overlap_by_clipping(p[0], p[1]));
        if (order == SL_TRIANGLES_OVERLAP || order == SL_TRIANGLES_BESIDE) {
            assert_int_equal(back, order);
        }
        seen[order]++;
        const double low = fmax(fmin(q[0][0], fmin(q[0][2], q[0][4])), fmin(q[1][0], fmin(q[1][2], q[1][4])));
        const double high = fmin(fmax(q[0][0], fmax(q[0][2], q[0][4])), fmax(q[1][0], fmax(q[1][2], q[1][4])));
        if (low < high && order != SL_TRIANGLES_OVERLAP) { /* then above and below mean something */
            assert_true((order == SL_TRIANGLE_ABOVE && back == SL_TRIANGLE_BELOW) ||
                        (order == SL_TRIANGLE_BELOW && back == SL_TRIANGLE_ABOVE));
        }
    }
    assert_true(seen[SL_TRIANGLES_OVERLAP] > 1000 && seen[SL_TRIANGLE_BELOW] > 1000);
    /* Only a vertical line: side by side, with a common edge on it. */
    const double left[6] = {0.1, 0.0, 0.7, -0.3, 0.7, 0.9}, right[6] = {0.7, -0.2, 1.3, 0.4, 0.7, 0.8};
    assert_int_equal(sl_triangles_order(left, right), SL_TRIANGLES_BESIDE);
}

/* A triangle's height over the x that two have in common decides what above means. */
static void above_is_higher_on_every_common_vertical(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0xab0e);
    int checked = 0;
    while (checked < 5000 * test_multiplier()) {
        double p[2][6], low = -1.0, high = 1.0;
        for (int i = 0; i < 2; i++) {
            do {
                for (int k = 0; k < 6; k++) {
                    p[i][k] = test_uniform(&rng, -1.0, 1.0) + (k % 2 == 1 ? 0.7 * i : 0.0);
                }
            } while (sl_orient2d(p[i], p[i] + 2, p[i] + 4) <= 0);
            low = fmax(low, fmin(p[i][0], fmin(p[i][2], p[i][4])));
            high = fmin(high, fmax(p[i][0], fmax(p[i][2], p[i][4])));
        }
        const sl_triangle_order order = sl_triangles_order(p[0], p[1]);
        if (order == SL_TRIANGLES_OVERLAP || low >= high) {
            continue;
        }
        const double x = 0.5 * (low + high);
        double middle[2];
        for (int i = 0; i < 2; i++) {
            double least = HUGE_VAL, most = -HUGE_VAL;
            for (int k = 0; k < 3; k++) {
                const double *a = p[i] + 2 * k, *b = p[i] + 2 * ((k + 1) % 3);
                if ((a[0] < x) != (b[0] < x)) {
                    const double y = a[1] + (b[1] - a[1]) * (x - a[0]) / (b[0] - a[0]);
                    least = fmin(least, y);
                    most = fmax(most, y);
                }
            }
            middle[i] = 0.5 * (least + most);
        }
        assert_int_equal(order, middle[0] < middle[1] ? SL_TRIANGLE_BELOW : SL_TRIANGLE_ABOVE);
        checked++;
    }
}

static void turn_counter_clockwise(const int32_t *t, double p[6])
{
    const bool turned = sl_orient2d(uv + 2 * t[0], uv + 2 * t[1], uv + 2 * t[2]) < 0;
    for (int k = 0; k < 3; k++) {
        memcpy(p + 2 * k, uv + 2 * t[turned ? 2 - k : k], 2 * sizeof *p);
    }
}

/* Returns how many are red. */
static int32_t check_against_all_pairs(int32_t nt)
{
    static uint8_t expected[MOST], red[MOST];
    sl_exact_overlap found, answer;
    int32_t sum = 0, flat = 0;
    memset(expected, 0, sizeof expected);
    for (int32_t i = 0; i < nt; i++) {
        const int32_t *t = tri + 3 * i;
        const bool degenerate = sl_orient2d(uv + 2 * t[0], uv + 2 * t[1], uv + 2 * t[2]) == 0;
        double p[6], q[6];
        flat += degenerate;
        turn_counter_clockwise(t, p);
        for (int32_t j = 0; j < i && !degenerate; j++) {
            const int32_t *o = tri + 3 * j;
            turn_counter_clockwise(o, q);
            if (sl_orient2d(q, q + 2, q + 4) != 0 && sl_triangles_order(p, q) == SL_TRIANGLES_OVERLAP) {
                expected[i] = expected[j] = 1;
            }
        }
    }
    assert_int_equal(sl_overlap_exact(uv, nt, tri, NULL, red, &found), SL_OK);
    assert_int_equal(sl_overlap_exact(uv, nt, tri, NULL, NULL, &answer), SL_OK);
    for (int32_t t = 0; t < nt; t++) {
        assert_int_equal(red[t], expected[t]);
        sum += red[t];
    }
    assert_int_equal(found.red, sum);
    assert_int_equal(found.degenerate, flat);
    assert_int_equal(answer.first[0] >= 0, sum > 0);
    for (int k = 0; k < 2 && sum > 0; k++) {
        double p[6], q[6];
        const sl_exact_overlap *e = k == 0 ? &found : &answer;
        turn_counter_clockwise(tri + 3 * e->first[0], p);
        turn_counter_clockwise(tri + 3 * e->first[1], q);
        assert_int_equal(sl_triangles_order(p, q), SL_TRIANGLES_OVERLAP);
    }
    return sum;
}

static void random_triangles_agree_with_all_pairs(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0x7419);
    int free_of_overlap = 0;
    for (int trial = 0; trial < 400 * test_multiplier(); trial++) {
        const int32_t nt = 1 + test_index(&rng, 120);
        const double size = pow(10.0, test_uniform(&rng, -3.0, 0.0));
        for (int32_t t = 0; t < nt; t++) {
            const double x = test_uniform(&rng, -1.0, 1.0), y = test_uniform(&rng, 4.0, 6.0);
            for (int k = 0; k < 3; k++) {
                tri[3 * t + k] = 3 * t + k;
                uv[2 * (3 * t + k)] = x + size * test_uniform(&rng, -1.0, 1.0);
                uv[2 * (3 * t + k) + 1] = y + size * test_uniform(&rng, -1.0, 1.0);
            }
        }
        free_of_overlap += check_against_all_pairs(nt) == 0;
    }
    assert_true(free_of_overlap > 20 && free_of_overlap < 380);
}

/* Whole coordinates in a small box: common corners, edges, vertical sides, identical triangles, none with area. */
static void triangles_on_a_lattice_agree_with_all_pairs(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0x1a7);
    int free_of_overlap = 0;
    for (int trial = 0; trial < 6000 * test_multiplier(); trial++) {
        const int32_t nt = 1 + test_index(&rng, trial % 3 == 0 ? 30 : 5), box = 2 + test_index(&rng, 9);
        for (int32_t v = 0; v < 3 * nt; v++) {
            tri[v] = v;
            uv[2 * v] = test_index(&rng, box);
            uv[2 * v + 1] = test_index(&rng, box);
        }
        free_of_overlap += check_against_all_pairs(nt) == 0;
    }
    assert_true(free_of_overlap > 300);
}

/* Grids whose triangles all touch; noise folds some; the diagonal cuts and the vertical sides are exact. */
static void touching_triangles_do_not_overlap_until_a_vertex_crosses(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0x96d1);
    for (int trial = 0; trial < 12 * test_multiplier(); trial++) {
        const int32_t n = 3 + test_index(&rng, 15);
        int32_t nt = 0;
        for (int32_t v = 0; v < (n + 1) * (n + 1); v++) {
            const double noise = trial % 3 == 0 ? 0.0 : 0.24;
            uv[2 * v] = v % (n + 1) + test_uniform(&rng, -noise, noise);
            uv[2 * v + 1] = floor((double)v / (n + 1)) + test_uniform(&rng, -noise, noise);
        }
        for (int32_t q = 0; q < n * n; q++) {
            const int32_t a = q / n * (n + 1) + q % n, corner[6] = {a, a + 1, a + n + 2, a, a + n + 2, a + n + 1};
            memcpy(tri + 3 * nt, corner, sizeof corner);
            nt += 2;
        }
        assert_int_equal(check_against_all_pairs(nt), 0);
        uv[2 * (n + 2)] += 1.3;
        assert_true(check_against_all_pairs(nt) > 0);
    }
}

/* Ring of triangles between two radii, `holes` sides. */
static int32_t add_ring(int32_t first_triangle, double x, double y, double inner, double outer, int32_t sides)
{
    for (int32_t s = 0; s < sides; s++) {
        const double turn[2] = {2.0 * TEST_PI * s / sides, 2.0 * TEST_PI * ((s + 1) % sides) / sides};
        const double point[4][2] = {{x + inner * cos(turn[0]), y + inner * sin(turn[0])},
                                    {x + outer * cos(turn[0]), y + outer * sin(turn[0])},
                                    {x + outer * cos(turn[1]), y + outer * sin(turn[1])},
                                    {x + inner * cos(turn[1]), y + inner * sin(turn[1])}};
        static const int corner[6] = {0, 1, 2, 0, 2, 3};
        for (int k = 0; k < 6; k++) {
            const int32_t v = 3 * first_triangle + 6 * s + k;
            tri[v] = v;
            memcpy(uv + 2 * v, point[corner[k]], sizeof point[0]);
        }
    }
    return first_triangle + 2 * sides;
}

static void a_chart_in_the_hole_of_another_is_no_overlap_and_one_inside_it_is(void **state)
{
    (void)state;
    int32_t nt = add_ring(0, 0.5, 0.5, 0.3, 0.45, 41);
    nt = add_ring(nt, 0.5, 0.5, 0.1, 0.25, 23);
    nt = add_ring(nt, 0.5, 0.5, 0.02, 0.1, 23); /* touches the ring around it, corner by corner */
    assert_int_equal(check_against_all_pairs(nt), 0);
    const int32_t nested = add_ring(nt, 0.5 + 0.375, 0.5, 0.001, 0.004, 7); /* wholly within the outermost ring */
    assert_true(check_against_all_pairs(nested) >= 14);
    const int32_t aside = add_ring(nt, 0.5 + 0.27, 0.51, 0.001, 0.004, 7); /* between two rings */
    assert_int_equal(check_against_all_pairs(aside), 0);
}

static void identical_and_mirrored_triangles_are_all_red(void **state)
{
    (void)state;
    const double corner[6] = {0.13, 0.2, 0.81, 0.33, 0.4, 0.77};
    const int32_t nt = 500;
    for (int32_t t = 0; t < nt; t++) {
        for (int k = 0; k < 3; k++) {
            tri[3 * t + k] = 3 * t + (t % 2 == 0 ? k : 2 - k);
        }
        memcpy(uv + 6 * t, corner, sizeof corner);
    }
    assert_int_equal(check_against_all_pairs(nt), nt);
}

/* A strip wound about the middle in n / 2 quads, `sides` to a turn: long thin triangles whose boxes all overlap. */
static void make_spiral(int32_t n, int32_t sides, double *point, int32_t *triangle)
{
    const double turns = 0.5 * n / sides, pitch = 0.45 / (turns + 2.0);
    for (int32_t s = 0; s <= n / 2; s++) {
        const double turn = 2.0 * TEST_PI * s / sides, inner = pitch * (1.0 + (double)s / sides);
        for (int k = 0; k < 2; k++) {
            point[4 * s + 2 * k] = 0.5 + (inner + 0.9 * k * pitch) * cos(turn);
            point[4 * s + 2 * k + 1] = 0.5 + (inner + 0.9 * k * pitch) * sin(turn);
        }
    }
    for (int32_t q = 0; q < n / 2; q++) {
        const int32_t a = 2 * q, corner[6] = {a, a + 1, a + 3, a, a + 3, a + 2};
        memcpy(triangle + 6 * q, corner, sizeof corner);
    }
}

/* Processor time of this process, so that a busy machine does not fail it; generous for unoptimised builds. */
static void spirals_of_strips_are_decided_in_little_time(void **state)
{
    (void)state;
    const int32_t n = 100000;
    static const int32_t sides[] = {7, 23, 60, 1000};
    double *point = sl_alloc(4 * (n / 2 + 1), sizeof *point);
    int32_t *triangle = sl_alloc(3 * n, sizeof *triangle);
    uint8_t *red = sl_alloc(n, 1);
    assert_true(point != NULL && triangle != NULL && red != NULL);
    for (int k = 0; k < 4; k++) {
        sl_exact_overlap found;
        make_spiral(n, sides[k], point, triangle);
        clock_t begin = clock();
        assert_int_equal(sl_overlap_exact(point, n, triangle, NULL, red, &found), SL_OK);
        const double simple = (double)(clock() - begin) / CLOCKS_PER_SEC;
        assert_int_equal(found.red, 0);
        point[4 * 20000] += 0.01; /* a vertex amid the windings */
        begin = clock();
        assert_int_equal(sl_overlap_exact(point, n, triangle, NULL, red, &found), SL_OK);
        const double folded = (double)(clock() - begin) / CLOCKS_PER_SEC;
        assert_true(found.red > 2);
        print_message("%d sides a turn: %.3f s, folded %.3f s (%d red)\n", sides[k], simple, folded, found.red);
        assert_true(simple < 3.0 && folded < 3.0);
    }
    sl_free(point);
    sl_free(triangle);
    sl_free(red);
}

static void red_triangles_are_the_same_for_any_number_of_threads(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0x7e1);
    static uint8_t red[2][MOST];
    sl_exact_overlap found[2];
    for (int32_t v = 0; v < 3 * MOST; v++) {
        tri[v] = v;
        uv[2 * v] = test_uniform(&rng, 0.0, 0.03) + v / 3 % 57 / 57.0;
        uv[2 * v + 1] = test_uniform(&rng, 0.0, 0.03) + v / 171 / 53.0;
    }
    assert_int_equal(sl_overlap_exact(uv, MOST, tri, NULL, red[0], &found[0]), SL_OK);
    for (int32_t workers = 2; workers <= 16; workers *= 2) {
        sl_thread_pool *pool = NULL;
        assert_int_equal(sl_thread_pool_create(workers + 1, &pool), SL_OK);
        const sl_context context = {.executor = sl_thread_pool_executor(pool)};
        assert_int_equal(sl_overlap_exact(uv, MOST, tri, &context, red[1], &found[1]), SL_OK);
        assert_memory_equal(red[0], red[1], MOST);
        assert_memory_equal(&found[0], &found[1], sizeof found[0]);
        sl_thread_pool_free(pool);
    }
}

static void empty_lists_are_free_and_what_is_not_finite_is_refused(void **state)
{
    (void)state;
    static const double bad[] = {NAN, INFINITY, -INFINITY};
    sl_exact_overlap found = {.red = 77};
    uint8_t red[2];
    const int32_t pair[6] = {0, 1, 2, 0, 2, 1};
    for (int k = 0; k < 3; k++) {
        double point[6] = {0.1, 0.2, 0.8, 0.3, 0.4, 0.9};
        point[k + 1] = bad[k];
        assert_int_equal(sl_overlap_exact(point, 2, pair, NULL, red, &found), SL_BAD_INPUT);
        assert_int_equal(found.red, 77);
    }
    assert_int_equal(sl_overlap_exact(NULL, 0, NULL, NULL, red, &found), SL_OK);
    assert_true(found.red == 0 && found.degenerate == 0 && found.first[0] == -1 && found.first[1] == -1);
    static const double scale[] = {1e-300, 1e-150, 1e150, 1e300};
    for (int k = 0; k < 4; k++) {
        const double point[6] = {0.1 * scale[k], 0.2 * scale[k], 0.8 * scale[k],
                                 0.3 * scale[k], 0.4 * scale[k], 0.9 * scale[k]};
        assert_int_equal(sl_overlap_exact(point, 2, pair, NULL, red, &found), SL_OK);
        assert_int_equal(found.red, 2);
        assert_int_equal(sl_overlap_exact(point, 1, pair, NULL, red, &found), SL_OK);
        assert_int_equal(found.red, 0);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(pairs_of_triangles_are_ordered_as_clipping_in_fractions_says),
        cmocka_unit_test(above_is_higher_on_every_common_vertical),
        cmocka_unit_test(random_triangles_agree_with_all_pairs),
        cmocka_unit_test(triangles_on_a_lattice_agree_with_all_pairs),
        cmocka_unit_test(touching_triangles_do_not_overlap_until_a_vertex_crosses),
        cmocka_unit_test(a_chart_in_the_hole_of_another_is_no_overlap_and_one_inside_it_is),
        cmocka_unit_test(identical_and_mirrored_triangles_are_all_red),
        cmocka_unit_test(spirals_of_strips_are_decided_in_little_time),
        cmocka_unit_test(red_triangles_are_the_same_for_any_number_of_threads),
        cmocka_unit_test(empty_lists_are_free_and_what_is_not_finite_is_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
