/* Minimum cuts against all cuts of small graphs, and against planted cuts of larger ones. */
#include "graph/random_graph.h"

#include <math.h>

enum { MAX_NODES = 10, MAX_EDGES = 30 };

static double cut_value(const test_edge *edge, int32_t edges, uint32_t positive)
{
    double sum = 0.0;
    for (int32_t e = 0; e < edges; e++) {
        sum += (positive >> edge[e].a & 1) != (positive >> edge[e].b & 1) ? edge[e].weight : 0.0;
    }
    return sum;
}

static bool respects_seeds(const int8_t *seed, int32_t n, uint32_t positive)
{
    for (int32_t i = 0; i < n; i++) {
        if ((seed[i] > 0 && (positive >> i & 1) == 0) || (seed[i] < 0 && (positive >> i & 1) != 0)) {
            return false;
        }
    }
    return true;
}

/* Smallest value, and the intersection of all sides that have it (itself one of them, by submodularity). */
static double best_cut(const test_edge *edge, int32_t edges, const int8_t *seed, int32_t n, uint32_t *smallest)
{
    double best = HUGE_VAL;
    for (uint32_t positive = 0; positive < 1u << n; positive++) {
        if (respects_seeds(seed, n, positive)) {
            const double value = cut_value(edge, edges, positive);
            *smallest = value < best ? positive : value == best ? *smallest & positive : *smallest;
            best = fmin(best, value);
        }
    }
    return best;
}

/* At least one seed of each sign. */
static void random_seeds(test_rng *rng, int8_t *seed, int32_t n)
{
    for (int32_t i = 0; i < n; i++) {
        const int32_t roll = test_index(rng, 6);
        seed[i] = (int8_t)(roll == 0 ? 3 : roll == 1 ? -2 : 0);
    }
    const int32_t s = test_index(rng, n);
    seed[s] = 1;
    seed[(s + 1 + test_index(rng, n - 1)) % n] = -1;
}

static uint32_t side_bits(const uint8_t *side, int32_t n)
{
    uint32_t bits = 0;
    for (int32_t i = 0; i < n; i++) {
        bits |= (uint32_t)side[i] << i;
    }
    return bits;
}

static void cut_of_whole_capacities_is_the_smallest_of_all_with_the_smallest_side(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0xc075);
    for (int trial = 0; trial < 3000 * test_multiplier(); trial++) {
        test_edge edge[MAX_EDGES];
        int8_t seed[MAX_NODES];
        uint8_t side[MAX_NODES];
        uint32_t smallest = 0;
        double value = -1.0;
        const int32_t n = 2 + test_index(&rng, MAX_NODES - 1), edges = test_index(&rng, MAX_EDGES);
        test_random_edges(&rng, n, 8, edge, edges);
        random_seeds(&rng, seed, n);
        sl_graph g = test_graph_from_edges(n, edge, edges);
        assert_int_equal(sl_graph_min_cut(&g, seed, side, &value), SL_OK);
        assert_true(value == best_cut(edge, edges, seed, n, &smallest));
        assert_int_equal(side_bits(side, n), smallest);
        sl_graph_clear(&g);
    }
}

/* Tenths do not add up in binary: without the residual threshold the smallest side is missed. */
static void cut_of_real_capacities_is_the_smallest_of_all(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0x4ea1);
    for (int trial = 0; trial < 3000 * test_multiplier(); trial++) {
        test_edge edge[MAX_EDGES], whole[MAX_EDGES];
        int8_t seed[MAX_NODES];
        uint8_t side[MAX_NODES];
        uint32_t smallest = 0;
        double value = -1.0;
        const int32_t n = 2 + test_index(&rng, MAX_NODES - 1), edges = test_index(&rng, MAX_EDGES);
        test_random_edges(&rng, n, 8, whole, edges);
        for (int32_t e = 0; e < edges; e++) {
            edge[e] = whole[e];
            edge[e].weight = whole[e].weight / 10.0;
        }
        random_seeds(&rng, seed, n);
        sl_graph g = test_graph_from_edges(n, edge, edges);
        assert_int_equal(sl_graph_min_cut(&g, seed, side, &value), SL_OK);
        const double tenfold = best_cut(whole, edges, seed, n, &smallest);
        assert_true(test_near_rel(10.0 * value, tenfold, 64 * TEST_EPS));
        assert_int_equal(side_bits(side, n), smallest);
        sl_graph_clear(&g);
    }
}

static void cut_of_capacities_of_very_different_size_is_nearly_the_smallest(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0x51e0);
    for (int trial = 0; trial < 2000 * test_multiplier(); trial++) {
        test_edge edge[MAX_EDGES];
        int8_t seed[MAX_NODES];
        uint8_t side[MAX_NODES];
        uint32_t smallest = 0;
        double value = -1.0;
        const int32_t n = 2 + test_index(&rng, MAX_NODES - 1), edges = test_index(&rng, MAX_EDGES);
        test_random_edges(&rng, n, 0, edge, edges);
        for (int32_t e = 0; e < edges; e++) {
            edge[e].weight = ldexp(edge[e].weight, test_index(&rng, 60) - 30);
        }
        random_seeds(&rng, seed, n);
        sl_graph g = test_graph_from_edges(n, edge, edges);
        assert_int_equal(sl_graph_min_cut(&g, seed, side, &value), SL_OK);
        assert_true(respects_seeds(seed, n, side_bits(side, n)));
        /* Rounding of the largest flows can hide what is 2^-53 of them; 2^-40 of the cut itself may be lost too. */
        const double best = best_cut(edge, edges, seed, n, &smallest);
        assert_true(test_near(value, best, 0x1p-38 * best + 0x1p-20));
        assert_true(test_near_rel(value, cut_value(edge, edges, side_bits(side, n)), 64 * TEST_EPS));
        sl_graph_clear(&g);
    }
}

static void infinite_capacities_are_cut_only_if_they_must_be(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0x1f1f);
    int infinite = 0;
    for (int trial = 0; trial < 2000 * test_multiplier(); trial++) {
        test_edge edge[MAX_EDGES];
        int8_t seed[MAX_NODES];
        uint8_t side[MAX_NODES];
        uint32_t smallest = 0;
        double value = -1.0;
        const int32_t n = 2 + test_index(&rng, MAX_NODES - 1), edges = test_index(&rng, MAX_EDGES);
        test_random_edges(&rng, n, 8, edge, edges);
        for (int32_t e = 0; e < edges / 4; e++) {
            edge[e].weight = HUGE_VAL;
        }
        random_seeds(&rng, seed, n);
        sl_graph g = test_graph_from_edges(n, edge, edges);
        assert_int_equal(sl_graph_min_cut(&g, seed, side, &value), SL_OK);
        assert_true(value == best_cut(edge, edges, seed, n, &smallest));
        infinite += value == HUGE_VAL;
        sl_graph_clear(&g);
    }
    assert_true(infinite > 100);
}

static void cut_without_negative_seeds_is_empty(void **state)
{
    (void)state;
    const test_edge edge[] = {{0, 1, 0.7}, {1, 2, 0.0}, {2, 3, 1.9}};
    const int8_t seed[] = {1, 0, 0, 0}, none[] = {0, 0, 0, 0};
    uint8_t side[4];
    double value = -1.0;
    sl_graph g = test_graph_from_edges(4, edge, 3);
    assert_int_equal(sl_graph_min_cut(&g, seed, side, &value), SL_OK);
    assert_true(value == 0.0);
    assert_int_equal(side_bits(side, 4), 0x3); /* no capacity leads on to 2 */
    assert_int_equal(sl_graph_min_cut(&g, none, side, &value), SL_OK);
    assert_true(value == 0.0);
    assert_int_equal(side_bits(side, 4), 0);
    sl_free(g.weight);
    g.weight = NULL; /* capacities of 1 */
    const int8_t ends[] = {0, 1, 0, -1};
    assert_int_equal(sl_graph_min_cut(&g, ends, side, &value), SL_OK);
    assert_true(value == 1.0);
    assert_int_equal(side_bits(side, 4), 0x3);
    sl_graph_clear(&g);
}

enum { SIZE = 60 };

/* A lattice of random strong edges; those across a wandering line are weak. The line's cut is the smallest: any other
 * cuts a strong edge, and each is worth more than the whole line. */
static void weak_line_across_a_large_lattice_is_found(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0x71fe);
    test_edge *edge = sl_alloc(2 * SIZE * SIZE, sizeof *edge);
    int8_t seed[SIZE * SIZE] = {0};
    uint8_t side[SIZE * SIZE], expected[SIZE * SIZE];
    int32_t edges = 0, height = SIZE / 2;
    for (int32_t x = 0; x < SIZE; x++) {
        height += test_index(&rng, 5) - 2;
        for (int32_t y = 0; y < SIZE; y++) {
            expected[SIZE * x + y] = y < height;
        }
        seed[SIZE * x] = 1;
        seed[SIZE * x + SIZE - 1] = -1;
    }
    double planted = 0.0;
    for (int32_t x = 0; x < SIZE; x++) {
        for (int32_t y = 0; y < SIZE; y++) {
            const int32_t i = SIZE * x + y, near[2] = {i + 1, i + SIZE};
            for (int k = 0; k < 2; k++) {
                if (k == 0 ? y + 1 < SIZE : x + 1 < SIZE) {
                    const bool weak = expected[i] != expected[near[k]];
                    const double weight = weak ? test_uniform(&rng, 0.001, 0.003) : test_uniform(&rng, 1.0, 9.0);
                    edge[edges++] = (test_edge){i, near[k], weight};
                    planted += weak ? weight : 0.0;
                }
            }
        }
    }
    sl_graph g = test_graph_from_edges(SIZE * SIZE, edge, edges);
    double value = -1.0;
    assert_true(planted < 1.0);
    assert_int_equal(sl_graph_min_cut(&g, seed, side, &value), SL_OK);
    assert_true(test_near_rel(value, planted, 1024 * TEST_EPS));
    assert_memory_equal(side, expected, sizeof side);
    sl_graph_clear(&g);
    sl_free(edge);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(cut_of_whole_capacities_is_the_smallest_of_all_with_the_smallest_side),
        cmocka_unit_test(cut_of_real_capacities_is_the_smallest_of_all),
        cmocka_unit_test(cut_of_capacities_of_very_different_size_is_nearly_the_smallest),
        cmocka_unit_test(infinite_capacities_are_cut_only_if_they_must_be),
        cmocka_unit_test(cut_without_negative_seeds_is_empty),
        cmocka_unit_test(weak_line_across_a_large_lattice_is_found),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
