/* The minimiser in a workspace that many charts share, and the sums of its measures. */
#include "param/stretch.h"

#include "param/distortion.h"
#include "param/stretch_charts.h"
#include "param/tutte.h"

/* One workspace for charts of all sizes, the same ones again, with and without held vertices, two solvers at a time. */
static void results_do_not_depend_on_the_workspace(void **state)
{
    (void)state;
    sl_stretch_workspace *workspace = NULL;
    assert_int_equal(sl_stretch_workspace_create(&workspace), SL_OK);
    for (int trial = 0; trial < 12 * test_multiplier(); trial++) {
        const int kind = trial / 2; /* each twice */
        sl_patch *patch =
            kind % 2 == 0 ? chart_tube(6 + kind, 4, 0.1, 0x3a) : chart_hexagon(3, 0.2, chart_bumps, 1.0, 7);
        const size_t size = 2 * (size_t)patch->nv * sizeof(double);
        double *uv = malloc(size), *alone = malloc(size), *start = malloc(size);
        uint8_t *fixed = calloc((size_t)patch->nv, 1);
        sl_stretch_def def = sl_stretch_default();
        sl_stretch *first = NULL, *second = NULL;
        assert_int_equal(sl_tutte(patch, SL_TUTTE_UNIFORM, NULL, start), SL_OK);
        memcpy(alone, start, size);
        fixed[trial % patch->nv] = 1;
        def.fixed = trial % 3 == 0 ? fixed : NULL;
        assert_int_equal(sl_stretch_minimise(patch, &def, NULL, alone, NULL), SL_OK);
        def.workspace = workspace;
        assert_int_equal(sl_stretch_create(patch, start, &def, &first), SL_OK);
        assert_int_equal(sl_stretch_create(patch, start, &def, &second), SL_OK);
        for (int i = 0; i < def.max_iterations; i++) {
            assert_int_equal(sl_stretch_step(first, 1, NULL), SL_OK);
            assert_int_equal(sl_stretch_step(second, 1, NULL), SL_OK);
        }
        assert_memory_equal(sl_stretch_uv(first), alone, size);
        assert_memory_equal(sl_stretch_uv(second), alone, size);
        sl_stretch_free(first);
        sl_stretch_free(second);
        memcpy(uv, start, size);
        assert_int_equal(sl_stretch_minimise(patch, &def, NULL, uv, NULL), SL_OK);
        assert_memory_equal(uv, alone, size);
        def.fixed = NULL; /* through coarse meshes, after and before the whole */
        assert_int_equal(sl_stretch_unfold(patch, &def, NULL, uv, NULL), SL_OK);
        def.workspace = NULL;
        assert_int_equal(sl_stretch_unfold(patch, &def, NULL, alone, NULL), SL_OK);
        assert_memory_equal(uv, alone, size);
        free(uv);
        free(alone);
        free(start);
        free(fixed);
        sl_patch_free(patch);
    }
    sl_stretch_workspace_free(workspace);
    sl_stretch_workspace_free(NULL);
}

static void terms_add_up_to_the_distortion_measures(void **state)
{
    (void)state;
    for (uint64_t seed = 0; seed < 10; seed++) {
        sl_patch *patch = seed % 2 == 0 ? chart_hexagon(4, 0.25, chart_bumps, 1.4, seed) : chart_tube(7, 3, 0.2, seed);
        double *uv = malloc(2 * (size_t)patch->nv * sizeof *uv);
        sl_stretch_terms *term = malloc((size_t)patch->nt * sizeof *term), half[2] = {{0}};
        sl_distortion d;
        assert_int_equal(sl_tutte(patch, SL_TUTTE_UNIFORM, NULL, uv), SL_OK);
        assert_int_equal(sl_distortion_measure_indexed(patch->nt, patch->tri, patch->xyz, uv, &d), SL_OK);
        const sl_stretch_terms sum = sl_stretch_terms_of(patch, uv, term);
        assert_true(test_near_rel(sum.area, d.area_3d, 1e-12) && test_near_rel(sum.uv, d.area_uv, 1e-12));
        assert_true(test_near_rel(sqrt(sum.inverse * sum.uv) / sum.area, d.l2, 1e-11));
        assert_true(test_near_rel(sum.angle / sum.area, d.angle_mean, 1e-9));
        for (int32_t t = 0; t < patch->nt; t++) {
            half[t % 2].inverse += term[t].inverse;
            half[t % 2].angle += term[t].angle;
        }
        assert_true(test_near_rel(half[0].inverse + half[1].inverse, sum.inverse, 1e-12));
        assert_true(test_near_rel(half[0].angle + half[1].angle, sum.angle, 1e-12));
        for (int32_t i = 0; i < patch->nv; i++) { /* mirrored */
            uv[2 * i] = -uv[2 * i];
        }
        assert_true(isinf(sl_stretch_terms_of(patch, uv, NULL).inverse));
        free(uv);
        free(term);
        sl_patch_free(patch);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(results_do_not_depend_on_the_workspace),
        cmocka_unit_test(terms_add_up_to_the_distortion_measures),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
