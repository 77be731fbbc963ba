/* The k smallest eigenpairs of a graph Laplacian (or any symmetric positive semidefinite matrix with a known null
 * space) by shift-invert block Lanczos, certified by an inertia count. Large problems start on the separators of the
 * factorisation's nested dissection alone. Layer: eigen (may include sparse, base). */
#ifndef SL_EIGEN_LANCZOS_H
#define SL_EIGEN_LANCZOS_H

#include "base/context.h"
#include "sparse/cholesky.h"

/* When a pair (lambda, v), ||v|| = 1, counts as found. */
typedef enum sl_lanczos_mode {
    SL_LANCZOS_TOLERANCE, /* ||A v - lambda v|| <= tolerance * ||A||_1 */
    SL_LANCZOS_SIGNS      /* ||A v - lambda v|| <= sign_tolerance * lambda: enough where only signs of v matter; pairs
                             with lambda below the tolerance's reach are held to the tolerance */
} sl_lanczos_mode;

/* Where the search begins. */
typedef enum sl_lanczos_start {
    SL_START_AUTO,    /* by size and mode */
    SL_START_PLAIN,   /* a random block of all unknowns */
    SL_START_SKELETON /* Lanczos on the separators first */
} sl_lanczos_start;

typedef struct sl_lanczos_def {
    int32_t count;            /* pairs wanted, the null space included; clipped to n; default 30 */
    sl_lanczos_mode mode;     /* default SL_LANCZOS_TOLERANCE */
    double tolerance;         /* [1e-14, 1); default 1e-8 */
    double sign_tolerance;    /* (0, 1); default 2e-3: no sign of 70,000 came out wrong */
    bool certify;             /* count the eigenvalues below the last one found; default true */
    int32_t block;            /* block width, rounded up to 4, 8, 16, 24 or 32; 0 = chosen from n; default 0 */
    int32_t max_basis;        /* columns before a restart; 0 = chosen from count and block; default 0 */
    int32_t max_restarts;     /* steps of sl_lanczos_solve beyond the first; default 50 */
    uint64_t seed;            /* start block; default 1 */
    const double *null_space; /* n x null_count, orthonormal columns, A null_space = 0; borrowed as long as the solver
                                 lives; default NULL */
    int32_t null_count;       /* default 0 */
    const double *xyz;        /* n x 3 for the ordering; borrowed; default NULL */
    const int32_t *perm;      /* ordering to inherit, length n; borrowed; default NULL */
    sl_lanczos_start start;   /* default SL_START_AUTO */
    int32_t patch;            /* unknowns of a patch the skeleton eliminates; 0 = chosen; default 0 */
    int64_t memory_limit;     /* bytes; 0 = none; default 0 */
} sl_lanczos_def;

sl_lanczos_def sl_lanczos_default(void);

/* How a solve went. */
typedef struct sl_lanczos_info {
    int32_t converged_count; /* pairs whose recomputed residual meets the mode's bound */
    bool converged;          /* all of them do */
    bool certified;          /* and inertia counts say that none is missing */
    double sigma;            /* certified: no eigenvalue between the last pair counted and here is missing */
    int32_t count;           /* eigenvalues counted below sigma */
    bool cluster_cut;        /* the wanted set ends inside a cluster too large to be found whole: sigma lies above the
                                cluster, `count` bounds its size; the pairs below it, `count_below`, are all found */
    double sigma_below;      /* cluster_cut: just below the cluster */
    int32_t count_below;
    int32_t counts;          /* inertia counts made */
    int32_t restarts;        /* thick restarts, and restarts with a larger block after a count disagreed */
    int32_t iterations;      /* block inverse iterations, the one after a basis of single precision included */
    int32_t solves;          /* right-hand sides solved for with the whole factor */
    int32_t skeleton_solves; /* with its top part alone */
    int32_t block;           /* block width used */
    int32_t patch;           /* skeleton: unknowns of a patch at most; 0 = plain start */
    double max_residual;     /* largest ||A v - lambda v|| / ||A||_1, recomputed at the end */
    double max_relative;     /* largest ||A v - lambda v|| / lambda of the computed pairs with lambda > 0 */
    int64_t memory;          /* bytes estimated before allocating, those of A and the results not included */
    bool dense;              /* small n: solved by LAPACKE instead */
} sl_lanczos_info;

typedef struct sl_lanczos sl_lanczos; /* opaque: owns factor, basis and workspace; borrows A */

/* A: n x n symmetric, lower triangle, positive semidefinite. Orders and factors A - sigma I with a small negative
 * sigma; a matrix of order 200 or less, or too small for the basis, is solved here and now by LAPACKE. SL_BAD_INPUT (A
 * unsound, a field out of range, null_space not orthonormal or not mapped to 0), SL_OUT_OF_MEMORY, SL_LIMIT (more than
 * memory_limit would be needed), SL_CANCELLED, SL_INTERNAL (LAPACK failed), SL_NOT_POSITIVE_DEFINITE (A has a clearly
 * negative eigenvalue). */
SL_NODISCARD sl_status sl_lanczos_create(const sl_csc *A, const sl_lanczos_def *def, const sl_context *context,
                                         sl_lanczos **out);

/* Up to n steps. A step is: the Krylov space of the skeleton; one filling of the Krylov basis; one block inverse
 * iteration with its Rayleigh-Ritz step; or the inertia count at the end. What was found so far may be asked for after
 * any of them. Nothing happens once it has converged. SL_OUT_OF_MEMORY, SL_CANCELLED, SL_INTERNAL (LAPACKE failed). */
SL_NODISCARD sl_status sl_lanczos_step(sl_lanczos *solver, int32_t n);

const sl_lanczos_info *sl_lanczos_info_of(const sl_lanczos *solver); /* borrowed */

/* Whether steps would go on: neither converged (and certified, where asked for) nor at their end. */
bool sl_lanczos_finished(const sl_lanczos *solver);

/* The pairs found, ascending: lambda: count values; vectors: n x count column-major, orthonormal, sign rule: the entry
 * of largest magnitude (the first of them, ties within 1e-8 relative) is positive; residual (nullable): count
 * recomputed ||A v - lambda v|| / ||A||_1. Before the first step vectors and values are zero but for the null space. */
void sl_lanczos_result(const sl_lanczos *solver, double *lambda, double *vectors, double *residual);

void sl_lanczos_free(sl_lanczos *solver); /* NULL is a no-op */

/* create, step to the end, result, free. lambda: min(count, n) values, vectors n x min(count, n), both the caller's;
 * residual and info are nullable. Not converging is no error, nor is a missing certificate: see info. Same bytes for
 * any number of threads. */
SL_NODISCARD sl_status sl_lanczos_solve(const sl_csc *A, const sl_lanczos_def *def, const sl_context *context,
                                        double *lambda, double *vectors, double *residual, sl_lanczos_info *info);

/* All eigenpairs of a small dense symmetric matrix through LAPACKE (dsyevr): A n x n column-major, destroyed; lambda n
 * ascending; V n x n. SL_INTERNAL, SL_OUT_OF_MEMORY. */
SL_NODISCARD sl_status sl_dense_eigen(int32_t n, double *A, double *lambda, double *V);

#endif
