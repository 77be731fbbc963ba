#include "mesh/facet_graph.h"

#include "mesh/chart_check.h"

static soup s;
static int32_t faces[SOUP_FACES], partner[SOUP_FACES];

static int32_t position(int32_t n, int32_t f)
{
    for (int32_t i = 0; i < n; i++) {
        if (faces[i] == f) {
            return i;
        }
    }
    return -1;
}

static bool glued(const sl_mesh *m, int32_t f, int32_t g)
{
    for (int32_t h = m->face_first[f]; h < m->face_first[f + 1]; h++) {
        if (m->twin[h] >= 0 && m->face[m->twin[h]] == g) {
            return true;
        }
    }
    return false;
}

/* Are the facets at positions i and j to be one node? */
static bool one_node(const sl_mesh *m, int32_t i, int32_t j, bool pairing)
{
    return i == j ||
           (pairing && partner[faces[i]] == faces[j] && partner[faces[j]] == faces[i] && glued(m, faces[i], faces[j]));
}

static void check_nodes(const sl_mesh *m, int32_t n, bool pairing, const sl_facet_graph *g)
{
    int32_t next = 0;
    for (int32_t i = 0; i < n; i++) {
        assert_in_range(g->node[i], 0, next);
        next += g->node[i] == next;
        for (int32_t j = 0; j < n; j++) {
            assert_int_equal(g->node[i] == g->node[j], one_node(m, i, j, pairing));
        }
    }
    assert_int_equal(next, g->graph.n);
    /* Centroid: the mean over the node's different vertices. */
    for (int32_t node = 0; node < g->graph.n; node++) {
        double mean[3] = {0.0, 0.0, 0.0};
        int32_t corners = 0;
        for (int32_t v = 0; v < m->nv; v++) {
            bool has = false;
            for (int32_t h = 0; h < m->nh && !has; h++) {
                const int32_t i = m->origin[h] == v ? position(n, m->face[h]) : -1;
                has = i >= 0 && g->node[i] == node;
            }
            corners += has;
            for (int k = 0; k < 3 && has; k++) {
                mean[k] += m->xyz[3 * v + k];
            }
        }
        for (int k = 0; k < 3; k++) {
            assert_true(test_near(g->centroid[3 * node + k], mean[k] / corners, 8 * TEST_EPS));
        }
    }
}

/* Each halfedge between different nodes of the set has its entry, each entry its halfedge. */
static void check_edges(const sl_mesh *m, int32_t n, const sl_facet_graph *g)
{
    int32_t crossing = 0;
    for (int32_t h = 0; h < m->nh; h++) {
        const int32_t i = position(n, m->face[h]), j = m->twin[h] >= 0 ? position(n, m->face[m->twin[h]]) : -1;
        crossing += i >= 0 && j >= 0 && g->node[i] != g->node[j];
    }
    assert_null(g->graph.weight);
    assert_int_equal(g->graph.first[0], 0);
    assert_int_equal(g->graph.first[g->graph.n], crossing);
    for (int32_t node = 0; node < g->graph.n; node++) {
        for (int32_t p = g->graph.first[node]; p < g->graph.first[node + 1]; p++) {
            const int32_t h = g->halfedge[p];
            assert_int_equal(g->node[position(n, m->face[h])], node);
            assert_int_equal(g->node[position(n, m->face[m->twin[h]])], g->graph.adj[p]);
            for (int32_t q = 0; q < p; q++) {
                assert_int_not_equal(g->halfedge[q], h);
            }
        }
    }
}

/* Random partners: good pairs, some that are not glued, some that are not mutual. */
static void random_partners(const sl_mesh *m, test_rng *rng)
{
    for (int32_t f = 0; f < m->nf; f++) {
        partner[f] = -1;
    }
    for (int32_t h = 0; h < m->nh; h++) {
        const int32_t f = m->face[h], g = m->twin[h] >= 0 ? m->face[m->twin[h]] : test_index(rng, m->nf);
        if (f != g && partner[f] < 0 && partner[g] < 0 && sl_degree(m, f) == 3 && sl_degree(m, g) == 3 &&
            test_index(rng, 4) == 0) {
            partner[f] = g;
            partner[g] = f;
        }
    }
    for (int32_t h = 0; h < m->nh; h++) {
        if (partner[m->face[h]] < 0 && m->twin[h] >= 0 && test_index(rng, 8) == 0) {
            partner[m->face[h]] = m->face[m->twin[h]]; /* not returned */
        }
    }
}

static void random_sets_have_the_graph_of_their_twins(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0xf6);
    for (int trial = 0; trial < 60 * test_multiplier(); trial++) {
        soup_grid(&s, &rng, (soup_surface)test_index(&rng, 5), 3 + test_index(&rng, 4), 3 + test_index(&rng, 3), 0.6);
        sl_mesh *m = soup_build(&s, NULL);
        random_partners(m, &rng);
        for (int32_t k = 0; k < test_index(&rng, 20); k++) {
            sl_mesh_cut_edge(m, test_index(&rng, m->nh));
        }
        const int32_t n = grow_set(m, &rng, 1 + test_index(&rng, m->nf), faces);
        for (int pairing = 0; pairing < 2; pairing++) {
            sl_facet_graph *g = NULL;
            assert_int_equal(sl_facet_graph_create(m, faces, n, pairing == 1 ? partner : NULL, &g), SL_OK);
            check_nodes(m, n, pairing == 1, g);
            check_edges(m, n, g);
            sl_facet_graph_free(g);
        }
        sl_mesh_free(m);
    }
    sl_facet_graph_free(NULL);
}

static void facets_that_share_two_edges_are_joined_twice(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0x2ed);
    soup_clear(&s);
    soup_random_vertices(&s, &rng, 5);
    soup_face(&s, 4, (int32_t[]){0, 1, 2, 3});
    soup_face(&s, 4, (int32_t[]){2, 1, 0, 4}); /* shares 0-1 and 1-2 */
    sl_mesh *m = soup_build(&s, NULL);
    faces[0] = 0;
    faces[1] = 1;
    sl_facet_graph *g = NULL;
    assert_int_equal(sl_facet_graph_create(m, faces, 2, NULL, &g), SL_OK);
    assert_int_equal(g->graph.first[1], 2);
    assert_int_equal(g->graph.first[2], 4);
    check_edges(m, 2, g);
    sl_facet_graph_free(g);
    sl_mesh_free(m);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(random_sets_have_the_graph_of_their_twins),
        cmocka_unit_test(facets_that_share_two_edges_are_joined_twice),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
