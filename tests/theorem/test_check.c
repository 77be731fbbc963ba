#include "support/test_support.h"

#include "base/memory.h"
#include "theorem/families_internal.h"

#include <math.h>
#include <string.h>

static sl_theorem_result check(const sl_theorem_graph *graph)
{
    const sl_theorem_def def = sl_theorem_default();
    sl_theorem_result result;
    assert_int_equal(sl_theorem_check(graph, &def, NULL, &result), SL_OK);
    return result;
}

static sl_theorem_graph *finish(sl_edges *edges)
{
    sl_theorem_graph *graph;
    assert_int_equal(sl_edges_finish(edges, &graph), SL_OK);
    return graph;
}

static bool holds(const sl_theorem_result *result, sl_theorem_statement statement)
{
    const sl_theorem_tally *t = &result->tally[statement];
    return t->holds > 0 && t->undecided == 0 && t->violated == 0;
}

static int64_t asked(const sl_theorem_result *result, sl_theorem_statement statement)
{
    const sl_theorem_tally *t = &result->tally[statement];
    return t->holds + t->undecided + t->violated;
}

static void assert_none_violated(const sl_theorem_result *result)
{
    if (result->failed != SL_THEOREM_STATEMENTS) {
        print_message("%s: %s\n", sl_theorem_statement_name(result->failed), result->reason);
    }
    assert_int_equal(result->failed, SL_THEOREM_STATEMENTS);
    for (int32_t s = 0; s < SL_THEOREM_STATEMENTS; s++) {
        assert_int_equal(result->tally[s].violated, 0);
    }
}

static void the_graph_of_figure_17_has_the_spectrum_of_the_record(void **state)
{
    (void)state;
    sl_theorem_result result = {.failed = SL_THEOREM_STATEMENTS};
    sl_theorem_graph *graph;
    assert_int_equal(sl_theorem_check_figure17(&result), SL_OK);
    assert_true(holds(&result, SL_THEOREM_FIGURE17));
    assert_int_equal(sl_theorem_figure17(&graph), SL_OK);
    assert_int_equal(graph->pairs, 4);
    assert_int_equal(graph->graph.first[8], 2 * 10);
    result = check(graph);
    assert_none_violated(&result);
    /* antisymmetric: 3 - sqrt 5, 2, 4, 3 + sqrt 5; that of 2 is 0 on both axis edges, that of 4 is not */
    assert_int_equal(result.antisymmetric, 4);
    assert_int_equal(result.tally[SL_THEOREM_AXIS].signs, 8);
    assert_int_equal(result.tally[SL_THEOREM_AXIS].zeros, 2);
    assert_int_equal(result.seams_off_axis, 1);
    assert_int_equal(result.lowest_index, 1);
    sl_theorem_graph_free(graph);
}

/* K4 without one edge: a, a' joined to b, b' and to one another. Its lowest antisymmetric vector is b - b', 0 on the
 * only axis edge: the smallest graph on which the appendix fails. */
static void the_smallest_counterexample_has_four_nodes(void **state)
{
    (void)state;
    sl_edges edges = {.pairs = 2};
    sl_edges_within(&edges, 0, 1);
    sl_edges_across(&edges, 0, 1);
    sl_edges_across(&edges, 0, 0);
    sl_theorem_graph *graph = finish(&edges);
    const sl_theorem_result result = check(graph);
    assert_none_violated(&result);
    assert_int_equal(result.graphs, 1);
    assert_int_equal(result.seams_off_axis, 1);
    assert_int_equal(result.tally[SL_THEOREM_AXIS].zeros, 1);
    assert_int_equal(asked(&result, SL_THEOREM_HALF), 0); /* no choice of halves makes A'' diagonal */
    assert_true(holds(&result, SL_THEOREM_CROSSED));
    assert_int_equal(result.lowest_index, 1);
    sl_theorem_graph_free(graph);
}

/* Two paths of three joined at their middles: with a diagonal A'' and no fixed node, the smallest. */
static void with_a_diagonal_part_the_smallest_counterexample_has_six_nodes(void **state)
{
    (void)state;
    sl_edges edges = {.pairs = 3};
    sl_edges_within(&edges, 0, 1);
    sl_edges_within(&edges, 1, 2);
    sl_edges_across(&edges, 1, 1);
    sl_theorem_graph *graph = finish(&edges);
    const sl_theorem_result result = check(graph);
    assert_none_violated(&result);
    assert_int_equal(result.seams_off_axis, 1);
    assert_true(holds(&result, SL_THEOREM_HALF) && holds(&result, SL_THEOREM_WHOLE));
    sl_theorem_graph_free(graph);
}

/* Every mirrored graph without parallel edges of up to 3 pairs and 1 fixed node: 2^12 graphs of 7 nodes at most. */
static sl_theorem_graph *graph_number(int32_t pairs, int32_t fixed, uint32_t bits)
{
    sl_edges edges = {.pairs = pairs, .fixed = fixed};
    for (int32_t i = 0; i < pairs; i++) {
        for (int32_t j = 0; j <= i; j++, bits >>= 1) {
            if ((bits & 1) != 0) {
                sl_edges_across(&edges, i, j);
            }
        }
        for (int32_t j = 0; j < i; j++, bits >>= 1) {
            if ((bits & 1) != 0) {
                sl_edges_within(&edges, i, j);
            }
        }
        for (int32_t k = 0; k < fixed; k++, bits >>= 1) {
            if ((bits & 1) != 0) {
                sl_edges_spoke(&edges, i, k);
            }
        }
    }
    return finish(&edges);
}

static bool connected(const sl_theorem_graph *graph)
{
    int32_t label[16], parts;
    assert_int_equal(sl_graph_components(&graph->graph, NULL, label, &parts), SL_OK);
    return parts == 1;
}

static void no_graph_of_up_to_seven_nodes_violates_or_escapes_a_statement(void **state)
{
    (void)state;
    int64_t off[4][2] = {{0}}, off_diagonal[4][2] = {{0}};
    for (int32_t pairs = 1; pairs <= 3; pairs++) {
        for (int32_t fixed = 0; fixed <= 1; fixed++) {
            const uint32_t count = 1u << (pairs * pairs + pairs * fixed);
            for (uint32_t bits = 0; bits < count; bits++) {
                sl_theorem_graph *graph = graph_number(pairs, fixed, bits);
                sl_half half;
                const sl_theorem_result result = check(graph);
                assert_none_violated(&result);
                for (int32_t s = 0; s < SL_THEOREM_STATEMENTS; s++) {
                    assert_int_equal(result.tally[s].undecided, 0);
                    assert_int_equal(result.tally[s].signs_undecided, 0);
                }
                assert_int_equal(sl_half_create(graph, &half), SL_OK);
                if (connected(graph) && result.seams_off_axis > 0) {
                    off[pairs][fixed]++;
                    off_diagonal[pairs][fixed] += half.diagonal ? 1 : 0;
                }
                sl_half_clear(&half);
                sl_theorem_graph_free(graph);
            }
        }
    }
    /* "all antisymmetric seams contain the axis", smallest failures among connected graphs: 4 nodes; with a diagonal
     * A'' 6 nodes without, 5 nodes with a fixed node */
    assert_int_equal(off[1][0] + off[1][1], 0);
    assert_true(off[2][0] > 0);
    assert_int_equal(off_diagonal[2][0], 0);
    assert_true(off_diagonal[2][1] > 0);
    assert_true(off_diagonal[3][0] > 0);
}

/* Lobes joined through one fixed node: A' is not connected though the graph is, and the lowest antisymmetric vector
 * lives on one pair of lobes. The statement holds lobe by lobe. */
static void lobes_have_a_statement_each(void **state)
{
    (void)state;
    sl_edges edges = {.pairs = 7, .fixed = 1};
    sl_edges_within(&edges, 0, 1);
    sl_edges_within(&edges, 1, 2);
    sl_edges_within(&edges, 2, 3);
    sl_edges_spoke(&edges, 0, 0);
    sl_edges_within(&edges, 4, 5);
    sl_edges_within(&edges, 5, 6);
    sl_edges_within(&edges, 4, 6);
    sl_edges_spoke(&edges, 4, 0);
    sl_edges_across(&edges, 6, 6);
    sl_theorem_graph *graph = finish(&edges);
    const sl_theorem_result result = check(graph);
    assert_none_violated(&result);
    assert_int_equal(result.blocks, 2);
    assert_int_equal(result.tally[SL_THEOREM_HALF].signs, 7);
    assert_true(holds(&result, SL_THEOREM_WHOLE) && holds(&result, SL_THEOREM_FIXED));
    sl_theorem_graph_free(graph);
}

/* A random graph under D3: ten eigenspaces and more have no basis common to two of its mirrors. Under D2 all have. */
static void mirrors_of_d3_have_no_common_basis_and_those_of_d2_have(void **state)
{
    (void)state;
    int64_t most = 0;
    for (uint64_t seed = 1; seed <= 12; seed++) {
        sl_theorem_graph *graph;
        sl_rng rng = sl_rng_seed(seed);
        assert_int_equal(sl_make_dihedral(&rng, 48, &graph), SL_OK);
        sl_theorem_result result = check(graph);
        assert_none_violated(&result);
        assert_true(holds(&result, SL_THEOREM_JOINT));
        assert_true(result.no_common_basis > 0);
        most = result.no_common_basis > most ? result.no_common_basis : most;
        sl_theorem_graph_free(graph);
        assert_int_equal(sl_make_commuting(&rng, 48, &graph), SL_OK);
        result = check(graph);
        assert_none_violated(&result);
        assert_true(holds(&result, SL_THEOREM_JOINT));
        assert_int_equal(result.no_common_basis, 0);
        sl_theorem_graph_free(graph);
    }
    assert_true(most >= 10);
}

/* Halves exchanged at random pairs: the statement finds the halves for which A'' is diagonal. */
static void another_choice_of_halves_changes_no_verdict(void **state)
{
    (void)state;
    for (uint64_t seed = 1; seed <= 20; seed++) {
        sl_theorem_graph *graph;
        sl_rng rng = sl_rng_seed(seed);
        assert_int_equal(sl_make_switched(&rng, 40, &graph), SL_OK);
        const sl_theorem_result result = check(graph);
        assert_none_violated(&result);
        assert_int_equal(result.crossed, 1);
        assert_int_equal(asked(&result, SL_THEOREM_CROSSED), 0);
        assert_true(holds(&result, SL_THEOREM_HALF) && holds(&result, SL_THEOREM_WHOLE));
        sl_theorem_graph_free(graph);
    }
}

/* With lowest pairs only there is no count of values that are not 0: a zero is shown by the component it lies off, or
 * by another mirror. */
static void zeros_are_shown_without_whole_spectra(void **state)
{
    (void)state;
    sl_edges lobes = {.pairs = 220, .fixed = 1};
    for (int32_t i = 1; i < 220; i++) {
        if (i != 97) {
            sl_edges_within(&lobes, i, i - 1);
        }
    }
    sl_edges_spoke(&lobes, 0, 0);
    sl_edges_spoke(&lobes, 97, 0);
    sl_edges_across(&lobes, 40, 40);
    sl_edges_across(&lobes, 150, 150);
    sl_theorem_graph *graph = finish(&lobes);
    sl_theorem_result result = check(graph);
    assert_none_violated(&result);
    const sl_theorem_tally *axis = &result.tally[SL_THEOREM_AXIS];
    assert_true(axis->signs == axis->zeros * 2 && axis->zeros > 10); /* each vector is 0 on one of the two lobes */
    assert_int_equal(axis->signs_undecided, 0);
    sl_theorem_graph_free(graph);

    const int32_t height = 23,
                  length = 10; /* half a grid; a second mirror fixes its middle row; prime: no other zeros */
    sl_edges grid = {.pairs = height * length};
    for (int32_t i = 0; i < height * length; i++) {
        if (i % length + 1 < length) {
            sl_edges_within(&grid, i, i + 1);
        }
        if (i + length < height * length) {
            sl_edges_within(&grid, i, i + length);
        }
        if (i % length == 0) {
            sl_edges_across(&grid, i, i);
        }
    }
    graph = finish(&grid);
    graph->second = sl_alloc(sl_theorem_nodes(graph), sizeof *graph->second);
    for (int32_t i = 0; i < height * length; i++) {
        graph->second[i] = (height - 1 - i / length) * length + i % length;
        graph->second[i + height * length] = graph->second[i] + height * length;
    }
    result = check(graph);
    assert_none_violated(&result);
    assert_true(axis->zeros >= 4 && axis->zeros <= 15);
    assert_int_equal(axis->signs_undecided, 0);
    sl_theorem_graph_free(graph);
}

/* 10 x 300 quads mirrored along their length: 30 symmetric vectors come before the first antisymmetric one, which is
 * beyond what the method computes. */
static void on_a_long_strip_the_lowest_antisymmetric_vector_is_not_among_thirty(void **state)
{
    (void)state;
    const int32_t width = 5, length = 300;
    sl_edges edges = {.pairs = width * length};
    for (int32_t y = 0; y < length; y++) {
        for (int32_t x = 0; x < width; x++) {
            if (x + 1 < width) {
                sl_edges_within(&edges, y * width + x, y * width + x + 1);
            }
            if (y + 1 < length) {
                sl_edges_within(&edges, y * width + x, (y + 1) * width + x);
            }
        }
        sl_edges_across(&edges, y * width, y * width);
    }
    sl_theorem_graph *graph = finish(&edges);
    const sl_theorem_def usual = sl_theorem_default();
    sl_theorem_def more = usual;
    sl_theorem_result result;
    more.lowest = 40;
    assert_int_equal(sl_theorem_check(graph, &usual, NULL, &result), SL_OK);
    assert_none_violated(&result);
    assert_true(holds(&result, SL_THEOREM_HALF));
    assert_int_equal(asked(&result, SL_THEOREM_WHOLE), 0);
    assert_int_equal(sl_theorem_check(graph, &more, NULL, &result), SL_OK);
    assert_none_violated(&result);
    assert_int_equal(result.lowest_index, 30); /* a symmetric one has the same eigenvalue */
    sl_theorem_graph_free(graph);
}

/* Whole spectra by LAPACK and lowest pairs by our own solver say the same of one graph. */
static void our_solver_and_lapack_give_the_same_verdicts(void **state)
{
    (void)state;
    int32_t families;
    const sl_theorem_family *family = sl_theorem_families(&families);
    for (int32_t k = 0; k < families; k++) {
        sl_theorem_graph *graph;
        sl_rng rng = sl_rng_seed(77);
        sl_theorem_def all = sl_theorem_default(), lowest = all;
        sl_theorem_result a, b;
        assert_int_equal(family[k].make(&rng, 500, &graph), SL_OK);
        all.full_nodes = 1000;
        assert_int_equal(sl_theorem_check(graph, &all, NULL, &a), SL_OK);
        assert_int_equal(sl_theorem_check(graph, &lowest, NULL, &b), SL_OK);
        assert_none_violated(&a);
        assert_none_violated(&b);
        assert_true(b.lowest_index < 0 || a.lowest_index == b.lowest_index);
        assert_int_equal(asked(&a, SL_THEOREM_HALF), asked(&b, SL_THEOREM_HALF));
        assert_true(a.largest_difference < 1e-13 && b.largest_difference < 1e-11);
        sl_theorem_graph_free(graph);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_graph_of_figure_17_has_the_spectrum_of_the_record),
        cmocka_unit_test(the_smallest_counterexample_has_four_nodes),
        cmocka_unit_test(with_a_diagonal_part_the_smallest_counterexample_has_six_nodes),
        cmocka_unit_test(no_graph_of_up_to_seven_nodes_violates_or_escapes_a_statement),
        cmocka_unit_test(lobes_have_a_statement_each),
        cmocka_unit_test(mirrors_of_d3_have_no_common_basis_and_those_of_d2_have),
        cmocka_unit_test(another_choice_of_halves_changes_no_verdict),
        cmocka_unit_test(zeros_are_shown_without_whole_spectra),
        cmocka_unit_test(on_a_long_strip_the_lowest_antisymmetric_vector_is_not_among_thirty),
        cmocka_unit_test(our_solver_and_lapack_give_the_same_verdicts),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
