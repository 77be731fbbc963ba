/* PNG files, by libspng: written without timestamps or text, so the same picture gives the same bytes.
 * Layer: image. */
#ifndef SL_IMAGE_PNG_H
#define SL_IMAGE_PNG_H

#include "image/image.h"

/* Encodes to memory: 8-bit truecolour with or without alpha, tagged sRGB. *data is owned by the caller (sl_free).
 * SL_OUT_OF_MEMORY, SL_INTERNAL (libspng refused a valid picture). */
SL_NODISCARD sl_status sl_png_encode(const sl_image *image, uint8_t **data, int64_t *size);

/* Encodes, then writes the file atomically ("-" = standard output). Those of sl_png_encode, SL_IO. diag is nullable. */
SL_NODISCARD sl_status sl_png_write(const char *path, const sl_image *image, sl_diag *diag);

/* Decodes a PNG of any bit depth and colour type to 8-bit RGB, or RGBA where it has transparency. name stands for the
 * path in messages. SL_BAD_INPUT (not a PNG, damaged, or a side over SL_IMAGE_MAX_SIDE or over 2^28 pixels),
 * SL_OUT_OF_MEMORY. *out is owned by the caller, NULL on failure. diag is nullable. */
SL_NODISCARD sl_status sl_png_decode(const char *name, const uint8_t *data, int64_t size, sl_image **out,
                                     sl_diag *diag);

/* Reads a file and decodes it. Those of sl_png_decode, SL_IO. */
SL_NODISCARD sl_status sl_png_read(const char *path, sl_image **out, sl_diag *diag);

#endif
