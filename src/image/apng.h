/* Animated PNG files: frames as libspng encodes single pictures, their image data put into animation chunks.
 * Layer: image. */
#ifndef SL_IMAGE_APNG_H
#define SL_IMAGE_APNG_H

#include "image/image.h"

enum { SL_APNG_MAX_MS = 65535 }; /* longest time of one frame */

/* An animation being made; frames are kept as compressed bytes only, and the last one's pixels. */
typedef struct sl_apng sl_apng; /* opaque */

/* plays: how often the animation runs, 0 = for ever. SL_BAD_INPUT (plays < 0), SL_OUT_OF_MEMORY. *out is owned by the
 * caller, NULL on failure. */
SL_NODISCARD sl_status sl_apng_create(int32_t plays, sl_apng **out);

/* Adds a picture, shown for ms milliseconds (1 to SL_APNG_MAX_MS). All pictures are as large as the first and have its
 * channels. Only the rectangle that differs from the frame before is stored; a picture equal to it makes that frame
 * last longer where the sum of the times allows. Without the chunks of the animation the file is an ordinary PNG of the
 * first picture. SL_BAD_INPUT (time, size or channels; nothing is added), SL_OUT_OF_MEMORY, SL_INTERNAL (libspng). */
SL_NODISCARD sl_status sl_apng_add(sl_apng *animation, const sl_image *image, int32_t ms);

/* Frames stored so far. */
int32_t sl_apng_frames(const sl_apng *animation);

/* The whole file. *data is owned by the caller (sl_free). The same pictures give the same bytes. SL_BAD_INPUT (no
 * frame), SL_OUT_OF_MEMORY. Source: W3C, "Portable Network Graphics (PNG) Specification (Third Edition)", Sec. 11.3.6.
 */
SL_NODISCARD sl_status sl_apng_encode(const sl_apng *animation, uint8_t **data, int64_t *size);

/* Encodes, then writes the file atomically ("-" = standard output). Those of sl_apng_encode, SL_IO. diag is nullable.
 */
SL_NODISCARD sl_status sl_apng_write(const char *path, const sl_apng *animation, sl_diag *diag);

void sl_apng_free(sl_apng *animation); /* NULL is a no-op */

#endif
