/* How a chart comes by its first state. */
#include <string.h>

#include "base/memory.h"
#include "param/abf_chart_internal.h"

enum { MAX_STEPS = 150 }; /* of one solve, unless def allows more */

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
    def.watch = NULL; /* its sectors are others */
    SL_TRY(sl_abf_create(chart->patch, &def, &plain));
    SL_TRY(sl_abf_solve_patiently(plain, context));
    chart->info.iterations += plain->info.iterations;
    chart->info.solves++;
    if (!plain->info.converged) {
        goto cleanup;
    }
    adopt_free_solution(solver, plain);
    memcpy(chart->state, solver->alpha, 3 * (size_t)chart->patch->nt * sizeof *chart->state);
    sl_abf_chart_sums(chart, chart->from);
    SL_TRY(sl_abf_set_targets(solver, chart->from));
    SL_TRY(sl_abf_chart_lay_out(chart, context, &valid));
    if (valid) {
        sl_abf_chart_hold(chart, true);
    }
cleanup:
    sl_abf_free(plain);
    return status;
}

/* From the angles given, if any are; *good = that worked. */
static sl_status start_known(sl_abf_chart *chart, const double *angle, const sl_context *context, bool *good)
{
    sl_status status = SL_OK;
    const int32_t taken = angle != NULL ? sl_abf_start_from(chart->solver, angle) : 0;
    *good = false;
    if (taken > 0) {
        SL_TRY(sl_abf_chart_try(chart, context, good));
        chart->info.taken_over = *good ? taken : 0;
        if (!*good) {
            sl_abf_start_from(chart->solver, NULL);
        }
    }
cleanup:
    return status;
}

static sl_status start(sl_abf_chart *chart, const double *angle, const sl_context *context)
{
    sl_status status = SL_OK;
    const size_t size = (size_t)chart->solver->sectors.count * sizeof *chart->to;
    bool good, valid;
    memcpy(chart->to, chart->solver->theta, size);
    memcpy(chart->theta, chart->solver->theta, size);
    SL_TRY(start_known(chart, angle, context, &good));
    if (!good) {
        SL_TRY(sl_abf_chart_try(chart, context, &good));
    }
    chart->info.reached = good ? 1.0 : 0.0;
    if (!good) {
        SL_TRY(start_free(chart, context));
        if (chart->info.valid) {
            SL_TRY(sl_abf_chart_approach(chart, context));
        } else { /* nothing valid is known: what there is, for what it is worth */
            SL_TRY(sl_abf_chart_lay_out(chart, context, &valid));
            sl_abf_chart_hold(chart, valid);
        }
    }
    sl_abf_chart_measure_distance(chart);
cleanup:
    return status;
}

static sl_status allocate(sl_abf_chart *chart)
{
    const int64_t nt = chart->patch->nt, nv = chart->patch->nv, count = chart->solver->sectors.count;
    chart->state = sl_calloc(4 * nt + chart->solver->system.nrows + count, sizeof *chart->state);
    chart->uv = sl_calloc(2 * nv, sizeof *chart->uv);
    chart->trial_uv = sl_calloc(2 * nv, sizeof *chart->trial_uv);
    chart->from = sl_calloc(count, sizeof *chart->from);
    chart->to = sl_calloc(count, sizeof *chart->to);
    chart->theta = sl_calloc(count, sizeof *chart->theta);
    const bool failed = chart->state == NULL || chart->uv == NULL || chart->trial_uv == NULL || chart->from == NULL ||
                        chart->to == NULL || chart->theta == NULL;
    return failed ? SL_OUT_OF_MEMORY : SL_OK;
}

sl_status sl_abf_chart_create_from(const sl_patch *patch, const sl_abf_def *def, const double *angle,
                                   const sl_context *context, sl_abf_chart **out)
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
    SL_TRY(allocate(chart));
    SL_TRY(start(chart, angle, context));
    *out = chart;
    chart = NULL;
cleanup:
    sl_abf_chart_free(chart);
    return status;
}

sl_status sl_abf_chart_create(const sl_patch *patch, const sl_abf_def *def, const sl_context *context,
                              sl_abf_chart **out)
{
    return sl_abf_chart_create_from(patch, def, NULL, context, out);
}
