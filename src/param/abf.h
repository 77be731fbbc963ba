/* Angle based flattening, ABF++: the angles of the flat triangles as a constrained minimum.
 *
 *     min sum w_c (alpha_c - phi_c)^2   subject to   g1(t) = 0, g2(s) = 0, g3(v) = 0      (paper, Eqs. 1-4)
 *
 * Layer: param. */
#ifndef SL_PARAM_ABF_H
#define SL_PARAM_ABF_H

#include "base/context.h"
#include "mesh/patch.h"
#include "sparse/csc.h"

/* Runs of corners with a prescribed sum of planar angles; see sl_abf_eval_g2. */
typedef struct sl_sectors {
    int32_t count;
    const int32_t *first;  /* count + 1 */
    const int32_t *corner; /* first[count] patch corners */
    const double *theta;   /* count, prescribed sums [rad] */
} sl_sectors;

typedef enum sl_abf_energy {
    SL_ABF_WEIGHTED,  /* w = 1 / phi^2, as ABF++ publishes it (default) */
    SL_ABF_UNWEIGHTED /* w = 1, the paper's Eq. 1 */
} sl_abf_energy;

typedef enum sl_abf_wheel {
    SL_ABF_LOG,     /* g3 = sum log sin - sum log sin (default) */
    SL_ABF_PRODUCT, /* g3 = prod sin - prod sin, as ABF++ publishes it */
    SL_ABF_RATIO    /* g3 = prod (sin / sin) - 1, the paper's Eq. 4 */
} sl_abf_wheel;

typedef enum sl_abf_newton {
    SL_ABF_DROPPED, /* the constraints' curvature is left out of the Hessian, as ABF++ does (default) */
    SL_ABF_EXACT    /* it is kept, but in triangles where the Hessian would not be positive definite: info.fallbacks */
} sl_abf_newton;

typedef struct sl_abf sl_abf; /* opaque: owns angles, multipliers, factor; borrows the patch */

/* Looks on while sl_abf_step works: called before the first step towards the present targets (info.iterations = 0) and
 * after every step. false cancels. */
typedef bool sl_abf_watch(void *user, const sl_abf *solver);

typedef struct sl_abf_def {
    sl_abf_energy energy;
    sl_abf_wheel wheel;
    sl_abf_newton newton;
    const sl_sectors *sectors;   /* borrowed; NULL (default) = one sector of 2 pi per interior vertex */
    int32_t max_iterations;      /* Newton steps; default 40 */
    double gradient_tolerance;   /* stop at |g| <= this, the max norm of the Lagrangian's gradient; default 1e-6 */
    double accept_gradient;      /* a result is accepted below this; default 1e-5 */
    double constraint_tolerance; /* and with max |g1|, |g2|, |g3| below this [rad, 1]; default 1e-11 */
    double accept_constraint;    /* a result at the rounding floor is accepted below this [rad, 1]; default 1e-9 */
    double min_angle;            /* measured angles are clamped up to this [rad]; default 0.1 degree */
    sl_abf_watch *watch;         /* nullable (default) */
    void *watch_user;
} sl_abf_def;

sl_abf_def sl_abf_default(void);

typedef struct sl_abf_info {
    int32_t iterations;
    bool converged;    /* gradient and constraints below their tolerances, every angle > 0 */
    bool stalled;      /* no step keeps the angles positive, or the system could not be factored */
    double energy;     /* Eq. 1 with its weights */
    double gradient;   /* |g| */
    double g1, g2, g3; /* max norms of the residuals */
    double min_angle;  /* [rad] */
    double step;       /* length of the last step taken, 1 = full Newton */
    int32_t fallbacks; /* SL_ABF_EXACT: triangles whose curvature was dropped in the last step */
    int32_t dependent; /* rows of g2 that follow from the others (regions wholly prescribed) and are left out of the
                          system; their residuals count in g2 all the same */
    bool floor;        /* stopped where rounding keeps the residuals from falling further */
} sl_abf_info;

/* How large the linear algebra is. J: rows g1, g2, g3 over the angles; M: the Schur complement, one triangle stored. */
typedef struct sl_abf_sizes {
    int32_t angles, triangles, sectors, wheels; /* columns of J; rows of g1, g2, g3 */
    int64_t jacobian_nonzeros, schur_nonzeros, factor_nonzeros;
    int32_t schur_rows;
} sl_abf_sizes;

/* SL_INFEASIBLE (a sector without corners, a region whose sectors contradict Gauss-Bonnet: sl_sectors_feasible says
 * which), SL_BAD_INPUT (sectors with a corner out of range, a theta not finite, first
 * not ascending), SL_OUT_OF_MEMORY. On failure *out is NULL. */
SL_NODISCARD sl_status sl_abf_create(const sl_patch *patch, const sl_abf_def *def, sl_abf **out);

/* Starts anew from given planar angles (3 nt [rad], one per patch corner; NULL = none): a triangle one of whose three
 * is not in (0, pi) - NaN says that none is known - starts from its optimal angles phi, as sl_abf_create starts all of
 * them. Multipliers are set to 0: with the curvature dropped a first full step finds theirs from the angles alone.
 * Returns how many triangles start as given. Allocates nothing, cannot fail. */
int32_t sl_abf_start_from(sl_abf *solver, const double *angle);

/* New prescribed sums theta (sectors->count, copied) for the same sectors: the warm start of a drag. Angles,
 * multipliers and the symbolic analysis stay; converged, stalled and the count of iterations begin anew. SL_BAD_INPUT
 * (not finite), SL_INFEASIBLE (a region's sum contradicts Gauss-Bonnet); the solver is then unchanged. */
SL_NODISCARD sl_status sl_abf_set_targets(sl_abf *solver, const double *theta);

/* Up to n Newton steps; stops early when converged or stalled. Allocates nothing. SL_CANCELLED. */
SL_NODISCARD sl_status sl_abf_step(sl_abf *solver, int32_t n, const sl_context *context);

const sl_abf_info *sl_abf_info_of(const sl_abf *solver); /* borrowed */
const double *sl_abf_angles(const sl_abf *solver);       /* 3 nt planar angles [rad], borrowed */
sl_abf_sizes sl_abf_sizes_of(const sl_abf *solver);

/* The Jacobian at the present angles: (nt + sectors + wheels) x 3 nt, rows g1, g2, g3; owned by the caller
 * (sl_csc_free). SL_OUT_OF_MEMORY. */
SL_NODISCARD sl_status sl_abf_jacobian(const sl_abf *solver, sl_csc **out);

/* The sums prescribed at present (sectors->count, borrowed): of the def, or of sl_abf_set_targets since. */
const double *sl_abf_prescribed(const sl_abf *solver);

/* The Schur complement of the last step, lower triangle, rows g2 then g3 (a dependent row is that of the identity);
 * borrowed, valid until the next step. */
const sl_csc *sl_abf_schur(const sl_abf *solver);

void sl_abf_free(sl_abf *solver); /* NULL is a no-op */

/* Optimal angles phi and weights w of a patch (3 nt each): beta measured, clamped, scaled around interior vertices. */
void sl_abf_targets(const sl_patch *patch, const sl_abf_def *def, double *phi, double *w);

/* Residuals; see abf_constraints.c for their formulas. g1: nt; g2: sectors->count; g3: one per interior vertex in
 * vertex order. */
void sl_abf_eval_g1(const sl_patch *patch, const double *alpha, double *g1);
void sl_abf_eval_g2(const sl_sectors *sectors, const double *alpha, double *g2);
void sl_abf_eval_g3(const sl_patch *patch, sl_abf_wheel wheel, const double *alpha, double *g3);

/* Positions from angles by least squares over all triangles (Levy et al. 2002 with the planar angles in place of the 3D
 * ones, as ABF++ does), scaled to the patch's 3D area. uv: nv x 2. SL_SINGULAR, SL_OUT_OF_MEMORY, SL_CANCELLED. */
SL_NODISCARD sl_status sl_abf_reconstruct(const sl_patch *patch, const double *alpha, const sl_context *context,
                                          double *uv);

/* create, step until converged, reconstruct. Not converging is no error: info says so and uv is then the reconstruction
 * of the last positive angles. info may be NULL. */
SL_NODISCARD sl_status sl_abf_flatten(const sl_patch *patch, const sl_abf_def *def, const sl_context *context,
                                      double *uv, sl_abf_info *info);

#endif
