/* The solver object of ABF++; internal to the room.
 * Layer: param. */
#ifndef SL_PARAM_ABF_SOLVER_INTERNAL_H
#define SL_PARAM_ABF_SOLVER_INTERNAL_H

#include "param/abf_internal.h"
#include "param/regions_internal.h"
#include "sparse/cholesky.h"

enum { SL_ABF_HISTORY = 4 }; /* values of the merit function that a new one is compared with */

/* Energy and the 1-norms of g1, g2, g3. */
typedef struct sl_abf_merit {
    double energy, norm[3];
} sl_abf_merit;

struct sl_abf {
    const sl_patch *patch; /* borrowed */
    sl_abf_def def;
    sl_sector_table own_sectors; /* when the caller gave none */
    sl_sectors sectors;          /* first, corner: borrowed; theta: own */
    double *theta;               /* sectors.count */
    sl_regions regions;
    sl_abf_system system;
    sl_cholesky *factor;
    sl_abf_info info;
    double best_excess; /* the smallest max of residual / tolerance since the targets were set */
    sl_abf_merit history[SL_ABF_HISTORY];
    int32_t history_next;      /* how many were ever put in */
    int32_t steps_since_best;  /* and how long ago that was */
    double *phi, *w, *hessian; /* 3 nt; hessian = Lambda of the last step */
    double *alpha, *lambda1;   /* 3 nt, nt */
    double *lambda2;           /* nrows: of g2, then of g3 */
    double *gradient, *delta;  /* 3 nt */
    double *g1, *dlambda1;     /* nt */
    double *g, *rhs;           /* nrows: g2, then g3 */
    double *work;              /* of the Cholesky solve */
};

/* J, the gradient of L, the residuals and info at alpha and lambda. Allocates nothing. */
void sl_abf_evaluate(sl_abf *solver);

/* Says in info whether the present state is converged. */
void sl_abf_judge(sl_abf *solver);

/* One damped Newton step; where it cannot be taken the angles stay as they are and info.stalled says so.
 * Allocates nothing. */
SL_NODISCARD sl_status sl_abf_newton_step(sl_abf *solver);

#endif
