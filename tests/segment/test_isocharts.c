/* Clusters around the extremes of embedded distances, and their borders. */
#include "segment/baselines.h"
#include "segment/isocharts_internal.h"

static sl_isocharts start(const sl_piece *piece, const sl_facet_graph *graph, int32_t *label)
{
    sl_isocharts iso = {.piece = piece, .graph = graph, .label = label};
    iso.area = calloc((size_t)graph->graph.n, sizeof *iso.area);
    iso.vertex_work = malloc((size_t)piece->mesh->nv * sizeof *iso.vertex_work);
    sl_node_areas(piece, graph, iso.area, NULL);
    assert_int_equal(sl_geodesics_create(piece->mesh, piece->triangulation, &iso.geodesics), SL_OK);
    return iso;
}

static void finish(sl_isocharts *iso)
{
    sl_geodesics_clear(&iso->geodesics);
    sl_mds_clear(&iso->mds);
    sl_free(iso->landmark);
    sl_free(iso->distance);
    sl_free(iso->node_distance);
    free(iso->area);
    free(iso->vertex_work);
}

/* A mesh as one piece with its graph, a node a facet. */
typedef struct subject {
    sl_mesh *mesh;
    sl_triangulation *t;
    sl_piece *piece;
    sl_facet_graph *graph;
    int32_t *label;
    sl_isocharts iso;
} subject;

static subject prepare(sl_mesh *mesh)
{
    subject s = {.mesh = mesh, .t = test_triangulate(mesh)};
    s.piece = test_whole_piece(mesh, s.t);
    s.graph = test_whole_graph(s.piece->mesh, NULL);
    s.label = malloc((size_t)mesh->nf * sizeof *s.label);
    s.iso = start(s.piece, s.graph, s.label);
    assert_int_equal(sl_iso_embed(&s.iso, NULL), SL_OK);
    return s;
}

static void discard(subject *s)
{
    finish(&s->iso);
    free(s->label);
    sl_facet_graph_free(s->graph);
    sl_piece_free(s->piece);
    sl_triangulation_free(s->t);
    sl_mesh_free(s->mesh);
}

static void landmarks_are_spread_and_know_their_distances(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0x150);
    subject s = prepare(test_torus_mesh(&rng, 30, 14, 0.35, TEST_MIXED));
    const int32_t nv = s.mesh->nv, n = s.iso.landmarks;
    assert_int_equal(n, 100);
    double nearest = HUGE_VAL, covered = 0.0;
    for (int32_t i = 0; i < n; i++) {
        assert_true(s.iso.distance[i * nv + s.iso.landmark[i]] == 0.0F);
        for (int32_t j = 0; j < i; j++) {
            nearest = fmin(nearest, s.iso.distance[i * nv + s.iso.landmark[j]]);
        }
    }
    for (int32_t v = 0; v < nv; v++) {
        double least = HUGE_VAL;
        for (int32_t i = 0; i < n; i++) {
            least = fmin(least, s.iso.distance[i * nv + v]);
        }
        covered = fmax(covered, least);
    }
    assert_true(covered <= nearest * (1.0 + 1e-3)); /* farthest points: no hole wider than what parts them */
    discard(&s);
}

/* A long tube is one dimension and two clusters, a ball three and six; a flat patch two and four. */
static void shapes_have_the_dimensions_that_one_would_say(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0x151);
    for (int trial = 0; trial < 3 * test_multiplier(); trial++) {
        for (int kind = 0; kind < 3; kind++) {
            sl_mesh *mesh = kind == 0   ? test_tube_mesh(&rng, 12, 80, 60.0, TEST_MIXED)
                            : kind == 1 ? test_spiky_mesh(&rng, 16, 0, 0.0, TEST_TRIANGLES)
                                        : test_patch_mesh(&rng, 24, 30, TEST_QUADS, NULL);
            subject s = prepare(mesh);
            assert_int_equal(s.iso.dims, kind == 0 ? 1 : kind == 1 ? 3 : 2);
            assert_int_equal(sl_iso_cluster(&s.iso, 100), SL_OK);
            assert_int_equal(s.iso.clusters, 2 * s.iso.dims);
            test_check_regions(mesh, s.label, s.iso.clusters);
            for (int32_t k = 0; k < s.iso.clusters; k++) {
                assert_int_equal(s.label[s.iso.seed[k]], k);
            }
            discard(&s);
        }
    }
}

/* Most facets belong to the representative nearest to them; few were cut off by others. */
static void clusters_go_to_the_nearest_representative(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0x152);
    subject s = prepare(test_spiky_mesh(&rng, 12, 5, 1.5, TEST_MIXED));
    int32_t nearest = 0, n = s.graph->graph.n;
    assert_int_equal(sl_iso_cluster(&s.iso, 100), SL_OK);
    for (int32_t i = 0; i < n; i++) {
        bool least = true;
        for (int32_t k = 0; k < s.iso.clusters; k++) {
            least &= s.iso.node_distance[k * n + i] >= s.iso.node_distance[s.label[i] * n + i];
        }
        nearest += least;
    }
    assert_true(nearest > 97 * n / 100);
    discard(&s);
}

static void no_more_clusters_than_allowed_but_two(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0x153);
    subject s = prepare(test_spiky_mesh(&rng, 12, 0, 0.0, TEST_MIXED));
    for (int32_t most = 1; most < 5; most++) {
        assert_int_equal(sl_iso_cluster(&s.iso, most), SL_OK);
        assert_int_equal(s.iso.clusters, most < 2 ? 2 : most);
        test_check_regions(s.mesh, s.label, s.iso.clusters);
        sl_free(s.iso.node_distance);
        s.iso.node_distance = NULL;
    }
    discard(&s);
}

/* Share of the border between regions that runs where the facets meet at an angle. */
static double share_on_creases(const subject *s, const int32_t *side)
{
    double crease = 0.0, all = 0.0;
    const sl_mesh *m = s->piece->mesh;
    for (int32_t h = 0; h < m->nh; h++) {
        const int32_t f = m->face[h], g = m->twin[h] >= 0 ? m->face[m->twin[h]] : f;
        if (s->label[f] != s->label[g]) {
            const double length = sl_mesh_edge_length(m, h);
            crease += side[f] != side[g] ? length : 0.0;
            all += length;
        }
    }
    return crease / all;
}

static void borders_move_to_creases_and_clusters_stay_whole(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0x154);
    double before = 0.0, after = 0.0;
    for (int trial = 0; trial < 6 * test_multiplier(); trial++) {
        const double a[3] = {test_uniform(&rng, 0.7, 1.0), test_uniform(&rng, 0.7, 1.0), test_uniform(&rng, 0.7, 1.0)};
        const int32_t n[3] = {9 + test_index(&rng, 4), 9 + test_index(&rng, 4), 9 + test_index(&rng, 4)};
        int32_t side[2048];
        subject s = prepare(test_box_mesh(&rng, a, n, TEST_TRIANGLES, side));
        assert_int_equal(sl_iso_cluster(&s.iso, 100), SL_OK);
        before += share_on_creases(&s, side);
        assert_int_equal(sl_iso_refine(&s.iso), SL_OK);
        after += share_on_creases(&s, side);
        test_check_regions(s.mesh, s.label, s.iso.clusters);
        for (int32_t k = 0; k < s.iso.clusters; k++) {
            assert_int_equal(s.label[s.iso.seed[k]], k);
        }
        discard(&s);
    }
    assert_true(after > 1.5 * before);
}

/* Two facets: two representatives at most, each with a facet of its own. */
static void two_facets_make_two_clusters(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0x155);
    subject s = prepare(test_patch_mesh(&rng, 2, 1, TEST_QUADS, NULL));
    sl_choice choice = {0};
    const sl_segment_def def = sl_segment_default();
    assert_int_equal(sl_isocharts_labels(s.piece, s.graph, &def, NULL, s.label, &choice), SL_OK);
    assert_true(choice.found && choice.vector == 2 && s.label[0] != s.label[1]);
    discard(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(landmarks_are_spread_and_know_their_distances),
        cmocka_unit_test(shapes_have_the_dimensions_that_one_would_say),
        cmocka_unit_test(clusters_go_to_the_nearest_representative),
        cmocka_unit_test(no_more_clusters_than_allowed_but_two),
        cmocka_unit_test(borders_move_to_creases_and_clusters_stay_whole),
        cmocka_unit_test(two_facets_make_two_clusters),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
