/* Dense kernels of the Cholesky factorisation and its solves, one set for each width of the machine's vectors;
 * internal to the room.
 *
 * A panel is stored in slabs: runs of eight rows (the last run shorter), each slab column by column, so that entry
 * (i, k) of a slab of r rows lies at k * r + i. First come the slabs of the panel's own rows, slab g with the columns
 * 0 .. 8 g + r - 1 (its last tile's upper half is unused; the diagonal holds reciprocals of the roots), then the slabs
 * of the rows below with all columns. An update matrix is a packed lower triangle, row by row.
 * Layer: sparse. */
#ifndef SL_SPARSE_KERNELS_H
#define SL_SPARSE_KERNELS_H

#include "base/status.h"

/* How a kernel's parts are put into it. Sanitised builds leave that to the compiler: instrumented and inlined into one
 * function they cost clang minutes and gigabytes. */
#if defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(undefined_behavior_sanitizer)
#define SL_KERNEL_SANITIZED 1
#endif
#endif
#if defined(__SANITIZE_ADDRESS__) || defined(SL_KERNEL_SANITIZED)
#define SL_KERNEL_INLINE unused
#else
#define SL_KERNEL_INLINE always_inline
#endif

#define SL_SLAB 8

/* Depth of a product before its operands would leave the first-level cache. */
#define SL_KERNEL_DEPTH 128

/* Doubles before slab g of a panel's own rows. */
static inline int64_t sl_slab_offset(int64_t g)
{
    return g * (g + 1) / 2 * (SL_SLAB * SL_SLAB);
}

/* Doubles of the own rows of a panel of `width` columns. */
static inline int64_t sl_own_size(int32_t width)
{
    const int64_t g = width / SL_SLAB, r = width % SL_SLAB;
    return sl_slab_offset(g) + r * width;
}

/* Where entry (row, column) lies: of the own rows (column <= row), and of the rows below from sl_own_size on. */
static inline int64_t sl_own_place(int32_t width, int32_t row, int32_t column)
{
    const int32_t g = row / SL_SLAB, left = width - g * SL_SLAB, r = left < SL_SLAB ? left : SL_SLAB;
    return sl_slab_offset(g) + (int64_t)column * r + row % SL_SLAB;
}

static inline int64_t sl_below_place(int32_t width, int32_t below, int32_t row, int32_t column)
{
    const int32_t g = row / SL_SLAB, left = below - g * SL_SLAB, r = left < SL_SLAB ? left : SL_SLAB;
    return (int64_t)g * SL_SLAB * width + (int64_t)column * r + row % SL_SLAB;
}

/* Entries of a packed lower triangle of `rows` rows. */
static inline int64_t sl_packed_size(int64_t rows)
{
    return rows * (rows + 1) / 2;
}

/* How pivots are treated: d is good when it (with sign: |d|) is above `least`. replacement > 0 stands in for bad ones;
 * otherwise the first bad one ends the factorisation. */
typedef struct sl_pivoting {
    double least, replacement;
} sl_pivoting;

/* Right-hand sides of a solve: row r of the block begins at X + (r - origin) * w; a row -1 - k at outside + k * w. */
typedef struct sl_rows {
    double *X, *outside;
    int32_t w, origin;
} sl_rows;

typedef struct sl_kernels {
    const char *name;

    /* panel := L of P A P' = L S L', in steps: open; for every SL_KERNEL_DEPTH-th column `begin`, columns (which
     * returns the bad column or -1), then trail over the pairs [0, sl_trail_pairs) of slabs; close. sign: width, NULL =
     * S is I. spare: sl_front_spare(width) doubles from open to the last update. */
    void (*open)(double *panel, int32_t width, int32_t below, double *spare);
    int32_t (*columns)(double *panel, int32_t width, int32_t below, int32_t begin, sl_pivoting pivoting, int8_t *sign,
                       double *spare);
    void (*trail)(double *panel, int32_t width, int32_t below, int32_t begin, int8_t *sign, double *spare,
                  int32_t pair_begin, int32_t pair_end);
    void (*close)(double *panel, int32_t width, int32_t below, double *spare);

    /* U := -L21 S L21' for the pairs of column slabs [begin, end) of sl_slab_pairs(below). */
    void (*update)(const double *panel, int32_t width, int32_t below, const int8_t *sign, double *spare, int32_t begin,
                   int32_t end, double *U);

    /* own rows := inv(L11) own rows, rows below -= L21 own rows. own: the first of the supernode's rows. */
    void (*forward)(const double *panel, int32_t width, int32_t below, const int32_t *row, double *own, sl_rows rows);

    /* own rows := inv(L11') (own rows - L21' rows below). */
    void (*backward)(const double *panel, int32_t width, int32_t below, const int32_t *row, double *own, sl_rows rows);
} sl_kernels;

static inline int64_t sl_front_spare(int32_t width)
{
    return 3 * SL_SLAB * ((int64_t)width + SL_SLAB);
}

static inline int32_t sl_slab_pairs(int32_t below)
{
    return (below + 2 * SL_SLAB - 1) / (2 * SL_SLAB);
}

/* Pairs of slabs right of and below the columns from `begin` on; 0 when these are the last. */
static inline int32_t sl_trail_pairs(int32_t width, int32_t below, int32_t begin)
{
    const int32_t end = begin + SL_KERNEL_DEPTH;
    const int32_t slabs = (width + SL_SLAB - 1) / SL_SLAB + (below + SL_SLAB - 1) / SL_SLAB - end / SL_SLAB;
    return end < width ? (slabs + 1) / 2 : 0;
}

/* The widest this machine runs. */
const sl_kernels *sl_kernels_best(void);

/* The k-th set from the plainest up; NULL beyond those this machine runs. All give the same bytes. */
const sl_kernels *sl_kernels_at(int32_t k);

extern const sl_kernels sl_kernels_scalar;
#if defined(__x86_64__)
extern const sl_kernels sl_kernels_v3; /* AVX2 and FMA */
extern const sl_kernels sl_kernels_v4; /* AVX-512 */
#endif

#endif
