/* The flip-free minimiser: what it promises at every step, and where it ends. */
#include "param/stretch.h"

#include "param/distortion.h"
#include "param/stretch_charts.h"
#include "param/tutte.h"

static size_t uv_size(const sl_patch *patch)
{
    return 2 * (size_t)patch->nv * sizeof(double);
}

/* Tutte's map, its vertices jittered as far as nothing flips. */
static double *random_start(const sl_patch *patch, double jitter, uint64_t seed)
{
    test_rng rng = test_rng_seed(seed);
    double *uv = malloc(uv_size(patch));
    assert_int_equal(sl_tutte(patch, SL_TUTTE_UNIFORM, NULL, uv), SL_OK);
    chart_jitter_uv(patch, jitter, uv, &rng);
    return uv;
}

static sl_stretch *create(const sl_patch *patch, const double *uv, const sl_stretch_def *def)
{
    sl_stretch *s = NULL;
    assert_int_equal(sl_stretch_create(patch, uv, def, &s), SL_OK);
    return s;
}

static double l2_of(const sl_patch *patch, const double *uv)
{
    sl_distortion d;
    assert_int_equal(sl_distortion_measure_indexed(patch->nt, patch->tri, patch->xyz, uv, &d), SL_OK);
    return d.l2;
}

/* Random triangles in space over random disks: as bad as starts can be. */
static void energy_never_rises_and_nothing_ever_flips(void **state)
{
    (void)state;
    static const double weights[] = {0.0, 0.4, 1.0};
    for (int trial = 0; trial < 36 * test_multiplier(); trial++) {
        sl_patch *patch = trial % 2 == 0 ? disk_random(10 + trial, 0x3e7 + (uint64_t)trial)
                                         : chart_tube(5 + trial % 4, 2 + trial / 4, 0.2, 0x3e7 + (uint64_t)trial);
        double *uv = random_start(patch, 0.3, (uint64_t)trial);
        sl_stretch_def def = sl_stretch_default();
        def.w = weights[trial % 3];
        sl_stretch *s = create(patch, uv, &def);
        const sl_stretch_info *info = sl_stretch_info_of(s);
        double energy = info->energy_before;
        for (int32_t before = -1; before < info->iterations;) {
            assert_true(info->energy_after <= energy);
            assert_int_equal(chart_flips(patch, sl_stretch_uv(s)), 0);
            energy = info->energy_after;
            before = info->iterations;
            assert_int_equal(sl_stretch_step(s, 1, NULL), SL_OK);
        }
        assert_true(info->iterations <= def.max_iterations && info->energy_after < info->energy_before);
        assert_true(test_near_rel(info->l2, l2_of(patch, sl_stretch_uv(s)), 1e-9));
        sl_stretch_free(s);
        free(uv);
        sl_patch_free(patch);
    }
}

static void an_isometric_map_stays_as_it_is(void **state)
{
    (void)state;
    sl_patch *patch = chart_grid(6, 5, 0.3, chart_plane, 0.7, 0x150);
    double *uv = malloc(uv_size(patch)), *start = malloc(uv_size(patch));
    for (int32_t v = 0; v < patch->nv; v++) { /* the plane's own coordinates: see chart_plane */
        const double *x = &patch->xyz[3 * v];
        uv[2 * v] = 0.36 * (x[0] - 0.7) + 0.48 * x[1] + 0.8 * x[2];
        uv[2 * v + 1] = -0.8 * (x[0] - 0.7) + 0.6 * x[1];
    }
    memcpy(start, uv, uv_size(patch));
    assert_true(test_near(l2_of(patch, uv), 1.0, 1e-13));
    const sl_stretch_def def = sl_stretch_default();
    sl_stretch_info info;
    assert_int_equal(sl_stretch_minimise(patch, &def, NULL, uv, &info), SL_OK);
    assert_true(info.converged && !info.hopeless);
    assert_true(test_near(info.energy_before, 4.0, 1e-12) && test_near(info.energy_after, 4.0, 1e-12));
    assert_true(test_near(chart_max_diff(uv, start, 2 * patch->nv), 0.0, 1e-9));
    free(uv);
    free(start);
    sl_patch_free(patch);
}

/* A developable chart has a minimum that is known: an isometry, L2 1, from wherever one starts. */
static void developable_charts_are_unrolled_from_random_starts(void **state)
{
    (void)state;
    for (uint64_t seed = 0; seed < 10; seed++) {
        sl_patch *patch = chart_grid(8, 6, 0.3, chart_plane, 0.2, 0xde7 + seed);
        double *uv = random_start(patch, 0.2, seed);
        sl_stretch_def def = sl_stretch_default();
        def.relative_decrease = 1e-12;
        sl_stretch_info info;
        assert_int_equal(sl_stretch_minimise(patch, &def, NULL, uv, &info), SL_OK);
        assert_true(info.converged && test_near(info.energy_after, 4.0, 1e-9) && test_near(info.l2, 1.0, 1e-9));
        assert_true(info.iterations <= 30);
        sl_distortion d;
        assert_int_equal(sl_distortion_measure_indexed(patch->nt, patch->tri, patch->xyz, uv, &d), SL_OK);
        assert_true(test_near(d.angle_max, 1.0, 1e-4) && test_near(d.area_max, 1.0, 1e-4));
        free(uv);
        sl_patch_free(patch);
    }
}

/* Near a minimum no random perturbation lowers the energy beyond what convergence leaves. */
static void the_end_is_a_minimum_whatever_the_start(void **state)
{
    (void)state;
    sl_patch *patch = chart_hexagon(5, 0.2, chart_bumps, 1.5, 0x313);
    sl_stretch_def def = sl_stretch_default();
    def.relative_decrease = 1e-13;
    def.max_iterations = 100;
    double energy = 0.0;
    for (uint64_t seed = 0; seed < 5; seed++) {
        double *uv = random_start(patch, 0.1 * (double)seed, seed), *near = malloc(uv_size(patch));
        sl_stretch_info info, other;
        assert_int_equal(sl_stretch_minimise(patch, &def, NULL, uv, &info), SL_OK);
        energy = seed == 0 ? info.energy_after : energy;
        assert_true(info.converged && test_near_rel(info.energy_after, energy, 1e-8));
        test_rng rng = test_rng_seed(seed);
        sl_stretch_def look = def;
        look.max_iterations = 0;
        for (int trial = 0; trial < 20; trial++) {
            for (int32_t i = 0; i < 2 * patch->nv; i++) {
                near[i] = uv[i] + test_uniform(&rng, -1e-3, 1e-3);
            }
            assert_int_equal(sl_stretch_minimise(patch, &look, NULL, near, &other), SL_OK);
            assert_int_equal(other.iterations, 0);
            assert_true(other.energy_before > info.energy_after);
        }
        free(uv);
        free(near);
    }
    sl_patch_free(patch);
}

static void energy_weight_one_gives_the_least_l2(void **state)
{
    (void)state;
    sl_patch *patch = chart_hexagon(5, 0.2, chart_cap, 1.6, 0x12);
    double l2[3], angle[3];
    for (int k = 0; k < 3; k++) {
        double *uv = random_start(patch, 0.05, 7);
        sl_stretch_def def = sl_stretch_default();
        def.w = 0.5 * k;
        def.max_iterations = 200;
        def.relative_decrease = 1e-9;
        assert_int_equal(sl_stretch_minimise(patch, &def, NULL, uv, NULL), SL_OK);
        sl_distortion d;
        assert_int_equal(sl_distortion_measure_indexed(patch->nt, patch->tri, patch->xyz, uv, &d), SL_OK);
        l2[k] = d.l2;
        angle[k] = d.angle_mean;
        free(uv);
    }
    assert_true(l2[2] < l2[1] && l2[1] < l2[0] && angle[0] < angle[1]);
    sl_patch_free(patch);
}

/* Scaling, moving and turning either side changes nothing but the last digits. */
static void result_does_not_depend_on_units_or_position(void **state)
{
    (void)state;
    sl_patch *patch = chart_hexagon(4, 0.25, chart_bumps, 1.4, 0x5c);
    double *uv = random_start(patch, 0.1, 3), *other = malloc(uv_size(patch));
    for (int32_t i = 0; i < patch->nv; i++) {
        other[2 * i] = 1e-3 * (0.6 * uv[2 * i] - 0.8 * uv[2 * i + 1]) + 0.7;
        other[2 * i + 1] = 1e-3 * (0.8 * uv[2 * i] + 0.6 * uv[2 * i + 1]) - 0.1;
    }
    const sl_stretch_def def = sl_stretch_default();
    sl_stretch_info a, b;
    assert_int_equal(sl_stretch_minimise(patch, &def, NULL, uv, &a), SL_OK);
    chart_move(patch, 250.0, (double[]){10.0, 20.0, -30.0});
    assert_int_equal(sl_stretch_minimise(patch, &def, NULL, other, &b), SL_OK);
    assert_true(a.converged && b.converged);
    assert_true(test_near_rel(a.energy_after, b.energy_after, 1e-3) && test_near_rel(a.l2, b.l2, 1e-3));
    assert_true(test_near_rel(chart_uv_area(patch, other), chart_uv_area(patch, uv) * 250.0 * 250.0, 1e-2));
    free(uv);
    free(other);
    sl_patch_free(patch);
}

static void it_stops_at_the_target_or_when_there_is_no_hope(void **state)
{
    (void)state;
    sl_patch *patch = chart_tube(8, 9, 0.1, 0x70);
    double *start = random_start(patch, 0.0, 1), *uv = malloc(uv_size(patch));
    sl_stretch_def def = sl_stretch_default();
    sl_stretch_info full, info;
    memcpy(uv, start, uv_size(patch));
    assert_int_equal(sl_stretch_minimise(patch, &def, NULL, uv, &full), SL_OK);
    assert_true(full.converged && full.l2 > 1.2);

    def.target_l2 = 1.3 * full.l2;
    memcpy(uv, start, uv_size(patch));
    assert_int_equal(sl_stretch_minimise(patch, &def, NULL, uv, &info), SL_OK);
    assert_true(info.converged && info.l2 <= def.target_l2 && info.l2 > full.l2 && info.iterations < full.iterations);
    const int32_t reached = info.iterations;
    assert_int_equal(sl_stretch_minimise(patch, &def, NULL, uv, &info), SL_OK); /* there already */
    assert_true(info.converged && info.iterations == 0);

    def.target_l2 = 0.9 * full.l2;
    def.hopeless_gain = 8.0;
    memcpy(uv, start, uv_size(patch));
    assert_int_equal(sl_stretch_minimise(patch, &def, NULL, uv, &info), SL_OK);
    assert_true(info.hopeless && !info.converged && info.iterations < full.iterations && info.iterations > reached);

    def.hopeless_gain = 0.0;
    def.hopeless_l2 = 1.05 * full.l2;
    def.hopeless_after = 2;
    memcpy(uv, start, uv_size(patch));
    assert_int_equal(sl_stretch_minimise(patch, &def, NULL, uv, &info), SL_OK);
    assert_true(info.hopeless && !info.converged && info.iterations == 2);

    def = sl_stretch_default(); /* from the end on a weight that buys angles for stretch */
    memcpy(uv, start, uv_size(patch));
    assert_int_equal(sl_stretch_minimise(patch, &def, NULL, uv, NULL), SL_OK);
    def.w = -4.0;
    def.most_l2 = 1.02 * full.l2;
    assert_int_equal(sl_stretch_minimise(patch, &def, NULL, uv, &info), SL_OK);
    assert_true(info.hopeless && !info.converged && info.l2 > def.most_l2 && info.iterations < 5);

    def = sl_stretch_default();
    def.max_iterations = 3;
    memcpy(uv, start, uv_size(patch));
    assert_int_equal(sl_stretch_minimise(patch, &def, NULL, uv, &info), SL_OK);
    assert_true(!info.hopeless && !info.converged && info.iterations == 3);
    free(start);
    free(uv);
    sl_patch_free(patch);
}

/* Three steps at a time or one by one: the same bytes. */
static void stepping_gives_the_bytes_of_solving(void **state)
{
    (void)state;
    sl_patch *patch = chart_tube(8, 6, 0.15, 0x57e);
    double *uv = random_start(patch, 0.1, 9);
    const sl_stretch_def def = sl_stretch_default();
    sl_stretch *s = create(patch, uv, &def);
    sl_stretch_info info;
    for (int i = 0; i < 25; i++) {
        assert_int_equal(sl_stretch_step(s, 3, NULL), SL_OK);
    }
    assert_int_equal(sl_stretch_minimise(patch, &def, NULL, uv, &info), SL_OK);
    assert_memory_equal(uv, sl_stretch_uv(s), uv_size(patch));
    assert_int_equal(info.iterations, sl_stretch_info_of(s)->iterations);
    sl_stretch_free(s);
    free(uv);
    sl_patch_free(patch);
}

/* One and a half turns of a ramp unroll isometrically onto themselves; with a simple border they may not. */
static void a_simple_border_keeps_the_ramp_from_covering_itself(void **state)
{
    (void)state;
    sl_patch *patch = chart_grid(4, 60, 0.2, chart_ramp, 1.5, 0x4a);
    double *uv = random_start(patch, 0.0, 1), *simple = malloc(uv_size(patch));
    memcpy(simple, uv, uv_size(patch));
    sl_stretch_def def = sl_stretch_default();
    sl_stretch_info free_info, info;
    assert_int_equal(sl_stretch_minimise(patch, &def, NULL, uv, &free_info), SL_OK);
    assert_true(free_info.l2 < 1.01 && chart_certify(patch, uv).border_crossings > 0);
    def.simple_border = true;
    sl_stretch *s = create(patch, simple, &def);
    for (int i = 0; i < def.max_iterations; i++) {
        assert_int_equal(sl_stretch_step(s, 1, NULL), SL_OK);
        assert_true(chart_certify(patch, sl_stretch_uv(s)).embedded);
    }
    info = *sl_stretch_info_of(s);
    assert_true(info.iterations > 0 && info.energy_after > free_info.energy_after);
    sl_stretch_free(s);
    s = (sl_stretch *)1;
    assert_int_equal(sl_stretch_create(patch, uv, &def, &s), SL_BAD_INPUT); /* this start crosses itself */
    assert_null(s);
    free(uv);
    free(simple);
    sl_patch_free(patch);
}

static void starts_that_flip_or_vanish_are_refused(void **state)
{
    (void)state;
    sl_patch *patch = chart_hexagon(2, 0.2, chart_bumps, 0.6, 0xbad);
    double *uv = random_start(patch, 0.0, 1);
    const sl_stretch_def def = sl_stretch_default();
    sl_stretch *s = NULL;
    for (int what = 0; what < 4; what++) {
        double *bad = malloc(uv_size(patch));
        memcpy(bad, uv, uv_size(patch));
        const int32_t *v = &patch->tri[9];
        if (what == 0) { /* one corner across the opposite edge */
            for (int k = 0; k < 2; k++) {
                bad[2 * v[0] + k] = 1.1 * (uv[2 * v[1] + k] + uv[2 * v[2] + k]) - uv[2 * v[0] + k] * 1.2;
            }
        } else if (what == 1) { /* two corners in one */
            memcpy(&bad[2 * v[0]], &bad[2 * v[1]], 2 * sizeof *bad);
        } else {
            bad[2 * v[2] + 1] = what == 2 ? NAN : INFINITY;
        }
        assert_int_equal(sl_stretch_create(patch, bad, &def, &s), SL_BAD_INPUT);
        assert_null(s);
        free(bad);
    }
    free(uv);
    sl_patch_free(patch);
}

static void cancelling_leaves_the_input_alone(void **state)
{
    (void)state;
    sl_patch *patch = chart_tube(7, 6, 0.1, 0xca);
    double *uv = random_start(patch, 0.1, 1), *copy = malloc(uv_size(patch));
    memcpy(copy, uv, uv_size(patch));
    const sl_stretch_def def = sl_stretch_default();
    for (int calls = 0; calls < 4; calls++) {
        int left = calls;
        const sl_context context = {.progress = chart_cancel_after, .progress_user = &left};
        assert_int_equal(sl_stretch_minimise(patch, &def, &context, uv, NULL), SL_CANCELLED);
        assert_memory_equal(uv, copy, uv_size(patch));
    }
    sl_stretch_free(NULL);
    free(uv);
    free(copy);
    sl_patch_free(patch);
}

/* A vertex on the middle of an edge: its triangle has no area, and its neighbours are mapped as if it were not there.
 */
static void degenerate_triangles_do_not_spoil_a_chart(void **state)
{
    (void)state;
    const double xyz[24] = {0, 0, 0, 2, 0, 0.1, 2.2, 1, 0, 1, 2, 0.3, -0.3, 1, 0, 1.1, 1, 0.05, 0, 0, 0, 0, 0, 0};
    const int32_t tri[21] = {0, 6, 5, 6, 1, 5, 1, 2, 5, 2, 3, 5, 3, 4, 5, 4, 0, 5, 0, 1, 6};
    double points[21];
    memcpy(points, xyz, sizeof points);
    memcpy(&points[18], (double[]){1.0, 0.0, 0.05}, 3 * sizeof *points);
    sl_patch *patch = chart_make(7, points, 7, tri);
    double *uv = random_start(patch, 0.0, 1);
    const sl_stretch_def def = sl_stretch_default();
    sl_stretch_info info;
    assert_int_equal(sl_stretch_minimise(patch, &def, NULL, uv, &info), SL_OK);
    assert_true(info.converged && info.l2 < 1.05);
    assert_int_equal(chart_flips(patch, uv), 0);
    assert_true(test_near_rel(info.l2, l2_of(patch, uv), 1e-9));
    free(uv);
    sl_patch_free(patch);
}

/* Energies of 1e16 come down within the default number of steps. */
static void long_limbs_are_unrolled_from_tutte(void **state)
{
    (void)state;
    static const int32_t rings[] = {18, 34};
    static const double before[] = {1e7, 1e16}, after[] = {25.0, 40.0};
    for (int k = 0; k < 2; k++) {
        sl_patch *patch = chart_tube(8, rings[k], 0.1, 0x11b);
        double *uv = random_start(patch, 0.0, 1);
        const sl_stretch_def def = sl_stretch_default();
        sl_stretch_info info;
        assert_int_equal(sl_stretch_minimise(patch, &def, NULL, uv, &info), SL_OK);
        assert_true(info.energy_before > before[k] && info.energy_after < after[k] && info.converged);
        assert_int_equal(chart_flips(patch, uv), 0);
        free(uv);
        sl_patch_free(patch);
    }
}

/* Several slender limbs at once: plain Newton steps are stopped by one limb or another, and leave energies of 1e5 and
 * more in half of such charts; of a hundred that begin with Tutte's embedding nine still end far off, of these 24 none.
 * From coarse meshes none does: test_stretch_levels.c. */
static void charts_with_many_limbs_come_near_their_minimum(void **state)
{
    (void)state;
    int far = 0;
    for (uint64_t seed = 0; seed < 24; seed++) {
        sl_patch *patch = chart_limbs(3, 7, 9, seed);
        double *uv = random_start(patch, 0.0, seed);
        const sl_stretch_def def = sl_stretch_default();
        sl_stretch_info info;
        assert_int_equal(sl_stretch_minimise(patch, &def, NULL, uv, &info), SL_OK);
        assert_true(info.energy_before > 1e5);
        far += info.energy_after > 60.0;
        free(uv);
        sl_patch_free(patch);
    }
    assert_true(far <= 1);
}

/* A needle's least energy is 170: still recognised as the end, though every map of it counts as far. */
static void a_minimum_of_high_energy_is_recognised(void **state)
{
    (void)state;
    sl_patch *patch = chart_tube(6, 12, 0.25, 0x5b);
    for (int32_t v = 0; v < patch->nv; v++) {
        patch->xyz[3 * v] *= 1.0 / 16.0;
        patch->xyz[3 * v + 1] *= 1.0 / 16.0;
    }
    double *uv = random_start(patch, 0.0, 1);
    const sl_stretch_def def = sl_stretch_default();
    sl_stretch_info info;
    assert_int_equal(sl_stretch_minimise(patch, &def, NULL, uv, &info), SL_OK);
    assert_true(info.converged && info.iterations < def.max_iterations);
    assert_true(info.energy_after > 150.0 && info.energy_after < 180.0);
    free(uv);
    sl_patch_free(patch);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(energy_never_rises_and_nothing_ever_flips),
        cmocka_unit_test(an_isometric_map_stays_as_it_is),
        cmocka_unit_test(developable_charts_are_unrolled_from_random_starts),
        cmocka_unit_test(the_end_is_a_minimum_whatever_the_start),
        cmocka_unit_test(energy_weight_one_gives_the_least_l2),
        cmocka_unit_test(result_does_not_depend_on_units_or_position),
        cmocka_unit_test(it_stops_at_the_target_or_when_there_is_no_hope),
        cmocka_unit_test(stepping_gives_the_bytes_of_solving),
        cmocka_unit_test(a_simple_border_keeps_the_ramp_from_covering_itself),
        cmocka_unit_test(starts_that_flip_or_vanish_are_refused),
        cmocka_unit_test(cancelling_leaves_the_input_alone),
        cmocka_unit_test(degenerate_triangles_do_not_spoil_a_chart),
        cmocka_unit_test(charts_with_many_limbs_come_near_their_minimum),
        cmocka_unit_test(a_minimum_of_high_energy_is_recognised),
        cmocka_unit_test(long_limbs_are_unrolled_from_tutte),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
