/* A picture in linear light while it is being made: strokes and text are blended here, as light mixes.
 * Layer: draw. */
#ifndef SL_DRAW_CANVAS_H
#define SL_DRAW_CANVAS_H

#include "draw/mask.h"

/* Row-major, top row first. */
typedef struct sl_canvas {
    int32_t width, height;
    float *rgb; /* 3 * width * height, linear light; owned */
} sl_canvas;

/* SL_BAD_INPUT (a side < 1 or > SL_SCREEN_MAX_SIDE), SL_OUT_OF_MEMORY. */
SL_NODISCARD sl_status sl_canvas_create(int32_t width, int32_t height, const float rgb[3], sl_canvas **out);

void sl_canvas_free(sl_canvas *canvas); /* NULL is a no-op */

/* rgb over the canvas where the mask is, times opacity in [0, 1]; mask samples are canvas pixels. */
void sl_canvas_blend(sl_canvas *canvas, const sl_mask *mask, const float rgb[3], float opacity);

/* The same onto bare samples of the mask's own window (3 floats a sample). */
void sl_blend_samples(float *samples, const sl_mask *mask, const float rgb[3], float opacity);

/* Writes rows [row, row + rows) of the canvas as the mean of scale x scale blocks of samples; samples has
 * canvas->width * scale columns and rows * scale rows. */
void sl_canvas_reduce(sl_canvas *canvas, int32_t row, int32_t rows, int32_t scale, const float *samples);

#endif
