/* Pictures of 8-bit sRGB pixels.
 * Layer: image (may include base). */
#ifndef SL_IMAGE_IMAGE_H
#define SL_IMAGE_IMAGE_H

#include "base/status.h"

enum { SL_IMAGE_MAX_SIDE = 1 << 16 }; /* pixels; larger sides are refused */

/* Row-major, top row first, no padding between rows. Colours are sRGB-encoded; alpha (if any) is linear, not
 * premultiplied. */
typedef struct sl_image {
    int32_t width, height; /* 1 .. SL_IMAGE_MAX_SIDE */
    int32_t channels;      /* 3 = RGB, 4 = RGBA */
    uint8_t *pixels;       /* width * height * channels */
} sl_image;

/* A picture of zero bytes. SL_BAD_INPUT (a side or the number of channels out of range), SL_OUT_OF_MEMORY. *out is
 * owned by the caller, NULL on failure. */
SL_NODISCARD sl_status sl_image_create(int32_t width, int32_t height, int32_t channels, sl_image **out);

void sl_image_free(sl_image *image); /* NULL is a no-op */

/* First byte of pixel (x, y); 0 <= x < width, 0 <= y < height. */
static inline uint8_t *sl_image_pixel(const sl_image *image, int32_t x, int32_t y)
{
    return image->pixels + ((int64_t)y * image->width + x) * image->channels;
}

/* Gives every pixel one colour; an alpha channel becomes opaque. */
void sl_image_fill(sl_image *image, const uint8_t rgb[3]);

/* Copies source into target with its top left corner at (x, y); what falls outside is left out. Channels may differ:
 * alpha is dropped (not blended) or set opaque. source and target must not be the same picture. */
void sl_image_paste(sl_image *target, const sl_image *source, int32_t x, int32_t y);

#endif
