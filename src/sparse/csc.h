/* Compressed sparse columns.
 * Layer: sparse (may include base only). */
#ifndef SL_SPARSE_CSC_H
#define SL_SPARSE_CSC_H

#include "base/status.h"

/* Column j holds row[p], val[p] for p = colptr[j] .. colptr[j + 1] - 1, rows ascending. Symmetric matrices are stored
 * as their lower triangle, diagonal included. */
typedef struct sl_csc {
    int32_t nrows, ncols;
    int64_t *colptr; /* ncols + 1 */
    int32_t *row;
    double *val;
} sl_csc;

/* A matrix with room for nnz entries, colptr zeroed. SL_OUT_OF_MEMORY. */
SL_NODISCARD sl_status sl_csc_create(int32_t nrows, int32_t ncols, int64_t nnz, sl_csc **out);

/* From triplets; duplicates are summed, rows sorted. O(n + triplets log column). SL_BAD_INPUT (index out of range,
 * value not finite), SL_OUT_OF_MEMORY. */
SL_NODISCARD sl_status sl_csc_from_triplets(int32_t nrows, int32_t ncols, int64_t count, const int32_t *row,
                                            const int32_t *col, const double *val, sl_csc **out);

void sl_csc_free(sl_csc *A); /* NULL is a no-op */

/* SL_BAD_INPUT unless dimensions, pointers, sorted rows and (values given) finiteness are in order; lower: only the
 * lower triangle and a full diagonal. */
SL_NODISCARD sl_status sl_csc_check(const sl_csc *A, bool lower);

/* The same without looking at the values. */
SL_NODISCARD sl_status sl_csc_check_pattern(const sl_csc *A, bool lower);

/* y = A x for a general matrix; yt = A' x. No aliasing. */
void sl_csc_multiply(const sl_csc *A, const double *x, double *y);
void sl_csc_multiply_transposed(const sl_csc *A, const double *x, double *y);

/* Y = A X for a symmetric matrix given by its lower triangle; X, Y n x nrhs column-major. No aliasing. */
void sl_csc_multiply_symmetric(const sl_csc *A, const double *X, int32_t nrhs, double *Y);

/* Lower triangle of A' diag(w) A (w NULL = 1): normal equations. SL_OUT_OF_MEMORY. */
SL_NODISCARD sl_status sl_csc_normal_matrix(const sl_csc *A, const double *w, sl_csc **out);

#endif
