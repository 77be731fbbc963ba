/* The minimiser with pins: vertices that are pulled to their places. */
#include "param/stretch_sheets.h"
#include "param/tutte.h"

/* Places for pins: where the vertices are, moved by up to `size`. */
static void make_pins(const sheet *s, double size, uint64_t seed, int32_t count, sl_pin *pin)
{
    test_rng rng = test_rng_seed(seed);
    for (int32_t i = 0; i < count; i++) { /* 17 and 63 have no common divisor */
        const int32_t v = (int32_t)((17 * (i + (int32_t)seed) + 5) % VERTICES);
        pin[i] = (sl_pin){
            .vertex = v,
            .uv = {s->uv[2 * v] + test_uniform(&rng, -size, size), s->uv[2 * v + 1] + test_uniform(&rng, -size, size)}};
    }
}

/* Any number of pins reach their places exactly, and the rest is at its minimum then. */
static void pins_are_brought_to_their_places(void **state)
{
    (void)state;
    for (uint64_t seed = 0; seed < 8; seed++) {
        sheet s = make_sheet(0x919 + seed);
        sl_pin pin[5];
        uint8_t fixed[VERTICES] = {0};
        sl_stretch_info info;
        sl_stretch_def def = to_the_end();
        make_pins(&s, 0.3, seed, 5, pin);
        def.pin = pin;
        def.pin_count = 1 + (int32_t)(seed % 5);
        assert_int_equal(sl_stretch_minimise(s.patch, &def, NULL, s.uv, &info), SL_OK);
        assert_true(info.pin_distance == 0.0 && info.converged);
        assert_int_equal(chart_flips(s.patch, s.uv), 0);
        for (int32_t i = 0; i < def.pin_count; i++) {
            assert_memory_equal(&s.uv[2 * pin[i].vertex], pin[i].uv, sizeof pin->uv);
            fixed[pin[i].vertex] = 1;
        }
        assert_true(test_near_rel(info.energy_after, energy_of(s.patch, s.uv), 1e-12));
        const double energy = info.energy_after;
        def.pin_count = 0;
        def.fixed = fixed;
        assert_int_equal(sl_stretch_minimise(s.patch, &def, NULL, s.uv, &info), SL_OK);
        assert_true(test_near_rel(info.energy_after, energy, 1e-5));
        sl_patch_free(s.patch);
    }
}

/* A flat sheet pinned as a turned copy of itself becomes that copy. */
static void pins_of_an_isometry_give_the_isometry(void **state)
{
    (void)state;
    sl_patch *patch = chart_grid(8, 7, 0.25, chart_plane, 0.3, 0x150);
    double *uv = malloc(2 * (size_t)patch->nv * sizeof *uv);
    sl_pin pin[4];
    sl_stretch_info info;
    sl_stretch_def def = to_the_end();
    assert_int_equal(sl_tutte(patch, SL_TUTTE_UNIFORM, NULL, uv), SL_OK);
    for (int32_t i = 0; i < 4; i++) {
        const int32_t v = (i * patch->nv) / 4 + 3;
        const double *x = &patch->xyz[3 * v]; /* the plane's own coordinates: see chart_plane */
        const double p = 0.36 * (x[0] - 0.3) + 0.48 * x[1] + 0.8 * x[2], q = -0.8 * (x[0] - 0.3) + 0.6 * x[1];
        pin[i] = (sl_pin){.vertex = v, .uv = {1.7 + 0.28 * p - 0.96 * q, -0.4 + 0.96 * p + 0.28 * q}};
    }
    def.pin = pin;
    def.pin_count = 4;
    assert_int_equal(sl_stretch_minimise(patch, &def, NULL, uv, &info), SL_OK);
    assert_true(info.pin_distance == 0.0 && test_near(info.energy_after, 4.0, 1e-8));
    free(uv);
    sl_patch_free(patch);
}

static void pins_out_of_reach_are_said_and_bad_ones_refused(void **state)
{
    (void)state;
    sheet s = make_sheet(0x0b);
    sheet_lines lines;
    uint8_t fixed[VERTICES] = {0};
    sl_stretch_info info;
    sl_stretch *solver = NULL;
    make_lines(&s, &lines);
    /* the corners of one triangle, two of them exchanged */
    const int32_t *v = &s.patch->tri[30];
    sl_pin pin[3] = {{v[0], {s.uv[2 * v[0]], s.uv[2 * v[0] + 1]}},
                     {v[1], {s.uv[2 * v[2]], s.uv[2 * v[2] + 1]}},
                     {v[2], {s.uv[2 * v[1]], s.uv[2 * v[1] + 1]}}};
    sl_stretch_def def = sl_stretch_default();
    def.pin = pin;
    def.pin_count = 3;
    double *uv = malloc(sizeof s.uv);
    memcpy(uv, s.uv, sizeof s.uv);
    assert_int_equal(sl_stretch_minimise(s.patch, &def, NULL, uv, &info), SL_OK);
    assert_true(info.pin_distance > 1e-3 && chart_flips(s.patch, uv) == 0);
    free(uv);
    for (int what = 0; what < 6; what++) {
        sl_pin bad[2] = {pin[0], pin[1]};
        bad[1].vertex = what == 0 ? -1 : what == 1 ? VERTICES : what == 2 ? pin[0].vertex : s.at[3][2];
        bad[1].uv[1] = what == 3 ? NAN : 0.1;
        fixed[s.at[3][2]] = what == 4;
        def = sl_stretch_default();
        def.pin = bad;
        def.pin_count = 2;
        def.fixed = what == 4 ? fixed : NULL;
        def.line = lines.line;
        def.line_count = what == 5 ? 2 : 0;
        assert_int_equal(sl_stretch_create(s.patch, s.uv, &def, &solver), SL_BAD_INPUT);
        assert_null(solver);
    }
    sl_patch_free(s.patch);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(pins_are_brought_to_their_places),
        cmocka_unit_test(pins_of_an_isometry_give_the_isometry),
        cmocka_unit_test(pins_out_of_reach_are_said_and_bad_ones_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
