#include "sparse/entries.h"

#include <string.h>

/* Where a block of L begins: rows of the own ones of its columns' supernode, or of those below. */
typedef struct block_place {
    int32_t s, row, column;
    bool below;
} block_place;

/* row, column: blocks in the order of elimination. */
static block_place find_place(const sl_cholesky *F, const int32_t *owner, int32_t row, int32_t column)
{
    const int32_t s = owner[column], i = F->block * row;
    block_place at = {s, i - F->first[s], F->block * column - F->first[s], false};
    if (i < F->first[s + 1]) {
        return at;
    }
    const int32_t *below = F->below + F->below_first[s];
    int32_t lo = 0, size = sl_supernode_below(F, s);
    while (size > 1) { /* the last that is at most i is at lo .. lo + size - 1 */
        const int32_t half = size / 2;
        lo = below[lo + half] <= i ? lo + half : lo;
        size -= half;
    }
    SL_ASSERT(below[lo] == i);
    at.row = lo;
    at.below = true;
    return at;
}

/* Where row r of the block begins in the panel; its next columns follow `stride` entries apart. */
static int32_t place_of_row(const sl_cholesky *F, const block_place *at, int32_t r, int32_t *stride)
{
    const int32_t row = at->row + r, width = sl_supernode_width(F, at->s), below = sl_supernode_below(F, at->s);
    const int32_t left = (at->below ? below : width) - row / SL_SLAB * SL_SLAB;
    *stride = left < SL_SLAB ? left : SL_SLAB;
    return (int32_t)(at->below ? sl_own_size(width) + sl_below_place(width, below, row, at->column)
                               : sl_own_place(width, row, at->column));
}

static void count_entries(sl_cholesky *F, const sl_csc *G, const int32_t *place, const int32_t *owner, int64_t *next)
{
    const int64_t b = F->block;
    memset(F->entry_first, 0, ((size_t)F->supernodes + 1) * sizeof *F->entry_first);
    for (int32_t J = 0; J < G->ncols; J++) {
        const int32_t column = place[J];
        F->entry_first[owner[column] + 1] += b * (b + 1) / 2;
        for (int64_t p = G->colptr[J] + 1; p < G->colptr[J + 1]; p++) {
            const int32_t row = place[G->row[p]];
            F->entry_first[owner[row < column ? row : column] + 1] += b * b;
        }
    }
    for (int32_t s = 0; s < F->supernodes; s++) {
        F->entry_first[s + 1] += F->entry_first[s];
        next[s] = F->entry_first[s];
    }
}

/* Block column J of A below its diagonal. b: F->block, known to the compiler where it matters. */
static inline void map_column(sl_cholesky *F, const sl_csc *A, const sl_csc *G, const int32_t *place,
                              const int32_t *owner, int32_t b, int32_t J, int64_t *next)
{
    const int64_t *colptr = A->colptr + (int64_t)b * J;
    const int32_t y = place[J];
    for (int64_t p = G->colptr[J]; p < G->colptr[J + 1]; p++) {
        const int32_t x = place[G->row[p]];
        const bool turned = x < y; /* above the diagonal of P A P', where A has it below */
        const block_place at = find_place(F, owner, turned ? y : x, turned ? x : y);
        const int64_t skipped = b * (p - G->colptr[J]);
        int64_t e = next[at.s];
        for (int32_t i = x == y; i < b; i++) { /* the block's rows in L */
            int32_t stride, to = place_of_row(F, &at, i, &stride);
            for (int32_t j = 0; j < (x == y ? i : b); j++, to += stride) {
                const int32_t r = turned ? j : i, c = turned ? i : j;
                F->entry_from[e] = (int32_t)(colptr[c] + skipped + r - c);
                F->entry_to[e++] = to;
            }
        }
        next[at.s] = e;
    }
}

void sl_map_entries(sl_cholesky *F, const sl_csc *A, const sl_csc *G, const int32_t *place, const int32_t *owner,
                    int64_t *next)
{
    count_entries(F, G, place, owner, next);
    for (int32_t s = 0; s < F->supernodes; s++) {
        for (int32_t k = F->first[s]; k < F->first[s + 1]; k++) {
            const int32_t own = k - F->first[s], b = F->block, i = b * F->perm[k / b] + k % b;
            F->entry_from[next[s]] = (int32_t)A->colptr[i]; /* diagonal entries first: shifts are theirs */
            F->entry_to[next[s]++] = (int32_t)sl_own_place(sl_supernode_width(F, s), own, own);
        }
    }
    for (int32_t J = 0; J < G->ncols; J++) {
        if (F->block == 1) {
            map_column(F, A, G, place, owner, 1, J, next);
        } else if (F->block == 2) {
            map_column(F, A, G, place, owner, 2, J, next);
        } else {
            map_column(F, A, G, place, owner, F->block, J, next);
        }
    }
}
