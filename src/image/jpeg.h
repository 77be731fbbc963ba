/* JPEG files, by libturbojpeg: frames that travel, textures that come from cameras.
 * Layer: image. */
#ifndef SL_IMAGE_JPEG_H
#define SL_IMAGE_JPEG_H

#include "image/image.h"

enum { SL_JPEG_QUALITY = 90 }; /* the quality pictures are written with unless something else is asked for */

/* Encodes to memory, alpha left out. quality: 1 to 100. sharp: colours at full resolution (4:4:4: text and thin lines
 * keep their colour), else at half (4:2:0: two thirds of the time and bytes). *data is owned by the caller (sl_free).
 * SL_BAD_INPUT (quality), SL_OUT_OF_MEMORY, SL_LIMIT (a side over 65500: the format ends there). */
SL_NODISCARD sl_status sl_jpeg_encode(const sl_image *image, int32_t quality, bool sharp, uint8_t **data,
                                      int64_t *size);

/* Encodes, then writes the file atomically ("-" = standard output). Those of sl_jpeg_encode, SL_IO. diag: nullable. */
SL_NODISCARD sl_status sl_jpeg_write(const char *path, const sl_image *image, int32_t quality, bool sharp,
                                     sl_diag *diag);

/* Decodes a baseline or progressive JPEG to RGB. name stands for the path in messages. SL_BAD_INPUT (no JPEG, damaged,
 * over 2^28 pixels), SL_OUT_OF_MEMORY. *out is owned by the caller, NULL on failure. diag: nullable. */
SL_NODISCARD sl_status sl_jpeg_decode(const char *name, const uint8_t *data, int64_t size, sl_image **out,
                                      sl_diag *diag);

/* Do the bytes begin as a JPEG does? */
bool sl_jpeg_recognise(const uint8_t *data, int64_t size);

/* Reads a picture, PNG or JPEG as its content says. Those of the decoders, SL_IO. */
SL_NODISCARD sl_status sl_picture_read(const char *path, sl_image **out, sl_diag *diag);

#endif
