/* Eight lanes in pairs of SSE2's registers, which every x86-64 has; see frame_lanes.h.
 * Layer: render, private. */
#ifndef SL_RENDER_FRAME_LANES_SSE2_H
#define SL_RENDER_FRAME_LANES_SSE2_H

#include <emmintrin.h>

#define LANES_TARGET
#define LANES_CALL LANES_STATIC __attribute__((LANES_INLINE))

typedef struct f8 {
    __m128 lo, hi;
} f8;

typedef struct i8 {
    __m128i lo, hi;
} i8;

LANES_CALL f8 f8_all(float a)
{
    return (f8){_mm_set1_ps(a), _mm_set1_ps(a)};
}

LANES_CALL f8 f8_load(const float *p)
{
    return (f8){_mm_loadu_ps(p), _mm_loadu_ps(p + 4)};
}

LANES_CALL void f8_store(float *p, f8 a)
{
    _mm_storeu_ps(p, a.lo);
    _mm_storeu_ps(p + 4, a.hi);
}

LANES_CALL f8 f8_add(f8 a, f8 b)
{
    return (f8){_mm_add_ps(a.lo, b.lo), _mm_add_ps(a.hi, b.hi)};
}

LANES_CALL f8 f8_sub(f8 a, f8 b)
{
    return (f8){_mm_sub_ps(a.lo, b.lo), _mm_sub_ps(a.hi, b.hi)};
}

LANES_CALL f8 f8_mul(f8 a, f8 b)
{
    return (f8){_mm_mul_ps(a.lo, b.lo), _mm_mul_ps(a.hi, b.hi)};
}

LANES_CALL f8 f8_div(f8 a, f8 b)
{
    return (f8){_mm_div_ps(a.lo, b.lo), _mm_div_ps(a.hi, b.hi)};
}

LANES_CALL f8 f8_min(f8 a, f8 b)
{
    return (f8){_mm_min_ps(a.lo, b.lo), _mm_min_ps(a.hi, b.hi)};
}

LANES_CALL f8 f8_max(f8 a, f8 b)
{
    return (f8){_mm_max_ps(a.lo, b.lo), _mm_max_ps(a.hi, b.hi)};
}

LANES_CALL f8 f8_root(f8 a)
{
    return (f8){_mm_sqrt_ps(a.lo), _mm_sqrt_ps(a.hi)};
}

LANES_CALL f8 f8_abs(f8 a)
{
    const __m128 sign = _mm_set1_ps(-0.0f);
    return (f8){_mm_andnot_ps(sign, a.lo), _mm_andnot_ps(sign, a.hi)};
}

LANES_CALL i8 f8_bits(f8 a)
{
    return (i8){_mm_castps_si128(a.lo), _mm_castps_si128(a.hi)};
}

LANES_CALL f8 i8_bits(i8 a)
{
    return (f8){_mm_castsi128_ps(a.lo), _mm_castsi128_ps(a.hi)};
}

LANES_CALL i8 f8_less(f8 a, f8 b)
{
    return f8_bits((f8){_mm_cmplt_ps(a.lo, b.lo), _mm_cmplt_ps(a.hi, b.hi)});
}

LANES_CALL i8 f8_whole(f8 a)
{
    return (i8){_mm_cvttps_epi32(a.lo), _mm_cvttps_epi32(a.hi)};
}

LANES_CALL f8 i8_float(i8 a)
{
    return (f8){_mm_cvtepi32_ps(a.lo), _mm_cvtepi32_ps(a.hi)};
}

LANES_CALL i8 i8_all(int32_t a)
{
    return (i8){_mm_set1_epi32(a), _mm_set1_epi32(a)};
}

LANES_CALL i8 i8_load(const int32_t *p)
{
    return (i8){_mm_loadu_si128((const __m128i *)(const void *)p),
                _mm_loadu_si128((const __m128i *)(const void *)(p + 4))};
}

LANES_CALL void i8_store(int32_t *p, i8 a)
{
    _mm_storeu_si128((__m128i *)(void *)p, a.lo);
    _mm_storeu_si128((__m128i *)(void *)(p + 4), a.hi);
}

LANES_CALL i8 i8_add(i8 a, i8 b)
{
    return (i8){_mm_add_epi32(a.lo, b.lo), _mm_add_epi32(a.hi, b.hi)};
}

LANES_CALL i8 i8_sub(i8 a, i8 b)
{
    return (i8){_mm_sub_epi32(a.lo, b.lo), _mm_sub_epi32(a.hi, b.hi)};
}

LANES_CALL i8 i8_and(i8 a, i8 b)
{
    return (i8){_mm_and_si128(a.lo, b.lo), _mm_and_si128(a.hi, b.hi)};
}

LANES_CALL i8 i8_or(i8 a, i8 b)
{
    return (i8){_mm_or_si128(a.lo, b.lo), _mm_or_si128(a.hi, b.hi)};
}

LANES_CALL i8 i8_without(i8 a, i8 b)
{
    return (i8){_mm_andnot_si128(b.lo, a.lo), _mm_andnot_si128(b.hi, a.hi)};
}

/* Low halves of the products of 32 bits, from those of even and of odd lanes. */
LANES_CALL __m128i product(__m128i a, __m128i b)
{
    const __m128i even = _mm_mul_epu32(a, b), odd = _mm_mul_epu32(_mm_srli_epi64(a, 32), _mm_srli_epi64(b, 32));
    return _mm_unpacklo_epi32(_mm_shuffle_epi32(even, 0x08), _mm_shuffle_epi32(odd, 0x08));
}

LANES_CALL i8 i8_mul(i8 a, i8 b)
{
    return (i8){product(a.lo, b.lo), product(a.hi, b.hi)};
}

LANES_CALL i8 i8_less(i8 a, i8 b)
{
    return (i8){_mm_cmplt_epi32(a.lo, b.lo), _mm_cmplt_epi32(a.hi, b.hi)};
}

LANES_CALL i8 i8_equal(i8 a, i8 b)
{
    return (i8){_mm_cmpeq_epi32(a.lo, b.lo), _mm_cmpeq_epi32(a.hi, b.hi)};
}

LANES_CALL i8 i8_select(i8 mask, i8 a, i8 b)
{
    return i8_or(i8_and(mask, a), i8_without(b, mask));
}

LANES_CALL f8 f8_select(i8 mask, f8 a, f8 b)
{
    return i8_bits(i8_select(mask, f8_bits(a), f8_bits(b)));
}

LANES_CALL i8 i8_min(i8 a, i8 b)
{
    return i8_select(i8_less(a, b), a, b);
}

LANES_CALL i8 i8_max(i8 a, i8 b)
{
    return i8_select(i8_less(a, b), b, a);
}

LANES_CALL i8 i8_up(i8 a, int32_t bits)
{
    const __m128i count = _mm_cvtsi32_si128(bits);
    return (i8){_mm_sll_epi32(a.lo, count), _mm_sll_epi32(a.hi, count)};
}

LANES_CALL i8 i8_down(i8 a, int32_t bits)
{
    const __m128i count = _mm_cvtsi32_si128(bits);
    return (i8){_mm_sra_epi32(a.lo, count), _mm_sra_epi32(a.hi, count)};
}

LANES_CALL uint32_t i8_signs(i8 a)
{
    const f8 f = i8_bits(a);
    return (uint32_t)_mm_movemask_ps(f.lo) | (uint32_t)_mm_movemask_ps(f.hi) << 4;
}

LANES_CALL __m128i tint_four(__m128i color, __m128i power)
{
    const __m128i zero = _mm_setzero_si128(), toe = _mm_set1_epi16(TINT_TOE);
    const __m128i rest = _mm_set1_epi16(TINT_TOE - (1 << (TINT_BITS - 1)));
    const __m128i twice = _mm_or_si128(power, _mm_slli_epi32(power, 16));
    __m128i lo = _mm_slli_epi16(_mm_unpacklo_epi8(color, zero), TINT_BITS);
    __m128i hi = _mm_slli_epi16(_mm_unpackhi_epi8(color, zero), TINT_BITS);
    lo = _mm_mulhi_epu16(_mm_add_epi16(lo, toe), _mm_unpacklo_epi32(twice, twice));
    hi = _mm_mulhi_epu16(_mm_add_epi16(hi, toe), _mm_unpackhi_epi32(twice, twice));
    lo = _mm_srli_epi16(_mm_subs_epu16(lo, rest), TINT_BITS);
    hi = _mm_srli_epi16(_mm_subs_epu16(hi, rest), TINT_BITS);
    return _mm_or_si128(_mm_packus_epi16(lo, hi), _mm_set1_epi32((int32_t)0xff000000u));
}

LANES_CALL i8 i8_tint(i8 color, i8 power)
{
    return (i8){tint_four(color.lo, power.lo), tint_four(color.hi, power.hi)};
}

LANES_CALL void turn_four(__m128 row[4])
{
    const __m128 ab = _mm_unpacklo_ps(row[0], row[1]), cd = _mm_unpacklo_ps(row[2], row[3]);
    const __m128 ab2 = _mm_unpackhi_ps(row[0], row[1]), cd2 = _mm_unpackhi_ps(row[2], row[3]);
    row[0] = _mm_movelh_ps(ab, cd);
    row[1] = _mm_movehl_ps(cd, ab);
    row[2] = _mm_movelh_ps(ab2, cd2);
    row[3] = _mm_movehl_ps(cd2, ab2);
}

LANES_CALL void four_words(const char *base, const int64_t at[8], i8 out[4])
{
    __m128 lo[4], hi[4];
    for (int k = 0; k < 4; k++) {
        lo[k] = _mm_castsi128_ps(_mm_loadu_si128((const __m128i *)(const void *)(base + at[k])));
        hi[k] = _mm_castsi128_ps(_mm_loadu_si128((const __m128i *)(const void *)(base + at[k + 4])));
    }
    turn_four(lo);
    turn_four(hi);
    for (int k = 0; k < 4; k++) {
        out[k] = f8_bits((f8){lo[k], hi[k]});
    }
}

LANES_CALL void put_four_words(char *base, size_t stride, const f8 in[4])
{
    __m128 lo[4] = {in[0].lo, in[1].lo, in[2].lo, in[3].lo}, hi[4] = {in[0].hi, in[1].hi, in[2].hi, in[3].hi};
    turn_four(lo);
    turn_four(hi);
    for (size_t k = 0; k < 4; k++) {
        _mm_storeu_ps((float *)(void *)(base + k * stride), lo[k]);
        _mm_storeu_ps((float *)(void *)(base + (k + 4) * stride), hi[k]);
    }
}

#endif
