/* Whole segmentations: what must hold for every one of them, options, threads, cancelling. */
#include "segment/checks.h"

static sl_mesh *shape(test_rng *rng, int kind)
{
    switch (kind % 5) {
    case 0:
        return test_spiky_mesh(rng, 6, 0, 0.0, TEST_TRIANGLES); /* a ball */
    case 1:
        return test_torus_mesh(rng, 18, 10, 0.35, TEST_MIXED);
    case 2:
        return test_spiky_mesh(rng, 8, 6, 1.6, TEST_MIXED); /* long fingers */
    case 3:
        return test_tube_mesh(rng, 9, 12, 6.0, TEST_QUADS);
    default:
        return test_patch_mesh(rng, 9, 11, TEST_TRIANGLES, NULL);
    }
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

static void every_shape_ends_in_valid_charts(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0x5e9);
    for (int trial = 0; trial < 5 * test_multiplier(); trial++) {
        sl_mesh *mesh = shape(&rng, trial);
        sl_triangulation *t = test_triangulate(mesh);
        sl_segment_def def = sl_segment_default();
        sl_segmentation *s = segment(mesh, t, &def, 1);
        assert_int_equal(test_check_segmentation(mesh, t, s, def.flatten.max_stretch), 0);
        assert_true(trial % 5 > 2 || s->nsplit > 0);   /* closed surfaces must be cut */
        assert_true(trial % 5 <= 2 || s->nchart == 1); /* a tube and a patch need not be split */
        sl_segmentation_free(s);
        sl_triangulation_free(t);
        sl_mesh_free(mesh);
    }
}

static void rules_and_the_paper_s_settings_end_in_valid_charts(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0x5ea);
    for (int k = 0; k < 4; k++) {
        sl_mesh *mesh = shape(&rng, k < 2 ? 1 : 2);
        sl_triangulation *t = test_triangulate(mesh);
        sl_segment_def def = k == 3 ? sl_segment_paper() : sl_segment_default();
        def.rule = k == 3 ? SL_RULE_LONGEST : (sl_cut_rule)k;
        def.pairing = k == 1 ? SL_PAIR_ON : def.pairing;
        sl_segmentation *s = segment(mesh, t, &def, 2);
        assert_int_equal(test_check_segmentation(mesh, t, s, def.flatten.max_stretch), 0);
        assert_true(k == 3 ? !s->paired : k != 1 || s->paired);
        if (k == 3) {
            assert_int_equal(s->merges, 0);
            for (int32_t c = 0; c < s->nchart; c++) {
                assert_int_not_equal(s->chart[c].flat.method, SL_FLATTEN_TUTTE);
            }
        }
        sl_segmentation_free(s);
        sl_triangulation_free(t);
        sl_mesh_free(mesh);
    }
}

/* Without sewing and symmetry: cutting edge by edge in the order that is told gives, after each split, as many pieces
 * as the splits so far made, and in the end the seams there are. */
static void the_order_of_cutting_is_told(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0x5ec);
    for (int trial = 0; trial < 3 * test_multiplier(); trial++) {
        sl_mesh *mesh = shape(&rng, trial), *again = NULL;
        sl_triangulation *t = test_triangulate(mesh);
        sl_segment_def def = sl_segment_default();
        def.sew = false;
        def.symmetry = SL_SYMMETRY_USE_OFF;
        def.flatten.max_stretch = 1.004;
        assert_int_equal(sl_mesh_copy(mesh, &again), SL_OK);
        sl_segmentation *s = segment(mesh, t, &def, 2);
        int32_t *label = sl_alloc(mesh->nf, sizeof *label), pieces = 1, count = 0;
        assert_non_null(label);
        assert_true(s->nsplit > 0);
        for (int32_t k = 0; k <= s->nsplit; k++) {
            assert_int_equal(sl_mesh_components(again, label, &count), SL_OK);
            assert_int_equal(count, pieces);
            for (int32_t h = 0; h < again->nh; h++) {
                if (s->cut_after[h] == k) {
                    sl_mesh_cut_edge(again, h);
                }
            }
            pieces += k < s->nsplit ? s->split[k].parts - 1 : 0;
        }
        assert_int_equal(pieces, s->nchart);
        assert_memory_equal(again->sew, mesh->sew, (size_t)mesh->nh * sizeof *mesh->sew);
        sl_free(label);
        sl_segmentation_free(s);
        sl_triangulation_free(t);
        sl_mesh_free(mesh);
        sl_mesh_free(again);
    }
}

/* Everything but what a solver's info may hold in padding. */
static void check_same(const sl_mesh *a, const sl_segmentation *s, const sl_mesh *b, const sl_segmentation *r)
{
    assert_int_equal(s->nchart, r->nchart);
    assert_int_equal(s->nsplit, r->nsplit);
    assert_int_equal(s->merges, r->merges);
    assert_memory_equal(s->face, r->face, (size_t)a->nf * sizeof *s->face);
    assert_memory_equal(s->face_chart, r->face_chart, (size_t)a->nf * sizeof *s->face_chart);
    assert_memory_equal(s->corner_uv, r->corner_uv, 2 * (size_t)a->nh * sizeof *s->corner_uv);
    assert_memory_equal(a->twin, b->twin, (size_t)a->nh * sizeof *a->twin);
    assert_memory_equal(a->sew, b->sew, (size_t)a->nh * sizeof *a->sew);
    for (int32_t k = 0; k < s->nsplit; k++) {
        assert_int_equal(s->split[k].vector, r->split[k].vector);
        assert_int_equal(s->split[k].facets, r->split[k].facets);
        assert_memory_equal(&s->split[k].length, &r->split[k].length, sizeof s->split[k].length);
    }
}

static void any_number_of_threads_gives_the_same_bytes(void **state)
{
    (void)state;
    for (int kind = 0; kind < 3; kind++) {
        sl_mesh *mesh[3];
        sl_segmentation *s[3];
        const int32_t threads[3] = {1, 2, 5};
        for (int k = 0; k < 3; k++) {
            test_rng rng = test_rng_seed(0x7ead + (uint64_t)kind);
            mesh[k] = shape(&rng, kind);
            sl_triangulation *t = test_triangulate(mesh[k]);
            const sl_segment_def def = sl_segment_default();
            s[k] = segment(mesh[k], t, &def, threads[k]);
            sl_triangulation_free(t);
        }
        for (int k = 1; k < 3; k++) {
            check_same(mesh[0], s[0], mesh[k], s[k]);
        }
        for (int k = 0; k < 3; k++) {
            sl_segmentation_free(s[k]);
            sl_mesh_free(mesh[k]);
        }
    }
}

static void the_cap_stops_splitting_and_is_reported(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0xca9);
    for (int32_t cap = 1; cap <= 6; cap += 2) {
        sl_mesh *mesh = shape(&rng, 2);
        sl_triangulation *t = test_triangulate(mesh);
        sl_segment_def def = sl_segment_default();
        def.max_charts = cap;
        def.sew = false;
        def.flatten.max_stretch = 1.02;
        sl_segmentation *s = segment(mesh, t, &def, 2);
        int32_t capped = 0;
        assert_true(s->nchart <= cap);
        test_check_segmentation(mesh, t, s, def.flatten.max_stretch);
        for (int32_t c = 0; c < s->nchart; c++) {
            capped += s->chart[c].capped;
        }
        assert_true(capped > 0);
        sl_segmentation_free(s);
        sl_triangulation_free(t);
        sl_mesh_free(mesh);
    }
}

/* Only what can be unrolled without any stretch is left whole: the recursion goes down to single facets, and ends. */
static void a_bound_of_no_stretch_ends_at_developable_charts(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0x1f);
    sl_mesh *mesh = test_torus_mesh(&rng, 6, 4, 0.4, TEST_TRIANGLES);
    sl_triangulation *t = test_triangulate(mesh);
    sl_segment_def def = sl_segment_default();
    def.flatten.max_stretch = 1.0;
    def.flatten.minimise_stretch = false;
    sl_segmentation *s = segment(mesh, t, &def, 1);
    test_check_segmentation(mesh, t, s, 1.0 + 1e-6);
    for (int32_t c = 0; c < s->nchart; c++) { /* no vertex inside: V - E + F = 1 and F facets glued in a tree */
        assert_true(s->chart[c].topology.vertices == s->chart[c].count + 2);
    }
    sl_segmentation_free(s);
    sl_triangulation_free(t);
    sl_mesh_free(mesh);
}

typedef struct countdown {
    int left;
} countdown;

static bool count_down(void *user, const char *stage, double fraction)
{
    (void)stage;
    (void)fraction;
    return ((countdown *)user)->left-- > 0;
}

static void cancelling_leaves_the_mesh_as_it_was(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0xca5ce1);
    sl_mesh *mesh = shape(&rng, 2), *before = NULL;
    sl_mesh_cut_edge(mesh, 17);
    sl_triangulation *t = test_triangulate(mesh);
    assert_int_equal(sl_mesh_copy(mesh, &before), SL_OK);
    const sl_segment_def def = sl_segment_default();
    int cancelled = 0;
    for (int after = 0; after < 4; after++) {
        countdown counter = {after};
        const sl_context context = {.progress = count_down, .progress_user = &counter};
        sl_segmentation *s = (sl_segmentation *)&rng;
        assert_int_equal(sl_segment(mesh, t, &def, &context, &s), SL_CANCELLED);
        assert_null(s);
        cancelled++;
        assert_memory_equal(mesh->twin, before->twin, (size_t)mesh->nh * sizeof *mesh->twin);
        assert_memory_equal(mesh->sew, before->sew, (size_t)mesh->nh * sizeof *mesh->sew);
    }
    assert_int_equal(cancelled, 4);
    countdown counter = {0};
    const sl_context context = {.progress = count_down, .progress_user = &counter};
    sl_segmentation *s = (sl_segmentation *)&rng;
    assert_int_equal(sl_flatten_charts(mesh, t, &def, &context, &s), SL_CANCELLED);
    assert_null(s);
    assert_memory_equal(mesh->twin, before->twin, (size_t)mesh->nh * sizeof *mesh->twin);
    sl_mesh_free(before);
    sl_triangulation_free(t);
    sl_mesh_free(mesh);
}

/* A patch cut across: the halves would merge at once if their seam were ours. */
static void seams_of_the_caller_stay(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0x5ea7);
    sl_mesh *mesh = test_patch_mesh(&rng, 12, 9, TEST_MIXED, NULL), *before = NULL;
    for (int32_t h = 0; h < mesh->nh; h++) {
        double c[3], d[3];
        sl_mesh_face_centroid(mesh, mesh->face[h], c);
        sl_mesh_face_centroid(mesh, mesh->face[mesh->twin[h] >= 0 ? mesh->twin[h] : h], d);
        if ((c[0] > 0.0) != (d[0] > 0.0)) {
            sl_mesh_cut_edge(mesh, h);
        }
    }
    assert_int_equal(sl_mesh_copy(mesh, &before), SL_OK);
    sl_triangulation *t = test_triangulate(mesh);
    sl_segment_def def = sl_segment_default();
    def.sew_stretch = 1.5;
    def.protect_first = false;
    sl_segmentation *s = segment(mesh, t, &def, 2);
    assert_int_equal(test_check_segmentation(mesh, t, s, def.flatten.max_stretch), 0);
    assert_int_equal(s->nchart, 2);
    for (int32_t h = 0; h < mesh->nh; h++) {
        assert_true(before->sew[h] < 0 || mesh->sew[h] == before->sew[h]);
    }
    sl_segmentation_free(s);
    sl_triangulation_free(t);
    sl_mesh_free(before);
    sl_mesh_free(mesh);
}

static void charts_of_the_caller_s_seams_are_flattened_and_only_loops_cut(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0xf1a7);
    for (int join = 0; join < 2; join++) {
        sl_mesh *mesh = test_tube_mesh(&rng, 11, 14, 5.0, TEST_MIXED), *before = NULL;
        for (int32_t h = 0; h < mesh->nh; h++) { /* two halves of the tube: one slit open, one left closed */
            const int32_t f = mesh->face[h], g = mesh->twin[h] >= 0 ? mesh->face[mesh->twin[h]] : f;
            double c[3], d[3];
            sl_mesh_face_centroid(mesh, f, c);
            sl_mesh_face_centroid(mesh, g, d);
            if ((c[0] > 0.0) != (d[0] > 0.0) || (c[0] > 0.0 && c[2] > 0.0 && (c[1] > 0.0) != (d[1] > 0.0))) {
                sl_mesh_cut_edge(mesh, h);
            }
        }
        assert_int_equal(sl_mesh_copy(mesh, &before), SL_OK);
        sl_triangulation *t = test_triangulate(mesh);
        sl_segment_def def = sl_segment_default();
        def.join = join == 1;
        sl_segmentation *s = NULL;
        assert_int_equal(sl_flatten_charts(mesh, t, &def, NULL, &s), SL_OK);
        test_check_partition(mesh, s);
        test_check_pointers(mesh);
        int32_t added = 0, disks = 0;
        for (int32_t h = 0; h < mesh->nh; h++) {
            assert_true(before->sew[h] < 0 || mesh->sew[h] == before->sew[h]);
            added += mesh->sew[h] >= 0 && before->sew[h] < 0;
        }
        for (int32_t c = 0; c < s->nchart; c++) {
            disks += s->chart[c].flat.verdict == SL_CHART_VALID;
            assert_false(s->chart[c].capped);
        }
        assert_int_equal(s->nsplit, 0);
        assert_true(join == 1 ? added > 0 && disks == s->nchart : added == 0 && disks == s->nchart - 1);
        if (join == 1) {
            assert_int_equal(test_check_segmentation(mesh, t, s, def.flatten.max_stretch), 0);
        }
        sl_segmentation_free(s);
        sl_triangulation_free(t);
        sl_mesh_free(before);
        sl_mesh_free(mesh);
    }
}

/* Minimising once more gains next to nothing, though the bound was met long before. */
static void minimised_charts_are_relaxed_to_the_end(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0x9015);
    int32_t relaxed = 0;
    for (int trial = 0; trial < 4 * test_multiplier(); trial++) {
        sl_mesh *mesh = test_spiky_mesh(&rng, 7, 4, 1.0, TEST_TRIANGLES);
        sl_triangulation *t = test_triangulate(mesh);
        const sl_segment_def def = sl_segment_default();
        sl_segmentation *s = segment(mesh, t, &def, 2);
        assert_int_equal(test_check_segmentation(mesh, t, s, def.flatten.max_stretch), 0);
        for (int32_t c = 0; c < s->nchart; c++) {
            const sl_chart *chart = &s->chart[c];
            if (!chart->flat.stretch_minimised) {
                continue;
            }
            sl_patch *patch = NULL;
            assert_int_equal(sl_patch_extract(mesh, t, s->face + chart->first, chart->count, &patch), SL_OK);
            double *uv = malloc(2 * (size_t)patch->nv * sizeof *uv);
            for (int32_t k = 0; k < 3 * patch->nt; k++) {
                memcpy(uv + 2 * patch->tri[k], s->corner_uv + 2 * patch->corner[k], 2 * sizeof *uv);
            }
            sl_stretch_def again = def.flatten.stretch;
            sl_stretch_info info;
            again.simple_border = true;
            assert_int_equal(sl_stretch_minimise(patch, &again, NULL, uv, &info), SL_OK);
            assert_true(info.energy_after > (1.0 - 2e-3) * info.energy_before);
            relaxed++;
            free(uv);
            sl_patch_free(patch);
        }
        sl_segmentation_free(s);
        sl_triangulation_free(t);
        sl_mesh_free(mesh);
    }
    assert_true(relaxed > 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_shape_ends_in_valid_charts),
        cmocka_unit_test(the_order_of_cutting_is_told),
        cmocka_unit_test(rules_and_the_paper_s_settings_end_in_valid_charts),
        cmocka_unit_test(any_number_of_threads_gives_the_same_bytes),
        cmocka_unit_test(minimised_charts_are_relaxed_to_the_end),
        cmocka_unit_test(the_cap_stops_splitting_and_is_reported),
        cmocka_unit_test(a_bound_of_no_stretch_ends_at_developable_charts),
        cmocka_unit_test(cancelling_leaves_the_mesh_as_it_was),
        cmocka_unit_test(seams_of_the_caller_stay),
        cmocka_unit_test(charts_of_the_caller_s_seams_are_flattened_and_only_loops_cut),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
