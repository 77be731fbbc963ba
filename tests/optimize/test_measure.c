/* The score against the measures of param, and the taking out of charts against the patches of mesh. */
#include "optimize/checks.h"

static void the_score_adds_up_to_the_atlas_s_stretch(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0x0b7);
    for (int trial = 0; trial < 4 * test_multiplier(); trial++) {
        const sl_optimize_def def = sl_optimize_default();
        test_surface s = test_surface_of(test_spiky_mesh(&rng, 6, trial, 0.8, trial % 2 ? TEST_MIXED : TEST_TRIANGLES));
        sl_opt_state opt = test_started(&s, &def);
        test_check_state(&opt);
        sl_opt_total total;
        sl_opt_totals(&opt, &total);
        const sl_patch *p = s.surface.patch;
        double *xyz = malloc(9 * sizeof *xyz * (size_t)p->nt), *uv = malloc(6 * sizeof *uv * (size_t)p->nt);
        for (int32_t c = 0; c < 3 * p->nt; c++) {
            const sl_opt_sums *sums = &opt.chart[opt.chart_of[c / 3]].sums;
            const double scale = pow(sums->inverse / sums->plane, 0.25); /* each chart at its best */
            memcpy(xyz + 3 * c, p->xyz + 3 * p->tri[c], 3 * sizeof *xyz);
            uv[2 * c] = scale * opt.uv[2 * c];
            uv[2 * c + 1] = scale * opt.uv[2 * c + 1];
        }
        sl_distortion d;
        assert_int_equal(sl_distortion_measure(p->nt, xyz, uv, 1, &d), SL_OK);
        assert_true(test_near_rel(total.stretch, d.l2, 1e-9));
        assert_true(test_near_rel(total.angle, d.angle_mean, 1e-9));
        for (int32_t c = 0; c < opt.nchart; c++) { /* the density is the sum's parts */
            const sl_opt_chart *chart = &opt.chart[c];
            double *density = malloc(2 * sizeof *density * (size_t)chart->patch->nt), sum[2] = {0.0, 0.0};
            sl_opt_sums sums;
            sl_opt_measure(&s.surface, chart->patch, chart->uv, &sums, density);
            for (int32_t t = 0; t < chart->patch->nt; t++) {
                assert_true(density[2 * t] >= -1e-15 && density[2 * t + 1] >= 0.0);
                sum[0] += density[2 * t];
                sum[1] += density[2 * t + 1];
            }
            assert_true(test_near(sum[0], sl_opt_stretch(&sums), 1e-12 * sums.space));
            assert_true(test_near(sum[1], sums.shear, 1e-12 * sums.space));
            free(density);
        }
        free(xyz);
        free(uv);
        sl_opt_state_clear(&opt);
        test_surface_clear(&s);
    }
}

static void a_map_that_turns_over_is_infinitely_bad(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0xbad);
    test_surface s = test_surface_of(test_patch_mesh(&rng, 7, 6, TEST_TRIANGLES, NULL));
    const sl_patch *p = s.surface.patch;
    double *uv = malloc(2 * sizeof *uv * (size_t)p->nv);
    for (int32_t v = 0; v < 2 * p->nv; v++) {
        uv[v] = test_uniform(&rng, -1.0, 1.0);
    }
    sl_patch *same = NULL;
    int32_t *local = malloc(sizeof *local * (size_t)p->nt), *list = malloc(sizeof *list * (size_t)p->nt);
    uint8_t *cut = calloc(3 * (size_t)p->nt, 1);
    for (int32_t t = 0; t < p->nt; t++) {
        local[t] = -1;
        list[t] = t;
    }
    assert_int_equal(sl_opt_extract(&s.surface, cut, list, p->nt, local, &same), SL_OK);
    sl_opt_sums sums;
    sl_opt_measure(&s.surface, same, uv, &sums, NULL);
    assert_true(isinf(sums.inverse) && isinf(sums.shear));
    sl_patch_free(same);
    free(uv);
    free(local);
    free(list);
    free(cut);
    test_surface_clear(&s);
}

static void a_chart_taken_out_is_the_mesh_s_own_patch(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0xe87);
    for (int trial = 0; trial < 5 * test_multiplier(); trial++) {
        test_surface s = test_surface_of(test_torus_mesh(&rng, 13, 9, 0.4, TEST_TRIANGLES));
        const sl_patch *p = s.surface.patch;
        uint8_t *cut = calloc(3 * (size_t)p->nt, 1);
        for (int32_t k = 0; k < 60; k++) {
            const int32_t h = test_index(&rng, 3 * p->nt);
            cut[h] = cut[p->twin[h]] = 1;
            sl_mesh_cut_edge(s.mesh, p->corner[h]);
        }
        int32_t *label = malloc(sizeof *label * (size_t)p->nt), parts = 0;
        int32_t *local = malloc(sizeof *local * (size_t)p->nt), *list = malloc(sizeof *list * (size_t)p->nt);
        memset(local, 0xff, sizeof *local * (size_t)p->nt);
        assert_int_equal(sl_mesh_components(s.mesh, label, &parts), SL_OK);
        for (int32_t c = 0; c < parts; c++) {
            int32_t n = 0;
            for (int32_t t = 0; t < p->nt; t++) {
                if (label[t] == c) {
                    list[n++] = t; /* triangle t is facet t */
                }
            }
            sl_patch *ours = NULL, *theirs = NULL;
            assert_int_equal(sl_opt_extract(&s.surface, cut, list, n, local, &ours), SL_OK);
            assert_int_equal(sl_patch_extract(s.mesh, s.triangulation, list, n, &theirs), SL_OK);
            assert_int_equal(ours->nv, theirs->nv);
            assert_int_equal(ours->loops, theirs->loops);
            assert_int_equal(ours->euler, theirs->euler);
            assert_memory_equal(ours->twin, theirs->twin, 3 * sizeof *ours->twin * (size_t)n);
            assert_memory_equal(ours->tri, theirs->tri, 3 * sizeof *ours->tri * (size_t)n);
            assert_memory_equal(ours->xyz, theirs->xyz, 3 * sizeof *ours->xyz * (size_t)ours->nv);
            assert_memory_equal(ours->border, theirs->border, (size_t)ours->nv);
            sl_patch_free(ours);
            sl_patch_free(theirs);
        }
        free(cut);
        free(label);
        free(local);
        free(list);
        test_surface_clear(&s);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_score_adds_up_to_the_atlas_s_stretch),
        cmocka_unit_test(a_map_that_turns_over_is_infinitely_bad),
        cmocka_unit_test(a_chart_taken_out_is_the_mesh_s_own_patch),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
