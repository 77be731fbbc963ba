#include "param/reconstruct_system_internal.h"

#include <string.h>

#include "base/memory.h"
#include "geom/vec3.h"
#include "param/sectors.h"
#include "sparse/order.h"

/* Border vertex farthest from a point, the lowest of equals; -1 without a border. */
static int32_t farthest_on_border(const sl_patch *patch, const double point[3], int32_t except)
{
    int32_t best = -1;
    double distance = -1.0;
    for (int32_t v = 0; v < patch->nv; v++) {
        if (patch->border[v] != 0 && v != except) {
            const double d = sl_vec3_distance(&patch->xyz[3 * (int64_t)v], point);
            if (d > distance) {
                best = v;
                distance = d;
            }
        }
    }
    return best;
}

static void choose_pins(const sl_patch *patch, int32_t pin[2])
{
    double mean[3] = {0.0, 0.0, 0.0};
    int32_t count = 0;
    for (int32_t v = 0; v < patch->nv; v++) {
        if (patch->border[v] != 0) {
            sl_vec3_add(mean, &patch->xyz[3 * (int64_t)v], mean);
            count++;
        }
    }
    for (int k = 0; k < 3 && count > 0; k++) {
        mean[k] /= count;
    }
    pin[0] = farthest_on_border(patch, mean, -1);
    pin[1] = pin[0] < 0 ? -1 : farthest_on_border(patch, &patch->xyz[3 * (int64_t)pin[0]], pin[0]);
}

/* Do the twins join all triangles? Several components could move apart freely. */
static sl_status check_connected(const sl_patch *patch)
{
    int32_t *queue = sl_alloc(patch->nt, sizeof *queue);
    uint8_t *seen = sl_calloc(patch->nt, sizeof *seen);
    sl_status status = SL_OUT_OF_MEMORY;
    if (queue != NULL && seen != NULL) {
        int32_t count = 1;
        queue[0] = 0;
        seen[0] = 1;
        for (int32_t i = 0; i < count; i++) {
            for (int k = 0; k < 3; k++) {
                const int32_t twin = patch->twin[3 * queue[i] + k];
                if (twin >= 0 && seen[twin / 3] == 0) {
                    seen[twin / 3] = 1;
                    queue[count++] = twin / 3;
                }
            }
        }
        status = count == patch->nt ? SL_OK : SL_SINGULAR;
    }
    sl_free(queue);
    sl_free(seen);
    return status;
}

sl_status sl_layout_init(sl_layout *layout, const sl_patch *patch)
{
    sl_status status = SL_OK;
    *layout = (sl_layout){.patch = patch, .pin = {-1, -1}};
    SL_TRY(patch->nv >= 3 && patch->nt >= 1 ? SL_OK : SL_SINGULAR);
    SL_TRY(patch->nv <= INT32_MAX / 2 ? SL_OK : SL_OUT_OF_MEMORY);
    SL_TRY(check_connected(patch));
    choose_pins(patch, layout->pin);
    SL_TRY(layout->pin[1] >= 0 ? SL_OK : SL_SINGULAR);
    layout->unknown = sl_alloc(patch->nv, sizeof *layout->unknown);
    layout->cot = sl_calloc(3 * (int64_t)patch->nt, sizeof *layout->cot);
    layout->w = sl_calloc(6 * (int64_t)patch->nt, sizeof *layout->w);
    layout->fill = sl_alloc(2 * (int64_t)patch->nv, sizeof *layout->fill);
    layout->last = sl_alloc(2 * (int64_t)patch->nv, sizeof *layout->last);
    if (layout->unknown == NULL || layout->cot == NULL || layout->w == NULL || layout->fill == NULL ||
        layout->last == NULL) {
        status = SL_OUT_OF_MEMORY;
        goto cleanup;
    }
    for (int32_t v = 0; v < patch->nv; v++) {
        layout->unknown[v] = v == layout->pin[0] || v == layout->pin[1] ? -1 : layout->nfree++;
    }
cleanup:
    if (status != SL_OK) {
        sl_layout_clear(layout);
    }
    return status;
}

void sl_layout_clear(sl_layout *layout)
{
    sl_free(layout->unknown);
    sl_free(layout->fill);
    sl_free(layout->last);
    sl_free(layout->cot);
    sl_free(layout->w);
    *layout = (sl_layout){0};
}

/* Lower triangle of R alone: the graph of the free vertices. */
static sl_status vertex_pattern(const sl_csc *A, sl_csc **out)
{
    sl_status status = SL_OK;
    sl_csc *G = NULL;
    int64_t nnz = 0;
    SL_TRY(sl_csc_create(A->nrows / 2, A->ncols / 2, A->colptr[A->ncols], &G));
    for (int32_t j = 0; j < G->ncols; j++) {
        G->colptr[j] = nnz;
        for (int64_t p = A->colptr[2 * j]; p < A->colptr[2 * j + 1]; p++) {
            if (A->row[p] % 2 == 0) {
                G->row[nnz++] = A->row[p] / 2;
            }
        }
    }
    G->colptr[G->ncols] = nnz;
    *out = G;
cleanup:
    return status;
}

sl_status sl_layout_order(const sl_layout *layout, const sl_csc *A, int32_t *perm)
{
    sl_status status = SL_OK;
    sl_csc *G = NULL;
    double *xyz = sl_alloc(3 * (int64_t)layout->nfree, sizeof *xyz);
    SL_TRY(xyz != NULL ? SL_OK : SL_OUT_OF_MEMORY);
    SL_TRY(vertex_pattern(A, &G));
    for (int32_t v = 0; v < layout->patch->nv; v++) {
        if (layout->unknown[v] >= 0) {
            memcpy(&xyz[3 * (int64_t)layout->unknown[v]], &layout->patch->xyz[3 * (int64_t)v], 3 * sizeof *xyz);
        }
    }
    SL_TRY(sl_order(G, SL_ORDER_AUTO, xyz, perm));
    for (int32_t k = layout->nfree; k-- > 0;) { /* from the end: what is read has not been written yet */
        const int32_t f = perm[k];
        perm[2 * k] = 2 * f;
        perm[2 * k + 1] = 2 * f + 1;
    }
cleanup:
    sl_csc_free(G);
    sl_free(xyz);
    return status;
}

/* One entry of H: the neighbour, the cotangent Laplacian's weight, +1 or -1 along the border. */
typedef struct neighbour {
    int32_t vertex;
    double real, imag;
} neighbour;

/* The edge of halfedge c, seen from its origin. */
static neighbour along(const sl_layout *layout, int32_t c)
{
    const sl_patch *patch = layout->patch;
    const int32_t twin = patch->twin[c];
    const double other = twin >= 0 ? layout->cot[sl_corner_prev(twin)] : 0.0;
    return (neighbour){patch->tri[sl_corner_next(c)], -layout->cot[sl_corner_prev(c)] - other, twin < 0 ? 1.0 : 0.0};
}

/* The border edge that arrives at corner c. */
static neighbour arriving(const sl_layout *layout, int32_t c)
{
    return (neighbour){layout->patch->tri[sl_corner_prev(c)], -layout->cot[sl_corner_next(c)], -1.0};
}

/* A lower triangle whose columns grow row by row: rows come in ascending order, so nothing needs sorting. Without `row`
 * the entries are only counted. */
typedef struct columns {
    int64_t *fill; /* 2 nfree: end of each column */
    int32_t *last; /* 2 nfree: its last row, -1 = none */
    int32_t *row;
    double *val;
} columns;

static void add(columns *out, int32_t row, int32_t col, double value)
{
    if (out->last[col] != row) {
        out->last[col] = row;
        if (out->row != NULL) {
            out->row[out->fill[col]] = row;
            out->val[out->fill[col]] = 0.0;
        }
        out->fill[col]++;
    }
    if (out->row != NULL) {
        out->val[out->fill[col] - 1] += value;
    }
}

/* Row 2 i (axis 0) or 2 i + 1 (axis 1) of [R -S; S R], i the unknown of vertex v, left of the diagonal and on it. */
static void add_row(const sl_layout *layout, int32_t v, int axis, columns *out)
{
    const int32_t i = layout->unknown[v], start = layout->patch->outgoing[v];
    const int32_t row = 2 * i + axis;
    double diagonal = 0.0;
    int32_t c = start, here;
    do {
        here = c;
        c = sl_corner_rotate(layout->patch, c);
        neighbour near[2] = {along(layout, here)};
        const int count = c < 0 ? 2 : 1;
        if (c < 0) {
            near[1] = arriving(layout, here);
        }
        for (int n = 0; n < count; n++) {
            const int32_t j = layout->unknown[near[n].vertex];
            diagonal -= near[n].real;
            if (j >= 0 && j < i) {
                add(out, row, 2 * j + axis, near[n].real);
                if (near[n].imag != 0.0) {
                    add(out, row, 2 * j + 1 - axis, axis == 0 ? -near[n].imag : near[n].imag);
                }
            }
        }
    } while (c >= 0 && c != start);
    add(out, row, row, diagonal);
}

static void add_rows(const sl_layout *layout, columns *out)
{
    for (int32_t i = 0; i < 2 * layout->nfree; i++) {
        out->last[i] = -1;
    }
    for (int32_t v = 0; v < layout->patch->nv; v++) {
        for (int axis = 0; axis < 2 && layout->unknown[v] >= 0; axis++) {
            add_row(layout, v, axis, out);
        }
    }
}

sl_status sl_layout_pattern(sl_layout *layout, sl_csc **out)
{
    sl_status status = SL_OK;
    sl_csc *A = NULL;
    const int32_t n = 2 * layout->nfree;
    columns cols = {.fill = layout->fill, .last = layout->last};
    int64_t nnz = 0;
    memset(cols.fill, 0, (size_t)n * sizeof *cols.fill);
    add_rows(layout, &cols);
    for (int32_t j = 0; j < n; j++) {
        nnz += cols.fill[j];
    }
    SL_TRY(sl_csc_create(n, n, nnz, &A));
    int64_t start = 0;
    for (int32_t j = 0; j < n; j++) {
        A->colptr[j] = start;
        start += cols.fill[j];
    }
    A->colptr[n] = start;
    sl_layout_fill(layout, A);
    *out = A;
cleanup:
    return status;
}

void sl_layout_fill(sl_layout *layout, sl_csc *A)
{
    columns cols = {.fill = layout->fill, .last = layout->last, .row = A->row, .val = A->val};
    memcpy(cols.fill, A->colptr, (size_t)A->ncols * sizeof *cols.fill);
    add_rows(layout, &cols);
}
