/* The arithmetic of the stretch minimiser, 32 triangles at a time; one set of kernels for each width of the machine's
 * vectors. All do the same operations in the same order: the same bytes.
 * Layer: param; private to it and to its tests. */
#ifndef SL_PARAM_STRETCH_KERNELS_H
#define SL_PARAM_STRETCH_KERNELS_H

#include "base/status.h"

#if defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(undefined_behavior_sanitizer)
#define SL_STRETCH_SANITIZED 1
#endif
#endif
#if defined(__SANITIZE_ADDRESS__) || defined(SL_STRETCH_SANITIZED)
#define SL_STRETCH_INLINE unused /* instrumented and inlined into one function they cost the compiler minutes */
#else
#define SL_STRETCH_INLINE always_inline
#endif

enum {
    SL_STRIP = 32,        /* triangles of a strip: one lane each */
    SL_STRETCH_LANES = 8, /* partial sums */
    SL_ELEMENT = 21       /* entries of a triangle's Hessian */
};

/* One row a lane quantity. Rest shapes: gradients of the hat functions at corners 1 and 2 (x, y each; corner 0 has
 * minus their sum), the share of the total area, and the same again where the triangle counts for L2; 0 in lanes beyond
 * the last triangle, which repeat it. */
typedef struct sl_strip_rest {
    double gradient[4][SL_STRIP];
    double weight[SL_STRIP], counted[SL_STRIP];
} sl_strip_rest;

/* u and v of the three corners: places, or directions. */
typedef double sl_strip_corners[6][SL_STRIP];

/* Sums over strips, a lane of eight each. least: min of det J; sure: min of what proves a triangle's area positive in
 * spite of rounding. Both are at most 0 or not a number when that fails. */
typedef struct sl_stretch_lanes {
    double energy[SL_STRETCH_LANES], inverse[SL_STRETCH_LANES], area[SL_STRETCH_LANES];
    double least[SL_STRETCH_LANES], sure[SL_STRETCH_LANES];
} sl_stretch_lanes;

typedef struct sl_stretch_kernels {
    const char *name;

    /* J of each lane. */
    void (*jacobian)(sl_strip_corners corners, double gradient[4][SL_STRIP], double J[4][SL_STRIP]);

    /* force += is up to the caller: d (weight psi) / d corners, u and v of each. */
    void (*force)(double w, const double *weight, double gradient[4][SL_STRIP], double J[4][SL_STRIP],
                  sl_strip_corners force);

    /* The projected Hessian in the corners' places: for corners k = 0, 1, 2 the entries uu, uv, vv; then for the pairs
     * (0, 1), (1, 2), (2, 0) of corners uu, uv, vu, vv, the first letter being the first corner's. */
    void (*element)(double w, const double *weight, double gradient[4][SL_STRIP], double J[4][SL_STRIP],
                    double element[SL_ELEMENT][SL_STRIP]);

    /* Adds a strip to the sums. */
    void (*measure)(double w, const sl_strip_rest *rest, sl_strip_corners corners, sl_stretch_lanes *lanes);

    /* bound[l] = min with the steps along `direction` at which lane l's areas first vanish. */
    void (*bound)(sl_strip_corners corners, sl_strip_corners direction, double bound[SL_STRETCH_LANES]);
} sl_stretch_kernels;

extern const sl_stretch_kernels sl_stretch_kernels_scalar;
#if defined(__x86_64__)
extern const sl_stretch_kernels sl_stretch_kernels_v3, sl_stretch_kernels_v4;
#endif

/* The k-th set this machine can run, from the plainest on; NULL beyond the last. And the last. */
const sl_stretch_kernels *sl_stretch_kernels_at(int32_t k);
const sl_stretch_kernels *sl_stretch_kernels_best(void);

#endif
