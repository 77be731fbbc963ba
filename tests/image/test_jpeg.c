#include "support/test_support.h"

#include "base/file.h"
#include "base/memory.h"
#include "image/jpeg.h"
#include "image/png.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

/* Smooth in both directions, other frequencies in each channel: what JPEG is good at. */
static sl_image *smooth_image(test_rng *rng, int32_t channels)
{
    sl_image *image = NULL;
    assert_int_equal(sl_image_create(40 + test_index(rng, 90), 40 + test_index(rng, 70), channels, &image), SL_OK);
    const double phase = test_uniform(rng, 0.0, 6.0), rate = test_uniform(rng, 0.02, 0.08);
    for (int32_t y = 0; y < image->height; y++) {
        for (int32_t x = 0; x < image->width; x++) {
            uint8_t *p = sl_image_pixel(image, x, y);
            memset(p, 255, (size_t)channels);
            for (int k = 0; k < 3; k++) {
                p[k] = (uint8_t)(128.0 + 100.0 * sin(phase + rate * (x + k * y) + k));
            }
        }
    }
    return image;
}

/* Root of the mean square difference over the three colours. */
static double difference(const sl_image *a, const sl_image *b)
{
    double sum = 0.0;
    for (int32_t y = 0; y < a->height; y++) {
        for (int32_t x = 0; x < a->width; x++) {
            for (int k = 0; k < 3; k++) {
                const double d = (double)sl_image_pixel(a, x, y)[k] - sl_image_pixel(b, x, y)[k];
                sum += d * d;
            }
        }
    }
    return sqrt(sum / (3.0 * a->width * a->height));
}

static void what_is_encoded_decodes_to_nearly_the_same_pixels(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0x19e6);
    for (int trial = 0; trial < 20 * test_multiplier(); trial++) {
        sl_image *image = smooth_image(&rng, 3 + trial % 2), *back = NULL;
        double worst[2];
        for (int sharp = 0; sharp < 2; sharp++) {
            uint8_t *data = NULL;
            int64_t size = 0;
            assert_int_equal(sl_jpeg_encode(image, 92, sharp != 0, &data, &size), SL_OK);
            assert_true(sl_jpeg_recognise(data, size));
            assert_int_equal(sl_jpeg_decode("memory", data, size, &back, NULL), SL_OK);
            assert_true(back->width == image->width && back->height == image->height && back->channels == 3);
            worst[sharp] = difference(image, back);
            sl_image_free(back);
            sl_free(data);
        }
        assert_true(worst[0] < 4.0 && worst[1] < 2.5 && worst[1] <= worst[0] + 0.1);
        sl_image_free(image);
    }
}

static void lower_quality_gives_fewer_bytes(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0x51e);
    sl_image *image = smooth_image(&rng, 3);
    for (int64_t i = 0; i < 3LL * image->width * image->height; i++) {
        image->pixels[i] = (uint8_t)(image->pixels[i] ^ (test_bits(&rng) & 15));
    }
    int64_t before = INT64_MAX;
    for (int32_t quality = 95; quality > 10; quality -= 20) {
        uint8_t *data = NULL;
        int64_t size = 0;
        assert_int_equal(sl_jpeg_encode(image, quality, false, &data, &size), SL_OK);
        assert_true(size < before);
        before = size;
        sl_free(data);
    }
    sl_image_free(image);
}

static void a_damaged_file_is_refused_with_a_reason(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0xbad1);
    sl_image *image = smooth_image(&rng, 3), *back = NULL;
    uint8_t *data = NULL;
    int64_t size = 0;
    assert_int_equal(sl_jpeg_encode(image, 80, true, &data, &size), SL_OK);
    for (int64_t cut = 0; cut < size - 2; cut += 1 + size / 61) {
        sl_diag diag = sl_diag_none();
        assert_int_equal(sl_jpeg_decode("cut.jpg", data, cut, &back, &diag), SL_BAD_INPUT);
        assert_null(back);
        assert_true(diag.reason[0] != '\0' && strcmp(diag.file, "cut.jpg") == 0);
    }
    for (int trial = 0; trial < 200 * test_multiplier(); trial++) { /* must end and leak nothing, whatever comes */
        uint8_t *broken = sl_copy(data, size, 1);
        assert_non_null(broken);
        for (int k = 0; k < 6; k++) {
            broken[test_index(&rng, (int32_t)size)] = (uint8_t)test_bits(&rng);
        }
        if (sl_jpeg_decode("broken.jpg", broken, size, &back, NULL) == SL_OK) {
            sl_image_free(back);
        }
        sl_free(broken);
    }
    sl_free(data);
    sl_image_free(image);
}

static void options_out_of_range_are_refused(void **state)
{
    (void)state;
    sl_image *image = NULL;
    uint8_t *data = NULL;
    int64_t size = 0;
    assert_int_equal(sl_image_create(7, 3, 3, &image), SL_OK);
    assert_int_equal(sl_jpeg_encode(image, 0, true, &data, &size), SL_BAD_INPUT);
    assert_int_equal(sl_jpeg_encode(image, 101, true, &data, &size), SL_BAD_INPUT);
    sl_image_free(image);
    assert_int_equal(sl_image_create(65501, 1, 3, &image), SL_OK);
    assert_int_equal(sl_jpeg_encode(image, 50, true, &data, &size), SL_LIMIT);
    assert_null(data);
    sl_image_free(image);
}

static void a_picture_is_read_by_its_content(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0xf11e);
    sl_image *image = smooth_image(&rng, 3), *back = NULL;
    sl_diag diag = sl_diag_none();
    assert_int_equal(sl_jpeg_write("test_jpeg_a.png", image, 95, true, NULL), SL_OK); /* names lie */
    assert_int_equal(sl_picture_read("test_jpeg_a.png", &back, NULL), SL_OK);
    assert_true(difference(image, back) < 2.5);
    sl_image_free(back);
    assert_int_equal(sl_png_write("test_jpeg_b.jpg", image, NULL), SL_OK);
    assert_int_equal(sl_picture_read("test_jpeg_b.jpg", &back, NULL), SL_OK);
    assert_true(difference(image, back) == 0.0);
    sl_image_free(back);
    remove("test_jpeg_a.png");
    remove("test_jpeg_b.jpg");
    assert_int_equal(sl_picture_read("test_jpeg_none", &back, &diag), SL_IO);
    assert_null(back);
    assert_int_equal(sl_jpeg_write("no/such/folder/a.jpg", image, 90, true, NULL), SL_IO);
    sl_image_free(image);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(what_is_encoded_decodes_to_nearly_the_same_pixels),
        cmocka_unit_test(lower_quality_gives_fewer_bytes),
        cmocka_unit_test(a_damaged_file_is_refused_with_a_reason),
        cmocka_unit_test(options_out_of_range_are_refused),
        cmocka_unit_test(a_picture_is_read_by_its_content),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
