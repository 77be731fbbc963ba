#include "image/color.h"

#include <math.h>
#include <stdbool.h>

static const double degree = 0.017453292519943295;
static const int gamut_bisections = 24; /* chroma to 1e-8 */

static double clamp01(double x)
{
    return x > 0.0 ? (x < 1.0 ? x : 1.0) : 0.0; /* NaN compares false: 0 */
}

double sl_srgb_to_linear(double encoded)
{
    const double x = clamp01(encoded);
    return x <= 0.04045 ? x / 12.92 : pow((x + 0.055) / 1.055, 2.4);
}

double sl_srgb_from_linear(double linear)
{
    const double x = clamp01(linear);
    return x <= 0.0031308 ? 12.92 * x : 1.055 * pow(x, 1.0 / 2.4) - 0.055;
}

void sl_rgb_to_linear(const uint8_t rgb[3], float linear[3])
{
    for (int k = 0; k < 3; k++) {
        linear[k] = (float)sl_srgb_to_linear(rgb[k] / 255.0);
    }
}

void sl_rgb_from_linear(const float linear[3], uint8_t rgb[3])
{
    for (int k = 0; k < 3; k++) {
        rgb[k] = (uint8_t)(255.0 * sl_srgb_from_linear((double)linear[k]) + 0.5);
    }
}

enum { GUESSES = 1024 };

/* Smallest float whose nearest byte is `byte`. The rounding in sl_rgb_from_linear decides, so the search is on floats.
 */
static float least_of_byte(int byte)
{
    float below = -1.0f, at = 1.0f;
    for (int i = 0; i < 64; i++) {
        const float middle = 0.5f * (below + at);
        const float grey[3] = {middle, middle, middle};
        uint8_t rgb[3];
        sl_rgb_from_linear(grey, rgb);
        if (rgb[0] >= byte) {
            at = middle;
        } else {
            below = middle;
        }
    }
    return at;
}

void sl_pixels_from_linear(int64_t count, const float *linear, uint8_t *rgb)
{
    float least[257];
    uint8_t guess[GUESSES + 1];
    for (int b = 1; b < 256; b++) {
        least[b] = least_of_byte(b);
    }
    least[0] = -1.0f;
    least[256] = 2.0f;
    for (int i = 0, b = 0; i <= GUESSES; i++) {
        while (b < 255 && least[b + 1] <= (float)i / GUESSES) {
            b++;
        }
        guess[i] = (uint8_t)b;
    }
    for (int64_t i = 0; i < 3 * count; i++) {
        const float x = linear[i] > 0.0f ? (linear[i] < 1.0f ? linear[i] : 1.0f) : 0.0f;
        int b = guess[(int)(x * GUESSES)];
        while (x >= least[b + 1]) {
            b++;
        }
        rgb[i] = (uint8_t)b;
    }
}

void sl_oklab_from_linear(const double rgb[3], double lab[3])
{
    const double l = cbrt(0.4122214708 * rgb[0] + 0.5363325363 * rgb[1] + 0.0514459929 * rgb[2]);
    const double m = cbrt(0.2119034982 * rgb[0] + 0.6806995451 * rgb[1] + 0.1073969566 * rgb[2]);
    const double s = cbrt(0.0883024619 * rgb[0] + 0.2817188376 * rgb[1] + 0.6299787005 * rgb[2]);
    lab[0] = 0.2104542553 * l + 0.7936177850 * m - 0.0040720468 * s;
    lab[1] = 1.9779984951 * l - 2.4285922050 * m + 0.4505937099 * s;
    lab[2] = 0.0259040371 * l + 0.7827717662 * m - 0.8086757660 * s;
}

void sl_oklab_to_linear(const double lab[3], double rgb[3])
{
    const double l = lab[0] + 0.3963377774 * lab[1] + 0.2158037573 * lab[2];
    const double m = lab[0] - 0.1055613458 * lab[1] - 0.0638541728 * lab[2];
    const double s = lab[0] - 0.0894841775 * lab[1] - 1.2914855480 * lab[2];
    const double l3 = l * l * l, m3 = m * m * m, s3 = s * s * s;
    rgb[0] = 4.0767416621 * l3 - 3.3077115913 * m3 + 0.2309699292 * s3;
    rgb[1] = -1.2684380046 * l3 + 2.6097574011 * m3 - 0.3413193965 * s3;
    rgb[2] = -0.0041960863 * l3 - 0.7034186147 * m3 + 1.7076147010 * s3;
}

static bool convert_polar(double lightness, double chroma, double hue, double rgb[3])
{
    const double slack = 1e-6; /* white and black sit on the border of the gamut */
    const double lab[3] = {lightness, chroma * cos(hue * degree), chroma * sin(hue * degree)};
    sl_oklab_to_linear(lab, rgb);
    bool inside = true;
    for (int k = 0; k < 3; k++) {
        inside = inside && rgb[k] >= -slack && rgb[k] <= 1.0 + slack;
    }
    return inside;
}

void sl_oklch_to_linear(double lightness, double chroma, double hue, double rgb[3])
{
    if (!convert_polar(lightness, chroma, hue, rgb)) {
        double inside = 0.0, outside = chroma;
        for (int i = 0; i < gamut_bisections; i++) {
            const double middle = 0.5 * (inside + outside);
            if (convert_polar(lightness, middle, hue, rgb)) {
                inside = middle;
            } else {
                outside = middle;
            }
        }
        convert_polar(lightness, inside, hue, rgb);
    }
    for (int k = 0; k < 3; k++) {
        rgb[k] = clamp01(rgb[k]);
    }
}

double sl_color_distance(const uint8_t a[3], const uint8_t b[3])
{
    double lab[2][3];
    for (int i = 0; i < 2; i++) {
        float linear[3];
        sl_rgb_to_linear(i == 0 ? a : b, linear);
        const double rgb[3] = {(double)linear[0], (double)linear[1], (double)linear[2]};
        sl_oklab_from_linear(rgb, lab[i]);
    }
    return sqrt((lab[0][0] - lab[1][0]) * (lab[0][0] - lab[1][0]) + (lab[0][1] - lab[1][1]) * (lab[0][1] - lab[1][1]) +
                (lab[0][2] - lab[1][2]) * (lab[0][2] - lab[1][2]));
}
