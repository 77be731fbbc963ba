/* How often each texel is covered: the GPU's stencil test in integers.
 * Layer: overlap (may include geom, base). */
#ifndef SL_OVERLAP_COVERAGE_H
#define SL_OVERLAP_COVERAGE_H

#include "base/context.h"

/* A square window of UV space and its texels: texel (x, y) has its centre at ((x + 1/2) / W, (y + 1/2) / H) of the
 * window [0, 1]^2, row 0 at v = 0. Fill rule: top-left, 8 sub-pixel bits, float32 transform; bit for bit llvmpipe's
 * rule for power-of-two sizes (reports/design/raster.md). Triangles that leave the window are counted as if it were
 * larger; llvmpipe gives the same bits where its viewport is (to 16384 texels), and clips by a viewport that is the
 * window: then texels within 1/256 of such a triangle's edge may differ. */
typedef struct sl_coverage {
    int32_t width, height;
    uint16_t *count; /* width * height, row-major, saturating at 65535 */
} sl_coverage;

/* width, height: 1 to 2^15, else SL_BAD_INPUT. SL_OUT_OF_MEMORY. */
SL_NODISCARD sl_status sl_coverage_create(int32_t width, int32_t height, sl_coverage **out); /* zeroed */
void sl_coverage_free(sl_coverage *coverage);                                                /* NULL is a no-op */

/* Adds 1 to every texel inside each triangle, whatever its orientation; zero-area ones (after snapping) add nothing.
 * uv: nv x 2 in [0, 1]; tri: 3 nt indices. SL_BAD_INPUT: a UV not finite or beyond |u| > 2^14. Deterministic for any
 * number of threads. O(triangles + covered texels). */
SL_NODISCARD sl_status sl_coverage_add(sl_coverage *coverage, const double *uv, int32_t nt, const int32_t *tri,
                                       const sl_context *context);

/* Texels hit at least once / at least twice. */
int64_t sl_coverage_covered(const sl_coverage *coverage);
int64_t sl_coverage_overlapping(const sl_coverage *coverage);

/* red[t] = 1 for each triangle that covers a texel of count >= 2. red: nt. */
SL_NODISCARD sl_status sl_coverage_red_triangles(const sl_coverage *coverage, const double *uv, int32_t nt,
                                                 const int32_t *tri, uint8_t *red);

#endif
