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

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(decimation_keeps_topology_and_takes_its_vertices_from_the_surface),
        cmocka_unit_test(seams_of_the_proxy_become_the_surface_s),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
