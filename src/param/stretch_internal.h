/* The parts of the stretch minimiser: rest shapes, what is held, the Newton system, the step bound.
 * Layer: param; private to it and to its tests. */
#ifndef SL_PARAM_STRETCH_INTERNAL_H
#define SL_PARAM_STRETCH_INTERNAL_H

#include "param/stretch.h"
#include "param/stretch_kernels.h"
#include "sparse/cholesky.h"

/* 2 x 2 matrices are row-major: J = {J00, J01, J10, J11}, J[2 r + c] = d uv_r / d x_c.
 *
 *     psi(J) = (1 - w)(s1^2 + s2^2) + 2 w s1 s2 + s1^-2 + s2^-2 = (1 - w) I + 2 w d + I / d^2,  I = |J|_F^2, d = det J
 *
 * infinite where d <= 0. */

/* The rest shapes of a patch: what never changes while its map is refined. Zero-initialised = empty. */
typedef struct sl_stretch_rest {
    int32_t nt, strips;
    int32_t capacity;       /* strips allocated */
    sl_strip_rest *strip;   /* triangle t is lane t % SL_STRIP of strip t / SL_STRIP */
    double total;           /* area of the rest shapes */
    double measured_weight; /* sum of the weights counted */
    const sl_stretch_kernels *kernels;
} sl_stretch_rest;

/* Keeps what is allocated where that is enough. */
SL_NODISCARD sl_status sl_stretch_rest_init(const sl_patch *patch, sl_stretch_rest *rest);
void sl_stretch_rest_clear(sl_stretch_rest *rest);

/* x (two a vertex) at the corners of strip s; lanes beyond the last triangle repeat it. */
void sl_stretch_gather(const sl_stretch_rest *rest, const int32_t *tri, const double *x, int32_t s,
                       sl_strip_corners corners);

/* Sums over the triangles: the energy, and the chart's L2 at its best scale; infinite where d <= 0 somewhere. */
typedef struct sl_stretch_sums {
    double energy;
    double l2;
    bool sure; /* every area is positive in spite of rounding; otherwise exact predicates must say so */
} sl_stretch_sums;

sl_stretch_sums sl_stretch_measure(const sl_stretch_rest *rest, const int32_t *tri, double w, const double *uv);

/* What the vertices may still do: vertex v moves by y[unknown[2 v]] times the first column of its basis plus
 * y[unknown[2 v + 1]] times the second. An unknown may belong to many vertices: the offset of a line. */
typedef struct sl_stretch_freedom {
    int32_t nv, unknowns;
    int32_t block;    /* unknowns come in blocks of so many that no vertex divides: 2, or 1 where there are lines */
    int32_t *unknown; /* nv x 2, -1 = none; NULL: nothing is held, 2 v and 2 v + 1 */
    double *basis;    /* nv x 4: du/dy0, dv/dy0, du/dy1, dv/dy1; NULL: the unit vectors */
} sl_stretch_freedom;

/* SL_BAD_INPUT: a line with a vertex out of range, twice on it or not on it in the plane, or two lines that cross at
 * less than 1e-3. On failure *out is empty. */
SL_NODISCARD sl_status sl_stretch_freedom_init(const sl_patch *patch, const sl_stretch_def *def, const double *uv,
                                               sl_stretch_freedom *out);
void sl_stretch_freedom_clear(sl_stretch_freedom *freedom);

/* Does the definition hold anything in place? Then the map may not be scaled. */
bool sl_stretch_holds_places(const sl_patch *patch, const sl_stretch_def *def);

/* Springs from the pins to their places, energy PULL/2 times the squared distances over the area of the rest shapes.
 * sl_stretch_pull_is_valid: every pin in range, at a finite place, of a vertex free to move and of no other pin. */
bool sl_stretch_pull_is_valid(const sl_stretch_def *def, int32_t nv);
double sl_stretch_pull_energy(const sl_stretch_def *def, double area, const double *uv);
double sl_stretch_pull_distance(const sl_stretch_def *def, const double *uv); /* the largest */

/* The Newton system: its matrix over the unknowns, lower triangle, and where each triangle's entries go. */
typedef struct sl_stretch_system {
    sl_csc *H;
    sl_cholesky *factor;
    int32_t *place;  /* SL_ELEMENT nt: into H->val; colptr[ncols] = nowhere */
    double *reduced; /* unknowns */
    double *work;
} sl_stretch_system;

SL_NODISCARD sl_status sl_stretch_system_init(const sl_patch *patch, const sl_stretch_freedom *freedom,
                                              sl_stretch_system *system);
void sl_stretch_system_clear(sl_stretch_system *system);

/* What a solver works with, its own or a workspace's. Zero-initialised = empty. */
typedef struct sl_stretch_store {
    double *block; /* capacity doubles */
    int64_t capacity;
    sl_stretch_rest rest;
    sl_stretch_system system;
    /* What the system was made for: triangles, points and freedom, copies; kept in a workspace's store only. */
    int32_t nt;
    int32_t *tri;
    double *xyz;
    sl_stretch_freedom freedom;
    bool lent, shared; /* to a solver just now; a workspace's */
} sl_stretch_store;

/* The workspace's store, or `own` where there is none or it is lent already; and back. */
sl_stretch_store *sl_stretch_store_borrow(sl_stretch_workspace *workspace, sl_stretch_store *own);
void sl_stretch_store_return(sl_stretch_workspace *workspace, sl_stretch_store *store);

/* Makes store->system that of the patch, unless it is already. */
SL_NODISCARD sl_status sl_stretch_store_system(sl_stretch_store *store, const sl_patch *patch,
                                               const sl_stretch_freedom *freedom);

/* Where entry (i, j) of a triangle's 6 x 6 Hessian stands among its SL_ELEMENT; i, j = 2 corner + (0 for u, 1 for v).
 */
static inline int sl_stretch_entry(int i, int j)
{
    static const int place[6][6] = {
        {0, 1, 9, 10, 17, 19},  {1, 2, 11, 12, 18, 20}, {9, 11, 3, 4, 13, 14},
        {10, 12, 4, 5, 15, 16}, {17, 18, 13, 15, 6, 7}, {19, 20, 14, 16, 7, 8},
    };
    return place[i][j];
}

/* Replaces the rest shape of a triangle by one nearer to its image, if a logarithm of a singular value of J exceeds
 * cap: J and the gradients g of its hat functions become those of the new shape. d > 0. False when nothing was done.
 * Source: Liu, Ye, Ni, Fu 2018, "Progressive parameterizations", Sec. 3. */
bool sl_stretch_soften(double cap, double J[4], double g[4]);

/* Fills H with the projected Hessian (negative eigenvalues dropped), gradient (2 nv) with the energy's gradient, and
 * force (2 nv) with minus the right side of the system. These two are the same unless cap is finite: then H and force
 * are those of the softened rest shapes. */
void sl_stretch_assemble(const sl_patch *patch, const sl_stretch_rest *rest, const sl_stretch_freedom *freedom,
                         double w, double cap, const double *uv, sl_stretch_system *system, double *gradient,
                         double *force);

/* Adds the springs' part. */
void sl_stretch_pull_assemble(const sl_stretch_def *def, double area, const sl_stretch_freedom *freedom,
                              const double *uv, sl_stretch_system *system, double *gradient, double *force);

/* direction (2 nv) = -inv(H + shift diag(H)) force over the unknowns, with the least shift of a short list that can be
 * factored. SL_NOT_POSITIVE_DEFINITE when none can. */
SL_NODISCARD sl_status sl_stretch_direction(const sl_stretch_freedom *freedom, sl_stretch_system *system,
                                            const double *force, double *direction);

/* The largest step along direction before some triangle's area vanishes; infinite when none ever does.
 * Source: Smith and Schaefer 2015, "Bijective parameterization with free boundaries", Sec. 3.3. */
double sl_stretch_step_bound(const sl_stretch_rest *rest, const int32_t *tri, const double *uv,
                             const double *direction);

bool sl_stretch_all_finite(int64_t count, const double *x);

#endif
