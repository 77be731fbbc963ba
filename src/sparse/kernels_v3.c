/* The kernels for x86-64-v3: AVX2 and FMA, eight doubles in two registers. */
#if defined(__x86_64__)
#include "sparse/kernels.h"

#include <immintrin.h>
#include <stdint.h>

typedef struct vec {
    __m256d lo, hi;
} vec;

#define SL_KERNEL static inline __attribute__((target("avx2,fma"), SL_KERNEL_INLINE))
#define SL_KERNEL_ENTRY static __attribute__((target("avx2,fma")))

static const int64_t lanes[16] = {-1, -1, -1, -1, -1, -1, -1, -1, 0, 0, 0, 0, 0, 0, 0, 0};

SL_KERNEL __m256i mask_of(int count, int first)
{
    return _mm256_loadu_si256((const __m256i *)(const void *)(lanes + 8 - count + first));
}

SL_KERNEL vec vec_load(const double *p)
{
    return (vec){_mm256_loadu_pd(p), _mm256_loadu_pd(p + 4)};
}

SL_KERNEL void vec_store(double *p, vec v)
{
    _mm256_storeu_pd(p, v.lo);
    _mm256_storeu_pd(p + 4, v.hi);
}

SL_KERNEL vec vec_load_part(const double *p, int count)
{
    return (vec){_mm256_maskload_pd(p, mask_of(count, 0)), _mm256_maskload_pd(p + 4, mask_of(count, 4))};
}

SL_KERNEL void vec_store_part(double *p, vec v, int count)
{
    _mm256_maskstore_pd(p, mask_of(count, 0), v.lo);
    _mm256_maskstore_pd(p + 4, mask_of(count, 4), v.hi);
}

SL_KERNEL vec vec_load_half(const double *p)
{
    return (vec){_mm256_loadu_pd(p), _mm256_setzero_pd()};
}

SL_KERNEL void vec_store_half(double *p, vec v)
{
    _mm256_storeu_pd(p, v.lo);
}

SL_KERNEL vec vec_of(double a)
{
    return (vec){_mm256_set1_pd(a), _mm256_set1_pd(a)};
}

SL_KERNEL vec vec_multiply(vec a, vec b)
{
    return (vec){_mm256_mul_pd(a.lo, b.lo), _mm256_mul_pd(a.hi, b.hi)};
}

SL_KERNEL vec vec_subtract(vec a, vec b)
{
    return (vec){_mm256_sub_pd(a.lo, b.lo), _mm256_sub_pd(a.hi, b.hi)};
}

SL_KERNEL vec vec_add(vec a, vec b)
{
    return (vec){_mm256_add_pd(a.lo, b.lo), _mm256_add_pd(a.hi, b.hi)};
}

/* c + a b */
SL_KERNEL vec vec_fma(vec a, vec b, vec c)
{
    return (vec){_mm256_fmadd_pd(a.lo, b.lo, c.lo), _mm256_fmadd_pd(a.hi, b.hi, c.hi)};
}

/* c - a b */
SL_KERNEL vec vec_fnma(vec a, vec b, vec c)
{
    return (vec){_mm256_fnmadd_pd(a.lo, b.lo, c.lo), _mm256_fnmadd_pd(a.hi, b.hi, c.hi)};
}

SL_KERNEL vec vec_pack(const double x[8])
{
    return (vec){_mm256_set_pd(x[3], x[2], x[1], x[0]), _mm256_set_pd(x[7], x[6], x[5], x[4])};
}

/* Lane j = (v0 + v1) + (v2 + v3) of the j-th. */
SL_KERNEL __m256d sums_of_4(__m256d a, __m256d b, __m256d c, __m256d d)
{
    const __m256d ab = _mm256_hadd_pd(a, b), cd = _mm256_hadd_pd(c, d);
    return _mm256_add_pd(_mm256_permute2f128_pd(ab, cd, 0x20), _mm256_permute2f128_pd(ab, cd, 0x31));
}

/* Lane j = ((v0 + v1) + (v2 + v3)) + ((v4 + v5) + (v6 + v7)) of v[j]. */
SL_KERNEL vec vec_sums(const vec v[8])
{
    return (vec){
        _mm256_add_pd(sums_of_4(v[0].lo, v[1].lo, v[2].lo, v[3].lo), sums_of_4(v[0].hi, v[1].hi, v[2].hi, v[3].hi)),
        _mm256_add_pd(sums_of_4(v[4].lo, v[5].lo, v[6].lo, v[7].lo), sums_of_4(v[4].hi, v[5].hi, v[6].hi, v[7].hi))};
}

#define SL_KERNEL_GROUP 4 /* vectors that stay in registers */
#define SL_KERNEL_NAME "v3"
#define SL_KERNEL_SET sl_kernels_v3
#include "sparse/kernels_front.h"
#include "sparse/kernels_solve.h"
#include "sparse/kernels_table.h"
#endif
typedef int sl_kernels_v3_unit; /* a unit of C may not be empty */
