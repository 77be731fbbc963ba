#include "sparse/kernels.h"

const sl_kernels *sl_kernels_at(int32_t k)
{
    if (k == 0) {
        return &sl_kernels_scalar;
    }
#if defined(__x86_64__)
    const bool v3 = __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");
    if (k == 1) {
        return v3 ? &sl_kernels_v3 : NULL;
    }
    if (k == 2) {
        return v3 && __builtin_cpu_supports("avx512f") ? &sl_kernels_v4 : NULL;
    }
#endif
    return NULL;
}

const sl_kernels *sl_kernels_best(void)
{
    int32_t k = 0;
    while (sl_kernels_at(k + 1) != NULL) {
        k++;
    }
    return sl_kernels_at(k);
}
