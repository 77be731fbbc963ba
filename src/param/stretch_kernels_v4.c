/* The kernels for x86-64-v4: eight doubles in one register. */
#if defined(__x86_64__)
#include "param/stretch_kernels.h"

#include <immintrin.h>

typedef __m512d vec;

#define SL_KERNEL static inline __attribute__((target("avx2,avx512f"), SL_STRETCH_INLINE))
#define SL_KERNEL_ENTRY static __attribute__((target("avx2,avx512f")))

SL_KERNEL vec vec_load(const double *p)
{
    return _mm512_loadu_pd(p);
}

SL_KERNEL void vec_store(double *p, vec v)
{
    _mm512_storeu_pd(p, v);
}

SL_KERNEL vec vec_of(double a)
{
    return _mm512_set1_pd(a);
}

SL_KERNEL vec add(vec a, vec b)
{
    return _mm512_add_pd(a, b);
}

SL_KERNEL vec sub(vec a, vec b)
{
    return _mm512_sub_pd(a, b);
}

SL_KERNEL vec mul(vec a, vec b)
{
    return _mm512_mul_pd(a, b);
}

SL_KERNEL vec quotient(vec a, vec b)
{
    return _mm512_div_pd(a, b);
}

SL_KERNEL vec root_of(vec a)
{
    return _mm512_sqrt_pd(a);
}

SL_KERNEL vec greater(vec a, vec b)
{
    return _mm512_max_pd(a, b);
}

SL_KERNEL vec lesser(vec a, vec b)
{
    return _mm512_min_pd(a, b);
}

SL_KERNEL vec where_positive(vec x, vec a, vec b)
{
    return _mm512_mask_blend_pd(_mm512_cmp_pd_mask(x, _mm512_setzero_pd(), _CMP_GT_OQ), b, a);
}

#define SL_KERNEL_NAME "v4"
#define SL_KERNEL_SET sl_stretch_kernels_v4
#include "param/stretch_kernels_body.h"
#endif
typedef int sl_stretch_kernels_v4_unit; /* a unit of C may not be empty */
