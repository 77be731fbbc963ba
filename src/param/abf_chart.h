/* A flat chart that a user holds in hand: ABF++ and reconstruction kept warm, the last valid state never lost.
 * Layer: param. */
#ifndef SL_PARAM_ABF_CHART_H
#define SL_PARAM_ABF_CHART_H

#include "param/abf.h"
#include "param/reconstruct.h"

/* A state is valid when every angle is positive and no triangle of its layout is flipped. */
typedef struct sl_abf_chart_info {
    sl_abf_info abf;           /* of the last solve */
    sl_layout_quality quality; /* of the layout held */
    bool valid;                /* the layout held is valid; false only if none was ever found */
    bool converged;            /* and its angles are converged on the targets reached */
    bool rolled_back;          /* the last move or release led to no valid state: the one before it is held */
    double reached;            /* of the way from the state before the last release to its targets, in [0, 1] */
    double distance;           /* largest |sector sum held - target| [rad]: what is left where reached < 1 */
    int32_t solves;            /* of the last release: 1 unless it was approached by homotopy */
    int32_t iterations;        /* Newton steps in all of them */
    int32_t taken_over;        /* triangles that sl_abf_chart_create_from started from the angles given; 0 too where
                                  no solution was found from these and the measured angles were used after all */
} sl_abf_chart_info;

typedef struct sl_abf_chart sl_abf_chart; /* opaque; borrows the patch and def->sectors' corners */

/* Solves for the targets of def->sectors as sl_abf_chart_release does, with at least 150 Newton steps for
 * def->max_iterations as long as they make progress; def->watch sees all of them but those of the chart without
 * constraints. Where that fails from the measured angles the chart is first flattened without constraints, which gives
 * a valid state to start from. SL_SINGULAR, SL_INFEASIBLE, SL_BAD_INPUT (as sl_abf_create and sl_reconstruct_create),
 * SL_OUT_OF_MEMORY, SL_CANCELLED. On failure *out is NULL. */
SL_NODISCARD sl_status sl_abf_chart_create(const sl_patch *patch, const sl_abf_def *def, const sl_context *context,
                                           sl_abf_chart **out);

/* The same from angles known already, those of a chart that was cut, sewn or grown a little: `angle` (3 nt [rad], one
 * per patch corner; borrowed for the call) as sl_abf_start_from takes it, NaN where none is known; NULL = none at all.
 * Where that leads to no valid converged state the angles given are forgotten: what follows, and the statuses, are
 * those of sl_abf_chart_create. sl_abf_carry_angles finds `angle` from another patch. It saves a step or none on an
 * easy chart, for the gradient falls linearly from wherever it starts (SL_ABF_EXACT takes 3 to 5 steps instead of 4 to
 * 12), tens of steps where lines are forced onto a steep one, and the homotopy where targets are hard. */
SL_NODISCARD sl_status sl_abf_chart_create_from(const sl_patch *patch, const sl_abf_def *def, const double *angle,
                                                const sl_context *context, sl_abf_chart **out);

/* Carries angles over between patches of one triangulated mesh: to_angle (3 to->nt) is written at the corners of every
 * triangle of `to` that `from` has, too (the same facet and corners, in the same order), and left as it is elsewhere.
 * Fill it with NaN first; a chart sewn from two takes two calls. *taken (nullable) = triangles written. No aliasing.
 * SL_OUT_OF_MEMORY. O(n log n). */
SL_NODISCARD sl_status sl_abf_carry_angles(const sl_patch *from, const double *from_angle, const sl_patch *to,
                                           double *to_angle, int32_t *taken);

/* The mouse moves: new targets theta (one per sector), two Newton steps, reconstruction (paper, Sec. 4.2). Where that
 * leads to no valid state everything is rolled back. SL_BAD_INPUT, SL_INFEASIBLE (theta; nothing changes),
 * SL_CANCELLED (the chart then holds what it held). Allocates nothing. */
SL_NODISCARD sl_status sl_abf_chart_move(sl_abf_chart *chart, const double *theta, const sl_context *context);

/* The button is released: the full criterion. Targets that are not reached in one go are approached step by step from
 * the state held (theta between its sums and the targets), as far as states stay valid: info.reached, info.distance.
 * Statuses as of sl_abf_chart_move; allocates nothing. */
SL_NODISCARD sl_status sl_abf_chart_release(sl_abf_chart *chart, const double *theta, const sl_context *context);

const sl_abf_chart_info *sl_abf_chart_info_of(const sl_abf_chart *chart); /* borrowed */
const double *sl_abf_chart_uv(const sl_abf_chart *chart);                 /* nv x 2: the layout held, borrowed */
const double *sl_abf_chart_angles(const sl_abf_chart *chart);             /* 3 nt: the angles held, borrowed */

/* The solver, at the state held and its targets (after a move that was rolled back, too); borrowed. */
const sl_abf *sl_abf_chart_solver(const sl_abf_chart *chart);

void sl_abf_chart_free(sl_abf_chart *chart); /* NULL is a no-op */

#endif
