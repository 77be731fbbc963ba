#include "sparse/csc.h"

#include "base/memory.h"

#include <string.h>

void sl_csc_multiply(const sl_csc *A, const double *x, double *y)
{
    memset(y, 0, (size_t)A->nrows * sizeof *y);
    for (int32_t j = 0; j < A->ncols; j++) {
        for (int64_t p = A->colptr[j]; p < A->colptr[j + 1]; p++) {
            y[A->row[p]] += A->val[p] * x[j];
        }
    }
}

void sl_csc_multiply_transposed(const sl_csc *A, const double *x, double *y)
{
    for (int32_t j = 0; j < A->ncols; j++) {
        double sum = 0.0;
        for (int64_t p = A->colptr[j]; p < A->colptr[j + 1]; p++) {
            sum += A->val[p] * x[A->row[p]];
        }
        y[j] = sum;
    }
}

void sl_csc_multiply_symmetric(const sl_csc *A, const double *X, int32_t nrhs, double *Y)
{
    for (int32_t c = 0; c < nrhs; c++) {
        const double *x = X + (int64_t)c * A->ncols;
        double *y = Y + (int64_t)c * A->ncols;
        memset(y, 0, (size_t)A->ncols * sizeof *y);
        for (int32_t j = 0; j < A->ncols; j++) {
            double sum = 0.0;
            for (int64_t p = A->colptr[j]; p < A->colptr[j + 1]; p++) {
                const int32_t i = A->row[p];
                sum += A->val[p] * x[i];
                if (i != j) {
                    y[i] += A->val[p] * x[j];
                }
            }
            y[j] += sum;
        }
    }
}

/* B = A', rows sorted. */
static sl_status transpose(const sl_csc *A, sl_csc **out)
{
    sl_csc *B = NULL;
    int64_t *next = NULL;
    sl_status status = SL_OK;
    *out = NULL;
    const int64_t nnz = A->colptr[A->ncols];
    SL_TRY(sl_csc_create(A->ncols, A->nrows, nnz, &B));
    for (int64_t p = 0; p < nnz; p++) {
        B->colptr[A->row[p] + 1]++;
    }
    for (int32_t i = 0; i < A->nrows; i++) {
        B->colptr[i + 1] += B->colptr[i];
    }
    next = sl_copy(B->colptr, A->nrows, sizeof *next);
    if (next == NULL) {
        sl_csc_free(B);
        status = SL_OUT_OF_MEMORY;
        goto cleanup;
    }
    for (int32_t j = 0; j < A->ncols; j++) {
        for (int64_t p = A->colptr[j]; p < A->colptr[j + 1]; p++) {
            const int64_t q = next[A->row[p]]++;
            B->row[q] = j;
            B->val[q] = A->val[p];
        }
    }
    *out = B;
cleanup:
    sl_free(next);
    return status;
}

/* Entries of the upper triangle of A'A with the whole diagonal; mark: ncols, any content. */
static int64_t count_upper(const sl_csc *A, const sl_csc *At, int32_t *mark)
{
    int64_t count = 0;
    memset(mark, -1, (size_t)A->ncols * sizeof *mark);
    for (int32_t j = 0; j < A->ncols; j++) {
        mark[j] = j;
        count++;
        for (int64_t p = A->colptr[j]; p < A->colptr[j + 1]; p++) {
            const int32_t r = A->row[p];
            for (int64_t q = At->colptr[r]; q < At->colptr[r + 1] && At->row[q] < j; q++) {
                count += mark[At->row[q]] != j;
                mark[At->row[q]] = j;
            }
        }
    }
    return count;
}

/* U = upper triangle of A' diag(w) A, rows of a column in the order met; position: ncols, any content. */
static void fill_upper(const sl_csc *A, const sl_csc *At, const double *w, int64_t *position, sl_csc *U)
{
    int64_t filled = 0;
    memset(position, -1, (size_t)A->ncols * sizeof *position);
    for (int32_t j = 0; j < A->ncols; j++) {
        const int64_t begin = filled;
        position[j] = filled;
        U->row[filled] = j;
        U->val[filled++] = 0.0;
        for (int64_t p = A->colptr[j]; p < A->colptr[j + 1]; p++) {
            const int32_t r = A->row[p];
            const double scaled = (w != NULL ? w[r] : 1.0) * A->val[p];
            for (int64_t q = At->colptr[r]; q < At->colptr[r + 1] && At->row[q] <= j; q++) {
                const int32_t i = At->row[q];
                if (position[i] < begin) {
                    position[i] = filled;
                    U->row[filled] = i;
                    U->val[filled++] = 0.0;
                }
                U->val[position[i]] += scaled * At->val[q];
            }
        }
        U->colptr[j + 1] = filled;
    }
}

sl_status sl_csc_normal_matrix(const sl_csc *A, const double *w, sl_csc **out)
{
    sl_csc *At = NULL, *U = NULL;
    int64_t *position = NULL;
    int32_t *mark = NULL;
    sl_status status = SL_OK;
    *out = NULL;
    SL_TRY(transpose(A, &At));
    mark = sl_alloc(A->ncols, sizeof *mark);
    position = sl_alloc(A->ncols, sizeof *position);
    if (mark == NULL || position == NULL) {
        status = SL_OUT_OF_MEMORY;
        goto cleanup;
    }
    SL_TRY(sl_csc_create(A->ncols, A->ncols, count_upper(A, At, mark), &U));
    fill_upper(A, At, w, position, U);
    SL_TRY(transpose(U, out)); /* sorts the rows */
cleanup:
    sl_csc_free(At);
    sl_csc_free(U);
    sl_free(mark);
    sl_free(position);
    return status;
}
