#include "render/frame_internal.h"

const sl_frame_kernels *sl_frame_kernels_at(int32_t k)
{
    if (k == 0) {
        return &sl_frame_kernels_portable;
    }
#if defined(__x86_64__)
    if (k == 1) {
        return &sl_frame_kernels_sse2;
    }
    if (k == 2 && __builtin_cpu_supports("avx2")) {
        return &sl_frame_kernels_avx2;
    }
#endif
    return NULL;
}

const sl_frame_kernels *sl_frame_kernels_best(void)
{
    int32_t k = 0;
    while (sl_frame_kernels_at(k + 1) != NULL) {
        k++;
    }
    return sl_frame_kernels_at(k);
}
