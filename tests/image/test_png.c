#include "support/test_support.h"

#include "base/file.h"
#include "base/memory.h"
#include "image/png.h"

#include <string.h>

static sl_image *random_image(test_rng *rng, int32_t channels)
{
    sl_image *image = NULL;
    assert_int_equal(sl_image_create(1 + test_index(rng, 70), 1 + test_index(rng, 50), channels, &image), SL_OK);
    const int64_t count = (int64_t)image->width * image->height * channels;
    for (int64_t i = 0; i < count; i++) {
        image->pixels[i] = (uint8_t)test_bits(rng);
    }
    return image;
}

static void assert_same_image(const sl_image *a, const sl_image *b)
{
    assert_int_equal(a->width, b->width);
    assert_int_equal(a->height, b->height);
    assert_int_equal(a->channels, b->channels);
    assert_memory_equal(a->pixels, b->pixels, (size_t)a->width * (size_t)a->height * (size_t)a->channels);
}

static void what_is_encoded_decodes_to_the_same_pixels(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0x9416);
    for (int trial = 0; trial < 40 * test_multiplier(); trial++) {
        sl_image *image = random_image(&rng, 3 + trial % 2), *back = NULL;
        uint8_t *data = NULL;
        int64_t size = 0;
        assert_int_equal(sl_png_encode(image, &data, &size), SL_OK);
        assert_int_equal(sl_png_decode("memory", data, size, &back, NULL), SL_OK);
        assert_same_image(image, back);
        sl_free(data);
        sl_image_free(image);
        sl_image_free(back);
    }
}

static uint32_t big_endian(const uint8_t *p)
{
    return (uint32_t)p[0] << 24 | (uint32_t)p[1] << 16 | (uint32_t)p[2] << 8 | p[3];
}

/* Read with our own eyes: signature, header, only the chunks we mean to write. */
static void a_file_holds_header_srgb_pixels_and_end_only(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0xc4a);
    sl_image *image = random_image(&rng, 3);
    uint8_t *data = NULL, *again = NULL;
    int64_t size = 0, size_again = 0;
    assert_int_equal(sl_png_encode(image, &data, &size), SL_OK);
    static const uint8_t signature[8] = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n'};
    assert_memory_equal(data, signature, 8);
    assert_memory_equal(data + 12, "IHDR", 4);
    assert_int_equal(big_endian(data + 16), image->width);
    assert_int_equal(big_endian(data + 20), image->height);
    assert_int_equal(data[24], 8); /* bits */
    assert_int_equal(data[25], 2); /* truecolour */
    for (int64_t at = 8; at < size; at += 12 + (int64_t)big_endian(data + at)) {
        const char *kind = (const char *)data + at + 4;
        assert_true(memcmp(kind, "IHDR", 4) == 0 || memcmp(kind, "sRGB", 4) == 0 || memcmp(kind, "IDAT", 4) == 0 ||
                    memcmp(kind, "IEND", 4) == 0);
    }
    assert_int_equal(sl_png_encode(image, &again, &size_again), SL_OK);
    assert_int_equal(size, size_again);
    assert_memory_equal(data, again, (size_t)size);
    sl_free(data);
    sl_free(again);
    sl_image_free(image);
}

static void a_file_written_reads_back(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0xf11e);
    sl_image *image = random_image(&rng, 4), *back = NULL;
    sl_diag diag = sl_diag_none();
    assert_int_equal(sl_png_write(test_scratch("a.png"), image, &diag), SL_OK);
    assert_int_equal(sl_png_read(test_scratch("a.png"), &back, &diag), SL_OK);
    assert_same_image(image, back);
    sl_image_free(image);
    sl_image_free(back);
}

static void a_folder_that_is_not_there_is_an_io_error(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(3);
    sl_image *image = random_image(&rng, 3), *back = NULL;
    sl_diag diag = sl_diag_none();
    assert_int_equal(sl_png_write(test_scratch("none/a.png"), image, &diag), SL_IO);
    assert_int_equal(sl_png_read(test_scratch("missing.png"), &back, &diag), SL_IO);
    assert_null(back);
    sl_image_free(image);
}

/* Cut short or with a flipped bit: refused or, where the flip is harmless, a picture of the right size; never a crash.
 */
static void damaged_files_are_refused_with_a_reason(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0xbad);
    sl_image *image = random_image(&rng, 3);
    uint8_t *data = NULL;
    int64_t size = 0;
    assert_int_equal(sl_png_encode(image, &data, &size), SL_OK);
    for (int trial = 0; trial < 300 * test_multiplier(); trial++) {
        sl_image *back = NULL;
        sl_diag diag = sl_diag_none();
        const bool cut = trial % 2 == 0;
        const int64_t at = test_index(&rng, (int32_t)size - 12);
        const uint8_t bit = (uint8_t)(1 << test_index(&rng, 8));
        data[at] ^= cut ? 0 : bit;
        const sl_status status = sl_png_decode("damaged.png", data, cut ? at : size, &back, &diag);
        if (cut || status != SL_OK) {
            assert_true(status == SL_BAD_INPUT || status == SL_OUT_OF_MEMORY);
            assert_null(back);
            assert_true(status == SL_OUT_OF_MEMORY || strcmp(diag.file, "damaged.png") == 0);
            assert_true(status == SL_OUT_OF_MEMORY || diag.reason[0] != '\0');
        }
        sl_image_free(back);
        data[at] ^= cut ? 0 : bit;
    }
    sl_free(data);
    sl_image_free(image);
}

/* The checksum of PNG chunks. */
static uint32_t crc(const uint8_t *p, int count)
{
    uint32_t c = 0xffffffffu;
    for (int i = 0; i < count; i++) {
        c ^= p[i];
        for (int k = 0; k < 8; k++) {
            c = (c & 1) != 0 ? 0xedb88320u ^ c >> 1 : c >> 1;
        }
    }
    return ~c;
}

static void a_header_that_claims_a_huge_picture_allocates_nothing(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0x416e);
    sl_image *image = random_image(&rng, 3), *back = NULL;
    uint8_t *data = NULL;
    int64_t size = 0;
    assert_int_equal(sl_png_encode(image, &data, &size), SL_OK);
    memcpy(data + 16, "\x00\x00\xff\xff\x00\x00\xff\xff", 8); /* 65535 x 65535 */
    const uint32_t sum = crc(data + 12, 17);
    for (int k = 0; k < 4; k++) {
        data[29 + k] = (uint8_t)(sum >> (24 - 8 * k));
    }
    assert_int_equal(sl_png_decode("huge", data, size, &back, NULL), SL_BAD_INPUT);
    assert_null(back);
    sl_free(data);
    sl_image_free(image);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(what_is_encoded_decodes_to_the_same_pixels),
        cmocka_unit_test(a_file_holds_header_srgb_pixels_and_end_only),
        cmocka_unit_test(a_file_written_reads_back),
        cmocka_unit_test(a_folder_that_is_not_there_is_an_io_error),
        cmocka_unit_test(damaged_files_are_refused_with_a_reason),
        cmocka_unit_test(a_header_that_claims_a_huge_picture_allocates_nothing),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
