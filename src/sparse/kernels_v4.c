/* The kernels for x86-64-v4: AVX-512. */
#if defined(__x86_64__)
#include <immintrin.h>

typedef __m512d vec;

#define SL_KERNEL static inline __attribute__((target("avx512f,avx2,fma"), always_inline))
#define SL_KERNEL_ENTRY static __attribute__((target("avx512f,avx2,fma")))

SL_KERNEL __mmask8 mask_of(int count)
{
    return (__mmask8)((1u << count) - 1u);
}

SL_KERNEL vec vec_load(const double *p)
{
    return _mm512_loadu_pd(p);
}

SL_KERNEL void vec_store(double *p, vec v)
{
    _mm512_storeu_pd(p, v);
}

SL_KERNEL vec vec_load_part(const double *p, int count)
{
    return _mm512_maskz_loadu_pd(mask_of(count), p);
}

SL_KERNEL void vec_store_part(double *p, vec v, int count)
{
    _mm512_mask_storeu_pd(p, mask_of(count), v);
}

SL_KERNEL vec vec_of(double a)
{
    return _mm512_set1_pd(a);
}

SL_KERNEL vec vec_multiply(vec a, vec b)
{
    return _mm512_mul_pd(a, b);
}

SL_KERNEL vec vec_subtract(vec a, vec b)
{
    return _mm512_sub_pd(a, b);
}

/* c + a b */
SL_KERNEL vec vec_fma(vec a, vec b, vec c)
{
    return _mm512_fmadd_pd(a, b, c);
}

/* c - a b */
SL_KERNEL vec vec_fnma(vec a, vec b, vec c)
{
    return _mm512_fnmadd_pd(a, b, c);
}

#define SL_KERNEL_GROUP 8 /* vectors that stay in registers */
#define SL_KERNEL_NAME "v4"
#define SL_KERNEL_SET sl_kernels_v4
#include "sparse/kernels_front.h"
#include "sparse/kernels_solve.h"
#include "sparse/kernels_table.h"
#endif
typedef int sl_kernels_v4_unit; /* a unit of C may not be empty */
