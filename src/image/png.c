#include "image/png.h"
#include "base/file.h"
#include "base/memory.h"

#include <spng.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum {
    COMPRESSION_LEVEL = 6,
    INTENT_PERCEPTUAL = 0, /* sRGB chunk */
    MAX_PIXELS = 1 << 28,  /* refused beyond: 1 GB of RGBA */
    CHUNK_LIMIT = 1 << 24  /* bytes of one chunk that is not image data */
};

/* libspng's own growing buffer comes from malloc; copying it lets callers free everything with sl_free. */
static sl_status take_encoded(spng_ctx *encoder, uint8_t **data, int64_t *size)
{
    int error = 0;
    size_t length = 0;
    void *bytes = spng_get_png_buffer(encoder, &length, &error);
    if (bytes == NULL) {
        return error == SPNG_EMEM ? SL_OUT_OF_MEMORY : SL_INTERNAL;
    }
    *data = sl_copy(bytes, (int64_t)length, 1);
    *size = (int64_t)length;
    free(bytes);
    return *data != NULL ? SL_OK : SL_OUT_OF_MEMORY;
}

static int encode(spng_ctx *encoder, const sl_image *image)
{
    struct spng_ihdr header = {
        .width = (uint32_t)image->width,
        .height = (uint32_t)image->height,
        .bit_depth = 8,
        .color_type = (uint8_t)(image->channels == 4 ? SPNG_COLOR_TYPE_TRUECOLOR_ALPHA : SPNG_COLOR_TYPE_TRUECOLOR)};
    const size_t length = (size_t)image->width * (size_t)image->height * (size_t)image->channels;
    int error = spng_set_option(encoder, SPNG_ENCODE_TO_BUFFER, 1);
    error = error != 0 ? error : spng_set_option(encoder, SPNG_IMG_COMPRESSION_LEVEL, COMPRESSION_LEVEL);
    error = error != 0 ? error : spng_set_ihdr(encoder, &header);
    error = error != 0 ? error : spng_set_srgb(encoder, INTENT_PERCEPTUAL);
    return error != 0 ? error : spng_encode_image(encoder, image->pixels, length, SPNG_FMT_PNG, SPNG_ENCODE_FINALIZE);
}

sl_status sl_png_encode(const sl_image *image, uint8_t **data, int64_t *size)
{
    *data = NULL;
    *size = 0;
    spng_ctx *encoder = spng_ctx_new(SPNG_CTX_ENCODER);
    if (encoder == NULL) {
        return SL_OUT_OF_MEMORY;
    }
    const int error = encode(encoder, image);
    sl_status status = error == 0 ? SL_OK : error == SPNG_EMEM ? SL_OUT_OF_MEMORY : SL_INTERNAL;
    if (status == SL_OK) {
        status = take_encoded(encoder, data, size);
    }
    spng_ctx_free(encoder);
    return status;
}

sl_status sl_png_write(const char *path, const sl_image *image, sl_diag *diag)
{
    sl_status status = SL_OK;
    uint8_t *data = NULL;
    int64_t size = 0;
    sl_writer *writer = NULL;
    SL_TRY(sl_png_encode(image, &data, &size));
    SL_TRY(sl_writer_create(path, &writer, diag));
    sl_writer_bytes(writer, data, size);
    SL_TRY(sl_writer_commit(writer, diag));
cleanup:
    sl_free(data);
    return status;
}

static sl_status refuse(sl_diag *diag, const char *name, const char *reason)
{
    if (diag != NULL) {
        *diag = sl_diag_none();
        snprintf(diag->file, sizeof diag->file, "%s", name);
        sl_diag_reason(diag, "%s", reason);
        sl_diag_hint(diag, "give a PNG picture of at most %d pixels", (int)MAX_PIXELS);
    }
    return SL_BAD_INPUT;
}

static int start_decoding(spng_ctx *decoder, const uint8_t *data, int64_t size, struct spng_ihdr *header,
                          bool *transparent)
{
    int error = spng_set_image_limits(decoder, SL_IMAGE_MAX_SIDE, SL_IMAGE_MAX_SIDE);
    error = error != 0 ? error : spng_set_chunk_limits(decoder, CHUNK_LIMIT, CHUNK_LIMIT);
    error = error != 0 ? error : spng_set_png_buffer(decoder, data, (size_t)size);
    error = error != 0 ? error : spng_get_ihdr(decoder, header);
    if (error == 0) {
        struct spng_trns key;
        const int found = spng_get_trns(decoder, &key);
        *transparent = found == 0 || (header->color_type & 4) != 0;
        error = found == SPNG_ECHUNKAVAIL ? 0 : found;
    }
    return error;
}

sl_status sl_png_decode(const char *name, const uint8_t *data, int64_t size, sl_image **out, sl_diag *diag)
{
    sl_status status = SL_OK;
    sl_image *image = NULL;
    struct spng_ihdr header = {0};
    bool transparent = false;
    *out = NULL;
    spng_ctx *decoder = spng_ctx_new(0);
    if (decoder == NULL) {
        return SL_OUT_OF_MEMORY;
    }
    int error = start_decoding(decoder, data, size, &header, &transparent);
    if (error == 0 && (int64_t)header.width * header.height > MAX_PIXELS) {
        error = SPNG_EUSER_WIDTH;
    }
    if (error == 0) {
        SL_TRY(sl_image_create((int32_t)header.width, (int32_t)header.height, transparent ? 4 : 3, &image));
        const size_t length = (size_t)image->width * (size_t)image->height * (size_t)image->channels;
        error = spng_decode_image(decoder, image->pixels, length, transparent ? SPNG_FMT_RGBA8 : SPNG_FMT_RGB8,
                                  transparent ? SPNG_DECODE_TRNS : 0);
    }
    if (error != 0) {
        status = error == SPNG_EMEM ? SL_OUT_OF_MEMORY : refuse(diag, name, spng_strerror(error));
        goto cleanup;
    }
    *out = image;
    image = NULL;
cleanup:
    sl_image_free(image);
    spng_ctx_free(decoder);
    return status;
}

sl_status sl_png_read(const char *path, sl_image **out, sl_diag *diag)
{
    char *data = NULL;
    int64_t size = 0;
    *out = NULL;
    sl_status status = sl_file_read(path, &data, &size, diag);
    if (status == SL_OK) {
        status = sl_png_decode(path, (const uint8_t *)data, size, out, diag);
    }
    sl_free(data);
    return status;
}
