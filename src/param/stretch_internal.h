/* The parts of the stretch minimiser: the energy of one triangle, the Newton system, the step bound.
 * Layer: param; private to it and to its tests. */
#ifndef SL_PARAM_STRETCH_INTERNAL_H
#define SL_PARAM_STRETCH_INTERNAL_H

#include "param/stretch.h"
#include "sparse/cholesky.h"

/* 2 x 2 matrices are row-major: J = {J00, J01, J10, J11}, J[2 r + c] = d uv_r / d x_c. */

/* psi(J) = (1 - w)(s1^2 + s2^2) + 2 w s1 s2 + s1^-2 + s2^-2 = (1 - w) I + 2 w d + I / d^2 with I = |J|_F^2, d = det J;
 * infinite where d <= 0. */
double sl_stretch_density(double w, const double J[4]);

/* d psi / d J. d > 0. */
void sl_stretch_density_gradient(double w, const double J[4], double P[4]);

/* The four eigenpairs of the 4 x 4 Hessian of psi: lambda[m] and the unit matrix Q[4 m .. 4 m + 3], unclamped. d > 0.
 * m = 0 twist, 1 flip, 2 and 3 scaling. Source: Smith, de Goes, Kim 2019, "Analytic eigensystems for isotropic
 * distortion energies", Sec. 4, in two dimensions. */
void sl_stretch_density_modes(double w, const double J[4], double lambda[4], double Q[16]);

/* The rest shapes of a patch: what never changes while its map is refined. */
typedef struct sl_stretch_rest {
    int32_t nt;
    double *
        gradient; /* nt x 4: x and y of the hat functions' gradients at corners 1 and 2; corner 0 has minus their sum */
    double *weight;         /* nt: area / total area */
    uint8_t *measured;      /* nt: 0 where the 3D triangle is degenerate and got a shape of its own */
    double measured_weight; /* sum of the weights measured */
} sl_stretch_rest;

SL_NODISCARD sl_status sl_stretch_rest_init(const sl_patch *patch, sl_stretch_rest *rest);
void sl_stretch_rest_clear(sl_stretch_rest *rest);

/* J of triangle t under the map uv. */
void sl_stretch_jacobian(const sl_stretch_rest *rest, const int32_t *tri, const double *uv, int32_t t, double J[4]);

/* Sums over the triangles: the energy, and the chart's L2 at its best scale. */
typedef struct sl_stretch_sums {
    double energy;
    double l2;
} sl_stretch_sums;

sl_stretch_sums sl_stretch_measure(const sl_stretch_rest *rest, const int32_t *tri, double w, const double *uv);

/* The Newton system: unknowns 2 v and 2 v + 1, lower triangle, and where each triangle's blocks go. */
typedef struct sl_stretch_system {
    sl_csc *H;
    sl_cholesky *factor;
    int64_t *slot; /* 3 nt: the off-diagonal block of edge (k, k + 1) of a triangle: its place in column 2 min(v, w) */
    double *work;
} sl_stretch_system;

SL_NODISCARD sl_status sl_stretch_system_init(const sl_patch *patch, sl_stretch_system *system);
void sl_stretch_system_clear(sl_stretch_system *system);

/* Replaces the rest shape of a triangle by one nearer to its image, if a logarithm of a singular value of J exceeds
 * cap: J and the gradients g of its hat functions become those of the new shape. d > 0. False when nothing was done.
 * Source: Liu, Ye, Ni, Fu 2018, "Progressive parameterizations", Sec. 3. */
bool sl_stretch_soften(double cap, double J[4], double g[4]);

/* Fills H with the projected Hessian (negative eigenvalues dropped), gradient (2 nv) with the energy's gradient, and
 * force (2 nv) with minus the right side of the system. These two are the same unless cap is finite: then H and force
 * are those of the softened rest shapes. */
void sl_stretch_assemble(const sl_patch *patch, const sl_stretch_rest *rest, double w, double cap, const double *uv,
                         sl_stretch_system *system, double *gradient, double *force);

/* direction = -inv(H + shift diag(H)) force with the least shift of a short list that can be factored.
 * SL_NOT_POSITIVE_DEFINITE when none can. */
SL_NODISCARD sl_status sl_stretch_direction(sl_stretch_system *system, const double *force, double *direction);

/* The largest step along direction before some triangle's area vanishes; infinite when none ever does.
 * Source: Smith and Schaefer 2015, "Bijective parameterization with free boundaries", Sec. 3.3. */
double sl_stretch_step_bound(const sl_patch *patch, const double *uv, const double *direction);

/* The border of all loops as *nb vertex pairs, as sl_certify_embedding takes it; *border is owned by the caller. */
SL_NODISCARD sl_status sl_stretch_list_border(const sl_patch *patch, int32_t *nb, int32_t **border);

bool sl_stretch_all_finite(int64_t count, const double *x);

#endif
