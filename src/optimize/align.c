/* How the two banks of a window lie to each other in the plane. */
#include "optimize/optimize_internal.h"

#include <math.h>

/* Sums over a window's points for the rigid motion that brings its right bank to its left one. */
typedef struct alignment {
    double mass, left[2], right[2], dot, cross, square;
} alignment;

static void add_point(const sl_opt_state *state, int32_t l, int32_t r, double mass, alignment *a)
{
    const double *p = state->uv + 2 * (int64_t)l, *q = state->uv + 2 * (int64_t)r;
    a->mass += mass;
    for (int k = 0; k < 2; k++) {
        a->left[k] += mass * p[k];
        a->right[k] += mass * q[k];
    }
    a->dot += mass * (p[0] * q[0] + p[1] * q[1]);
    a->cross += mass * (q[0] * p[1] - q[1] * p[0]);
    a->square += mass * (p[0] * p[0] + p[1] * p[1] + q[0] * q[0] + q[1] * q[1]);
}

/* The banks as they lie: left is the chart old[0]'s. */
static alignment sum_points(const sl_opt_state *state, const sl_opt_trial *trial)
{
    const int32_t *twin = state->surface->patch->twin;
    alignment a = {0};
    for (int32_t k = 0; k < trial->nedge; k++) {
        const int32_t h = trial->edge[k], g = twin[h];
        const double mass = 0.5 * state->surface->length[h];
        add_point(state, h, sl_corner_next(g), mass, &a);
        add_point(state, sl_corner_next(h), g, mass, &a);
    }
    return a;
}

double sl_opt_align(const sl_opt_state *state, const sl_opt_trial *trial, double motion[4])
{
    const alignment a = sum_points(state, trial);
    motion[0] = 1.0;
    motion[1] = motion[2] = motion[3] = 0.0;
    if (!(a.mass > 0.0)) {
        return 0.0;
    }
    if (trial->old[1] < 0) { /* within one chart nothing can move */
        return sqrt(fmax(a.square - 2.0 * a.dot, 0.0) / a.mass);
    }
    const double ll = a.left[0] * a.left[0] + a.left[1] * a.left[1];
    const double rr = a.right[0] * a.right[0] + a.right[1] * a.right[1];
    const double dot = a.dot - (a.left[0] * a.right[0] + a.left[1] * a.right[1]) / a.mass;
    const double cross = a.cross - (a.right[0] * a.left[1] - a.right[1] * a.left[0]) / a.mass;
    const double turn = hypot(dot, cross);
    if (turn > 0.0) {
        motion[0] = dot / turn;
        motion[1] = cross / turn;
    }
    motion[2] = (a.left[0] - motion[0] * a.right[0] + motion[1] * a.right[1]) / a.mass;
    motion[3] = (a.left[1] - motion[1] * a.right[0] - motion[0] * a.right[1]) / a.mass;
    return sqrt(fmax(a.square - (ll + rr) / a.mass - 2.0 * turn, 0.0) / a.mass);
}
