/* How a frame's surfaces take light, for pixels shaded in lanes and for those shaded alone.
 * Layer: render, private. */
#ifndef SL_RENDER_FRAME_LIGHT_H
#define SL_RENDER_FRAME_LIGHT_H

/* Light of a surface: ambient + direct max(0, wrap + (1 - wrap) cosine), on its back a part of that. */
static const float light_ambient = 0.34f, light_direct = 0.62f, light_behind = 0.55f;
static const float light_wrap = 0.25f; /* light reaches this far round the terminator */

/* Light on the checkerboard: middle +- half the difference between light and dark squares. */
static const float check_middle = 0.84f, check_half = 0.16f;
static const float check_rounding = 12582912.0f; /* 1.5 * 2^23: sums with it are whole */
static const float check_widest = 4.0f;          /* squares a pixel; beyond, the mean */
static const float check_least = 1e-4f;
static const float check_farthest = 1e6f; /* squares; beyond, floats cannot tell them apart */

/* light^(1/2.4) = 1 + d (p1 + d (p2 + d p3)), d = sqrt(light) - 1: within 2e-4 where light is above 0.09. */
static const float power_1 = 0.83676715f, power_2 = -0.043682235f, power_3 = 0.07584678f;

#endif
