#include "param/abf_chart_internal.h"

#include <math.h>
#include <string.h>

#include "base/memory.h"

/* A solve goes on as long as one step in PATIENCE makes progress. */
enum { MOVE_STEPS = 2, MAX_SOLVES = 60, PATIENCE = 20 };

static const double shortest_advance = 0x1p-10; /* of the way to the targets: below this homotopy gives up */

static void save_state(const sl_abf *solver, double *state)
{
    const size_t nt = (size_t)solver->patch->nt, rows = (size_t)solver->system.nrows;
    memcpy(state, solver->alpha, 3 * nt * sizeof *state);
    memcpy(&state[3 * nt], solver->lambda1, nt * sizeof *state);
    memcpy(&state[4 * nt], solver->lambda2, rows * sizeof *state);
    memcpy(&state[4 * nt + rows], solver->theta, (size_t)solver->sectors.count * sizeof *state);
}

static sl_status restore_state(sl_abf *solver, const double *state)
{
    const size_t nt = (size_t)solver->patch->nt, rows = (size_t)solver->system.nrows;
    memcpy(solver->alpha, state, 3 * nt * sizeof *state);
    memcpy(solver->lambda1, &state[3 * nt], nt * sizeof *state);
    memcpy(solver->lambda2, &state[4 * nt], rows * sizeof *state);
    return sl_abf_set_targets(solver, &state[4 * nt + rows]);
}

/* Sums of the angles held over the sectors. */
void sl_abf_chart_sums(const sl_abf_chart *chart, double *sum)
{
    const sl_sectors *sectors = &chart->solver->sectors;
    sl_abf_eval_g2(sectors, chart->state, sum);
    for (int32_t s = 0; s < sectors->count; s++) {
        sum[s] += sectors->theta[s];
    }
}

/* Lays the solver's angles out in trial_uv; *valid = no triangle is flipped. */
sl_status sl_abf_chart_lay_out(sl_abf_chart *chart, const sl_context *context, bool *valid)
{
    const sl_status status = sl_reconstruct_solve(chart->layout, chart->solver->alpha, context, chart->trial_uv);
    *valid = false;
    if (status == SL_OK) {
        chart->trial = sl_layout_judge(chart->patch, chart->solver->alpha, chart->trial_uv);
        *valid = chart->trial.flipped == 0 && chart->solver->info.min_angle > 0.0;
    }
    return status == SL_SINGULAR ? SL_OK : status;
}

/* The solver's state and trial_uv become what is held. */
void sl_abf_chart_hold(sl_abf_chart *chart, bool valid)
{
    save_state(chart->solver, chart->state);
    memcpy(chart->uv, chart->trial_uv, 2 * (size_t)chart->patch->nv * sizeof *chart->uv);
    chart->info.quality = chart->trial;
    chart->info.valid = valid;
    chart->info.converged = chart->solver->info.converged;
}

/* Newton steps until converged, stalled, or without hope. */
sl_status sl_abf_solve_patiently(sl_abf *solver, const sl_context *context)
{
    sl_status status = SL_OK;
    const sl_abf_info *info = &solver->info;
    while (!info->converged && !info->stalled && info->iterations < solver->def.max_iterations &&
           solver->steps_since_best < PATIENCE) {
        SL_TRY(sl_report_progress(context, "abf", (double)info->iterations / solver->def.max_iterations));
        SL_TRY(sl_abf_step(solver, 1, NULL));
    }
cleanup:
    return status;
}

/* A full solve for chart->theta from the present state; *good = converged and valid, and then held. */
sl_status sl_abf_chart_try(sl_abf_chart *chart, const sl_context *context, bool *good)
{
    sl_status status = SL_OK;
    sl_abf *solver = chart->solver;
    bool valid = false;
    *good = false;
    SL_TRY(sl_abf_set_targets(solver, chart->theta));
    SL_TRY(sl_abf_solve_patiently(solver, context));
    chart->info.abf = solver->info;
    chart->info.iterations += solver->info.iterations;
    chart->info.solves++;
    if (solver->info.converged) {
        SL_TRY(sl_abf_chart_lay_out(chart, context, &valid));
    }
    if (valid) {
        sl_abf_chart_hold(chart, true);
        *good = true;
    }
cleanup:
    return status;
}

/* From the state held (of sums `from`) towards `to`, in steps that double where they succeed and halve where not. */
sl_status sl_abf_chart_approach(sl_abf_chart *chart, const sl_context *context)
{
    sl_status status = SL_OK;
    const int32_t count = chart->solver->sectors.count;
    double advance = 0.5;
    for (int i = 0; i < MAX_SOLVES && advance >= shortest_advance && chart->info.reached < 1.0; i++) {
        const double s = fmin(1.0, chart->info.reached + advance);
        bool good;
        for (int32_t k = 0; k < count; k++) {
            chart->theta[k] = s < 1.0 ? (1.0 - s) * chart->from[k] + s * chart->to[k] : chart->to[k];
        }
        SL_TRY(sl_abf_chart_try(chart, context, &good));
        if (good) {
            chart->info.reached = s;
        } else {
            SL_TRY(restore_state(chart->solver, chart->state));
        }
        advance *= good ? 2.0 : 0.5;
    }
cleanup:
    return status;
}

void sl_abf_chart_measure_distance(sl_abf_chart *chart)
{
    sl_abf_chart_sums(chart, chart->theta);
    chart->info.distance = 0.0;
    for (int32_t s = 0; s < chart->solver->sectors.count; s++) {
        chart->info.distance = fmax(chart->info.distance, fabs(chart->theta[s] - chart->to[s]));
    }
}

sl_status sl_abf_chart_release(sl_abf_chart *chart, const double *theta, const sl_context *context)
{
    sl_status status = SL_OK;
    const size_t size = (size_t)chart->solver->sectors.count * sizeof *theta;
    bool good;
    memmove(chart->to, theta, size);
    memcpy(chart->theta, theta, size);
    chart->info.solves = chart->info.iterations = 0;
    chart->info.rolled_back = false;
    chart->info.reached = 0.0;
    SL_TRY(sl_abf_chart_try(chart, context, &good));
    if (good) {
        chart->info.reached = 1.0;
    } else {
        SL_TRY(restore_state(chart->solver, chart->state));
        sl_abf_chart_sums(chart, chart->from);
        if (chart->info.valid) {
            SL_TRY(sl_abf_chart_approach(chart, context));
        }
        chart->info.rolled_back = chart->info.reached == 0.0;
    }
    sl_abf_chart_measure_distance(chart);
cleanup:
    if (status != SL_OK) {
        const sl_status restored = restore_state(chart->solver, chart->state);
        (void)restored; /* targets that were taken before */
    }
    return status;
}

sl_status sl_abf_chart_move(sl_abf_chart *chart, const double *theta, const sl_context *context)
{
    sl_status status = SL_OK;
    bool valid = false;
    SL_TRY(sl_abf_set_targets(chart->solver, theta));
    memmove(chart->to, theta, (size_t)chart->solver->sectors.count * sizeof *theta);
    SL_TRY(sl_abf_step(chart->solver, MOVE_STEPS, context));
    SL_TRY(sl_abf_chart_lay_out(chart, context, &valid));
    chart->info.abf = chart->solver->info;
    chart->info.solves = 1;
    chart->info.iterations = chart->solver->info.iterations;
    chart->info.rolled_back = !valid;
    if (valid) {
        sl_abf_chart_hold(chart, true);
    } else {
        SL_TRY(restore_state(chart->solver, chart->state));
    }
    chart->info.reached = valid ? 1.0 : 0.0;
    sl_abf_chart_measure_distance(chart);
cleanup:
    if (status != SL_OK) {
        const sl_status restored = restore_state(chart->solver, chart->state);
        (void)restored; /* targets that were taken before */
    }
    return status;
}

const sl_abf_chart_info *sl_abf_chart_info_of(const sl_abf_chart *chart)
{
    return &chart->info;
}

const double *sl_abf_chart_uv(const sl_abf_chart *chart)
{
    return chart->uv;
}

const double *sl_abf_chart_angles(const sl_abf_chart *chart)
{
    return chart->state;
}

const sl_abf *sl_abf_chart_solver(const sl_abf_chart *chart)
{
    return chart->solver;
}

void sl_abf_chart_free(sl_abf_chart *chart)
{
    if (chart == NULL) {
        return;
    }
    sl_abf_free(chart->solver);
    sl_reconstruct_free(chart->layout);
    double *arrays[] = {chart->state, chart->uv, chart->trial_uv, chart->from, chart->to, chart->theta};
    for (size_t i = 0; i < SL_COUNTOF(arrays); i++) {
        sl_free(arrays[i]);
    }
    sl_free(chart);
}
