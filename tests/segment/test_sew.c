/* Auto-sew: fewer charts, the bound kept, the first cut's seam kept. */
#include "segment/checks.h"
#include "segment/sew_internal.h"

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
    for (int trial = 0; trial < 8 * test_multiplier(); trial++) {
        sl_mesh *plain = trial % 2 == 0 ? test_spiky_mesh(&rng, 7, 5, 1.2, TEST_MIXED)
                                        : test_torus_mesh(&rng, 18, 10, 0.5, TEST_TRIANGLES);
        sl_mesh *sewn = NULL;
        assert_int_equal(sl_mesh_copy(plain, &sewn), SL_OK);
        sl_triangulation *t = test_triangulate(plain);
        sl_segment_def def = sl_segment_default();
        def.rule = SL_RULE_LONGEST; /* splits more than it need */
        def.flatten.minimise_stretch = false;
        def.flatten.max_stretch = 1.3;
        def.sew_stretch = 1.16;
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

/* Capped at two charts the result is the first cut itself: none of its edges may be sewn later. Returns how many are
 * where protection is off. */
static int32_t check_first_cut(sl_mesh *mesh)
{
    sl_mesh *first = NULL, *loose = NULL;
    assert_int_equal(sl_mesh_copy(mesh, &first), SL_OK);
    assert_int_equal(sl_mesh_copy(mesh, &loose), SL_OK);
    sl_triangulation *t = test_triangulate(mesh);
    sl_segment_def def = sl_segment_default();
    def.rule = SL_RULE_LONGEST;
    def.flatten.minimise_stretch = false;
    def.sew = false;
    def.max_charts = 2;
    sl_segmentation *two = segment(first, t, &def);
    assert_int_equal(two->nchart, 2);
    def.sew = true;
    def.max_charts = 1000;
    def.flatten.max_stretch = 1.3;
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
    sl_segmentation_free(two);
    sl_segmentation_free(kept);
    sl_segmentation_free(free_to_sew);
    sl_triangulation_free(t);
    sl_mesh_free(first);
    sl_mesh_free(loose);
    return opened;
}

static void the_first_cut_s_seam_is_never_sewn(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0x5e4);
    int32_t opened = 0;
    for (int trial = 0; trial < 6 * test_multiplier(); trial++) {
        sl_mesh *mesh = test_spiky_mesh(&rng, 7, 4 + trial % 4, 1.2, TEST_TRIANGLES);
        opened += check_first_cut(mesh);
        sl_mesh_free(mesh);
    }
    assert_true(opened > 0);
}

static sl_chart_job half_of(const sl_mesh *mesh, bool right)
{
    sl_chart_job job = {.face = sl_alloc(mesh->nf, sizeof *job.face)};
    for (int32_t f = 0; f < mesh->nf; f++) {
        double c[3];
        sl_mesh_face_centroid(mesh, f, c);
        if ((c[0] > 0.0) == right) {
            job.face[job.count++] = f;
        }
    }
    return job;
}

/* Two halves of a patch, their seam closed to sewing in one place: only the longer run beside that place may be sewn.
 */
static void a_merge_sews_the_longest_run_of_what_may_be_sewn(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0x5e5);
    for (int trial = 0; trial < 10 * test_multiplier(); trial++) {
        sl_mesh *mesh = test_patch_mesh(&rng, 8, 14, TEST_MIXED, NULL);
        sl_triangulation *t = test_triangulate(mesh);
        sl_chart_job a = half_of(mesh, false), b = half_of(mesh, true), job = {0};
        uint8_t *sewable = calloc((size_t)mesh->nh, 1);
        const double gap = mesh->xyz[3 * test_index(&rng, mesh->nv) + 1];
        double length[2] = {0.0};
        int32_t edges[2] = {0}, seam = 0;
        for (int32_t h = 0; h < mesh->nh; h++) {
            const int32_t o = mesh->twin[h];
            const bool cross = o >= 0 && sl_find_sorted(a.face, a.count, mesh->face[h]) >= 0 &&
                               sl_find_sorted(b.face, b.count, mesh->face[o]) >= 0;
            if (cross) {
                const double y0 = mesh->xyz[3 * mesh->origin[h] + 1], y1 = mesh->xyz[3 * sl_target(mesh, h) + 1];
                sl_mesh_cut_edge(mesh, h);
                seam++;
                if ((y0 > gap) == (y1 > gap)) { /* the edge over the gap stays closed */
                    sewable[h] = sewable[o] = 1;
                    length[y0 > gap] += sl_mesh_edge_length(mesh, h);
                    edges[y0 > gap]++;
                }
            }
        }
        const sl_context context = {0};
        sl_sewing sewing = {mesh, t, sewable, sl_flatten_default(), &context};
        sl_merge_charts(&sewing, &a, &b, &job);
        assert_int_equal(job.status, SL_OK);
        assert_true(job.done && job.count == mesh->nf);
        if (edges[0] + edges[1] == seam - 1) { /* otherwise the seam crosses the gap several times */
            assert_int_equal(job.joined.count, edges[length[1] > length[0]]);
        }
        for (int32_t k = 0; k < job.joined.count; k++) {
            assert_true(sewable[job.joined.halfedge[k]]);
        }
        free(sewable);
        sl_chart_job_clear(&a);
        sl_chart_job_clear(&b);
        sl_chart_job_clear(&job);
        sl_triangulation_free(t);
        sl_mesh_free(mesh);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(sewing_merges_within_its_own_bound),
        cmocka_unit_test(a_merge_sews_the_longest_run_of_what_may_be_sewn),
        cmocka_unit_test(the_first_cut_s_seam_is_never_sewn),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
