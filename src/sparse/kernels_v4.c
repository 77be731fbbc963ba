/* The kernels for x86-64-v4: AVX-512. */
#if defined(__x86_64__)
#include "sparse/kernels.h"

#include <immintrin.h>

typedef __m512d vec;

#define SL_KERNEL static inline __attribute__((target("avx512f,avx2,fma"), SL_KERNEL_INLINE))
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

/* Four sides: a plain load of half a vector, so that what was stored is forwarded to it. */
SL_KERNEL vec vec_load_half(const double *p)
{
    return _mm512_zextpd256_pd512(_mm256_loadu_pd(p));
}

SL_KERNEL void vec_store_half(double *p, vec v)
{
    _mm256_storeu_pd(p, _mm512_castpd512_pd256(v));
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

SL_KERNEL vec vec_add(vec a, vec b)
{
    return _mm512_add_pd(a, b);
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

SL_KERNEL vec vec_pack(const double x[8])
{
    return _mm512_set_pd(x[7], x[6], x[5], x[4], x[3], x[2], x[1], x[0]);
}

/* Neighbouring lanes of a and of b, added: a01 b01 a23 b23 .. */
SL_KERNEL vec add_neighbours(vec a, vec b)
{
    return _mm512_add_pd(_mm512_unpacklo_pd(a, b), _mm512_unpackhi_pd(a, b));
}

/* Lane j = ((v0 + v1) + (v2 + v3)) + ((v4 + v5) + (v6 + v7)) of v[j]. */
SL_KERNEL vec vec_sums(const vec v[8])
{
    const vec ab = add_neighbours(v[0], v[1]), cd = add_neighbours(v[2], v[3]);
    const vec ef = add_neighbours(v[4], v[5]), gh = add_neighbours(v[6], v[7]);
    /* ab, cd: pairs 01 23 45 67 each; even pairs of both, then odd ones: ab0123 ab4567 cd0123 cd4567. */
    const vec abcd = _mm512_add_pd(_mm512_shuffle_f64x2(ab, cd, 0x88), _mm512_shuffle_f64x2(ab, cd, 0xdd));
    const vec efgh = _mm512_add_pd(_mm512_shuffle_f64x2(ef, gh, 0x88), _mm512_shuffle_f64x2(ef, gh, 0xdd));
    return _mm512_add_pd(_mm512_shuffle_f64x2(abcd, efgh, 0x88), _mm512_shuffle_f64x2(abcd, efgh, 0xdd));
}

#define SL_KERNEL_GROUP 8 /* vectors that stay in registers */
#define SL_KERNEL_NAME "v4"
#define SL_KERNEL_SET sl_kernels_v4
#include "sparse/kernels_front.h"
#include "sparse/kernels_solve.h"
#include "sparse/kernels_table.h"
#endif
typedef int sl_kernels_v4_unit; /* a unit of C may not be empty */
