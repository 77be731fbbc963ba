/* Auto-sew: fewer charts, the bound kept, the first cut's seam kept. */
#include "segment/checks.h"

static sl_segmentation *segment(sl_mesh *mesh, const sl_triangulation *t, const sl_segment_def *def)
{
    sl_segmentation *s = NULL;
    assert_int_equal(sl_segment(mesh, t, def, NULL, &s), SL_OK);
    return s;
}

static int32_t seam_edges(const sl_mesh *mesh)
{
    int32_t n = 0;
    for (int32_t h = 0; h < mesh->nh; h++) {
        n += h < mesh->sew[h];
    }
    return n;
}

/* Is chart c of s also one of r, facet for facet? */
static bool is_chart_of(const sl_segmentation *s, int32_t c, const sl_segmentation *r)
{
    const int32_t d = r->face_chart[s->face[s->chart[c].first]];
    return s->chart[c].count == r->chart[d].count && memcmp(s->face + s->chart[c].first, r->face + r->chart[d].first,
                                                            (size_t)s->chart[c].count * sizeof *s->face) == 0;
}

static void sewing_merges_within_its_own_bound(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0x5e3);
    int32_t merges = 0;
    for (int trial = 0; trial < 4 * test_multiplier(); trial++) {
        sl_mesh *plain = trial % 2 == 0 ? test_spiky_mesh(&rng, 7, 5, 1.2, TEST_MIXED)
                                        : test_torus_mesh(&rng, 18, 10, 0.5, TEST_TRIANGLES);
        sl_mesh *sewn = NULL;
        assert_int_equal(sl_mesh_copy(plain, &sewn), SL_OK);
        sl_triangulation *t = test_triangulate(plain);
        sl_segment_def def = sl_segment_default();
        def.flatten.max_stretch = 1.08;
        def.sew_stretch = 1.04;
        def.sew = false;
        sl_segmentation *a = segment(plain, t, &def);
        def.sew = true;
        sl_segmentation *b = segment(sewn, t, &def);
        assert_int_equal(test_check_segmentation(sewn, t, b, def.flatten.max_stretch), 0);
        assert_int_equal(b->nchart, a->nchart - b->merges);
        for (int32_t c = 0; c < b->nchart; c++) {
            assert_true(is_chart_of(b, c, a) || b->chart[c].flat.distortion.l2 <= def.sew_stretch * (1.0 + 1e-9));
        }
        for (int32_t h = 0; h < plain->nh; h++) { /* sewing cuts nothing */
            assert_true(sewn->sew[h] < 0 || plain->sew[h] == sewn->sew[h]);
        }
        assert_true(b->merges == 0 || seam_edges(sewn) < seam_edges(plain));
        merges += b->merges;
        sl_segmentation_free(a);
        sl_segmentation_free(b);
        sl_triangulation_free(t);
        sl_mesh_free(plain);
        sl_mesh_free(sewn);
    }
    assert_true(merges > 0);
}

/* Capped at two charts the result is the first cut itself: none of its edges may be sewn later. */
static void the_first_cut_s_seam_is_never_sewn(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0x5e4);
    sl_mesh *mesh = test_spiky_mesh(&rng, 7, 5, 1.2, TEST_TRIANGLES), *first = NULL, *loose = NULL;
    assert_int_equal(sl_mesh_copy(mesh, &first), SL_OK);
    assert_int_equal(sl_mesh_copy(mesh, &loose), SL_OK);
    sl_triangulation *t = test_triangulate(mesh);
    sl_segment_def def = sl_segment_default();
    def.sew = false;
    def.max_charts = 2;
    sl_segmentation *two = segment(first, t, &def);
    assert_int_equal(two->nchart, 2);
    def = sl_segment_default();
    def.flatten.max_stretch = 1.1;
    def.sew_stretch = 1e9;
    sl_segmentation *kept = segment(mesh, t, &def);
    def.protect_first = false;
    sl_segmentation *free_to_sew = segment(loose, t, &def);
    int32_t opened = 0;
    for (int32_t h = 0; h < mesh->nh; h++) {
        const bool on_first_cut = first->sew[h] >= 0;
        assert_true(!on_first_cut || mesh->sew[h] >= 0);
        opened += on_first_cut && loose->sew[h] < 0;
    }
    assert_true(opened > 0); /* and without protection it is */
    sl_segmentation_free(two);
    sl_segmentation_free(kept);
    sl_segmentation_free(free_to_sew);
    sl_triangulation_free(t);
    sl_mesh_free(mesh);
    sl_mesh_free(first);
    sl_mesh_free(loose);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(sewing_merges_within_its_own_bound),
        cmocka_unit_test(the_first_cut_s_seam_is_never_sewn),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
