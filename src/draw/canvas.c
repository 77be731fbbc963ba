#include "draw/canvas.h"
#include "base/memory.h"

sl_status sl_canvas_create(int32_t width, int32_t height, const float rgb[3], sl_canvas **out)
{
    *out = NULL;
    if (width < 1 || height < 1 || width > SL_SCREEN_MAX_SIDE || height > SL_SCREEN_MAX_SIDE) {
        return SL_BAD_INPUT;
    }
    const int64_t count = (int64_t)width * height;
    sl_canvas *canvas = sl_alloc(1, sizeof *canvas);
    float *pixels = sl_alloc(count, 3 * sizeof *pixels);
    if (canvas == NULL || pixels == NULL) {
        sl_free(canvas);
        sl_free(pixels);
        return SL_OUT_OF_MEMORY;
    }
    for (int64_t i = 0; i < count; i++) {
        for (int k = 0; k < 3; k++) {
            pixels[3 * i + k] = rgb[k];
        }
    }
    *canvas = (sl_canvas){width, height, pixels};
    *out = canvas;
    return SL_OK;
}

void sl_canvas_free(sl_canvas *canvas)
{
    if (canvas != NULL) {
        sl_free(canvas->rgb);
        sl_free(canvas);
    }
}

static void mix(float *at, const float rgb[3], float amount)
{
    for (int k = 0; k < 3; k++) {
        at[k] += amount * (rgb[k] - at[k]);
    }
}

void sl_canvas_blend(sl_canvas *canvas, const sl_mask *mask, const float rgb[3], float opacity)
{
    for (int32_t y = 0; y < mask->height; y++) {
        for (int32_t x = 0; x < mask->width; x++) {
            const float amount = opacity * mask->coverage[(int64_t)y * mask->width + x];
            const int32_t cx = mask->x0 + x, cy = mask->y0 + y;
            if (amount > 0.0f && cx >= 0 && cy >= 0 && cx < canvas->width && cy < canvas->height) {
                mix(canvas->rgb + 3 * ((int64_t)cy * canvas->width + cx), rgb, amount);
            }
        }
    }
}

void sl_blend_samples(float *samples, const sl_mask *mask, const float rgb[3], float opacity)
{
    const int64_t count = (int64_t)mask->width * mask->height;
    for (int64_t i = 0; i < count; i++) {
        if (mask->coverage[i] > 0.0f) {
            mix(samples + 3 * i, rgb, opacity * mask->coverage[i]);
        }
    }
}

void sl_canvas_reduce(sl_canvas *canvas, int32_t row, int32_t rows, int32_t scale, const float *samples)
{
    const int64_t columns = (int64_t)canvas->width * scale;
    const float weight = 1.0f / (float)(scale * scale);
    for (int32_t y = 0; y < rows; y++) {
        for (int32_t x = 0; x < canvas->width; x++) {
            float sum[3] = {0.0f, 0.0f, 0.0f};
            for (int32_t j = 0; j < scale; j++) {
                const float *from = samples + 3 * (((int64_t)y * scale + j) * columns + (int64_t)x * scale);
                for (int32_t i = 0; i < 3 * scale; i++) {
                    sum[i % 3] += from[i];
                }
            }
            float *to = canvas->rgb + 3 * ((int64_t)(row + y) * canvas->width + x);
            for (int k = 0; k < 3; k++) {
                to[k] = weight * sum[k];
            }
        }
    }
}
