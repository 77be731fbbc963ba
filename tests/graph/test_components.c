/* Components against repeated merging of labels. */
#include "graph/random_graph.h"

enum { MAX_NODES = 60, MAX_EDGES = 90 };

/* The smallest node each node can reach, by merging until nothing changes. */
static void roots_by_merging(int32_t n, const test_edge *edge, int32_t edges, const int32_t *key, int32_t *root)
{
    for (int32_t i = 0; i < n; i++) {
        root[i] = i;
    }
    for (bool changed = true; changed;) {
        changed = false;
        for (int32_t e = 0; e < edges; e++) {
            const int32_t a = edge[e].a, b = edge[e].b;
            if ((key == NULL || key[a] == key[b]) && root[a] != root[b]) {
                const int32_t low = root[a] < root[b] ? root[a] : root[b];
                root[a] = root[b] = low;
                changed = true;
            }
        }
    }
}

static void check_components(test_rng *rng, bool keyed)
{
    test_edge edge[MAX_EDGES];
    int32_t root[MAX_NODES], label[MAX_NODES], number[MAX_NODES], key[MAX_NODES], count = -1, expected = 0;
    const int32_t n = 1 + test_index(rng, MAX_NODES), edges = test_index(rng, MAX_EDGES);
    test_random_edges(rng, n, 5, edge, edges);
    for (int32_t i = 0; i < n; i++) {
        key[i] = 17 - 9 * test_index(rng, 3);
    }
    sl_graph g = test_graph_from_edges(n, edge, edges);
    assert_int_equal(sl_graph_components(&g, keyed ? key : NULL, label, &count), SL_OK);
    roots_by_merging(n, edge, edges, keyed ? key : NULL, root);
    for (int32_t i = 0; i < n; i++) { /* numbered by first node */
        number[i] = root[i] == i ? expected++ : number[root[i]];
        assert_int_equal(label[i], number[i]);
    }
    assert_int_equal(count, expected);
    sl_graph_clear(&g);
}

static void components_are_those_found_by_merging(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0xc0de);
    for (int trial = 0; trial < 1000 * test_multiplier(); trial++) {
        check_components(&rng, false);
    }
}

static void components_do_not_join_nodes_of_different_keys(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0x4e75);
    for (int trial = 0; trial < 1000 * test_multiplier(); trial++) {
        check_components(&rng, true);
    }
}

static void empty_graph_has_no_component_and_can_be_cleared_twice(void **state)
{
    (void)state;
    sl_graph g = test_graph_from_edges(0, NULL, 0);
    int32_t count = -1;
    assert_int_equal(sl_graph_components(&g, NULL, NULL, &count), SL_OK);
    assert_int_equal(count, 0);
    sl_graph_clear(&g);
    assert_null(g.first);
    sl_graph_clear(&g);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(components_are_those_found_by_merging),
        cmocka_unit_test(components_do_not_join_nodes_of_different_keys),
        cmocka_unit_test(empty_graph_has_no_component_and_can_be_cleared_twice),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
