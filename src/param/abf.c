/* ABF++: Newton's method on the Lagrangian of Eqs. 1-4, the constraints' curvature dropped.
 *
 *     [ Lambda  J' ] [ dalpha  ]     [ grad_alpha L ]        Lambda = 2 diag(w),  L = E + lambda' g
 *     [ J       0  ] [ dlambda ] = - [ g            ]
 *
 * alpha and then g1, whose block J1 inv(Lambda) J1' is diagonal, are eliminated; what is left, M dlambda2 = rhs, has
 * one unknown per sector and one per interior vertex and is positive definite iff J has full row rank. Source: Sheffer,
 * Levy, Mogilnitsky, Bogomyakov 2005, "ABF++: fast and robust angle based flattening". Deviations: log form of g3 by
 * default; general sectors; steps are damped so that all angles stay in (0, pi). */
#include "param/abf.h"

#include <math.h>
#include <string.h>

#include "base/memory.h"
#include "param/abf_internal.h"
#include "sparse/cholesky.h"

static const double pi = 3.14159265358979323846;
static const double boundary_share = 0.95; /* of the way to 0 or pi that one step may go */
static const double shortest_step = 1e-6;  /* below this the solver has stalled */

struct sl_abf {
    const sl_patch *patch; /* borrowed */
    sl_abf_def def;
    sl_sector_table own_sectors; /* when the caller gave none */
    const sl_sectors *sectors;
    sl_abf_system system;
    sl_cholesky *factor;
    sl_abf_info info;
    double *phi, *w, *d;      /* 3 nt; d = 1 / (2 w) */
    double *alpha, *lambda1;  /* 3 nt, nt */
    double *lambda2;          /* nrows: of g2, then of g3 */
    double *gradient, *delta; /* 3 nt */
    double *g1, *reduced;     /* nt */
    double *g, *rhs;          /* nrows: g2, then g3 */
    double *work;             /* of the Cholesky solve */
};

static double max_norm(const double *x, int64_t n)
{
    double largest = 0.0;
    for (int64_t i = 0; i < n; i++) {
        largest = fabs(x[i]) <= largest ? largest : fabs(x[i]); /* keeps a NaN */
    }
    return largest;
}

/* Everything that depends on alpha and lambda: J, gradient of L, residuals, info. */
static void evaluate(sl_abf *solver)
{
    const sl_patch *patch = solver->patch;
    const int64_t nc = 3 * (int64_t)patch->nt;
    const int32_t nsectors = solver->system.nsectors;
    sl_abf_system_linearise(&solver->system, solver->def.wheel, solver->alpha);
    sl_abf_eval_g1(patch, solver->alpha, solver->g1);
    sl_abf_eval_g2(solver->sectors, solver->alpha, solver->g);
    sl_abf_eval_g3(patch, solver->def.wheel, solver->alpha, &solver->g[nsectors]);
    double energy = 0.0, smallest = pi;
    for (int64_t c = 0; c < nc; c++) {
        const double off = solver->alpha[c] - solver->phi[c];
        energy += solver->w[c] * off * off;
        smallest = fmin(smallest, solver->alpha[c]);
        solver->gradient[c] = 2.0 * solver->w[c] * off + solver->lambda1[c / 3];
    }
    sl_abf_system_apply_transposed(&solver->system, solver->lambda2, solver->gradient);
    sl_abf_info *info = &solver->info;
    info->energy = energy;
    info->min_angle = smallest;
    info->gradient = max_norm(solver->gradient, nc);
    info->g1 = max_norm(solver->g1, patch->nt);
    info->g2 = max_norm(solver->g, nsectors);
    info->g3 = max_norm(&solver->g[nsectors], (int64_t)solver->system.nrows - nsectors);
}

/* Below the tolerance asked for; or, where no further step will be taken, below the one a result is accepted with. */
static void judge(sl_abf *solver)
{
    sl_abf_info *info = &solver->info;
    const sl_abf_def *def = &solver->def;
    const bool last = info->stalled || info->iterations >= def->max_iterations;
    const double gradient = last ? fmax(def->accept_gradient, def->gradient_tolerance) : def->gradient_tolerance;
    info->converged = info->gradient <= gradient && info->g1 <= def->constraint_tolerance &&
                      info->g2 <= def->constraint_tolerance && info->g3 <= def->constraint_tolerance &&
                      info->min_angle > 0.0;
}

static sl_status allocate(sl_abf *solver)
{
    const int64_t nt = solver->patch->nt, nrows = solver->system.nrows;
    double **of_corners[] = {&solver->phi, &solver->w, &solver->d, &solver->alpha, &solver->gradient, &solver->delta};
    double **of_triangles[] = {&solver->lambda1, &solver->g1, &solver->reduced};
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
    solver->work = sl_alloc(sl_cholesky_work_size(solver->factor, 1), sizeof(double));
    status = solver->work == NULL ? SL_OUT_OF_MEMORY : SL_OK;
cleanup:
    sl_free(xyz);
    return status;
}

/* alpha = phi kept inside (0, pi): where few triangles share the whole turn, phi exceeds pi. */
static void start_angles(sl_abf *solver)
{
    const double low = solver->def.min_angle, high = pi - low;
    sl_abf_targets(solver->patch, &solver->def, solver->phi, solver->w);
    for (int64_t c = 0; c < 3 * (int64_t)solver->patch->nt; c++) {
        solver->alpha[c] = fmin(fmax(solver->phi[c], low), high);
        solver->d[c] = 0.5 / solver->w[c];
    }
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
    solver->sectors = def->sectors;
    if (def->sectors == NULL) {
        SL_TRY(sl_sectors_interior(patch, &solver->own_sectors));
        solver->sectors = &solver->own_sectors.view;
    }
    SL_TRY(sl_abf_system_init(&solver->system, patch, solver->sectors));
    SL_TRY(allocate(solver));
    SL_TRY(analyze(solver));
    start_angles(solver);
    evaluate(solver);
    judge(solver);
    *out = solver;
    solver = NULL;
cleanup:
    sl_abf_free(solver);
    return status;
}

/* The right-hand side of M dlambda2 = rhs; reduced[t] keeps that of the g1 rows. */
static void reduce(sl_abf *solver)
{
    const sl_abf_system *system = &solver->system;
    for (int32_t t = 0; t < solver->patch->nt; t++) {
        const double *d = &solver->d[3 * (int64_t)t], *gradient = &solver->gradient[3 * (int64_t)t];
        double *delta = &solver->delta[3 * (int64_t)t];
        const double r = solver->g1[t] - (d[0] * gradient[0] + d[1] * gradient[1] + d[2] * gradient[2]);
        const double mean = r / (d[0] + d[1] + d[2]);
        for (int k = 0; k < 3; k++) {
            delta[k] = d[k] * (gradient[k] + mean);
        }
        solver->reduced[t] = r;
    }
    memcpy(solver->rhs, solver->g, (size_t)system->nrows * sizeof *solver->rhs);
    sl_abf_system_subtract(system, solver->delta, solver->rhs);
}

/* rhs holds dlambda2; delta becomes dalpha, reduced dlambda1. */
static void substitute_back(sl_abf *solver)
{
    memset(solver->delta, 0, 3 * (size_t)solver->patch->nt * sizeof *solver->delta);
    sl_abf_system_apply_transposed(&solver->system, solver->rhs, solver->delta);
    for (int32_t t = 0; t < solver->patch->nt; t++) {
        const double *d = &solver->d[3 * (int64_t)t], *gradient = &solver->gradient[3 * (int64_t)t];
        double *z = &solver->delta[3 * (int64_t)t];
        const double r = solver->reduced[t] - (d[0] * z[0] + d[1] * z[1] + d[2] * z[2]);
        const double dlambda1 = r / (d[0] + d[1] + d[2]);
        for (int k = 0; k < 3; k++) {
            z[k] = -d[k] * (gradient[k] + dlambda1 + z[k]);
        }
        solver->reduced[t] = dlambda1;
    }
}

/* Longest step <= 1 that goes at most boundary_share of the way to an angle of 0 or pi; 0 when a value is not finite.
 */
static double step_length(const sl_abf *solver)
{
    double step = 1.0;
    for (int64_t c = 0; c < 3 * (int64_t)solver->patch->nt; c++) {
        const double room = solver->delta[c] < 0.0 ? solver->alpha[c] : pi - solver->alpha[c];
        if (!isfinite(solver->delta[c])) {
            return 0.0;
        }
        if (fabs(solver->delta[c]) * step > boundary_share * room) {
            step = boundary_share * room / fabs(solver->delta[c]);
        }
    }
    return step;
}

static void advance(sl_abf *solver, double step)
{
    for (int64_t c = 0; c < 3 * (int64_t)solver->patch->nt; c++) {
        solver->alpha[c] += step * solver->delta[c];
    }
    for (int32_t t = 0; t < solver->patch->nt; t++) {
        solver->lambda1[t] += step * solver->reduced[t];
    }
    for (int32_t r = 0; r < solver->system.nrows; r++) {
        solver->lambda2[r] += step * solver->rhs[r];
    }
}

/* One Newton step; where it cannot be taken the angles stay as they are. SL_OUT_OF_MEMORY at most. */
static sl_status newton_step(sl_abf *solver)
{
    sl_abf_system_assemble(&solver->system, solver->d);
    const sl_status status = sl_cholesky_factor(solver->factor, solver->system.M, NULL);
    if (status == SL_NOT_POSITIVE_DEFINITE || status == SL_BAD_INPUT) {
        solver->info.stalled = true;
        judge(solver);
        return SL_OK;
    }
    if (status != SL_OK) {
        return status;
    }
    reduce(solver);
    sl_cholesky_solve(solver->factor, solver->rhs, 1, solver->work);
    substitute_back(solver);
    const double step = step_length(solver);
    solver->info.step = step;
    if (step < shortest_step) {
        solver->info.stalled = true;
    } else {
        advance(solver, step);
        solver->info.iterations++;
        evaluate(solver);
    }
    judge(solver);
    return SL_OK;
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
        SL_TRY(newton_step(solver));
    }
cleanup:
    return status;
}

const sl_abf_info *sl_abf_info_of(const sl_abf *solver)
{
    return &solver->info;
}

const double *sl_abf_angles(const sl_abf *solver)
{
    return solver->alpha;
}

sl_abf_view sl_abf_view_of(const sl_abf *solver)
{
    return (sl_abf_view){solver->lambda1, solver->lambda2, solver->gradient, solver->phi, solver->w, &solver->system};
}

void sl_abf_free(sl_abf *solver)
{
    if (solver == NULL) {
        return;
    }
    sl_sectors_clear(&solver->own_sectors);
    sl_abf_system_clear(&solver->system);
    sl_cholesky_free(solver->factor);
    double *arrays[] = {solver->phi,     solver->w,        solver->d,     solver->alpha, solver->lambda1,
                        solver->lambda2, solver->gradient, solver->delta, solver->g1,    solver->reduced,
                        solver->g,       solver->rhs,      solver->work};
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
