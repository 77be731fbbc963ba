/* The k smallest eigenpairs of a graph Laplacian (or any symmetric positive semidefinite matrix with a known null
 * space) by shift-invert block Lanczos with full reorthogonalisation and thick restarts. Layer: eigen (may include
 * sparse, base). */
#ifndef SL_EIGEN_LANCZOS_H
#define SL_EIGEN_LANCZOS_H

#include "base/context.h"
#include "sparse/cholesky.h"

typedef struct sl_lanczos_def {
    int32_t count;            /* pairs wanted, the null space included; clipped to n; default 30 */
    int32_t block;            /* block width; 0 = chosen from n; default 0 */
    int32_t max_basis;        /* columns before a restart; 0 = chosen from count and block; default 0 */
    int32_t max_restarts;     /* default 50 */
    double tolerance;         /* ||A v - lambda v|| <= tolerance * ||A||_1; default 1e-8 */
    uint64_t seed;            /* start block; default 1 */
    const double *null_space; /* n x null_count, orthonormal columns, A null_space = 0; borrowed; default NULL */
    int32_t null_count;       /* default 0 */
    const double *xyz;        /* n x 3 for the ordering; borrowed; default NULL */
    const int32_t *perm;      /* ordering to inherit, length n; borrowed; default NULL */
} sl_lanczos_def;

sl_lanczos_def sl_lanczos_default(void);

/* How a solve went. */
typedef struct sl_lanczos_info {
    int32_t converged_count; /* pairs whose recomputed residual meets the tolerance */
    bool converged;          /* all of them do */
    int32_t restarts;        /* thick restarts taken */
    int32_t solves;          /* right-hand sides solved for */
    int32_t block;           /* block width used */
    double max_residual;     /* largest ||A v - lambda v|| / ||A||_1, recomputed at the end */
    bool dense;              /* small n: solved by LAPACKE instead */
} sl_lanczos_info;

typedef struct sl_lanczos sl_lanczos; /* opaque: owns factor, basis and workspace; borrows A */

/* A: n x n symmetric, lower triangle, positive semidefinite. Factors A - sigma I with a small negative sigma; a matrix
 * of order 200 or less, or too small for the basis, is solved here and now by LAPACKE. SL_BAD_INPUT (A unsound, a field
 * out of range, null_space not orthonormal or not mapped to 0), SL_OUT_OF_MEMORY, SL_CANCELLED, SL_INTERNAL (LAPACK
 * failed), SL_NOT_POSITIVE_DEFINITE (A has a clearly negative eigenvalue). */
SL_NODISCARD sl_status sl_lanczos_create(const sl_csc *A, const sl_lanczos_def *def, const sl_context *context,
                                         sl_lanczos **out);

/* Up to n restarts (a restart fills the basis once). SL_CANCELLED, SL_INTERNAL (LAPACKE failed). Allocates nothing. */
SL_NODISCARD sl_status sl_lanczos_step(sl_lanczos *solver, int32_t n);

const sl_lanczos_info *sl_lanczos_info_of(const sl_lanczos *solver); /* borrowed */

/* The pairs found, ascending: lambda: count values; vectors: n x count column-major, orthonormal, sign rule: the entry
 * of largest magnitude (the first of them, ties within 1e-8 relative) is positive; residual (nullable): count
 * recomputed
 * ||A v - lambda v|| / ||A||_1. */
void sl_lanczos_result(const sl_lanczos *solver, double *lambda, double *vectors, double *residual);

void sl_lanczos_free(sl_lanczos *solver); /* NULL is a no-op */

/* create, step to the end, result, free. lambda: min(count, n) values, vectors n x min(count, n), both the caller's;
 * residual and info are nullable. Not converging is no error: see info. After convergence a random block in the
 * complement of the pairs found hunts for missed copies of multiple values (any multiplicity, any block width) and is
 * counted in info.solves; a copy found means more restarts. Same bytes for any number of threads. */
SL_NODISCARD sl_status sl_lanczos_solve(const sl_csc *A, const sl_lanczos_def *def, const sl_context *context,
                                        double *lambda, double *vectors, double *residual, sl_lanczos_info *info);

/* All eigenpairs of a small dense symmetric matrix through LAPACKE (dsyevr): A n x n column-major, destroyed; lambda n
 * ascending; V n x n. SL_INTERNAL, SL_OUT_OF_MEMORY. */
SL_NODISCARD sl_status sl_dense_eigen(int32_t n, double *A, double *lambda, double *V);

#endif
