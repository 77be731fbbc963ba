/* Matrices made of square blocks: their symbolic analysis is that of the graph of the blocks, a quarter of the entries
 * where these are 2 x 2; internal to the room.
 * Layer: sparse. */
#ifndef SL_SPARSE_BLOCKS_H
#define SL_SPARSE_BLOCKS_H

#include "sparse/csc.h"

/* G: the pattern of A's blocks, lower triangle, without values; column J of G has a row I where A has the whole block
 * (I, J), and the diagonal. On failure G is empty. SL_BAD_INPUT (block < 1, or A's order or pattern is not made of
 * whole blocks), SL_OUT_OF_MEMORY. */
SL_NODISCARD sl_status sl_block_pattern(const sl_csc *A, int32_t block, sl_csc *G);

/* Frees what sl_block_pattern made. */
void sl_block_pattern_clear(sl_csc *G);

/* A permutation of `count` blocks becomes that of their unknowns, in place: count * block entries. */
void sl_block_expand(int32_t count, int32_t block, int32_t *perm);

#endif
