/* The kernels for x86-64-v3: eight doubles in two registers. No fused operations: plain C has none to match them. */
#if defined(__x86_64__)
#include "param/stretch_kernels.h"

#include <immintrin.h>

typedef struct vec {
    __m256d lo, hi;
} vec;

#define SL_KERNEL static inline __attribute__((target("avx2"), SL_STRETCH_INLINE))
#define SL_KERNEL_ENTRY static __attribute__((target("avx2")))

SL_KERNEL vec vec_load(const double *p)
{
    return (vec){_mm256_loadu_pd(p), _mm256_loadu_pd(p + 4)};
}

SL_KERNEL void vec_store(double *p, vec v)
{
    _mm256_storeu_pd(p, v.lo);
    _mm256_storeu_pd(p + 4, v.hi);
}

SL_KERNEL vec vec_of(double a)
{
    return (vec){_mm256_set1_pd(a), _mm256_set1_pd(a)};
}

SL_KERNEL vec add(vec a, vec b)
{
    return (vec){_mm256_add_pd(a.lo, b.lo), _mm256_add_pd(a.hi, b.hi)};
}

SL_KERNEL vec sub(vec a, vec b)
{
    return (vec){_mm256_sub_pd(a.lo, b.lo), _mm256_sub_pd(a.hi, b.hi)};
}

SL_KERNEL vec mul(vec a, vec b)
{
    return (vec){_mm256_mul_pd(a.lo, b.lo), _mm256_mul_pd(a.hi, b.hi)};
}

SL_KERNEL vec quotient(vec a, vec b)
{
    return (vec){_mm256_div_pd(a.lo, b.lo), _mm256_div_pd(a.hi, b.hi)};
}

SL_KERNEL vec root_of(vec a)
{
    return (vec){_mm256_sqrt_pd(a.lo), _mm256_sqrt_pd(a.hi)};
}

SL_KERNEL vec greater(vec a, vec b)
{
    return (vec){_mm256_max_pd(a.lo, b.lo), _mm256_max_pd(a.hi, b.hi)};
}

SL_KERNEL vec lesser(vec a, vec b)
{
    return (vec){_mm256_min_pd(a.lo, b.lo), _mm256_min_pd(a.hi, b.hi)};
}

SL_KERNEL vec where_positive(vec x, vec a, vec b)
{
    const __m256d none = _mm256_setzero_pd();
    return (vec){_mm256_blendv_pd(b.lo, a.lo, _mm256_cmp_pd(x.lo, none, _CMP_GT_OQ)),
                 _mm256_blendv_pd(b.hi, a.hi, _mm256_cmp_pd(x.hi, none, _CMP_GT_OQ))};
}

#define SL_KERNEL_NAME "v3"
#define SL_KERNEL_SET sl_stretch_kernels_v3
#include "param/stretch_kernels_body.h"
#endif
typedef int sl_stretch_kernels_v3_unit; /* a unit of C may not be empty */
