/* Flip-free minimisation of a stretch energy, starting from any flip-free map; with vertices and lines held where
 * asked.
 *
 *     E = sum over triangles A_t ((1 - w)(s1^2 + s2^2) + 2 w s1 s2 + s1^-2 + s2^-2)
 *
 * w = 0: symmetric Dirichlet; w = 1: Sander's L2 plus area, exactly what the bound on stretch measures.
 * Layer: param. */
#ifndef SL_PARAM_STRETCH_H
#define SL_PARAM_STRETCH_H

#include "base/context.h"
#include "mesh/patch.h"
#include "param/constraints.h"

/* Vertices kept on a straight line. Lines may cross and end on each other, and share vertices with the fixed ones: a
 * line with a fixed vertex is fixed. A vertex on three or more lines stays where it is, and so do they. */
typedef struct sl_stretch_line {
    int32_t count;         /* at least 2 */
    const int32_t *vertex; /* straight in the start to 1e-6 of its length; borrowed */
    bool fixed; /* false: the line moves along its normal as the energy wants; its direction never changes, so that the
                   angles between lines are kept, too */
} sl_stretch_line;

/* Buffers and a symbolic analysis to be used again by one solver after another; not by two at a time, nor by two
 * threads. Opaque. */
typedef struct sl_stretch_workspace sl_stretch_workspace;

typedef struct sl_stretch_def {
    double w;                 /* energy weight, at most 1; below 0 it buys angles for stretch; default 0 */
    int32_t max_iterations;   /* projected Newton steps; default 60 */
    double relative_decrease; /* stop when a step lowers the energy by less than this share; default 1e-4 */
    double target_l2;         /* stop as soon as the L2 stretch is at most this; 0 = never; default 0 */
    double hopeless_l2;     /* give up after `hopeless_after` steps when L2 is still above this; 0 = never; default 0 */
    int32_t hopeless_after; /* default 15 */
    double hopeless_gain; /* give up once target_l2 is out of reach even if L2 falls by this many times the share of the
                           * energy that the last plain step gained; 0 = never; default 0 */
    double most_l2; /* give up once a step leaves L2 above this, which weights below 0 do that buy angles for it; 0 =
                     * never; default 0 */
    bool simple_border;   /* refuse steps that make the border cross itself; needs a simple start; default false */
    const uint8_t *fixed; /* nv: 1 = the vertex stays where it starts; borrowed until create returns; default NULL =
                           * none. With fixed vertices or lines the map is not scaled first */
    int32_t line_count;   /* default 0 */
    const sl_stretch_line *line; /* line_count; borrowed until create returns */
    /* Vertices, neither fixed nor on lines, that are drawn to places of their own and, once there, exactly there; the
     * energy may rise on their way. Borrowed while the solver lives; default none. */
    int32_t pin_count;
    const sl_pin *pin;
    const double *guess; /* sl_stretch_unfold alone: nv x 2, about where the vertices will come to lie: what flips there
                          * is mended, and where that can be (and with simple_border no edges cross) it is minimised
                          * from there, without coarse meshes; borrowed; default NULL */
    sl_stretch_workspace *workspace; /* borrowed while the solver lives; default NULL = everything anew */
} sl_stretch_def;

sl_stretch_def sl_stretch_default(void);

typedef struct sl_stretch_info {
    int32_t iterations;
    double energy_before, energy_after; /* divided by the total area: 4 = isometric for w = 0 */
    double l2;                          /* of the result, the chart's best scale */
    double pin_distance;                /* of the pin furthest from its place [uv units]; 0 = all are there */
    bool converged;                     /* stopped by relative_decrease or target_l2, not by the iteration bound */
    bool hopeless;
    int32_t levels; /* sl_stretch_unfold: coarser meshes that were mapped first */
} sl_stretch_info;

typedef struct sl_stretch sl_stretch; /* opaque: owns the system and its factor; borrows the patch */

/* uv: nv x 2, copied; must have no flipped or zero-area triangle and, with simple_border, a simple border: SL_BAD_INPUT
 * otherwise, and for lines and pins that cannot be kept; SL_OUT_OF_MEMORY. Triangles degenerate in 3D (as distortion.h
 * says) get a raised height as their rest shape and do not count for L2. O(nt): a fifth of a step on 500 triangles. A
 * patch whose rim is fixed is solved like any other; only its free vertices are unknowns. */
SL_NODISCARD sl_status sl_stretch_create(const sl_patch *patch, const double *uv, const sl_stretch_def *def,
                                         sl_stretch **out);

/* An empty workspace. A solver that is freed leaves its buffers and the analysis of its system here; the next one that
 * names it allocates only what is larger, and analyses nothing when its triangles, their points in space and the
 * vertices held are the same (compared, not trusted). The results do not depend on it. The analysis costs as much
 * as two steps on 500 triangles, one on 5000; it is made by the first step. SL_OUT_OF_MEMORY. */
SL_NODISCARD sl_status sl_stretch_workspace_create(sl_stretch_workspace **out);
void sl_stretch_workspace_free(sl_stretch_workspace *workspace); /* after its solvers; NULL is a no-op */

/* Up to n Newton steps: per-triangle Hessians projected by their analytic eigenvalues, Cholesky, step at most 0.9 of
 * the first flip (Smith and Schaefer 2015), Armijo; longer than a full step where that pays. While the map is far from
 * its minimum (energy above 100 a unit of area) the direction is taken from rest shapes softened towards their images
 * (Liu et al. 2018). Without pins the energy never rises; no triangle ever flips. SL_CANCELLED, SL_OUT_OF_MEMORY (the
 * first step allocates the system, the test of a simple border its grid; nothing else does). */
SL_NODISCARD sl_status sl_stretch_step(sl_stretch *solver, int32_t n, const sl_context *context);

const sl_stretch_info *sl_stretch_info_of(const sl_stretch *solver);
const double *sl_stretch_uv(const sl_stretch *solver); /* nv x 2, borrowed */

/* What the measures of stretch add up from: over the triangles that are not degenerate in 3D, in the input's units,
 *
 *     area = sum A_t, uv = sum a_t, inverse = sum A_t (s1^-2 + s2^-2)/2, angle = sum A_t s1/s2
 *
 * with A_t, a_t the areas in space and in the plane and s1 >= s2 the singular values of the map from space to the
 * plane. L2 = sqrt(inverse uv) / area at the best scale of what was summed; sqrt(inverse uv) - area is its share of a
 * sum over charts. Sums of parts add. inverse and angle are infinite where a triangle is not positive. */
typedef struct sl_stretch_terms {
    double area, uv, inverse, angle;
} sl_stretch_terms;

/* The sum over all triangles under uv (nv x 2), of triangle t in term[t] (nullable, nt). Allocates nothing. O(nt). */
sl_stretch_terms sl_stretch_terms_of(const sl_patch *patch, const double *uv, sl_stretch_terms *term);

void sl_stretch_free(sl_stretch *solver); /* NULL is a no-op */

/* create, step to the end; uv in and out. info may be NULL. */
SL_NODISCARD sl_status sl_stretch_minimise(const sl_patch *patch, const sl_stretch_def *def, const sl_context *context,
                                           double *uv, sl_stretch_info *info);

/* The same without a start: a coarse mesh of the chart (a disk) is embedded by Tutte's method and minimised, then the
 * other vertices are put back a level at a time, each where its triangles stretch least, and every level is minimised.
 * Charts of fewer than 100 triangles, and those where a level fails, start from Tutte's embedding of the whole. With a
 * target_l2 and a hopeless_gain a chart is hopeless, too, when its last coarse level is far from the target. uv: out.
 * There being no start, def->fixed and def->line are not looked at; pins are served on the chart itself. SL_INFEASIBLE
 * (no disk), SL_BAD_INPUT (doubles have no embedding without flips), SL_SINGULAR, SL_CANCELLED,
 * SL_OUT_OF_MEMORY: uv and info (nullable) are unchanged then. Deterministic.
 * Source: Hormann, Greiner, Campagna 1999, "Hierarchical parametrization of triangulated surfaces". */
SL_NODISCARD sl_status sl_stretch_unfold(const sl_patch *patch, const sl_stretch_def *def, const sl_context *context,
                                         double *uv, sl_stretch_info *info);

#endif
