/* One iteration of the minimiser: a direction, how far along it, and what that says. */
#include "param/stretch_solver_internal.h"

#include <math.h>
#include <string.h>

static const double STEP_SHARE = 0.9; /* of the step to the first flip */
static const double ARMIJO = 1e-4;
static const double NEGLIGIBLE = 1e-2; /* of the decrease asked for */
static const double LONGER = 1.15;     /* a step is doubled where the parabola along it has its least beyond that */

/* A plain Newton step from afar is stopped short by a few triangles that would flip; the softened one is not. The two
 * take turns by what the last step gained. */
static const double SOFT_CAP = 1.0; /* bound on |ln s|: singular values within 0.37 and 2.7 */
static const double SOFT_GAIN = 0.03, PLAIN_GAIN = 0.05;

enum {
    MAX_HALVINGS = 40, /* of a step: 1e-12 of the first trial */
    MAX_DOUBLINGS = 10 /* of a full step */
};

/* trial = uv + length direction, accepted if flip-free, its border simple and its energy low enough. */
static sl_status try_length(sl_stretch *s, double length, double slope, bool *accepted, sl_stretch_sums *sums)
{
    *accepted = false;
    for (int64_t i = 0; i < 2 * (int64_t)s->patch->nv; i++) {
        s->trial[i] = s->uv[i] + length * s->direction[i];
    }
    *sums = sl_stretch_measure_map(s, s->trial);
    if (!(sums->energy <= s->energy + ARMIJO * length * slope) ||
        (!sums->sure && !sl_stretch_all_positive(s->patch, s->trial))) {
        return SL_OK;
    }
    return sl_stretch_border_is_simple(s, s->trial, accepted);
}

/* After an accepted full step: longer ones where the parabola through what is known has its least value well beyond it.
 * The best map so far is kept in spare meanwhile, and ends in trial. */
static sl_status lengthen(sl_stretch *s, double slope, double bound, sl_stretch_sums *sums)
{
    const double bend = sums->energy - s->energy - slope; /* E(t) = E + slope t + bend t^2 */
    sl_status status = SL_OK;
    double length = 1.0;
    bool better = -slope > LONGER * 2.0 * bend;
    for (int i = 0; i < MAX_DOUBLINGS && better && 2.0 * length <= bound && status == SL_OK; i++) {
        sl_stretch_sums longer;
        sl_stretch_swap(&s->trial, &s->spare);
        status = try_length(s, 2.0 * length, slope, &better, &longer);
        better = status == SL_OK && better && longer.energy < sums->energy;
        if (better) {
            length *= 2.0;
            *sums = longer;
        } else {
            sl_stretch_swap(&s->trial, &s->spare);
        }
    }
    return status;
}

/* Backtracks from 0.9 of the flip-free step; where a full step did well, tries longer ones (a projected Hessian is too
 * stiff where the energy is not convex). *moved = false when no length will do; else trial and *sums hold the result.
 */
static sl_status line_search(sl_stretch *s, double slope, bool *moved, sl_stretch_sums *sums)
{
    const double bound = STEP_SHARE * sl_stretch_step_bound(&s->store->rest, s->patch->tri, s->uv, s->direction);
    double length = fmin(1.0, bound);
    *moved = false;
    for (int i = 0; i < MAX_HALVINGS && !*moved; i++) {
        const sl_status status = try_length(s, length, slope, moved, sums);
        if (status != SL_OK) {
            return status;
        }
        length *= *moved ? 1.0 : 0.5;
    }
    return *moved && length == 1.0 ? lengthen(s, slope, bound, sums) : SL_OK;
}

static double dot(int64_t count, const double *a, const double *b)
{
    double sum = 0.0;
    for (int64_t i = 0; i < count; i++) {
        sum += a[i] * b[i];
    }
    return sum;
}

/* The projected Newton direction, softened or not. SL_NOT_POSITIVE_DEFINITE when there is none. */
static sl_status newton_direction(sl_stretch *s, bool softened)
{
    const sl_stretch_rest *rest = &s->store->rest;
    sl_stretch_system *system = &s->store->system;
    sl_stretch_assemble(s->patch, rest, &s->freedom, s->def.w, softened ? SOFT_CAP : INFINITY, s->uv, system,
                        s->gradient, s->force);
    sl_stretch_pull_assemble(&s->def, rest->total, &s->freedom, s->uv, system, s->gradient, s->force);
    return sl_stretch_direction(&s->freedom, system, s->force, s->direction);
}

/* A step along the projected Newton direction. *moved = false when there is none to take. */
static sl_status move(sl_stretch *s, bool softened, bool *moved, sl_stretch_sums *sums)
{
    const int64_t count = 2 * (int64_t)s->patch->nv;
    *moved = false;
    const sl_status status = newton_direction(s, softened);
    if (status != SL_OK) {
        return status == SL_NOT_POSITIVE_DEFINITE ? SL_OK : status;
    }
    const double slope = dot(count, s->gradient, s->direction);
    if (!sl_stretch_all_finite(count, s->direction) || !(slope < 0.0)) {
        s->info.converged = slope == 0.0;
        return SL_OK;
    }
    if (!softened && -slope < NEGLIGIBLE * s->def.relative_decrease * s->energy) {
        s->info.converged = true; /* not even the linear model promises enough */
        return SL_OK;
    }
    return line_search(s, slope, moved, sums);
}

/* After a step that lowered the energy by the share `gain`. */
static bool is_hopeless(const sl_stretch *s, double gain)
{
    const sl_stretch_def *def = &s->def;
    if (def->most_l2 > 0.0 && s->info.l2 > def->most_l2) {
        return true;
    }
    if (def->hopeless_l2 > 0.0 && s->info.iterations >= def->hopeless_after && s->info.l2 > def->hopeless_l2) {
        return true;
    }
    return def->hopeless_gain > 0.0 && def->target_l2 > 0.0 &&
           s->info.l2 * (1.0 - def->hopeless_gain * gain) > def->target_l2;
}

/* Books an accepted step and says whether to go on. */
static void accept(sl_stretch *s, bool softened, sl_stretch_sums sums)
{
    const double gain = (s->energy - sums.energy) / s->energy;
    sl_stretch_swap(&s->uv, &s->trial);
    s->energy = sums.energy;
    sl_stretch_take_stock(s, sums);
    const bool far = s->info.energy_after > SL_STRETCH_FAR_ENERGY;
    s->softened = far && (softened ? gain >= SOFT_GAIN : gain < PLAIN_GAIN);
    s->info.iterations++;
    if (softened) {
        s->soft_gain = gain;
    }
    /* Far from the minimum a small gain says something only if neither kind of step gained more. */
    const double recent = softened ? 1.0 : far ? fmax(gain, s->soft_gain) : gain;
    const bool reached = s->def.target_l2 > 0.0 && sums.l2 <= s->def.target_l2 && s->def.pin_count == 0;
    s->info.converged = reached || recent < s->def.relative_decrease;
    s->info.hopeless = !s->info.converged && is_hopeless(s, recent);
    s->done = s->info.converged || s->info.hopeless;
}

sl_status sl_stretch_iterate(sl_stretch *s)
{
    bool moved = false, softened = s->softened;
    sl_stretch_sums sums = {0};
    sl_status status = move(s, softened, &moved, &sums);
    if (status == SL_OK && !moved && softened) { /* the softened direction may lead uphill */
        softened = false;
        s->soft_gain = 0.0;
        status = move(s, false, &moved, &sums);
    }
    if (status != SL_OK || !moved) {
        s->done = true;
        return status;
    }
    accept(s, softened, sums);
    return SL_OK;
}
