/* Block Lanczos with full orthogonalisation and thick restarts for any symmetric operator; internal to the room.
 * Layer: eigen. */
#ifndef SL_EIGEN_KRYLOV_H
#define SL_EIGEN_KRYLOV_H

#include "base/rng.h"
#include "eigen/panel.h"

#include <lapacke.h>

/* The widest block. */
#define SL_KRYLOV_MAX_BLOCK 32

/* W := OP W; W: rows x w row by row, w = 4 or 8. */
typedef void sl_operator_fn(void *user, double *W, int32_t w);

/* The basis Q has orthonormal columns: `fixed` given ones that OP maps into their own span (deflated), then `applied`
 * columns V that OP has been applied to, then `pending` columns P that it has not:
 *
 *     OP V = V T + P B        T, B: rows of `T`, up to the fixed columns
 */
typedef struct sl_krylov {
    sl_panels Q;
    int32_t fixed, applied, pending;
    int32_t block, w; /* pending columns at full width; columns OP is applied to at once: 4 or 8 */
    int32_t max_basis;
    bool both_ends; /* leading Ritz values are the largest in magnitude, not the largest */
    sl_operator_fn *apply;
    void *user;
    const sl_context *context; /* borrowed */
    sl_rng rng;
    int64_t operations; /* columns OP was applied to */
    double *T;          /* (max_basis + block) squared; column j < applied is complete */
    double *W, *spare;  /* rows x w: the block at work, and the one OP was applied to */
    double *H, *again, *corrected, *partial;
    double *S, *theta; /* Ritz vectors (applied x found, column-major) and values, the largest first */
    double *last;      /* found: ||B s_k||, what OP x_k - theta_k x_k measures */
    int32_t found;
    double *copy, *lapack; /* max_basis squared; workspace */
    lapack_int *lapack_int;
} sl_krylov;

/* When to look at the Ritz pairs next, by how fast the logarithm of the worst error fell since the last look. */
typedef struct sl_krylov_watch {
    int32_t look;   /* columns at which to look */
    int32_t before; /* columns at the last look; 0 = none */
    double worst;   /* error then, over what is allowed */
} sl_krylov_watch;

/* Whether it is time, or the basis is full. */
static inline bool sl_krylov_looks(const sl_krylov *k, const sl_krylov_watch *watch)
{
    return k->applied >= watch->look || k->applied + k->w > k->max_basis;
}

/* What was seen. */
void sl_krylov_seen(const sl_krylov *k, sl_krylov_watch *watch, double worst);

/* Bytes of a basis and what belongs to it. */
int64_t sl_krylov_bytes(int64_t rows, int32_t fixed, int32_t block, int32_t max_basis, sl_precision precision);

/* block: 4 or a multiple of 8 up to SL_KRYLOV_MAX_BLOCK. A basis of single precision is as good as orthonormal for T
 * (Simon 1984: to the square root of the roundings is enough), its Ritz vectors have errors of 1e-7, hardly any of it
 * in directions that OP does not damp. apply and user are set by the caller, and the fixed columns stored in Q.
 * SL_OUT_OF_MEMORY; *k may then be cleared. */
SL_NODISCARD sl_status sl_krylov_init(int32_t rows, int32_t fixed, int32_t block, int32_t max_basis,
                                      sl_precision precision, uint64_t seed, const sl_context *context, sl_krylov *k);
void sl_krylov_clear(sl_krylov *k);

/* Columns of Q in use. */
static inline int32_t sl_krylov_columns(const sl_krylov *k)
{
    return k->fixed + k->applied + k->pending;
}

/* W = W_new R with orthonormal W_new, W orthogonal to the basis and G = W'W: by Cholesky of G twice, or column by
 * column. Lanes that depend on the basis or on one another (before: their lengths before they were projected) are
 * replaced by random ones, with zeros in R. */
void sl_krylov_orthonormalise(sl_krylov *k, double *G, const double *before, double *R);

/* Fills the pending block up with random vectors orthogonal to the basis. */
void sl_krylov_random(sl_krylov *k);

/* Applies OP to w pending columns and appends w new ones. Needs room: applied + w <= max_basis. */
void sl_krylov_expand(sl_krylov *k);

/* The leading Ritz pairs: min(count, applied) of them. SL_INTERNAL when LAPACK fails. */
SL_NODISCARD sl_status sl_krylov_ritz(sl_krylov *k, int32_t count);

/* Makes the Ritz pairs index[0] < index[1] < ... the leading ones; the others are forgotten. */
void sl_krylov_select(sl_krylov *k, const int32_t *index, int32_t count);

/* X := the leading `count` Ritz vectors; the first `extended` of them plus P B s / theta, that is OP x / theta: an
 * inverse iteration for nothing. X: nullable; if NULL they take the place of the basis's first columns, which is then
 * spent. SL_OUT_OF_MEMORY. */
SL_NODISCARD sl_status sl_krylov_vectors(sl_krylov *k, int32_t count, int32_t extended, sl_panels *X);

/* Keeps the leading `kept` Ritz vectors and the pending block. SL_OUT_OF_MEMORY. */
SL_NODISCARD sl_status sl_krylov_restart(sl_krylov *k, int32_t kept);

#endif
