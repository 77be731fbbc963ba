#include "support/test_support.h"

#include "base/status.h"
#include "image/color.h"

#include <math.h>

static void srgb_bytes_survive_linear_light(void **state)
{
    (void)state;
    for (int b = 0; b < 256; b++) {
        const uint8_t rgb[3] = {(uint8_t)b, (uint8_t)(255 - b), (uint8_t)(b * 7 % 256)};
        float linear[3];
        uint8_t back[3];
        sl_rgb_to_linear(rgb, linear);
        sl_rgb_from_linear(linear, back);
        assert_memory_equal(rgb, back, 3);
    }
}

/* Values of IEC 61966-2-1 worked out by hand. */
static void srgb_transfer_has_its_known_values(void **state)
{
    (void)state;
    assert_true(test_near(sl_srgb_to_linear(0.5), 0.21404114048223255, 1e-12));
    assert_true(test_near(sl_srgb_to_linear(0.02), 0.02 / 12.92, 1e-15));
    assert_true(test_near(sl_srgb_from_linear(0.18), 0.46135612950044164, 1e-12));
    assert_true(test_near(sl_srgb_to_linear(-3.0), 0.0, 0.0) && test_near(sl_srgb_from_linear(7.0), 1.0, 1e-15));
    assert_true(test_near(sl_srgb_from_linear((double)NAN), 0.0, 0.0));
}

static void a_table_gives_the_same_bytes_as_the_formula(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0x7ab1e);
    enum { COUNT = 40000 };
    static float linear[3 * COUNT];
    static uint8_t bytes[3 * COUNT];
    for (int i = 0; i < 3 * COUNT; i++) {
        const double x = test_uniform(&rng, -0.1, 1.1);
        linear[i] = (float)(i % 5 == 0 ? x * x * x * x * x * x : x);
    }
    linear[7] = (float)NAN;
    linear[8] = INFINITY;
    linear[9] = -INFINITY;
    linear[10] = 1.0f;
    sl_pixels_from_linear(COUNT, linear, bytes);
    for (int i = 0; i < COUNT; i++) {
        uint8_t want[3];
        sl_rgb_from_linear(linear + 3 * i, want);
        assert_memory_equal(bytes + 3 * i, want, 3);
    }
}

/* Reference values published with the definition of OKLab (XYZ columns turned to sRGB primaries). */
static void oklab_of_white_and_the_primaries_is_known(void **state)
{
    (void)state;
    static const double rgb[][3] = {{1, 1, 1}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    static const double lab[][3] = {{1.0, 0.0, 0.0},
                                    {0.6279554, 0.2248631, 0.1258463},
                                    {0.8664396, -0.2338876, 0.1794985},
                                    {0.4520137, -0.0324570, -0.3115281}};
    for (size_t i = 0; i < SL_COUNTOF(rgb); i++) {
        double got[3];
        sl_oklab_from_linear(rgb[i], got);
        for (int k = 0; k < 3; k++) {
            assert_true(test_near(got[k], lab[i][k], 1e-5));
        }
    }
}

static void oklab_and_back_is_the_identity(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0x0c1ab);
    for (int trial = 0; trial < 1000 * test_multiplier(); trial++) {
        const double rgb[3] = {test_uniform(&rng, 0, 1), test_uniform(&rng, 0, 1), test_uniform(&rng, 0, 1)};
        double lab[3], back[3];
        sl_oklab_from_linear(rgb, lab);
        sl_oklab_to_linear(lab, back);
        for (int k = 0; k < 3; k++) {
            assert_true(test_near(back[k], rgb[k], 1e-6)); /* the published matrices have ten digits */
        }
    }
}

static void oklch_stays_in_the_gamut_and_keeps_lightness_and_hue(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0x0c1c4);
    for (int trial = 0; trial < 1000 * test_multiplier(); trial++) {
        const double lightness = test_uniform(&rng, 0.05, 0.98), hue = test_uniform(&rng, -180, 540);
        double rgb[3], lab[3];
        sl_oklch_to_linear(lightness, test_uniform(&rng, 0.02, 0.5), hue, rgb);
        sl_oklab_from_linear(rgb, lab);
        for (int k = 0; k < 3; k++) {
            assert_true(rgb[k] >= 0.0 && rgb[k] <= 1.0);
        }
        assert_true(test_near(lab[0], lightness, 1e-3));
        const double chroma = sqrt(lab[1] * lab[1] + lab[2] * lab[2]), angle = hue * TEST_PI / 180.0;
        assert_true(test_near(lab[1], chroma * cos(angle), 2e-3) && test_near(lab[2], chroma * sin(angle), 2e-3));
    }
}

static void distance_is_a_metric_with_black_to_white_one(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0xd15);
    const uint8_t black[3] = {0, 0, 0}, white[3] = {255, 255, 255};
    assert_true(test_near(sl_color_distance(black, white), 1.0, 1e-4));
    for (int trial = 0; trial < 300; trial++) {
        uint8_t c[3][3];
        for (int i = 0; i < 9; i++) {
            c[i / 3][i % 3] = (uint8_t)test_bits(&rng);
        }
        const double ab = sl_color_distance(c[0], c[1]), bc = sl_color_distance(c[1], c[2]);
        assert_true(test_near(ab, sl_color_distance(c[1], c[0]), 1e-12));
        assert_true(sl_color_distance(c[0], c[2]) <= ab + bc + 1e-12);
        assert_true(test_near(sl_color_distance(c[0], c[0]), 0.0, 0.0));
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(srgb_bytes_survive_linear_light),
        cmocka_unit_test(srgb_transfer_has_its_known_values),
        cmocka_unit_test(a_table_gives_the_same_bytes_as_the_formula),
        cmocka_unit_test(oklab_of_white_and_the_primaries_is_known),
        cmocka_unit_test(oklab_and_back_is_the_identity),
        cmocka_unit_test(oklch_stays_in_the_gamut_and_keeps_lightness_and_hue),
        cmocka_unit_test(distance_is_a_metric_with_black_to_white_one),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
