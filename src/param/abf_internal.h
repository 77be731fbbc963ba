/* Inner parts of ABF++, shared with its tests; internal to the room.
 * Layer: param. */
#ifndef SL_PARAM_ABF_INTERNAL_H
#define SL_PARAM_ABF_INTERNAL_H

#include "param/abf.h"
#include "param/sectors.h"
#include "sparse/csc.h"

/**
 * Corner angles of the 3D triangles, in [0, pi].
 *
 *     beta[c] = atan2(|a x b|, a . b),  a and b the edges that leave corner c
 *
 * Where an edge has no length its two corners are given pi/2 and the third 0; a triangle of one point gets pi/3 three
 * times: the sum is pi to rounding in every case.
 *
 * @param[out] beta angles [rad], length 3 nt
 *
 * No allocation, cannot fail. O(nt).
 */
void sl_corner_angles(const sl_patch *patch, double *beta);

/* Jacobian J2 of the constraints that couple triangles (g2 and g3), triangle by triangle, and the Schur complement
 *
 *     M = J2 P J2',   P = blockdiag over triangles of  D - D 1 1' D / (1' D 1),   D = inv(Lambda)
 *
 * which is what is left of J inv(Lambda) J' once the g1 block, a diagonal, is eliminated. Rows: all of g2, then all of
 * g3. Triangle t takes part in rows row[p], p = first[t] .. first[t + 1] - 1, with the coefficients coeff[3 p + k] at
 * its corners k; the pair of its rows (i, j), j <= i, adds to M->val[slot[slot_first[t] + i (i + 1) / 2 + j]]. */
typedef struct sl_abf_system {
    const sl_patch *patch;     /* borrowed */
    const sl_sectors *sectors; /* borrowed */
    int32_t nrows, nsectors;
    int32_t *wheel_row;   /* nv: row of a vertex's g3, -1 at the border */
    int64_t *first;       /* nt + 1 */
    int32_t *row;         /* first[nt] */
    double *coeff;        /* 3 first[nt] */
    int64_t *wheel_entry; /* 3 nt: p of the g3 row of a corner's vertex in its triangle, -1 at the border */
    int64_t *slot_first;  /* nt + 1 */
    int64_t *slot;        /* slot_first[nt] */
    double *wheel_scale;  /* 2 (nrows - nsectors): the products of sines on the two sides of g3 in product form, their
                             quotient twice in ratio form, else 1 */
    double *sine, *cot;   /* 3 nt: of the angles last linearised at */
    int32_t ndropped;
    int32_t *dropped; /* rows left out: they have no triangle, and in M the row of the identity */
    sl_csc *M;        /* nrows x nrows, lower triangle */
} sl_abf_system;

/* The pattern and the g2 coefficients; those of g3 are left 0. dropped: ndropped sectors, ascending, whose rows are
 * left out; copied. SL_INFEASIBLE (a sector without corners), SL_BAD_INPUT (a corner out of range, first not
 * ascending), SL_OUT_OF_MEMORY. On failure the system is cleared. */
SL_NODISCARD sl_status sl_abf_system_init(sl_abf_system *system, const sl_patch *patch, const sl_sectors *sectors,
                                          int32_t ndropped, const int32_t *dropped);
void sl_abf_system_clear(sl_abf_system *system);

/* The g3 coefficients at alpha: +cot at the next corner of each wheel triangle, -cot at the previous one, times the
 * wheel_scale of that side. Allocates nothing. */
void sl_abf_system_linearise(sl_abf_system *system, sl_abf_wheel wheel, const double *alpha);

/* sl_abf_eval_g3 at the angles last linearised at, without a sine to compute. */
void sl_abf_system_eval_g3(const sl_abf_system *system, sl_abf_wheel wheel, double *g3);

/* P of one triangle applied to c, without a division by an entry of Lambda, which may be 0 or negative as long as P is
 * positive semidefinite:
 *
 *     (P c)_0 = (Lambda_2 (c_0 - c_1) + Lambda_1 (c_0 - c_2)) / det,   det = Lambda_0 Lambda_1 + Lambda_1 Lambda_2 +
 *     Lambda_2 Lambda_0 */
static inline void sl_abf_project(const double Lambda[3], double inverse_det, const double c[3], double out[3])
{
    const double a = c[0] - c[1], b = c[1] - c[2], e = c[2] - c[0];
    out[0] = (Lambda[2] * a - Lambda[1] * e) * inverse_det;
    out[1] = (Lambda[0] * b - Lambda[2] * a) * inverse_det;
    out[2] = (Lambda[1] * e - Lambda[0] * b) * inverse_det;
}

static inline double sl_abf_inverse_det(const double Lambda[3])
{
    return 1.0 / (Lambda[0] * Lambda[1] + Lambda[1] * Lambda[2] + Lambda[2] * Lambda[0]);
}

/* M for Lambda, length 3 nt. Fixed summation order, allocates nothing. */
void sl_abf_system_assemble(sl_abf_system *system, const double *Lambda);

/* out += J2' y: out 3 nt, y nrows. */
void sl_abf_system_apply_transposed(const sl_abf_system *system, const double *y, double *out);

/* out -= J2 x: out nrows, x 3 nt. */
void sl_abf_system_subtract(const sl_abf_system *system, const double *x, double *out);

/* A point per row for the geometric ordering: xyz nrows x 3. */
void sl_abf_system_points(const sl_abf_system *system, double *xyz);

/* What the finite-difference tests look at: multipliers (nt of g1, then g2, then g3), gradient of the Lagrangian over
 * the angles (3 nt), targets and weights (3 nt), all borrowed. */
typedef struct sl_abf_view {
    const double *lambda1, *lambda2, *gradient, *phi, *w, *hessian;
    const sl_abf_system *system;
} sl_abf_view;
sl_abf_view sl_abf_view_of(const sl_abf *solver);

#endif
