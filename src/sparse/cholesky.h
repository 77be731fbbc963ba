/* Sparse Cholesky P A P' = L L' of a symmetric positive definite matrix, and L S L' (S = +-1) of an indefinite one
 * without pivoting; supernodal.
 * Layer: sparse (may include base only). */
#ifndef SL_SPARSE_CHOLESKY_H
#define SL_SPARSE_CHOLESKY_H

#include "base/context.h"
#include "sparse/csc.h"
#include "sparse/order.h"

typedef struct sl_cholesky sl_cholesky; /* opaque: owns P, the symbolic analysis and L */

typedef enum sl_factor_kind {
    SL_FACTOR_LLT, /* positive definite matrices */
    SL_FACTOR_LDLT /* indefinite ones, without pivoting: L holds L |D|^(1/2), S the signs of D. The error is bounded by
                      what sl_inertia reports, not by the condition number alone */
} sl_factor_kind;

typedef struct sl_cholesky_def {
    sl_ordering ordering; /* default SL_ORDER_AUTO */
    int32_t block;        /* A is made of whole blocks of so many rows and columns (the unknowns of one vertex): what is
                             symbolic is done on their graph, which is that many times smaller, and the unknowns of a
                             block stay together; default 1 */
    const double *xyz;    /* n / block x 3, a point per block for geometric dissection; borrowed; default NULL */
    const int32_t *perm; /* length n / block, an ordering of the blocks to inherit; borrowed; default NULL = computed */
    double pivot_rtol;   /* reject pivot d_k <= pivot_rtol * max|a_ii| (|d_k| for LDL'); unitless; default 0 */
    sl_factor_kind kind; /* default SL_FACTOR_LLT */
    int32_t patch;       /* subtrees of at most so many columns are the bottom part, eliminated before all of the top;
                            default 0 = no bottom part */
    const sl_context *context; /* workers for the ordering; borrowed; default NULL */
} sl_cholesky_def;

sl_cholesky_def sl_cholesky_default(void);

/* Symbolic phase. A: n x n, lower triangle, sorted columns, n >= 0. On failure *out is NULL. SL_BAD_INPUT (not square,
 * unsorted, not lower, not made of whole blocks), SL_OUT_OF_MEMORY. */
SL_NODISCARD sl_status sl_cholesky_analyze(const sl_csc *A, const sl_cholesky_def *def, sl_cholesky **out);

/* Numeric phase; call again when values change but the pattern does not. SL_NOT_POSITIVE_DEFINITE (LL') or SL_SINGULAR
 * (LDL') sets *bad_column (nullable) to the column of A at fault; F may then be refactored or freed. SL_BAD_INPUT: a
 * value is not finite, or the pattern is another. SL_OUT_OF_MEMORY: L is allocated by the first call, workspace by
 * each, unless sl_cholesky_reserve did. */
SL_NODISCARD sl_status sl_cholesky_factor(sl_cholesky *F, const sl_csc *A, int32_t *bad_column);

/* Allocates L and the workspace now (sl_cholesky_factor_bytes in all), to stay until sl_cholesky_release: factoring
 * without workers then allocates nothing, for those who factor again and again. SL_OUT_OF_MEMORY; F is as good as
 * before then. */
SL_NODISCARD sl_status sl_cholesky_reserve(sl_cholesky *F);

/* The same of A - sigma I, which is not formed. context: workers for the elimination tree, nullable; the bytes of L do
 * not depend on how many. SL_CANCELLED: its progress function said so; F may be refactored or freed. */
SL_NODISCARD sl_status sl_cholesky_factor_shifted(sl_cholesky *F, const sl_csc *A, double sigma,
                                                  const sl_context *context, int32_t *bad_column);

/* Frees L, the signs and what is reserved; the analysis stays, for inertia counts and further factorisations. */
void sl_cholesky_release(sl_cholesky *F);

/* X: n x nrhs, column-major, leading dimension n; B on entry, inv(A) B on return. work: sl_cholesky_work_size(F, nrhs)
 * doubles, no meaning on return, one per thread: two threads may solve with one factor. Cannot fail, allocates nothing.
 */
void sl_cholesky_solve(const sl_cholesky *F, double *X, int32_t nrhs, double *work);
int64_t sl_cholesky_work_size(const sl_cholesky *F, int32_t nrhs);

/* Analyze, factor and solve A X = B once: X holds B on entry. */
SL_NODISCARD sl_status sl_cholesky_solve_once(const sl_csc *A, const sl_cholesky_def *def, double *X, int32_t nrhs);

/* Blocks of right-hand sides in the order of elimination, row by row: X[k * w + c] is row k of P X, side c. The columns
 * below sl_cholesky_top_first are the bottom part (the leaf patches of def.patch), the others the top:
 *
 *     P A P' = [L_bb     ] [S_b    ] [L_bb' L_tb']
 *              [L_tb L_tt] [    S_t] [      L_tt']        (S = I for LL')
 *
 *     forward   ALL     X := inv(L) X                                      X: n x w
 *               BOTTOM  X_b := inv(L_bb) X_b, X_t := X_t - L_tb X_b        X: n x w
 *               TOP     X_t := inv(L_tt) X_t                               X: the top rows alone, (n - top_first) x w
 *     backward  ALL     X := inv(L') S X                                   X: n x w
 *               BOTTOM  X_b := inv(L_bb') (S_b X_b - L_tb' X_t)            X: n x w, X_t is read
 *               TOP     X_t := inv(L_tt') S_t X_t                          X: the top rows alone
 *
 * forward BOTTOM leaves X_t - A_tb inv(A_bb) X_b above; backward BOTTOM extends given top rows to the bottom (with
 * X_b = 0, by -inv(A_bb) A_bt X_t). 1 <= w <= 32; 1 and multiples of 4 are fast, 16 is fastest. work:
 * sl_cholesky_block_work_size(F, w) doubles, one per caller. context: workers, nullable; the bytes do not depend on
 * them. Cannot fail, allocates nothing. */
typedef enum sl_part { SL_PART_ALL, SL_PART_BOTTOM, SL_PART_TOP } sl_part;

#define SL_CHOLESKY_MAX_BLOCK 32

void sl_cholesky_forward_part(const sl_cholesky *F, sl_part part, double *X, int32_t w, double *work,
                              const sl_context *context);
void sl_cholesky_backward_part(const sl_cholesky *F, sl_part part, double *X, int32_t w, double *work,
                               const sl_context *context);
int64_t sl_cholesky_block_work_size(const sl_cholesky *F, int32_t w);

/* First top column, 0 when there is no bottom part. */
int32_t sl_cholesky_top_first(const sl_cholesky *F);

/* Y (row by row in the order of elimination, n x w) = X (column-major, unknowns as in A, leading dimension n), and
 * back. No aliasing. */
void sl_cholesky_permute_in(const sl_cholesky *F, const double *X, int32_t w, double *Y);
void sl_cholesky_permute_out(const sl_cholesky *F, const double *Y, int32_t w, double *X);

/* What an LDL' factorisation of A - sigma I says about its eigenvalues. */
typedef struct sl_inertia_info {
    int32_t negative, zero, positive; /* pivots; zero: those replaced by a tiny positive number to go on */
    double max_a, max_l, max_d;       /* max |entry| of A - sigma I, of the unit lower L, of D */
    double growth;                    /* max_d / max_a */
    double backward_error;            /* bound on ||E||_2 in P (A - sigma I + E) P' = L D L' as computed: `negative` is
                                         the number of eigenvalues of A + E below sigma, so it is A's when no
                                         eigenvalue of A is this near to sigma */
} sl_inertia_info;

/* Counts the eigenvalues of A below sigma by Sylvester's law of inertia. F: an analysis of A's pattern, of either kind;
 * it is only read, no L is stored: memory for the stack of fronts alone. SL_BAD_INPUT, SL_OUT_OF_MEMORY, SL_CANCELLED.
 * Backward
 * error: Higham 2002, Theorem 10.3 for |L| |D| |L'|, with the length of each row of L for n. */
SL_NODISCARD sl_status sl_inertia(const sl_cholesky *F, const sl_csc *A, double sigma, const sl_context *context,
                                  sl_inertia_info *info);

/* Entries of L (supernode padding included), and the permutation in use (length n, borrowed). */
int64_t sl_cholesky_nnz(const sl_cholesky *F);
const int32_t *sl_cholesky_permutation(const sl_cholesky *F);

/* Bytes that a first sl_cholesky_factor of this analysis will allocate with one worker, and the part of them that L
 * keeps: an estimate before allocating. More workers take the rest once more each, and what the subtrees leave for the
 * crown of the tree until it is used. */
int64_t sl_cholesky_factor_bytes(const sl_cholesky *F, int64_t *kept);

void sl_cholesky_free(sl_cholesky *F); /* NULL is a no-op */

#endif
