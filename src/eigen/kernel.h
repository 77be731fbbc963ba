/* Kernels on rows of panels, one source compiled for several instruction sets and chosen when the program loads;
 * internal to the room. Products and sums are rounded one by one in the same order everywhere (no fused operations), so
 * all versions give the same bytes.
 * Layer: eigen. */
#ifndef SL_EIGEN_KERNEL_H
#define SL_EIGEN_KERNEL_H

#include <stdint.h>

/* H (8 x w, row by row) += P' W; P: rows x 8, W: rows x w, w = 4 or 8. */
void sl_kernel_gram(const double *P, const double *W, int64_t rows, int32_t w, double *H);

/* W (rows x w) += P H; P: rows x 8, H: 8 x w. */
void sl_kernel_add(const double *P, const double *H, int64_t rows, int32_t w, double *W);

/* G (w x w) += W' W. */
void sl_kernel_self(const double *W, int64_t rows, int32_t w, double *G);

/* W := W U, U: w x w upper triangular, row by row. */
void sl_kernel_triangle(const double *U, int64_t rows, int32_t w, double *W);

/* Y (rows x w) = rows begin .. begin + rows - 1 of (A - shift I) X. */
void sl_kernel_multiply(const int64_t *first, const int32_t *col, const double *val, double shift, const double *X,
                        int32_t w, int64_t begin, int64_t rows, double *Y);

/* Y = X and back, rounded. */
void sl_kernel_widen(const float *X, int64_t count, double *Y);
void sl_kernel_narrow(const double *X, int64_t count, float *Y);

#endif
