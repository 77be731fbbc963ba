/* Eight numbers at a time. The kernels of the frame are written once, in these terms, and compiled three times:
 * for the registers of AVX2, for those of SSE2 and for any machine. Every operation is one of IEEE 754 or of integers,
 * so both give the same bytes.
 *
 *     f8_min(a, b)    a < b ? a : b, so b where one is NaN; f8_max alike
 *     f8_whole        towards 0; what does not fit has no meaning
 *     x_less, _equal  all bits set where true; x_select(mask, a, b) is a there and b elsewhere; signs: a bit a lane
 *     f8_bits         the same bits as integers; i8_bits as floats
 *     i8_without      a & ~b; i8_up and i8_down shift, i8_down keeps the sign
 *     d8_...          eight doubles; round: to nearest, as lrint; points: x, y, z of eight points
 *     i8_tint         four bytes a lane, as tint
 *     four_words      out[i], lane k = word i of those at base + at[k] bytes; put_four_words: to rows a stride apart
 *
 * SL_LANES_AVX2 or SL_LANES_SSE2 chooses. Layer: render, private. */
#ifndef SL_RENDER_FRAME_LANES_H
#define SL_RENDER_FRAME_LANES_H

#include <stddef.h>
#include <stdint.h>

/* Sanitised builds keep functions apart: instrumented and in one, kernels take minutes to compile. */
#if defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(undefined_behavior_sanitizer)
#define LANES_SANITIZED 1
#endif
#endif
#if defined(__SANITIZE_ADDRESS__) || defined(LANES_SANITIZED)
#define LANES_STATIC static
#define LANES_INLINE noinline, unused
#else
#define LANES_STATIC static inline
#define LANES_INLINE always_inline
#endif

/* sRGB's curve is (1 + 0.055) light^(1/2.4) - 0.055 but for its darkest colours, so a byte under less light is
 * (byte + 14.03) power - 14.03 with power = light^(1/2.4), for all three channels alike; the fourth byte becomes 255.
 * Bytes in 1/128, 14.03 as 1795; power in 1/65536, below 65536. */
enum { TINT_BITS = 7, TINT_TOE = 1795 };

static inline uint32_t tint(uint32_t color, uint32_t power)
{
    const uint32_t rest = TINT_TOE - (1u << (TINT_BITS - 1));
    uint32_t tinted = 0xff000000u;
    for (int bit = 0; bit < 24; bit += 8) {
        const uint32_t value = ((((color >> bit) & 0xffu) << TINT_BITS) + TINT_TOE) * power >> 16;
        tinted |= (value > rest ? value - rest : 0u) >> TINT_BITS << bit;
    }
    return tinted;
}

#if defined(SL_LANES_AVX2)
#include "render/frame_doubles_avx2.h"
#elif defined(SL_LANES_SSE2)
#include "render/frame_doubles_sse2.h"
#else
#include "render/frame_doubles_portable.h"
#endif

#endif
