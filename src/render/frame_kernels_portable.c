/* The kernels of the frame for any machine. */
#include "render/frame_kernel_keep.h"
#include "render/frame_kernel_project.h"
#include "render/frame_kernel_raster.h"
#include "render/frame_kernel_shade.h"

const sl_frame_kernels sl_frame_kernels_portable = {"portable", range, project, keep, raster, shade};
