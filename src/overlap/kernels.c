#include "overlap/kernels_internal.h"

#include "overlap/raster_internal.h"

#include <math.h>

static bool snap(int64_t n, const double *uv, int32_t width, int32_t height, int32_t *position)
{
    /* 256 texels a unit stay below the bound; what is out of range in small windows is seen to elsewhere. */
    const double most = SL_RASTER_MAX_COORDINATE;
    const double reach_x = fmin(0x1p20 / width, most), reach_y = fmin(0x1p20 / height, most);
    bool good = true;
    for (int64_t v = 0; v < n; v++) {
        const bool near = fabs(uv[2 * v]) < reach_x && fabs(uv[2 * v + 1]) < reach_y; /* a NaN compares false */
        good = good && near;
        position[2 * v] = near ? (int32_t)sl_raster_snap(uv[2 * v], width) : 0;
        position[2 * v + 1] = near ? (int32_t)sl_raster_snap(uv[2 * v + 1], height) : 0;
    }
    return good;
}

static void orient(int64_t begin, int64_t end, int32_t *const corner[3], const int32_t *position, int8_t *sign)
{
    for (int64_t t = begin; t < end; t++) {
        const int32_t *p = position + 2 * (int64_t)corner[0][t], *q = position + 2 * (int64_t)corner[1][t];
        const int32_t *r = position + 2 * (int64_t)corner[2][t];
        const int64_t left = (int64_t)(q[0] - p[0]) * (r[1] - p[1]), right = (int64_t)(r[0] - p[0]) * (q[1] - p[1]);
        sign[t] = (int8_t)((right > left) - (right < left));
    }
}

static void prefix(int32_t width, int32_t *difference, uint16_t *count, int32_t sums[2])
{
    int32_t sum = 0, once = 0, twice = 0;
    for (int32_t x = 0; x < width; x++) {
        sum += difference[x];
        difference[x] = 0;
        once += sum > 0;
        twice += sum > 1;
        count[x] = (uint16_t)(sum < UINT16_MAX ? sum : UINT16_MAX);
    }
    difference[width] = 0;
    sums[0] = once;
    sums[1] = twice;
}

sl_raster_kernels sl_raster_kernels_portable(void)
{
    return (sl_raster_kernels){snap, orient, prefix};
}
