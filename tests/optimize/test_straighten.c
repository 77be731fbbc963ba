/* Seams laid anew: the ways against relaxation, states before and after; and where weights put seams. */
#include "optimize/checks.h"
#include "optimize/ways_internal.h"

/* The price of the cheapest way by relaxing all pairs of edges that follow each other until nothing changes. */
static double cheapest(const sl_opt_ways *ways, int32_t start, int32_t goal)
{
    const sl_opt_surface *s = ways->state->surface;
    const sl_patch *p = s->patch;
    const int32_t nh = 3 * p->nt;
    double *price = malloc(sizeof *price * (size_t)nh), best = HUGE_VAL;
    for (int32_t h = 0; h < nh; h++) {
        price[h] = p->tri[h] == start && p->twin[h] >= 0 ? s->cost[h] : HUGE_VAL;
    }
    for (bool changed = true; changed;) {
        changed = false;
        for (int32_t h = 0; h < nh; h++) {
            const int32_t v = p->tri[sl_corner_next(h)];
            for (int32_t g = 0; g < nh && price[h] < HUGE_VAL && ways->taken[v] == 0; g++) {
                if (p->tri[g] == v && p->twin[g] >= 0 && g != p->twin[h]) {
                    const int32_t pair[2] = {h, g};
                    const double there = price[h] - s->cost[h] + sl_opt_way_cost(ways, pair, 2);
                    changed = changed || there < price[g] - 1e-12;
                    price[g] = there < price[g] - 1e-12 ? there : price[g];
                }
            }
        }
    }
    for (int32_t h = 0; h < nh; h++) {
        best = p->tri[sl_corner_next(h)] == goal ? fmin(best, price[h]) : best;
    }
    free(price);
    return best;
}

/* A state of one chart: nothing cut. */
static sl_opt_state whole_state(const test_surface *s, const sl_optimize_def *def)
{
    sl_opt_state state;
    assert_int_equal(sl_opt_state_init(&s->surface, def, NULL, &state), SL_OK);
    memset(state.chart_of, 0, sizeof *state.chart_of * (size_t)s->surface.patch->nt);
    return state;
}

static void ways_are_the_cheapest_that_relaxation_finds(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0x3a95);
    const sl_optimize_def def = sl_optimize_default();
    for (int trial = 0; trial < 6 * test_multiplier(); trial++) {
        test_surface s = test_surface_of(test_patch_mesh(&rng, 7, 8, trial % 2 ? TEST_MIXED : TEST_TRIANGLES, NULL));
        const sl_patch *p = s.surface.patch;
        for (int32_t h = 0; h < 3 * p->nt; h++) {
            if (p->twin[h] > h) {
                s.surface.cost[h] *= test_uniform(&rng, 0.2, 1.0);
                s.surface.cost[p->twin[h]] = s.surface.cost[h];
            }
        }
        s.surface.weight = trial % 3 > 0 ? s.surface.cost : NULL; /* turns cost something where there are weights */
        sl_opt_state opt = whole_state(&s, &def);
        sl_opt_ways ways;
        assert_int_equal(sl_opt_ways_init(&opt, &ways), SL_OK);
        int32_t *way = malloc(sizeof *way * 3 * (size_t)p->nt), n = 0;
        const int32_t h = test_index(&rng, 3 * p->nt), g = test_index(&rng, 3 * p->nt);
        const int32_t old[2] = {h, g}, chart[2] = {0, 0}; /* only the ends count here */
        const int32_t start = p->tri[h], goal = p->tri[sl_corner_next(g)];
        const double best = start != goal ? cheapest(&ways, start, goal) : HUGE_VAL;
        if (best < HUGE_VAL) {
            assert_int_equal(sl_opt_way_find(&ways, old, 2, 1e9, chart, HUGE_VAL, way, &n), SL_OK);
            assert_true(n > 0 && p->tri[way[0]] == start && p->tri[sl_corner_next(way[n - 1])] == goal);
            for (int32_t k = 1; k < n; k++) {
                assert_int_equal(p->tri[way[k]], p->tri[sl_corner_next(way[k - 1])]);
                assert_true(p->border[p->tri[way[k]]] == 0);
            }
            assert_true(test_near_rel(sl_opt_way_cost(&ways, way, n), best, 1e-9));
            assert_int_equal(sl_opt_way_find(&ways, old, 2, 1e9, chart, 0.999 * best, way, &n), SL_OK);
            assert_int_equal(n, 0); /* nothing below the bound */
        }
        free(way);
        sl_opt_ways_clear(&ways);
        sl_opt_state_clear(&opt);
        test_surface_clear(&s);
    }
}

/* What all arcs cost, their turns included. */
static double price_of_arcs(const sl_opt_state *opt)
{
    sl_opt_ways ways;
    sl_opt_arcs arcs;
    double sum = 0.0;
    assert_int_equal(sl_opt_ways_init(opt, &ways), SL_OK);
    assert_int_equal(sl_opt_arcs_init(opt, &arcs), SL_OK);
    for (int32_t k = 0; k < arcs.count; k++) {
        sum += sl_opt_way_cost(&ways, arcs.halfedge + arcs.first[k], arcs.first[k + 1] - arcs.first[k]);
    }
    sl_opt_arcs_clear(&arcs);
    sl_opt_ways_clear(&ways);
    return sum;
}

static void straightening_makes_seams_cheaper_and_keeps_charts_and_targets(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0x57a1);
    const sl_optimize_def def = sl_optimize_default();
    int32_t moved = 0;
    for (int trial = 0; trial < 4 * test_multiplier(); trial++) {
        test_surface s = test_surface_of(trial % 2 ? test_spiky_mesh(&rng, 8, 4, 1.0, TEST_TRIANGLES)
                                                   : test_torus_mesh(&rng, 20, 11, 0.35, TEST_QUADS));
        sl_opt_state opt = test_started(&s, &def);
        sl_opt_total total;
        assert_int_equal(sl_opt_cut(&opt), SL_OK);
        const double before = price_of_arcs(&opt);
        const int64_t charts = opt.nchart;
        assert_int_equal(sl_opt_straighten(&opt), SL_OK);
        test_check_state(&opt);
        sl_opt_totals(&opt, &total);
        assert_true(sl_opt_within(&opt, &total));
        assert_int_equal(opt.nchart, charts);
        const double after = price_of_arcs(&opt);
        assert_true(opt.info.straightened > 0 ? after < before : after == before);
        moved += opt.info.straightened;
        for (int32_t c = 0; c < opt.nchart; c++) {
            sl_certificate certificate;
            assert_int_equal(sl_opt_certify(opt.chart[c].patch, opt.chart[c].uv, &certificate), SL_OK);
            assert_true(certificate.embedded);
        }
        sl_opt_state_clear(&opt);
        test_surface_clear(&s);
    }
    assert_true(moved > 0);
}

/* Length of the seams, and of those where the two facets look in different directions. */
static void measure_seams(const sl_mesh *m, double *length, double *crease)
{
    *length = *crease = 0.0;
    for (int32_t h = 0; h < m->nh; h++) {
        if (m->sew[h] > h) {
            *length += sl_mesh_edge_length(m, h);
            *crease += fabs(sl_seam_dihedral(m, h)) > 0.5 ? sl_mesh_edge_length(m, h) : 0.0;
        }
    }
}

static void seams_of_a_box_run_on_its_edges(void **state)
{
    (void)state;
    static const int32_t cells[] = {9, 7, 8};
    test_rng rng = test_rng_seed(0xb0c5);
    for (int trial = 0; trial < 2 * test_multiplier(); trial++) {
        const double a[3] = {test_uniform(&rng, 1.0, 1.3), test_uniform(&rng, 0.6, 0.8), test_uniform(&rng, 0.8, 1.0)};
        int32_t side[6 * 16 * 16 * 2];
        sl_mesh *mesh = test_box_mesh(&rng, a, cells, TEST_QUADS, side);
        sl_triangulation *t = test_triangulate(mesh);
        sl_optimize_def def = sl_optimize_default();
        sl_segment_def segment = sl_segment_default();
        sl_segmentation *s = NULL;
        double length, crease;
        segment.symmetry = SL_SYMMETRY_USE_OFF;
        def.target_stretch = 1.0001; /* as a box unfolds */
        def.target_angle = 1.005;
        assert_int_equal(sl_optimize_segment(mesh, t, &segment, &def, NULL, &s, NULL), SL_OK);
        measure_seams(mesh, &length, &crease);
        assert_true(length > 0.0 && crease > 0.99 * length);
        sl_segmentation_free(s);
        sl_triangulation_free(t);
        sl_mesh_free(mesh);
    }
}

/* A weight that is not one is refused before anything is cut. */
static void weights_out_of_range_are_refused(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0xbad3);
    sl_mesh *mesh = test_spiky_mesh(&rng, 5, 3, 0.5, TEST_TRIANGLES);
    sl_triangulation *t = test_triangulate(mesh);
    const sl_segment_def segment = sl_segment_default();
    sl_optimize_def def = sl_optimize_default();
    sl_segmentation *s = NULL;
    def.weights.crease = 1.5;
    assert_int_equal(sl_optimize_segment(mesh, t, &segment, &def, NULL, &s, NULL), SL_BAD_INPUT);
    assert_true(s == NULL);
    test_check_pointers(mesh);
    sl_triangulation_free(t);
    sl_mesh_free(mesh);
}

/* Diagonals of pairs weigh more than any other edge; without strengths and pairs there are no weights at all. */
static void pairs_keep_seams_off_their_diagonals(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0x9a15);
    sl_mesh *mesh = test_torus_mesh(&rng, 18, 12, 0.4, TEST_TRIANGLES);
    const sl_seam_cost_def none = sl_seam_cost_none();
    double *weight = NULL, fraction = 0.0;
    int32_t *partner = malloc(sizeof *partner * (size_t)mesh->nf), diagonals = 0;
    assert_int_equal(sl_opt_weights(mesh, &none, SL_PAIR_AUTO, NULL, &weight), SL_OK);
    assert_true(weight == NULL);
    assert_int_equal(sl_pair_triangles(mesh, partner, &fraction), SL_OK);
    assert_int_equal(sl_opt_weights(mesh, &none, SL_PAIR_ON, NULL, &weight), SL_OK);
    for (int32_t h = 0; h < mesh->nh; h++) {
        const bool diagonal = mesh->twin[h] >= 0 && partner[mesh->face[h]] == mesh->face[mesh->twin[h]];
        assert_true(weight[h] == (diagonal ? none.diagonal : 1.0));
        diagonals += diagonal;
    }
    assert_true(diagonals > mesh->nf / 2);
    free(partner);
    sl_free(weight);
    sl_mesh_free(mesh);
}

static void weights_are_one_in_the_mean(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0x3ea9);
    sl_mesh *mesh = test_spiky_mesh(&rng, 7, 5, 1.0, TEST_MIXED);
    const sl_seam_cost_def def = sl_seam_cost_default();
    double *weight = NULL, sum = 0.0, length = 0.0, least = HUGE_VAL;
    assert_int_equal(sl_opt_weights(mesh, &def, SL_PAIR_OFF, NULL, &weight), SL_OK);
    for (int32_t h = 0; h < mesh->nh; h++) {
        sum += weight[h] * sl_mesh_edge_length(mesh, h);
        length += sl_mesh_edge_length(mesh, h);
        least = fmin(least, weight[h]);
        assert_true(weight[h] == weight[mesh->twin[h]]);
    }
    assert_true(test_near_rel(sum, length, 1e-12) && least < 0.9);
    sl_free(weight);
    sl_mesh_free(mesh);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(ways_are_the_cheapest_that_relaxation_finds),
        cmocka_unit_test(straightening_makes_seams_cheaper_and_keeps_charts_and_targets),
        cmocka_unit_test(seams_of_a_box_run_on_its_edges),
        cmocka_unit_test(weights_out_of_range_are_refused),
        cmocka_unit_test(weights_are_one_in_the_mean),
        cmocka_unit_test(pairs_keep_seams_off_their_diagonals),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
