/* The chain from chart to map: every verdict provoked, every fallback seen, every claim checked from outside. */
#include "param/flatten.h"

#include "param/flatten_internal.h"
#include "param/stretch_charts.h"

typedef struct outcome {
    sl_flatten_result r;
    double *uv;
} outcome;

/* Flattens, and checks what holds for any outcome: the result describes the map that was given back. */
static outcome flatten(const sl_patch *patch, const sl_flatten_def *def)
{
    outcome o = {.uv = malloc(2 * (size_t)patch->nv * sizeof(double))};
    memset(o.uv, 0xff, 2 * (size_t)patch->nv * sizeof(double));
    assert_int_equal(sl_flatten(patch, def, NULL, o.uv, &o.r), SL_OK);
    for (int32_t i = 0; i < 2 * patch->nv; i++) {
        assert_true(isfinite(o.uv[i]) && (o.r.method != SL_FLATTEN_NONE || o.uv[i] == 0.0));
    }
    if (o.r.method == SL_FLATTEN_NONE || chart_area(patch) == 0.0) {
        return o;
    }
    const sl_certificate c = chart_certify(patch, o.uv);
    sl_distortion d;
    assert_int_equal(sl_distortion_measure_indexed(patch->nt, patch->tri, patch->xyz, o.uv, &d), SL_OK);
    assert_int_equal(c.embedded, o.r.certificate.embedded);
    assert_int_equal(c.flipped, o.r.certificate.flipped);
    assert_true(d.l2 == o.r.distortion.l2 || (isnan(d.l2) && isnan(o.r.distortion.l2)));
    if (o.r.verdict == SL_CHART_VALID || o.r.verdict == SL_CHART_STRETCHED) {
        assert_true(c.embedded && test_near_rel(chart_uv_area(patch, o.uv), chart_area(patch), 1e-9));
    }
    if (o.r.verdict == SL_CHART_VALID && !sl_flatten_is_one_facet(patch)) {
        assert_true(d.l2 <= def->max_stretch && d.angle_mean <= def->max_angle);
    }
    return o;
}

/* The paper's: ABF++ and nothing else. */
static sl_flatten_def plain(void)
{
    sl_flatten_def def = sl_flatten_default();
    def.minimise_stretch = false;
    def.tutte = false;
    return def;
}

static void tame_charts_are_valid_by_abf_alone(void **state)
{
    (void)state;
    for (uint64_t seed = 0; seed < 12; seed++) {
        sl_patch *patch = seed % 2 == 0 ? chart_hexagon(5, 0.2, chart_bumps, 0.9, seed)
                                        : chart_grid(7, 5, 0.25, chart_bumps, 0.8, seed);
        const sl_flatten_def def = seed % 3 == 0 ? plain() : sl_flatten_default();
        outcome o = flatten(patch, &def);
        assert_int_equal(o.r.verdict, SL_CHART_VALID);
        assert_int_equal(o.r.method, SL_FLATTEN_ABF);
        assert_true(o.r.abf.converged && !o.r.stretch_minimised && o.r.distortion.angle_mean < 1.1);
        free(o.uv);
        sl_patch_free(patch);
    }
}

static void coplanar_charts_are_projected_isometrically(void **state)
{
    (void)state;
    sl_patch *patch = chart_grid(6, 5, 0.3, chart_plane, 0.7, 0x91a);
    const sl_flatten_def def = plain();
    outcome o = flatten(patch, &def);
    assert_int_equal(o.r.verdict, SL_CHART_VALID);
    assert_int_equal(o.r.method, SL_FLATTEN_PLANAR);
    assert_true(test_near(o.r.distortion.l2, 1.0, 1e-12) && test_near(o.r.distortion.angle_max, 1.0, 1e-11));
    for (int32_t v = 1; v < patch->nv; v++) {
        const double *x = patch->xyz, *y = &patch->xyz[3 * v];
        const double space =
            sqrt((x[0] - y[0]) * (x[0] - y[0]) + (x[1] - y[1]) * (x[1] - y[1]) + (x[2] - y[2]) * (x[2] - y[2]));
        assert_true(test_near(hypot(o.uv[2 * v] - o.uv[0], o.uv[2 * v + 1] - o.uv[1]), space, 1e-13));
    }
    double *uv = malloc(2 * (size_t)patch->nv * sizeof *uv);
    patch->xyz[3 * 7] += 1e-9; /* off the plane by more than rounding */
    patch->xyz[3 * 7 + 2] -= 1e-9;
    assert_false(sl_flatten_project(patch, uv));
    free(uv);
    free(o.uv);
    sl_patch_free(patch);
}

/* Coplanar, but folded over: no projection, and no ABF++ border that could stay where it was. */
static void a_folded_plane_is_not_projected(void **state)
{
    (void)state;
    const double xyz[15] = {0, 0, 1, 2, 0, 1, 2.1, 1.9, 1, 0, 2, 1, 1.1, -1.3, 1};
    const int32_t tri[12] = {0, 1, 4, 1, 2, 4, 2, 3, 4, 3, 0, 4}; /* the centre lies beyond edge 0-1 */
    sl_patch *patch = chart_make(5, xyz, 4, tri);
    const sl_flatten_def def = sl_flatten_default();
    outcome o = flatten(patch, &def);
    assert_true(o.r.method != SL_FLATTEN_PLANAR && o.r.method != SL_FLATTEN_NONE);
    assert_true(o.r.verdict == SL_CHART_VALID || o.r.verdict == SL_CHART_STRETCHED);
    free(o.uv);
    sl_patch_free(patch);
}

static void what_is_not_a_disk_has_no_map(void **state)
{
    (void)state;
    sl_patch *ring = chart_ring(9);
    const sl_flatten_def def = sl_flatten_default();
    outcome o = flatten(ring, &def);
    assert_int_equal(o.r.verdict, SL_CHART_NOT_A_DISK);
    assert_int_equal(o.r.method, SL_FLATTEN_NONE);
    free(o.uv);
    sl_patch_free(ring);
}

/* A sharp spike: ABF++ fails, and what happens then is the caller's choice. */
static void spikes_fail_in_abf_and_are_saved_by_tutte(void **state)
{
    (void)state;
    sl_patch *patch = chart_tube(6, 12, 0.25, 0x5b);
    for (int32_t v = 0; v < patch->nv; v++) {
        patch->xyz[3 * v] *= 0.05; /* twenty times as slender */
        patch->xyz[3 * v + 1] *= 0.05;
    }
    sl_flatten_def def = plain();
    outcome o = flatten(patch, &def);
    assert_int_equal(o.r.verdict, SL_CHART_NOT_CONVERGED);
    assert_true(o.r.method == SL_FLATTEN_ABF || o.r.method == SL_FLATTEN_NONE);
    assert_false(o.r.abf.converged);
    free(o.uv);

    def.minimise_stretch = true; /* LSCM is asked, and flips */
    o = flatten(patch, &def);
    assert_int_equal(o.r.verdict, SL_CHART_FLIPPED);
    assert_int_equal(o.r.method, SL_FLATTEN_LSCM);
    assert_true(o.r.certificate.flipped > 0);
    free(o.uv);

    def = sl_flatten_default();
    def.max_stretch = 1e6;
    def.minimise_stretch = false;
    o = flatten(patch, &def);
    const double raw = o.r.distortion.l2;
    assert_int_equal(o.r.method, SL_FLATTEN_TUTTE);
    assert_true(!o.r.stretch_minimised);
    free(o.uv);

    def.minimise_stretch = true;
    def.max_stretch = INFINITY;
    o = flatten(patch, &def);
    assert_int_equal(o.r.verdict, SL_CHART_VALID);
    assert_int_equal(o.r.method, SL_FLATTEN_TUTTE);
    free(o.uv);

    def.max_stretch = 1.5; /* no seam, no way */
    o = flatten(patch, &def);
    assert_int_equal(o.r.verdict, SL_CHART_STRETCHED);
    assert_int_equal(o.r.method, SL_FLATTEN_TUTTE);
    assert_true(o.r.stretch_minimised && o.r.distortion.l2 < raw && o.r.stretch.hopeless);
    free(o.uv);
    sl_patch_free(patch);
}

/* Angles alone shrink the limb by orders of magnitude; the plain chain says so, the full one mends it within a bound
 * that the limb allows. */
static void stretched_charts_are_said_so_or_mended(void **state)
{
    (void)state;
    sl_patch *patch = chart_tube(10, 6, 0.1, 0x57);
    sl_flatten_def def = plain();
    outcome o = flatten(patch, &def);
    assert_int_equal(o.r.verdict, SL_CHART_STRETCHED);
    assert_int_equal(o.r.method, SL_FLATTEN_ABF);
    const double conformal = o.r.distortion.l2;
    assert_true(conformal > 5.0);
    free(o.uv);
    def = sl_flatten_default();
    def.max_stretch = 2.0;
    o = flatten(patch, &def);
    assert_int_equal(o.r.verdict, SL_CHART_VALID);
    assert_true(o.r.stretch_minimised && o.r.stretch.converged && o.r.stretch.iterations + o.r.stretch.levels > 0);
    free(o.uv);
    def.max_stretch = INFINITY; /* no bound: nothing to mend */
    o = flatten(patch, &def);
    assert_int_equal(o.r.verdict, SL_CHART_VALID);
    assert_true(o.r.method == SL_FLATTEN_ABF && o.r.distortion.l2 == conformal && !o.r.stretch_minimised);
    free(o.uv);
    sl_patch_free(patch);
}

/* A little too stretched: refined where it is, no other start. */
static void mild_stretch_is_refined_from_abf(void **state)
{
    (void)state;
    sl_patch *patch = chart_hexagon(6, 0.15, chart_cap, 2.6, 0x31d);
    sl_flatten_def def = plain();
    def.max_stretch = 1e9;
    outcome o = flatten(patch, &def);
    const double conformal = o.r.distortion.l2;
    assert_true(conformal > 1.3 && conformal < 10.0);
    free(o.uv);
    def = sl_flatten_default();
    def.max_stretch = 0.95 * conformal;
    o = flatten(patch, &def);
    assert_int_equal(o.r.verdict, SL_CHART_VALID);
    assert_int_equal(o.r.method, SL_FLATTEN_ABF);
    assert_true(o.r.stretch_minimised && o.r.distortion.l2 <= 1.0 + 0.96 * (def.max_stretch - 1.0) + 1e-9);
    free(o.uv);
    sl_patch_free(patch);
}

/* Lowering the stretch of a cap costs angles: a bound on them turns the same map from valid to sheared, and makes the
 * minimisation go on to its end. */
/* Less stretch for some shear, and never beyond the bound on that. */
static void polishing_lowers_the_stretch_of_valid_charts(void **state)
{
    (void)state;
    for (uint64_t seed = 0; seed < 8; seed++) {
        sl_patch *patch = chart_hexagon(5, 0.2, chart_bumps, 1.6, seed);
        sl_flatten_def def = sl_flatten_default();
        def.max_stretch = 2.0;
        outcome before = flatten(patch, &def);
        def.polish = true;
        outcome after = flatten(patch, &def);
        assert_true(before.r.verdict == SL_CHART_VALID && !before.r.stretch_minimised);
        assert_true(after.r.verdict == SL_CHART_VALID && after.r.stretch_minimised);
        assert_int_equal(after.r.method, SL_FLATTEN_ABF);
        assert_true(after.r.distortion.l2 - 1.0 < 0.9 * (before.r.distortion.l2 - 1.0));
        assert_true(after.r.distortion.angle_mean > before.r.distortion.angle_mean);
        def.max_angle = 0.5 * (after.r.distortion.angle_mean + before.r.distortion.angle_mean);
        outcome kept = flatten(patch, &def);
        assert_true(kept.r.verdict == SL_CHART_VALID && !kept.r.stretch_minimised);
        assert_memory_equal(kept.uv, before.uv, 2 * (size_t)patch->nv * sizeof(double));
        free(before.uv);
        free(after.uv);
        free(kept.uv);
        sl_patch_free(patch);
    }
}

static void a_chart_within_its_stretch_may_still_be_sheared(void **state)
{
    (void)state;
    sl_patch *patch = chart_hexagon(6, 0.15, chart_cap, 2.6, 0x31d);
    sl_flatten_def def = sl_flatten_default();
    def.max_stretch = 1.25;
    outcome o = flatten(patch, &def);
    const double angle = o.r.distortion.angle_mean;
    const int32_t steps = o.r.stretch.iterations;
    assert_int_equal(o.r.verdict, SL_CHART_VALID);
    assert_true(o.r.stretch_minimised && angle > 1.01);
    free(o.uv);
    def.max_angle = 1.0 + 1e-6;
    o = flatten(patch, &def);
    assert_int_equal(o.r.verdict, SL_CHART_SHEARED);
    assert_true(o.r.stretch.iterations > steps && o.r.certificate.embedded);
    free(o.uv);
    def.max_angle = 1.01 * angle;
    o = flatten(patch, &def);
    assert_int_equal(o.r.verdict, SL_CHART_VALID);
    free(o.uv);
    sl_patch_free(patch);
}

static void a_ramp_overlaps_by_abf_and_is_embedded_by_tutte(void **state)
{
    (void)state;
    sl_patch *patch = chart_grid(3, 50, 0.2, chart_ramp, 1.6, 0x4a3);
    sl_flatten_def def = plain();
    outcome o = flatten(patch, &def);
    assert_int_equal(o.r.verdict, SL_CHART_OVERLAPS);
    assert_int_equal(o.r.method, SL_FLATTEN_ABF);
    assert_true(o.r.certificate.flipped == 0 && o.r.certificate.border_crossings > 0 && o.r.distortion.l2 < 1.1);
    free(o.uv);
    def = sl_flatten_default();
    o = flatten(patch, &def);
    assert_int_equal(o.r.verdict, SL_CHART_VALID);
    assert_int_equal(o.r.method, SL_FLATTEN_TUTTE);
    assert_true(o.r.stretch_minimised);
    free(o.uv);
    def.max_stretch = 1.0001; /* out of reach without covering itself: still refined, still an embedding */
    o = flatten(patch, &def);
    assert_int_equal(o.r.verdict, SL_CHART_STRETCHED);
    assert_true(o.r.stretch_minimised && o.r.distortion.l2 < 1.6 && o.r.certificate.embedded);
    free(o.uv);
    sl_patch_free(patch);
}

/* A quad bent along its diagonal: cannot be split further, so no bound on stretch holds for it. */
static void a_single_facet_is_exempt_from_the_bound(void **state)
{
    (void)state;
    sl_patch *patch = chart_grid(3, 3, 0.2, chart_cap, 2.2, 0x0f);
    sl_flatten_def def = sl_flatten_default();
    def.max_stretch = 1.0;
    outcome o = flatten(patch, &def);
    assert_int_equal(o.r.verdict, SL_CHART_STRETCHED);
    free(o.uv);
    for (int32_t t = 0; t < patch->nt; t++) {
        patch->facet[t] = 41;
    }
    o = flatten(patch, &def);
    assert_int_equal(o.r.verdict, SL_CHART_VALID);
    assert_true(o.r.distortion.l2 > 1.01);
    free(o.uv);
    sl_patch_free(patch);
    const double quad[12] = {0, 0, 0, 1.3, 0.1, 0, 1.1, 0.9, 0.4, -0.1, 1.2, 0};
    patch = chart_make(4, quad, 2, (int32_t[]){0, 1, 2, 0, 2, 3});
    patch->facet[1] = patch->facet[0];
    o = flatten(patch, &def);
    assert_int_equal(o.r.verdict, SL_CHART_VALID);
    assert_int_equal(o.r.method, SL_FLATTEN_ABF); /* two triangles unfold: no stretch at all */
    assert_true(test_near(o.r.distortion.l2, 1.0, 1e-9));
    free(o.uv);
    sl_patch_free(patch);
}

static void facets_without_area_become_points(void **state)
{
    (void)state;
    const double collinear[9] = {0.1, 0.2, 0.3, 0.3, 0.6, 0.9, 0.2, 0.4, 0.6}, point[9] = {1, 2, 3, 1, 2, 3, 1, 2, 3};
    const sl_flatten_def def = sl_flatten_default();
    for (int k = 0; k < 2; k++) {
        sl_patch *patch = chart_make(3, k == 0 ? collinear : point, 1, (int32_t[]){0, 1, 2});
        outcome o = flatten(patch, &def);
        assert_int_equal(o.r.verdict, SL_CHART_VALID);
        assert_int_equal(o.r.method, SL_FLATTEN_PLANAR);
        if (k == 1) {
            assert_true(o.uv[0] == 0.0 && o.uv[3] == 0.0 && o.uv[4] == 0.0);
        }
        free(o.uv);
        sl_patch_free(patch);
    }
}

/* Wild charts: whatever comes out, the checks of flatten() hold, and with every fallback on there is no flip. */
static void random_charts_always_end_in_an_embedding(void **state)
{
    (void)state;
    int valid = 0, tutte = 0;
    const int trials = 60 * test_multiplier();
    for (int trial = 0; trial < trials; trial++) {
        sl_patch *patch = trial % 3 == 0 ? disk_random(6 + trial % 50, 0xf1a7 + (uint64_t)trial)
                                         : chart_tube(4 + trial % 5, 1 + trial % 9, 0.3, 0xf1a7 + (uint64_t)trial);
        sl_flatten_def def = sl_flatten_default();
        def.max_stretch = trial % 2 == 0 ? 1.5 : 3.0;
        outcome o = flatten(patch, &def);
        assert_true(o.r.verdict == SL_CHART_VALID || o.r.verdict == SL_CHART_STRETCHED);
        valid += o.r.verdict == SL_CHART_VALID;
        tutte += o.r.method == SL_FLATTEN_TUTTE;
        outcome again = flatten(patch, &def);
        assert_memory_equal(o.uv, again.uv, 2 * (size_t)patch->nv * sizeof *o.uv);
        free(again.uv);
        free(o.uv);
        sl_patch_free(patch);
    }
    assert_true(valid > trials / 5 && valid < trials && tutte > trials / 5);
}

static void flattening_can_be_cancelled(void **state)
{
    (void)state;
    sl_patch *patch = chart_tube(8, 7, 0.1, 0xca);
    const sl_flatten_def def = sl_flatten_default();
    double *uv = malloc(2 * (size_t)patch->nv * sizeof *uv);
    sl_flatten_result r;
    sl_status status = SL_CANCELLED;
    int calls = 0;
    for (; status == SL_CANCELLED && calls < 500; calls++) {
        int left = calls;
        const sl_context context = {.progress = chart_cancel_after, .progress_user = &left};
        status = sl_flatten(patch, &def, &context, uv, &r);
    }
    assert_int_equal(status, SL_OK);
    assert_true(calls > 5);
    free(uv);
    sl_patch_free(patch);
}

static void names_are_known_for_every_value(void **state)
{
    (void)state;
    assert_string_equal(sl_flatten_method_name(SL_FLATTEN_NONE), "none");
    assert_string_equal(sl_flatten_method_name(SL_FLATTEN_PLANAR), "planar");
    assert_string_equal(sl_flatten_method_name((sl_flatten_method)99), "unknown");
    assert_string_equal(sl_flatten_verdict_name(SL_CHART_VALID), "valid");
    assert_string_equal(sl_flatten_verdict_name(SL_CHART_STRETCHED), "stretched");
    assert_string_equal(sl_flatten_verdict_name(SL_CHART_SHEARED), "sheared");
    assert_string_equal(sl_flatten_verdict_name((sl_flatten_verdict)99), "unknown");
}

/* On large charts a coarse mesh says how a conformal map would stretch: a limb goes straight to the minimisation, a
 * tame chart is ABF++'s as ever, and the paper's chain foresees nothing. */
static void a_coarse_mesh_tells_what_angles_would_do(void **state)
{
    (void)state;
    sl_patch *limb = chart_tube(200, 22, 0.005, 0xf0e), *tame = chart_hexagon(37, 0.2, chart_bumps, 1.6, 0xf0e);
    assert_true(limb->nt > 8000 && tame->nt > 8000);
    for (int32_t v = 0; v < limb->nv; v++) { /* about twice as long as wide */
        limb->xyz[3 * v + 2] *= 0.35;
    }
    sl_flatten_def def = sl_flatten_default(), alone = plain();
    def.max_stretch = alone.max_stretch = 2.5;
    outcome o = flatten(limb, &def), abf = flatten(limb, &alone);
    assert_true(o.r.foreseen_l2 > 10.0 && o.r.abf.iterations == 0);
    assert_int_equal(o.r.method, SL_FLATTEN_TUTTE);
    assert_int_equal(o.r.verdict, SL_CHART_VALID);
    assert_true(abf.r.foreseen_l2 == 0.0 && abf.r.abf.converged);
    assert_true(test_near_rel(o.r.foreseen_l2, abf.r.distortion.l2, 0.2));
    free(o.uv);
    free(abf.uv);
    o = flatten(tame, &def);
    assert_int_equal(o.r.method, SL_FLATTEN_ABF);
    assert_true(o.r.foreseen_l2 > 1.0 && test_near_rel(o.r.foreseen_l2, o.r.distortion.l2, 0.1));
    free(o.uv);
    sl_patch_free(limb);
    sl_patch_free(tame);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(tame_charts_are_valid_by_abf_alone),
        cmocka_unit_test(coplanar_charts_are_projected_isometrically),
        cmocka_unit_test(a_folded_plane_is_not_projected),
        cmocka_unit_test(what_is_not_a_disk_has_no_map),
        cmocka_unit_test(spikes_fail_in_abf_and_are_saved_by_tutte),
        cmocka_unit_test(stretched_charts_are_said_so_or_mended),
        cmocka_unit_test(mild_stretch_is_refined_from_abf),
        cmocka_unit_test(polishing_lowers_the_stretch_of_valid_charts),
        cmocka_unit_test(a_chart_within_its_stretch_may_still_be_sheared),
        cmocka_unit_test(a_ramp_overlaps_by_abf_and_is_embedded_by_tutte),
        cmocka_unit_test(a_single_facet_is_exempt_from_the_bound),
        cmocka_unit_test(facets_without_area_become_points),
        cmocka_unit_test(random_charts_always_end_in_an_embedding),
        cmocka_unit_test(flattening_can_be_cancelled),
        cmocka_unit_test(names_are_known_for_every_value),
        cmocka_unit_test(a_coarse_mesh_tells_what_angles_would_do),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
