/* Dissection of graphs: separators, leaves and their orders, vertex covers. */
#include "matrices.h"

#include "sparse/dissection.h"
#include "sparse/order.h"

/* side x side grid with `twins` unknowns at each point; all twins of neighbours joined, or each layer by itself; node
 * (x, y, k) has the number number[(y * side + x) * twins + k]. */
typedef struct grid {
    int32_t side, twins, n;
    int32_t *number;
    double *xyz;
    sl_adjacency graph;
} grid;

static grid grid_create(int32_t side, int32_t twins, bool layers, test_rng *rng)
{
    grid g = {.side = side, .twins = twins, .n = side * side * twins};
    g.number = sl_alloc(g.n, sizeof *g.number);
    g.xyz = sl_alloc(3 * (int64_t)g.n, sizeof *g.xyz);
    g.graph.n = g.n;
    g.graph.first = sl_calloc((int64_t)g.n + 1, sizeof *g.graph.first);
    g.graph.adj = sl_alloc(5 * (int64_t)g.n * twins, sizeof *g.graph.adj);
    int32_t *point = sl_alloc(g.n, sizeof *point), *layer = sl_alloc(g.n, sizeof *layer);
    assert_true(g.number && g.xyz && g.graph.first && g.graph.adj && point && layer);
    for (int32_t i = 0; i < g.n; i++) {
        const int32_t k = test_index(rng, i + 1);
        g.number[i] = g.number[k];
        g.number[k] = i;
    }
    for (int32_t i = 0; i < side * side; i++) {
        const double p[3] = {i % side + test_uniform(rng, -0.3, 0.3), i / side + test_uniform(rng, -0.3, 0.3),
                             test_uniform(rng, 0.0, 1.0)};
        for (int32_t k = 0; k < twins; k++) {
            const int32_t node = g.number[i * twins + k];
            memcpy(g.xyz + 3 * node, p, sizeof p);
            point[node] = i;
            layer[node] = k;
        }
    }
    int64_t filled = 0;
    for (int32_t v = 0; v < g.n; v++) {
        for (int32_t w = 0; w < g.n; w++) {
            const int32_t dx = abs(point[v] % side - point[w] % side), dy = abs(point[v] / side - point[w] / side);
            if (v != w && dx + dy <= 1 && (!layers || layer[v] == layer[w])) {
                g.graph.adj[filled++] = w;
            }
        }
        g.graph.first[v + 1] = filled;
    }
    sl_free(point);
    sl_free(layer);
    return g;
}

static void grid_clear(grid *g)
{
    sl_free(g->number);
    sl_free(g->xyz);
    sl_adjacency_clear(&g->graph);
}

/* Size of the part of the graph without `removed` pieces that start lies in; seen marks it. */
static int32_t flood(const sl_adjacency *graph, const int32_t *piece, int32_t removed, int32_t start, bool *seen,
                     int32_t *queue)
{
    int32_t head = 0, tail = 0;
    queue[tail++] = start;
    seen[start] = true;
    while (head < tail) {
        const int32_t v = queue[head++];
        for (int64_t p = graph->first[v]; p < graph->first[v + 1]; p++) {
            const int32_t w = graph->adj[p];
            if (!seen[w] && piece[w] != removed) {
                seen[w] = true;
                queue[tail++] = w;
            }
        }
    }
    return tail;
}

/* The last piece is the first separator: small, and without it no part is much more than half. */
static void check_top_separator(const grid *g, const double *xyz, double widest)
{
    int32_t *piece = sl_alloc(g->n, sizeof *piece), *queue = sl_alloc(g->n, sizeof *queue);
    bool *seen = sl_calloc(g->n, sizeof *seen);
    assert_true(piece && queue && seen);
    assert_int_equal(sl_dissect(&g->graph, xyz, NULL, piece, queue), SL_OK);
    assert_permutation(queue, g->n);
    for (int32_t k = 1; k < g->n; k++) {
        assert_in_range(piece[queue[k]] - piece[queue[k - 1]], 0, 1);
    }
    int32_t last = 0, size = 0;
    for (int32_t i = 0; i < g->n; i++) {
        last = piece[i] > last ? piece[i] : last;
    }
    for (int32_t i = 0; i < g->n; i++) {
        size += piece[i] == last;
    }
    assert_true(last >= 2);
    assert_true(size <= widest * g->side * g->twins);
    for (int32_t i = 0; i < g->n; i++) {
        if (!seen[i] && piece[i] != last) {
            assert_true(flood(&g->graph, piece, last, i, seen, queue) <= g->n / 2 + g->side * g->twins);
        }
    }
    for (int32_t i = 0; i < g->side * g->side && xyz != NULL; i++) {
        for (int32_t k = 1; k < g->twins; k++) {
            assert_int_equal(piece[g->number[i * g->twins + k]], piece[g->number[i * g->twins]]);
        }
    }
    sl_free(piece);
    sl_free(queue);
    sl_free(seen);
}

static void dissection_halves_a_grid_by_a_small_separator(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0xd155);
    for (int32_t twins = 1; twins <= 3; twins++) {
        for (int k = 0; k < 2; k++) {
            grid g = grid_create(24, twins, k == 1, &rng);
            check_top_separator(&g, g.xyz, 1.6);
            if (k == 0) {
                check_top_separator(&g, NULL, 2.0);
            }
            grid_clear(&g);
        }
    }
}

/* Monotone maps of the coordinates leave halves as they are, though nearly all points fall into one slice of the
 * extent, or the extent itself is no number. */
static void halves_do_not_depend_on_how_points_are_spread(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0x59ead);
    for (int map = 0; map < 5; map++) {
        grid g = grid_create(50, 1, false, &rng);
        for (int32_t k = 0; k < 3 * g.n; k++) {
            const double x = g.xyz[k] / g.side;
            const double spread[] = {exp(30.0 * x), x * x * x * 1e300, x * 1e-310, -exp(-300.0 * x),
                                     1.5e308 * (2.0 * x - 1.0)};
            g.xyz[k] = k % 3 == 2 ? 0.0 : spread[map];
        }
        check_top_separator(&g, g.xyz, 1.6);
        grid_clear(&g);
    }
}

/* Leaves keep their nodes and places, separators their order. */
static void ordered_leaves_are_the_same_leaves(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0x1eaf);
    for (int trial = 0; trial < 6 * test_multiplier(); trial++) {
        grid g = grid_create(20 + test_index(&rng, 6), 1, false, &rng);
        int32_t *piece = sl_alloc(g.n, sizeof *piece), *order = sl_alloc(g.n, sizeof *order), *before;
        bool complete = false, moved = false;
        assert_true(piece != NULL && order != NULL);
        assert_int_equal(sl_dissect(&g.graph, trial % 2 == 0 ? g.xyz : NULL, NULL, piece, order), SL_OK);
        before = sl_copy(order, g.n, sizeof *order);
        assert_non_null(before);
        assert_int_equal(sl_order_leaves(&g.graph, piece, NULL, order, &complete), SL_OK);
        assert_true(complete);
        assert_permutation(order, g.n);
        for (int32_t k = 0; k < g.n; k++) {
            bool separates = false;
            for (int64_t p = g.graph.first[order[k]]; p < g.graph.first[order[k] + 1]; p++) {
                separates = separates || piece[g.graph.adj[p]] < piece[order[k]];
            }
            assert_int_equal(piece[order[k]], piece[before[k]]);
            assert_true(!separates || order[k] == before[k]);
            moved = moved || order[k] != before[k];
        }
        assert_true(moved);
        sl_free(piece);
        sl_free(order);
        sl_free(before);
        grid_clear(&g);
    }
}

/* A leaf that is a tree is eliminated without fill: each node has at most one neighbour left when its turn comes. */
static void leaves_that_are_trees_are_eliminated_from_their_ends(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0x74ee);
    for (int trial = 0; trial < 50 * test_multiplier(); trial++) {
        const int32_t n = 1 + test_index(&rng, 128);
        sl_csc *A = random_spd(MATRIX_TREE, n, 0.3, &rng);
        sl_adjacency graph = {.n = n};
        int32_t *piece = sl_calloc(n, sizeof *piece), *order = sl_alloc(n, sizeof *order);
        int32_t *place = sl_alloc(n, sizeof *place);
        bool complete;
        graph.first = sl_calloc((int64_t)n + 1, sizeof *graph.first);
        graph.adj = sl_alloc(2 * (int64_t)n, sizeof *graph.adj);
        assert_true(piece && order && place && graph.first && graph.adj);
        int64_t filled = 0;
        for (int32_t v = 0; v < n; v++) {
            order[v] = v;
            for (int32_t j = 0; j < n; j++) {
                for (int64_t p = A->colptr[j] + 1; p < A->colptr[j + 1]; p++) {
                    if (j == v || A->row[p] == v) {
                        graph.adj[filled++] = j == v ? A->row[p] : j;
                    }
                }
            }
            graph.first[v + 1] = filled;
        }
        assert_int_equal(sl_order_leaves(&graph, piece, NULL, order, &complete), SL_OK);
        assert_true(complete);
        assert_permutation(order, n);
        for (int32_t k = 0; k < n; k++) {
            place[order[k]] = k;
        }
        for (int32_t v = 0; v < n; v++) {
            int32_t later = 0;
            for (int64_t p = graph.first[v]; p < graph.first[v + 1]; p++) {
                later += place[graph.adj[p]] > place[v];
            }
            assert_true(later <= 1);
        }
        sl_free(piece);
        sl_free(order);
        sl_free(place);
        sl_adjacency_clear(&graph);
        sl_csc_free(A);
    }
}

static int32_t degree_of(bool joined[100][100], const bool *gone, int32_t n, int32_t v)
{
    int32_t degree = 0;
    for (int32_t u = 0; u < n; u++) {
        degree += u != v && !gone[u] && joined[v][u];
    }
    return degree;
}

/* v goes; its neighbours are joined. */
static void eliminate_densely(bool joined[100][100], bool *gone, int32_t n, int32_t v)
{
    gone[v] = true;
    for (int32_t a = 0; a < n; a++) {
        for (int32_t b = 0; b < n; b++) {
            joined[a][b] = joined[a][b] || (!gone[a] && !gone[b] && joined[v][a] && joined[v][b]);
        }
    }
}

static void leaves_are_eliminated_by_least_degree_and_twins_at_once(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0x1eade);
    for (int trial = 0; trial < 40 * test_multiplier(); trial++) {
        static bool joined[100][100];
        const int32_t n = 2 + test_index(&rng, 98), edges = n + test_index(&rng, 2 * n);
        int64_t first[101] = {0};
        int32_t adj[10000], piece[100] = {0}, order[100];
        bool gone[100] = {false}, complete;
        memset(joined, 0, sizeof joined);
        for (int32_t e = 0; e < edges; e++) {
            const int32_t a = test_index(&rng, n), b = test_index(&rng, n);
            joined[a][b] = joined[b][a] = a != b;
        }
        for (int32_t v = 0; v < n; v++) {
            order[v] = v;
            first[v + 1] = first[v];
            for (int32_t u = 0; u < n; u++) {
                if (joined[v][u]) {
                    adj[first[v + 1]++] = u;
                }
            }
        }
        const sl_adjacency graph = {n, first, adj};
        assert_int_equal(sl_order_leaves(&graph, piece, NULL, order, &complete), SL_OK);
        assert_permutation(order, n);
        int32_t pivot_degree = -1; /* of the last that was chosen, less its twins */
        for (int32_t k = 0; k < n; k++) {
            const int32_t degree = degree_of(joined, gone, n, order[k]);
            bool least = true, twin = k > 0 && degree == pivot_degree - 1;
            for (int32_t u = 0; u < n; u++) {
                least = least && (gone[u] || degree_of(joined, gone, n, u) >= degree);
            }
            assert_true(least || twin);
            pivot_degree = degree;
            eliminate_densely(joined, gone, n, order[k]);
        }
    }
}

static bool is_cover(bool joined[6][6], int32_t left, int32_t right, const bool *left_in, const bool *right_in)
{
    for (int32_t l = 0; l < left; l++) {
        for (int32_t r = 0; r < right; r++) {
            if (joined[l][r] && !left_in[l] && !right_in[r]) {
                return false;
            }
        }
    }
    return true;
}

static int32_t smallest_cover(bool joined[6][6], int32_t left, int32_t right)
{
    int32_t best = left + right;
    for (int32_t set = 0; set < 1 << (left + right); set++) {
        bool left_in[6], right_in[6];
        int32_t size = 0;
        for (int32_t k = 0; k < left + right; k++) {
            const bool in = (set >> k & 1) != 0;
            size += in;
            if (k < left) {
                left_in[k] = in;
            } else {
                right_in[k - left] = in;
            }
        }
        if (size < best && is_cover(joined, left, right, left_in, right_in)) {
            best = size;
        }
    }
    return best;
}

static void vertex_covers_are_minimum(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0xc0ef);
    for (int trial = 0; trial < 300 * test_multiplier(); trial++) {
        const int32_t left = 1 + test_index(&rng, 6), right = 1 + test_index(&rng, 6),
                      density = 1 + test_index(&rng, 5);
        bool joined[6][6] = {{false}}, left_in[6], right_in[6];
        int64_t first[7] = {0}, next[6];
        int32_t adj[36], left_mate[6], right_mate[6], level[6], stack[6];
        int64_t edges = 0;
        for (int32_t l = 0; l < left; l++) {
            for (int32_t r = 0; r < right; r++) {
                joined[l][r] = test_index(&rng, 6) < density;
                if (joined[l][r]) {
                    adj[edges++] = r;
                }
            }
            first[l + 1] = edges;
        }
        sl_bipartite g = {left, right, first, adj, left_mate, right_mate, level, stack, next, left_in, right_in};
        sl_minimum_vertex_cover(&g);
        int32_t size = 0;
        for (int32_t k = 0; k < left; k++) {
            size += left_in[k];
        }
        for (int32_t k = 0; k < right; k++) {
            size += right_in[k];
        }
        assert_true(is_cover(joined, left, right, left_in, right_in));
        assert_int_equal(size, smallest_cover(joined, left, right));
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(dissection_halves_a_grid_by_a_small_separator),
        cmocka_unit_test(halves_do_not_depend_on_how_points_are_spread),
        cmocka_unit_test(ordered_leaves_are_the_same_leaves),
        cmocka_unit_test(leaves_that_are_trees_are_eliminated_from_their_ends),
        cmocka_unit_test(leaves_are_eliminated_by_least_degree_and_twins_at_once),
        cmocka_unit_test(vertex_covers_are_minimum),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
