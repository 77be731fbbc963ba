#include "image/jpeg.h"
#include "base/file.h"
#include "base/memory.h"
#include "image/png.h"

#include <stdio.h>
#include <turbojpeg.h>

enum { MAX_PIXELS = 1 << 28, MAX_SIDE = 65500 };

static int pixel_format(const sl_image *image)
{
    return image->channels == 4 ? TJPF_RGBX : TJPF_RGB;
}

sl_status sl_jpeg_encode(const sl_image *image, int32_t quality, bool sharp, uint8_t **data, int64_t *size)
{
    sl_status status = SL_OK;
    *data = NULL;
    *size = 0;
    if (quality < 1 || quality > 100) {
        return SL_BAD_INPUT;
    }
    if (image->width > MAX_SIDE || image->height > MAX_SIDE) {
        return SL_LIMIT;
    }
    const int sampling = sharp ? TJSAMP_444 : TJSAMP_420;
    unsigned long length = tjBufSize(image->width, image->height, sampling);
    const tjhandle encoder = tjInitCompress();
    uint8_t *room = sl_alloc((int64_t)length, 1);
    uint8_t *at = room;
    if (encoder == NULL || room == NULL) {
        status = SL_OUT_OF_MEMORY;
        goto cleanup;
    }
    if (tjCompress2(encoder, image->pixels, image->width, 0, image->height, pixel_format(image), &at, &length, sampling,
                    quality, TJFLAG_NOREALLOC) != 0) {
        status = SL_INTERNAL;
        goto cleanup;
    }
    *data = room;
    *size = (int64_t)length;
    room = NULL;
cleanup:
    sl_free(room);
    if (encoder != NULL) {
        tjDestroy(encoder);
    }
    return status;
}

sl_status sl_jpeg_write(const char *path, const sl_image *image, int32_t quality, bool sharp, sl_diag *diag)
{
    sl_status status = SL_OK;
    uint8_t *data = NULL;
    int64_t size = 0;
    sl_writer *writer = NULL;
    SL_TRY(sl_jpeg_encode(image, quality, sharp, &data, &size));
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
        sl_diag_hint(diag, "give a whole JPEG or PNG picture of at most %d pixels", (int)MAX_PIXELS);
    }
    return SL_BAD_INPUT;
}

sl_status sl_jpeg_decode(const char *name, const uint8_t *data, int64_t size, sl_image **out, sl_diag *diag)
{
    sl_status status = SL_OK;
    sl_image *image = NULL;
    int width = 0, height = 0, sampling = 0, space = 0;
    *out = NULL;
    const tjhandle decoder = tjInitDecompress();
    if (decoder == NULL) {
        return SL_OUT_OF_MEMORY;
    }
    if (tjDecompressHeader3(decoder, data, (unsigned long)size, &width, &height, &sampling, &space) != 0) {
        status = refuse(diag, name, tjGetErrorStr2(decoder));
        goto cleanup;
    }
    if (width < 1 || height < 1 || (int64_t)width * height > MAX_PIXELS) {
        status = refuse(diag, name, "the picture is too large, or empty");
        goto cleanup;
    }
    SL_TRY(sl_image_create(width, height, 3, &image));
    /* Warnings count: a picture cut short decodes to grey with no more than one. */
    if (tjDecompress2(decoder, data, (unsigned long)size, image->pixels, width, 0, height, TJPF_RGB,
                      TJFLAG_STOPONWARNING | TJFLAG_LIMITSCANS) != 0) {
        status = refuse(diag, name, tjGetErrorStr2(decoder));
        goto cleanup;
    }
    *out = image;
    image = NULL;
cleanup:
    sl_image_free(image);
    tjDestroy(decoder);
    return status;
}

bool sl_jpeg_recognise(const uint8_t *data, int64_t size)
{
    return size >= 3 && data[0] == 0xff && data[1] == 0xd8 && data[2] == 0xff;
}

sl_status sl_picture_read(const char *path, sl_image **out, sl_diag *diag)
{
    char *data = NULL;
    int64_t size = 0;
    *out = NULL;
    sl_status status = sl_file_read(path, &data, &size, diag);
    const uint8_t *bytes = (const uint8_t *)data;
    if (status == SL_OK) {
        status = sl_jpeg_recognise(bytes, size) ? sl_jpeg_decode(path, bytes, size, out, diag)
                                                : sl_png_decode(path, bytes, size, out, diag);
    }
    sl_free(data);
    return status;
}
