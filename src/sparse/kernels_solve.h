/* Bodies of the solves' kernels; included by each of kernels_*.c after its vectors of eight doubles. A vector holds
 * one row of up to eight right-hand sides.
 * Layer: sparse. */
#include "sparse/kernels.h"

enum { HALF = SL_SLAB / 2 };

/* `sides` right-hand sides from c on; eight and four are constants wherever they matter. Others go through masks, which
 * the machine cannot forward from a store to the next load: twice the time. */
SL_KERNEL vec side_load(const double *p, int sides)
{
    return sides == SL_SLAB ? vec_load(p) : sides == HALF ? vec_load_half(p) : vec_load_part(p, sides);
}

SL_KERNEL void side_store(double *p, vec v, int sides)
{
    if (sides == SL_SLAB) {
        vec_store(p, v);
    } else if (sides == HALF) {
        vec_store_half(p, v);
    } else {
        vec_store_part(p, v, sides);
    }
}

#include "sparse/kernels_single.h"

SL_KERNEL double *row_at(sl_rows rows, int32_t r)
{
    return r >= 0 ? rows.X + (int64_t)(r - rows.origin) * rows.w : rows.outside + (int64_t)(-1 - r) * rows.w;
}

/* x[i] -= sum over k < columns of slab[k][i] own[k], for count rows. */
SL_KERNEL void subtract_known(const double *slab, int count, int32_t columns, const double *own, int64_t w, int sides,
                              vec *x)
{
#pragma GCC unroll 8
    for (int first = 0; first < count; first += SL_KERNEL_GROUP) {
        const int last = first + SL_KERNEL_GROUP < count ? first + SL_KERNEL_GROUP : count;
        for (int64_t k = 0; k < columns; k++) {
            const vec known = side_load(own + k * w, sides);
#pragma GCC unroll 8
            for (int i = first; i < last; i++) {
                x[i] = vec_fnma(vec_of(slab[k * count + i]), known, x[i]);
            }
        }
    }
}

/* own[k] -= sum over i < count of slab[k][i] x[i], for all columns. */
SL_KERNEL void subtract_from_all(const double *slab, int count, int32_t columns, double *own, int64_t w, int sides,
                                 const vec *x)
{
#pragma GCC unroll 8
    for (int first = 0; first < count; first += SL_KERNEL_GROUP) {
        const int last = first + SL_KERNEL_GROUP < count ? first + SL_KERNEL_GROUP : count;
        for (int64_t k = 0; k < columns; k++) {
            vec sum = side_load(own + k * w, sides);
#pragma GCC unroll 8
            for (int i = first; i < last; i++) {
                sum = vec_fnma(vec_of(slab[k * count + i]), x[i], sum);
            }
            side_store(own + k * w, sum, sides);
        }
    }
}

/* The own rows of one slab, which begins at column `before`. */
SL_KERNEL void forward_own(const double *slab, int count, int32_t before, double *own, int64_t w, int sides)
{
    vec x[SL_SLAB];
    double *at = own + before * w;
    const double *tile = slab + (int64_t)before * count;
#pragma GCC unroll 8
    for (int i = 0; i < count; i++) {
        x[i] = side_load(at + i * w, sides);
    }
    subtract_known(slab, count, before, own, w, sides, x);
#pragma GCC unroll 8
    for (int j = 0; j < count; j++) {
        x[j] = vec_multiply(x[j], vec_of(tile[j * count + j]));
        side_store(at + j * w, x[j], sides);
#pragma GCC unroll 8
        for (int i = j + 1; i < count; i++) {
            x[i] = vec_fnma(vec_of(tile[j * count + i]), x[j], x[i]);
        }
    }
}

SL_KERNEL void backward_own(const double *slab, int count, int32_t before, double *own, int64_t w, int sides)
{
    vec x[SL_SLAB];
    double *at = own + before * w;
    const double *tile = slab + (int64_t)before * count;
#pragma GCC unroll 8
    for (int i = 0; i < count; i++) {
        x[i] = side_load(at + i * w, sides);
    }
#pragma GCC unroll 8
    for (int i = count - 1; i >= 0; i--) {
        x[i] = vec_multiply(x[i], vec_of(tile[i * count + i]));
        side_store(at + i * w, x[i], sides);
#pragma GCC unroll 8
        for (int j = 0; j < i; j++) {
            x[j] = vec_fnma(vec_of(tile[j * count + i]), x[i], x[j]);
        }
    }
    subtract_from_all(slab, count, before, own, w, sides, x);
}

SL_KERNEL void forward_below(const double *slab, int count, int32_t columns, const double *own, const int32_t *row,
                             sl_rows rows, int sides)
{
    vec x[SL_SLAB];
    double *at[SL_SLAB] = {0};
#pragma GCC unroll 8
    for (int i = 0; i < count; i++) {
        at[i] = row_at(rows, row[i]);
        x[i] = side_load(at[i], sides);
    }
    subtract_known(slab, count, columns, own, rows.w, sides, x);
#pragma GCC unroll 8
    for (int i = 0; i < count; i++) {
        side_store(at[i], x[i], sides);
    }
}

SL_KERNEL void backward_below(const double *slab, int count, int32_t columns, double *own, const int32_t *row,
                              sl_rows rows, int sides)
{
    vec x[SL_SLAB];
#pragma GCC unroll 8
    for (int i = 0; i < count; i++) {
        x[i] = side_load(row_at(rows, row[i]), sides);
    }
    subtract_from_all(slab, count, columns, own, rows.w, sides, x);
}

/* What is done with a slab of any number of rows. */
typedef enum slab_step { FORWARD_OWN, BACKWARD_OWN, FORWARD_BELOW, BACKWARD_BELOW } slab_step;

/* For `sides`: one right-hand side, rows.w = 1. */
enum { SINGLE = 0 };

SL_KERNEL void take_single_step(slab_step step, const double *slab, int count, int32_t columns, double *own,
                                const int32_t *row, sl_rows rows)
{
    switch (step) {
    case FORWARD_OWN:
        forward_own_1(slab, count, columns, own);
        break;
    case BACKWARD_OWN:
        backward_own_1(slab, count, columns, own);
        break;
    case FORWARD_BELOW:
        forward_below_1(slab, count, columns, own, row, rows);
        break;
    default:
        backward_below_1(slab, count, columns, own, row, rows);
        break;
    }
}

SL_KERNEL void take_step(slab_step step, const double *slab, int count, int32_t columns, double *own,
                         const int32_t *row, sl_rows rows, int sides)
{
    if (sides == SINGLE) {
        take_single_step(step, slab, count, columns, own, row, rows);
        return;
    }
    switch (step) {
    case FORWARD_OWN:
        forward_own(slab, count, columns, own, rows.w, sides);
        break;
    case BACKWARD_OWN:
        backward_own(slab, count, columns, own, rows.w, sides);
        break;
    case FORWARD_BELOW:
        forward_below(slab, count, columns, own, row, rows, sides);
        break;
    default:
        backward_below(slab, count, columns, own, row, rows, sides);
        break;
    }
}

/* The same where count is not a constant. */
SL_KERNEL void take_ragged_step(slab_step step, const double *slab, int count, int32_t columns, double *own,
                                const int32_t *row, sl_rows rows, int sides)
{
    switch (count) {
    case 1:
        take_step(step, slab, 1, columns, own, row, rows, sides);
        break;
    case 2:
        take_step(step, slab, 2, columns, own, row, rows, sides);
        break;
    case 3:
        take_step(step, slab, 3, columns, own, row, rows, sides);
        break;
    case 4:
        take_step(step, slab, 4, columns, own, row, rows, sides);
        break;
    case 5:
        take_step(step, slab, 5, columns, own, row, rows, sides);
        break;
    case 6:
        take_step(step, slab, 6, columns, own, row, rows, sides);
        break;
    case 7:
        take_step(step, slab, 7, columns, own, row, rows, sides);
        break;
    default:
        break;
    }
}

SL_KERNEL void forward_sides(const double *panel, int32_t width, int32_t below, const int32_t *row, double *own,
                             sl_rows rows, int sides)
{
    const int32_t own_full = width / SL_SLAB, below_full = below / SL_SLAB;
    const double *slab = panel;
    for (int32_t g = 0; g < own_full; g++) {
        take_step(FORWARD_OWN, slab, SL_SLAB, g * SL_SLAB, own, NULL, rows, sides);
        slab += (int64_t)(g + 1) * SL_SLAB * SL_SLAB;
    }
    const int32_t own_rest = width - own_full * SL_SLAB;
    take_ragged_step(FORWARD_OWN, slab, own_rest, own_full * SL_SLAB, own, NULL, rows, sides);
    slab += (int64_t)own_rest * width;
    for (int32_t g = 0; g < below_full; g++) {
        take_step(FORWARD_BELOW, slab, SL_SLAB, width, own, row + g * SL_SLAB, rows, sides);
        slab += (int64_t)SL_SLAB * width;
    }
    take_ragged_step(FORWARD_BELOW, slab, below - below_full * SL_SLAB, width, own, row + below_full * SL_SLAB, rows,
                     sides);
}

SL_KERNEL void backward_sides(const double *panel, int32_t width, int32_t below, const int32_t *row, double *own,
                              sl_rows rows, int sides)
{
    const int32_t own_full = width / SL_SLAB, below_full = below / SL_SLAB;
    const double *lower = panel + sl_own_size(width);
    for (int32_t g = 0; g < below_full; g++) {
        take_step(BACKWARD_BELOW, lower, SL_SLAB, width, own, row + g * SL_SLAB, rows, sides);
        lower += (int64_t)SL_SLAB * width;
    }
    take_ragged_step(BACKWARD_BELOW, lower, below - below_full * SL_SLAB, width, own, row + below_full * SL_SLAB, rows,
                     sides);
    const double *slab = panel + sl_slab_offset(own_full);
    take_ragged_step(BACKWARD_OWN, slab, width - own_full * SL_SLAB, own_full * SL_SLAB, own, NULL, rows, sides);
    for (int32_t g = own_full - 1; g >= 0; g--) {
        take_step(BACKWARD_OWN, panel + sl_slab_offset(g), SL_SLAB, g * SL_SLAB, own, NULL, rows, sides);
    }
}

/* The block from side c on. */
SL_KERNEL sl_rows rows_from(sl_rows rows, int32_t c)
{
    rows.X += c;
    rows.outside = rows.outside != NULL ? rows.outside + c : NULL;
    return rows;
}

SL_KERNEL_ENTRY void solve_forward(const double *panel, int32_t width, int32_t below, const int32_t *row, double *own,
                                   sl_rows rows)
{
    int32_t c = 0;
    if (rows.w == 1) {
        forward_sides(panel, width, below, row, own, rows, SINGLE);
        return;
    }
    for (; c + SL_SLAB <= rows.w; c += SL_SLAB) {
        forward_sides(panel, width, below, row, own + c, rows_from(rows, c), SL_SLAB);
    }
    if (c + HALF == rows.w) {
        forward_sides(panel, width, below, row, own + c, rows_from(rows, c), HALF);
    } else if (c < rows.w) {
        forward_sides(panel, width, below, row, own + c, rows_from(rows, c), rows.w - c);
    }
}

SL_KERNEL_ENTRY void solve_backward(const double *panel, int32_t width, int32_t below, const int32_t *row, double *own,
                                    sl_rows rows)
{
    int32_t c = 0;
    if (rows.w == 1) {
        backward_sides(panel, width, below, row, own, rows, SINGLE);
        return;
    }
    for (; c + SL_SLAB <= rows.w; c += SL_SLAB) {
        backward_sides(panel, width, below, row, own + c, rows_from(rows, c), SL_SLAB);
    }
    if (c + HALF == rows.w) {
        backward_sides(panel, width, below, row, own + c, rows_from(rows, c), HALF);
    } else if (c < rows.w) {
        backward_sides(panel, width, below, row, own + c, rows_from(rows, c), rows.w - c);
    }
}
