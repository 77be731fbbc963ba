/* Eight doubles in four of SSE2's registers; see frame_lanes.h.
 * Layer: render, private. */
#ifndef SL_RENDER_FRAME_DOUBLES_SSE2_H
#define SL_RENDER_FRAME_DOUBLES_SSE2_H

#include "render/frame_lanes_sse2.h"

#include <float.h>

typedef struct d8 {
    __m128d v[4];
} d8;

LANES_CALL d8 d8_all(double a)
{
    return (d8){{_mm_set1_pd(a), _mm_set1_pd(a), _mm_set1_pd(a), _mm_set1_pd(a)}};
}

LANES_CALL d8 d8_add(d8 a, d8 b)
{
    for (int k = 0; k < 4; k++) {
        a.v[k] = _mm_add_pd(a.v[k], b.v[k]);
    }
    return a;
}

LANES_CALL d8 d8_sub(d8 a, d8 b)
{
    for (int k = 0; k < 4; k++) {
        a.v[k] = _mm_sub_pd(a.v[k], b.v[k]);
    }
    return a;
}

LANES_CALL d8 d8_mul(d8 a, d8 b)
{
    for (int k = 0; k < 4; k++) {
        a.v[k] = _mm_mul_pd(a.v[k], b.v[k]);
    }
    return a;
}

LANES_CALL d8 d8_div(d8 a, d8 b)
{
    for (int k = 0; k < 4; k++) {
        a.v[k] = _mm_div_pd(a.v[k], b.v[k]);
    }
    return a;
}

LANES_CALL d8 d8_min(d8 a, d8 b)
{
    for (int k = 0; k < 4; k++) {
        a.v[k] = _mm_min_pd(a.v[k], b.v[k]);
    }
    return a;
}

LANES_CALL d8 d8_max(d8 a, d8 b)
{
    for (int k = 0; k < 4; k++) {
        a.v[k] = _mm_max_pd(a.v[k], b.v[k]);
    }
    return a;
}

LANES_CALL d8 d8_abs(d8 a)
{
    for (int k = 0; k < 4; k++) {
        a.v[k] = _mm_andnot_pd(_mm_set1_pd(-0.0), a.v[k]);
    }
    return a;
}

LANES_CALL d8 d8_finite_or(d8 a, d8 other)
{
    for (int k = 0; k < 4; k++) {
        const __m128d size = _mm_andnot_pd(_mm_set1_pd(-0.0), a.v[k]);
        const __m128d finite = _mm_cmple_pd(size, _mm_set1_pd(DBL_MAX));
        a.v[k] = _mm_or_pd(_mm_and_pd(finite, a.v[k]), _mm_andnot_pd(finite, other.v[k]));
    }
    return a;
}

LANES_CALL void d8_store(double *p, d8 a)
{
    for (int k = 0; k < 4; k++) {
        _mm_storeu_pd(p + 2 * k, a.v[k]);
    }
}

LANES_CALL i8 d8_less(d8 a, d8 b)
{
    __m128 mask[4];
    for (int k = 0; k < 4; k++) {
        mask[k] = _mm_castpd_ps(_mm_cmplt_pd(a.v[k], b.v[k]));
    }
    return f8_bits((f8){_mm_shuffle_ps(mask[0], mask[1], 0x88), _mm_shuffle_ps(mask[2], mask[3], 0x88)});
}

LANES_CALL i8 d8_round(d8 a)
{
    __m128i two[4];
    for (int k = 0; k < 4; k++) {
        two[k] = _mm_cvtpd_epi32(a.v[k]);
    }
    return (i8){_mm_unpacklo_epi64(two[0], two[1]), _mm_unpacklo_epi64(two[2], two[3])};
}

LANES_CALL f8 d8_float(d8 a)
{
    __m128 two[4];
    for (int k = 0; k < 4; k++) {
        two[k] = _mm_cvtpd_ps(a.v[k]);
    }
    return (f8){_mm_movelh_ps(two[0], two[1]), _mm_movelh_ps(two[2], two[3])};
}

/* x0 y0 | z0 x1 | y1 z1 into x, y, z of two points. */
LANES_CALL void d8_points(const double *p, d8 xyz[3])
{
    for (int k = 0; k < 4; k++) {
        const __m128d a = _mm_loadu_pd(p + 6 * k), b = _mm_loadu_pd(p + 6 * k + 2), c = _mm_loadu_pd(p + 6 * k + 4);
        xyz[0].v[k] = _mm_shuffle_pd(a, b, 2);
        xyz[1].v[k] = _mm_shuffle_pd(a, c, 1);
        xyz[2].v[k] = _mm_shuffle_pd(b, c, 2);
    }
}

#endif
