/* The state of the block Lanczos solver and its parts; internal to the room.
 * Layer: eigen. */
#ifndef SL_EIGEN_LANCZOS_INTERNAL_H
#define SL_EIGEN_LANCZOS_INTERNAL_H

#include "base/rng.h"
#include "eigen/lanczos.h"

#include <lapacke.h>

/* The widest block. */
#define SL_LANCZOS_MAX_BLOCK 32

/* OP = inv(M), M = A - sigma I. The basis Q has orthonormal columns: the null space first, then `size` columns OP has
 * been applied to, then the block it is applied to next. On those `size` columns V, with W the next block, OP V = V T +
 * W R E'   (E = the last `block` unit vectors) up to the null space, which OP maps to itself. */
struct sl_lanczos {
    int32_t n;
    int32_t count;      /* pairs delivered: null_count + wanted */
    int32_t null_count; /* columns of the null space in Q, already clipped to count */
    int32_t wanted;     /* pairs to compute */
    int32_t block, max_basis;
    double tolerance, norm, sigma;
    const sl_csc *A;           /* borrowed */
    const sl_context *context; /* borrowed */
    sl_rng rng;
    sl_cholesky *factor;
    double *solve_work;
    double *Q; /* n x (null_count + max_basis + block) */
    int32_t size;
    double *T;     /* max_basis x max_basis, leading dimension max_basis */
    double *R;     /* block x block, upper triangular */
    double *S;     /* size x size eigenvectors of T, leading dimension size, by descending theta */
    double *theta; /* max_basis, descending */
    double *H;     /* projections: (null_count + max_basis + block) x block, twice */
    double *Z;     /* n x block */
    double *chunk; /* rows of the basis while it is rotated in place */
    double *G;     /* wanted x wanted, and block x block before */
    double *lapack;
    lapack_int *lapack_int;
    bool verifying;        /* hunting for missed copies */
    int32_t verify_left;   /* block steps until the hunt is over */
    double *verify_lambda; /* wanted: the values before the hunt */
    bool finished;
    double *X;                 /* n x count: the pairs found */
    double *lambda, *residual; /* count */
    sl_lanczos_info info;
};

/* basis.c: column k of V, or of the block after it. */
double *sl_lanczos_column(const sl_lanczos *s, int32_t k);

/* Fills the block after V with random unit vectors orthogonal to all before them. */
void sl_lanczos_random_block(sl_lanczos *s);

/* One block step: T, R and the next block; size grows by one block. */
void sl_lanczos_expand(sl_lanczos *s);

/* V (n x columns) = V S for its first `kept` columns; S: columns x kept, leading dimension columns. */
void sl_lanczos_rotate(sl_lanczos *s, double *V, int32_t columns, const double *S, int32_t kept);

/* Doubles of s->chunk. */
int64_t sl_lanczos_rotation_work(const sl_lanczos *s);

/* ritz.c: theta and S from T. SL_INTERNAL when LAPACK fails. */
SL_NODISCARD sl_status sl_lanczos_ritz(sl_lanczos *s);

/* The eigenvalue of A that belongs to an eigenvalue of OP. */
double sl_lanczos_lambda(const sl_lanczos *s, double theta);

/* How many of the wanted Ritz pairs meet the tolerance, from T, R and the next block alone. */
int32_t sl_lanczos_count_converged(sl_lanczos *s);

/* Replaces V by its `kept` leading Ritz vectors (after sl_lanczos_ritz); the next block follows them. */
void sl_lanczos_restart(sl_lanczos *s, int32_t kept);

/* X, lambda, residual and what info says of them from the first `wanted` columns of V, by a Rayleigh-Ritz step with A.
 */
SL_NODISCARD sl_status sl_lanczos_extract(sl_lanczos *s);

/* One inverse iteration of X, orthonormalised, and a Rayleigh-Ritz step with A. */
SL_NODISCARD sl_status sl_lanczos_polish(sl_lanczos *s);

/* dense.c: all pairs through LAPACKE, X, lambda, residual and info filled. */
SL_NODISCARD sl_status sl_lanczos_solve_dense(sl_lanczos *s);

/* Residuals of X, the sign rule and info's summary; what any way of filling X and lambda ends with. */
void sl_lanczos_finish_pairs(sl_lanczos *s);

#endif
