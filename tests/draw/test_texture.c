#include "draw/draw_support.h"

#include "draw/texture.h"

#include <math.h>
#include <string.h>

static const double none[2] = {0.0, 0.0};

/* Light proportional to the byte: sums can be checked by hand. */
static void proportional(float linear[256])
{
    for (int k = 0; k < 256; k++) {
        linear[k] = (float)(k / 255.0);
    }
}

static sl_texture *make(int32_t width, int32_t height, int32_t channels, const uint8_t *pixels)
{
    float linear[256];
    sl_texture *texture = NULL;
    proportional(linear);
    assert_int_equal(sl_texture_create(width, height, channels, pixels, linear, &texture), SL_OK);
    return texture;
}

static void fill(test_rng *rng, uint8_t *pixels, int32_t count)
{
    for (int32_t i = 0; i < count; i++) {
        pixels[i] = (uint8_t)test_bits(rng);
    }
}

static void the_middle_of_a_texel_shows_it_exactly_wherever_it_repeats(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0x7e8);
    uint8_t pixels[13 * 7 * 4];
    for (int trial = 0; trial < 100 * test_multiplier(); trial++) {
        const int32_t width = 1 + test_index(&rng, 13), height = 1 + test_index(&rng, 7), channels = 3 + trial % 2;
        fill(&rng, pixels, width * height * channels);
        sl_texture *t = make(width, height, channels, pixels);
        const int32_t x = test_index(&rng, width), y = test_index(&rng, height);
        const double uv[2] = {(x + 0.5) / width + test_index(&rng, 9) - 4,
                              1.0 - (y + 0.5) / height + test_index(&rng, 9) - 4};
        float rgb[3];
        assert_true(sl_texture_sample(t, uv, none, none, rgb));
        for (int k = 0; k < 3; k++) {
            assert_true(fabs((double)rgb[k] - pixels[channels * (y * width + x) + k] / 255.0) < 1e-4);
        }
        sl_texture_free(t);
    }
}

static void between_texels_light_is_interpolated_in_both_directions(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0xb11);
    uint8_t pixels[6 * 5 * 3];
    fill(&rng, pixels, 90);
    sl_texture *t = make(6, 5, 3, pixels);
    for (int trial = 0; trial < 200 * test_multiplier(); trial++) {
        const int32_t x = test_index(&rng, 6), y = test_index(&rng, 5);
        const double fx = test_uniform(&rng, 0.0, 1.0), fy = test_uniform(&rng, 0.0, 1.0);
        const double uv[2] = {(x + 0.5 + fx) / 6.0, 1.0 - (y + 0.5 + fy) / 5.0};
        float rgb[3];
        assert_true(sl_texture_sample(t, uv, none, none, rgb));
        for (int k = 0; k < 3; k++) {
            const double a = pixels[3 * (6 * y + x) + k], b = pixels[3 * (6 * y + (x + 1) % 6) + k];
            const double c = pixels[3 * (6 * ((y + 1) % 5) + x) + k],
                         d = pixels[3 * (6 * ((y + 1) % 5) + (x + 1) % 6) + k];
            const double expected = (1.0 - fy) * (a + fx * (b - a)) + fy * (c + fx * (d - c));
            assert_true(fabs((double)rgb[k] - expected / 255.0) < 1e-4);
        }
    }
    sl_texture_free(t);
}

/* Levels of every size keep the mean, so a footprint as large as the picture shows it. */
static void from_far_away_a_texture_is_its_mean(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0xfa2);
    uint8_t pixels[37 * 29 * 3];
    for (int trial = 0; trial < 60 * test_multiplier(); trial++) {
        const int32_t width = 1 + test_index(&rng, 37), height = 1 + test_index(&rng, 29);
        double mean[3] = {0.0, 0.0, 0.0};
        fill(&rng, pixels, 3 * width * height);
        for (int32_t i = 0; i < 3 * width * height; i++) {
            mean[i % 3] += pixels[i] / 255.0 / (width * height);
        }
        sl_texture *t = make(width, height, 3, pixels);
        const double uv[2] = {test_uniform(&rng, -3.0, 3.0), test_uniform(&rng, -3.0, 3.0)};
        const double right[2] = {70.0, 3.0}, below[2] = {-2.0, 90.0};
        float rgb[3];
        assert_true(sl_texture_sample(t, uv, right, below, rgb));
        for (int k = 0; k < 3; k++) {
            assert_true(fabs((double)rgb[k] - mean[k]) < 2e-3);
        }
        sl_texture_free(t);
    }
}

/* The same stripes the other way round: a footprint a period long shows their mean, on whichever side it is long. */
static void a_long_footprint_averages_along_itself(void **state)
{
    (void)state;
    uint8_t pixels[64 * 64 * 3];
    for (int32_t i = 0; i < 64 * 64 * 3; i++) {
        pixels[i] = i / 3 / 64 / 8 % 2 != 0 ? 230 : 20;
    }
    sl_texture *t = make(64, 64, 3, pixels);
    const double uv[2] = {0.37, 1.0 - (8 + 4) / 64.0}, narrow[2] = {1.0 / 64.0, 0.0}, tall[2] = {0.0, 16.0 / 64.0};
    float rgb[2][3];
    assert_true(sl_texture_sample(t, uv, narrow, tall, rgb[0]));
    assert_true(sl_texture_sample(t, uv, tall, narrow, rgb[1]));
    for (int k = 0; k < 2; k++) {
        assert_true(fabs((double)rgb[k][0] - 125.0 / 255.0) < 0.06);
    }
    sl_texture_free(t);
}

/* Stripes along u under a footprint long in v: still sharp, where one isotropic sample would be grey. */
static void a_long_footprint_blurs_along_itself_only(void **state)
{
    (void)state;
    uint8_t pixels[64 * 64 * 3];
    for (int32_t i = 0; i < 64 * 64 * 3; i++) {
        pixels[i] = i / 3 % 64 / 8 % 2 != 0 ? 230 : 20;
    }
    sl_texture *t = make(64, 64, 3, pixels);
    const double uv[2] = {(8 + 4) / 64.0, 0.37}, right[2] = {1.0 / 64.0, 0.0}, below[2] = {0.0, 7.0 / 64.0};
    float rgb[3];
    assert_true(sl_texture_sample(t, uv, right, below, rgb));
    assert_true(rgb[0] > 0.88f);
    sl_texture_free(t);
}

static void numbers_that_are_no_places_and_sizes_out_of_range_are_refused(void **state)
{
    (void)state;
    static const double odd[][2] = {{NAN, 0.5}, {0.5, INFINITY}, {1e12, 0.0}, {0.0, -1e300}};
    const uint8_t pixel[4] = {10, 20, 30, 40};
    float linear[256], rgb[3] = {7.0f, 8.0f, 9.0f};
    sl_texture *t = make(1, 1, 4, pixel), *bad = NULL;
    const double here[2] = {0.3, 0.3};
    proportional(linear);
    for (int i = 0; i < 4; i++) {
        assert_false(sl_texture_sample(t, odd[i], none, none, rgb));
    }
    assert_false(sl_texture_sample(t, here, odd[0], none, rgb));
    assert_false(sl_texture_sample(t, here, none, odd[3], rgb));
    assert_true(rgb[0] == 7.0f && rgb[2] == 9.0f);
    assert_int_equal(sl_texture_create(0, 1, 3, pixel, linear, &bad), SL_BAD_INPUT);
    assert_int_equal(sl_texture_create(1, SL_TEXTURE_MAX_SIDE + 1, 3, pixel, linear, &bad), SL_BAD_INPUT);
    assert_int_equal(sl_texture_create(1, 1, 2, pixel, linear, &bad), SL_BAD_INPUT);
    assert_null(bad);
    sl_texture_free(t);
    sl_texture_free(NULL);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_middle_of_a_texel_shows_it_exactly_wherever_it_repeats),
        cmocka_unit_test(between_texels_light_is_interpolated_in_both_directions),
        cmocka_unit_test(from_far_away_a_texture_is_its_mean),
        cmocka_unit_test(a_long_footprint_averages_along_itself),
        cmocka_unit_test(a_long_footprint_blurs_along_itself_only),
        cmocka_unit_test(numbers_that_are_no_places_and_sizes_out_of_range_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
