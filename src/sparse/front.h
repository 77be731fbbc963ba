/* Dense kernels of the multifrontal factorisation, and the walk over its fronts; internal to the room.
 * Layer: sparse. */
#ifndef SL_SPARSE_FRONT_H
#define SL_SPARSE_FRONT_H

#include "sparse/cholesky_internal.h"

/* panel (height x width, column-major, its top square given by the lower triangle) = columns of L. sign: NULL for LL',
 * else the signs of D are written there. A pivot d not above `least` (|d| with sign) stops LL' and LDL' alike: returns
 * its column. replacement > 0 stands in for such pivots instead. Returns -1 when all went well. */
int32_t sl_front_factor(double *panel, int32_t width, int32_t height, double least, double replacement, int8_t *sign);

/* own (below x below, lower triangle, column-major) -= L21 S L21'. sign: as above. */
void sl_front_update(const double *panel, int32_t width, int32_t below, const int8_t *sign, double *own);

/* Called with each finished panel, children before parents. */
typedef void sl_panel_fn(void *user, int32_t s, const double *panel, const int8_t *sign);

/* How a walk treats pivots and where its panels go. */
typedef struct sl_front_job {
    const sl_cholesky *F;
    const sl_csc *A;
    double sigma;
    double least, replacement; /* see sl_front_factor */
    double *L;                 /* where panels stay, NULL = they are thrown away */
    int8_t *sign;              /* n, NULL = LL' */
    sl_panel_fn *panel_done;   /* nullable */
    void *user;
    int32_t bad; /* result: column of P A P' whose pivot stopped the walk, or -1 */
} sl_front_job;

/* SL_OK also when a pivot stopped it; SL_OUT_OF_MEMORY. */
SL_NODISCARD sl_status sl_factor_fronts(sl_front_job *job);

/* max|a_ij| and max|a_ii| of A - sigma I; SL_BAD_INPUT when a value is not finite or A has another pattern than F. */
SL_NODISCARD sl_status sl_check_values(const sl_cholesky *F, const sl_csc *A, double sigma, double *largest,
                                       double *largest_diagonal);

#endif
