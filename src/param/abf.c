/* ABF++: Newton's method on the Lagrangian of Eqs. 1-4.
 *
 * alpha and then g1, whose block J1 inv(Lambda) J1' is diagonal, are eliminated; what is left, M dlambda2 = rhs, has
 * one unknown per sector and one per interior vertex and is positive definite iff J has full row rank, which leaving
 * out one row per region wholly prescribed sees to. Source: Sheffer, Levy, Mogilnitsky, Bogomyakov 2005, "ABF++: fast
 * and robust angle based flattening". Deviations: log form of g3 by default; general sectors; exact Newton as an
 * option; steps are damped so that all angles stay in (0, pi). */
#include "param/abf.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "param/abf_solver_internal.h"

static const double pi = 3.14159265358979323846;

static sl_status allocate(sl_abf *solver)
{
    const int64_t nt = solver->patch->nt, nrows = solver->system.nrows;
    double **of_corners[] = {&solver->phi,   &solver->w,        &solver->hessian,
                             &solver->alpha, &solver->gradient, &solver->delta};
    double **of_triangles[] = {&solver->lambda1, &solver->g1, &solver->dlambda1};
    double **of_rows[] = {&solver->lambda2, &solver->g, &solver->rhs};
    bool failed = false;
    for (size_t i = 0; i < SL_COUNTOF(of_corners); i++) {
        *of_corners[i] = sl_calloc(3 * nt, sizeof(double));
        failed = failed || *of_corners[i] == NULL;
    }
    for (size_t i = 0; i < SL_COUNTOF(of_triangles); i++) {
        *of_triangles[i] = sl_calloc(nt, sizeof(double));
        failed = failed || *of_triangles[i] == NULL;
    }
    for (size_t i = 0; i < SL_COUNTOF(of_rows); i++) {
        *of_rows[i] = sl_calloc(nrows, sizeof(double));
        failed = failed || *of_rows[i] == NULL;
    }
    return failed ? SL_OUT_OF_MEMORY : SL_OK;
}

static sl_status analyze(sl_abf *solver)
{
    sl_status status = SL_OK;
    double *xyz = sl_alloc(3 * (int64_t)solver->system.nrows, sizeof *xyz);
    if (xyz == NULL) {
        return SL_OUT_OF_MEMORY;
    }
    sl_abf_system_points(&solver->system, xyz);
    sl_cholesky_def def = sl_cholesky_default();
    def.xyz = xyz;
    SL_TRY(sl_cholesky_analyze(solver->system.M, &def, &solver->factor));
    SL_TRY(sl_cholesky_reserve(solver->factor)); /* no step allocates */
    solver->work = sl_alloc(sl_cholesky_work_size(solver->factor, 1), sizeof(double));
    status = solver->work == NULL ? SL_OUT_OF_MEMORY : SL_OK;
cleanup:
    sl_free(xyz);
    return status;
}

/* The sectors asked for, or those of interior vertices; theta is copied, so that it can be changed. */
static sl_status adopt_sectors(sl_abf *solver)
{
    sl_status status = SL_OK;
    const sl_sectors *given = solver->def.sectors;
    if (given == NULL) {
        SL_TRY(sl_sectors_interior(solver->patch, &solver->own_sectors));
        given = &solver->own_sectors.view;
    }
    SL_TRY(sl_sectors_check(solver->patch, given, NULL));
    solver->theta = sl_copy(given->theta, given->count, sizeof *given->theta);
    if (solver->theta == NULL) {
        return SL_OUT_OF_MEMORY;
    }
    solver->sectors = (sl_sectors){given->count, given->first, given->corner, solver->theta};
cleanup:
    return status;
}

static int ascending(const void *a, const void *b)
{
    const int32_t x = *(const int32_t *)a, y = *(const int32_t *)b;
    return (x > y) - (x < y);
}

/* The rows that depend on others, one per region wholly prescribed, ascending; *count of them, owned by the caller. */
static sl_status find_dependent_rows(sl_abf *solver, int32_t *count, int32_t **rows)
{
    sl_status status = SL_OK;
    *count = 0;
    SL_TRY(sl_regions_init(&solver->regions, solver->patch, &solver->sectors));
    SL_TRY(sl_regions_contradicted(&solver->regions) >= 0 ? SL_INFEASIBLE : SL_OK);
    *rows = sl_alloc(solver->regions.count, sizeof **rows);
    if (*rows == NULL) {
        return SL_OUT_OF_MEMORY;
    }
    for (int32_t r = 0; r < solver->regions.count; r++) {
        if (solver->regions.dependent[r] >= 0) {
            (*rows)[(*count)++] = solver->regions.dependent[r];
        }
    }
    qsort(*rows, (size_t)*count, sizeof **rows, ascending);
cleanup:
    return status;
}

static sl_status build_system(sl_abf *solver)
{
    sl_status status = SL_OK;
    int32_t count = 0, *rows = NULL;
    SL_TRY(adopt_sectors(solver));
    SL_TRY(find_dependent_rows(solver, &count, &rows));
    SL_TRY(sl_abf_system_init(&solver->system, solver->patch, &solver->sectors, count, rows));
    solver->info.dependent = count;
cleanup:
    sl_free(rows);
    return status;
}

/* alpha = phi kept inside (0, pi): where few triangles share the whole turn, phi exceeds pi. */
static void start_angles(sl_abf *solver)
{
    const double low = solver->def.min_angle, high = pi - low;
    sl_abf_targets(solver->patch, &solver->def, solver->phi, solver->w);
    for (int64_t c = 0; c < 3 * (int64_t)solver->patch->nt; c++) {
        solver->alpha[c] = fmin(fmax(solver->phi[c], low), high);
    }
}

/* A new race towards the present targets. */
static void begin(sl_abf *solver)
{
    solver->info = (sl_abf_info){.dependent = solver->info.dependent};
    solver->best_excess = INFINITY;
    solver->steps_since_best = solver->history_next = 0;
    sl_abf_evaluate(solver);
    sl_abf_judge(solver);
}

sl_status sl_abf_create(const sl_patch *patch, const sl_abf_def *def, sl_abf **out)
{
    sl_status status = SL_OK;
    *out = NULL;
    sl_abf *solver = sl_calloc(1, sizeof *solver);
    if (solver == NULL) {
        return SL_OUT_OF_MEMORY;
    }
    solver->patch = patch;
    solver->def = *def;
    SL_TRY(build_system(solver));
    SL_TRY(allocate(solver));
    SL_TRY(analyze(solver));
    start_angles(solver);
    begin(solver);
    *out = solver;
    solver = NULL;
cleanup:
    sl_abf_free(solver);
    return status;
}

/* Are the three angles those of a triangle, as far as signs go? */
static bool usable(const double *angle)
{
    return angle[0] > 0.0 && angle[0] < pi && angle[1] > 0.0 && angle[1] < pi && angle[2] > 0.0 && angle[2] < pi;
}

int32_t sl_abf_start_from(sl_abf *solver, const double *angle)
{
    const int32_t nt = solver->patch->nt;
    int32_t taken = 0;
    start_angles(solver);
    for (int32_t t = 0; t < nt && angle != NULL; t++) {
        if (usable(&angle[3 * (int64_t)t])) {
            memcpy(&solver->alpha[3 * (int64_t)t], &angle[3 * (int64_t)t], 3 * sizeof *angle);
            taken++;
        }
    }
    memset(solver->lambda1, 0, (size_t)nt * sizeof *solver->lambda1);
    memset(solver->lambda2, 0, (size_t)solver->system.nrows * sizeof *solver->lambda2);
    begin(solver);
    return taken;
}

sl_status sl_abf_set_targets(sl_abf *solver, const double *theta)
{
    for (int32_t s = 0; s < solver->sectors.count; s++) {
        if (!isfinite(theta[s])) {
            return SL_BAD_INPUT;
        }
    }
    sl_regions_sum(&solver->regions, solver->sectors.count, theta);
    if (sl_regions_contradicted(&solver->regions) >= 0) {
        sl_regions_sum(&solver->regions, solver->sectors.count, solver->theta);
        return SL_INFEASIBLE;
    }
    memmove(solver->theta, theta, (size_t)solver->sectors.count * sizeof *theta);
    begin(solver);
    return SL_OK;
}

/* False: whoever watches has seen enough. */
static bool is_watched(const sl_abf *solver)
{
    return solver->def.watch == NULL || solver->def.watch(solver->def.watch_user, solver);
}

sl_status sl_abf_step(sl_abf *solver, int32_t n, const sl_context *context)
{
    sl_status status = SL_OK;
    const sl_abf_info *info = &solver->info;
    for (int32_t i = 0; i < n; i++) {
        if (info->converged || info->stalled || info->iterations >= solver->def.max_iterations) {
            break;
        }
        SL_TRY(sl_report_progress(context, "abf", (double)i / n));
        SL_TRY(info->iterations > 0 || is_watched(solver) ? SL_OK : SL_CANCELLED);
        SL_TRY(sl_abf_newton_step(solver));
        SL_TRY(is_watched(solver) ? SL_OK : SL_CANCELLED);
    }
cleanup:
    return status;
}

const sl_abf_info *sl_abf_info_of(const sl_abf *solver)
{
    return &solver->info;
}

const double *sl_abf_prescribed(const sl_abf *solver)
{
    return solver->theta;
}

const double *sl_abf_angles(const sl_abf *solver)
{
    return solver->alpha;
}

void sl_abf_free(sl_abf *solver)
{
    if (solver == NULL) {
        return;
    }
    sl_sectors_clear(&solver->own_sectors);
    sl_regions_clear(&solver->regions);
    sl_abf_system_clear(&solver->system);
    sl_cholesky_free(solver->factor);
    double *arrays[] = {solver->theta,    solver->phi,     solver->w,        solver->hessian, solver->alpha,
                        solver->lambda1,  solver->lambda2, solver->gradient, solver->delta,   solver->g1,
                        solver->dlambda1, solver->g,       solver->rhs,      solver->work};
    for (size_t i = 0; i < SL_COUNTOF(arrays); i++) {
        sl_free(arrays[i]);
    }
    sl_free(solver);
}

sl_status sl_abf_flatten(const sl_patch *patch, const sl_abf_def *def, const sl_context *context, double *uv,
                         sl_abf_info *info)
{
    sl_status status = SL_OK;
    sl_abf *solver = NULL;
    SL_TRY(sl_abf_create(patch, def, &solver));
    SL_TRY(sl_abf_step(solver, def->max_iterations, context));
    if (info != NULL) {
        *info = solver->info;
    }
    SL_TRY(sl_abf_reconstruct(patch, solver->alpha, context, uv));
cleanup:
    sl_abf_free(solver);
    return status;
}
