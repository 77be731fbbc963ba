#include "support/test_support.h"

#include "base/file.h"
#include "base/memory.h"
#include "theorem/theorem_internal.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

/* A random mirrored graph with every kind of edge. */
static sl_theorem_graph *random_graph(test_rng *rng, int32_t pairs, int32_t fixed, int32_t edges)
{
    sl_edges list = {.pairs = pairs, .fixed = fixed};
    for (int32_t k = 0; k < edges; k++) {
        const int32_t i = test_index(rng, pairs), j = test_index(rng, pairs);
        const int32_t kind = test_index(rng, fixed > 0 ? 4 : 2);
        if (kind == 0 && i != j) {
            sl_edges_within(&list, i, j);
        } else if (kind == 1) {
            sl_edges_across(&list, i, j);
        } else if (kind == 2) {
            sl_edges_spoke(&list, i, test_index(rng, fixed));
        } else if (kind == 3 && fixed > 1) {
            sl_edges_fixed(&list, 0, 1 + test_index(rng, fixed - 1));
        }
    }
    sl_theorem_graph *graph;
    assert_int_equal(sl_edges_finish(&list, &graph), SL_OK);
    return graph;
}

static void mirror_images_of_random_edges_make_an_automorphism_and_one_edge_less_does_not(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0x7e0);
    for (int trial = 0; trial < 50 * test_multiplier(); trial++) {
        sl_theorem_graph *graph = random_graph(&rng, 3 + test_index(&rng, 9), test_index(&rng, 3), 30), *broken;
        int32_t at, edge[200], count = 0, dropped = -1;
        assert_int_equal(sl_theorem_graph_check(graph, NULL, &at), SL_OK);
        assert_int_equal(at, -1);
        for (int32_t i = 0; i < graph->graph.n; i++) {
            for (int32_t p = graph->graph.first[i]; p < graph->graph.first[i + 1]; p++) {
                const int32_t j = graph->graph.adj[p];
                const bool own_image =
                    j == sl_theorem_image(graph, i) || (i >= 2 * graph->pairs && j >= 2 * graph->pairs);
                if (j < i) {
                    continue;
                }
                if (dropped < 0 && !own_image) {
                    dropped = i;
                    continue;
                }
                edge[2 * count] = i;
                edge[2 * count++ + 1] = j;
            }
        }
        assert_true(dropped >= 0);
        assert_int_equal(sl_theorem_graph_create(graph->pairs, graph->fixed, edge, count, &broken), SL_OK);
        assert_int_equal(sl_theorem_graph_check(broken, NULL, &at), SL_OK);
        assert_true(at >= 0);
        sl_theorem_graph_free(broken);
        sl_theorem_graph_free(graph);
    }
}

static void edges_that_cannot_be_are_refused(void **state)
{
    (void)state;
    sl_theorem_graph *graph;
    const int32_t loop[] = {2, 2}, far[] = {0, 7}, good[] = {0, 6};
    assert_int_equal(sl_theorem_graph_create(3, 1, loop, 1, &graph), SL_BAD_INPUT);
    assert_null(graph);
    assert_int_equal(sl_theorem_graph_create(3, 1, far, 1, &graph), SL_BAD_INPUT);
    assert_int_equal(sl_theorem_graph_create(0, 0, far, 0, &graph), SL_BAD_INPUT);
    assert_int_equal(sl_theorem_graph_create(-1, 3, far, 0, &graph), SL_BAD_INPUT);
    assert_int_equal(sl_theorem_graph_create(3, 1, good, 1, &graph), SL_OK);
    sl_theorem_graph_free(graph);
    sl_theorem_graph_free(NULL);
}

/* A shuffled copy, given with its involution, comes back as a mirrored graph with the same neighbours. */
static void a_shuffled_graph_is_renumbered_by_its_involution(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0x5f1);
    for (int trial = 0; trial < 30 * test_multiplier(); trial++) {
        sl_theorem_graph *graph = random_graph(&rng, 7, 3, 25), *again, *shuffled;
        const int32_t n = sl_theorem_nodes(graph);
        int32_t to[17], mirror[17], edge[400], count = 0, at;
        for (int32_t i = 0; i < n; i++) {
            const int32_t k = test_index(&rng, i + 1);
            to[i] = i;
            const int32_t t = to[i];
            to[i] = to[k];
            to[k] = t;
        }
        for (int32_t i = 0; i < n; i++) {
            mirror[to[i]] = to[sl_theorem_image(graph, i)];
            for (int32_t p = graph->graph.first[i]; p < graph->graph.first[i + 1]; p++) {
                if (graph->graph.adj[p] > i) {
                    edge[2 * count] = to[i];
                    edge[2 * count++ + 1] = to[graph->graph.adj[p]];
                }
            }
        }
        assert_int_equal(sl_theorem_graph_create(0, n, edge, count, &shuffled), SL_OK);
        assert_int_equal(sl_theorem_graph_from_mirror(&shuffled->graph, mirror, mirror, &again), SL_OK);
        assert_int_equal(again->pairs, 7);
        assert_int_equal(again->fixed, 3);
        assert_int_equal(again->graph.first[n], graph->graph.first[n]);
        assert_int_equal(sl_theorem_graph_check(again, NULL, &at), SL_OK);
        assert_int_equal(at, -1);
        for (int32_t i = 0; i < n; i++) { /* the second involution given was the mirror itself */
            assert_int_equal(again->second[i], sl_theorem_image(again, i));
            assert_int_equal(mirror[again->label[i]], again->label[sl_theorem_image(again, i)]);
        }
        mirror[0] = mirror[0] == 1 ? 2 : 1; /* no involution any more */
        sl_theorem_graph *none;
        assert_int_equal(sl_theorem_graph_from_mirror(&shuffled->graph, mirror, NULL, &none), SL_BAD_INPUT);
        assert_null(none);
        sl_theorem_graph_free(shuffled);
        sl_theorem_graph_free(again);
        sl_theorem_graph_free(graph);
    }
}

/* x' M x over the lower triangle. */
static double quadratic(const sl_csc *A, const double *x)
{
    double y[64], sum = 0.0;
    sl_csc_multiply_symmetric(A, x, 1, y);
    for (int32_t i = 0; i < A->ncols; i++) {
        sum += x[i] * y[i];
    }
    return sum;
}

/* The blocks against L itself: for any half vector, its symmetric and antisymmetric lifts give the same quadratic form,
 * and the two lifts do not meet in L. */
static void the_blocks_are_l_on_symmetric_and_antisymmetric_vectors(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0xb10c);
    for (int trial = 0; trial < 40 * test_multiplier(); trial++) {
        sl_theorem_graph *graph = random_graph(&rng, 2 + test_index(&rng, 8), test_index(&rng, 4), 40);
        const int32_t n = graph->pairs, m = graph->fixed, nodes = sl_theorem_nodes(graph);
        sl_csc *L, *S, *T;
        double s[64], t[64], vs[64] = {0}, vt[64] = {0}, Lt[64], cross = 0.0;
        assert_int_equal(sl_matrix_whole(graph, &L), SL_OK);
        assert_int_equal(sl_matrix_symmetric(graph, &S), SL_OK);
        assert_int_equal(sl_matrix_antisymmetric(graph, &T), SL_OK);
        for (int32_t i = 0; i < n + m; i++) {
            s[i] = test_uniform(&rng, -1.0, 1.0);
            t[i] = test_uniform(&rng, -1.0, 1.0);
        }
        for (int32_t i = 0; i < n; i++) {
            vs[i] = vs[i + n] = s[i] / sqrt(2.0);
            vt[i] = t[i] / sqrt(2.0);
            vt[i + n] = -vt[i];
        }
        for (int32_t k = 0; k < m; k++) {
            vs[2 * n + k] = s[n + k];
        }
        assert_true(test_near(quadratic(S, s), quadratic(L, vs), 1e-12 * 40));
        assert_true(test_near(quadratic(T, t), quadratic(L, vt), 1e-12 * 40));
        sl_csc_multiply_symmetric(L, vt, 1, Lt);
        for (int32_t i = 0; i < nodes; i++) {
            cross += vs[i] * Lt[i];
        }
        assert_true(test_near(cross, 0.0, 1e-12 * 40));
        sl_csc_free(L);
        sl_csc_free(S);
        sl_csc_free(T);
        sl_theorem_graph_free(graph);
    }
}

/* Brute force over all choices of halves: is there one for which no edge of this component is crossed? */
static bool can_be_uncrossed(const sl_half *half, int32_t component)
{
    for (uint32_t choice = 0; choice < (1u << half->n); choice++) {
        bool good = true;
        for (int32_t i = 0; i < half->n && good; i++) {
            for (int32_t p = half->first[i]; half->component[i] == component && p < half->first[i + 1]; p++) {
                const bool turned = ((choice >> i) & 1) != ((choice >> half->other[p]) & 1);
                good = good && turned == (half->sign[p] < 0);
            }
        }
        if (good) {
            return true;
        }
    }
    return false;
}

static void a_component_is_balanced_iff_some_choice_of_halves_uncrosses_it(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0x8a1);
    int32_t balanced = 0, unbalanced = 0;
    for (int trial = 0; trial < 200 * test_multiplier(); trial++) {
        sl_theorem_graph *graph = random_graph(&rng, 9, test_index(&rng, 2), 4 + test_index(&rng, 9));
        sl_half half;
        assert_int_equal(sl_half_create(graph, &half), SL_OK);
        for (int32_t c = 0; c < half.components; c++) {
            assert_int_equal(half.balanced[c], can_be_uncrossed(&half, c));
            balanced += half.balanced[c] ? 1 : 0;
            unbalanced += half.balanced[c] ? 0 : 1;
        }
        for (int32_t i = 0; i < half.n; i++) { /* and `turn` is such a choice */
            for (int32_t p = half.first[i]; half.balanced[half.component[i]] && p < half.first[i + 1]; p++) {
                assert_int_equal(half.turn[i] * half.turn[half.other[p]], half.sign[p]);
            }
        }
        sl_half_clear(&half);
        sl_theorem_graph_free(graph);
    }
    assert_true(balanced > 100 && unbalanced > 30);
}

static void a_graph_file_reads_back_as_it_was_written(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0xf11e);
    char path[512];
    snprintf(path, sizeof path, "%s", test_scratch("a.graph"));
    for (int trial = 0; trial < 10; trial++) {
        sl_theorem_graph *graph = random_graph(&rng, 6, test_index(&rng, 3), 20), *back;
        const int32_t n = sl_theorem_nodes(graph);
        sl_diag diag = sl_diag_none();
        graph->second = sl_alloc(n, sizeof *graph->second);
        for (int32_t i = 0; i < n; i++) {
            graph->second[i] = sl_theorem_image(graph, i);
        }
        assert_int_equal(sl_theorem_graph_write(path, graph, "a comment", &diag), SL_OK);
        assert_int_equal(sl_theorem_graph_read(path, &back, &diag), SL_OK);
        assert_int_equal(back->pairs, graph->pairs);
        assert_int_equal(back->fixed, graph->fixed);
        assert_memory_equal(back->graph.first, graph->graph.first, ((size_t)n + 1) * sizeof(int32_t));
        assert_memory_equal(back->second, graph->second, (size_t)n * sizeof(int32_t));
        for (int32_t i = 0; i < n; i++) { /* rows may be in another order */
            int64_t sum = 0, sum_back = 0;
            for (int32_t p = graph->graph.first[i]; p < graph->graph.first[i + 1]; p++) {
                sum += (int64_t)graph->graph.adj[p] * graph->graph.adj[p];
                sum_back += (int64_t)back->graph.adj[p] * back->graph.adj[p];
            }
            assert_int_equal(sum, sum_back);
        }
        sl_theorem_graph_free(graph);
        sl_theorem_graph_free(back);
    }
}

typedef struct bad_file {
    const char *text;
    int64_t line;
} bad_file;

static void bad_graph_files_are_refused_with_their_line(void **state)
{
    (void)state;
    static const bad_file bad[] = {
        {"", 0},
        {"off\n", 1},
        {"seamlab-theorem-graph 2\n", 1},
        {"seamlab-theorem-graph 0\npairs 1\nfixed 0\nedges 0\nend\n", 1},
        {"seamlab-theorem-graph 1\n\n# nothing\npairs -1\n", 4},
        {"seamlab-theorem-graph 1\npairs two\n", 2},
        {"seamlab-theorem-graph 1\npairs 0\nfixed 0\nedges 0\nend\n", 4},
        {"seamlab-theorem-graph 1\npairs 40000000\nfixed 0\nedges 0\nend\n", 4},
        {"seamlab-theorem-graph 1\npairs 2\nfixed 0\nedges 2\n0 1\n0 4\nend\n", 6},
        {"seamlab-theorem-graph 1\npairs 2\nfixed 0\nedges 1\n1 1\nend\n", 5},
        {"seamlab-theorem-graph 1\npairs 2\nfixed 0\nedges 1\n1 2 3\nend\n", 5},
        {"seamlab-theorem-graph 1\npairs 2\nfixed 0\nedges 1\n1\nend\n", 5},
        {"seamlab-theorem-graph 1\npairs 2\nfixed 0\nedges 9\n1 2\n", 5},
        {"seamlab-theorem-graph 1\npairs 2\nfixed 0\nedges 1\n1 2\n", 5},
        {"seamlab-theorem-graph 1\npairs 2\nfixed 0\nedges 1\n1 2\nfin\n", 6},
        {"seamlab-theorem-graph 1\npairs 2\nfixed 0\nedges 1\n1 2\nend\n3\n", 7},
        {"seamlab-theorem-graph 1\npairs 1\nfixed 1\nedges 1\n0 2\nsecond\n1\n2\n0\nend\n", 9},
        {"seamlab-theorem-graph 1\npairs 1\nfixed 0\nedges 1\n0 1\nsecond\n1\n0\n", 8},
        {"seamlab-theorem-graph 1\npairs 1\nfixed 0\nedges 1\n0 1\nsecond\n1\n", 7},
        {"seamlab-theorem-graph 1\npairs 1\nfixed 0\nedges 4000000000\n0 1\nend\n", 4},
    };
    char path[512];
    snprintf(path, sizeof path, "%s", test_scratch("bad.graph"));
    for (size_t k = 0; k < SL_COUNTOF(bad); k++) {
        sl_theorem_graph *graph;
        sl_diag diag = sl_diag_none();
        FILE *file = fopen(path, "wb");
        assert_non_null(file);
        fputs(bad[k].text, file);
        fclose(file);
        assert_int_equal(sl_theorem_graph_read(path, &graph, &diag), SL_BAD_INPUT);
        assert_null(graph);
        if (diag.line != bad[k].line) {
            printf("file %zu: line %d: %s\n", k, (int)diag.line, diag.reason);
        }
        assert_int_equal(diag.line, bad[k].line);
        assert_true(diag.reason[0] != '\0');
        assert_string_equal(diag.file, path);
    }
    sl_theorem_graph *graph;
    sl_diag diag = sl_diag_none();
    assert_int_equal(sl_theorem_graph_read(test_scratch("none.graph"), &graph, &diag), SL_IO);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(mirror_images_of_random_edges_make_an_automorphism_and_one_edge_less_does_not),
        cmocka_unit_test(edges_that_cannot_be_are_refused),
        cmocka_unit_test(a_shuffled_graph_is_renumbered_by_its_involution),
        cmocka_unit_test(the_blocks_are_l_on_symmetric_and_antisymmetric_vectors),
        cmocka_unit_test(a_component_is_balanced_iff_some_choice_of_halves_uncrosses_it),
        cmocka_unit_test(a_graph_file_reads_back_as_it_was_written),
        cmocka_unit_test(bad_graph_files_are_refused_with_their_line),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
