/* Bodies of the solves' kernels for one right-hand side; included by kernels_solve.h. A vector holds eight rows of a
 * slab's column, so that L is read as it lies.
 * Layer: sparse. */
#include <math.h>

/* Chains of sums that are open at the same time: an addition takes four times as long as it takes to begin one. */
enum { CHAINS = 4 };

SL_KERNEL double *entry_at(sl_rows rows, int32_t r)
{
    return r >= 0 ? rows.X + (r - rows.origin) : rows.outside + (-1 - r);
}

/* Sum over k < columns of slab[k] own[k]. */
SL_KERNEL vec times_own(const double *slab, int count, int32_t columns, const double *own)
{
    vec chain[CHAINS];
    int32_t k = 0;
    for (int c = 0; c < CHAINS; c++) {
        chain[c] = vec_of(0.0);
    }
    for (; k + CHAINS <= columns; k += CHAINS) {
#pragma GCC unroll 4
        for (int c = 0; c < CHAINS; c++) {
            chain[c] = vec_fma(side_load(slab + (int64_t)(k + c) * count, count), vec_of(own[k + c]), chain[c]);
        }
    }
#pragma GCC unroll 4
    for (int c = 0; c < CHAINS - 1; c++) {
        if (k + c < columns) {
            chain[c] = vec_fma(side_load(slab + (int64_t)(k + c) * count, count), vec_of(own[k + c]), chain[c]);
        }
    }
    return vec_add(vec_add(chain[0], chain[1]), vec_add(chain[2], chain[3]));
}

/* own[k] -= column k of the slab times x, for all columns. */
SL_KERNEL void subtract_dots(const double *slab, int count, int32_t columns, vec x, double *own)
{
    for (int32_t k = 0; k < columns; k += SL_SLAB) {
        const int32_t left = columns - k;
        vec product[SL_SLAB];
        if (left >= SL_SLAB) {
#pragma GCC unroll 8
            for (int j = 0; j < SL_SLAB; j++) {
                product[j] = vec_multiply(side_load(slab + (int64_t)(k + j) * count, count), x);
            }
            vec_store(own + k, vec_subtract(vec_load(own + k), vec_sums(product)));
            continue;
        }
#pragma GCC unroll 8
        for (int j = 0; j < SL_SLAB; j++) {
            product[j] = j < left ? vec_multiply(side_load(slab + (int64_t)(k + j) * count, count), x) : vec_of(0.0);
        }
        double sum[SL_SLAB];
        vec_store(sum, vec_sums(product));
        for (int32_t j = 0; j < left; j++) {
            own[k + j] -= sum[j];
        }
    }
}

SL_KERNEL void forward_own_1(const double *slab, int count, int32_t before, double *own)
{
    double x[SL_SLAB];
    const double *tile = slab + (int64_t)before * count;
    vec_store(x, times_own(slab, count, before, own));
#pragma GCC unroll 8
    for (int i = 0; i < count; i++) {
        x[i] = own[before + i] - x[i];
    }
#pragma GCC unroll 8
    for (int j = 0; j < count; j++) {
        x[j] *= tile[j * count + j];
        own[before + j] = x[j];
#pragma GCC unroll 8
        for (int i = j + 1; i < count; i++) {
            x[i] = fma(-tile[j * count + i], x[j], x[i]);
        }
    }
}

SL_KERNEL void backward_own_1(const double *slab, int count, int32_t before, double *own)
{
    double x[SL_SLAB] = {0.0};
    const double *tile = slab + (int64_t)before * count;
#pragma GCC unroll 8
    for (int i = 0; i < count; i++) {
        x[i] = own[before + i];
    }
#pragma GCC unroll 8
    for (int i = count - 1; i >= 0; i--) {
        x[i] *= tile[i * count + i];
        own[before + i] = x[i];
#pragma GCC unroll 8
        for (int j = 0; j < i; j++) {
            x[j] = fma(-tile[j * count + i], x[i], x[j]);
        }
    }
    if (before > 0) {
        subtract_dots(slab, count, before, vec_pack(x), own);
    }
}

SL_KERNEL void forward_below_1(const double *slab, int count, int32_t columns, const double *own, const int32_t *row,
                               sl_rows rows)
{
    double sum[SL_SLAB];
    vec_store(sum, times_own(slab, count, columns, own));
#pragma GCC unroll 8
    for (int i = 0; i < count; i++) {
        *entry_at(rows, row[i]) -= sum[i];
    }
}

SL_KERNEL void backward_below_1(const double *slab, int count, int32_t columns, double *own, const int32_t *row,
                                sl_rows rows)
{
    double x[SL_SLAB] = {0.0};
#pragma GCC unroll 8
    for (int i = 0; i < count; i++) {
        x[i] = *entry_at(rows, row[i]);
    }
    subtract_dots(slab, count, columns, vec_pack(x), own);
}
