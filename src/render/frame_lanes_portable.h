/* Eight lanes as arrays; see frame_lanes.h. Integers wrap as those of registers do: sums are made unsigned.
 * Layer: render, private. */
#ifndef SL_RENDER_FRAME_LANES_PORTABLE_H
#define SL_RENDER_FRAME_LANES_PORTABLE_H

#include <math.h>
#include <string.h>

#define LANES_TARGET
#define LANES_CALL LANES_STATIC __attribute__((LANES_INLINE))

typedef struct f8 {
    float v[8];
} f8;

typedef struct i8 {
    int32_t v[8];
} i8;

LANES_CALL f8 f8_all(float a)
{
    f8 r;
    for (int k = 0; k < 8; k++) {
        r.v[k] = a;
    }
    return r;
}

LANES_CALL f8 f8_load(const float *p)
{
    f8 r;
    memcpy(r.v, p, sizeof r.v);
    return r;
}

LANES_CALL void f8_store(float *p, f8 a)
{
    memcpy(p, a.v, sizeof a.v);
}

LANES_CALL i8 i8_all(int32_t a)
{
    i8 r;
    for (int k = 0; k < 8; k++) {
        r.v[k] = a;
    }
    return r;
}

LANES_CALL i8 i8_load(const int32_t *p)
{
    i8 r;
    memcpy(r.v, p, sizeof r.v);
    return r;
}

LANES_CALL void i8_store(int32_t *p, i8 a)
{
    memcpy(p, a.v, sizeof a.v);
}

LANES_CALL f8 f8_add(f8 a, f8 b)
{
    for (int k = 0; k < 8; k++) {
        a.v[k] += b.v[k];
    }
    return a;
}

LANES_CALL f8 f8_sub(f8 a, f8 b)
{
    for (int k = 0; k < 8; k++) {
        a.v[k] -= b.v[k];
    }
    return a;
}

LANES_CALL f8 f8_mul(f8 a, f8 b)
{
    for (int k = 0; k < 8; k++) {
        a.v[k] *= b.v[k];
    }
    return a;
}

LANES_CALL f8 f8_div(f8 a, f8 b)
{
    for (int k = 0; k < 8; k++) {
        a.v[k] /= b.v[k];
    }
    return a;
}

LANES_CALL f8 f8_min(f8 a, f8 b)
{
    for (int k = 0; k < 8; k++) {
        a.v[k] = a.v[k] < b.v[k] ? a.v[k] : b.v[k];
    }
    return a;
}

LANES_CALL f8 f8_max(f8 a, f8 b)
{
    for (int k = 0; k < 8; k++) {
        a.v[k] = a.v[k] > b.v[k] ? a.v[k] : b.v[k];
    }
    return a;
}

LANES_CALL f8 f8_root(f8 a)
{
    for (int k = 0; k < 8; k++) {
        a.v[k] = sqrtf(a.v[k]);
    }
    return a;
}

LANES_CALL f8 f8_abs(f8 a)
{
    for (int k = 0; k < 8; k++) {
        a.v[k] = fabsf(a.v[k]);
    }
    return a;
}

LANES_CALL i8 f8_less(f8 a, f8 b)
{
    i8 r;
    for (int k = 0; k < 8; k++) {
        r.v[k] = -(a.v[k] < b.v[k]);
    }
    return r;
}

LANES_CALL i8 f8_bits(f8 a)
{
    i8 r;
    memcpy(r.v, a.v, sizeof r.v);
    return r;
}

LANES_CALL f8 i8_bits(i8 a)
{
    f8 r;
    memcpy(r.v, a.v, sizeof r.v);
    return r;
}

LANES_CALL i8 f8_whole(f8 a)
{
    i8 r;
    for (int k = 0; k < 8; k++) {
        r.v[k] = (int32_t)a.v[k];
    }
    return r;
}

LANES_CALL f8 i8_float(i8 a)
{
    f8 r;
    for (int k = 0; k < 8; k++) {
        r.v[k] = (float)a.v[k];
    }
    return r;
}

LANES_CALL i8 i8_add(i8 a, i8 b)
{
    for (int k = 0; k < 8; k++) {
        a.v[k] = (int32_t)((uint32_t)a.v[k] + (uint32_t)b.v[k]);
    }
    return a;
}

LANES_CALL i8 i8_sub(i8 a, i8 b)
{
    for (int k = 0; k < 8; k++) {
        a.v[k] = (int32_t)((uint32_t)a.v[k] - (uint32_t)b.v[k]);
    }
    return a;
}

LANES_CALL i8 i8_mul(i8 a, i8 b)
{
    for (int k = 0; k < 8; k++) {
        a.v[k] = (int32_t)((uint32_t)a.v[k] * (uint32_t)b.v[k]);
    }
    return a;
}

LANES_CALL i8 i8_and(i8 a, i8 b)
{
    for (int k = 0; k < 8; k++) {
        a.v[k] &= b.v[k];
    }
    return a;
}

LANES_CALL i8 i8_or(i8 a, i8 b)
{
    for (int k = 0; k < 8; k++) {
        a.v[k] |= b.v[k];
    }
    return a;
}

LANES_CALL i8 i8_without(i8 a, i8 b)
{
    for (int k = 0; k < 8; k++) {
        a.v[k] &= ~b.v[k];
    }
    return a;
}

LANES_CALL i8 i8_less(i8 a, i8 b)
{
    for (int k = 0; k < 8; k++) {
        a.v[k] = -(a.v[k] < b.v[k]);
    }
    return a;
}

LANES_CALL i8 i8_equal(i8 a, i8 b)
{
    for (int k = 0; k < 8; k++) {
        a.v[k] = -(a.v[k] == b.v[k]);
    }
    return a;
}

LANES_CALL i8 i8_min(i8 a, i8 b)
{
    for (int k = 0; k < 8; k++) {
        a.v[k] = a.v[k] < b.v[k] ? a.v[k] : b.v[k];
    }
    return a;
}

LANES_CALL i8 i8_max(i8 a, i8 b)
{
    for (int k = 0; k < 8; k++) {
        a.v[k] = a.v[k] > b.v[k] ? a.v[k] : b.v[k];
    }
    return a;
}

LANES_CALL i8 i8_up(i8 a, int32_t bits)
{
    for (int k = 0; k < 8; k++) {
        a.v[k] = (int32_t)((uint32_t)a.v[k] << bits);
    }
    return a;
}

LANES_CALL i8 i8_down(i8 a, int32_t bits)
{
    for (int k = 0; k < 8; k++) {
        a.v[k] >>= bits;
    }
    return a;
}

LANES_CALL i8 i8_select(i8 mask, i8 a, i8 b)
{
    for (int k = 0; k < 8; k++) {
        a.v[k] = (a.v[k] & mask.v[k]) | (b.v[k] & ~mask.v[k]);
    }
    return a;
}

LANES_CALL f8 f8_select(i8 mask, f8 a, f8 b)
{
    return i8_bits(i8_select(mask, f8_bits(a), f8_bits(b)));
}

LANES_CALL uint32_t i8_signs(i8 a)
{
    uint32_t r = 0;
    for (int k = 0; k < 8; k++) {
        r |= (uint32_t)a.v[k] >> 31 << k;
    }
    return r;
}

LANES_CALL i8 i8_tint(i8 color, i8 power)
{
    for (int k = 0; k < 8; k++) {
        color.v[k] = (int32_t)tint((uint32_t)color.v[k], (uint32_t)power.v[k]);
    }
    return color;
}

LANES_CALL void four_words(const char *base, const int64_t at[8], i8 out[4])
{
    for (int k = 0; k < 8; k++) {
        int32_t word[4];
        memcpy(word, base + at[k], sizeof word);
        for (int i = 0; i < 4; i++) {
            out[i].v[k] = word[i];
        }
    }
}

LANES_CALL void put_four_words(char *base, size_t stride, const f8 in[4])
{
    for (size_t k = 0; k < 8; k++) {
        const float word[4] = {in[0].v[k], in[1].v[k], in[2].v[k], in[3].v[k]};
        memcpy(base + k * stride, word, sizeof word);
    }
}

#endif
