/* Bodies of the factorisation's kernels; included by each of kernels_*.c after its vectors of eight doubles.
 * Blocks of eight columns are eliminated from the left within SL_KERNEL_DEPTH columns, whose product is then subtracted
 * from all columns to their right: operands stay in the caches, tiles of 16 x 8 in registers.
 * Layer: sparse. */
#include "sparse/kernels.h"

#include <math.h>
#include <stddef.h>

/* A panel at work. Ragged slabs are copied to `spare`, eight rows each, zeros below, and back. */
typedef struct front {
    double *panel, *lower; /* slabs of the own rows, of the rows below */
    int32_t width, below;
    int32_t own_full, below_full; /* whole slabs */
    int32_t own_slabs, below_slabs;
    double *own_tail, *below_tail;
    double *factor; /* width x 8: a slab times the signs of D */
    int8_t *sign;
} front;

SL_KERNEL front front_at(double *panel, int32_t width, int32_t below, int8_t *sign, double *spare)
{
    const int64_t room = SL_SLAB * ((int64_t)width + SL_SLAB);
    front f = {.panel = panel, .lower = panel + sl_own_size(width), .width = width, .below = below, .sign = sign};
    f.own_full = width / SL_SLAB;
    f.below_full = below / SL_SLAB;
    f.own_slabs = (width + SL_SLAB - 1) / SL_SLAB;
    f.below_slabs = (below + SL_SLAB - 1) / SL_SLAB;
    f.own_tail = spare;
    f.below_tail = spare + room;
    f.factor = spare + 2 * room;
    return f;
}

SL_KERNEL double *own_slab(const front *f, int32_t g)
{
    return g < f->own_full ? f->panel + sl_slab_offset(g) : f->own_tail;
}

SL_KERNEL double *below_slab(const front *f, int32_t g)
{
    return g < f->below_full ? f->lower + (int64_t)g * SL_SLAB * f->width : f->below_tail;
}

/* Slabs of the own rows, then those below. */
SL_KERNEL double *any_slab(const front *f, int32_t g)
{
    return g < f->own_slabs ? own_slab(f, g) : below_slab(f, g - f->own_slabs);
}

SL_KERNEL void pad_slab(const double *ragged, int32_t rows, int32_t columns, double *padded)
{
    for (int32_t k = 0; k < columns; k++) {
        vec_store(padded + (int64_t)k * SL_SLAB, vec_load_part(ragged + (int64_t)k * rows, rows));
    }
}

SL_KERNEL void unpad_slab(const double *padded, int32_t rows, int32_t columns, double *ragged)
{
    for (int32_t k = 0; k < columns; k++) {
        vec_store_part(ragged + (int64_t)k * rows, vec_load(padded + (int64_t)k * SL_SLAB), rows);
    }
}

SL_KERNEL bool any_negative(const int8_t *sign, int32_t begin, int32_t end)
{
    int8_t all = 1;
    for (int32_t k = begin; k < end && sign != NULL; k++) {
        all = all < sign[k] ? all : sign[k];
    }
    return all < 0;
}

/* The slab's columns [begin, end) times their signs: itself where all are positive. */
SL_KERNEL const double *signed_slab(const double *slab, const int8_t *sign, int32_t begin, int32_t end, double *copy)
{
    if (!any_negative(sign, begin, end)) {
        return slab + (int64_t)begin * SL_SLAB;
    }
    for (int32_t k = begin; k < end; k++) {
        const vec s = vec_of(sign[k] < 0 ? -1.0 : 1.0);
        vec_store(copy + (int64_t)(k - begin) * SL_SLAB, vec_multiply(s, vec_load(slab + (int64_t)k * SL_SLAB)));
    }
    return copy;
}

/* sum[j] = sum over k < depth of a[k] b[k][j]: vectors times numbers. */
SL_KERNEL void product_1(const double *a, const double *b, int32_t depth, vec sum[SL_SLAB])
{
#pragma GCC unroll 8
    for (int j = 0; j < SL_SLAB; j++) {
        sum[j] = vec_of(0.0);
    }
#pragma GCC unroll 8
    for (int first = 0; first < SL_SLAB; first += SL_KERNEL_GROUP) {
        for (int64_t k = 0; k < depth; k++) {
            const vec column = vec_load(a + k * SL_SLAB);
#pragma GCC unroll 8
            for (int j = first; j < first + SL_KERNEL_GROUP; j++) {
                sum[j] = vec_fma(column, vec_of(b[k * SL_SLAB + j]), sum[j]);
            }
        }
    }
}

/* The same for two slabs at once: each number of b is loaded once for both. */
SL_KERNEL void product_2(const double *a0, const double *a1, const double *b, int32_t depth, vec sum0[SL_SLAB],
                         vec sum1[SL_SLAB])
{
    if (SL_KERNEL_GROUP < SL_SLAB) { /* too few registers */
        product_1(a0, b, depth, sum0);
        product_1(a1, b, depth, sum1);
        return;
    }
#pragma GCC unroll 8
    for (int j = 0; j < SL_SLAB; j++) {
        sum0[j] = sum1[j] = vec_of(0.0);
    }
    for (int64_t k = 0; k < depth; k++) {
        const vec column0 = vec_load(a0 + k * SL_SLAB), column1 = vec_load(a1 + k * SL_SLAB);
#pragma GCC unroll 8
        for (int j = 0; j < SL_SLAB; j++) {
            const vec number = vec_of(b[k * SL_SLAB + j]);
            sum0[j] = vec_fma(column0, number, sum0[j]);
            sum1[j] = vec_fma(column1, number, sum1[j]);
        }
    }
}

/* The first `columns` columns of a tile -= sum. */
SL_KERNEL void subtract_tile(double *tile, const vec sum[SL_SLAB], int32_t columns)
{
    if (columns == SL_SLAB) {
#pragma GCC unroll 8
        for (int j = 0; j < SL_SLAB; j++) {
            vec_store(tile + j * SL_SLAB, vec_subtract(vec_load(tile + j * SL_SLAB), sum[j]));
        }
        return;
    }
#pragma GCC unroll 8
    for (int j = 0; j < SL_SLAB; j++) {
        if (j < columns) {
            vec_store(tile + j * SL_SLAB, vec_subtract(vec_load(tile + j * SL_SLAB), sum[j]));
        }
    }
}

/* What the elimination of eight columns does to the rows below: column j -= number[j][i] column i for i < j, in turn,
 * each multiplied by its scale when done. */
typedef struct eliminator {
    double number[SL_SLAB][SL_SLAB];
    double scale[SL_SLAB];
} eliminator;

/* Factors the square tile D in place; the bad column or -1. The next pivot is computed apart, as the vectors compute
 * it: through a store and a load it would come a third later, and narrow fronts wait for little else. */
SL_KERNEL int32_t factor_tile(double *D, int32_t columns, sl_pivoting pivoting, int8_t *sign, eliminator *e)
{
    double d = D[0];
    for (int32_t j = 0; j < columns; j++) {
        double *column = D + j * SL_SLAB, *next = column + SL_SLAB;
        const double size = sign != NULL ? fabs(d) : d;
        if (!(size > pivoting.least && isfinite(d))) {
            if (!(pivoting.replacement > 0.0)) {
                return j;
            }
            d = pivoting.replacement;
        }
        const double s = d < 0.0 ? -1.0 : 1.0, reciprocal = 1.0 / sqrt(fabs(d));
        const double scale = sign != NULL ? s * reciprocal : reciprocal;
        if (sign != NULL) {
            sign[j] = (int8_t)s;
        }
        if (j + 1 < columns) {
            const double x = column[j + 1] * scale;
            d = fma(-(sign != NULL ? s * x : x), x, next[j + 1]);
        }
        e->scale[j] = scale;
        const vec done = vec_multiply(vec_load(column), vec_of(scale));
        vec_store(column, done);
        for (int32_t m = j + 1; m < columns; m++) {
            e->number[m][j] = s * column[m];
            vec_store(D + m * SL_SLAB, vec_fnma(vec_of(e->number[m][j]), done, vec_load(D + m * SL_SLAB)));
        }
        column[j] = reciprocal;
    }
    return -1;
}

/* Eight columns of one slab in registers. */
SL_KERNEL void eliminate_8(vec t[SL_SLAB], const eliminator *e, double *tile)
{
#pragma GCC unroll 8
    for (int i = 0; i < SL_SLAB; i++) {
        t[i] = vec_multiply(t[i], vec_of(e->scale[i]));
        vec_store(tile + i * SL_SLAB, t[i]);
#pragma GCC unroll 8
        for (int j = i + 1; j < SL_SLAB; j++) {
            t[j] = vec_fnma(vec_of(e->number[j][i]), t[i], t[j]);
        }
    }
}

SL_KERNEL void eliminate_few(double *tile, const eliminator *e, int32_t columns)
{
    for (int32_t j = 0; j < columns; j++) {
        vec t = vec_load(tile + j * SL_SLAB);
        for (int32_t i = 0; i < j; i++) {
            t = vec_fnma(vec_of(e->number[j][i]), vec_load(tile + i * SL_SLAB), t);
        }
        vec_store(tile + j * SL_SLAB, vec_multiply(t, vec_of(e->scale[j])));
    }
}

/* Columns of block g in one slab: product of the `depth` columns before them subtracted, then eliminated. */
SL_KERNEL void finish_slab(double *before, double *tile, const double *b, int32_t depth, const eliminator *e,
                           int32_t columns)
{
    vec sum[SL_SLAB];
    if (columns == SL_SLAB) {
        product_1(before, b, depth, sum);
#pragma GCC unroll 8
        for (int j = 0; j < SL_SLAB; j++) {
            sum[j] = vec_subtract(vec_load(tile + j * SL_SLAB), sum[j]);
        }
        eliminate_8(sum, e, tile);
        return;
    }
    if (depth > 0) {
        product_1(before, b, depth, sum);
        subtract_tile(tile, sum, columns);
    }
    eliminate_few(tile, e, columns);
}

/* Block g of columns in all slabs from the diagonal down; columns before `begin` have been dealt with. */
SL_KERNEL int32_t factor_block(const front *f, int32_t g, int32_t begin, sl_pivoting pivoting)
{
    const int32_t column = g * SL_SLAB, left = f->width - column, columns = left < SL_SLAB ? left : SL_SLAB;
    const int32_t depth = column - begin;
    const int64_t from = (int64_t)begin * SL_SLAB, to = (int64_t)column * SL_SLAB;
    double *slab = own_slab(f, g);
    const double *b = signed_slab(slab, f->sign, begin, column, f->factor);
    eliminator e;
    if (depth > 0) {
        vec sum[SL_SLAB];
        product_1(slab + from, b, depth, sum);
        subtract_tile(slab + to, sum, columns);
    }
    const int32_t bad = factor_tile(slab + to, columns, pivoting, f->sign != NULL ? f->sign + column : NULL, &e);
    if (bad != -1) {
        return column + bad;
    }
    for (int32_t h = g + 1; h < f->own_slabs + f->below_slabs; h++) {
        double *other = any_slab(f, h);
        finish_slab(other + from, other + to, b, depth, &e, columns);
    }
    return -1;
}

/* Subtracts the product of columns [begin, end) from all blocks of columns from `end` on, in the slabs h and h + 1. */
SL_KERNEL void subtract_product(const front *f, int32_t begin, int32_t end, int32_t h)
{
    const bool two = h + 1 < f->own_slabs + f->below_slabs;
    const int32_t last = h + two < f->own_slabs ? h + two : f->own_slabs - 1;
    double *slab0 = any_slab(f, h), *slab1 = two ? any_slab(f, h + 1) : slab0;
    double pair[2 * SL_SLAB * SL_KERNEL_DEPTH]; /* of this worker */
    const double *a0 = signed_slab(slab0, f->sign, begin, end, pair);
    const double *a1 = two ? signed_slab(slab1, f->sign, begin, end, pair + SL_SLAB * SL_KERNEL_DEPTH) : a0;
    for (int32_t g = end / SL_SLAB; g <= last; g++) {
        const int32_t left = f->width - g * SL_SLAB, columns = left < SL_SLAB ? left : SL_SLAB;
        const double *b = own_slab(f, g) + (int64_t)begin * SL_SLAB;
        const int64_t tile = (int64_t)g * SL_SLAB * SL_SLAB;
        vec sum0[SL_SLAB], sum1[SL_SLAB];
        product_2(a0, a1, b, end - begin, sum0, sum1);
        if (g <= h || h >= f->own_slabs) {
            subtract_tile(slab0 + tile, sum0, columns);
        }
        if (two) {
            subtract_tile(slab1 + tile, sum1, columns);
        }
    }
}

/* Ragged slabs to their padded copies. */
SL_KERNEL_ENTRY void front_open(double *panel, int32_t width, int32_t below, double *spare)
{
    const front f = front_at(panel, width, below, NULL, spare);
    const int32_t own_rest = width % SL_SLAB, below_rest = below % SL_SLAB;
    if (own_rest > 0) {
        pad_slab(panel + sl_slab_offset(f.own_full), own_rest, width, f.own_tail);
    }
    if (below_rest > 0) {
        pad_slab(f.lower + (int64_t)f.below_full * SL_SLAB * width, below_rest, width, f.below_tail);
    }
}

/* And back. */
SL_KERNEL_ENTRY void front_close(double *panel, int32_t width, int32_t below, double *spare)
{
    const front f = front_at(panel, width, below, NULL, spare);
    const int32_t own_rest = width % SL_SLAB, below_rest = below % SL_SLAB;
    if (own_rest > 0) {
        unpad_slab(f.own_tail, own_rest, width, panel + sl_slab_offset(f.own_full));
    }
    if (below_rest > 0) {
        unpad_slab(f.below_tail, below_rest, width, f.lower + (int64_t)f.below_full * SL_SLAB * width);
    }
}

SL_KERNEL_ENTRY int32_t front_columns(double *panel, int32_t width, int32_t below, int32_t begin, sl_pivoting pivoting,
                                      int8_t *sign, double *spare)
{
    const front f = front_at(panel, width, below, sign, spare);
    int32_t bad = -1;
    for (int32_t g = begin / SL_SLAB; g < f.own_slabs && g * SL_SLAB < begin + SL_KERNEL_DEPTH && bad == -1; g++) {
        bad = factor_block(&f, g, begin, pivoting);
    }
    return bad;
}

SL_KERNEL_ENTRY void front_trail(double *panel, int32_t width, int32_t below, int32_t begin, int8_t *sign,
                                 double *spare, int32_t pair_begin, int32_t pair_end)
{
    const front f = front_at(panel, width, below, sign, spare);
    const int32_t end = begin + SL_KERNEL_DEPTH;
    for (int32_t p = pair_begin; p < pair_end; p++) {
        subtract_product(&f, begin, end, end / SL_SLAB + 2 * p);
    }
}

/* U - sum, or -sum where U has no meaning yet. */
SL_KERNEL vec subtract_or_begin(const double *U, vec sum, bool fresh)
{
    return vec_subtract(fresh ? vec_of(0.0) : vec_load(U), sum);
}

/* Rows 8 h .. of U, the columns from 8 g on: two tiles below the diagonal. */
SL_KERNEL void subtract_rows(double *U, int32_t h, int32_t g, const vec sum0[SL_SLAB], const vec sum1[SL_SLAB],
                             bool fresh)
{
    double *at = U + sl_packed_size((int64_t)h * SL_SLAB) + (int64_t)g * SL_SLAB;
#pragma GCC unroll 8
    for (int j = 0; j < SL_SLAB; j++) {
        vec_store(at, subtract_or_begin(at, sum0[j], fresh));
        vec_store(at + SL_SLAB, subtract_or_begin(at + SL_SLAB, sum1[j], fresh));
        at += (int64_t)h * SL_SLAB + j + 1;
    }
}

/* One tile on the diagonal or in the last, shorter slab of rows. */
SL_KERNEL void subtract_edge(double *U, int32_t below, int32_t h, int32_t g, const vec sum[SL_SLAB], bool fresh)
{
    double *at = U + sl_packed_size((int64_t)h * SL_SLAB) + (int64_t)g * SL_SLAB;
#pragma GCC unroll 8
    for (int j = 0; j < SL_SLAB; j++) {
        const int32_t row = h * SL_SLAB + j, room = row + 1 - g * SL_SLAB, count = room < SL_SLAB ? room : SL_SLAB;
        if (row < below && count > 0) {
            const vec old = fresh ? vec_of(0.0) : vec_load_part(at, count);
            vec_store_part(at, vec_subtract(old, sum[j]), count);
        }
        at += row + 1;
    }
}

SL_KERNEL_ENTRY void front_update(const double *panel, int32_t width, int32_t below, const int8_t *sign, double *spare,
                                  int32_t begin, int32_t end, double *U)
{
    const front f = front_at((double *)(uintptr_t)panel, width, below, NULL, spare); /* the panel is only read */
    double pair[2 * SL_SLAB * SL_KERNEL_DEPTH];                                      /* of this worker */
    vec sum0[SL_SLAB], sum1[SL_SLAB];
    for (int32_t k = 0; k < width; k += SL_KERNEL_DEPTH) {
        const int32_t stop = k + SL_KERNEL_DEPTH < width ? k + SL_KERNEL_DEPTH : width;
        for (int32_t p = begin; p < end; p++) {
            const int32_t g = 2 * p;
            const bool two = g + 1 < f.below_slabs;
            const double *a0 = signed_slab(below_slab(&f, g), sign, k, stop, pair);
            const double *a1 =
                two ? signed_slab(below_slab(&f, g + 1), sign, k, stop, pair + SL_SLAB * SL_KERNEL_DEPTH) : a0;
            product_1(a0, below_slab(&f, g) + (int64_t)k * SL_SLAB, stop - k, sum0);
            subtract_edge(U, below, g, g, sum0, k == 0);
            for (int32_t h = g + 1; h < f.below_slabs; h++) {
                product_2(a0, a1, below_slab(&f, h) + (int64_t)k * SL_SLAB, stop - k, sum0, sum1);
                if (h > g + 1 && h < f.below_full) {
                    subtract_rows(U, h, g, sum0, sum1, k == 0);
                } else {
                    subtract_edge(U, below, h, g, sum0, k == 0);
                    subtract_edge(U, below, h, g + 1, sum1, k == 0);
                }
            }
        }
    }
}
