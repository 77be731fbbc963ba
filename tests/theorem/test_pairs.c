#include "support/test_support.h"

#include "base/memory.h"
#include "theorem/theorem_internal.h"

#include <math.h>
#include <string.h>

static const double pi = TEST_PI;

/* Two paths of n nodes joined at their first: the path of 2 n nodes. */
static sl_theorem_graph *doubled_path(int32_t n)
{
    sl_edges edges = {.pairs = n};
    sl_theorem_graph *graph;
    for (int32_t i = 1; i < n; i++) {
        sl_edges_within(&edges, i - 1, i);
    }
    sl_edges_across(&edges, 0, 0);
    assert_int_equal(sl_edges_finish(&edges, &graph), SL_OK);
    return graph;
}

/* Path of 2 n nodes: lambda_k = 2 - 2 cos(pi k / (2 n)), even k symmetric, odd k antisymmetric; vector k at node i is
 * cos(pi k (i + 1/2) / (2 n)). */
static void half_spectra_of_a_doubled_path_are_the_even_and_odd_eigenvalues(void **state)
{
    (void)state;
    for (int32_t n = 2; n <= 90; n += 11) {
        sl_theorem_graph *graph = doubled_path(n);
        sl_csc *S, *T;
        sl_pairs s, t;
        assert_int_equal(sl_matrix_symmetric(graph, &S), SL_OK);
        assert_int_equal(sl_matrix_antisymmetric(graph, &T), SL_OK);
        assert_int_equal(sl_pairs_solve(S, 0, NULL, 0, 0.0, NULL, &s), SL_OK);
        assert_int_equal(sl_pairs_solve(T, 0, NULL, 0, 0.0, NULL, &t), SL_OK);
        assert_true(s.complete && s.sound && t.complete && t.sound);
        for (int32_t k = 0; k < n; k++) {
            assert_true(test_near(s.lambda[k], 2.0 - 2.0 * cos(pi * k / n), s.error));
            assert_true(test_near(t.lambda[k], 2.0 - 2.0 * cos(pi * (2 * k + 1) / (2.0 * n)), t.error));
        }
        assert_true(s.error < 1e-11 && t.error < 1e-11);
        sl_pairs_clear(&s);
        sl_pairs_clear(&t);
        sl_csc_free(S);
        sl_csc_free(T);
        sl_theorem_graph_free(graph);
    }
}

/* The bound against the truth: the distance of each computed vector to the known one. */
static void every_vector_of_a_path_is_within_its_bound_and_the_bound_is_no_empty_word(void **state)
{
    (void)state;
    for (int32_t mode = 0; mode < 2; mode++) { /* all by LAPACK; the lowest 12 by our own solver */
        const int32_t n = mode == 0 ? 80 : 300, nodes = 2 * n;
        sl_theorem_graph *graph = doubled_path(n);
        sl_csc *L;
        sl_pairs p;
        double *ones = sl_alloc(nodes, sizeof *ones), *exact = sl_alloc(nodes, sizeof *exact);
        assert_int_equal(sl_matrix_whole(graph, &L), SL_OK);
        for (int32_t i = 0; i < nodes; i++) {
            ones[i] = 1.0 / sqrt((double)nodes);
        }
        assert_int_equal(sl_pairs_solve(L, mode == 0 ? 0 : 12, ones, 1, 1e-12, NULL, &p), SL_OK);
        assert_int_equal(p.complete, mode == 0);
        assert_true(p.sound && p.clusters == p.count && p.count >= 11);
        for (int32_t k = 0; k < p.count; k++) {
            const double *v = sl_pairs_vector(&p, k);
            double squares = 0.0, dot = 0.0, distance = 0.0;
            for (int32_t i = 0; i < nodes;
                 i++) { /* node i < n is number n - 1 - i along the path, node n + i is n + i */
                const int32_t along = i < n ? n - 1 - i : i;
                exact[i] = cos(pi * k * (along + 0.5) / nodes);
                squares += exact[i] * exact[i];
                dot += exact[i] * v[i];
            }
            for (int32_t i = 0; i < nodes; i++) {
                const double d = v[i] - dot / squares * exact[i];
                distance += d * d;
            }
            assert_true(sqrt(distance) <= p.bound[k]);
            assert_true(p.bound[k] < 1e-6);
        }
        sl_pairs_clear(&p);
        sl_free(ones);
        sl_free(exact);
        sl_csc_free(L);
        sl_theorem_graph_free(graph);
    }
}

/* A vector that is moved comes with a residual that says so. */
static void a_moved_vector_is_unsound_and_its_bound_covers_the_move(void **state)
{
    (void)state;
    sl_theorem_graph *graph = doubled_path(30);
    sl_csc *L;
    sl_pairs p;
    assert_int_equal(sl_matrix_whole(graph, &L), SL_OK);
    assert_int_equal(sl_pairs_solve(L, 0, NULL, 0, 0.0, NULL, &p), SL_OK);
    p.vector[(int64_t)p.n * 5 + 3] += 1e-3;
    assert_int_equal(sl_pairs_judge(L, 1e-12, &p), SL_OK);
    assert_false(p.sound);
    assert_true(p.bound[5] > 0.99e-3);
    sl_pairs_clear(&p);
    sl_csc_free(L);
    sl_theorem_graph_free(graph);
}

/* Repeated eigenvalues stand in one cluster: a torus of 6 x 6. */
static void repeated_eigenvalues_form_clusters(void **state)
{
    (void)state;
    sl_edges edges = {.fixed = 36};
    sl_theorem_graph *graph;
    sl_csc *L;
    sl_pairs p;
    for (int32_t i = 0; i < 36; i++) {
        sl_edges_fixed(&edges, i, i / 6 * 6 + (i + 1) % 6);
        sl_edges_fixed(&edges, i, (i + 6) % 36);
    }
    assert_int_equal(sl_edges_finish(&edges, &graph), SL_OK);
    assert_int_equal(sl_matrix_whole(graph, &L), SL_OK);
    assert_int_equal(sl_pairs_solve(L, 0, NULL, 0, 0.0, NULL, &p), SL_OK);
    /* 2 - 2 cos(2 pi j / 6) = 0, 1, 1, 3, 3, 4: sums of two of these */
    const double value[] = {0, 1, 2, 3, 4, 5, 6, 7, 8};
    const int32_t times[] = {1, 4, 4, 4, 10, 4, 4, 4, 1};
    assert_int_equal(p.clusters, 9);
    for (int32_t c = 0; c < 9; c++) {
        assert_int_equal(p.first[c + 1] - p.first[c], times[c]);
        assert_true(test_near(p.lambda[p.first[c]], value[c], 1e-12));
        assert_true(p.bound[c] < 1e-11);
    }
    sl_pairs_clear(&p);
    sl_csc_free(L);
    sl_theorem_graph_free(graph);
}

/* A torus of 30 x 30 has eigenvalues 0, then 4 equal ones, then 4: of seven pairs asked for, two belong to a cluster
 * that goes on. */
static void a_cluster_cut_by_the_count_is_dropped(void **state)
{
    (void)state;
    const int32_t side = 30, n = side * side;
    sl_edges edges = {.fixed = n};
    sl_theorem_graph *graph;
    sl_csc *L;
    sl_pairs p;
    double *ones = sl_alloc(n, sizeof *ones);
    for (int32_t i = 0; i < n; i++) {
        ones[i] = 1.0 / side;
        sl_edges_fixed(&edges, i, i / side * side + (i + 1) % side);
        sl_edges_fixed(&edges, i, (i + side) % n);
    }
    assert_int_equal(sl_edges_finish(&edges, &graph), SL_OK);
    assert_int_equal(sl_matrix_whole(graph, &L), SL_OK);
    assert_int_equal(sl_pairs_solve(L, 7, ones, 1, 1e-12, NULL, &p), SL_OK);
    assert_int_equal(p.count, 5);
    assert_int_equal(p.clusters, 2);
    assert_true(p.bound[1] < 1e-6);
    assert_true(p.end > p.lambda[4] + 0.01 && p.end < 4.0 - 4.0 * cos(2.0 * pi / side) + 1e-9);
    sl_pairs_clear(&p);
    sl_free(ones);
    sl_csc_free(L);
    sl_theorem_graph_free(graph);
}

/* Against LAPACK: clusters whose part of e_f is not 0. High-entropy integer weights, and graphs with symmetries. */
static void the_recurrence_counts_the_eigenvalues_seen_from_a_row(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0x2e20);
    int32_t less = 0;
    for (int trial = 0; trial < 60 * test_multiplier(); trial++) {
        const int32_t n = 2 + test_index(&rng, 23);
        const bool weights = trial % 3 == 0;
        int32_t row[400], col[400];
        double val[400];
        int64_t count = 0;
        for (int32_t i = 0; i < n; i++) {
            row[count] = col[count] = i;
            val[count++] = weights ? (double)(test_index(&rng, 41) - 20) : 2.0;
            const bool ring = trial % 3 == 1; /* as many symmetries as a graph can have */
            for (int32_t k = 0; i > 0 && k < (ring && i < n - 1 ? 1 : 2); k++) {
                row[count] = i;
                col[count] = weights ? test_index(&rng, i) : k == 0 ? i - 1 : 0;
                val[count++] = weights ? (double)(test_index(&rng, 15) - 7) : -1.0;
            }
        }
        sl_csc *A;
        sl_pairs p;
        assert_int_equal(sl_csc_from_triplets(n, n, count, row, col, val, &A), SL_OK);
        assert_int_equal(sl_pairs_solve(A, 0, NULL, 0, 0.0, NULL, &p), SL_OK);
        for (int32_t f = 0; f < n; f += 3) {
            int32_t seen = 0, counted = -1;
            for (int32_t c = 0; c < p.clusters; c++) {
                double squares = 0.0;
                for (int32_t k = p.first[c]; k < p.first[c + 1]; k++) {
                    squares += sl_pairs_vector(&p, k)[f] * sl_pairs_vector(&p, k)[f];
                }
                seen += sqrt(squares) > 1e-11 ? 1 : 0;
            }
            assert_int_equal(sl_distinct_at(A, f, &counted), SL_OK);
            assert_int_equal(counted, seen);
            less += counted < n ? 1 : 0;
        }
        sl_pairs_clear(&p);
        sl_csc_free(A);
    }
    assert_true(less > 20);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(half_spectra_of_a_doubled_path_are_the_even_and_odd_eigenvalues),
        cmocka_unit_test(every_vector_of_a_path_is_within_its_bound_and_the_bound_is_no_empty_word),
        cmocka_unit_test(a_moved_vector_is_unsound_and_its_bound_covers_the_move),
        cmocka_unit_test(repeated_eigenvalues_form_clusters),
        cmocka_unit_test(a_cluster_cut_by_the_count_is_dropped),
        cmocka_unit_test(the_recurrence_counts_the_eigenvalues_seen_from_a_row),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
