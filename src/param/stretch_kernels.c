#include "param/stretch_kernels.h"

const sl_stretch_kernels *sl_stretch_kernels_at(int32_t k)
{
    if (k == 0) {
        return &sl_stretch_kernels_scalar;
    }
#if defined(__x86_64__)
    if (k == 1) {
        return __builtin_cpu_supports("avx2") ? &sl_stretch_kernels_v3 : NULL;
    }
    if (k == 2) {
        return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("avx512f") ? &sl_stretch_kernels_v4 : NULL;
    }
#endif
    return NULL;
}

const sl_stretch_kernels *sl_stretch_kernels_best(void)
{
    int32_t k = 0;
    while (sl_stretch_kernels_at(k + 1) != NULL) {
        k++;
    }
    return sl_stretch_kernels_at(k);
}
