/* The walk over the fronts of the multifrontal factorisation; internal to the room.
 * Layer: sparse. */
#ifndef SL_SPARSE_FRONT_H
#define SL_SPARSE_FRONT_H

#include "sparse/cholesky_internal.h"

/* Called with each finished panel, children before parents, supernodes of different tasks at the same time. */
typedef void sl_panel_fn(void *user, int32_t s, const double *panel, const int8_t *sign);

/* How a walk treats pivots and where its panels go. */
typedef struct sl_front_job {
    const sl_cholesky *F;
    const sl_csc *A;
    double sigma;
    sl_pivoting pivoting;
    const char *stage;       /* for progress */
    double *L;               /* where panels stay, NULL = they are thrown away */
    int8_t *sign;            /* n, NULL = LL' */
    sl_panel_fn *panel_done; /* nullable */
    void *user;
    const sl_front_space *space; /* room for max_update doubles to walk with; NULL = it is allocated */
    int32_t bad;                 /* result: column of P A P' whose pivot stopped the walk, or -1 */
} sl_front_job;

/* SL_OK also when a pivot stopped it; SL_OUT_OF_MEMORY, SL_CANCELLED. */
SL_NODISCARD sl_status sl_factor_fronts(sl_front_job *job, const sl_context *context);

/* Room for walks whose stacks take so many doubles. SL_OUT_OF_MEMORY: the space is cleared. */
SL_NODISCARD sl_status sl_front_space_init(const sl_cholesky *F, int64_t room, sl_front_space *space);
void sl_front_space_clear(sl_front_space *space);

/* max|a_ij| (nullable) and max|a_ii| of A - sigma I; SL_BAD_INPUT when a value is not finite or A has another pattern
 * than F. */
SL_NODISCARD sl_status sl_check_values(const sl_cholesky *F, const sl_csc *A, double sigma, double *largest,
                                       double *largest_diagonal);

#endif
