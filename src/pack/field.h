/* What it costs to stand somewhere: weights of cells, summed along rows.
 * Layer: pack. */
#ifndef SL_PACK_FIELD_H
#define SL_PACK_FIELD_H

#include "pack/mask.h"

/* A window of a page: cells low .. low + size - 1. */
typedef struct sl_field {
    int32_t low[2], size[2];
    int32_t stride;
    int64_t capacity;
    int32_t *sum; /* size[1] x stride; row y: weights of its first 0, 1, .. size[0] cells */
} sl_field;

/* Room for windows of up to width x height cells. SL_OUT_OF_MEMORY. */
SL_NODISCARD sl_status sl_field_init(int32_t width, int32_t height, sl_field *out);
void sl_field_clear(sl_field *field);

/* A new window, without weights. */
void sl_field_begin(sl_field *field, const int32_t low[2], const int32_t size[2]);

/* Adds weight to the cells of a mask at (x, y), as far as they lie in the window. */
void sl_field_add(sl_field *field, const sl_mask *mask, int32_t x, int32_t y, int32_t weight);

/* After the last mask was added: sums the rows. */
void sl_field_sum(sl_field *field);

/* The same weights on cells `factor` times as wide. fine: summed, from (0, 0), its size divisible by factor, but for a
 * rest that is left out. */
void sl_field_coarsen(const sl_field *fine, int32_t factor, sl_field *coarse);

/* Weights under a mask at (x, y), which lies in the window; or any sum of at least bound. */
int64_t sl_field_cost(const sl_field *field, const sl_mask *mask, int32_t x, int32_t y, int64_t bound);

#endif
