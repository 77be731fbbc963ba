#include "sparse/csc.h"

#include "base/memory.h"

#include <math.h>

sl_status sl_csc_create(int32_t nrows, int32_t ncols, int64_t nnz, sl_csc **out)
{
    SL_ASSERT(nrows >= 0 && ncols >= 0 && nnz >= 0);
    *out = NULL;
    sl_csc *A = sl_calloc(1, sizeof *A);
    if (A == NULL) {
        return SL_OUT_OF_MEMORY;
    }
    A->nrows = nrows;
    A->ncols = ncols;
    A->colptr = sl_calloc((int64_t)ncols + 1, sizeof *A->colptr);
    A->row = sl_alloc(nnz, sizeof *A->row);
    A->val = sl_alloc(nnz, sizeof *A->val);
    if (A->colptr == NULL || A->row == NULL || A->val == NULL) {
        sl_csc_free(A);
        return SL_OUT_OF_MEMORY;
    }
    *out = A;
    return SL_OK;
}

void sl_csc_free(sl_csc *A)
{
    if (A == NULL) {
        return;
    }
    sl_free(A->colptr);
    sl_free(A->row);
    sl_free(A->val);
    sl_free(A);
}

/* Turns counts per bucket into offsets: on entry first[k + 1] = count of k, on return first[k] = where k begins. */
static void counts_to_offsets(int32_t buckets, int64_t *first)
{
    for (int32_t k = 0; k < buckets; k++) {
        first[k + 1] += first[k];
    }
}

/* order = the triplets stably sorted by key; next: buckets + 1, zeroed. input: the order to start from, NULL = as
 * given. */
static void counting_sort(int32_t buckets, int64_t count, const int32_t *key, const int64_t *input, int64_t *next,
                          int64_t *order)
{
    for (int64_t t = 0; t < count; t++) {
        next[key[t] + 1]++;
    }
    counts_to_offsets(buckets, next);
    for (int64_t t = 0; t < count; t++) {
        const int64_t item = input != NULL ? input[t] : t;
        order[next[key[item]]++] = item;
    }
}

static sl_status check_triplets(int32_t nrows, int32_t ncols, int64_t count, const int32_t *row, const int32_t *col,
                                const double *val)
{
    if (nrows < 0 || ncols < 0 || count < 0) {
        return SL_BAD_INPUT;
    }
    for (int64_t t = 0; t < count; t++) {
        if (row[t] < 0 || row[t] >= nrows || col[t] < 0 || col[t] >= ncols || !isfinite(val[t])) {
            return SL_BAD_INPUT;
        }
    }
    return SL_OK;
}

/* Fills A from triplets sorted by column, then row. Duplicates are neighbours and are summed in their given order. */
static void fill_columns(sl_csc *A, int64_t count, const int64_t *order, const int32_t *row, const int32_t *col,
                         const double *val)
{
    int64_t filled = 0;
    int32_t last_col = -1;
    for (int64_t k = 0; k < count; k++) {
        const int64_t t = order[k];
        if (col[t] == last_col && A->row[filled - 1] == row[t]) {
            A->val[filled - 1] += val[t];
            continue;
        }
        last_col = col[t];
        A->row[filled] = row[t];
        A->val[filled] = val[t];
        A->colptr[last_col + 1]++;
        filled++;
    }
    counts_to_offsets(A->ncols, A->colptr);
}

sl_status sl_csc_from_triplets(int32_t nrows, int32_t ncols, int64_t count, const int32_t *row, const int32_t *col,
                               const double *val, sl_csc **out)
{
    *out = NULL;
    sl_csc *A = NULL;
    int64_t *by_row = NULL, *by_col = NULL, *row_next = NULL, *col_next = NULL;
    sl_status status = SL_OK;
    SL_TRY(check_triplets(nrows, ncols, count, row, col, val));
    by_row = sl_alloc(count, sizeof *by_row);
    by_col = sl_alloc(count, sizeof *by_col);
    row_next = sl_calloc((int64_t)nrows + 1, sizeof *row_next);
    col_next = sl_calloc((int64_t)ncols + 1, sizeof *col_next);
    if (by_row == NULL || by_col == NULL || row_next == NULL || col_next == NULL) {
        status = SL_OUT_OF_MEMORY;
        goto cleanup;
    }
    SL_TRY(sl_csc_create(nrows, ncols, count, &A));
    counting_sort(nrows, count, row, NULL, row_next, by_row);
    counting_sort(ncols, count, col, by_row, col_next, by_col);
    fill_columns(A, count, by_col, row, col, val);
    *out = A;
cleanup:
    sl_free(by_row);
    sl_free(by_col);
    sl_free(row_next);
    sl_free(col_next);
    return status;
}

static bool rows_are_sound(const sl_csc *A, int32_t j, bool lower)
{
    const int64_t begin = A->colptr[j], end = A->colptr[j + 1];
    if (lower && (begin == end || A->row[begin] != j)) {
        return false;
    }
    int32_t above = -1;
    for (int64_t p = begin; p < end; p++) {
        if (A->row[p] <= above || A->row[p] >= A->nrows) {
            return false;
        }
        above = A->row[p];
    }
    return true;
}

sl_status sl_csc_check_pattern(const sl_csc *A, bool lower)
{
    if (A == NULL || A->nrows < 0 || A->ncols < 0 || A->colptr == NULL || A->colptr[0] != 0) {
        return SL_BAD_INPUT;
    }
    if (lower && A->nrows != A->ncols) {
        return SL_BAD_INPUT;
    }
    for (int32_t j = 0; j < A->ncols; j++) {
        /* A column holds each row at most once: this bounds the reads before a row is looked at. */
        const int64_t size = A->colptr[j + 1] - A->colptr[j];
        if (A->colptr[j + 1] < A->colptr[j] || size > A->nrows) {
            return SL_BAD_INPUT;
        }
    }
    if (A->colptr[A->ncols] > 0 && A->row == NULL) {
        return SL_BAD_INPUT;
    }
    for (int32_t j = 0; j < A->ncols; j++) {
        if (!rows_are_sound(A, j, lower)) {
            return SL_BAD_INPUT;
        }
    }
    return SL_OK;
}

sl_status sl_csc_check(const sl_csc *A, bool lower)
{
    const sl_status status = sl_csc_check_pattern(A, lower);
    if (status != SL_OK || A->val == NULL) {
        return status;
    }
    for (int64_t p = 0; p < A->colptr[A->ncols]; p++) {
        if (!isfinite(A->val[p])) {
            return SL_BAD_INPUT;
        }
    }
    return SL_OK;
}
