#include "sparse/blocks.h"

#include "base/memory.h"

#include <string.h>

/* Has column `block` J the rows of whole blocks, and each column of block J the same but for those above itself? */
static bool is_block_column(const sl_csc *A, int32_t block, int32_t J)
{
    const int64_t *at = A->colptr + (int64_t)block * J;
    const int64_t size = at[1] - at[0];
    const int32_t *row = A->row + at[0];
    if (size % block != 0) {
        return false;
    }
    for (int64_t q = 0; q < size; q += block) {
        for (int32_t r = 0; r < block; r++) {
            if (row[q] % block != 0 || row[q + r] != row[q] + r) {
                return false;
            }
        }
    }
    for (int32_t c = 1; c < block; c++) {
        if (at[c + 1] - at[c] != size - c || memcmp(A->row + at[c], row + c, (size_t)(size - c) * sizeof *row) != 0) {
            return false;
        }
    }
    return true;
}

sl_status sl_block_pattern(const sl_csc *A, int32_t block, sl_csc *G)
{
    *G = (sl_csc){0};
    if (block < 1 || A->ncols % block != 0) {
        return SL_BAD_INPUT;
    }
    const int32_t count = A->ncols / block;
    int64_t filled = 0;
    for (int32_t J = 0; J < count; J++) {
        if (!is_block_column(A, block, J)) {
            return SL_BAD_INPUT;
        }
        filled += (A->colptr[(int64_t)block * J + 1] - A->colptr[(int64_t)block * J]) / block;
    }
    G->nrows = G->ncols = count;
    G->colptr = sl_alloc((int64_t)count + 1, sizeof *G->colptr);
    G->row = sl_alloc(filled, sizeof *G->row);
    if (G->colptr == NULL || G->row == NULL) {
        sl_block_pattern_clear(G);
        return SL_OUT_OF_MEMORY;
    }
    G->colptr[0] = filled = 0;
    for (int32_t J = 0; J < count; J++) {
        const int64_t end = A->colptr[(int64_t)block * J + 1];
        for (int64_t p = A->colptr[(int64_t)block * J]; p < end; p += block) {
            G->row[filled++] = A->row[p] / block;
        }
        G->colptr[J + 1] = filled;
    }
    return SL_OK;
}

void sl_block_pattern_clear(sl_csc *G)
{
    sl_free(G->colptr);
    sl_free(G->row);
    *G = (sl_csc){0};
}

void sl_block_expand(int32_t count, int32_t block, int32_t *perm)
{
    for (int32_t k = count; k-- > 0;) { /* backwards: perm[k] is read before it is overwritten */
        const int32_t i = perm[k];
        for (int32_t c = 0; c < block; c++) {
            perm[(int64_t)block * k + c] = block * i + c;
        }
    }
}
