/* Seeded random numbers: the same on every machine.
 * Layer: base. */
#ifndef SL_BASE_RNG_H
#define SL_BASE_RNG_H

#include <stdint.h>

typedef struct sl_rng {
    uint64_t state;
} sl_rng;

static inline sl_rng sl_rng_seed(uint64_t seed)
{
    return (sl_rng){seed};
}

/* 64 random bits. Source: Steele, Lea, Flood 2014, "Fast splittable pseudorandom number generators" (SplitMix64). */
static inline uint64_t sl_rng_bits(sl_rng *rng)
{
    uint64_t z = (rng->state += 0x9e3779b97f4a7c15u);
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return z ^ (z >> 31);
}

/* Uniform in [0, 1), 53 bits. */
static inline double sl_rng_uniform(sl_rng *rng)
{
    return (double)(sl_rng_bits(rng) >> 11) * 0x1p-53;
}

#endif
