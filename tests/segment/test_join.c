/* Joining loops: disks, shortest paths. */
#include "segment/checks.h"

/* Distance from loop to loop over the mesh's edges, by relaxation. Border vertices are told apart by x. */
static double tube_distance(const sl_mesh *m, double middle)
{
    double *d = malloc((size_t)m->nv * sizeof *d), best = HUGE_VAL;
    uint8_t *border = calloc((size_t)m->nv, 1);
    for (int32_t h = 0; h < m->nh; h++) {
        border[m->origin[h]] |= m->twin[h] < 0;
    }
    for (int32_t v = 0; v < m->nv; v++) {
        d[v] = border[v] && m->xyz[3 * v] < middle ? 0.0 : HUGE_VAL;
    }
    for (bool changed = true; changed;) {
        changed = false;
        for (int32_t h = 0; h < m->nh; h++) {
            const int32_t a = m->origin[h], b = sl_target(m, h);
            for (int k = 0; k < 2; k++) {
                const int32_t from = k == 0 ? a : b, to = k == 0 ? b : a;
                if (d[from] + sl_mesh_edge_length(m, h) < d[to]) {
                    d[to] = d[from] + sl_mesh_edge_length(m, h);
                    changed = true;
                }
            }
        }
    }
    for (int32_t v = 0; v < m->nv; v++) {
        best = border[v] && m->xyz[3 * v] >= middle ? fmin(best, d[v]) : best;
    }
    free(d);
    free(border);
    return best;
}

static double list_length(const sl_mesh *m, const sl_cut_list *list)
{
    double length = 0.0;
    for (int32_t k = 0; k < list->count; k++) {
        length += sl_mesh_edge_length(m, list->halfedge[k]);
    }
    return length;
}

static sl_topology whole_topology(const sl_mesh *m)
{
    int32_t *all = malloc((size_t)m->nf * sizeof *all);
    sl_topology topology;
    for (int32_t f = 0; f < m->nf; f++) {
        all[f] = f;
    }
    assert_int_equal(sl_mesh_topology(m, all, m->nf, &topology), SL_OK);
    free(all);
    return topology;
}

static void a_tube_is_cut_along_the_shortest_path_between_its_ends(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0x707);
    for (int trial = 0; trial < 20 * test_multiplier(); trial++) {
        sl_mesh *m = test_tube_mesh(&rng, 7 + test_index(&rng, 6), 9, 5.0, (test_facets)(trial % 3));
        const double expected = tube_distance(m, 0.0);
        sl_cut_list list;
        assert_int_equal(sl_join_loops(m, NULL, &list), SL_OK);
        const sl_topology topology = whole_topology(m);
        assert_true(topology.genus == 0 && topology.loops == 1);
        assert_true(test_near(list_length(m, &list), expected, 1e-12 * 9));
        sl_cut_list_clear(&list);
        sl_mesh_free(m);
    }
}

/* Holes of one cell each, no two touching. */
static int32_t punch_holes(test_rng *rng, int32_t nu, int32_t nv, uint8_t *drop)
{
    int32_t holes = 0;
    memset(drop, 0, (size_t)(nu * nv));
    for (int tries = 0; tries < 40; tries++) {
        const int32_t i = 1 + test_index(rng, nu - 2), j = 1 + test_index(rng, nv - 2);
        bool apart = true;
        for (int32_t k = 0; k < nu * nv; k++) {
            apart = apart && !(drop[k] && abs(k / nv - i) <= 1 && abs(k % nv - j) <= 1);
        }
        if (apart) {
            drop[i * nv + j] = 1;
            holes++;
        }
    }
    return holes;
}

static void a_patch_with_holes_becomes_a_disk_and_is_sewn_again(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0x401e5);
    for (int trial = 0; trial < 20 * test_multiplier(); trial++) {
        uint8_t drop[13 * 17];
        const int32_t holes = punch_holes(&rng, 13, 17, drop);
        sl_mesh *m = test_patch_mesh(&rng, 13, 17, TEST_MIXED, drop), *before = NULL;
        assert_int_equal(sl_mesh_copy(m, &before), SL_OK);
        assert_int_equal(whole_topology(m).loops, holes + 1);
        sl_cut_list list;
        assert_int_equal(sl_join_loops(m, NULL, &list), SL_OK);
        const sl_topology topology = whole_topology(m);
        assert_true(topology.genus == 0 && topology.loops == 1 && list.count >= holes);
        sl_sew_list(m, &list);
        assert_memory_equal(m->twin, before->twin, (size_t)m->nh * sizeof *m->twin);
        assert_memory_equal(m->sew, before->sew, (size_t)m->nh * sizeof *m->sew);
        sl_cut_list_clear(&list);
        sl_mesh_free(before);
        sl_mesh_free(m);
    }
}

/* Distances from one border loop to all others over the mesh's edges. loop: border loop of a vertex, -1 inside. */
static void loop_distances(const sl_mesh *m, const int32_t *loop, int32_t from, int32_t nloops, double *out)
{
    double *d = malloc((size_t)m->nv * sizeof *d);
    for (int32_t v = 0; v < m->nv; v++) {
        d[v] = loop[v] == from ? 0.0 : HUGE_VAL;
    }
    for (bool changed = true; changed;) {
        changed = false;
        for (int32_t h = 0; h < m->nh; h++) {
            const int32_t end[2] = {m->origin[h], sl_target(m, h)};
            for (int k = 0; k < 2; k++) {
                const double via = d[end[k]] + sl_mesh_edge_length(m, h);
                changed = changed || via < d[end[1 - k]];
                d[end[1 - k]] = fmin(d[end[1 - k]], via);
            }
        }
    }
    for (int32_t l = 0; l < nloops; l++) {
        out[l] = HUGE_VAL;
    }
    for (int32_t v = 0; v < m->nv; v++) {
        if (loop[v] >= 0) {
            out[loop[v]] = fmin(out[loop[v]], d[v]);
        }
    }
    free(d);
}

/* Length of the shortest tree that joins the loops pair by pair (Prim over all distances between loops). */
static double spanning_length(const sl_mesh *m)
{
    enum { MAX_LOOPS = 64 };
    int32_t *loop = malloc((size_t)m->nv * sizeof *loop), nloops = 0;
    for (int32_t v = 0; v < m->nv; v++) {
        loop[v] = -1;
    }
    for (int32_t h = 0; h < m->nh; h++) {
        if (m->twin[h] < 0 && loop[m->origin[h]] < 0) {
            int32_t k = h;
            while (loop[m->origin[k]] < 0) {
                loop[m->origin[k]] = nloops;
                for (k = sl_next(m, k); m->twin[k] >= 0; k = sl_next(m, m->twin[k])) {
                }
            }
            nloops++;
        }
    }
    assert_true(nloops <= MAX_LOOPS);
    double near[MAX_LOOPS], row[MAX_LOOPS], total = 0.0;
    bool in[MAX_LOOPS] = {true};
    loop_distances(m, loop, 0, nloops, near);
    for (int32_t k = 1; k < nloops; k++) {
        int32_t best = -1;
        for (int32_t l = 0; l < nloops; l++) {
            best = !in[l] && (best < 0 || near[l] < near[best]) ? l : best;
        }
        total += near[best];
        in[best] = true;
        loop_distances(m, loop, best, nloops, row);
        for (int32_t l = 0; l < nloops; l++) {
            near[l] = fmin(near[l], row[l]);
        }
    }
    free(loop);
    return total;
}

/* A path may start from a path: never longer than joining loops in pairs, and sometimes shorter. */
static void paths_branch_where_that_is_shorter(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0xb4a9);
    int32_t shorter = 0;
    for (int trial = 0; trial < 12 * test_multiplier(); trial++) {
        uint8_t drop[28 * 28] = {0}; /* three holes far from the border, at the corners of a triangle */
        drop[(11 + test_index(&rng, 2)) * 28 + 10] = 1;
        drop[(11 + test_index(&rng, 2)) * 28 + 17] = 1;
        drop[(17 + test_index(&rng, 2)) * 28 + 13] = 1;
        sl_mesh *m = test_patch_mesh(&rng, 28, 28, TEST_TRIANGLES, drop);
        const double pairwise = spanning_length(m);
        sl_cut_list list;
        assert_int_equal(sl_join_loops(m, NULL, &list), SL_OK);
        const double length = list_length(m, &list);
        assert_true(length <= pairwise * (1.0 + 1e-12));
        shorter += length < pairwise * (1.0 - 1e-9);
        sl_cut_list_clear(&list);
        sl_mesh_free(m);
    }
    assert_true(shorter > 0);
}

static double weighted_length(const sl_mesh *m, const double *weight, const sl_cut_list *list)
{
    double sum = 0.0;
    for (int32_t k = 0; k < list->count; k++) {
        sum += weight[list->halfedge[k]] * sl_mesh_edge_length(m, list->halfedge[k]);
    }
    return sum;
}

static void weights_draw_the_path_to_cheaper_edges(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0x3e16);
    int32_t cheaper = 0;
    for (int trial = 0; trial < 10 * test_multiplier(); trial++) {
        sl_mesh *m = test_tube_mesh(&rng, 12, 18, 4.0, TEST_MIXED);
        double *weight = malloc((size_t)m->nh * sizeof *weight);
        for (int32_t h = 0; h < m->nh; h++) {
            weight[h] = m->twin[h] >= 0 && m->twin[h] < h ? weight[m->twin[h]] : test_uniform(&rng, 0.1, 1.0);
        }
        sl_cut_list plain, weighed;
        assert_int_equal(sl_join_loops(m, NULL, &plain), SL_OK);
        const double length = list_length(m, &plain);
        sl_sew_list(m, &plain);
        assert_int_equal(sl_join_loops(m, weight, &weighed), SL_OK);
        assert_true(list_length(m, &weighed) >= length * (1.0 - 1e-12));
        const double was = weighted_length(m, weight, &plain), now = weighted_length(m, weight, &weighed);
        assert_true(now <= was * (1.0 + 1e-12));
        cheaper += now < was * (1.0 - 1e-9);
        sl_cut_list_clear(&plain);
        sl_cut_list_clear(&weighed);
        free(weight);
        sl_mesh_free(m);
    }
    assert_true(cheaper > 0);
}

static void a_disk_and_a_closed_surface_are_left_alone(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0xd15c);
    for (int closed = 0; closed < 2; closed++) {
        sl_mesh *m =
            closed ? test_spiky_mesh(&rng, 3, 2, 1.0, TEST_MIXED) : test_patch_mesh(&rng, 4, 6, TEST_MIXED, NULL);
        sl_cut_list list;
        assert_int_equal(sl_join_loops(m, NULL, &list), SL_OK);
        assert_int_equal(list.count, 0);
        sl_cut_list_clear(&list);
        sl_mesh_free(m);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_tube_is_cut_along_the_shortest_path_between_its_ends),
        cmocka_unit_test(a_patch_with_holes_becomes_a_disk_and_is_sewn_again),
        cmocka_unit_test(paths_branch_where_that_is_shorter),
        cmocka_unit_test(weights_draw_the_path_to_cheaper_edges),
        cmocka_unit_test(a_disk_and_a_closed_surface_are_left_alone),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
