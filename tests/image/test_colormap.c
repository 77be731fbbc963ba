#include "support/test_support.h"

#include "base/status.h"
#include "image/color.h"
#include "image/colormap.h"

#include <math.h>

static double lightness_of(const float linear[3])
{
    const double rgb[3] = {(double)linear[0], (double)linear[1], (double)linear[2]};
    double lab[3];
    sl_oklab_from_linear(rgb, lab);
    return lab[0];
}

enum { STEPS = 201 };

/* Perceptually even: lightness is monotone and no step is over twice the mean one. */
static void one_way_maps_change_lightness_evenly(void **state)
{
    (void)state;
    static const struct {
        sl_colormap map;
        double sign;
    } cases[] = {{SL_COLORMAP_SEQUENTIAL, 1.0}, {SL_COLORMAP_HEAT, -1.0}};
    for (size_t i = 0; i < SL_COUNTOF(cases); i++) {
        float table[3 * STEPS];
        sl_colormap_table(cases[i].map, STEPS, table);
        const double whole = cases[i].sign * (lightness_of(table + 3 * (STEPS - 1)) - lightness_of(table));
        assert_true(whole > 0.5);
        for (int k = 1; k < STEPS; k++) {
            const double step = cases[i].sign * (lightness_of(table + 3 * k) - lightness_of(table + 3 * (k - 1)));
            assert_true(step > 0.0 && step < 2.0 * whole / (STEPS - 1));
        }
    }
}

static void the_diverging_map_is_blue_white_red_and_even_on_both_sides(void **state)
{
    (void)state;
    float table[3 * STEPS];
    sl_colormap_table(SL_COLORMAP_DIVERGING, STEPS, table);
    const int middle = STEPS / 2;
    for (int k = 0; k < middle; k++) {
        const double left = lightness_of(table + 3 * k), right = lightness_of(table + 3 * (STEPS - 1 - k));
        assert_true(test_near(left, right, 5e-3));
        assert_true(left < lightness_of(table + 3 * (k + 1)));
    }
    assert_true(lightness_of(table + 3 * middle) > 0.95);
    assert_true(table[2] > 2.0f * table[0]);
    assert_true(table[3 * (STEPS - 1)] > 2.0f * table[3 * (STEPS - 1) + 2]);
}

static void samples_are_the_table_and_clamp(void **state)
{
    (void)state;
    for (int map = SL_COLORMAP_SEQUENTIAL; map <= SL_COLORMAP_HEAT; map++) {
        float table[3 * STEPS];
        sl_colormap_table((sl_colormap)map, STEPS, table);
        for (int k = 0; k < STEPS; k++) {
            uint8_t want[3], got[3];
            sl_rgb_from_linear(table + 3 * k, want);
            sl_colormap_sample((sl_colormap)map, (double)k / (STEPS - 1), got);
            assert_memory_equal(got, want, 3);
        }
        uint8_t below[3], first[3], above[3], last[3];
        sl_colormap_sample((sl_colormap)map, -1e300, below);
        sl_colormap_sample((sl_colormap)map, 0.0, first);
        sl_colormap_sample((sl_colormap)map, (double)INFINITY, above);
        sl_colormap_sample((sl_colormap)map, 1.0, last);
        assert_memory_equal(below, first, 3);
        assert_memory_equal(above, last, 3);
    }
}

static void not_a_number_is_a_grey(void **state)
{
    (void)state;
    uint8_t rgb[3];
    sl_colormap_sample(SL_COLORMAP_DIVERGING, (double)NAN, rgb);
    assert_true(rgb[0] == rgb[1] && rgb[1] == rgb[2] && rgb[0] > 60 && rgb[0] < 200);
}

/* 0.02 in OKLab is about one just noticeable difference. */
static void palette_colors_differ_and_near_numbers_differ_clearly(void **state)
{
    (void)state;
    enum { COUNT = 120, NEAR = 4, BY_HAND = 12 };
    uint8_t rgb[COUNT][3];
    for (int i = 0; i < COUNT; i++) {
        sl_palette_color(i, rgb[i]);
        float linear[3];
        sl_rgb_to_linear(rgb[i], linear);
        const double lightness = lightness_of(linear);
        assert_true(lightness > 0.6 && lightness < 0.93);
        for (int j = 0; j < i; j++) {
            const double distance = sl_color_distance(rgb[i], rgb[j]);
            assert_true(distance > 0.003);
            assert_true(i - j > NEAR || distance > 0.05);
            assert_true(i >= BY_HAND || distance > 0.045);
        }
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(one_way_maps_change_lightness_evenly),
        cmocka_unit_test(the_diverging_map_is_blue_white_red_and_even_on_both_sides),
        cmocka_unit_test(samples_are_the_table_and_clamp),
        cmocka_unit_test(not_a_number_is_a_grey),
        cmocka_unit_test(palette_colors_differ_and_near_numbers_differ_clearly),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
