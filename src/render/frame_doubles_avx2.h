/* Eight doubles in two registers of AVX2; see frame_lanes.h.
 * Layer: render, private. */
#ifndef SL_RENDER_FRAME_DOUBLES_AVX2_H
#define SL_RENDER_FRAME_DOUBLES_AVX2_H

#include "render/frame_lanes_avx2.h"

#include <float.h>

typedef struct d8 {
    __m256d lo, hi;
} d8;

LANES_CALL d8 d8_all(double a)
{
    return (d8){_mm256_set1_pd(a), _mm256_set1_pd(a)};
}

LANES_CALL d8 d8_add(d8 a, d8 b)
{
    return (d8){_mm256_add_pd(a.lo, b.lo), _mm256_add_pd(a.hi, b.hi)};
}

LANES_CALL d8 d8_sub(d8 a, d8 b)
{
    return (d8){_mm256_sub_pd(a.lo, b.lo), _mm256_sub_pd(a.hi, b.hi)};
}

LANES_CALL d8 d8_mul(d8 a, d8 b)
{
    return (d8){_mm256_mul_pd(a.lo, b.lo), _mm256_mul_pd(a.hi, b.hi)};
}

LANES_CALL d8 d8_div(d8 a, d8 b)
{
    return (d8){_mm256_div_pd(a.lo, b.lo), _mm256_div_pd(a.hi, b.hi)};
}

LANES_CALL d8 d8_min(d8 a, d8 b)
{
    return (d8){_mm256_min_pd(a.lo, b.lo), _mm256_min_pd(a.hi, b.hi)};
}

LANES_CALL d8 d8_max(d8 a, d8 b)
{
    return (d8){_mm256_max_pd(a.lo, b.lo), _mm256_max_pd(a.hi, b.hi)};
}

LANES_CALL d8 d8_abs(d8 a)
{
    const __m256d sign = _mm256_set1_pd(-0.0);
    return (d8){_mm256_andnot_pd(sign, a.lo), _mm256_andnot_pd(sign, a.hi)};
}

LANES_CALL __m256d finite_or(__m256d a, __m256d other)
{
    const __m256d size = _mm256_andnot_pd(_mm256_set1_pd(-0.0), a);
    return _mm256_blendv_pd(other, a, _mm256_cmp_pd(size, _mm256_set1_pd(DBL_MAX), _CMP_LE_OQ));
}

LANES_CALL d8 d8_finite_or(d8 a, d8 other)
{
    return (d8){finite_or(a.lo, other.lo), finite_or(a.hi, other.hi)};
}

LANES_CALL void d8_store(double *p, d8 a)
{
    _mm256_storeu_pd(p, a.lo);
    _mm256_storeu_pd(p + 4, a.hi);
}

LANES_CALL i8 d8_less(d8 a, d8 b)
{
    const __m256 lo = _mm256_castpd_ps(_mm256_cmp_pd(a.lo, b.lo, _CMP_LT_OQ));
    const __m256 hi = _mm256_castpd_ps(_mm256_cmp_pd(a.hi, b.hi, _CMP_LT_OQ));
    return _mm256_permute4x64_epi64(_mm256_castps_si256(_mm256_shuffle_ps(lo, hi, 0x88)), 0xd8);
}

LANES_CALL i8 d8_round(d8 a)
{
    const __m128i lo = _mm256_cvtpd_epi32(a.lo), hi = _mm256_cvtpd_epi32(a.hi);
    return _mm256_inserti128_si256(_mm256_castsi128_si256(lo), hi, 1);
}

LANES_CALL f8 d8_float(d8 a)
{
    const __m128 lo = _mm256_cvtpd_ps(a.lo), hi = _mm256_cvtpd_ps(a.hi);
    return _mm256_insertf128_ps(_mm256_castps128_ps256(lo), hi, 1);
}

/* x0 y0 z0 x1 | y1 z1 x2 y2 | z2 x3 y3 z3 into x, y, z of four points. */
LANES_CALL void four_points(const double *p, __m256d *x, __m256d *y, __m256d *z)
{
    const __m256d a = _mm256_loadu_pd(p), b = _mm256_loadu_pd(p + 4), c = _mm256_loadu_pd(p + 8);
    const __m256d xy = _mm256_permute2f128_pd(a, b, 0x30), zx = _mm256_permute2f128_pd(a, c, 0x21);
    const __m256d yz = _mm256_permute2f128_pd(b, c, 0x30);
    *x = _mm256_shuffle_pd(xy, zx, 0xa);
    *y = _mm256_shuffle_pd(xy, yz, 0x5);
    *z = _mm256_shuffle_pd(zx, yz, 0xa);
}

LANES_CALL void d8_points(const double *p, d8 xyz[3])
{
    four_points(p, &xyz[0].lo, &xyz[1].lo, &xyz[2].lo);
    four_points(p + 12, &xyz[0].hi, &xyz[1].hi, &xyz[2].hi);
}

#endif
