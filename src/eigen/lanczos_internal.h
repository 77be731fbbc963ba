/* The state of the eigensolver and its stages; internal to the room.
 * Layer: eigen. */
#ifndef SL_EIGEN_LANCZOS_INTERNAL_H
#define SL_EIGEN_LANCZOS_INTERNAL_H

#include "eigen/krylov.h"
#include "eigen/lanczos.h"

/* What the next step does. */
typedef enum sl_stage {
    SL_STAGE_SKELETON, /* Krylov space of the separators, interiors recovered, first inverse iteration */
    SL_STAGE_KRYLOV,   /* one filling of the basis */
    SL_STAGE_ITERATE,  /* one block inverse iteration */
    SL_STAGE_CERTIFY,  /* count the eigenvalues below the last one found */
    SL_STAGE_DONE
} sl_stage;

/* All vectors are in the factor's order of elimination. X holds the computed pairs, guards behind the wanted ones. */
struct sl_lanczos {
    sl_lanczos_def def;
    int32_t n;
    int32_t count;      /* pairs delivered: null_count + wanted */
    int32_t null_count; /* clipped to count */
    int32_t wanted;     /* pairs to compute */
    int32_t needed;     /* pairs that must converge: wanted, and the rest of a cluster it ends in */
    int32_t columns;    /* of X: wanted and guards */
    int32_t block, max_basis;
    sl_precision precision; /* of the plain start's basis */
    double norm, sigma;
    const sl_csc *A;           /* borrowed */
    const sl_context *context; /* borrowed */
    sl_cholesky *factor;
    bool released; /* L has made room for a count; it is computed again when more pairs are needed */
    int32_t *perm; /* its permutation */
    sl_rows rows;  /* A in the factor's order; made when first needed */
    double *solve_work;
    double *N; /* null space, n x null_count, column-major */
    sl_panels X;
    bool have_pairs;
    double *lambda, *residual; /* columns: of X; residuals are not divided by ||A||_1 */
    sl_krylov krylov;          /* plain start only; empty otherwise */
    bool krylov_live, krylov_tried;
    double previous_worst; /* of the residuals over their bounds, one iteration ago; 0 = none */
    bool extended;         /* guards were let converge for a count once */
    bool widest;           /* no larger block fits the space: LAPACK takes over */
    sl_stage stage;
    double *dense_X, *dense_lambda, *dense_residual; /* dense only: n x count, unknowns as in A */
    sl_lanczos_info info;
};

/* sizes.c: block, basis, guards, start and patch. *dense: the basis would not fit the space. */
void sl_lanczos_choose_sizes(sl_lanczos *s, bool *dense);

/* Columns of the basis for s->block; false when it would not fit the space. */
bool sl_lanczos_choose_basis(sl_lanczos *s);

/* Bytes the solver will hold at its peak. factor: after its analysis. */
int64_t sl_lanczos_estimate(const sl_lanczos *s, bool dense);

/* skeleton.c: fills X. *usable = false when the condensed mass is not positive or the Krylov space does not converge:
 * X is then unchanged. */
SL_NODISCARD sl_status sl_lanczos_skeleton(sl_lanczos *s, bool *usable);

/* plain.c: one filling of the basis of the whole matrix; goes on to the next stage when enough pairs converge. */
SL_NODISCARD sl_status sl_lanczos_fill(sl_lanczos *s);

/* Starts (again) with a random block. */
SL_NODISCARD sl_status sl_lanczos_begin_plain(sl_lanczos *s);

/* iterate.c: X := OP X, Rayleigh-Ritz with A, residuals. Panels of X whose pairs all have converged are left alone. */
SL_NODISCARD sl_status sl_lanczos_iterate(sl_lanczos *s);

/* Rayleigh-Ritz of X with A and residuals; what any way of filling X ends with. */
SL_NODISCARD sl_status sl_lanczos_rayleigh_ritz(sl_lanczos *s);

/* Largest residual of the pairs needed, over what the mode allows it: at most 1 when all have converged. */
double sl_lanczos_worst(const sl_lanczos *s);

/* What the mode allows the residual of a pair. */
double sl_lanczos_bound(const sl_lanczos *s, double lambda);

/* W := inv(A - sigma I) W. What W has of the null space grows by 1 / |sigma|: it is to be taken out before, and what
 * rounding puts there after. */
void sl_lanczos_apply(sl_lanczos *s, double *W, int32_t w);

/* Takes the null space out of a panel. */
void sl_lanczos_deflate(sl_lanczos *s, double *W);

/* certify.c: decides the next stage: done, or more pairs, or a larger block. */
SL_NODISCARD sl_status sl_lanczos_certify(sl_lanczos *s);

/* dense.c: all pairs through LAPACKE, results and info filled. */
SL_NODISCARD sl_status sl_lanczos_solve_dense(sl_lanczos *s);

/* result.c: info's summary of the pairs at hand. */
void sl_lanczos_summarise(sl_lanczos *s);

/* Makes the entry of largest magnitude positive. */
void sl_lanczos_sign_rule(int32_t n, double *x);

#endif
