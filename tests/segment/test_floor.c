/* The Fiedler vector's cut, random cuts, and clusters of the global point signature. */
#include "eigen/lanczos.h"
#include "segment/baselines.h"

/* A mesh as one piece with its graph. */
typedef struct subject {
    sl_mesh *mesh;
    sl_triangulation *t;
    sl_piece *piece;
    sl_facet_graph *graph;
    int32_t *label;
} subject;

static subject prepare(sl_mesh *mesh)
{
    subject s = {.mesh = mesh, .t = test_triangulate(mesh)};
    s.piece = test_whole_piece(mesh, s.t);
    s.graph = test_whole_graph(s.piece->mesh, NULL);
    s.label = malloc((size_t)mesh->nf * sizeof *s.label);
    return s;
}

static void discard(subject *s)
{
    free(s->label);
    sl_facet_graph_free(s->graph);
    sl_piece_free(s->piece);
    sl_triangulation_free(s->t);
    sl_mesh_free(s->mesh);
}

/* All pairs of D - A as dense matrices; *lambda n, returns n x n. */
static double *all_pairs(const sl_graph *g, double *lambda)
{
    const size_t n = (size_t)g->n;
    double *A = calloc(n * n, sizeof *A), *V = malloc(n * n * sizeof *V);
    for (int32_t i = 0; i < g->n; i++) {
        for (int32_t p = g->first[i]; p < g->first[i + 1]; p++) {
            A[i * g->n + i] += 1.0;
            A[i * g->n + g->adj[p]] -= 1.0;
        }
    }
    assert_int_equal(sl_dense_eigen(g->n, A, lambda, V), SL_OK);
    free(A);
    return V;
}

static void sides_are_the_signs_of_the_second_of_all_eigenvectors(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0xf1ed);
    const sl_segment_def def = sl_segment_default();
    for (int trial = 0; trial < 6 * test_multiplier(); trial++) {
        subject s = prepare(trial % 2 == 0 ? test_spiky_mesh(&rng, 5, 3, 1.1, TEST_MIXED)
                                           : test_patch_mesh(&rng, 9, 14, TEST_TRIANGLES, NULL));
        double *lambda = malloc((size_t)s.mesh->nf * sizeof *lambda), *V = all_pairs(&s.graph->graph, lambda);
        const double *v = V + s.mesh->nf;
        sl_choice choice = {0};
        assert_int_equal(sl_fiedler_labels(s.graph, &def, NULL, s.label, &choice), SL_OK);
        assert_true(choice.found && choice.vector == 1 && choice.candidates == 1);
        assert_true(test_near(choice.lambda, lambda[1], 1e-5 * lambda[1]));
        int32_t wrong[2] = {0, 0};
        for (int32_t i = 0; i < s.mesh->nf && lambda[2] > 1.01 * lambda[1]; i++) {
            for (int sign = 0; sign < 2; sign++) {
                wrong[sign] += fabs(v[i]) > 1e-4 && s.label[i] != (sign == 0 ? v[i] > 0.0 : v[i] < 0.0);
            }
        }
        assert_true(wrong[0] == 0 || wrong[1] == 0);
        free(lambda);
        free(V);
        discard(&s);
    }
}

static int32_t count_ones(const subject *s)
{
    int32_t ones = 0;
    for (int32_t i = 0; i < s->graph->graph.n; i++) {
        ones += s->label[i];
    }
    return ones;
}

static void random_cuts_are_in_two_connected_parts_and_by_the_seed(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0x4a2d);
    subject s = prepare(test_spiky_mesh(&rng, 7, 4, 1.4, TEST_MIXED));
    const int32_t n = s.graph->graph.n;
    int32_t *before = malloc((size_t)n * sizeof *before), same = 0;
    double share = 0.0;
    enum { SEEDS = 60 };
    for (int32_t seed = 0; seed < SEEDS; seed++) {
        sl_segment_def def = sl_segment_default();
        sl_choice choice = {0};
        def.seed = seed;
        memcpy(before, s.label, (size_t)n * sizeof *before);
        assert_int_equal(sl_random_labels(s.piece, s.graph, &def, s.label, &choice), SL_OK);
        assert_true(choice.found);
        test_check_regions(s.piece->mesh, s.label, 2);
        same += seed > 0 && memcmp(before, s.label, (size_t)n * sizeof *before) == 0;
        share += (double)count_ones(&s) / n / SEEDS;
        memcpy(before, s.label, (size_t)n * sizeof *before);
        assert_int_equal(sl_random_labels(s.piece, s.graph, &def, s.label, &choice), SL_OK);
        assert_memory_equal(before, s.label, (size_t)n * sizeof *before);
    }
    assert_true(same <= 2);
    assert_true(share > 0.35 && share < 0.65); /* neither side is favoured */
    free(before);
    discard(&s);
}

static void two_facets_are_parted_at_random_too(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0x4a2e);
    subject s = prepare(test_patch_mesh(&rng, 2, 1, TEST_QUADS, NULL));
    for (int32_t seed = 0; seed < 20; seed++) {
        sl_segment_def def = sl_segment_default();
        sl_choice choice = {0};
        def.seed = seed;
        assert_int_equal(sl_random_labels(s.piece, s.graph, &def, s.label, &choice), SL_OK);
        assert_true(choice.found && s.label[0] != s.label[1]);
    }
    discard(&s);
}

/* The sum of squares from the definition, with the signature by dense eigenvectors: what the method reports, and hardly
 * any facet can change its cluster to lower it. */
static void clusters_of_the_signature_cannot_be_improved(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0xe3b);
    for (int32_t clusters = 2; clusters < 6; clusters++) {
        subject s = prepare(test_spiky_mesh(&rng, 5, 4, 1.3, TEST_MIXED));
        const int32_t n = s.graph->graph.n, dims = 11;
        double *lambda = malloc((size_t)n * sizeof *lambda), *V = all_pairs(&s.graph->graph, lambda);
        double *area = calloc((size_t)n, sizeof *area), total = 0.0, energy = 0.0;
        double mean[6 * 11] = {0.0}, mass[6] = {0.0};
        sl_segment_def def = sl_segment_default();
        sl_choice choice = {0};
        def.vectors = dims + 1;
        def.clusters = clusters;
        assert_int_equal(sl_embedding_labels(s.piece, s.graph, &def, NULL, s.label, &choice), SL_OK);
        assert_true(choice.found && choice.vector == clusters);
        for (int32_t i = 0; i < n; i++) {
            area[i] = sl_mesh_face_area(s.piece->mesh, i);
            total += area[i];
            mass[s.label[i]] += area[i];
            for (int32_t k = 0; k < dims; k++) {
                mean[s.label[i] * dims + k] += area[i] * V[(k + 1) * n + i] / sqrt(lambda[k + 1]);
            }
        }
        for (int32_t i = 0; i < n; i++) {
            double own = 0.0, least = HUGE_VAL;
            for (int32_t c = 0; c < clusters; c++) {
                double sum = 0.0;
                for (int32_t k = 0; k < dims; k++) {
                    const double d = V[(k + 1) * n + i] / sqrt(lambda[k + 1]) - mean[c * dims + k] / mass[c];
                    sum += d * d;
                }
                own = c == s.label[i] ? sum : own;
                least = fmin(least, sum);
            }
            energy += area[i] * own;
            assert_true(own <= least * (1.0 + 1e-3));
        }
        assert_true(
            test_near(choice.lambda, energy / total, 2e-3 * choice.lambda)); /* quads bend: areas differ a bit */
        free(area);
        free(lambda);
        free(V);
        discard(&s);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(sides_are_the_signs_of_the_second_of_all_eigenvectors),
        cmocka_unit_test(random_cuts_are_in_two_connected_parts_and_by_the_seed),
        cmocka_unit_test(two_facets_are_parted_at_random_too),
        cmocka_unit_test(clusters_of_the_signature_cannot_be_improved),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
