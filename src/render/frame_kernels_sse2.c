/* The kernels of the frame for any x86-64 processor. */
#if defined(__x86_64__)
#define SL_LANES_SSE2 1
#include "render/frame_kernel_keep.h"
#include "render/frame_kernel_project.h"
#include "render/frame_kernel_raster.h"
#include "render/frame_kernel_shade.h"

const sl_frame_kernels sl_frame_kernels_sse2 = {"SSE2", range, project, keep, raster, shade};
#else
typedef int frame_kernels_sse2_is_for_x86_64;
#endif
