/* The reference rasterizer: OpenGL ES's stencil increment on Mesa's llvmpipe, without a display. */
#ifndef SL_TEST_STENCIL_H
#define SL_TEST_STENCIL_H

#include <stdbool.h>
#include <stdint.h>

typedef struct test_stencil test_stencil; /* opaque: a context and a stencil buffer of one size */

/* NULL when there is no EGL, no surfaceless platform, no llvmpipe, or no way to read a stencil buffer. `threads`:
 * LP_NUM_THREADS, read by Mesa once a process. */
test_stencil *test_stencil_create(int32_t width, int32_t height, int threads);

/* Lets the viewport, and with it what the driver clips by, reach beyond the window by so many doublings of its size,
 * about its middle; what lands in the window stays the same, since the smaller clip coordinates and the larger viewport
 * are exact powers of two of one another. 0, as it is made: the viewport is the window. False where the driver's
 * viewport is not that large or the window's size is odd. */
bool test_stencil_widen(test_stencil *stencil, int doublings);

/* Uploads nv points (x, y as float) and 3 nt indices into buffers of the driver, draws them with INCR on a cleared
 * buffer and reads the counts into count (width * height bytes, row 0 at v = 0). False on any GL error. */
bool test_stencil_draw(test_stencil *stencil, int32_t nv, const float *uv, int32_t nt, const int32_t *tri,
                       uint8_t *count);

/* "llvmpipe (LLVM 15.0.6, 256 bits), Mesa 22.3.6"; borrowed. */
const char *test_stencil_name(const test_stencil *stencil);

void test_stencil_free(test_stencil *stencil); /* NULL is a no-op */

#endif
