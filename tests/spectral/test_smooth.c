/* Band minimum cuts: against enumeration on small meshes, properties on larger ones. */
#include "base/memory.h"
#include "spectral/shapes.h"
#include "spectral/spectrum.h"

/* weight: nullable. */
static double cut_length(const sl_mesh *mesh, const sl_facet_graph *g, const double *weight, const uint8_t *side)
{
    double length = 0.0;
    for (int32_t i = 0; i < g->graph.n; i++) {
        for (int32_t p = g->graph.first[i]; p < g->graph.first[i + 1]; p++) {
            const int32_t h = g->halfedge[p];
            const double factor = weight != NULL ? weight[h] : 1.0;
            length += side[i] == 1 && side[g->graph.adj[p]] == 0 ? factor * sl_mesh_edge_length(mesh, h) : 0.0;
        }
    }
    return length;
}

/* Dual distance to the cut, 1 on it, by relaxation. */
static void ring_numbers(const sl_graph *g, const uint8_t *side, int32_t *ring)
{
    for (int32_t i = 0; i < g->n; i++) {
        ring[i] = 1000000;
        for (int32_t p = g->first[i]; p < g->first[i + 1]; p++) {
            ring[i] = side[g->adj[p]] != side[i] ? 1 : ring[i];
        }
    }
    for (bool changed = true; changed;) {
        changed = false;
        for (int32_t i = 0; i < g->n; i++) {
            for (int32_t p = g->first[i]; p < g->first[i + 1]; p++) {
                if (ring[g->adj[p]] + 1 < ring[i]) {
                    ring[i] = ring[g->adj[p]] + 1;
                    changed = true;
                }
            }
        }
    }
}

static bool sides_connected(const sl_graph *g, const uint8_t *side)
{
    int32_t parts = 0, *key = malloc((size_t)g->n * sizeof *key), *label = malloc((size_t)g->n * sizeof *label);
    for (int32_t i = 0; i < g->n; i++) {
        key[i] = side[i];
    }
    assert_int_equal(sl_graph_components(g, key, label, &parts), SL_OK);
    free(key);
    free(label);
    return parts == 2;
}

/* A random bipartition with connected sides: grown from one node, as long as the rest stays connected. */
static bool random_sides(test_rng *rng, const sl_graph *g, int32_t size, uint8_t *side)
{
    memset(side, 0, (size_t)g->n);
    side[test_index(rng, g->n)] = 1;
    for (int32_t grown = 1, tries = 0; grown < size && tries < 500; tries++) {
        const int32_t i = test_index(rng, g->n);
        bool next_to = false;
        for (int32_t p = g->first[i]; side[i] == 0 && p < g->first[i + 1]; p++) {
            next_to = next_to || side[g->adj[p]] == 1;
        }
        if (next_to) {
            side[i] = 1;
            if (sides_connected(g, side)) {
                grown++;
            } else {
                side[i] = 0;
            }
        }
    }
    return sides_connected(g, side);
}

/* Shortest cut over all assignments of the free nodes. */
static double shortest_by_enumeration(const sl_mesh *mesh, const sl_facet_graph *g, const double *weight,
                                      const uint8_t *side, const int32_t *free_node, int32_t nfree)
{
    uint8_t trial[64];
    double best = HUGE_VAL;
    memcpy(trial, side, (size_t)g->graph.n);
    for (int32_t bits = 0; bits < 1 << nfree; bits++) {
        for (int32_t k = 0; k < nfree; k++) {
            trial[free_node[k]] = (uint8_t)(bits >> k & 1);
        }
        best = fmin(best, cut_length(mesh, g, weight, trial));
    }
    return best;
}

/* Random factors, the same for both halfedges of an edge. */
static double *random_weights(test_rng *rng, const sl_mesh *mesh)
{
    double *weight = malloc(sizeof *weight * (size_t)mesh->nh);
    for (int32_t h = 0; h < mesh->nh; h++) {
        weight[h] = mesh->twin[h] >= 0 && mesh->twin[h] < h ? weight[mesh->twin[h]] : test_uniform(rng, 0.1, 1.0);
    }
    return weight;
}

static void smoothing_finds_the_shortest_cut_of_the_band(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0x500);
    int32_t changes = 0, compared = 0;
    for (int trial = 0; trial < 150 * test_multiplier(); trial++) {
        sl_mesh *mesh = test_patch_mesh(&rng, 4, 5, TEST_MIXED, NULL);
        sl_facet_graph *g = test_whole_graph(mesh, NULL);
        double *weight = trial % 2 == 0 ? random_weights(&rng, mesh) : NULL;
        uint8_t side[64], before[64];
        int32_t ring[64], free_node[64], nfree = 0, core[2] = {0};
        if (random_sides(&rng, &g->graph, g->graph.n / 2, side)) {
            ring_numbers(&g->graph, side, ring);
            for (int32_t i = 0; i < g->graph.n; i++) {
                core[side[i]] += ring[i] > 1;
                if (ring[i] <= 1) {
                    free_node[nfree++] = i;
                }
            }
            memcpy(before, side, sizeof before);
            bool changed = false;
            assert_int_equal(sl_smooth_cut(mesh, g, weight, 1, side, &changed), SL_OK);
            if (core[0] > 0 && core[1] > 0 && nfree <= 13) {
                const double best = shortest_by_enumeration(mesh, g, weight, before, free_node, nfree);
                const double now = cut_length(mesh, g, weight, side), was = cut_length(mesh, g, weight, before);
                compared++;
                changes += changed;
                if (changed) { /* where it stayed, the shortest cut may have torn a side */
                    assert_true(test_near(now, best, 1e-12) && now < was);
                } else {
                    assert_memory_equal(side, before, (size_t)g->graph.n);
                }
            }
        }
        free(weight);
        sl_facet_graph_free(g);
        sl_mesh_free(mesh);
    }
    assert_true(compared >= 20 && changes >= 10);
}

static void smoothing_shortens_keeps_sides_connected_and_stays_in_its_band(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0x501);
    int32_t changes = 0;
    for (int trial = 0; trial < 24 * test_multiplier(); trial++) {
        sl_mesh *mesh = trial % 2 == 0 ? test_spiky_mesh(&rng, 7, 5, 1.0, TEST_TRIANGLES)
                                       : test_torus_mesh(&rng, 20, 11, 0.4, TEST_MIXED);
        sl_facet_graph *g = test_whole_graph(mesh, NULL);
        const int32_t n = g->graph.n, rings = 1 + trial % 4;
        uint8_t *side = malloc((size_t)n), *before = malloc((size_t)n);
        int32_t *ring = malloc((size_t)n * sizeof *ring);
        if (random_sides(&rng, &g->graph, n / 3, side)) {
            memcpy(before, side, (size_t)n);
            ring_numbers(&g->graph, side, ring);
            bool changed = false;
            assert_int_equal(sl_smooth_cut(mesh, g, NULL, rings, side, &changed), SL_OK);
            assert_true(sides_connected(&g->graph, side));
            assert_true(changed ? cut_length(mesh, g, NULL, side) < cut_length(mesh, g, NULL, before)
                                : memcmp(side, before, (size_t)n) == 0);
            for (int32_t i = 0; i < n; i++) {
                assert_true(side[i] == before[i] || ring[i] <= rings);
            }
            changes += changed;
        }
        free(side);
        free(before);
        free(ring);
        sl_facet_graph_free(g);
        sl_mesh_free(mesh);
    }
    assert_true(changes >= 6);
}

static void a_side_swallowed_by_the_band_does_not_vanish(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0x502);
    for (int trial = 0; trial < 40 * test_multiplier(); trial++) {
        sl_mesh *mesh = test_patch_mesh(&rng, 6, 7, TEST_TRIANGLES, NULL);
        sl_facet_graph *g = test_whole_graph(mesh, NULL);
        uint8_t side[128];
        if (random_sides(&rng, &g->graph, 1 + test_index(&rng, 5), side)) {
            bool changed = false;
            assert_int_equal(sl_smooth_cut(mesh, g, NULL, 1 + test_index(&rng, 20), side, &changed), SL_OK);
            assert_true(sides_connected(&g->graph, side));
        }
        sl_facet_graph_free(g);
        sl_mesh_free(mesh);
    }
}

static void no_rings_change_nothing(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0x503);
    sl_mesh *mesh = test_patch_mesh(&rng, 6, 7, TEST_TRIANGLES, NULL);
    sl_facet_graph *g = test_whole_graph(mesh, NULL);
    uint8_t side[128], before[128];
    bool changed = true;
    assert_true(random_sides(&rng, &g->graph, 30, side));
    memcpy(before, side, sizeof side);
    assert_int_equal(sl_smooth_cut(mesh, g, NULL, 0, side, &changed), SL_OK);
    assert_false(changed);
    assert_memory_equal(side, before, (size_t)g->graph.n);
    sl_facet_graph_free(g);
    sl_mesh_free(mesh);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(smoothing_finds_the_shortest_cut_of_the_band),
        cmocka_unit_test(smoothing_shortens_keeps_sides_connected_and_stays_in_its_band),
        cmocka_unit_test(a_side_swallowed_by_the_band_does_not_vanish),
        cmocka_unit_test(no_rings_change_nothing),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
