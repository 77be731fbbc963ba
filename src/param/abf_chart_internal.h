/* The chart a user holds in hand; internal to the room.
 * Layer: param. */
#ifndef SL_PARAM_ABF_CHART_INTERNAL_H
#define SL_PARAM_ABF_CHART_INTERNAL_H

#include "param/abf_chart.h"
#include "param/abf_solver_internal.h"

/* What a solver is at: alpha, lambda1, lambda2, theta, one after the other. */
struct sl_abf_chart {
    const sl_patch *patch; /* borrowed */
    sl_abf *solver;
    sl_reconstruct *layout;
    double *state;         /* of the layout held */
    double *uv, *trial_uv; /* 2 nv: held, and under trial */
    double *from, *to;     /* sectors: the ends of a homotopy */
    double *theta;         /* sectors: a point between them */
    sl_layout_quality trial;
    sl_abf_chart_info info;
};

/* Newton steps until converged, stalled, or without hope. */
SL_NODISCARD sl_status sl_abf_solve_patiently(sl_abf *solver, const sl_context *context);

/* Sums of the angles held over the sectors. */
void sl_abf_chart_sums(const sl_abf_chart *chart, double *sum);

/* Lays the solver's angles out in trial_uv; *valid = no triangle is flipped. */
SL_NODISCARD sl_status sl_abf_chart_lay_out(sl_abf_chart *chart, const sl_context *context, bool *valid);

/* The solver's state and trial_uv become what is held. */
void sl_abf_chart_hold(sl_abf_chart *chart, bool valid);

/* A full solve from the solver's present state and targets; *good = converged and valid, and then held. */
SL_NODISCARD sl_status sl_abf_chart_try(sl_abf_chart *chart, const sl_context *context, bool *good);

/* From the state held (of sums `from`) towards `to`, in steps that double where they succeed and halve where not. */
SL_NODISCARD sl_status sl_abf_chart_approach(sl_abf_chart *chart, const sl_context *context);

/* info.distance. */
void sl_abf_chart_measure_distance(sl_abf_chart *chart);

#endif
