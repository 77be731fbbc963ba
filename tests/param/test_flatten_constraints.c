/* Constraints and pins through the chain, and what the stretch minimiser keeps of them. */
#include "param/flatten.h"

#include "param/constraint_charts.h"
#include "param/flatten_internal.h"
#include "param/stretch_charts.h"
#include "param/stretch_internal.h"

/* Flattens with the constraints asked for and holds the map against them. */
static sl_flatten_result check_kept(const sl_patch *patch, int32_t count, const sl_constraint *list, bool polish,
                                    double *uv)
{
    sl_sector_table table = compile(patch, count, list);
    sl_constraint_measure measure[8];
    sl_flatten_result result;
    sl_flatten_def def = sl_flatten_default();
    def.abf.max_iterations = 200;
    def.max_stretch = INFINITY;
    def.polish = polish;
    def.stretch.relative_decrease = 1e-10;
    def.wishes.constraint = list;
    def.wishes.constraint_count = count;
    assert_int_equal(sl_flatten(patch, &def, NULL, uv, &result), SL_OK);
    assert_int_equal(result.verdict, SL_CHART_VALID);
    assert_int_equal(result.method, SL_FLATTEN_ABF);
    assert_true(result.constrained && result.stretch_minimised == polish);
    sl_constraints_measure(patch, count, list, &table, uv, measure);
    for (int32_t i = 0; i < count; i++) {
        if (!(measure[i].angle <= 1e-8 && measure[i].line <= 1e-9)) {
            fail_msg("constraint %d: angle %g, line %g", i, measure[i].angle, measure[i].line);
        }
    }
    sl_sectors_clear(&table);
    return result;
}

/* A rectangle with a line across it, right angles where they meet, and an angle at a border vertex that no line
 * touches: polished, it stretches less and keeps them all. */
static void polishing_keeps_lines_and_angles(void **state)
{
    (void)state;
    for (int trial = 0; trial < 4; trial++) {
        const double height = 0.9;
        sl_patch *patch = chart_hexagon(RINGS, 0.0, chart_bumps, height, 0xf1 + (uint64_t)trial);
        int32_t corner[4], row[9], free_corner;
        for (int k = 0; k < 4; k++) {
            corner[k] = lattice(patch, chart_bumps, height, corner_at[k][0], corner_at[k][1]);
        }
        free_corner = lattice(patch, chart_bumps, height, corner_at[4][0], corner_at[4][1]);
        const sl_constraint line = lattice_path(patch, height, (int32_t[]){-4, 1}, (int32_t[]){1, 0}, 8, row);
        const sl_constraint polygon[] = {{SL_CONSTRAINT_POLYGON, 4, corner, 0.0}, line};
        const sl_constraint angles[] = {
            {SL_CONSTRAINT_ANGLE, 1, &free_corner, 1.9}, {SL_CONSTRAINT_RIGHT, 1, &corner[1], 0.0}, line};
        const sl_constraint *list = trial % 2 == 0 ? polygon : angles;
        const int32_t count = trial % 2 == 0 ? 2 : 3;
        double *plain = malloc(2 * (size_t)patch->nv * sizeof *plain), *uv = malloc(2 * (size_t)patch->nv * sizeof *uv);
        const sl_flatten_result before = check_kept(patch, count, list, false, plain);
        const sl_flatten_result after = check_kept(patch, count, list, true, uv);
        assert_true(after.distortion.l2 < before.distortion.l2 - 1e-4 && after.stretch.iterations > 0);
        assert_int_equal(chart_flips(patch, uv), 0);
        free(plain);
        free(uv);
        sl_patch_free(patch);
    }
}

/* A limb too long for angles: unrolled without its constraint, and said so. */
static void a_constraint_that_is_lost_is_reported(void **state)
{
    (void)state;
    sl_patch *patch = chart_tube(10, 6, 0.1, 0x57);
    double *uv = malloc(2 * (size_t)patch->nv * sizeof *uv);
    int32_t v = 0;
    while (patch->border[v] == 0) {
        v++;
    }
    const sl_constraint angle = {SL_CONSTRAINT_ANGLE, 1, &v, 2.0};
    sl_flatten_result result;
    sl_flatten_def def = sl_flatten_default();
    def.max_stretch = 2.0;
    def.wishes.constraint = &angle;
    def.wishes.constraint_count = 1;
    assert_int_equal(sl_flatten(patch, &def, NULL, uv, &result), SL_OK);
    assert_int_equal(result.verdict, SL_CHART_VALID);
    assert_true(!result.constrained && result.method == SL_FLATTEN_TUTTE);
    free(uv);
    sl_patch_free(patch);
}

static void pins_come_last_and_exactly(void **state)
{
    (void)state;
    sl_patch *patch = chart_hexagon(RINGS, 0.1, chart_bumps, 0.8, 0x91);
    double *uv = malloc(2 * (size_t)patch->nv * sizeof *uv), *plain = malloc(2 * (size_t)patch->nv * sizeof *uv);
    sl_flatten_def def = sl_flatten_default();
    sl_flatten_result result, without;
    assert_int_equal(sl_flatten(patch, &def, NULL, plain, &without), SL_OK);
    assert_true(without.constrained && without.pin_distance == 0.0);
    sl_pin pin[6];
    test_rng rng = test_rng_seed(0x91);
    for (int32_t i = 0; i < 6; i++) { /* turned by a right angle, moved, and not quite the same shape */
        const int32_t v = 15 * i + 3;
        pin[i] = (sl_pin){v,
                          {4.0 - plain[2 * v + 1] + test_uniform(&rng, -0.1, 0.1),
                           1.0 + plain[2 * v] + test_uniform(&rng, -0.1, 0.1)}};
    }
    def.wishes.pin = pin;
    for (int32_t count = 1; count <= 6; count++) {
        def.wishes.pin_count = count;
        assert_int_equal(sl_flatten(patch, &def, NULL, uv, &result), SL_OK);
        assert_int_equal(result.verdict, SL_CHART_VALID);
        assert_true(result.pin_distance <= (count <= 2 ? 1e-14 : 0.0));
        assert_true(result.stretch_minimised == (count > 2) && chart_certify(patch, uv).embedded);
        for (int32_t i = 0; i < count; i++) {
            assert_true(test_near(chart_max_diff(&uv[2 * pin[i].vertex], pin[i].uv, 2), 0.0, 1e-14));
        }
        assert_true(count > 2 || test_near_rel(result.distortion.l2, without.distortion.l2, 1e-9));
    }
    pin[5].vertex = patch->nv;
    assert_int_equal(sl_flatten(patch, &def, NULL, uv, &result), SL_BAD_INPUT);
    const int32_t closed[4] = {0, 1, 2, 0};
    const sl_constraint bad = {SL_CONSTRAINT_STRAIGHT, 4, closed, 0.0};
    def.wishes = (sl_flatten_wishes){.constraint_count = 1, .constraint = &bad};
    const sl_status status = sl_flatten(patch, &def, NULL, uv, &result);
    assert_true(status == SL_BAD_INPUT || status == SL_INFEASIBLE);
    free(uv);
    free(plain);
    sl_patch_free(patch);
}

/* Relaxing with nothing asked for is minimising; what cannot be kept is refused and nothing changes. */
static void relaxing_refuses_what_it_cannot_keep(void **state)
{
    (void)state;
    sl_patch *patch = chart_hexagon(RINGS, 0.0, chart_bumps, 0.8, 0x4e1);
    double *uv = malloc(2 * (size_t)patch->nv * sizeof *uv), *other = malloc(2 * (size_t)patch->nv * sizeof *uv);
    const sl_stretch_def def = sl_stretch_default();
    sl_flatten_wishes wishes = {0};
    sl_stretch_info info;
    int32_t row[8];
    assert_int_equal(sl_abf_flatten(patch,
                                    &(sl_abf_def){.max_iterations = 40,
                                                  .gradient_tolerance = 1e-6,
                                                  .accept_gradient = 1e-5,
                                                  .constraint_tolerance = 1e-11,
                                                  .accept_constraint = 1e-9,
                                                  .min_angle = 1e-3},
                                    NULL, uv, NULL),
                     SL_OK);
    memcpy(other, uv, 2 * (size_t)patch->nv * sizeof *uv);
    const sl_constraint line = lattice_path(patch, 0.8, (int32_t[]){-4, 1}, (int32_t[]){1, 0}, 8, row);
    wishes = (sl_flatten_wishes){.constraint_count = 1, .constraint = &line};
    assert_int_equal(sl_flatten_relax(patch, &def, &wishes, NULL, uv, &info), SL_BAD_INPUT); /* not straight */
    assert_memory_equal(uv, other, 2 * (size_t)patch->nv * sizeof *uv);
    wishes = (sl_flatten_wishes){0};
    assert_int_equal(sl_flatten_relax(patch, &def, &wishes, NULL, uv, &info), SL_OK);
    assert_int_equal(sl_stretch_minimise(patch, &def, NULL, other, NULL), SL_OK);
    assert_memory_equal(uv, other, 2 * (size_t)patch->nv * sizeof *uv);
    free(uv);
    free(other);
    sl_patch_free(patch);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(polishing_keeps_lines_and_angles),
        cmocka_unit_test(a_constraint_that_is_lost_is_reported),
        cmocka_unit_test(pins_come_last_and_exactly),
        cmocka_unit_test(relaxing_refuses_what_it_cannot_keep),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
