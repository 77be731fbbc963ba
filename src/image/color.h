/* Colours: sRGB bytes, linear light, and OKLab, in which equal steps look equal.
 * Layer: image. */
#ifndef SL_IMAGE_COLOR_H
#define SL_IMAGE_COLOR_H

#include <stdint.h>

/* Linear light in [0, 1] of an sRGB-encoded value in [0, 1], and back; both clamp, NaN gives 0.
 * Source: IEC 61966-2-1. */
double sl_srgb_to_linear(double encoded);
double sl_srgb_from_linear(double linear);

/* Linear RGB of sRGB bytes. */
void sl_rgb_to_linear(const uint8_t rgb[3], float linear[3]);

/* Nearest sRGB bytes of linear RGB; clamps, NaN gives 0. */
void sl_rgb_from_linear(const float linear[3], uint8_t rgb[3]);

/* As sl_rgb_from_linear for a whole picture of `count` colours, by table; the same bytes. */
void sl_pixels_from_linear(int64_t count, const float *linear, uint8_t *rgb);

/* OKLab (L in [0, 1], a, b about [-0.4, 0.4]) of linear RGB, and back (unclamped: may leave [0, 1] outside the gamut).
 * Source: Ottosson 2020, "A perceptual color space for image processing". */
void sl_oklab_from_linear(const double rgb[3], double lab[3]);
void sl_oklab_to_linear(const double lab[3], double rgb[3]);

/* OKLCH (lightness, chroma, hue in degrees) to linear RGB in [0, 1]; chroma is lowered where the gamut ends, so that
 * lightness and hue stand. */
void sl_oklch_to_linear(double lightness, double chroma, double hue, double rgb[3]);

/* Distance of two sRGB colours in OKLab; 0.02 is about one just noticeable difference. */
double sl_color_distance(const uint8_t a[3], const uint8_t b[3]);

#endif
