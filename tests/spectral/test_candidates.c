/* Sides, nodal domains and seams against brute force. */
#include "base/memory.h"
#include "spectral/shapes.h"
#include "spectral/spectrum.h"

static void zeros_and_rounding_belong_to_the_positive_side(void **state)
{
    (void)state;
    double vectors[] = {0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 3.7, -2e-12, 0.0, -0.0, -3.8e-12, -1.3};
    const sl_spectrum s = {.n = 6, .count = 2, .vectors = vectors};
    const uint8_t expected[6] = {1, 1, 1, 1, 0, 0};
    uint8_t side[6];
    sl_spectrum_side(&s, 1, side);
    assert_memory_equal(side, expected, sizeof side);
    sl_spectrum_side(&s, 0, side);
    for (int k = 0; k < 6; k++) {
        assert_int_equal(side[k], 1);
    }
}

/* Nodal domains by repeated relaxation over mesh edges: nothing of the graph code is used. */
static void brute_force(const sl_mesh *mesh, const double *v, sl_cut_candidate *c)
{
    int32_t *root = malloc((size_t)mesh->nf * sizeof *root);
    double zero = 0.0; /* regular grids have true zeros, blurred by rounding: they belong to F+ */
    *c = (sl_cut_candidate){0};
    for (int32_t f = 0; f < mesh->nf; f++) {
        root[f] = f;
        zero = fmin(zero, -1e-12 * fabs(v[f]));
    }
    for (bool changed = true; changed;) {
        changed = false;
        for (int32_t h = 0; h < mesh->nh; h++) {
            const int32_t f = mesh->face[h], g = mesh->twin[h] >= 0 ? mesh->face[mesh->twin[h]] : f;
            if ((v[f] >= zero) == (v[g] >= zero) && root[g] < root[f]) {
                root[f] = root[g];
                changed = true;
            }
        }
    }
    for (int32_t f = 0; f < mesh->nf; f++) {
        c->positive_parts += root[f] == f && v[f] >= zero;
        c->negative_parts += root[f] == f && v[f] < zero;
    }
    for (int32_t h = 0; h < mesh->nh; h++) {
        if (h < mesh->twin[h] && (v[mesh->face[h]] >= zero) != (v[mesh->face[mesh->twin[h]]] >= zero)) {
            c->seam_edges++;
            c->seam_length += sl_mesh_edge_length(mesh, h);
        }
    }
    free(root);
}

static void check_mesh(const sl_mesh *mesh, int32_t *passing, int32_t *failing)
{
    sl_facet_graph *graph = test_whole_graph(mesh, NULL);
    sl_spectrum *s = NULL;
    assert_int_equal(sl_spectrum_compute(graph, 20, NULL, &s), SL_OK);
    sl_cut_candidate c[19], expected;
    assert_int_equal(sl_cut_candidates(mesh, graph, s, c), SL_OK);
    for (int32_t k = 1; k < s->count; k++) {
        brute_force(mesh, s->vectors + (int64_t)k * s->n, &expected);
        assert_int_equal(c[k - 1].vector, k);
        assert_int_equal(c[k - 1].positive_parts, expected.positive_parts);
        assert_int_equal(c[k - 1].negative_parts, expected.negative_parts);
        assert_int_equal(c[k - 1].seam_edges, expected.seam_edges);
        assert_true(test_near_rel(c[k - 1].seam_length, expected.seam_length, 1e-12));
        assert_int_equal(c[k - 1].passes, expected.positive_parts == 1 && expected.negative_parts == 1);
        *passing += c[k - 1].passes;
        *failing += !c[k - 1].passes;
    }
    sl_spectrum_free(s);
    sl_facet_graph_free(graph);
}

static void candidates_agree_with_brute_force_nodal_domains(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0xca9d);
    int32_t passing = 0, failing = 0;
    for (int trial = 0; trial < 9 * test_multiplier(); trial++) {
        const test_facets kind = (test_facets)test_index(&rng, 3);
        sl_mesh *mesh = trial % 3 == 0   ? test_patch_mesh(&rng, 9, 4 + test_index(&rng, 12), kind, NULL)
                        : trial % 3 == 1 ? test_torus_mesh(&rng, 14, 9, 0.4, kind)
                                         : test_spiky_mesh(&rng, 5, 4, 1.5, kind);
        check_mesh(mesh, &passing, &failing);
        sl_mesh_free(mesh);
    }
    assert_true(passing > 10 && failing > 10); /* both outcomes were met */
}

/* The Fiedler vector of a connected graph has connected nodal domains unless lambda_2 is multiple (Fiedler 1975). */
static void the_fiedler_vector_passes_on_generic_meshes(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0xf1ed1e);
    for (int trial = 0; trial < 10 * test_multiplier(); trial++) {
        sl_mesh *mesh = test_patch_mesh(&rng, 7 + test_index(&rng, 7), 15, TEST_MIXED, NULL);
        sl_facet_graph *graph = test_whole_graph(mesh, NULL);
        sl_spectrum *s = NULL;
        sl_cut_candidate c;
        assert_int_equal(sl_spectrum_compute(graph, 2, NULL, &s), SL_OK);
        assert_int_equal(sl_cut_candidates(mesh, graph, s, &c), SL_OK);
        assert_true(c.passes);
        sl_spectrum_free(s);
        sl_facet_graph_free(graph);
        sl_mesh_free(mesh);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(zeros_and_rounding_belong_to_the_positive_side),
        cmocka_unit_test(candidates_agree_with_brute_force_nodal_domains),
        cmocka_unit_test(the_fiedler_vector_passes_on_generic_meshes),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
