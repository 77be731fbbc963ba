/* The fill rule as reports/design/raster.md states it, texel by texel and in 128 bits: the oracle of this folder. */
#ifndef SL_TEST_FILL_RULE_H
#define SL_TEST_FILL_RULE_H

#include <math.h>
#include <stdbool.h>
#include <stdint.h>

__extension__ typedef __int128 test_wide;

typedef struct test_snapped {
    int64_t x[3], y[3];
} test_snapped;

/* Steps 1 to 3, with the fused operation of the C library. */
static inline int64_t test_snap(double u, int32_t size)
{
    const float f = (float)u, c = 2.0f * f - 1.0f, half = 0.5f * (float)size;
    const float s = fmaf(c, half, half);
    return (int64_t)rint((double)(s - 0.5f) * 256.0);
}

static inline test_snapped test_snap_triangle(const double *uv, const int32_t *tri, int32_t width, int32_t height)
{
    test_snapped t;
    for (int k = 0; k < 3; k++) {
        t.x[k] = test_snap(uv[2 * tri[k]], width);
        t.y[k] = test_snap(uv[2 * tri[k] + 1], height);
    }
    return t;
}

/* Steps 4 and 5. */
static inline bool test_inside(const test_snapped *t, int32_t px, int32_t py)
{
    const test_wide area =
        (test_wide)(t->x[0] - t->x[1]) * (t->y[2] - t->y[0]) - (test_wide)(t->x[2] - t->x[0]) * (t->y[0] - t->y[1]);
    const int order[3] = {0, area < 0 ? 2 : 1, area < 0 ? 1 : 2};
    bool inside = area != 0;
    for (int k = 0; k < 3; k++) {
        const int i = order[k], n = order[(k + 1) % 3];
        const test_wide dx = t->y[i] - t->y[n], dy = t->x[i] - t->x[n];
        test_wide c = dx * t->x[i] - dy * t->y[i];
        c += dx < 0 || (dx == 0 && dy > 0);
        inside = inside && c + 256 * (dy * py - dx * px) > 0;
    }
    return inside;
}

#endif
