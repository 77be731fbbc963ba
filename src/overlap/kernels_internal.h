/* The inner loops of the edge raster, portable and for AVX2. Both give the same bytes.
 * Layer: overlap. Private. */
#ifndef SL_OVERLAP_KERNELS_INTERNAL_H
#define SL_OVERLAP_KERNELS_INTERNAL_H

#include "base/status.h"

enum {
    SL_KERNEL_PAD = 16,        /* entries a difference row needs beyond its end */
    SL_KERNEL_BOUND = 1 << 29, /* lattice coordinates below it fit every integer of the edge raster */
};

typedef struct sl_raster_kernels {
    /* Lattice positions (x, y interleaved) of n points in a window of this size; false if one is not finite, not
     * below SL_KERNEL_BOUND, or beyond the coordinates that coverage takes (then all positions are without meaning). */
    bool (*snap)(int64_t n, const double *uv, int32_t width, int32_t height, int32_t *position);
    /* sign[t] of the triangles [begin, end): +1, -1, 0 by the raster's orientation. */
    void (*orient)(int64_t begin, int64_t end, int32_t *const corner[3], const int32_t *position, int8_t *sign);
    /* count[x] = min(prefix sum of difference[0 .. x], 65535); clears the differences. sums[0], sums[1]: entries of sum
     * 1 and more, 2 and more. */
    void (*prefix)(int32_t width, int32_t *difference, uint16_t *count, int32_t sums[2]);
} sl_raster_kernels;

sl_raster_kernels sl_raster_kernels_portable(void);

/* Fills *kernels when the processor has AVX2; false and unchanged otherwise. */
bool sl_raster_kernels_avx2(sl_raster_kernels *kernels);

#endif
