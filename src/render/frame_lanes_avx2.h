/* Eight lanes in AVX2's registers; see frame_lanes.h.
 * Layer: render, private. */
#ifndef SL_RENDER_FRAME_LANES_AVX2_H
#define SL_RENDER_FRAME_LANES_AVX2_H

#include <immintrin.h>

#define LANES_TARGET __attribute__((target("avx2")))
#define LANES_CALL LANES_STATIC __attribute__((target("avx2"), LANES_INLINE))

typedef __m256 f8;
typedef __m256i i8;

LANES_CALL f8 f8_all(float a)
{
    return _mm256_set1_ps(a);
}

LANES_CALL f8 f8_load(const float *p)
{
    return _mm256_loadu_ps(p);
}

LANES_CALL void f8_store(float *p, f8 a)
{
    _mm256_storeu_ps(p, a);
}

LANES_CALL f8 f8_add(f8 a, f8 b)
{
    return _mm256_add_ps(a, b);
}

LANES_CALL f8 f8_sub(f8 a, f8 b)
{
    return _mm256_sub_ps(a, b);
}

LANES_CALL f8 f8_mul(f8 a, f8 b)
{
    return _mm256_mul_ps(a, b);
}

LANES_CALL f8 f8_div(f8 a, f8 b)
{
    return _mm256_div_ps(a, b);
}

LANES_CALL f8 f8_root(f8 a)
{
    return _mm256_sqrt_ps(a);
}

LANES_CALL f8 f8_min(f8 a, f8 b)
{
    return _mm256_min_ps(a, b);
}

LANES_CALL f8 f8_max(f8 a, f8 b)
{
    return _mm256_max_ps(a, b);
}

LANES_CALL f8 f8_abs(f8 a)
{
    return _mm256_andnot_ps(_mm256_set1_ps(-0.0f), a);
}

LANES_CALL i8 f8_less(f8 a, f8 b)
{
    return _mm256_castps_si256(_mm256_cmp_ps(a, b, _CMP_LT_OQ));
}

LANES_CALL i8 f8_bits(f8 a)
{
    return _mm256_castps_si256(a);
}

LANES_CALL i8 f8_whole(f8 a)
{
    return _mm256_cvttps_epi32(a);
}

LANES_CALL i8 i8_all(int32_t a)
{
    return _mm256_set1_epi32(a);
}

LANES_CALL i8 i8_load(const int32_t *p)
{
    return _mm256_loadu_si256((const __m256i *)(const void *)p);
}

LANES_CALL void i8_store(int32_t *p, i8 a)
{
    _mm256_storeu_si256((__m256i *)(void *)p, a);
}

LANES_CALL i8 i8_add(i8 a, i8 b)
{
    return _mm256_add_epi32(a, b);
}

LANES_CALL i8 i8_sub(i8 a, i8 b)
{
    return _mm256_sub_epi32(a, b);
}

LANES_CALL i8 i8_mul(i8 a, i8 b)
{
    return _mm256_mullo_epi32(a, b);
}

LANES_CALL i8 i8_and(i8 a, i8 b)
{
    return _mm256_and_si256(a, b);
}

LANES_CALL i8 i8_or(i8 a, i8 b)
{
    return _mm256_or_si256(a, b);
}

LANES_CALL i8 i8_without(i8 a, i8 b)
{
    return _mm256_andnot_si256(b, a);
}

LANES_CALL i8 i8_less(i8 a, i8 b)
{
    return _mm256_cmpgt_epi32(b, a);
}

LANES_CALL i8 i8_equal(i8 a, i8 b)
{
    return _mm256_cmpeq_epi32(a, b);
}

LANES_CALL i8 i8_min(i8 a, i8 b)
{
    return _mm256_min_epi32(a, b);
}

LANES_CALL i8 i8_max(i8 a, i8 b)
{
    return _mm256_max_epi32(a, b);
}

LANES_CALL i8 i8_up(i8 a, int32_t bits)
{
    return _mm256_sll_epi32(a, _mm_cvtsi32_si128(bits));
}

LANES_CALL i8 i8_down(i8 a, int32_t bits)
{
    return _mm256_sra_epi32(a, _mm_cvtsi32_si128(bits));
}

LANES_CALL f8 i8_float(i8 a)
{
    return _mm256_cvtepi32_ps(a);
}

LANES_CALL f8 i8_bits(i8 a)
{
    return _mm256_castsi256_ps(a);
}

LANES_CALL i8 i8_select(i8 mask, i8 a, i8 b)
{
    return _mm256_blendv_epi8(b, a, mask);
}

LANES_CALL f8 f8_select(i8 mask, f8 a, f8 b)
{
    return _mm256_blendv_ps(b, a, _mm256_castsi256_ps(mask));
}

LANES_CALL uint32_t i8_signs(i8 a)
{
    return (uint32_t)_mm256_movemask_ps(_mm256_castsi256_ps(a));
}

LANES_CALL i8 i8_tint(i8 color, i8 power)
{
    const __m256i zero = _mm256_setzero_si256(), toe = _mm256_set1_epi16(TINT_TOE);
    const __m256i rest = _mm256_set1_epi16(TINT_TOE - (1 << (TINT_BITS - 1)));
    const __m256i twice = _mm256_or_si256(power, _mm256_slli_epi32(power, 16));
    __m256i lo = _mm256_slli_epi16(_mm256_unpacklo_epi8(color, zero), TINT_BITS);
    __m256i hi = _mm256_slli_epi16(_mm256_unpackhi_epi8(color, zero), TINT_BITS);
    lo = _mm256_mulhi_epu16(_mm256_add_epi16(lo, toe), _mm256_unpacklo_epi32(twice, twice));
    hi = _mm256_mulhi_epu16(_mm256_add_epi16(hi, toe), _mm256_unpackhi_epi32(twice, twice));
    lo = _mm256_srli_epi16(_mm256_subs_epu16(lo, rest), TINT_BITS);
    hi = _mm256_srli_epi16(_mm256_subs_epu16(hi, rest), TINT_BITS);
    return _mm256_or_si256(_mm256_packus_epi16(lo, hi), _mm256_set1_epi32((int32_t)0xff000000u));
}

/* Halves of the registers hold rows k and k + 4, so that four-word transposes within halves are all it takes. */
LANES_CALL __m256 two_rows(const char *base, int64_t low, int64_t high)
{
    const __m128i a = _mm_loadu_si128((const __m128i *)(const void *)(base + low));
    const __m128i b = _mm_loadu_si128((const __m128i *)(const void *)(base + high));
    return _mm256_castsi256_ps(_mm256_inserti128_si256(_mm256_castsi128_si256(a), b, 1));
}

LANES_CALL void four_words(const char *base, const int64_t at[8], i8 out[4])
{
    const __m256 a = two_rows(base, at[0], at[4]), b = two_rows(base, at[1], at[5]);
    const __m256 c = two_rows(base, at[2], at[6]), d = two_rows(base, at[3], at[7]);
    const __m256 ab = _mm256_unpacklo_ps(a, b), cd = _mm256_unpacklo_ps(c, d);
    const __m256 ab2 = _mm256_unpackhi_ps(a, b), cd2 = _mm256_unpackhi_ps(c, d);
    out[0] = _mm256_castps_si256(_mm256_shuffle_ps(ab, cd, 0x44));
    out[1] = _mm256_castps_si256(_mm256_shuffle_ps(ab, cd, 0xee));
    out[2] = _mm256_castps_si256(_mm256_shuffle_ps(ab2, cd2, 0x44));
    out[3] = _mm256_castps_si256(_mm256_shuffle_ps(ab2, cd2, 0xee));
}

LANES_CALL void put_four_words(char *base, size_t stride, const f8 in[4])
{
    const __m256 ab = _mm256_unpacklo_ps(in[0], in[1]), cd = _mm256_unpacklo_ps(in[2], in[3]);
    const __m256 ab2 = _mm256_unpackhi_ps(in[0], in[1]), cd2 = _mm256_unpackhi_ps(in[2], in[3]);
    const __m256 row[4] = {_mm256_shuffle_ps(ab, cd, 0x44), _mm256_shuffle_ps(ab, cd, 0xee),
                           _mm256_shuffle_ps(ab2, cd2, 0x44), _mm256_shuffle_ps(ab2, cd2, 0xee)};
    for (size_t k = 0; k < 4; k++) {
        _mm_storeu_ps((float *)(void *)(base + k * stride), _mm256_castps256_ps128(row[k]));
        _mm_storeu_ps((float *)(void *)(base + (k + 4) * stride), _mm256_extractf128_ps(row[k], 1));
    }
}

#endif
