#include "image/colormap.h"
#include "base/status.h"
#include "image/color.h"

#include <math.h>
#include <stddef.h>

/* A point of a map in OKLCH: the maps are linear in L between even steps of t, so lightness is monotone by design. */
typedef struct stop {
    double lightness, chroma, hue;
} stop;

/* Hue runs from violet-blue over teal and green to yellow, as in viridis (van der Walt and Smith 2015). */
static const stop sequential[] = {{0.27, 0.100, 312}, {0.35, 0.112, 289}, {0.43, 0.100, 262},
                                  {0.51, 0.090, 230}, {0.59, 0.098, 190}, {0.67, 0.130, 160},
                                  {0.75, 0.165, 140}, {0.83, 0.180, 122}, {0.91, 0.185, 106}};
static const stop blues[] = {{0.965, 0.006, 250}, {0.85, 0.060, 246}, {0.73, 0.105, 248},
                             {0.61, 0.140, 253},  {0.50, 0.155, 259}, {0.40, 0.140, 264}};
static const stop reds[] = {{0.965, 0.006, 40}, {0.85, 0.075, 42}, {0.73, 0.125, 36},
                            {0.61, 0.170, 30},  {0.50, 0.170, 27}, {0.40, 0.145, 24}};
static const stop heat[] = {{0.97, 0.020, 95}, {0.88, 0.100, 85}, {0.78, 0.150, 68}, {0.68, 0.175, 50},
                            {0.57, 0.180, 32}, {0.45, 0.150, 20}, {0.33, 0.100, 10}};

/* By hand: twelve colours with neighbours far apart. */
static const stop palette[] = {{0.76, 0.100, 250}, {0.86, 0.115, 82},  {0.80, 0.115, 152}, {0.74, 0.130, 26},
                               {0.80, 0.090, 305}, {0.88, 0.120, 114}, {0.83, 0.085, 200}, {0.79, 0.110, 352},
                               {0.71, 0.095, 278}, {0.82, 0.110, 56},  {0.75, 0.080, 175}, {0.89, 0.060, 228}};
static const double levels[] = {0.79, 0.87, 0.71};
static const double golden_angle = 137.50776405003785;
static const double first_hue = 21.0;
static const double palette_chroma = 0.105;

static stop between(const stop *stops, int32_t count, double t)
{
    const double x = t * (count - 1);
    const int32_t i = x < count - 1 ? (int32_t)x : count - 2;
    const double f = x - i;
    const stop a = stops[i], b = stops[i + 1];
    return (stop){a.lightness + f * (b.lightness - a.lightness), a.chroma + f * (b.chroma - a.chroma),
                  a.hue + f * (b.hue - a.hue)};
}

static stop sample(sl_colormap map, double t)
{
    switch (map) {
    case SL_COLORMAP_DIVERGING:
        return t < 0.5 ? between(blues, (int32_t)SL_COUNTOF(blues), 1.0 - 2.0 * t)
                       : between(reds, (int32_t)SL_COUNTOF(reds), 2.0 * t - 1.0);
    case SL_COLORMAP_HEAT:
        return between(heat, (int32_t)SL_COUNTOF(heat), t);
    case SL_COLORMAP_SEQUENTIAL:
        break;
    }
    return between(sequential, (int32_t)SL_COUNTOF(sequential), t);
}

static void stop_to_linear(stop s, float linear[3])
{
    double rgb[3];
    sl_oklch_to_linear(s.lightness, s.chroma, s.hue, rgb);
    for (int k = 0; k < 3; k++) {
        linear[k] = (float)rgb[k];
    }
}

void sl_colormap_sample(sl_colormap map, double t, uint8_t rgb[3])
{
    static const stop missing = {0.62, 0.0, 0.0};
    float linear[3];
    stop_to_linear(isnan(t) ? missing : sample(map, fmin(fmax(t, 0.0), 1.0)), linear);
    sl_rgb_from_linear(linear, rgb);
}

void sl_colormap_table(sl_colormap map, int32_t count, float *linear)
{
    for (int32_t i = 0; i < count; i++) {
        stop_to_linear(sample(map, (double)i / (count - 1)), linear + (size_t)(3 * i));
    }
}

void sl_palette_color(int32_t i, uint8_t rgb[3])
{
    const int32_t by_hand = (int32_t)SL_COUNTOF(palette);
    stop s;
    if (i < by_hand) {
        s = palette[i];
    } else {
        const int32_t k = i - by_hand;
        s = (stop){levels[k % 3], palette_chroma, fmod(first_hue + golden_angle * k, 360.0)};
    }
    float linear[3];
    stop_to_linear(s, linear);
    sl_rgb_from_linear(linear, rgb);
}
