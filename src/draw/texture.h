/* Pictures laid on surfaces: a pyramid of ever smaller versions, so that a sample averages what it covers.
 * Layer: draw. */
#ifndef SL_DRAW_TEXTURE_H
#define SL_DRAW_TEXTURE_H

#include "base/status.h"

enum { SL_TEXTURE_MAX_SIDE = 8192 }; /* texels */

typedef struct sl_texture sl_texture; /* opaque; shared by threads once made */

/* pixels: width x height of `channels` (3 or 4; the fourth is left out) bytes, top row first, borrowed for the call.
 * linear: 256 entries, the light in [0, 1] that each byte stands for; averages are taken of light. SL_BAD_INPUT (a side
 * out of range), SL_OUT_OF_MEMORY. *out is NULL on failure. 8 bytes a texel.
 * Source: Williams 1983, "Pyramidal parametrics". */
SL_NODISCARD sl_status sl_texture_create(int32_t width, int32_t height, int32_t channels, const uint8_t *pixels,
                                         const float linear[256], sl_texture **out);

/* Mean of the texture over the parallelogram of the sides right and below around uv (UV units: the picture fills the
 * unit square, its top row at v = 1, and repeats): trilinear, up to eight samples along the longer side. False, rgb
 * untouched, where a number is not finite or too large to tell texels apart. */
bool sl_texture_sample(const sl_texture *texture, const double uv[2], const double right[2], const double below[2],
                       float rgb[3]);

void sl_texture_free(sl_texture *texture); /* NULL is a no-op */

#endif
