/* Dijkstra against Floyd-Warshall. */
#include "graph/random_graph.h"

#include <math.h>

enum { MAX_NODES = 40, MAX_EDGES = 120 };

typedef struct path_case {
    int32_t n, edges, nsources;
    test_edge edge[MAX_EDGES];
    int32_t source[3];
    double start[3];
    sl_graph graph;
    double all_pairs[MAX_NODES][MAX_NODES];
    double distance[MAX_NODES];
    int32_t parent[MAX_NODES], entry[MAX_NODES];
} path_case;

static void floyd_warshall(path_case *c)
{
    for (int32_t i = 0; i < c->n; i++) {
        for (int32_t j = 0; j < c->n; j++) {
            c->all_pairs[i][j] = i == j ? 0.0 : HUGE_VAL;
        }
    }
    for (int32_t e = 0; e < c->edges; e++) {
        const int32_t a = c->edge[e].a, b = c->edge[e].b;
        c->all_pairs[a][b] = c->all_pairs[b][a] = fmin(c->all_pairs[a][b], c->edge[e].weight);
    }
    for (int32_t k = 0; k < c->n; k++) {
        for (int32_t i = 0; i < c->n; i++) {
            for (int32_t j = 0; j < c->n; j++) {
                c->all_pairs[i][j] = fmin(c->all_pairs[i][j], c->all_pairs[i][k] + c->all_pairs[k][j]);
            }
        }
    }
}

/* whole: bound of the weights, 0 = real ones. */
static void make_case(test_rng *rng, int32_t whole, path_case *c)
{
    c->n = 2 + test_index(rng, MAX_NODES - 1);
    c->edges = test_index(rng, MAX_EDGES);
    c->nsources = 1 + test_index(rng, 3);
    test_random_edges(rng, c->n, whole, c->edge, c->edges);
    for (int32_t k = 0; k < 3; k++) {
        c->source[k] = test_index(rng, c->n);
        c->start[k] = whole > 0 ? test_index(rng, whole) : test_uniform(rng, 0.0, 2.0);
    }
    c->graph = test_graph_from_edges(c->n, c->edge, c->edges);
    floyd_warshall(c);
}

static double expected_distance(const path_case *c, int32_t i, bool with_start)
{
    double best = HUGE_VAL;
    for (int32_t k = 0; k < c->nsources; k++) {
        best = fmin(best, (with_start ? c->start[k] : 0.0) + c->all_pairs[c->source[k]][i]);
    }
    return best;
}

static double source_start(const path_case *c, int32_t i, bool with_start)
{
    double best = HUGE_VAL;
    for (int32_t k = 0; k < c->nsources; k++) {
        best = c->source[k] == i ? fmin(best, with_start ? c->start[k] : 0.0) : best;
    }
    return best;
}

/* Each node hangs on its parent by an entry of the parent's row that explains its distance to the last bit. */
static void check_tree(const path_case *c, bool with_start)
{
    for (int32_t i = 0; i < c->n; i++) {
        const int32_t parent = c->parent[i], entry = c->entry[i];
        if (parent < 0) {
            assert_int_equal(entry, -1);
            assert_true(c->distance[i] == source_start(c, i, with_start)); /* HUGE_VAL if it is no source */
            continue;
        }
        assert_in_range(entry, c->graph.first[parent], c->graph.first[parent + 1] - 1);
        assert_int_equal(c->graph.adj[entry], i);
        assert_true(c->distance[i] == c->distance[parent] + c->graph.weight[entry]);
    }
}

static void distances_are_those_of_floyd_warshall(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0xd15c);
    for (int trial = 0; trial < 600 * test_multiplier(); trial++) {
        path_case c;
        const bool with_start = trial % 2 == 0;
        make_case(&rng, trial % 3 == 0 ? 6 : 0, &c);
        assert_int_equal(sl_graph_shortest_paths(&c.graph, c.source, c.nsources, with_start ? c.start : NULL, -1,
                                                 c.distance, c.parent, c.entry),
                         SL_OK);
        for (int32_t i = 0; i < c.n; i++) {
            const double expected = expected_distance(&c, i, with_start);
            assert_true(expected == c.distance[i] || test_near_rel(c.distance[i], expected, 64 * TEST_EPS));
        }
        check_tree(&c, with_start);
        sl_graph_clear(&c.graph);
    }
}

static void target_has_its_final_distance_when_the_search_stops_there(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0x7a46);
    for (int trial = 0; trial < 600 * test_multiplier(); trial++) {
        path_case c;
        make_case(&rng, 9, &c);
        const int32_t target = test_index(&rng, c.n);
        assert_int_equal(
            sl_graph_shortest_paths(&c.graph, c.source, c.nsources, NULL, target, c.distance, c.parent, NULL), SL_OK);
        assert_true(c.distance[target] == expected_distance(&c, target, false));
        for (int32_t i = 0; i < c.n; i++) {
            assert_true(c.distance[i] >= expected_distance(&c, i, false));
            assert_true(expected_distance(&c, i, false) >= c.distance[target] ||
                        c.distance[i] == expected_distance(&c, i, false));
        }
        sl_graph_clear(&c.graph);
    }
}

static void search_does_not_go_beyond_its_target(void **state)
{
    (void)state;
    const test_edge edge[] = {{0, 1, 0.7}, {1, 2, 1.3}, {2, 3, 0.4}, {3, 4, 2.1}};
    const int32_t source = 0;
    double distance[5];
    int32_t parent[5];
    sl_graph g = test_graph_from_edges(5, edge, 4);
    assert_int_equal(sl_graph_shortest_paths(&g, &source, 1, NULL, 1, distance, parent, NULL), SL_OK);
    assert_true(distance[1] == 0.7 && distance[2] == HUGE_VAL && distance[3] == HUGE_VAL);
    sl_graph_clear(&g);
}

/* Of all best ways the one over the parent settled first: by distance, then by number. */
static void ties_are_broken_by_the_smaller_node_number(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0x71e5);
    for (int trial = 0; trial < 600 * test_multiplier(); trial++) {
        path_case c;
        make_case(&rng, 3, &c);
        for (int32_t p = 0; p < c.graph.first[c.n]; p++) {
            c.graph.weight[p] += 1.0; /* 1, 2 or 3: many ties, no zeros */
        }
        assert_int_equal(sl_graph_shortest_paths(&c.graph, c.source, c.nsources, NULL, -1, c.distance, c.parent, NULL),
                         SL_OK);
        for (int32_t i = 0; i < c.n; i++) {
            for (int32_t p = c.graph.first[i]; p < c.graph.first[i + 1]; p++) {
                const int32_t j = c.graph.adj[p];
                if (c.parent[i] >= 0 && c.distance[j] + c.graph.weight[p] == c.distance[i]) {
                    const double d = c.distance[c.parent[i]];
                    assert_true(d < c.distance[j] || (d == c.distance[j] && c.parent[i] <= j));
                }
            }
        }
        sl_graph_clear(&c.graph);
    }
}

static void missing_weights_count_one_each(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0x1111);
    for (int trial = 0; trial < 200 * test_multiplier(); trial++) {
        path_case c;
        make_case(&rng, 5, &c);
        for (int32_t e = 0; e < c.edges; e++) {
            c.edge[e].weight = 1.0;
        }
        floyd_warshall(&c);
        sl_free(c.graph.weight);
        c.graph.weight = NULL;
        assert_int_equal(sl_graph_shortest_paths(&c.graph, c.source, c.nsources, NULL, -1, c.distance, c.parent, NULL),
                         SL_OK);
        for (int32_t i = 0; i < c.n; i++) {
            assert_true(c.distance[i] == expected_distance(&c, i, false));
        }
        sl_graph_clear(&c.graph);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(distances_are_those_of_floyd_warshall),
        cmocka_unit_test(target_has_its_final_distance_when_the_search_stops_there),
        cmocka_unit_test(search_does_not_go_beyond_its_target),
        cmocka_unit_test(ties_are_broken_by_the_smaller_node_number),
        cmocka_unit_test(missing_weights_count_one_each),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
