/* Flip-free minimisation of a stretch energy, starting from any flip-free map.
 *
 *     E = sum over triangles A_t ((1 - w)(s1^2 + s2^2) + 2 w s1 s2 + s1^-2 + s2^-2)
 *
 * w = 0: symmetric Dirichlet; w = 1: Sander's L2 plus area, exactly what the bound on stretch measures.
 * Layer: param. */
#ifndef SL_PARAM_STRETCH_H
#define SL_PARAM_STRETCH_H

#include "base/context.h"
#include "mesh/patch.h"

typedef struct sl_stretch_def {
    double w;                 /* energy weight, at most 1; below 0 it buys angles for stretch; default 0 */
    int32_t max_iterations;   /* projected Newton steps; default 60 */
    double relative_decrease; /* stop when a step lowers the energy by less than this share; default 1e-4 */
    double target_l2;         /* stop as soon as the L2 stretch is at most this; 0 = never; default 0 */
    double hopeless_l2;     /* give up after `hopeless_after` steps when L2 is still above this; 0 = never; default 0 */
    int32_t hopeless_after; /* default 15 */
    double hopeless_gain; /* give up once target_l2 is out of reach even if L2 falls by this many times the share of the
                           * energy that the last plain step gained; 0 = never; default 0 */
    bool simple_border;   /* refuse steps that make the border cross itself; needs a simple start; default false */
} sl_stretch_def;

sl_stretch_def sl_stretch_default(void);

typedef struct sl_stretch_info {
    int32_t iterations;
    double energy_before, energy_after; /* divided by the total area: 4 = isometric for w = 0 */
    double l2;                          /* of the result, the chart's best scale */
    bool converged;                     /* stopped by relative_decrease or target_l2, not by the iteration bound */
    bool hopeless;
    int32_t levels; /* sl_stretch_unfold: coarser meshes that were mapped first */
} sl_stretch_info;

typedef struct sl_stretch sl_stretch; /* opaque: owns the system and its factor; borrows the patch */

/* uv: nv x 2, copied; must have no flipped or zero-area triangle and, with simple_border, a simple border: SL_BAD_INPUT
 * otherwise; SL_OUT_OF_MEMORY. Triangles degenerate in 3D (as distortion.h says) get a raised height as their rest
 * shape and do not count for L2. */
SL_NODISCARD sl_status sl_stretch_create(const sl_patch *patch, const double *uv, const sl_stretch_def *def,
                                         sl_stretch **out);

/* Up to n Newton steps: per-triangle Hessians projected by their analytic eigenvalues, Cholesky, step at most 0.9 of
 * the first flip (Smith and Schaefer 2015), Armijo; longer than a full step where that pays. While the map is far from
 * its minimum (energy above 100 a unit of area) the direction is taken from rest shapes softened towards their images
 * (Liu et al. 2018). The energy never rises and no triangle ever flips. SL_CANCELLED, SL_OUT_OF_MEMORY (the
 * first step allocates the system, the test of a simple border its grid; nothing else does). */
SL_NODISCARD sl_status sl_stretch_step(sl_stretch *solver, int32_t n, const sl_context *context);

const sl_stretch_info *sl_stretch_info_of(const sl_stretch *solver);
const double *sl_stretch_uv(const sl_stretch *solver); /* nv x 2, borrowed */
void sl_stretch_free(sl_stretch *solver);              /* NULL is a no-op */

/* create, step to the end; uv in and out. info may be NULL. */
SL_NODISCARD sl_status sl_stretch_minimise(const sl_patch *patch, const sl_stretch_def *def, const sl_context *context,
                                           double *uv, sl_stretch_info *info);

/* The same without a start: a coarse mesh of the chart (a disk) is embedded by Tutte's method and minimised, then the
 * other vertices are put back a level at a time, each where its triangles stretch least, and every level is minimised.
 * Charts of fewer than 200 triangles, and those where a level fails, start from Tutte's embedding of the whole. With a
 * target_l2 and a hopeless_gain a chart is hopeless, too, when its last coarse level is far from the target. uv: out.
 * SL_INFEASIBLE (no disk), SL_BAD_INPUT (doubles have no embedding without flips), SL_SINGULAR, SL_CANCELLED,
 * SL_OUT_OF_MEMORY: uv and info (nullable) are unchanged then. Deterministic.
 * Source: Hormann, Greiner, Campagna 1999, "Hierarchical parametrization of triangulated surfaces". */
SL_NODISCARD sl_status sl_stretch_unfold(const sl_patch *patch, const sl_stretch_def *def, const sl_context *context,
                                         double *uv, sl_stretch_info *info);

#endif
