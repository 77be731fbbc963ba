/* The grid of the packer against what brute force says: masks, boards, fields. */
#include "pack/board.h"
#include "pack/field.h"
#include "support/test_support.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { SIDE = 90, RING = 11 };

/* A random star with a hole: an annulus of 2 RING triangles. */
typedef struct ring_chart {
    sl_pack_chart chart;
    double uv[4 * RING];
    int32_t tri[6 * RING];
} ring_chart;

static void random_ring(test_rng *rng, ring_chart *r)
{
    for (int32_t k = 0; k < RING; k++) {
        const double angle = 2.0 * TEST_PI * (k + test_uniform(rng, 0.2, 0.8)) / RING;
        const double outer = test_uniform(rng, 0.5, 1.0), inner = outer * test_uniform(rng, 0.3, 0.7);
        const int32_t next = (k + 1) % RING;
        const double uv[4] = {outer * cos(angle), outer * sin(angle), inner * cos(angle), inner * sin(angle)};
        const int32_t tri[6] = {2 * k, 2 * next, 2 * k + 1, 2 * next, 2 * next + 1, 2 * k + 1};
        memcpy(r->uv + 4 * k, uv, sizeof uv);
        memcpy(r->tri + 6 * k, tri, sizeof tri);
    }
    r->chart = (sl_pack_chart){2 * RING, 2 * RING, r->uv, r->tri, 0.0};
}

static double cross(const double a[2], const double b[2], const double c[2])
{
    return (b[0] - a[0]) * (c[1] - a[1]) - (c[0] - a[0]) * (b[1] - a[1]);
}

static double point_segment(const double p[2], const double a[2], const double b[2])
{
    const double d[2] = {b[0] - a[0], b[1] - a[1]};
    const double t = ((p[0] - a[0]) * d[0] + (p[1] - a[1]) * d[1]) / (d[0] * d[0] + d[1] * d[1]);
    const double s = fmin(1.0, fmax(0.0, t));
    return hypot(p[0] - a[0] - s * d[0], p[1] - a[1] - s * d[1]);
}

/* Distance of a point from a triangle, 0 inside. */
static double point_triangle(const double p[2], double q[3][2])
{
    double least = HUGE_VAL;
    bool left = true, right = true;
    for (int k = 0; k < 3; k++) {
        const double side = cross(q[k], q[(k + 1) % 3], p);
        left &= side >= 0.0;
        right &= side <= 0.0;
        least = fmin(least, point_segment(p, q[k], q[(k + 1) % 3]));
    }
    return left || right ? 0.0 : least;
}

/* Distance of a point from the chart as the mask stands, in cells. */
static double distance(const ring_chart *r, const sl_outline *outline, const sl_mask *mask, double scale,
                       const double p[2])
{
    double least = HUGE_VAL;
    const double c = cos(mask->angle), s = sin(mask->angle);
    for (int32_t t = 0; t < 2 * RING; t++) {
        double q[3][2];
        for (int k = 0; k < 3; k++) {
            const double *uv = r->uv + 2 * r->tri[3 * t + k];
            const double x = uv[0] - outline->centre[0], y = uv[1] - outline->centre[1];
            q[k][0] = scale * (c * x - s * y) + mask->origin[0];
            q[k][1] = scale * (s * x + c * y) + mask->origin[1];
        }
        least = fmin(least, point_triangle(p, q));
    }
    return least;
}

static void set_cells(const sl_mask *mask, int32_t x, int32_t y, int32_t value, int32_t *cells)
{
    for (int32_t r = 0; r < mask->count; r++) {
        for (int32_t i = 0; i < mask->run[r].length; i++) {
            cells[(y + mask->run[r].row) * SIDE + x + mask->run[r].left + i] += value;
        }
    }
}

/* No point of the grown chart lies outside its cells, and no cell lies farther out than its own diagonal. */
static void a_mask_holds_every_cell_that_the_grown_chart_touches(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0x3a5c);
    for (int trial = 0; trial < 12 * test_multiplier(); trial++) {
        ring_chart r;
        sl_outline outline;
        sl_mask mask;
        const double scale = test_uniform(&rng, 3.0, 30.0), grow = trial % 4 == 0 ? 0.0 : test_uniform(&rng, 0.1, 4.0);
        random_ring(&rng, &r);
        assert_int_equal(sl_outline_init(&r.chart, &outline), SL_OK);
        assert_int_equal(outline.count, 2 * RING);
        assert_int_equal(sl_mask_init(&outline, test_uniform(&rng, 0, 7), scale, grow, SIDE, SIDE, &mask), SL_OK);
        assert_true(mask.width > 0 && mask.height > 0);
        int32_t *cells = calloc(SIDE * SIDE, sizeof *cells), count = 0;
        set_cells(&mask, 0, 0, 1, cells);
        for (int32_t k = 0; k < SIDE * SIDE; k++) {
            const int32_t x = k % SIDE, y = k / SIDE;
            const double centre[2] = {x + 0.5, y + 0.5};
            assert_true(cells[k] <= 1);
            count += cells[k];
            if (cells[k] != 0) {
                assert_true(distance(&r, &outline, &mask, scale, centre) <= grow + 0.5 * sqrt(2.0) + 1e-5);
            }
            for (int i = 0; i < 32 && cells[k] == 0; i++) { /* along the cell's sides: what reaches in crosses them */
                const double t = (i / 4 + test_uniform(&rng, 0, 1)) / 8.0, side = i % 2;
                const double p[2] = {x + (i % 4 < 2 ? t : side), y + (i % 4 < 2 ? side : t)};
                assert_true(distance(&r, &outline, &mask, scale, p) > grow - 1e-9);
            }
        }
        assert_true(mask.cells == count);
        free(cells);
        sl_pack_mask_clear(&mask);
        sl_outline_clear(&outline);
    }
}

static void a_mask_larger_than_allowed_has_no_cells(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0x3a5d);
    ring_chart r;
    sl_outline outline;
    sl_mask mask;
    random_ring(&rng, &r);
    assert_int_equal(sl_outline_init(&r.chart, &outline), SL_OK);
    assert_int_equal(sl_mask_init(&outline, 0.3, 40.0, 1.0, SIDE, 20, &mask), SL_OK);
    assert_true(mask.width == 0 && mask.count == 0);
    sl_pack_mask_clear(&mask);
    sl_outline_clear(&outline);
}

/* A board with some masks on it, and the same as plain numbers. */
typedef struct crowd {
    sl_board board;
    int32_t cells[SIDE * SIDE];
} crowd;

static void random_mask(test_rng *rng, double size, sl_mask *mask)
{
    ring_chart r;
    sl_outline outline;
    random_ring(rng, &r);
    assert_int_equal(sl_outline_init(&r.chart, &outline), SL_OK);
    assert_int_equal(sl_mask_init(&outline, test_uniform(rng, 0, 7), size, 0.4, SIDE, SIDE, mask), SL_OK);
    sl_outline_clear(&outline);
}

static crowd *random_crowd(test_rng *rng)
{
    crowd *c = calloc(1, sizeof *c);
    assert_int_equal(sl_board_init(SIDE, SIDE, &c->board), SL_OK);
    for (int32_t k = 0; k < 6; k++) {
        sl_mask mask;
        random_mask(rng, test_uniform(rng, 4, 14), &mask);
        const int32_t x = test_index(rng, SIDE - mask.width + 1), y = test_index(rng, SIDE - mask.height + 1);
        sl_board_put(&c->board, &mask, x, y);
        if (k == 2) { /* and away again */
            sl_board_wipe(&c->board);
            memset(c->cells, 0, sizeof c->cells);
        } else {
            set_cells(&mask, x, y, 1, c->cells);
        }
        sl_pack_mask_clear(&mask);
    }
    return c;
}

static bool fits(const crowd *c, const sl_mask *mask, int32_t x, int32_t y)
{
    for (int32_t r = 0; r < mask->count; r++) {
        for (int32_t i = 0; i < mask->run[r].length; i++) {
            if (c->cells[(y + mask->run[r].row) * SIDE + x + mask->run[r].left + i] != 0) {
                return false;
            }
        }
    }
    return true;
}

static int64_t cost_at(const sl_board_query *q, int32_t x, int32_t y)
{
    return q->pull[0] * (2 * (int64_t)x + q->reference[0]) + q->pull[1] * (2 * (int64_t)y + q->reference[1]);
}

static void a_board_finds_the_best_free_place(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0xb0a4d);
    for (int trial = 0; trial < 60 * test_multiplier(); trial++) {
        crowd *c = random_crowd(&rng);
        sl_mask mask;
        sl_board_place place;
        int64_t work = 0, least = INT64_MAX;
        random_mask(&rng, test_uniform(&rng, 3, 20), &mask);
        sl_board_query q = {.high = {SIDE, SIDE},
                            .pull = {test_index(&rng, 9) - 4, test_index(&rng, 9) - 4},
                            .reference = {test_index(&rng, 40), test_index(&rng, 40)},
                            .limit = INT64_MAX};
        for (int i = 0; i < 2 && trial % 3 == 0; i++) {
            q.low[i] = test_index(&rng, SIDE / 2);
            q.high[i] = q.low[i] + test_index(&rng, SIDE / 2);
        }
        for (int32_t y = q.low[1]; y <= q.high[1] && y + mask.height <= SIDE; y++) {
            for (int32_t x = q.low[0]; x <= q.high[0] && x + mask.width <= SIDE; x++) {
                least = fits(c, &mask, x, y) && cost_at(&q, x, y) < least ? cost_at(&q, x, y) : least;
            }
        }
        assert_true(sl_board_find(&c->board, &mask, &q, &place, &work) == (least < INT64_MAX));
        if (least < INT64_MAX) {
            assert_true(place.cost == least && fits(c, &mask, place.x, place.y) && work > 0);
            assert_true(cost_at(&q, place.x, place.y) == least);
            q.limit = least;
            assert_false(sl_board_find(&c->board, &mask, &q, &place, &work));
        }
        sl_pack_mask_clear(&mask);
        sl_board_clear(&c->board);
        free(c);
    }
}

/* Weights of overlapping masks in a window, against the sum cell by cell. */
static void a_field_sums_the_weights_under_a_mask(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0xf1e1d);
    for (int trial = 0; trial < 30 * test_multiplier(); trial++) {
        sl_field field, coarse;
        int32_t *cells = calloc(SIDE * SIDE, sizeof *cells);
        const int32_t low[2] = {test_index(&rng, 20), test_index(&rng, 20)};
        const int32_t size[2] = {SIDE - low[0] - test_index(&rng, 10), SIDE - low[1] - test_index(&rng, 10)};
        sl_mask mask;
        int64_t sum = 0, all = 0;
        assert_int_equal(sl_field_init(SIDE, SIDE, &field), SL_OK);
        assert_int_equal(sl_field_init(SIDE, SIDE, &coarse), SL_OK);
        sl_field_begin(&field, low, size);
        for (int32_t k = 0; k < 5; k++) {
            const int32_t weight = 1 + test_index(&rng, 90);
            random_mask(&rng, test_uniform(&rng, 5, 25), &mask);
            const int32_t x = test_index(&rng, SIDE - mask.width + 1), y = test_index(&rng, SIDE - mask.height + 1);
            sl_field_add(&field, &mask, x, y, weight);
            set_cells(&mask, x, y, weight, cells);
            sl_pack_mask_clear(&mask);
        }
        sl_field_sum(&field);
        random_mask(&rng, 12.0, &mask);
        const int32_t x = low[0] + test_index(&rng, size[0] - mask.width + 1);
        const int32_t y = low[1] + test_index(&rng, size[1] - mask.height + 1);
        for (int32_t r = 0; r < mask.count; r++) {
            for (int32_t i = 0; i < mask.run[r].length; i++) {
                sum += cells[(y + mask.run[r].row) * SIDE + x + mask.run[r].left + i];
            }
        }
        assert_true(sl_field_cost(&field, &mask, x, y, INT64_MAX) == sum);
        assert_true(sum == 0 || sl_field_cost(&field, &mask, x, y, 1) >= 1);
        sl_field_coarsen(&field, 4, &coarse);
        for (int32_t k = 0; k < size[1] / 4 * 4; k++) {
            for (int32_t i = 0; i < size[0] / 4 * 4; i++) {
                all += cells[(low[1] + k) * SIDE + low[0] + i];
            }
        }
        for (int32_t k = 0; k < size[1] / 4; k++) {
            all -= coarse.sum[k * coarse.stride + size[0] / 4];
        }
        assert_true(all == 0);
        sl_pack_mask_clear(&mask);
        sl_field_clear(&field);
        sl_field_clear(&coarse);
        free(cells);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_mask_holds_every_cell_that_the_grown_chart_touches),
        cmocka_unit_test(a_mask_larger_than_allowed_has_no_cells),
        cmocka_unit_test(a_board_finds_the_best_free_place),
        cmocka_unit_test(a_field_sums_the_weights_under_a_mask),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
