/* libFuzzer target: bytes are decoded as PNG and as JPEG; what decodes is encoded and decoded again, and put into an
 * animation. Anything but a status, or another picture than the one given, is a finding. See meson.build. */
#include "base/memory.h"
#include "image/apng.h"
#include "image/jpeg.h"
#include "image/png.h"

#include <stdlib.h>
#include <string.h>

enum { MOST_PIXELS = 1 << 16 }; /* encoded again: larger ones take too long */

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

static void demand(bool good)
{
    if (!good) {
        abort();
    }
}

static bool same(const sl_image *a, const sl_image *b)
{
    return a->width == b->width && a->height == b->height && a->channels == b->channels &&
           memcmp(a->pixels, b->pixels, (size_t)a->width * (size_t)a->height * (size_t)a->channels) == 0;
}

static void encode_again(const sl_image *image)
{
    uint8_t *png = NULL;
    int64_t size = 0;
    sl_image *back = NULL;
    sl_apng *animation = NULL;
    demand(sl_png_encode(image, &png, &size) == SL_OK);
    demand(sl_png_decode("again", png, size, &back, NULL) == SL_OK && same(image, back));
    sl_free(png);
    png = NULL;
    back->pixels[0] ^= 255;
    demand(sl_apng_create(0, &animation) == SL_OK);
    demand(sl_apng_add(animation, image, 10) == SL_OK && sl_apng_add(animation, back, 20) == SL_OK);
    sl_image_free(back);
    demand(sl_apng_encode(animation, &png, &size) == SL_OK);
    demand(sl_png_decode("animation", png, size, &back, NULL) == SL_OK && same(image, back));
    sl_image_free(back);
    sl_apng_free(animation);
    sl_free(png);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    for (int k = 0; k < 2; k++) {
        sl_image *image = NULL;
        sl_diag diag = sl_diag_none();
        const sl_status status = k == 0 ? sl_png_decode("fuzz", data, (int64_t)size, &image, &diag)
                                        : sl_jpeg_decode("fuzz", data, (int64_t)size, &image, &diag);
        demand((status == SL_OK) == (image != NULL));
        demand(status != SL_BAD_INPUT || diag.reason[0] != '\0');
        if (image != NULL && (int64_t)image->width * image->height <= MOST_PIXELS) {
            encode_again(image);
        }
        sl_image_free(image);
    }
    return 0;
}
