#include "draw/texture.h"
#include "base/memory.h"

#include <math.h>

enum { MAX_LEVELS = 14, MOST_SAMPLES = 8 }; /* 2^13 = SL_TEXTURE_MAX_SIDE */

static const double farthest_uv = 1e9;
static const double most_texels = 1e12; /* longer footprints are as good as infinite */

typedef struct level {
    int32_t width, height;
    uint16_t *rgb; /* light, 65535 = 1 */
} level;

struct sl_texture {
    int32_t levels;
    level level[MAX_LEVELS];
};

static sl_status add_level(sl_texture *t, int32_t width, int32_t height)
{
    level *l = &t->level[t->levels];
    *l = (level){width, height, sl_alloc((int64_t)width * height, 3 * sizeof *l->rgb)};
    if (l->rgb == NULL) {
        return SL_OUT_OF_MEMORY;
    }
    t->levels++;
    return SL_OK;
}

/* The source texels under texel i of `count`, of `source` texels: from *first on, with their shares. At most 3. */
static int32_t shares(int32_t i, int32_t count, int32_t source, int32_t *first, double share[4])
{
    const double lo = (double)i * source / count, hi = (double)(i + 1) * source / count;
    int32_t taps = 0;
    *first = (int32_t)lo;
    for (int32_t k = *first; k < source && k < hi && taps < 4; k++) {
        share[taps++] = (fmin(hi, k + 1.0) - fmax(lo, k)) / (hi - lo);
    }
    return taps;
}

/* Each texel of b is the mean of what it covers of a, whatever the sizes. */
static void reduce(const level *a, const level *b)
{
    for (int32_t y = 0; y < b->height; y++) {
        double down[4], across[4];
        int32_t y0, x0;
        const int32_t rows = shares(y, b->height, a->height, &y0, down);
        for (int32_t x = 0; x < b->width; x++) {
            const int32_t columns = shares(x, b->width, a->width, &x0, across);
            double sum[3] = {0.0, 0.0, 0.0};
            for (int32_t j = 0; j < rows; j++) {
                for (int32_t i = 0; i < columns; i++) {
                    const uint16_t *from = a->rgb + 3 * ((int64_t)(y0 + j) * a->width + x0 + i);
                    for (int k = 0; k < 3; k++) {
                        sum[k] += down[j] * across[i] * from[k];
                    }
                }
            }
            for (int k = 0; k < 3; k++) {
                b->rgb[3 * ((int64_t)y * b->width + x) + k] = (uint16_t)(fmin(sum[k], 65535.0) + 0.5);
            }
        }
    }
}

sl_status sl_texture_create(int32_t width, int32_t height, int32_t channels, const uint8_t *pixels,
                            const float linear[256], sl_texture **out)
{
    sl_status status = SL_OK;
    *out = NULL;
    if (width < 1 || height < 1 || width > SL_TEXTURE_MAX_SIDE || height > SL_TEXTURE_MAX_SIDE || channels < 3 ||
        channels > 4) {
        return SL_BAD_INPUT;
    }
    sl_texture *t = sl_calloc(1, sizeof *t);
    if (t == NULL) {
        return SL_OUT_OF_MEMORY;
    }
    SL_TRY(add_level(t, width, height));
    for (int64_t i = 0; i < (int64_t)width * height; i++) {
        for (int k = 0; k < 3; k++) {
            t->level[0].rgb[3 * i + k] = (uint16_t)(65535.0f * linear[pixels[channels * i + k]] + 0.5f);
        }
    }
    while (width > 1 || height > 1) {
        width = width > 1 ? width / 2 : 1;
        height = height > 1 ? height / 2 : 1;
        SL_TRY(add_level(t, width, height));
        reduce(&t->level[t->levels - 2], &t->level[t->levels - 1]);
    }
    *out = t;
    t = NULL;
cleanup:
    sl_texture_free(t);
    return status;
}

/* Repeats: x modulo n, in [0, n). */
static int32_t wrap(double x, int32_t n)
{
    const double r = x - n * floor(x / n);
    return r < n ? (int32_t)r : n - 1;
}

static void bilinear(const level *l, const double uv[2], double weight, double sum[3])
{
    const double x = uv[0] * l->width - 0.5, y = (1.0 - uv[1]) * l->height - 0.5;
    const double fx = x - floor(x), fy = y - floor(y);
    const int32_t x0 = wrap(floor(x), l->width), y0 = wrap(floor(y), l->height);
    const int32_t x1 = x0 + 1 < l->width ? x0 + 1 : 0, y1 = y0 + 1 < l->height ? y0 + 1 : 0;
    const uint16_t *top = l->rgb + 3 * (int64_t)y0 * l->width, *bottom = l->rgb + 3 * (int64_t)y1 * l->width;
    for (int k = 0; k < 3; k++) {
        const double a = top[3 * (int64_t)x0 + k] + fx * (top[3 * (int64_t)x1 + k] - top[3 * (int64_t)x0 + k]);
        const double b = bottom[3 * (int64_t)x0 + k] + fx * (bottom[3 * (int64_t)x1 + k] - bottom[3 * (int64_t)x0 + k]);
        sum[k] += weight * (a + fy * (b - a));
    }
}

static void trilinear(const sl_texture *t, const double uv[2], double depth, double weight, double sum[3])
{
    const double most = t->levels - 1, place = fmin(fmax(depth, 0.0), most);
    const int32_t i = place < most ? (int32_t)place : t->levels - 1;
    const double f = place - i;
    bilinear(&t->level[i], uv, weight * (1.0 - f), sum);
    if (f > 0.0) {
        bilinear(&t->level[i + 1], uv, weight * f, sum);
    }
}

bool sl_texture_sample(const sl_texture *t, const double uv[2], const double right[2], const double below[2],
                       float rgb[3])
{
    const double w = t->level[0].width, h = t->level[0].height;
    const double a = hypot(right[0] * w, right[1] * h), b = hypot(below[0] * w, below[1] * h);
    if (!(fabs(uv[0]) < farthest_uv && fabs(uv[1]) < farthest_uv && a + b < most_texels)) {
        return false;
    }
    const double major = fmax(a, b), minor = fmax(fmax(fmin(a, b), major / MOST_SAMPLES), 1.0);
    const double *along = a > b ? right : below;
    const int32_t samples = (int32_t)fmin(fmax(ceil(major / minor), 1.0), MOST_SAMPLES);
    double sum[3] = {0.0, 0.0, 0.0};
    for (int32_t i = 0; i < samples; i++) {
        const double s = (i + 0.5) / samples - 0.5;
        const double at[2] = {uv[0] + s * along[0], uv[1] + s * along[1]};
        trilinear(t, at, log2(minor), 1.0 / samples, sum);
    }
    for (int k = 0; k < 3; k++) {
        rgb[k] = (float)(sum[k] / 65535.0);
    }
    return true;
}

void sl_texture_free(sl_texture *texture)
{
    if (texture != NULL) {
        for (int32_t k = 0; k < texture->levels; k++) {
            sl_free(texture->level[k].rgb);
        }
        sl_free(texture);
    }
}
