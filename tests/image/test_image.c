#include "support/test_support.h"

#include "base/memory.h"
#include "image/image.h"

#include <string.h>

static void fill_random(sl_image *image, test_rng *rng)
{
    const int64_t count = (int64_t)image->width * image->height * image->channels;
    for (int64_t i = 0; i < count; i++) {
        image->pixels[i] = (uint8_t)test_bits(rng);
    }
}

static void sides_and_channels_out_of_range_are_refused(void **state)
{
    (void)state;
    static const int32_t bad[][3] = {{0, 7, 3}, {7, 0, 3}, {-4, 7, 3}, {7, SL_IMAGE_MAX_SIDE + 1, 4},
                                     {7, 7, 1}, {7, 7, 5}};
    for (size_t i = 0; i < SL_COUNTOF(bad); i++) {
        sl_image *image = (sl_image *)&bad; /* any address: must become NULL */
        assert_int_equal(sl_image_create(bad[i][0], bad[i][1], bad[i][2], &image), SL_BAD_INPUT);
        assert_null(image);
    }
    sl_image_free(NULL);
}

static void a_fill_reaches_every_pixel_and_makes_it_opaque(void **state)
{
    (void)state;
    const uint8_t rgb[3] = {17, 201, 93};
    sl_image *image = NULL;
    assert_int_equal(sl_image_create(13, 7, 4, &image), SL_OK);
    sl_image_fill(image, rgb);
    for (int32_t i = 0; i < 13 * 7; i++) {
        const uint8_t *p = sl_image_pixel(image, i % 13, i / 13);
        assert_memory_equal(p, rgb, 3);
        assert_int_equal(p[3], 255);
    }
    sl_image_free(image);
}

/* Oracle: every target pixel looked up by itself. */
static void a_paste_copies_what_lands_inside_wherever_it_starts(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0x9a57e);
    for (int trial = 0; trial < 200 * test_multiplier(); trial++) {
        sl_image *target = NULL, *source = NULL, *before = NULL;
        const int32_t w = 1 + test_index(&rng, 9), h = 1 + test_index(&rng, 9), channels = 3 + test_index(&rng, 2);
        assert_int_equal(sl_image_create(w, h, channels, &target), SL_OK);
        assert_int_equal(sl_image_create(w, h, channels, &before), SL_OK);
        assert_int_equal(
            sl_image_create(1 + test_index(&rng, 12), 1 + test_index(&rng, 12), 3 + test_index(&rng, 2), &source),
            SL_OK);
        fill_random(target, &rng);
        fill_random(source, &rng);
        memcpy(before->pixels, target->pixels, (size_t)(w * h * channels));
        const int32_t x = test_index(&rng, 31) - 15, y = test_index(&rng, 31) - 15;
        sl_image_paste(target, source, x, y);
        for (int32_t i = 0; i < w * h; i++) {
            const int32_t sx = i % w - x, sy = i / w - y;
            const bool hit = sx >= 0 && sy >= 0 && sx < source->width && sy < source->height;
            const uint8_t *want = hit ? sl_image_pixel(source, sx, sy) : sl_image_pixel(before, i % w, i / w);
            const uint8_t *got = sl_image_pixel(target, i % w, i / w);
            assert_memory_equal(got, want, 3);
            if (channels == 4) {
                assert_int_equal(got[3], hit && source->channels == 3 ? 255 : want[3]);
            }
        }
        sl_image_free(target);
        sl_image_free(source);
        sl_image_free(before);
    }
}

static void a_paste_far_outside_changes_nothing(void **state)
{
    (void)state;
    sl_image *a = NULL, *b = NULL;
    assert_int_equal(sl_image_create(5, 4, 3, &a), SL_OK);
    assert_int_equal(sl_image_create(3, 3, 3, &b), SL_OK);
    memset(b->pixels, 200, 27);
    static const int32_t at[][2] = {{INT32_MAX, 0}, {INT32_MIN, 1}, {1, INT32_MAX}, {1, INT32_MIN},
                                    {5, 0},         {-3, 0},        {0, 4},         {0, -3}};
    for (size_t i = 0; i < SL_COUNTOF(at); i++) {
        sl_image_paste(a, b, at[i][0], at[i][1]);
    }
    for (int i = 0; i < 60; i++) {
        assert_int_equal(a->pixels[i], 0);
    }
    sl_image_free(a);
    sl_image_free(b);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(sides_and_channels_out_of_range_are_refused),
        cmocka_unit_test(a_fill_reaches_every_pixel_and_makes_it_opaque),
        cmocka_unit_test(a_paste_copies_what_lands_inside_wherever_it_starts),
        cmocka_unit_test(a_paste_far_outside_changes_nothing),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
