#include "image/image.h"
#include "base/memory.h"

#include <string.h>

static bool side_is_valid(int32_t side)
{
    return side >= 1 && side <= SL_IMAGE_MAX_SIDE;
}

sl_status sl_image_create(int32_t width, int32_t height, int32_t channels, sl_image **out)
{
    *out = NULL;
    if (!side_is_valid(width) || !side_is_valid(height) || (channels != 3 && channels != 4)) {
        return SL_BAD_INPUT;
    }
    sl_image *image = sl_alloc(1, sizeof *image);
    uint8_t *pixels = sl_calloc((int64_t)width * height, (size_t)channels);
    if (image == NULL || pixels == NULL) {
        sl_free(image);
        sl_free(pixels);
        return SL_OUT_OF_MEMORY;
    }
    *image = (sl_image){width, height, channels, pixels};
    *out = image;
    return SL_OK;
}

void sl_image_free(sl_image *image)
{
    if (image != NULL) {
        sl_free(image->pixels);
        sl_free(image);
    }
}

static void set_pixel(uint8_t *to, int32_t channels, const uint8_t *rgb, uint8_t alpha)
{
    memcpy(to, rgb, 3);
    if (channels == 4) {
        to[3] = alpha;
    }
}

void sl_image_fill(sl_image *image, const uint8_t rgb[3])
{
    for (int32_t y = 0; y < image->height; y++) {
        for (int32_t x = 0; x < image->width; x++) {
            set_pixel(sl_image_pixel(image, x, y), image->channels, rgb, 255);
        }
    }
}

/* The part [*begin, *end) of a source of `count` pixels that lands inside `room` when it starts at `at`. */
static void clip_range(int32_t at, int32_t count, int32_t room, int32_t *begin, int32_t *end)
{
    const int64_t last = (int64_t)room - at;
    *begin = at < 0 ? (at <= -count ? count : -at) : 0;
    *end = last < count ? (last > 0 ? (int32_t)last : 0) : count;
}

void sl_image_paste(sl_image *target, const sl_image *source, int32_t x, int32_t y)
{
    int32_t x0, x1, y0, y1;
    clip_range(x, source->width, target->width, &x0, &x1);
    clip_range(y, source->height, target->height, &y0, &y1);
    for (int32_t r = y0; r < y1; r++) {
        for (int32_t c = x0; c < x1; c++) {
            const uint8_t *from = sl_image_pixel(source, c, r);
            set_pixel(sl_image_pixel(target, x + c, y + r), target->channels, from,
                      source->channels == 4 ? from[3] : 255);
        }
    }
}
