/* The check can fail: graphs, vectors and signs broken on purpose. */
#include "support/test_support.h"

#include "base/memory.h"
#include "theorem/blocks_internal.h"
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

static sl_theorem_graph *sample(uint64_t seed)
{
    sl_theorem_graph *graph;
    sl_rng rng = sl_rng_seed(seed);
    assert_int_equal(sl_make_planar(&rng, 60, &graph), SL_OK);
    return graph;
}

static void a_graph_that_lost_an_edge_violates_mirror_and_spectra(void **state)
{
    (void)state;
    sl_theorem_run_def def = sl_theorem_run_default();
    def.check.sabotage = SL_THEOREM_BREAK_GRAPH;
    for (def.seed = 1; def.seed <= 10; def.seed++) {
        int32_t family;
        sl_theorem_graph *graph;
        assert_int_equal(sl_theorem_graph_of(&def, 0, &family, &graph), SL_OK);
        const sl_theorem_result result = check(graph);
        assert_int_equal(result.tally[SL_THEOREM_MIRROR].violated, 1);
        assert_int_equal(result.tally[SL_THEOREM_SPECTRA].violated, 1);
        assert_int_equal(result.failed, SL_THEOREM_MIRROR);
        assert_true(result.reason[0] != '\0');
        sl_theorem_graph_free(graph);
    }
}

static void a_moved_vector_violates_the_spectra_and_a_changed_sign_its_statements(void **state)
{
    (void)state;
    for (uint64_t seed = 1; seed <= 10; seed++) {
        sl_theorem_graph *graph = sample(seed);
        sl_theorem_def def = sl_theorem_default();
        sl_theorem_result result;
        def.sabotage = SL_THEOREM_BREAK_VECTOR;
        assert_int_equal(sl_theorem_check(graph, &def, NULL, &result), SL_OK);
        assert_int_equal(result.tally[SL_THEOREM_SPECTRA].violated, 1);
        def.sabotage = SL_THEOREM_BREAK_SIGN;
        assert_int_equal(sl_theorem_check(graph, &def, NULL, &result), SL_OK);
        assert_int_equal(result.tally[SL_THEOREM_SPECTRA].violated, 0);
        assert_int_equal(result.tally[SL_THEOREM_WHOLE].violated, 1);
        sl_theorem_graph_free(graph);
    }
}

/* What each statement is to notice, corrupted behind its back. */
typedef void corrupt_fn(const sl_theorem_graph *graph, sl_solution *solution);

static void corrupt_value(const sl_theorem_graph *graph, sl_solution *s)
{
    (void)graph;
    s->antisymmetric.lambda[s->antisymmetric.count / 2] += 1e-9;
}

static void corrupt_parity(const sl_theorem_graph *graph, sl_solution *s)
{
    for (int32_t i = 0; i < sl_theorem_nodes(graph); i++) { /* a little of a symmetric vector in an antisymmetric one */
        s->whole.vector[(int64_t)s->whole.n * s->lowest_skew + i] += 1e-7;
    }
}

static void corrupt_count(const sl_theorem_graph *graph, sl_solution *s)
{
    (void)graph;
    s->skew[s->whole.clusters / 2] ^= 1;
}

static void corrupt_axis(const sl_theorem_graph *graph, sl_solution *s)
{
    for (int32_t i = 0; i < graph->pairs; i++) {
        s->vector[i] = -s->vector[i];
    }
}

static void corrupt_half(const sl_theorem_graph *graph, sl_solution *s)
{
    (void)graph;
    s->antisymmetric.vector[1] = -s->antisymmetric.vector[1];
}

static void corrupt_fixed(const sl_theorem_graph *graph, sl_solution *s)
{
    s->vector[2 * graph->pairs] = 1e-6;
}

typedef sl_status state_fn(const sl_theorem_graph *graph, const sl_half *half, sl_solution *s,
                           const sl_theorem_def *def, sl_theorem_result *result);

static sl_status ask_spectra(const sl_theorem_graph *g, const sl_half *h, sl_solution *s, const sl_theorem_def *d,
                             sl_theorem_result *r)
{
    (void)h;
    (void)d;
    return sl_state_spectra(g, s, r);
}

static sl_status ask_basis(const sl_theorem_graph *g, const sl_half *h, sl_solution *s, const sl_theorem_def *d,
                           sl_theorem_result *r)
{
    (void)h;
    (void)d;
    return sl_state_basis(g, s, r);
}

static sl_status ask_axis(const sl_theorem_graph *g, const sl_half *h, sl_solution *s, const sl_theorem_def *d,
                          sl_theorem_result *r)
{
    return sl_state_axis(g, h, s, d, r);
}

static sl_status ask_blocks(const sl_theorem_graph *g, const sl_half *h, sl_solution *s, const sl_theorem_def *d,
                            sl_theorem_result *r)
{
    return sl_state_blocks(g, h, s, d, r);
}

static sl_status ask_fixed(const sl_theorem_graph *g, const sl_half *h, sl_solution *s, const sl_theorem_def *d,
                           sl_theorem_result *r)
{
    (void)h;
    (void)d;
    return sl_state_fixed(g, s, r);
}

/* A connected half with axis edges and a fixed node, nothing special about it. */
static sl_theorem_graph *plain_sample(uint64_t seed)
{
    const int32_t n = 17;
    sl_rng rng = sl_rng_seed(seed);
    sl_edges edges = {.pairs = n, .fixed = 1};
    for (int32_t i = 1; i < n; i++) {
        sl_edges_within(&edges, i, sl_rng_index(&rng, i));
        sl_edges_within(&edges, i, i - 1);
    }
    sl_edges_across(&edges, 2, 2);
    sl_edges_across(&edges, 5, 5);
    sl_edges_spoke(&edges, 7, 0);
    return finish(&edges);
}

static void every_statement_notices_what_is_corrupted_behind_its_back(void **state)
{
    (void)state;
    static const struct {
        sl_theorem_statement statement;
        corrupt_fn *corrupt;
        state_fn *ask;
    } table[] = {{SL_THEOREM_SPECTRA, corrupt_value, ask_spectra}, {SL_THEOREM_BASIS, corrupt_parity, ask_basis},
                 {SL_THEOREM_BASIS, corrupt_count, ask_basis},     {SL_THEOREM_AXIS, corrupt_axis, ask_axis},
                 {SL_THEOREM_HALF, corrupt_half, ask_blocks},      {SL_THEOREM_WHOLE, corrupt_axis, ask_blocks},
                 {SL_THEOREM_FIXED, corrupt_fixed, ask_fixed}};
    const sl_theorem_def def = sl_theorem_default();
    for (size_t k = 0; k < SL_COUNTOF(table); k++) {
        for (int32_t broken = 0; broken < 2; broken++) {
            sl_theorem_graph *graph = plain_sample(1 + k);
            sl_half half;
            sl_solution solution;
            sl_theorem_result result = {.failed = SL_THEOREM_STATEMENTS};
            assert_int_equal(sl_half_create(graph, &half), SL_OK);
            assert_int_equal(sl_solution_create(graph, &half, &def, NULL, &solution), SL_OK);
            if (broken != 0) {
                table[k].corrupt(graph, &solution);
            }
            assert_int_equal(table[k].ask(graph, &half, &solution, &def, &result), SL_OK);
            if (result.tally[table[k].statement].violated != broken) {
                print_message("%s\n", sl_theorem_statement_name(table[k].statement));
            }
            assert_int_equal(result.tally[table[k].statement].violated, broken);
            assert_int_equal(result.failed, broken != 0 ? table[k].statement : SL_THEOREM_STATEMENTS);
            sl_solution_clear(&solution);
            sl_half_clear(&half);
            sl_theorem_graph_free(graph);
        }
    }
}

/* Two mirrors said to commute that do not, and the other way round. */
static void a_second_mirror_that_is_none_is_noticed(void **state)
{
    (void)state;
    sl_theorem_graph *graph;
    sl_rng rng = sl_rng_seed(5);
    assert_int_equal(sl_make_commuting(&rng, 40, &graph), SL_OK);
    for (int32_t i = 0; i < sl_theorem_nodes(graph); i++) {
        graph->second[i] = i;
    }
    int32_t other = 1; /* exchanged with a node of another degree */
    while (graph->graph.first[other + 1] - graph->graph.first[other] == graph->graph.first[1]) {
        other++;
    }
    graph->second[0] = other;
    graph->second[other] = 0;
    const sl_theorem_result result = check(graph);
    assert_int_equal(result.tally[SL_THEOREM_MIRROR].violated, 1);
    sl_theorem_graph_free(graph);
}

/* A balanced component passed off as none: its lowest antisymmetric seam is the axis after all. */
static void a_seam_that_is_the_axis_of_an_unbalanced_half_is_noticed(void **state)
{
    (void)state;
    const sl_theorem_def def = sl_theorem_default();
    sl_theorem_graph *graph = plain_sample(4);
    sl_half half;
    sl_solution solution;
    sl_theorem_result result = {.failed = SL_THEOREM_STATEMENTS};
    assert_int_equal(sl_half_create(graph, &half), SL_OK);
    assert_int_equal(sl_solution_create(graph, &half, &def, NULL, &solution), SL_OK);
    half.balanced[0] = false;
    assert_int_equal(sl_state_blocks(graph, &half, &solution, &def, &result), SL_OK);
    assert_int_equal(result.tally[SL_THEOREM_CROSSED].violated, 1);
    assert_int_equal(result.failed, SL_THEOREM_CROSSED);
    sl_solution_clear(&solution);
    sl_half_clear(&half);
    sl_theorem_graph_free(graph);
}

static void signs_are_counted_against_their_bound(void **state)
{
    (void)state;
    const double value[] = {-0.3, -0.5, 1e-9, -0.2, -1e-7, -0.4};
    sl_sign_count count = sl_count_signs(value, 6, 1e-6);
    assert_int_equal(count.undecided, 2);
    assert_false(count.mixed);
    count = sl_count_signs(value, 6, 1e-10);
    assert_int_equal(count.undecided, 0);
    assert_true(count.mixed);
}

static void sides_that_fall_apart_are_noticed(void **state)
{
    (void)state;
    sl_edges edges = {.pairs = 3};
    sl_edges_within(&edges, 0, 1);
    sl_edges_within(&edges, 1, 2);
    sl_edges_across(&edges, 0, 0);
    sl_theorem_graph *graph = finish(&edges);
    bool connected;
    const uint8_t halves[] = {1, 1, 1, 0, 0, 0}, apart[] = {1, 0, 1, 1, 1, 1}, all[] = {1, 1, 1, 1, 1, 1};
    assert_int_equal(sl_seam_connected(graph, halves, &connected), SL_OK);
    assert_true(connected);
    assert_int_equal(sl_seam_connected(graph, apart, &connected), SL_OK);
    assert_false(connected);
    assert_int_equal(sl_seam_connected(graph, all, &connected), SL_OK);
    assert_true(connected);
    sl_theorem_graph_free(graph);
}

static void a_seam_is_told_from_the_axis_edge_by_edge(void **state)
{
    (void)state;
    sl_theorem_graph *graph = plain_sample(3);
    sl_half half;
    uint8_t side[35];
    int32_t off, missing;
    assert_int_equal(sl_half_create(graph, &half), SL_OK);
    for (int32_t i = 0; i < 35; i++) {
        side[i] = i < 17 || i == 34;
    }
    sl_seam_compare(graph, &half, 0, side, &off, &missing);
    assert_int_equal(off, 0);
    assert_int_equal(missing, 0);
    side[17 + 2] = 1; /* an end of an axis edge goes over: the edge is no longer cut, its others are */
    sl_seam_compare(graph, &half, 0, side, &off, &missing);
    assert_int_equal(missing, 1);
    assert_true(off >= 2);
    side[17 + 2] = 0;
    side[34] = 0; /* a fixed node in F-: not the axis as defined */
    sl_seam_compare(graph, &half, 0, side, &off, &missing);
    assert_int_equal(off, 1);
    sl_half_clear(&half);
    sl_theorem_graph_free(graph);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_graph_that_lost_an_edge_violates_mirror_and_spectra),
        cmocka_unit_test(a_moved_vector_violates_the_spectra_and_a_changed_sign_its_statements),
        cmocka_unit_test(every_statement_notices_what_is_corrupted_behind_its_back),
        cmocka_unit_test(a_second_mirror_that_is_none_is_noticed),
        cmocka_unit_test(a_seam_that_is_the_axis_of_an_unbalanced_half_is_noticed),
        cmocka_unit_test(signs_are_counted_against_their_bound),
        cmocka_unit_test(sides_that_fall_apart_are_noticed),
        cmocka_unit_test(a_seam_is_told_from_the_axis_edge_by_edge),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
