/* Whole segmentations by every method: only the cut differs, what must hold does not. */
#include "segment/baselines.h"

static sl_mesh *shape(test_rng *rng, int kind)
{
    switch (kind % 4) {
    case 0:
        return test_spiky_mesh(rng, 6, 0, 0.0, TEST_TRIANGLES);
    case 1:
        return test_torus_mesh(rng, 18, 10, 0.35, TEST_MIXED);
    case 2:
        return test_spiky_mesh(rng, 8, 6, 1.6, TEST_MIXED);
    default:
        return test_spiky_mesh(rng, 7, 2, 2.0, TEST_QUADS);
    }
}

/* PCA, VSA by number, VSA by error, the Fiedler vector, at random, Iso-charts, embeddings in two and in five. */
enum { METHODS = 8 };

static sl_segment_def method(int which, sl_segment_def def)
{
    static const sl_cut_method methods[METHODS] = {SL_METHOD_PCA,       SL_METHOD_VSA,      SL_METHOD_VSA,
                                                   SL_METHOD_FIEDLER,   SL_METHOD_RANDOM,   SL_METHOD_ISOCHARTS,
                                                   SL_METHOD_EMBEDDING, SL_METHOD_EMBEDDING};
    def.symmetry = SL_SYMMETRY_USE_OFF;
    def.method = methods[which];
    def.vsa_regions = which == 1 ? 5 : 0;
    def.vsa_error = 0.3;
    def.clusters = which == 7 ? 5 : 2;
    return def;
}

static sl_segmentation *segment(sl_mesh *mesh, const sl_triangulation *t, const sl_segment_def *def, int32_t threads)
{
    sl_thread_pool *pool = NULL;
    sl_segmentation *s = NULL;
    assert_int_equal(sl_thread_pool_create(threads, &pool), SL_OK);
    const sl_context context = {.executor = sl_thread_pool_executor(pool)};
    assert_int_equal(sl_segment(mesh, t, def, &context, &s), SL_OK);
    sl_thread_pool_free(pool);
    return s;
}

static void every_method_ends_in_valid_charts(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0x3e70);
    int32_t deeper = 0;
    for (int trial = 0; trial < 4 * METHODS * test_multiplier(); trial++) {
        const int which = trial % METHODS;
        sl_mesh *mesh = shape(&rng, trial / METHODS);
        sl_triangulation *t = test_triangulate(mesh);
        sl_segment_def def = method(which, trial / METHODS % 2 == 0 ? sl_segment_default() : sl_segment_paper());
        def.flatten.max_stretch = which == 1 ? 1.02 : def.flatten.max_stretch;
        sl_segmentation *s = segment(mesh, t, &def, 2);
        assert_int_equal(test_check_segmentation(mesh, t, s, def.flatten.max_stretch), 0);
        assert_true(s->nsplit > 0 && s->split[0].vector >= 0 && s->split[0].candidates == 1);
        assert_true(def.method != SL_METHOD_PCA || s->split[0].vector <= 2);
        assert_true(def.method != SL_METHOD_FIEDLER || s->split[0].vector == 1);
        assert_true(def.method != SL_METHOD_EMBEDDING || s->split[0].vector == def.clusters);
        for (int32_t k = 0; k < s->nsplit; k++) { /* as many proxies as were asked for once, then two */
            const bool first = s->split[k].depth == 0;
            deeper += which == 1 && !first;
            assert_true(which != 1 || s->split[k].parts == (first ? 5 : 2));
            assert_true(which != 1 || s->split[k].vector == s->split[k].parts);
            assert_true(which != 2 || first || s->split[k].parts == 2);
            assert_true(def.method != SL_METHOD_RANDOM || s->split[k].parts == 2);
            assert_true(which != 7 || first || s->split[k].vector == 2);
        }
        sl_segmentation_free(s);
        sl_triangulation_free(t);
        sl_mesh_free(mesh);
    }
    assert_true(deeper > 4);
}

static void any_number_of_threads_gives_the_same_bytes(void **state)
{
    (void)state;
    for (int which = 0; which < METHODS; which++) {
        sl_mesh *mesh[3];
        sl_segmentation *s[3];
        const int32_t threads[3] = {1, 2, 5};
        for (int k = 0; k < 3; k++) {
            test_rng rng = test_rng_seed(0x7ead);
            mesh[k] = shape(&rng, 2);
            sl_triangulation *t = test_triangulate(mesh[k]);
            const sl_segment_def def = method(which, sl_segment_default());
            s[k] = segment(mesh[k], t, &def, threads[k]);
            sl_triangulation_free(t);
        }
        for (int k = 1; k < 3; k++) {
            assert_int_equal(s[0]->nchart, s[k]->nchart);
            assert_int_equal(s[0]->nsplit, s[k]->nsplit);
            assert_memory_equal(s[0]->face_chart, s[k]->face_chart, (size_t)mesh[0]->nf * sizeof(int32_t));
            assert_memory_equal(s[0]->corner_uv, s[k]->corner_uv, 2 * (size_t)mesh[0]->nh * sizeof(double));
            assert_memory_equal(mesh[0]->twin, mesh[k]->twin, (size_t)mesh[0]->nh * sizeof(int32_t));
        }
        for (int k = 0; k < 3; k++) {
            sl_segmentation_free(s[k]);
            sl_mesh_free(mesh[k]);
        }
    }
}

static void pairs_of_triangles_are_never_cut_apart(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0x9a13);
    for (int which = 0; which < METHODS; which++) {
        sl_mesh *mesh = test_spiky_mesh(&rng, 6, 3, 1.0, TEST_TRIANGLES);
        sl_triangulation *t = test_triangulate(mesh);
        sl_piece *piece = test_whole_piece(mesh, t);
        int32_t *partner = malloc((size_t)mesh->nf * sizeof *partner), pairs = 0;
        double fraction = 0.0;
        sl_choice choice;
        assert_int_equal(sl_pair_triangles(mesh, partner, &fraction), SL_OK);
        const sl_segment_def def = method(which, sl_segment_default());
        assert_int_equal(sl_choose_cut(piece, partner, &def, NULL, &choice), SL_OK);
        assert_true(choice.found);
        for (int32_t f = 0; f < mesh->nf; f++) {
            pairs += partner[f] >= 0;
            assert_true(partner[f] < 0 || choice.side[f] == choice.side[partner[f]]);
        }
        assert_true(pairs > mesh->nf / 2);
        sl_choice_clear(&choice);
        free(partner);
        sl_piece_free(piece);
        sl_triangulation_free(t);
        sl_mesh_free(mesh);
    }
}

static void no_more_proxies_than_charts_are_allowed(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0xca9);
    for (int which = 1; which < 3; which++) {
        sl_mesh *mesh = shape(&rng, 2);
        sl_triangulation *t = test_triangulate(mesh);
        sl_segment_def def = method(which, sl_segment_default());
        def.vsa_regions = which == 1 ? 30 : 0;
        def.vsa_error = 0.01;
        def.max_charts = 7;
        sl_segmentation *s = segment(mesh, t, &def, 1);
        test_check_segmentation(mesh, t, s, def.flatten.max_stretch);
        assert_int_equal(s->split[0].parts, 7);
        assert_int_equal(s->nchart, 7);
        sl_segmentation_free(s);
        sl_triangulation_free(t);
        sl_mesh_free(mesh);
    }
}

/* VSA on its own, so that only its reports count. */
typedef struct countdown {
    int left, heard;
} countdown;

static bool count_down(void *user, const char *stage, double fraction)
{
    countdown *c = user;
    assert_string_equal(stage, "proxies");
    assert_true(fraction >= 0.0 && fraction <= 1.0);
    c->heard++;
    return c->left-- > 0;
}

static void the_search_for_proxies_can_be_cancelled(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0xca5ce1);
    sl_mesh *mesh = shape(&rng, 2);
    sl_triangulation *t = test_triangulate(mesh);
    test_surface s = test_surface_of(mesh, t);
    int32_t *region = malloc((size_t)mesh->nf * sizeof *region), count = -3, cancelled = 0;
    const sl_vsa_def def = {.regions = 6, .most = 100};
    sl_status status = SL_CANCELLED;
    for (int after = 0; status == SL_CANCELLED; after++) {
        countdown counter = {after, 0};
        const sl_context context = {.progress = count_down, .progress_user = &counter};
        status = sl_vsa_partition(&s.vsa, &def, &context, region, &count, NULL);
        assert_int_equal(counter.heard, after + (status == SL_CANCELLED));
        assert_true(status == SL_OK ? count == 6 : status == SL_CANCELLED && count == -3);
        cancelled += status == SL_CANCELLED;
    }
    assert_int_equal(status, SL_OK);
    assert_true(cancelled >= 8); /* five insertions, the sweeps after them */
    free(region);
    test_surface_clear(&s);
    sl_triangulation_free(t);
    sl_mesh_free(mesh);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_method_ends_in_valid_charts),
        cmocka_unit_test(any_number_of_threads_gives_the_same_bytes),
        cmocka_unit_test(pairs_of_triangles_are_never_cut_apart),
        cmocka_unit_test(no_more_proxies_than_charts_are_allowed),
        cmocka_unit_test(the_search_for_proxies_can_be_cancelled),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
