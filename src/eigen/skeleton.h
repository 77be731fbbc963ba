/* What the search on the separators and the recovery of the patches share; internal to the room.
 * Layer: eigen. */
#ifndef SL_EIGEN_SKELETON_H
#define SL_EIGEN_SKELETON_H

#include "eigen/lanczos_internal.h"

/* Condensing the patches turns A x = lambda x into S(lambda) x_t = 0 with
 *
 *     S(lambda) = S - lambda (I + T'T) - lambda^2 T' inv(A_bb) T - ...        T = -inv(A_bb) A_bt
 *
 * and the Schur complement S. Both masses are lumped to their row sums D and E. */
typedef struct sl_skeleton {
    sl_lanczos *s;
    int32_t first, rows; /* of the top part */
    double *root;        /* D^(1/2) */
    double *second;      /* E */
    double *column;      /* n */
    double *response;    /* n x 8 */
    sl_krylov krylov;    /* of D^(1/2) inv(S) D^(1/2) */
    int32_t modes;       /* Ritz pairs kept: those of X, then some beyond */
    double *theta;       /* their values: inverse eigenvalues */
    sl_panels U;         /* D^(-1/2) times their vectors */
    double *partial, *H; /* of projections on the pairs beyond those of X */
} sl_skeleton;

/* Pairs beyond those of X that corrections know of; measured: 24 do half as well, 96 no better. */
enum { SL_MODES_BEYOND = 48 };

/* recover.c: takes the Ritz pairs over from the Krylov space, which is spent. SL_OUT_OF_MEMORY. */
SL_NODISCARD sl_status sl_skeleton_take_modes(sl_skeleton *k);

/* Panel p of X := the Ritz vectors with their patches. */
void sl_skeleton_recover(sl_skeleton *k, int32_t p);

#endif
