/* Measured angles, optimal angles and weights. */
#include <math.h>

#include "geom/vec3.h"
#include "param/abf_internal.h"

static const double pi = 3.14159265358979323846;
static const double full_turn = 6.283185307179586476925287;

sl_abf_def sl_abf_default(void)
{
    return (sl_abf_def){
        .energy = SL_ABF_WEIGHTED,
        .wheel = SL_ABF_LOG,
        .newton = SL_ABF_DROPPED,
        .sectors = NULL,
        .max_iterations = 40,
        .gradient_tolerance = 1e-6,
        .accept_gradient = 1e-5,
        .constraint_tolerance = 1e-11,
        .accept_constraint = 1e-9,
        .min_angle = 0.1 * 3.14159265358979323846 / 180.0,
    };
}

/* edge[k] runs from corner k to the next one; `zero` of the three have no length. */
static void degenerate_angles(const double length[3], int zero, double beta[3])
{
    for (int k = 0; k < 3; k++) {
        const bool beside = length[k] == 0.0 || length[(k + 2) % 3] == 0.0;
        beta[k] = zero == 3 ? pi / 3.0 : beside ? pi / 2.0 : 0.0;
    }
}

static void triangle_angles(const sl_patch *patch, int32_t t, double beta[3])
{
    double edge[3][3], length[3];
    int zero = 0;
    for (int k = 0; k < 3; k++) {
        const int32_t a = patch->tri[3 * (int64_t)t + k], b = patch->tri[3 * (int64_t)t + (k + 1) % 3];
        sl_vec3_sub(&patch->xyz[3 * (int64_t)b], &patch->xyz[3 * (int64_t)a], edge[k]);
        length[k] = sl_vec3_norm(edge[k]);
        zero += length[k] == 0.0;
    }
    if (zero > 0) {
        degenerate_angles(length, zero, beta);
        return;
    }
    for (int k = 0; k < 3; k++) {
        double normal[3];
        sl_vec3_cross(edge[k], edge[(k + 2) % 3], normal);
        beta[k] = atan2(sl_vec3_norm(normal), -sl_vec3_dot(edge[k], edge[(k + 2) % 3]));
    }
}

void sl_corner_angles(const sl_patch *patch, double *beta)
{
    for (int32_t t = 0; t < patch->nt; t++) {
        triangle_angles(patch, t, &beta[3 * (int64_t)t]);
    }
}

/* phi = beta 2 pi / (sum of beta around the vertex) where the surface closes around it. */
static void scale_around(const sl_patch *patch, int32_t v, double *phi)
{
    double sum = 0.0;
    const int32_t start = patch->outgoing[v];
    int32_t c = start;
    do {
        sum += phi[c];
        c = sl_corner_rotate(patch, c);
    } while (c != start);
    do {
        phi[c] *= full_turn / sum;
        c = sl_corner_rotate(patch, c);
    } while (c != start);
}

void sl_abf_targets(const sl_patch *patch, const sl_abf_def *def, double *phi, double *w)
{
    const int64_t nc = 3 * (int64_t)patch->nt;
    sl_corner_angles(patch, phi);
    for (int64_t c = 0; c < nc; c++) {
        phi[c] = fmax(phi[c], def->min_angle);
    }
    for (int32_t v = 0; v < patch->nv; v++) {
        if (patch->border[v] == 0) {
            scale_around(patch, v, phi);
        }
    }
    for (int64_t c = 0; c < nc; c++) {
        w[c] = def->energy == SL_ABF_WEIGHTED ? 1.0 / (phi[c] * phi[c]) : 1.0;
    }
}
