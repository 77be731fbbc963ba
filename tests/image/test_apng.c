#include "support/test_support.h"

#include "base/file.h"
#include "base/memory.h"
#include "image/apng.h"
#include "image/png.h"

#include <string.h>

static uint32_t big_endian(const uint8_t *p)
{
    return (uint32_t)p[0] << 24 | (uint32_t)p[1] << 16 | (uint32_t)p[2] << 8 | p[3];
}

static void store(uint8_t *p, uint32_t value)
{
    for (int k = 0; k < 4; k++) {
        p[k] = (uint8_t)(value >> (24 - 8 * k));
    }
}

/* The checksum of chunks, a bit at a time. */
static uint32_t crc(const uint8_t *p, int64_t count)
{
    uint32_t c = 0xffffffffu;
    for (int64_t i = 0; i < count; i++) {
        c ^= p[i];
        for (int k = 0; k < 8; k++) {
            c = (c & 1) != 0 ? 0xedb88320u ^ c >> 1 : c >> 1;
        }
    }
    return ~c;
}

static sl_image *image_of(test_rng *rng, int32_t width, int32_t height, int32_t channels)
{
    sl_image *image = NULL;
    assert_int_equal(sl_image_create(width, height, channels, &image), SL_OK);
    for (int64_t i = 0; i < (int64_t)width * height * channels; i++) {
        image->pixels[i] = (uint8_t)test_bits(rng);
    }
    return image;
}

/* An animation as a reader sees it, written from the specification: chunks in order, checksums and sequence numbers
 * right, each frame's data decoded as a picture of its own and laid over what was there. */
typedef struct player {
    const uint8_t *data;
    int64_t size, at;
    uint32_t sequence, declared, plays;
    int32_t frames;
    int32_t ms[64];
    uint32_t area[64]; /* pixels stored */
    sl_image *canvas;
    sl_image *shown[64];
    uint8_t header[25]; /* the IHDR chunk */
    uint8_t *part;      /* the PNG of the frame being read */
    int64_t part_size;
    uint32_t where[4]; /* width, height, x, y */
} player;

static void append(player *p, const uint8_t *bytes, int64_t count)
{
    memcpy(p->part + p->part_size, bytes, (size_t)count);
    p->part_size += count;
}

static void begin_part(player *p)
{
    static const uint8_t signature[8] = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n'};
    p->part_size = 0;
    append(p, signature, 8);
    uint8_t header[25];
    memcpy(header, p->header, 25);
    store(header + 8, p->where[0]);
    store(header + 12, p->where[1]);
    store(header + 21, crc(header + 4, 17));
    append(p, header, 25);
}

static void end_part(player *p)
{
    static const uint8_t end[12] = {0, 0, 0, 0, 'I', 'E', 'N', 'D', 0xae, 0x42, 0x60, 0x82};
    if (p->part_size == 0) {
        return;
    }
    sl_image *piece = NULL;
    append(p, end, 12);
    assert_int_equal(sl_png_decode("frame", p->part, p->part_size, &piece, NULL), SL_OK);
    assert_int_equal(piece->width, p->where[0]);
    assert_int_equal(piece->height, p->where[1]);
    sl_image_paste(p->canvas, piece, (int32_t)p->where[2], (int32_t)p->where[3]);
    const int32_t last = p->frames - 1;
    assert_int_equal(sl_image_create(p->canvas->width, p->canvas->height, p->canvas->channels, &p->shown[last]), SL_OK);
    sl_image_paste(p->shown[last], p->canvas, 0, 0);
    sl_image_free(piece);
    p->part_size = 0;
}

static void read_control(player *p, const uint8_t *body)
{
    end_part(p);
    assert_int_equal(big_endian(body), p->sequence++);
    for (int k = 0; k < 4; k++) {
        p->where[k] = big_endian(body + 4 + 4 * k);
    }
    assert_true(p->where[0] >= 1 && p->where[0] + p->where[2] <= (uint32_t)p->canvas->width);
    assert_true(p->where[1] >= 1 && p->where[1] + p->where[3] <= (uint32_t)p->canvas->height);
    assert_int_equal(body[22] << 8 | body[23], 1000);
    assert_int_equal(body[24] | body[25], 0);
    p->ms[p->frames] = body[20] << 8 | body[21];
    p->area[p->frames] = p->where[0] * p->where[1];
    p->frames++;
    begin_part(p);
}

static void read_data(player *p, const uint8_t *body, int64_t length)
{
    const bool first = p->frames == 1;
    uint8_t *chunk = p->part + p->part_size;
    if (!first) {
        assert_int_equal(big_endian(body), p->sequence++);
    }
    const int64_t skip = first ? 0 : 4;
    store(chunk, (uint32_t)(length - skip));
    memcpy(chunk + 4, "IDAT", 4);
    memcpy(chunk + 8, body + skip, (size_t)(length - skip));
    store(chunk + 8 + length - skip, crc(chunk + 4, length - skip + 4));
    p->part_size += length - skip + 12;
}

static void read_chunk(player *p)
{
    const int64_t length = big_endian(p->data + p->at);
    const uint8_t *name = p->data + p->at + 4, *body = name + 4;
    assert_true(p->at + 12 + length <= p->size);
    assert_int_equal(big_endian(body + length), crc(name, length + 4));
    if (memcmp(name, "IHDR", 4) == 0) {
        memcpy(p->header, p->data + p->at, 25);
        assert_int_equal(
            sl_image_create((int32_t)big_endian(body), (int32_t)big_endian(body + 4), body[9] == 6 ? 4 : 3, &p->canvas),
            SL_OK);
    } else if (memcmp(name, "acTL", 4) == 0) {
        assert_int_equal(p->frames, 0);
        p->declared = big_endian(body);
        p->plays = big_endian(body + 4);
    } else if (memcmp(name, "fcTL", 4) == 0) {
        read_control(p, body);
    } else if (memcmp(name, "IDAT", 4) == 0 || memcmp(name, "fdAT", 4) == 0) {
        assert_true((memcmp(name, "IDAT", 4) == 0) == (p->frames == 1));
        read_data(p, body, length);
    } else if (memcmp(name, "IEND", 4) == 0) {
        end_part(p);
        assert_int_equal(p->at + 12, p->size);
    } else {
        assert_memory_equal(name, "sRGB", 4);
    }
    p->at += length + 12;
}

static player *play(const uint8_t *data, int64_t size)
{
    player *p = sl_calloc(1, sizeof *p);
    assert_non_null(p);
    *p = (player){.data = data, .size = size, .at = 8, .part = sl_alloc(size + 1024, 1)};
    assert_non_null(p->part);
    while (p->at < size) {
        read_chunk(p);
    }
    assert_int_equal(p->declared, p->frames);
    return p;
}

static void player_free(player *p)
{
    for (int32_t k = 0; k < p->frames; k++) {
        sl_image_free(p->shown[k]);
    }
    sl_image_free(p->canvas);
    sl_free(p->part);
    sl_free(p);
}

static void assert_same_pixels(const sl_image *a, const sl_image *b)
{
    assert_int_equal(a->width, b->width);
    assert_int_equal(a->height, b->height);
    assert_int_equal(a->channels, b->channels);
    assert_memory_equal(a->pixels, b->pixels, (size_t)a->width * (size_t)a->height * (size_t)a->channels);
}

/* Changes some pixels in a random rectangle; returns how many pixels the tightest box of the changes has. */
static uint32_t change(test_rng *rng, sl_image *image)
{
    const int32_t x0 = test_index(rng, image->width), y0 = test_index(rng, image->height);
    const int32_t x1 = x0 + test_index(rng, image->width - x0), y1 = y0 + test_index(rng, image->height - y0);
    const int32_t corner[4][2] = {{x0, y0}, {x1, y0}, {x0, y1}, {x1, y1}};
    for (int k = 0; k < 4; k++) {
        const int32_t channel = test_index(rng, image->channels);
        if (k == 0 || k == 3) {
            sl_image_pixel(image, corner[k][0], corner[k][1])[channel] ^= (uint8_t)(1 + test_index(rng, 127));
        }
    }
    return x0 == x1 && y0 == y1 ? 0 : (uint32_t)((x1 - x0 + 1) * (y1 - y0 + 1));
}

static void frames_play_back_as_they_were_given_and_store_what_changed_only(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0xa916);
    for (int trial = 0; trial < 12 * test_multiplier(); trial++) {
        sl_image *image = image_of(&rng, 2 + test_index(&rng, 90), 2 + test_index(&rng, 60), 3 + trial % 2);
        sl_image *given[20] = {0};
        uint32_t area[20];
        int32_t ms[20];
        sl_apng *animation = NULL;
        assert_int_equal(sl_apng_create(trial, &animation), SL_OK);
        for (int k = 0; k < 20; k++) {
            area[k] = k == 0 ? (uint32_t)(image->width * image->height) : change(&rng, image);
            ms[k] = 1 + test_index(&rng, 9000);
            assert_int_equal(sl_image_create(image->width, image->height, image->channels, &given[k]), SL_OK);
            sl_image_paste(given[k], image, 0, 0);
            assert_int_equal(sl_apng_add(animation, image, ms[k]), SL_OK);
        }
        uint8_t *data = NULL, *again = NULL;
        int64_t size = 0, size_again = 0;
        assert_int_equal(sl_apng_encode(animation, &data, &size), SL_OK);
        assert_int_equal(sl_apng_encode(animation, &again, &size_again), SL_OK);
        assert_int_equal(size, size_again);
        assert_memory_equal(data, again, (size_t)size);
        player *p = play(data, size);
        assert_int_equal(p->plays, trial);
        assert_int_equal(p->frames, sl_apng_frames(animation));
        assert_int_equal(p->frames, 20); /* a single pixel that changed twice is one that differs or not */
        for (int k = 0; k < 20; k++) {
            assert_same_pixels(p->shown[k], given[k]);
            assert_int_equal(p->ms[k], ms[k]);
            assert_true(area[k] == 0 || p->area[k] == area[k]);
            sl_image_free(given[k]);
        }
        player_free(p);
        sl_free(data);
        sl_free(again);
        sl_apng_free(animation);
        sl_image_free(image);
    }
}

static void a_picture_shown_again_makes_its_frame_last_longer(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0xa917);
    sl_image *image = image_of(&rng, 31, 17, 3);
    sl_apng *animation = NULL;
    assert_int_equal(sl_apng_create(0, &animation), SL_OK);
    const int32_t ms[5] = {40000, 25535, 7, 65535, 3};
    for (int k = 0; k < 5; k++) {
        assert_int_equal(sl_apng_add(animation, image, ms[k]), SL_OK);
    }
    assert_int_equal(sl_apng_frames(animation), 4); /* 65535, then 7, 65535 and 3 */
    uint8_t *data = NULL;
    int64_t size = 0;
    assert_int_equal(sl_apng_encode(animation, &data, &size), SL_OK);
    player *p = play(data, size);
    const int32_t expected[4] = {65535, 7, 65535, 3};
    for (int k = 0; k < 4; k++) {
        assert_int_equal(p->ms[k], expected[k]);
        assert_same_pixels(p->shown[k], image);
    }
    player_free(p);
    sl_free(data);
    sl_apng_free(animation);
    sl_image_free(image);
}

static void to_other_readers_it_is_the_first_picture(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0xa918);
    sl_image *first = image_of(&rng, 120, 77, 3), *second = image_of(&rng, 120, 77, 3), *back = NULL;
    sl_apng *animation = NULL;
    sl_diag diag = sl_diag_none();
    assert_int_equal(sl_apng_create(3, &animation), SL_OK);
    assert_int_equal(sl_apng_add(animation, first, 100), SL_OK);
    assert_int_equal(sl_apng_add(animation, second, 100), SL_OK);
    assert_int_equal(sl_apng_write(test_scratch("a.png"), animation, &diag), SL_OK);
    assert_int_equal(sl_png_read(test_scratch("a.png"), &back, &diag), SL_OK);
    assert_same_pixels(first, back);
    assert_int_equal(sl_apng_write(test_scratch("none/a.png"), animation, &diag), SL_IO);
    sl_apng_free(animation);
    sl_image_free(first);
    sl_image_free(second);
    sl_image_free(back);
}

static void what_does_not_fit_is_refused_and_changes_nothing(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0xa919);
    sl_image *image = image_of(&rng, 12, 9, 3), *wide = image_of(&rng, 13, 9, 3), *high = image_of(&rng, 12, 10, 3);
    sl_image *clear = image_of(&rng, 12, 9, 4);
    sl_apng *animation = NULL;
    uint8_t *data = NULL;
    int64_t size = 0;
    assert_int_equal(sl_apng_create(-1, &animation), SL_BAD_INPUT);
    assert_null(animation);
    assert_int_equal(sl_apng_create(0, &animation), SL_OK);
    assert_int_equal(sl_apng_encode(animation, &data, &size), SL_BAD_INPUT);
    assert_int_equal(sl_apng_write(test_scratch("empty.png"), animation, NULL), SL_BAD_INPUT);
    assert_int_equal(sl_apng_add(animation, image, 0), SL_BAD_INPUT);
    assert_int_equal(sl_apng_add(animation, image, 65536), SL_BAD_INPUT);
    assert_int_equal(sl_apng_add(animation, image, 65535), SL_OK);
    assert_int_equal(sl_apng_add(animation, wide, 10), SL_BAD_INPUT);
    assert_int_equal(sl_apng_add(animation, high, 10), SL_BAD_INPUT);
    assert_int_equal(sl_apng_add(animation, clear, 10), SL_BAD_INPUT);
    assert_int_equal(sl_apng_frames(animation), 1);
    assert_int_equal(sl_apng_encode(animation, &data, &size), SL_OK);
    player_free(play(data, size));
    sl_free(data);
    sl_apng_free(animation);
    sl_apng_free(NULL);
    sl_image_free(image);
    sl_image_free(wide);
    sl_image_free(high);
    sl_image_free(clear);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(frames_play_back_as_they_were_given_and_store_what_changed_only),
        cmocka_unit_test(a_picture_shown_again_makes_its_frame_last_longer),
        cmocka_unit_test(to_other_readers_it_is_the_first_picture),
        cmocka_unit_test(what_does_not_fit_is_refused_and_changes_nothing),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
