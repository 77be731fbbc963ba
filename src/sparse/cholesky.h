/* Sparse Cholesky P A P' = L L' of a symmetric positive definite matrix, supernodal.
 * Layer: sparse (may include base only). */
#ifndef SL_SPARSE_CHOLESKY_H
#define SL_SPARSE_CHOLESKY_H

#include "base/context.h"
#include "sparse/csc.h"
#include "sparse/order.h"

typedef struct sl_cholesky sl_cholesky; /* opaque: owns P, the symbolic analysis and L */

typedef struct sl_cholesky_def {
    sl_ordering ordering; /* default SL_ORDER_AUTO */
    const double *xyz;    /* n x 3, a point per unknown for geometric dissection; borrowed; default NULL */
    const int32_t *perm;  /* length n, an ordering to inherit; borrowed; default NULL = computed */
    double pivot_rtol;    /* reject pivot d_k <= pivot_rtol * max|a_ii|; unitless; default 0 */
} sl_cholesky_def;

sl_cholesky_def sl_cholesky_default(void);

/* Symbolic phase. A: n x n, lower triangle, sorted columns, n >= 0. On failure *out is NULL. SL_BAD_INPUT (not square,
 * unsorted, not lower), SL_OUT_OF_MEMORY. */
SL_NODISCARD sl_status sl_cholesky_analyze(const sl_csc *A, const sl_cholesky_def *def, sl_cholesky **out);

/* Numeric phase; call again when values change but the pattern does not. SL_NOT_POSITIVE_DEFINITE sets *bad_column
 * (nullable) to the column of A at fault; F may then be refactored or freed. SL_BAD_INPUT: a value is not finite, or
 * the pattern is another. Allocates nothing. */
SL_NODISCARD sl_status sl_cholesky_factor(sl_cholesky *F, const sl_csc *A, int32_t *bad_column);

/* X: n x nrhs, column-major, leading dimension n; B on entry, inv(A) B on return. work: sl_cholesky_work_size(F, nrhs)
 * doubles, no meaning on return, one per thread: two threads may solve with one factor. Cannot fail, allocates nothing.
 */
void sl_cholesky_solve(const sl_cholesky *F, double *X, int32_t nrhs, double *work);
int64_t sl_cholesky_work_size(const sl_cholesky *F, int32_t nrhs);

/* Analyze, factor and solve A X = B once: X holds B on entry. */
SL_NODISCARD sl_status sl_cholesky_solve_once(const sl_csc *A, const sl_cholesky_def *def, double *X, int32_t nrhs);

/* Entries of L (supernode padding included), and the permutation in use (length n, borrowed). */
int64_t sl_cholesky_nnz(const sl_cholesky *F);
const int32_t *sl_cholesky_permutation(const sl_cholesky *F);

void sl_cholesky_free(sl_cholesky *F); /* NULL is a no-op */

#endif
