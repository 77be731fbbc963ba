/* The coarse mesh of large pieces, and the way of its seams back to the surface. */
#include "optimize/checks.h"

static void decimation_keeps_topology_and_takes_its_vertices_from_the_surface(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0xdec);
    for (int trial = 0; trial < 4 * test_multiplier(); trial++) {
        sl_mesh *fine = trial % 2 == 0 ? test_spiky_mesh(&rng, 12, 4, 0.8, TEST_TRIANGLES)
                                       : test_patch_mesh(&rng, 24, 19, TEST_MIXED, NULL);
        test_surface s = test_surface_of(fine);
        const sl_patch *p = s.surface.patch;
        sl_mesh *coarse = NULL;
        int32_t *vertex = NULL;
        assert_int_equal(sl_opt_decimate(p, p->nt / 5, &coarse, &vertex), SL_OK);
        assert_true(coarse->nf <= p->nt / 5 && coarse->nf > p->nt / 8);
        int32_t *face = malloc(sizeof *face * (size_t)(coarse->nf > fine->nf ? coarse->nf : fine->nf));
        for (int32_t f = 0; f < coarse->nf || f < fine->nf; f++) {
            face[f] = f;
        }
        sl_topology a, b;
        assert_int_equal(sl_mesh_topology(fine, face, fine->nf, &a), SL_OK);
        assert_int_equal(sl_mesh_topology(coarse, face, coarse->nf, &b), SL_OK);
        assert_int_equal(a.genus, b.genus);
        assert_int_equal(a.loops, b.loops);
        for (int32_t v = 0; v < coarse->nv; v++) {
            for (int k = 0; k < 3; k++) { /* the coarse mesh was normalised anew */
                const double x = coarse->xyz[3 * v + k] / coarse->scale + coarse->centre[k];
                assert_true(test_near(x, p->xyz[3 * vertex[coarse->input_vertex[v]] + k], 1e-14));
            }
        }
        free(face);
        sl_mesh_free(coarse);
        sl_free(vertex);
        test_surface_clear(&s);
    }
}

static void seams_of_the_proxy_become_the_surface_s(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0xca4);
    for (int trial = 0; trial < 2 * test_multiplier(); trial++) {
        const sl_optimize_def def = sl_optimize_default();
        test_surface fine = test_surface_of(test_spiky_mesh(&rng, 14, 3, 0.6, TEST_TRIANGLES));
        sl_mesh *mesh = NULL;
        int32_t *vertex = NULL;
        assert_int_equal(sl_opt_decimate(fine.surface.patch, 700, &mesh, &vertex), SL_OK);
        test_surface coarse = test_surface_of(mesh);
        sl_opt_state there = test_started(&coarse, &def), here;
        assert_int_equal(sl_opt_cut(&there), SL_OK);
        assert_int_equal(sl_opt_state_init(&fine.surface, &def, NULL, &here), SL_OK);
        bool carried = false;
        assert_int_equal(sl_opt_carry(&there, vertex, &here, &carried), SL_OK);
        assert_true(carried);
        test_check_state(&here);
        assert_int_equal(here.nchart, there.nchart);
        sl_opt_total a, b;
        sl_opt_totals(&there, &a);
        sl_opt_totals(&here, &b);
        assert_true(test_near(a.length, b.length, 0.2 * a.length));
        sl_opt_uncut(&here);
        assert_int_equal(here.nchart, 0);
        sl_opt_state_clear(&here);
        sl_opt_state_clear(&there);
        sl_free(vertex);
        test_surface_clear(&coarse);
        test_surface_clear(&fine);
    }
}

static sl_segmentation *search(sl_mesh *mesh, const sl_triangulation *t, const sl_optimize_def *def,
                               sl_optimize_info *info)
{
    sl_segmentation *s = NULL;
    const sl_segment_def segment = sl_segment_default();
    assert_int_equal(sl_optimize_segment(mesh, t, &segment, def, NULL, &s, info), SL_OK);
    test_check_partition(mesh, s);
    test_check_glued(mesh, s);
    return s;
}

static void large_pieces_are_searched_on_a_coarse_mesh(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0x1a26e);
    sl_mesh *mesh = test_spiky_mesh(&rng, 30, 5, 1.2, TEST_MIXED);
    sl_triangulation *t = test_triangulate(mesh);
    const sl_optimize_def def = sl_optimize_default();
    sl_optimize_info info;
    assert_true(t->nt > 10000);
    sl_segmentation *s = search(mesh, t, &def, &info);
    assert_int_equal(info.failed + info.missed + info.direct, 0);
    for (int32_t c = 0; c < s->nchart; c++) {
        assert_int_equal(s->chart[c].flat.verdict, SL_CHART_VALID);
    }
    const sl_distortion d = test_whole_distortion(mesh, t, s);
    assert_true(d.l2 <= def.target_stretch * (1.0 + 1e-9) && d.angle_mean <= def.target_angle * (1.0 + 1e-9));
    assert_true(info.cuts > 0 && info.seconds[SL_OPTIMIZE_COARSEN] > 0.0 && info.seconds[SL_OPTIMIZE_CARRY] > 0.0);
    sl_segmentation_free(s);
    sl_triangulation_free(t);
    sl_mesh_free(mesh);
}

/* A sphere whose rings are one long facet and one quad each, at random places: seams across the rings must take long
 * ways, which no corridor about a coarse seam holds. */
static sl_mesh *ring_mesh(test_rng *rng, int32_t columns, int32_t rings)
{
    const int32_t rows = rings + 1;
    double *xyz = malloc(3 * sizeof *xyz * (size_t)(rows * columns));
    int32_t *first = malloc(sizeof *first * (size_t)(2 * rings + 3)), nf = 0, n = 0;
    int32_t *index = malloc(sizeof *index * (size_t)(2 * rings * (columns + 2) + 2 * columns));
    for (int32_t v = 0; v < rows * columns; v++) {
        const double z = 0.98 * cos(3.14159265358979 * (v / columns + 1) / (rows + 1));
        const double turn = 6.28318530717959 * (v % columns) / columns, r = sqrt(1.0 - z * z);
        xyz[3 * v] = r * cos(turn);
        xyz[3 * v + 1] = r * sin(turn);
        xyz[3 * v + 2] = z;
    }
    first[0] = 0;
    for (int32_t i = 0; i < rings; i++) {
        const int32_t a = test_index(rng, columns);
        for (int32_t part = 0; part < 2; part++) {
            const int32_t from = a + part, cells = part == 0 ? 1 : columns - 1;
            for (int32_t k = 0; k <= cells; k++) { /* the lower row on, the upper back */
                index[n++] = (i + 1) * columns + (from + k) % columns;
            }
            for (int32_t k = cells; k >= 0; k--) {
                index[n++] = i * columns + (from + k) % columns;
            }
            first[++nf] = n;
        }
    }
    for (int32_t cap = 0; cap < 2; cap++) {
        for (int32_t k = 0; k < columns; k++) {
            index[n++] = cap == 0 ? k : (rows - 1) * columns + columns - 1 - k;
        }
        first[++nf] = n;
    }
    return test_mesh_of(rows * columns, nf, xyz, first, index);
}

static void pieces_whose_coarse_seams_lead_nowhere_are_searched_as_they_are(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0xd12ec7);
    sl_mesh *mesh = ring_mesh(&rng, 100, 52);
    sl_triangulation *t = test_triangulate(mesh);
    sl_optimize_def def = sl_optimize_default();
    sl_optimize_info info;
    def.weights = sl_seam_cost_none();
    assert_true(t->nt > 10000);
    sl_segmentation *s = search(mesh, t, &def, &info);
    assert_int_equal(info.direct, 1);
    sl_segmentation_free(s);
    sl_triangulation_free(t);
    sl_mesh_free(mesh);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(decimation_keeps_topology_and_takes_its_vertices_from_the_surface),
        cmocka_unit_test(seams_of_the_proxy_become_the_surface_s),
        cmocka_unit_test(large_pieces_are_searched_on_a_coarse_mesh),
        cmocka_unit_test(pieces_whose_coarse_seams_lead_nowhere_are_searched_as_they_are),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
