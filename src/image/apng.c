#include "image/apng.h"

#include "base/file.h"
#include "base/memory.h"
#include "image/png.h"

#include <string.h>

enum {
    SIGNATURE = 8,
    FRAME_OVERHEAD = 12, /* length, name and checksum of a chunk */
    CONTROL = 26,        /* bytes of fcTL */
    HEADER = 13,         /* bytes of IHDR */
    DELAY = 20,          /* of delay_num in fcTL */
    PER_SECOND = 1000    /* delay_den */
};

struct sl_apng {
    int32_t plays, frames, sequence;
    uint8_t *head;     /* signature and chunks of the first frame before its image data */
    int64_t head_size; /* acTL is written after the first HEADER chunk of these */
    uint8_t *body;     /* fcTL, IDAT and fdAT chunks */
    int64_t size, capacity;
    int64_t control; /* where the last frame's fcTL begins */
    int32_t ms;      /* its time */
    sl_image *last;
};

typedef struct rectangle {
    int32_t x, y, width, height;
} rectangle;

static void put32(uint8_t *to, uint32_t value)
{
    for (int k = 0; k < 4; k++) {
        to[k] = (uint8_t)(value >> (24 - 8 * k));
    }
}

static uint32_t get32(const uint8_t *from)
{
    return (uint32_t)from[0] << 24 | (uint32_t)from[1] << 16 | (uint32_t)from[2] << 8 | from[3];
}

/* CRC-32 of a chunk's name and data, four bits at a time. */
static uint32_t checksum(const uint8_t *data, int64_t size)
{
    static const uint32_t nibble[16] = {0x00000000, 0x1db71064, 0x3b6e20c8, 0x26d930ac, 0x76dc4190, 0x6b6b51f4,
                                        0x4db26158, 0x5005713c, 0xedb88320, 0xf00f9344, 0xd6d6a3e8, 0xcb61b38c,
                                        0x9b64c2b0, 0x86d3d2d4, 0xa00ae278, 0xbdbdf21c};
    uint32_t crc = 0xffffffffu;
    for (int64_t i = 0; i < size; i++) {
        crc ^= data[i];
        crc = crc >> 4 ^ nibble[crc & 15];
        crc = crc >> 4 ^ nibble[crc & 15];
    }
    return ~crc;
}

/* Writes a chunk whose data stands at to + 8 already; returns its size. */
static int64_t close_chunk(uint8_t *to, const char *name, int64_t size)
{
    put32(to, (uint32_t)size);
    memcpy(to + 4, name, 4);
    put32(to + 8 + size, checksum(to + 4, size + 4));
    return size + FRAME_OVERHEAD;
}

static sl_status make_room(sl_apng *a, int64_t more)
{
    return sl_reserve((void **)&a->body, &a->capacity, a->size + more, 1);
}

sl_status sl_apng_create(int32_t plays, sl_apng **out)
{
    *out = NULL;
    if (plays < 0) {
        return SL_BAD_INPUT;
    }
    sl_apng *a = sl_calloc(1, sizeof *a);
    if (a == NULL) {
        return SL_OUT_OF_MEMORY;
    }
    a->plays = plays;
    *out = a;
    return SL_OK;
}

/* The smallest rectangle that holds all differences; width 0 when there are none. */
static rectangle difference(const sl_image *a, const sl_image *b)
{
    int32_t lo[2] = {a->width, a->height}, hi[2] = {-1, -1};
    const int64_t row = (int64_t)a->width * a->channels;
    for (int32_t y = 0; y < a->height; y++) {
        const uint8_t *p = a->pixels + y * row, *q = b->pixels + y * row;
        if (memcmp(p, q, (size_t)row) == 0) {
            continue;
        }
        int64_t first = 0, last = row - 1;
        while (p[first] == q[first]) {
            first++;
        }
        while (p[last] == q[last]) {
            last--;
        }
        const int32_t left = (int32_t)(first / a->channels), right = (int32_t)(last / a->channels);
        lo[0] = left < lo[0] ? left : lo[0];
        hi[0] = right > hi[0] ? right : hi[0];
        lo[1] = y < lo[1] ? y : lo[1];
        hi[1] = y;
    }
    return hi[1] < 0 ? (rectangle){0} : (rectangle){lo[0], lo[1], hi[0] - lo[0] + 1, hi[1] - lo[1] + 1};
}

/* PNG of a part of a picture. */
static sl_status encode_part(const sl_image *image, const rectangle *r, uint8_t **data, int64_t *size)
{
    sl_image *part = NULL;
    sl_status status = sl_image_create(r->width, r->height, image->channels, &part);
    if (status == SL_OK) {
        sl_image_paste(part, image, -r->x, -r->y);
        status = sl_png_encode(part, data, size);
    }
    sl_image_free(part);
    return status;
}

static void write_control(sl_apng *a, const rectangle *r, int32_t ms)
{
    uint8_t *chunk = a->body + a->size, *data = chunk + 8;
    put32(data, (uint32_t)a->sequence++);
    put32(data + 4, (uint32_t)r->width);
    put32(data + 8, (uint32_t)r->height);
    put32(data + 12, (uint32_t)r->x);
    put32(data + 16, (uint32_t)r->y);
    data[DELAY] = (uint8_t)(ms >> 8);
    data[DELAY + 1] = (uint8_t)ms;
    data[DELAY + 2] = PER_SECOND >> 8;
    data[DELAY + 3] = PER_SECOND & 255;
    data[DELAY + 4] = 0; /* what was drawn stays */
    data[DELAY + 5] = 0; /* and is written over, not blended */
    a->control = a->size;
    a->ms = ms;
    a->size += close_chunk(chunk, "fcTL", CONTROL);
}

/* The frame before lasts longer. */
static void extend_frame(sl_apng *a, int32_t ms)
{
    a->ms += ms;
    uint8_t *chunk = a->body + a->control;
    chunk[8 + DELAY] = (uint8_t)(a->ms >> 8);
    chunk[8 + DELAY + 1] = (uint8_t)a->ms;
    close_chunk(chunk, "fcTL", CONTROL);
}

/* Appends the image data of an encoded picture: IDAT as it is in the first frame, fdAT with a number in others. */
static void append_data(sl_apng *a, const uint8_t *png, int64_t size)
{
    for (int64_t at = SIGNATURE; at + FRAME_OVERHEAD <= size;) {
        const int64_t length = get32(png + at);
        if (memcmp(png + at + 4, "IDAT", 4) == 0) {
            uint8_t *chunk = a->body + a->size;
            const int64_t number = a->frames > 0 ? 4 : 0;
            memcpy(chunk + 8 + number, png + at + 8, (size_t)length);
            if (number > 0) {
                put32(chunk + 8, (uint32_t)a->sequence++);
            }
            a->size += close_chunk(chunk, number > 0 ? "fdAT" : "IDAT", length + number);
        }
        at += length + FRAME_OVERHEAD;
    }
}

/* Bytes that the frame takes at most, a number more in each chunk. */
static int64_t room_for(const uint8_t *png, int64_t size)
{
    int64_t room = size + FRAME_OVERHEAD + CONTROL;
    for (int64_t at = SIGNATURE; at + FRAME_OVERHEAD <= size; at += (int64_t)get32(png + at) + FRAME_OVERHEAD) {
        room += 4;
    }
    return room;
}

/* Signature and what libspng puts before the image data: header and colour space. */
static sl_status keep_head(sl_apng *a, const uint8_t *png, int64_t size)
{
    int64_t at = SIGNATURE;
    while (at + FRAME_OVERHEAD <= size && memcmp(png + at + 4, "IDAT", 4) != 0) {
        at += (int64_t)get32(png + at) + FRAME_OVERHEAD;
    }
    a->head = sl_copy(png, at, 1);
    a->head_size = at;
    return a->head != NULL ? SL_OK : SL_OUT_OF_MEMORY;
}

static bool fits(const sl_apng *a, const sl_image *image, int32_t ms)
{
    return ms >= 1 && ms <= SL_APNG_MAX_MS &&
           (a->last == NULL || (image->width == a->last->width && image->height == a->last->height &&
                                image->channels == a->last->channels));
}

static void remember(sl_apng *a, const sl_image *image)
{
    memcpy(a->last->pixels, image->pixels, (size_t)image->width * (size_t)image->height * (size_t)image->channels);
}

sl_status sl_apng_add(sl_apng *a, const sl_image *image, int32_t ms)
{
    sl_status status = SL_OK;
    uint8_t *png = NULL;
    int64_t size = 0;
    rectangle r = {0, 0, image->width, image->height};
    SL_TRY(fits(a, image, ms) ? SL_OK : SL_BAD_INPUT);
    if (a->last != NULL) {
        r = difference(a->last, image);
        if (r.width == 0 && a->ms + ms <= SL_APNG_MAX_MS) {
            extend_frame(a, ms);
            goto cleanup;
        }
        r = r.width == 0 ? (rectangle){0, 0, 1, 1} : r;
    }
    SL_TRY(encode_part(image, &r, &png, &size));
    SL_TRY(make_room(a, room_for(png, size)));
    if (a->last == NULL) {
        SL_TRY(a->head == NULL ? keep_head(a, png, size) : SL_OK);
        SL_TRY(sl_image_create(image->width, image->height, image->channels, &a->last));
    }
    write_control(a, &r, ms);
    append_data(a, png, size);
    a->frames++;
    remember(a, image);
cleanup:
    sl_free(png);
    return status;
}

int32_t sl_apng_frames(const sl_apng *animation)
{
    return animation->frames;
}

sl_status sl_apng_encode(const sl_apng *a, uint8_t **data, int64_t *size)
{
    *data = NULL;
    *size = 0;
    if (a->frames == 0) {
        return SL_BAD_INPUT;
    }
    const int64_t header = SIGNATURE + FRAME_OVERHEAD + HEADER, control = FRAME_OVERHEAD + 8;
    uint8_t *file = sl_alloc(a->head_size + control + a->size + FRAME_OVERHEAD, 1), *at = file;
    if (file == NULL) {
        return SL_OUT_OF_MEMORY;
    }
    memcpy(at, a->head, (size_t)header);
    at += header;
    put32(at + 8, (uint32_t)a->frames);
    put32(at + 12, (uint32_t)a->plays);
    at += close_chunk(at, "acTL", 8);
    memcpy(at, a->head + header, (size_t)(a->head_size - header));
    at += a->head_size - header;
    memcpy(at, a->body, (size_t)a->size);
    at += a->size;
    at += close_chunk(at, "IEND", 0);
    *data = file;
    *size = at - file;
    return SL_OK;
}

sl_status sl_apng_write(const char *path, const sl_apng *animation, sl_diag *diag)
{
    sl_status status = SL_OK;
    uint8_t *data = NULL;
    int64_t size = 0;
    sl_writer *writer = NULL;
    SL_TRY(sl_apng_encode(animation, &data, &size));
    SL_TRY(sl_writer_create(path, &writer, diag));
    sl_writer_bytes(writer, data, size);
    SL_TRY(sl_writer_commit(writer, diag));
cleanup:
    sl_free(data);
    return status;
}

void sl_apng_free(sl_apng *animation)
{
    if (animation == NULL) {
        return;
    }
    sl_free(animation->head);
    sl_free(animation->body);
    sl_image_free(animation->last);
    sl_free(animation);
}
