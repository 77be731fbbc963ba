#include "param/abf_chart.h"

#include <math.h>
#include <string.h>

#include "base/memory.h"
#include "param/abf_solver_internal.h"

/* A solve goes on up to MAX_STEPS as long as one in PATIENCE of them makes progress. */
enum { MOVE_STEPS = 2, MAX_SOLVES = 60, MAX_STEPS = 150, PATIENCE = 20 };

static const double shortest_advance = 0x1p-10; /* of the way to the targets: below this homotopy gives up */

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
static void sector_sums(const sl_abf_chart *chart, double *sum)
{
    const sl_sectors *sectors = &chart->solver->sectors;
    sl_abf_eval_g2(sectors, chart->state, sum);
    for (int32_t s = 0; s < sectors->count; s++) {
        sum[s] += sectors->theta[s];
    }
}

/* Lays the solver's angles out in trial_uv; *valid = no triangle is flipped. */
static sl_status lay_out(sl_abf_chart *chart, const sl_context *context, bool *valid)
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
static void hold(sl_abf_chart *chart, bool valid)
{
    save_state(chart->solver, chart->state);
    memcpy(chart->uv, chart->trial_uv, 2 * (size_t)chart->patch->nv * sizeof *chart->uv);
    chart->info.quality = chart->trial;
    chart->info.valid = valid;
    chart->info.converged = chart->solver->info.converged;
}

/* Newton steps until converged, stalled, or without hope. */
static sl_status solve_patiently(sl_abf *solver, const sl_context *context)
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
static sl_status try_targets(sl_abf_chart *chart, const sl_context *context, bool *good)
{
    sl_status status = SL_OK;
    sl_abf *solver = chart->solver;
    bool valid = false;
    *good = false;
    SL_TRY(sl_abf_set_targets(solver, chart->theta));
    SL_TRY(solve_patiently(solver, context));
    chart->info.abf = solver->info;
    chart->info.iterations += solver->info.iterations;
    chart->info.solves++;
    if (solver->info.converged) {
        SL_TRY(lay_out(chart, context, &valid));
    }
    if (valid) {
        hold(chart, true);
        *good = true;
    }
cleanup:
    return status;
}

/* From the state held (of sums `from`) towards `to`, in steps that double where they succeed and halve where not. */
static sl_status approach(sl_abf_chart *chart, const sl_context *context)
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
        SL_TRY(try_targets(chart, context, &good));
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

static void measure_distance(sl_abf_chart *chart)
{
    sector_sums(chart, chart->theta);
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
    SL_TRY(try_targets(chart, context, &good));
    if (good) {
        chart->info.reached = 1.0;
    } else {
        SL_TRY(restore_state(chart->solver, chart->state));
        sector_sums(chart, chart->from);
        if (chart->info.valid) {
            SL_TRY(approach(chart, context));
        }
        chart->info.rolled_back = chart->info.reached == 0.0;
    }
    measure_distance(chart);
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
    SL_TRY(lay_out(chart, context, &valid));
    chart->info.abf = chart->solver->info;
    chart->info.solves = 1;
    chart->info.iterations = chart->solver->info.iterations;
    chart->info.rolled_back = !valid;
    if (valid) {
        hold(chart, true);
    } else {
        SL_TRY(restore_state(chart->solver, chart->state));
    }
    chart->info.reached = valid ? 1.0 : 0.0;
    measure_distance(chart);
cleanup:
    if (status != SL_OK) {
        const sl_status restored = restore_state(chart->solver, chart->state);
        (void)restored; /* targets that were taken before */
    }
    return status;
}

/* Multipliers of a solution without constraints: a part of an interior vertex's turn takes those of the whole. */
static void adopt_free_solution(sl_abf *solver, const sl_abf *plain)
{
    const sl_patch *patch = solver->patch;
    const int32_t base = solver->system.nsectors;
    memcpy(solver->alpha, plain->alpha, 3 * (size_t)patch->nt * sizeof *solver->alpha);
    memcpy(solver->lambda1, plain->lambda1, (size_t)patch->nt * sizeof *solver->lambda1);
    for (int32_t r = base; r < solver->system.nrows; r++) {
        solver->lambda2[r] = plain->lambda2[r - base + plain->system.nsectors];
    }
    for (int32_t s = 0; s < base; s++) {
        const int32_t v = patch->tri[solver->sectors.corner[solver->sectors.first[s]]];
        const int32_t wheel = plain->system.wheel_row[v]; /* both of an interior vertex's rows are in vertex order */
        solver->lambda2[s] = wheel >= 0 ? plain->lambda2[wheel - plain->system.nsectors] : 0.0;
    }
    for (int32_t i = 0; i < solver->system.ndropped; i++) {
        solver->lambda2[solver->system.dropped[i]] = 0.0;
    }
}

/* Holds the chart flattened without constraints, the targets being its own sums, if that is valid. */
static sl_status start_free(sl_abf_chart *chart, const sl_context *context)
{
    sl_status status = SL_OK;
    sl_abf *plain = NULL, *solver = chart->solver;
    sl_abf_def def = solver->def;
    bool valid = false;
    def.sectors = NULL;
    SL_TRY(sl_abf_create(chart->patch, &def, &plain));
    SL_TRY(solve_patiently(plain, context));
    chart->info.iterations += plain->info.iterations;
    chart->info.solves++;
    if (!plain->info.converged) {
        goto cleanup;
    }
    adopt_free_solution(solver, plain);
    memcpy(chart->state, solver->alpha, 3 * (size_t)chart->patch->nt * sizeof *chart->state);
    sector_sums(chart, chart->from);
    SL_TRY(sl_abf_set_targets(solver, chart->from));
    SL_TRY(lay_out(chart, context, &valid));
    if (valid) {
        hold(chart, true);
    }
cleanup:
    sl_abf_free(plain);
    return status;
}

static sl_status start(sl_abf_chart *chart, const sl_context *context)
{
    sl_status status = SL_OK;
    const size_t size = (size_t)chart->solver->sectors.count * sizeof *chart->to;
    bool good, valid;
    memcpy(chart->to, chart->solver->theta, size);
    memcpy(chart->theta, chart->solver->theta, size);
    SL_TRY(try_targets(chart, context, &good));
    chart->info.reached = good ? 1.0 : 0.0;
    if (!good) {
        SL_TRY(start_free(chart, context));
        if (chart->info.valid) {
            SL_TRY(approach(chart, context));
        } else { /* nothing valid is known: what there is, for what it is worth */
            SL_TRY(lay_out(chart, context, &valid));
            hold(chart, valid);
        }
    }
    measure_distance(chart);
cleanup:
    return status;
}

sl_status sl_abf_chart_create(const sl_patch *patch, const sl_abf_def *def, const sl_context *context,
                              sl_abf_chart **out)
{
    sl_status status = SL_OK;
    *out = NULL;
    sl_abf_chart *chart = sl_calloc(1, sizeof *chart);
    if (chart == NULL) {
        return SL_OUT_OF_MEMORY;
    }
    chart->patch = patch;
    SL_TRY(sl_abf_create(patch, def, &chart->solver));
    chart->solver->def.max_iterations = def->max_iterations > MAX_STEPS ? def->max_iterations : MAX_STEPS;
    SL_TRY(sl_reconstruct_create(patch, &chart->layout));
    const int64_t nt = patch->nt, nv = patch->nv, count = chart->solver->sectors.count;
    chart->state = sl_calloc(4 * nt + chart->solver->system.nrows + count, sizeof *chart->state);
    chart->uv = sl_calloc(2 * nv, sizeof *chart->uv);
    chart->trial_uv = sl_calloc(2 * nv, sizeof *chart->trial_uv);
    chart->from = sl_calloc(count, sizeof *chart->from);
    chart->to = sl_calloc(count, sizeof *chart->to);
    chart->theta = sl_calloc(count, sizeof *chart->theta);
    if (chart->state == NULL || chart->uv == NULL || chart->trial_uv == NULL || chart->from == NULL ||
        chart->to == NULL || chart->theta == NULL) {
        SL_TRY(SL_OUT_OF_MEMORY);
    }
    SL_TRY(start(chart, context));
    *out = chart;
    chart = NULL;
cleanup:
    sl_abf_chart_free(chart);
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
