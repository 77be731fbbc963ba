/* Colour maps of numbers and palettes of labels.
 * Layer: image. */
#ifndef SL_IMAGE_COLORMAP_H
#define SL_IMAGE_COLORMAP_H

#include <stdint.h>

typedef enum sl_colormap {
    SL_COLORMAP_SEQUENTIAL, /* dark blue - teal - green - yellow; lightness rises evenly: amounts */
    SL_COLORMAP_DIVERGING,  /* blue - white - red; lightness symmetric about the middle: signed values */
    SL_COLORMAP_HEAT,       /* white - amber - red - dark; lightness falls evenly: error, distortion */
} sl_colormap;

/* Colour at t in [0, 1] (clamped) as sRGB bytes. NaN gives a mid grey that no map contains. */
void sl_colormap_sample(sl_colormap map, double t, uint8_t rgb[3]);

/* count >= 2 colours at even steps from t = 0 to 1, as linear light, 3 floats each. */
void sl_colormap_table(sl_colormap map, int32_t count, float *linear);

/* Colour of label i >= 0, as sRGB bytes: pleasant, of middle lightness (dark lines and white text both read on it).
 * The first 12 are chosen by hand for distance; the rest go round the hue circle by the golden angle on three
 * lightness levels, so that near numbers look different and no colour returns within some hundreds of labels. */
void sl_palette_color(int32_t i, uint8_t rgb[3]);

#endif
