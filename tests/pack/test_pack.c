#include "base/context.h"
#include "pack/pack.h"
#include "support/test_support.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { MAX_CHARTS = 40, MAX_POINTS = 24 };

/* Star-shaped random charts: a centre and a ring of n points, so that outlines are concave. */
typedef struct chart_set {
    int32_t count;
    sl_pack_chart chart[MAX_CHARTS];
    double uv[MAX_CHARTS][2 * (MAX_POINTS + 1)];
    int32_t tri[MAX_CHARTS][3 * MAX_POINTS];
} chart_set;

static void random_chart(test_rng *rng, chart_set *set, int32_t c)
{
    const int32_t n = 3 + test_index(rng, MAX_POINTS - 3);
    const double size = test_uniform(rng, 0.05, 1.0), x = test_uniform(rng, -9, 9), y = test_uniform(rng, -9, 9);
    set->uv[c][0] = x;
    set->uv[c][1] = y;
    for (int32_t k = 0; k < n; k++) {
        const double angle = 2.0 * TEST_PI * (k + test_uniform(rng, 0.1, 0.9)) / n;
        const double radius = size * test_uniform(rng, 0.25, 1.0);
        set->uv[c][2 * (k + 1)] = x + radius * cos(angle);
        set->uv[c][2 * (k + 1) + 1] = y + 1.7 * radius * sin(angle);
        set->tri[c][3 * k] = 0;
        set->tri[c][3 * k + 1] = k + 1;
        set->tri[c][3 * k + 2] = (k + 1) % n + 1;
    }
    set->chart[c] = (sl_pack_chart){n + 1, n, set->uv[c], set->tri[c], 0.0};
}

static chart_set *random_charts(test_rng *rng, int32_t count)
{
    chart_set *set = calloc(1, sizeof *set);
    set->count = count;
    for (int32_t c = 0; c < count; c++) {
        random_chart(rng, set, c);
    }
    return set;
}

/* Texel position of a chart's point. */
static void placed(const sl_pack_chart *chart, const sl_placement *p, const sl_pack_info *info, double side, int32_t v,
                   double out[2])
{
    const double c = cos(p->angle), s = sin(p->angle), *uv = chart->uv + 2 * v;
    out[0] = side * (info->scale * (c * uv[0] - s * uv[1]) + p->offset[0]);
    out[1] = side * (info->scale * (s * uv[0] + c * uv[1]) + p->offset[1]);
}

static double point_segment(const double p[2], const double a[2], const double b[2])
{
    const double dx = b[0] - a[0], dy = b[1] - a[1], length2 = dx * dx + dy * dy;
    double t = length2 > 0.0 ? ((p[0] - a[0]) * dx + (p[1] - a[1]) * dy) / length2 : 0.0;
    t = fmin(1.0, fmax(0.0, t));
    return hypot(p[0] - a[0] - t * dx, p[1] - a[1] - t * dy);
}

static double cross(const double a[2], const double b[2], const double c[2])
{
    return (b[0] - a[0]) * (c[1] - a[1]) - (c[0] - a[0]) * (b[1] - a[1]);
}

static double segment_distance(double a[2][2], double b[2][2])
{
    if (cross(a[0], a[1], b[0]) * cross(a[0], a[1], b[1]) < 0.0 &&
        cross(b[0], b[1], a[0]) * cross(b[0], b[1], a[1]) < 0.0) {
        return 0.0;
    }
    return fmin(fmin(point_segment(a[0], b[0], b[1]), point_segment(a[1], b[0], b[1])),
                fmin(point_segment(b[0], a[0], a[1]), point_segment(b[1], a[0], a[1])));
}

/* Least distance between the edges of two placed charts [texels]: the oracle knows nothing of profiles. */
static double chart_distance(const chart_set *set, int32_t c, int32_t d, const sl_placement *place,
                             const sl_pack_info *info, double side)
{
    double least = HUGE_VAL;
    for (int32_t i = 0; i < 3 * set->chart[c].nt; i++) {
        double a[2][2], b[2][2];
        placed(&set->chart[c], &place[c], info, side, set->tri[c][i], a[0]);
        placed(&set->chart[c], &place[c], info, side, set->tri[c][i % 3 == 2 ? i - 2 : i + 1], a[1]);
        for (int32_t j = 0; j < 3 * set->chart[d].nt; j++) {
            placed(&set->chart[d], &place[d], info, side, set->tri[d][j], b[0]);
            placed(&set->chart[d], &place[d], info, side, set->tri[d][j % 3 == 2 ? j - 2 : j + 1], b[1]);
            least = fmin(least, segment_distance(a, b));
        }
    }
    return least;
}

static void charts_keep_their_margin_and_the_page(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0x9ac);
    for (int trial = 0; trial < 3 * test_multiplier(); trial++) {
        chart_set *set = random_charts(&rng, 2 + test_index(&rng, 11));
        sl_pack_def def = sl_pack_default();
        sl_placement place[MAX_CHARTS];
        sl_pack_info info;
        def.resolution = 128 << test_index(&rng, 3);
        def.margin = test_uniform(&rng, 0.0, 9.0);
        def.effort = trial % 2;
        def.rotations = (sl_pack_rotations)(trial % 3);
        assert_int_equal(sl_pack(set->count, set->chart, &def, NULL, place, &info), SL_OK);
        assert_true(info.scale > 0.0 && info.fill > 0.25 && info.fill < 1.0 && info.pages == 1);
        for (int32_t c = 0; c < set->count; c++) {
            for (int32_t v = 0; v < set->chart[c].nv; v++) {
                double p[2];
                placed(&set->chart[c], &place[c], &info, def.resolution, v, p);
                for (int k = 0; k < 2; k++) {
                    assert_true(p[k] >= 0.5 * def.margin - 1e-6 && p[k] <= def.resolution - 0.5 * def.margin + 1e-6);
                }
            }
            for (int32_t d = 0; d < c; d++) {
                assert_true(chart_distance(set, c, d, place, &info, def.resolution) >= def.margin - 1e-6);
            }
        }
        free(set);
    }
}

static void one_square_fills_the_page_but_for_the_margin(void **state)
{
    (void)state;
    const double uv[] = {3.1, 4.7, 3.1 + 0.6, 4.7 + 0.8, 3.1 - 0.2, 4.7 + 1.4, 3.1 - 0.8, 4.7 + 0.6}; /* unit, turned */
    const int32_t tri[] = {0, 1, 2, 0, 2, 3};
    const sl_pack_chart square = {4, 2, uv, tri, 0.0};
    const sl_pack_def def = sl_pack_default();
    sl_placement place;
    sl_pack_info info;
    assert_int_equal(sl_pack(1, &square, &def, NULL, &place, &info), SL_OK);
    assert_true(info.scale > 0.96 * (1.0 - def.margin / def.resolution));
    assert_true(test_near(info.fill, info.scale * info.scale, 1e-12));
}

static void the_same_charts_twice_as_large_are_packed_alike(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0xace);
    chart_set *set = random_charts(&rng, 9);
    const sl_pack_def def = {.resolution = 512, .margin = 3.0, .effort = 1};
    sl_placement a[MAX_CHARTS], b[MAX_CHARTS];
    sl_pack_info small, large;
    assert_int_equal(sl_pack(set->count, set->chart, &def, NULL, a, &small), SL_OK);
    for (int32_t c = 0; c < set->count; c++) {
        for (int32_t k = 0; k < 2 * set->chart[c].nv; k++) {
            set->uv[c][k] *= 2.0;
        }
    }
    assert_int_equal(sl_pack(set->count, set->chart, &def, NULL, b, &large), SL_OK);
    for (int32_t c = 0; c < set->count; c++) {
        assert_true(a[c].angle == b[c].angle && a[c].page == b[c].page);
        assert_memory_equal(a[c].offset, b[c].offset, sizeof a[c].offset);
    }
    assert_true(large.scale * 2.0 == small.scale && large.fill == small.fill);
    free(set);
}

static void charts_without_area_get_a_texel_each(void **state)
{
    (void)state;
    const double point[] = {0.3, 0.3, 0.3, 0.3, 0.3, 0.3}, triangle[] = {0, 0, 1.1, 0.1, 0.2, 0.9};
    const int32_t tri[] = {0, 1, 2};
    const sl_pack_chart charts[] = {{3, 1, point, tri, 0.0}, {3, 1, triangle, tri, 0.0}, {3, 1, point, tri, 0.0}};
    const sl_pack_def def = {.resolution = 128, .margin = 2.0};
    sl_placement place[3];
    sl_pack_info info;
    assert_int_equal(sl_pack(3, charts, &def, NULL, place, &info), SL_OK);
    double p[2], q[2];
    placed(&charts[0], &place[0], &info, 128, 0, p);
    placed(&charts[2], &place[2], &info, 128, 0, q);
    assert_true(fmax(fabs(p[0] - q[0]), fabs(p[1] - q[1])) >= 3.0 - 1e-9);
    assert_int_equal(sl_pack(1, charts, &def, NULL, place, &info), SL_OK); /* nothing but a point */
    assert_int_equal(sl_pack(0, NULL, &def, NULL, NULL, &info), SL_OK);
}

static void too_many_charts_for_the_page_are_infeasible(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(7);
    chart_set *set = random_charts(&rng, 30);
    const sl_pack_def def = {.resolution = 16, .margin = 8.0};
    sl_placement place[MAX_CHARTS];
    sl_pack_info info;
    assert_int_equal(sl_pack(set->count, set->chart, &def, NULL, place, &info), SL_INFEASIBLE);
    free(set);
}

/* A page that is all margin holds points, not charts: nothing of them would be left. */
static void charts_that_would_shrink_to_points_are_infeasible(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(8);
    chart_set *set = random_charts(&rng, 1);
    const sl_pack_def def = {.resolution = 64, .margin = 64.0};
    sl_placement place[MAX_CHARTS];
    sl_pack_info info;
    assert_int_equal(sl_pack(set->count, set->chart, &def, NULL, place, &info), SL_INFEASIBLE);
    free(set);
}

/* A bar across the page's diagonal is longer than one along its side. */
static void a_bar_lies_across_the_page_where_it_may_turn(void **state)
{
    (void)state;
    const double uv[] = {0, 0, 3.0, 0.1, 3.0, 0.4, 0.1, 0.3};
    const int32_t tri[] = {0, 1, 2, 0, 2, 3};
    const sl_pack_chart bar = {4, 2, uv, tri, 0.0};
    sl_pack_def def = sl_pack_default();
    sl_placement place;
    sl_pack_info plain, turned;
    def.rotations = SL_ROTATE_RIGHT;
    assert_int_equal(sl_pack(1, &bar, &def, NULL, &place, &plain), SL_OK);
    def.rotations = SL_ROTATE_FREE;
    assert_int_equal(sl_pack(1, &bar, &def, NULL, &place, &turned), SL_OK);
    assert_true(turned.scale > 1.2 * plain.scale);
}

static bool is_multiple(double angle, double of)
{
    const double turns = angle / of;
    return test_near(turns, floor(turns + 0.5), 1e-12);
}

static void charts_turn_only_as_they_may(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0x7a21);
    chart_set *set = random_charts(&rng, 7);
    sl_pack_def def = {.resolution = 256, .margin = 2.0, .effort = 1};
    sl_placement place[MAX_CHARTS];
    sl_pack_info info;
    int32_t lying = 0;
    for (int32_t c = 0; c < set->count; c++) {
        set->chart[c].upright = test_uniform(&rng, -3.0, 3.0);
    }
    def.rotations = SL_ROTATE_NONE;
    assert_int_equal(sl_pack(set->count, set->chart, &def, NULL, place, &info), SL_OK);
    for (int32_t c = 0; c < set->count; c++) {
        assert_true(place[c].angle == set->chart[c].upright);
    }
    def.rotations = SL_ROTATE_RIGHT;
    assert_int_equal(sl_pack(set->count, set->chart, &def, NULL, place, &info), SL_OK);
    for (int32_t c = 0; c < set->count; c++) {
        const double by = place[c].angle - set->chart[c].upright;
        assert_true(is_multiple(by, 0.5 * TEST_PI));
        lying += !is_multiple(by, TEST_PI);
    }
    assert_true(lying > 0 && lying < set->count);
    free(set);
}

static void more_effort_finds_larger_scales(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0x7a22);
    double sum[2] = {0.0, 0.0};
    for (int trial = 0; trial < 2 * test_multiplier(); trial++) {
        chart_set *set = random_charts(&rng, 6);
        sl_placement place[MAX_CHARTS];
        sl_pack_info info;
        for (int32_t k = 0; k < 2; k++) {
            const sl_pack_def def = {.resolution = 128, .margin = 1.0, .effort = 3 * k};
            assert_int_equal(sl_pack(set->count, set->chart, &def, NULL, place, &info), SL_OK);
            sum[k] += info.fill;
        }
        free(set);
    }
    assert_true(sum[1] > 1.01 * sum[0]);
}

static void charts_fill_several_pages_and_pages_that_are_not_square(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0x7a23);
    chart_set *set = random_charts(&rng, 16);
    const sl_pack_def def = {.resolution = 512, .height = 200, .margin = 3.0, .pages = 3};
    sl_placement place[MAX_CHARTS];
    sl_pack_info info;
    assert_int_equal(sl_pack(set->count, set->chart, &def, NULL, place, &info), SL_OK);
    assert_int_equal(info.pages, 3);
    for (int32_t c = 0; c < set->count; c++) {
        for (int32_t v = 0; v < set->chart[c].nv; v++) {
            double p[2];
            placed(&set->chart[c], &place[c], &info, 512, v, p);
            assert_true(p[0] >= 1.5 - 1e-6 && p[0] <= 510.5 + 1e-6 && p[1] >= 1.5 - 1e-6 && p[1] <= 198.5 + 1e-6);
        }
        for (int32_t d = 0; d < c; d++) {
            assert_true(place[c].page != place[d].page || chart_distance(set, c, d, place, &info, 512) >= 3.0 - 1e-6);
        }
    }
    free(set);
}

/* As many pages as the density asks for, and no more. */
static void a_density_that_is_given_is_kept(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0x7a24);
    chart_set *set = random_charts(&rng, 12);
    sl_pack_def def = {.resolution = 256, .margin = 2.0};
    sl_placement place[MAX_CHARTS];
    sl_pack_info info;
    assert_int_equal(sl_pack(set->count, set->chart, &def, NULL, place, &info), SL_OK);
    const double largest = info.scale * 256;
    def.density = 0.9 * largest;
    def.pages = 9;
    assert_int_equal(sl_pack(set->count, set->chart, &def, NULL, place, &info), SL_OK);
    assert_true(info.pages == 1 && test_near(info.scale * 256, def.density, 1e-12 * def.density));
    def.density = 1.3 * largest;
    assert_int_equal(sl_pack(set->count, set->chart, &def, NULL, place, &info), SL_OK);
    assert_true(info.pages > 1 && info.pages < 4 && test_near(info.scale * 256, def.density, 1e-12 * def.density));
    def.pages = 1;
    assert_int_equal(sl_pack(set->count, set->chart, &def, NULL, place, &info), SL_INFEASIBLE);
    free(set);
}

/* What the first layout spreads over more pages is pushed together; charts stay apart. */
static void effort_saves_pages_at_a_given_density(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0x7a2c);
    int32_t pages[2] = {0, 0};
    for (int trial = 0; trial < 4 * test_multiplier(); trial++) {
        chart_set *set = random_charts(&rng, 22);
        sl_pack_def def = {.resolution = 256, .margin = 2.0, .pages = 2, .effort = 1};
        sl_placement place[MAX_CHARTS];
        sl_pack_info info;
        assert_int_equal(sl_pack(set->count, set->chart, &def, NULL, place, &info), SL_OK);
        def.density = 0.97 * info.scale * 256; /* nearly the most that two pages hold */
        def.pages = 9;
        for (def.effort = 0; def.effort < 2; def.effort++) {
            assert_int_equal(sl_pack(set->count, set->chart, &def, NULL, place, &info), SL_OK);
            assert_true(test_near(info.scale * 256, def.density, 1e-12 * def.density));
            pages[def.effort] += info.pages;
            for (int32_t c = 0; c < set->count; c++) {
                assert_true(place[c].page >= 0 && place[c].page < info.pages);
                for (int32_t d = 0; d < c; d++) {
                    assert_true(place[c].page != place[d].page ||
                                chart_distance(set, c, d, place, &info, 256) >= 2.0 - 1e-6);
                }
            }
        }
        free(set);
    }
    assert_true(pages[1] < pages[0]);
}

/* A square ring with a chart that only its hole has room for. */
static void a_chart_nests_in_the_hole_of_another(void **state)
{
    (void)state;
    const double uv[] = {0, 0, 1, 0, 1, 1, 0, 1, 0.1, 0.1, 0.9, 0.1, 0.9, 0.9, 0.1, 0.9};
    const int32_t ring[] = {0, 1, 4, 1, 5, 4, 1, 2, 5, 2, 6, 5, 2, 3, 6, 3, 7, 6, 3, 0, 7, 0, 4, 7};
    const double inner_uv[] = {3.0, 2.0, 3.7, 2.0, 3.7, 2.6, 3.0, 2.6};
    const int32_t inner[] = {0, 1, 2, 0, 2, 3};
    const sl_pack_chart charts[] = {{8, 8, uv, ring, 0.0}, {4, 2, inner_uv, inner, 0.0}};
    const sl_pack_def def = {.resolution = 256, .margin = 2.0, .effort = 1};
    sl_placement place[2];
    sl_pack_info info;
    assert_int_equal(sl_pack(2, charts, &def, NULL, place, &info), SL_OK);
    assert_true(info.scale > 0.96);
}

static void the_number_of_threads_changes_nothing(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0x7a25);
    chart_set *set = random_charts(&rng, 5);
    const sl_pack_def def = {.resolution = 128, .margin = 2.0, .effort = 6};
    sl_placement place[2][MAX_CHARTS];
    sl_pack_info info[2];
    for (int32_t k = 0; k < 2; k++) {
        sl_thread_pool *pool;
        assert_int_equal(sl_thread_pool_create(1 + 4 * k, &pool), SL_OK);
        const sl_context context = {.executor = sl_thread_pool_executor(pool)};
        assert_int_equal(sl_pack(set->count, set->chart, &def, &context, place[k], &info[k]), SL_OK);
        sl_thread_pool_free(pool);
    }
    assert_true(info[0].scale == info[1].scale && info[0].attempts == info[1].attempts);
    for (int32_t c = 0; c < set->count; c++) {
        assert_true(place[0][c].angle == place[1][c].angle && place[0][c].offset[0] == place[1][c].offset[0] &&
                    place[0][c].offset[1] == place[1][c].offset[1]);
    }
    free(set);
}

/* Area alone is no bound for a needle: the search must start where its length fits. */
static void a_needle_is_packed_at_the_length_of_the_page(void **state)
{
    (void)state;
    const double uv[] = {0, 0, 3.0, 0.2, 1.5, 0.1 + 1e-12};
    const int32_t tri[] = {0, 1, 2};
    const sl_pack_chart chart = {3, 1, uv, tri, 0.0};
    const sl_pack_def def = sl_pack_default();
    sl_placement place;
    sl_pack_info info;
    assert_int_equal(sl_pack(1, &chart, &def, NULL, &place, &info), SL_OK);
    assert_true(info.scale * hypot(3.0, 0.2) > 0.9);
}

static void a_uv_that_is_not_finite_is_bad_input(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(8);
    chart_set *set = random_charts(&rng, 3);
    const sl_pack_def def = sl_pack_default();
    sl_placement place[MAX_CHARTS];
    sl_pack_info info;
    set->uv[1][4] = NAN;
    assert_int_equal(sl_pack(set->count, set->chart, &def, NULL, place, &info), SL_BAD_INPUT);
    free(set);
}

static bool refuse(void *user, const char *stage, double fraction)
{
    (void)user, (void)stage;
    return fraction < 0.1;
}

static void packing_can_be_cancelled(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(9);
    chart_set *set = random_charts(&rng, 5);
    const sl_pack_def def = sl_pack_default();
    const sl_context context = {.progress = refuse};
    sl_placement place[MAX_CHARTS];
    sl_pack_info info;
    assert_int_equal(sl_pack(set->count, set->chart, &def, &context, place, &info), SL_CANCELLED);
    free(set);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(charts_keep_their_margin_and_the_page),
        cmocka_unit_test(one_square_fills_the_page_but_for_the_margin),
        cmocka_unit_test(the_same_charts_twice_as_large_are_packed_alike),
        cmocka_unit_test(charts_without_area_get_a_texel_each),
        cmocka_unit_test(too_many_charts_for_the_page_are_infeasible),
        cmocka_unit_test(charts_that_would_shrink_to_points_are_infeasible),
        cmocka_unit_test(a_bar_lies_across_the_page_where_it_may_turn),
        cmocka_unit_test(charts_turn_only_as_they_may),
        cmocka_unit_test(more_effort_finds_larger_scales),
        cmocka_unit_test(charts_fill_several_pages_and_pages_that_are_not_square),
        cmocka_unit_test(a_density_that_is_given_is_kept),
        cmocka_unit_test(effort_saves_pages_at_a_given_density),
        cmocka_unit_test(a_chart_nests_in_the_hole_of_another),
        cmocka_unit_test(the_number_of_threads_changes_nothing),
        cmocka_unit_test(a_needle_is_packed_at_the_length_of_the_page),
        cmocka_unit_test(a_uv_that_is_not_finite_is_bad_input),
        cmocka_unit_test(packing_can_be_cancelled),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
