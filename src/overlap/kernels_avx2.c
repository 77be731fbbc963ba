#include "overlap/kernels_internal.h"

#if defined(__x86_64__)

#include "overlap/raster_internal.h"

#include <immintrin.h>

#define AVX2 __attribute__((target("avx2")))

/* Steps 1 to 3 of the fill rule for two points; see sl_raster_snap for why the double product replaces the fused one.
 */
AVX2 static inline __m128i snap_two(__m256d uv, __m256d half)
{
    const __m128 u = _mm256_cvtpd_ps(uv);
    const __m128 clip = _mm_sub_ps(_mm_add_ps(u, u), _mm_set1_ps(1.0f));
    const __m128 window = _mm256_cvtpd_ps(_mm256_add_pd(_mm256_mul_pd(_mm256_cvtps_pd(clip), half), half));
    return _mm_cvtps_epi32(_mm_mul_ps(_mm_sub_ps(window, _mm_set1_ps(0.5f)), _mm_set1_ps((float)SL_RASTER_SUBPIXEL)));
}

AVX2 static bool snap(int64_t n, const double *uv, int32_t width, int32_t height, int32_t *position)
{
    const __m256d half = _mm256_setr_pd(0.5 * width, 0.5 * height, 0.5 * width, 0.5 * height);
    /* As in the portable twin. */
    const __m256d reach =
        _mm256_min_pd(_mm256_div_pd(_mm256_set1_pd(0x1p19), half), _mm256_set1_pd(SL_RASTER_MAX_COORDINATE));
    const __m256d sign_bit = _mm256_set1_pd(-0.0);
    __m256d good = _mm256_cmp_pd(half, half, _CMP_EQ_OQ);
    int64_t v = 0;
    for (; v + 2 <= n; v += 2) {
        const __m256d p = _mm256_loadu_pd(uv + 2 * v);
        good = _mm256_and_pd(good, _mm256_cmp_pd(_mm256_andnot_pd(sign_bit, p), reach, _CMP_LT_OQ));
        _mm_storeu_si128((__m128i *)(void *)(position + 2 * v), snap_two(p, half));
    }
    bool rest = true;
    if (v < n) {
        rest = sl_raster_kernels_portable().snap(1, uv + 2 * v, width, height, position + 2 * v);
    }
    return rest && _mm256_movemask_pd(good) == 0xf;
}

AVX2 static inline __m256i load_points(const int32_t *corner, const int32_t *position)
{
    const __m128i index = _mm_loadu_si128((const __m128i *)(const void *)corner);
    return _mm256_i32gather_epi64((const long long *)(const void *)position, index, 8);
}

/* Four triangles at a time, a point in each 64-bit lane: x below, y above. */
AVX2 static void orient(int64_t begin, int64_t end, int32_t *const corner[3], const int32_t *position, int8_t *sign)
{
    int64_t t = begin;
    for (; t + 4 <= end; t += 4) {
        const __m256i p = load_points(corner[0] + t, position);
        const __m256i q = _mm256_sub_epi32(load_points(corner[1] + t, position), p);
        const __m256i r = _mm256_sub_epi32(load_points(corner[2] + t, position), p);
        const __m256i left = _mm256_mul_epi32(q, _mm256_srli_epi64(r, 32));
        const __m256i right = _mm256_mul_epi32(r, _mm256_srli_epi64(q, 32));
        const int more = _mm256_movemask_pd(_mm256_castsi256_pd(_mm256_cmpgt_epi64(right, left)));
        const int less = _mm256_movemask_pd(_mm256_castsi256_pd(_mm256_cmpgt_epi64(left, right)));
        for (int k = 0; k < 4; k++) {
            sign[t + k] = (int8_t)((more >> k & 1) - (less >> k & 1));
        }
    }
    sl_raster_kernels_portable().orient(t, end, corner, position, sign);
}

/* Inclusive prefix sum of eight differences on top of *carry, which becomes the last of them eight times. */
AVX2 static inline __m256i scan_eight(int32_t *difference, __m256i *carry)
{
    __m256i v = _mm256_loadu_si256((const __m256i *)(const void *)difference);
    _mm256_storeu_si256((__m256i *)(void *)difference, _mm256_setzero_si256());
    v = _mm256_add_epi32(v, _mm256_slli_si256(v, 4));
    v = _mm256_add_epi32(v, _mm256_slli_si256(v, 8));
    const __m256i low_total = _mm256_permute2x128_si256(v, v, 0x08); /* lower half to the upper, zero below */
    v = _mm256_add_epi32(v, _mm256_shuffle_epi32(low_total, 0xff));
    v = _mm256_add_epi32(v, *carry);
    *carry = _mm256_permutevar8x32_epi32(v, _mm256_set1_epi32(7));
    return v;
}

AVX2 static int32_t sum_lanes(__m256i v)
{
    int32_t lane[8], sum = 0;
    _mm256_storeu_si256((__m256i *)(void *)lane, v);
    for (int k = 0; k < 8; k++) {
        sum += lane[k];
    }
    return sum;
}

AVX2 static void prefix(int32_t width, int32_t *difference, uint16_t *count, int32_t sums[2])
{
    const __m256i one = _mm256_set1_epi32(1), zero = _mm256_setzero_si256();
    __m256i carry = zero, once = zero, twice = zero;
    int32_t x = 0;
    for (; x + 16 <= width; x += 16) {
        const __m256i a = scan_eight(difference + x, &carry), b = scan_eight(difference + x + 8, &carry);
        once = _mm256_sub_epi32(once, _mm256_add_epi32(_mm256_cmpgt_epi32(a, zero), _mm256_cmpgt_epi32(b, zero)));
        twice = _mm256_sub_epi32(twice, _mm256_add_epi32(_mm256_cmpgt_epi32(a, one), _mm256_cmpgt_epi32(b, one)));
        const __m256i packed = _mm256_permute4x64_epi64(_mm256_packus_epi32(a, b), 0xd8); /* saturates at 65535 */
        _mm256_storeu_si256((__m256i *)(void *)(count + x), packed);
    }
    if (x < width) {
        difference[x] += _mm256_extract_epi32(carry, 0);
    }
    sl_raster_kernels_portable().prefix(width - x, difference + x, count + x, sums);
    sums[0] += sum_lanes(once);
    sums[1] += sum_lanes(twice);
}

bool sl_raster_kernels_avx2(sl_raster_kernels *kernels)
{
    if (!__builtin_cpu_supports("avx2")) {
        return false;
    }
    *kernels = (sl_raster_kernels){snap, orient, prefix};
    return true;
}

#else

bool sl_raster_kernels_avx2(sl_raster_kernels *kernels)
{
    (void)kernels;
    return false;
}

#endif
