/* Where the matrix is made of blocks of two, rows and columns are added in pairs: half the indices are looked up, and
 * two neighbours are one vector. The sums are the same. */
#include "sparse/extend_add.h"

/* Both lists are ascending. */
static void match_rows(const sl_cholesky *F, int32_t s, int32_t *relative)
{
    const int32_t parent = F->parent[s], rows = sl_supernode_below(F, s), b = F->block;
    const int32_t width = sl_supernode_width(F, parent);
    const int32_t *row = F->below + F->below_first[s], *to = F->below + F->below_first[parent];
    int32_t k = 0;
    for (int32_t i = 0; i < rows; i += b) {
        const bool own = row[i] < F->first[parent + 1];
        while (!own && to[k] != row[i]) {
            k += b;
        }
        for (int32_t r = 0; r < b; r++) {
            relative[i + r] = (own ? row[i] - F->first[parent] : width + k) + r;
        }
    }
}

void sl_match_rows(sl_cholesky *F)
{
    for (int32_t s = 0; s < F->supernodes; s++) {
        if (F->parent[s] != -1) {
            match_rows(F, s, F->relative + F->below_first[s]);
        }
    }
}

static int32_t columns_in_panel(const int32_t *relative, int32_t rows, int32_t width)
{
    int32_t count = 0;
    while (count < rows && relative[count] < width) {
        count++;
    }
    return count;
}

/* Rows of a slab around row i of `rows`. */
static int32_t slab_rows(int32_t rows, int32_t i)
{
    const int32_t left = rows - i / SL_SLAB * SL_SLAB;
    return left < SL_SLAB ? left : SL_SLAB;
}

static void add_strided(const double *restrict from, const int32_t *relative, int32_t count, double *restrict to,
                        int32_t stride)
{
    for (int32_t k = 0; k < count; k++) {
        to[(int64_t)relative[k] * stride] += from[k];
    }
}

/* Two rows whose places are neighbours; columns in pairs. */
static void add_pairs_strided(const double *restrict row0, const double *restrict row1, const int32_t *relative,
                              int32_t count, double *restrict to, int32_t stride)
{
    for (int32_t k = 0; k < count; k += 2) {
        double *left = to + (int64_t)relative[k] * stride, *right = left + stride;
        const double a = left[0] + row0[k], b = left[1] + row1[k];
        const double c = right[0] + row0[k + 1], d = right[1] + row1[k + 1];
        left[0] = a;
        left[1] = b;
        right[0] = c;
        right[1] = d;
    }
}

/* Place of row `row` in the panel of s, and how far its columns are apart. */
static double *panel_row(const sl_cholesky *F, int32_t s, double *panel, int32_t row, int32_t *stride)
{
    const int32_t width = sl_supernode_width(F, s), below = sl_supernode_below(F, s);
    if (row < width) {
        *stride = slab_rows(width, row);
        return panel + sl_own_place(width, row, 0);
    }
    *stride = slab_rows(below, row - width);
    return panel + sl_own_size(width) + sl_below_place(width, below, row - width, 0);
}

/* Two rows at a time: blocks of two never straddle slabs, whose heights are even. */
static void extend_panel_by_pairs(const sl_cholesky *F, int32_t s, const double *U, int32_t owned, double *panel)
{
    const int32_t *relative = F->relative + F->below_first[s], rows = sl_supernode_below(F, s);
    for (int32_t i = 0; i < rows; i += 2) {
        const double *row0 = U + sl_packed_size(i), *row1 = row0 + i + 1;
        int32_t stride;
        double *to = panel_row(F, F->parent[s], panel, relative[i], &stride);
        add_pairs_strided(row0, row1, relative, i < owned ? i : owned, to, stride);
        if (i < owned) { /* on the diagonal: the upper of the two has one entry less */
            to += (int64_t)relative[i] * stride;
            to[0] += row0[i];
            to[1] += row1[i];
            to[stride + 1] += row1[i + 1];
        }
    }
}

void sl_extend_panel(const sl_cholesky *F, int32_t s, const double *U, double *panel)
{
    const int32_t *relative = F->relative + F->below_first[s], rows = sl_supernode_below(F, s);
    const int32_t owned = columns_in_panel(relative, rows, sl_supernode_width(F, F->parent[s]));
    if (F->block == 2) {
        extend_panel_by_pairs(F, s, U, owned, panel);
        return;
    }
    for (int32_t i = 0; i < rows; i++) {
        int32_t stride;
        double *to = panel_row(F, F->parent[s], panel, relative[i], &stride);
        add_strided(U + sl_packed_size(i), relative, i < owned ? i + 1 : owned, to, stride);
    }
}

static void add_run(const double *restrict from, int32_t count, double *restrict to)
{
    for (int32_t k = 0; k < count; k++) {
        to[k] += from[k];
    }
}

static void add_pairs(const double *restrict from, const int32_t *relative, int32_t begin, int32_t end,
                      double *restrict to)
{
    for (int32_t k = begin; k < end; k += 2) {
        double *pair = to + relative[k];
        const double a = pair[0] + from[k], b = pair[1] + from[k + 1];
        pair[0] = a;
        pair[1] = b;
    }
}

static void add_scattered(const double *restrict from, const int32_t *relative, int32_t begin, int32_t end,
                          double *restrict to)
{
    for (int32_t k = begin; k < end; k++) {
        to[relative[k]] += from[k];
    }
}

void sl_extend_update(const sl_cholesky *F, int32_t s, const double *U, double *update)
{
    const int32_t *relative = F->relative + F->below_first[s], rows = sl_supernode_below(F, s);
    const int32_t width = sl_supernode_width(F, F->parent[s]), owned = columns_in_panel(relative, rows, width);
    for (int32_t i = owned; i < rows; i++) {
        const double *from = U + sl_packed_size(i);
        double *to = update + sl_packed_size(relative[i] - width) - width;
        if (relative[i] - relative[owned] == i - owned) { /* no gaps */
            add_run(from + owned, i + 1 - owned, to + relative[owned]);
        } else if (F->block == 2) {
            const int32_t whole = i + i % 2; /* of an even row the last column has no partner */
            add_pairs(from, relative, owned, whole, to);
            add_scattered(from, relative, whole, i + 1, to);
        } else {
            add_scattered(from, relative, owned, i + 1, to);
        }
    }
}
