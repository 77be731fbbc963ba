/* One Newton step on the Lagrangian of Eqs. 1-4.
 *
 *     [ Lambda  J' ] [ dalpha  ]     [ grad_alpha L ]
 *     [ J       0  ] [ dlambda ] = - [ g            ]        L = E + lambda' g
 *
 * Lambda = 2 diag(w), plus, in exact Newton, the curvature of g3:
 *
 *     log      diag(-+ lambda_v / sin^2 alpha)                 - at the next corners of a wheel, + at the previous ones
 *     ratio    R times that  +  (lambda_v / R) j j'            R = prod sin / sin, j the wheel's row of J
 *     product  N and D times that  +  lambda_v (j s' + s j') / 2  -  lambda_v g3_v (a b' + b a') / 2
 *
 * with N, D the two products, a and b the cotangents on the two sides and s = a + b. Terms in j need no larger system:
 * J dalpha = - g is known, so j j' dalpha only shifts lambda, and s j' dalpha is a known vector. The last term vanishes
 * with g3 and is left out: convergence stays quadratic. */
#include <math.h>
#include <string.h>

#include "param/abf_solver_internal.h"

static const double pi = 3.14159265358979323846;
static const double boundary_share = 0.95; /* of the way to 0 or pi that one step may go */
static const double shortest_step = 1e-6;  /* below this the solver has stalled */
static const double penalty_factor = 1.1;  /* over the largest multiplier of a group */
static const double sufficient = 1e-4;     /* of the decrease that the slope promises */
static const double rounding = 1e-12;      /* of the merit function: less than that is no increase */
static const int max_halvings = 6;
static const double least_curvature = 1e-3; /* of det P's denominator without curvature: exact Newton needs this much */
static const double progress = 0.99;        /* a residual must fall below this share of the best to count as progress */
static const int32_t patience = 5;          /* steps without progress that show the rounding floor */

static double max_norm(const double *x, int64_t n)
{
    double largest = 0.0;
    for (int64_t i = 0; i < n; i++) {
        largest = fabs(x[i]) <= largest ? largest : fabs(x[i]); /* keeps a NaN */
    }
    return largest;
}

void sl_abf_evaluate(sl_abf *solver)
{
    const sl_patch *patch = solver->patch;
    const int64_t nc = 3 * (int64_t)patch->nt;
    const int32_t nsectors = solver->system.nsectors;
    sl_abf_system_linearise(&solver->system, solver->def.wheel, solver->alpha);
    sl_abf_eval_g1(patch, solver->alpha, solver->g1);
    sl_abf_eval_g2(&solver->sectors, solver->alpha, solver->g);
    sl_abf_system_eval_g3(&solver->system, solver->def.wheel, &solver->g[nsectors]);
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

/* Counts the steps since the largest of the residuals, each over what a result is accepted with, last fell. */
static void watch_progress(sl_abf *solver)
{
    const sl_abf_info *info = &solver->info;
    const double constraint = fmax(fmax(info->g1, info->g2), info->g3);
    const double excess =
        fmax(info->gradient / solver->def.accept_gradient, constraint / solver->def.accept_constraint);
    solver->steps_since_best++;
    if (excess < progress * solver->best_excess) {
        solver->best_excess = excess;
        solver->steps_since_best = 0;
    }
}

/* Below the tolerance asked for; or, where no further step will be taken, below the one a result is accepted with. */
void sl_abf_judge(sl_abf *solver)
{
    sl_abf_info *info = &solver->info;
    const sl_abf_def *def = &solver->def;
    const double accept_gradient = fmax(def->accept_gradient, def->gradient_tolerance);
    const double accept_constraint = fmax(def->accept_constraint, def->constraint_tolerance);
    const double constraint = fmax(fmax(info->g1, info->g2), info->g3);
    const bool positive = info->min_angle > 0.0;
    const bool acceptable = info->gradient <= accept_gradient && constraint <= accept_constraint && positive;
    info->converged = info->gradient <= def->gradient_tolerance && constraint <= def->constraint_tolerance && positive;
    info->floor = !info->converged && acceptable && solver->steps_since_best >= patience;
    if (info->floor || info->stalled || info->iterations >= def->max_iterations) {
        info->converged = info->converged || acceptable;
    }
}

/* Adds the diagonal part of g3's curvature where P stays positive definite with it, and counts where it does not. */
static void add_curvature(sl_abf *solver)
{
    const sl_patch *patch = solver->patch;
    const sl_abf_system *system = &solver->system;
    for (int32_t t = 0; t < patch->nt; t++) {
        double *Lambda = &solver->hessian[3 * (int64_t)t], bent[3];
        for (int k = 0; k < 3; k++) {
            const int32_t c = 3 * t + k;
            const int32_t after = system->wheel_row[patch->tri[sl_corner_prev(c)]]; /* c is the next corner there */
            const int32_t before = system->wheel_row[patch->tri[sl_corner_next(c)]];
            const double s = system->sine[c];
            bent[k] = 0.0;
            if (after >= 0) {
                bent[k] -= solver->lambda2[after] * system->wheel_scale[2 * (int64_t)(after - system->nsectors)];
            }
            if (before >= 0) {
                bent[k] += solver->lambda2[before] * system->wheel_scale[2 * (int64_t)(before - system->nsectors) + 1];
            }
            bent[k] = Lambda[k] + bent[k] / (s * s);
        }
        const double det = 1.0 / sl_abf_inverse_det(bent), least = least_curvature / sl_abf_inverse_det(Lambda);
        if (det > least && bent[0] + bent[1] + bent[2] > 0.0) {
            memcpy(Lambda, bent, sizeof bent);
        } else {
            solver->info.fallbacks++;
        }
    }
}

static void set_hessian(sl_abf *solver)
{
    for (int64_t c = 0; c < 3 * (int64_t)solver->patch->nt; c++) {
        solver->hessian[c] = 2.0 * solver->w[c];
    }
    solver->info.fallbacks = 0;
    if (solver->def.newton == SL_ABF_EXACT) {
        add_curvature(solver);
    }
}

/* Product form, exact Newton: gradient -= sum over wheels of lambda_v g3_v s / 2. */
static void shift_gradient(sl_abf *solver)
{
    const sl_patch *patch = solver->patch;
    const int32_t *row = solver->system.wheel_row;
    for (int32_t c = 0; c < 3 * patch->nt; c++) {
        const int32_t hub[2] = {row[patch->tri[sl_corner_prev(c)]], row[patch->tri[sl_corner_next(c)]]};
        const double cot = solver->system.cot[c];
        for (int side = 0; side < 2; side++) {
            if (hub[side] >= 0) {
                solver->gradient[c] -= 0.5 * cot * solver->lambda2[hub[side]] * solver->g[hub[side]];
            }
        }
    }
}

/* From the multipliers of the system solved to dlambda: ratio + (lambda_v / R) g3_v, product - lambda_v s' dalpha / 2.
 */
static void shift_multipliers(sl_abf *solver)
{
    const sl_patch *patch = solver->patch;
    const sl_abf_system *system = &solver->system;
    if (solver->def.wheel == SL_ABF_RATIO) {
        for (int32_t r = system->nsectors; r < system->nrows; r++) {
            const double ratio = system->wheel_scale[2 * (int64_t)(r - system->nsectors)];
            solver->rhs[r] += solver->lambda2[r] / ratio * solver->g[r];
        }
        return;
    }
    for (int32_t c = 0; c < 3 * patch->nt; c++) {
        const int32_t hub[2] = {system->wheel_row[patch->tri[sl_corner_prev(c)]],
                                system->wheel_row[patch->tri[sl_corner_next(c)]]};
        const double turn = solver->delta[c] * system->cot[c];
        for (int side = 0; side < 2; side++) {
            if (hub[side] >= 0) {
                solver->rhs[hub[side]] -= 0.5 * solver->lambda2[hub[side]] * turn;
            }
        }
    }
}

/* The right-hand side of M dlambda2 = g - J2 (P gradient + g1 q), q = diag P's null vector, sum 1. */
static void reduce(sl_abf *solver)
{
    const sl_abf_system *system = &solver->system;
    for (int32_t t = 0; t < solver->patch->nt; t++) {
        const double *Lambda = &solver->hessian[3 * (int64_t)t];
        double *delta = &solver->delta[3 * (int64_t)t];
        const double inverse = sl_abf_inverse_det(Lambda);
        sl_abf_project(Lambda, inverse, &solver->gradient[3 * (int64_t)t], delta);
        for (int k = 0; k < 3; k++) {
            delta[k] += solver->g1[t] * Lambda[(k + 1) % 3] * Lambda[(k + 2) % 3] * inverse;
        }
    }
    memcpy(solver->rhs, solver->g, (size_t)system->nrows * sizeof *solver->rhs);
    sl_abf_system_subtract(system, solver->delta, solver->rhs);
    for (int32_t i = 0; i < system->ndropped; i++) {
        solver->rhs[system->dropped[i]] = 0.0;
    }
}

/* rhs holds dlambda2; delta becomes dalpha = - P (gradient + J2' dlambda2) - g1 q. */
static void substitute_back(sl_abf *solver)
{
    memcpy(solver->delta, solver->gradient, 3 * (size_t)solver->patch->nt * sizeof *solver->delta);
    sl_abf_system_apply_transposed(&solver->system, solver->rhs, solver->delta);
    for (int32_t t = 0; t < solver->patch->nt; t++) {
        const double *Lambda = &solver->hessian[3 * (int64_t)t];
        double *z = &solver->delta[3 * (int64_t)t], y[3], mean = 0.0;
        const double inverse = sl_abf_inverse_det(Lambda);
        sl_abf_project(Lambda, inverse, z, y);
        for (int k = 0; k < 3; k++) {
            const double q = Lambda[(k + 1) % 3] * Lambda[(k + 2) % 3] * inverse;
            mean += q * z[k];
            z[k] = -y[k] - solver->g1[t] * q;
        }
        solver->dlambda1[t] = solver->g1[t] * Lambda[0] * Lambda[1] * Lambda[2] * inverse - mean;
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
        solver->lambda1[t] += step * solver->dlambda1[t];
    }
    for (int32_t r = 0; r < solver->system.nrows; r++) {
        solver->lambda2[r] += step * solver->rhs[r];
    }
}

/* dalpha in delta, dlambda in dlambda1 and rhs. */
static sl_status solve_system(sl_abf *solver)
{
    const bool exact = solver->def.newton == SL_ABF_EXACT && solver->def.wheel != SL_ABF_LOG;
    set_hessian(solver);
    sl_abf_system_assemble(&solver->system, solver->hessian);
    const sl_status status = sl_cholesky_factor(solver->factor, solver->system.M, NULL);
    if (status != SL_OK) {
        return status;
    }
    if (exact && solver->def.wheel == SL_ABF_PRODUCT) {
        shift_gradient(solver);
    }
    reduce(solver);
    sl_cholesky_solve(solver->factor, solver->rhs, 1, solver->work);
    substitute_back(solver);
    if (exact) {
        shift_multipliers(solver);
    }
    return SL_OK;
}

/* The 1-norms of the residuals. */
static sl_abf_merit merit_of(const sl_abf *solver)
{
    sl_abf_merit merit = {.energy = solver->info.energy};
    for (int32_t t = 0; t < solver->patch->nt; t++) {
        merit.norm[0] += fabs(solver->g1[t]);
    }
    for (int32_t r = 0; r < solver->system.nrows; r++) {
        merit.norm[r < solver->system.nsectors ? 1 : 2] += fabs(solver->g[r]);
    }
    return merit;
}

/* Penalties that exceed every multiplier the step leads to: then it descends on the merit function. */
static void set_penalties(const sl_abf *solver, double penalty[3])
{
    penalty[0] = penalty[1] = penalty[2] = 0.0;
    for (int32_t t = 0; t < solver->patch->nt; t++) {
        penalty[0] = fmax(penalty[0], fabs(solver->lambda1[t] + solver->dlambda1[t]));
    }
    for (int32_t r = 0; r < solver->system.nrows; r++) {
        double *group = &penalty[r < solver->system.nsectors ? 1 : 2];
        *group = fmax(*group, fabs(solver->lambda2[r] + solver->rhs[r]));
    }
    for (int k = 0; k < 3; k++) {
        penalty[k] *= penalty_factor;
    }
}

static double weigh(const sl_abf_merit *merit, const double penalty[3])
{
    return merit->energy + penalty[0] * merit->norm[0] + penalty[1] * merit->norm[1] + penalty[2] * merit->norm[2];
}

/* Derivative of the merit function along delta. */
static double slope(const sl_abf *solver, const double penalty[3])
{
    const sl_abf_merit now = merit_of(solver);
    double sum = 0.0;
    for (int64_t c = 0; c < 3 * (int64_t)solver->patch->nt; c++) {
        sum += 2.0 * solver->w[c] * (solver->alpha[c] - solver->phi[c]) * solver->delta[c];
    }
    return sum - (weigh(&now, penalty) - now.energy);
}

/* Goes along delta until the merit function E + sum of penalties |g| is below the largest of its last values, halving
 * the step where it is not; the last halving is taken as it is. Source: Grippo, Lampariello, Lucidi 1986, "A
 * nonmonotone line search technique for Newton's method"; Han 1977 for the merit function. */
static double search_line(sl_abf *solver, double step)
{
    double penalty[3], reference = -INFINITY;
    set_penalties(solver, penalty);
    const double descent = fmin(slope(solver, penalty), 0.0);
    solver->history[solver->history_next++ % SL_ABF_HISTORY] = merit_of(solver);
    for (int32_t i = 0; i < SL_ABF_HISTORY && i < solver->history_next; i++) {
        reference = fmax(reference, weigh(&solver->history[i], penalty));
    }
    advance(solver, step);
    sl_abf_evaluate(solver);
    for (int halving = 0; halving < max_halvings; halving++) {
        const sl_abf_merit now = merit_of(solver);
        if (weigh(&now, penalty) <= reference + sufficient * step * descent + rounding * reference) {
            break;
        }
        step *= 0.5;
        advance(solver, -step);
        sl_abf_evaluate(solver);
    }
    return step;
}

sl_status sl_abf_newton_step(sl_abf *solver)
{
    const sl_status status = solve_system(solver);
    if (status != SL_OK && status != SL_NOT_POSITIVE_DEFINITE && status != SL_BAD_INPUT) {
        return status;
    }
    double step = status == SL_OK ? step_length(solver) : 0.0;
    if (step < shortest_step) {
        solver->info.stalled = true;
        sl_abf_evaluate(solver); /* solve_system may have shifted the gradient */
    } else {
        step = search_line(solver, step);
        solver->info.iterations++;
    }
    solver->info.step = step;
    watch_progress(solver);
    sl_abf_judge(solver);
    return SL_OK;
}
