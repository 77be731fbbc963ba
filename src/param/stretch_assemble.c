/* Gradient and projected Hessian of the energy, a strip of triangles at a time. */
#include "param/stretch_internal.h"

#include <math.h>
#include <string.h>

enum { CORNER_UNKNOWNS = 6 };

/* One strip at work. */
typedef struct strip {
    int32_t first, count; /* triangles */
    sl_strip_corners corners, force;
    double J[4][SL_STRIP], gradient[4][SL_STRIP];
    double element[SL_ELEMENT][SL_STRIP];
} strip;

static void scatter_force(const sl_patch *patch, const strip *s, double *sum)
{
    for (int32_t lane = 0; lane < s->count; lane++) {
        const int32_t *v = &patch->tri[3 * (int64_t)(s->first + lane)];
        for (int k = 0; k < 3; k++) {
            sum[2 * (int64_t)v[k]] += s->force[2 * k][lane];
            sum[2 * (int64_t)v[k] + 1] += s->force[2 * k + 1][lane];
        }
    }
}

static void scatter_elements(const int32_t *place, const strip *s, double *val)
{
    for (int32_t lane = 0; lane < s->count; lane++) {
        const int32_t *to = &place[SL_ELEMENT * (int64_t)(s->first + lane)];
        for (int e = 0; e < SL_ELEMENT; e++) {
            val[to[e]] += s->element[e][lane];
        }
    }
}

/* Triangles at lines, in the unknowns of their corners: K := B' K B. An unknown that two corners share has their
 * coupling twice, as entry (i, j) and as (j, i). */
static void change_basis(const sl_patch *patch, const sl_stretch_freedom *freedom, strip *s)
{
    for (int32_t lane = 0; lane < s->count; lane++) {
        const int32_t *v = &patch->tri[3 * (int64_t)(s->first + lane)];
        double K[CORNER_UNKNOWNS][CORNER_UNKNOWNS], KB[CORNER_UNKNOWNS][CORNER_UNKNOWNS];
        for (int i = 0; i < CORNER_UNKNOWNS; i++) {
            for (int j = 0; j < CORNER_UNKNOWNS; j++) {
                K[i][j] = s->element[sl_stretch_entry(i, j)][lane];
            }
        }
        for (int i = 0; i < CORNER_UNKNOWNS; i++) {
            for (int j = 0; j < CORNER_UNKNOWNS; j++) {
                const double *b = &freedom->basis[4 * (int64_t)v[j / 2] + 2 * (j % 2)];
                KB[i][j] = K[i][j - j % 2] * b[0] + K[i][j - j % 2 + 1] * b[1];
            }
        }
        for (int i = 0; i < CORNER_UNKNOWNS; i++) {
            const double *b = &freedom->basis[4 * (int64_t)v[i / 2] + 2 * (i % 2)];
            for (int j = 0; j <= i; j++) {
                const bool shared = i != j && freedom->unknown[2 * (int64_t)v[i / 2] + i % 2] ==
                                                  freedom->unknown[2 * (int64_t)v[j / 2] + j % 2];
                const double x = b[0] * KB[i - i % 2][j] + b[1] * KB[i - i % 2 + 1][j];
                s->element[sl_stretch_entry(i, j)][lane] = shared ? 2.0 * x : x;
            }
        }
    }
}

/* Softens the lanes that need it. False when none did. */
static bool soften(double cap, strip *s)
{
    bool any = false;
    for (int32_t lane = 0; lane < SL_STRIP; lane++) {
        double J[4], g[4];
        for (int k = 0; k < 4; k++) {
            J[k] = s->J[k][lane];
            g[k] = s->gradient[k][lane];
        }
        if (sl_stretch_soften(cap, J, g)) {
            any = true;
            for (int k = 0; k < 4; k++) {
                s->J[k][lane] = J[k];
                s->gradient[k][lane] = g[k];
            }
        }
    }
    return any;
}

void sl_stretch_assemble(const sl_patch *patch, const sl_stretch_rest *rest, const sl_stretch_freedom *freedom,
                         double w, double cap, const double *uv, sl_stretch_system *system, double *gradient,
                         double *force)
{
    const sl_stretch_kernels *kernels = rest->kernels;
    sl_csc *H = system->H;
    memset(H->val, 0, (size_t)(H->colptr[H->ncols] + 1) * sizeof *H->val);
    memset(gradient, 0, 2 * (size_t)patch->nv * sizeof *gradient);
    memset(force, 0, 2 * (size_t)patch->nv * sizeof *force);
    strip s;
    for (int32_t i = 0; i < rest->strips; i++) {
        s.first = i * SL_STRIP;
        s.count = rest->nt - s.first < SL_STRIP ? rest->nt - s.first : SL_STRIP;
        const double *weight = rest->strip[i].weight;
        memcpy(s.gradient, rest->strip[i].gradient, sizeof s.gradient);
        sl_stretch_gather(rest, patch->tri, uv, i, s.corners);
        kernels->jacobian(s.corners, s.gradient, s.J);
        kernels->force(w, weight, s.gradient, s.J, s.force);
        scatter_force(patch, &s, gradient);
        if (isfinite(cap)) {
            if (soften(cap, &s)) {
                kernels->force(w, weight, s.gradient, s.J, s.force);
            }
            scatter_force(patch, &s, force);
        }
        kernels->element(w, weight, s.gradient, s.J, s.element);
        if (freedom->basis != NULL) {
            change_basis(patch, freedom, &s);
        }
        scatter_elements(system->place, &s, H->val);
    }
    if (!isfinite(cap)) {
        memcpy(force, gradient, 2 * (size_t)patch->nv * sizeof *force);
    }
}
