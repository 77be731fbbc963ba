/* The constraints of ABF++ as functions of the planar angles alpha (corner c = 3 t + k of triangle t). */
#include <math.h>

#include "param/abf_internal.h"

static const double pi = 3.14159265358979323846;
static const int32_t quotients_per_log = 8;

/**
 * Triangle validity residuals g1.
 *
 *     g1[t] = alpha[3 t] + alpha[3 t + 1] + alpha[3 t + 2] - pi
 *
 * @param[in]  alpha planar corner angles [rad], length 3 nt
 * @param[out] g1    residuals [rad], length nt
 *
 * No allocation, cannot fail. O(nt).  Source: What you seam is what you get, Eq. 2.
 */
void sl_abf_eval_g1(const sl_patch *patch, const double *alpha, double *g1)
{
    for (int32_t t = 0; t < patch->nt; t++) {
        const double *a = &alpha[3 * (int64_t)t];
        g1[t] = a[0] + a[1] + a[2] - pi;
    }
}

/**
 * Planarity residuals g2 of all constrained vertex sectors.
 *
 *     g2[s] = sum of alpha[c] over corners c of sector s  -  theta[s]
 *
 * A sector is a run of corners around one vertex. One formula covers every case of the paper: interior vertex,
 * theta = 2 pi (Eq. 3); straight line, two sectors with theta = pi (Eqs. 5-6); two crossing lines, four sectors with
 * theta = pi/2; border angle, theta given by the user (Sec. 4.2).
 *
 * @param[in]  sectors  CSR table: corners of s are corner[first[s] .. first[s+1]-1]
 * @param[in]  alpha    planar corner angles [rad], length 3 nt
 * @param[out] g2       residuals [rad], length sectors->count, must not overlap alpha
 *
 * No allocation, cannot fail. O(corners). Fixed summation order.
 * Source: What you seam is what you get, Sec. 4.2.  Deviations: none.
 */
void sl_abf_eval_g2(const sl_sectors *sectors, const double *alpha, double *g2)
{
    for (int32_t s = 0; s < sectors->count; s++) {
        double sum = 0.0;
        for (int32_t p = sectors->first[s]; p < sectors->first[s + 1]; p++) {
            sum += alpha[sectors->corner[p]];
        }
        g2[s] = sum - sectors->theta[s];
    }
}

/* One wheel, counter-clockwise; next and prev are the corners after and before the hub in each of its triangles. The
 * log form takes one logarithm for every eight quotients, which do not overflow for any angles that doubles can hold
 * apart from 0 and pi. sine: of each corner, NULL = to be computed. */
static double wheel_residual(const sl_patch *patch, int32_t v, sl_abf_wheel wheel, const double *alpha,
                             const double *sine)
{
    const int32_t start = patch->outgoing[v];
    int32_t c = start, factors = 0;
    double sum = 0.0, ratio = 1.0, next = 1.0, prev = 1.0;
    do {
        const int32_t n = sl_corner_next(c), p = sl_corner_prev(c);
        const double s_next = sine != NULL ? sine[n] : sin(alpha[n]);
        const double s_prev = sine != NULL ? sine[p] : sin(alpha[p]);
        if (wheel == SL_ABF_PRODUCT) {
            next *= s_next;
            prev *= s_prev;
        } else {
            ratio *= s_next / s_prev;
        }
        if (wheel == SL_ABF_LOG && ++factors % quotients_per_log == 0) {
            sum += log(ratio);
            ratio = 1.0;
        }
        c = sl_corner_rotate(patch, c);
    } while (c != start);
    return wheel == SL_ABF_LOG ? sum + log(ratio) : wheel == SL_ABF_PRODUCT ? next - prev : ratio - 1.0;
}

static void all_wheels(const sl_patch *patch, sl_abf_wheel wheel, const double *alpha, const double *sine, double *g3)
{
    int32_t i = 0;
    for (int32_t v = 0; v < patch->nv; v++) {
        if (patch->border[v] == 0) {
            g3[i++] = wheel_residual(patch, v, wheel, alpha, sine);
        }
    }
}

/**
 * Reconstruction residuals g3 of all interior vertices, in vertex order.
 *
 *     log form:      g3[v] = sum over triangles around v of  log sin alpha_next - log sin alpha_prev
 *     product form:  g3[v] = prod over them of sin alpha_next  -  prod of sin alpha_prev
 *     ratio form:    g3[v] = prod over them of sin alpha_next / sin alpha_prev  -  1
 *
 * alpha_next, alpha_prev: the corners after and before the one at v. All vanish iff the edges around v close up.
 *
 * @param[in]  alpha planar corner angles [rad], length 3 nt, in (0, pi)
 * @param[out] g3    residuals, one per interior vertex, must not overlap alpha
 *
 * No allocation, cannot fail. O(corners). Fixed summation order.
 * Source: What you seam is what you get, Eq. 4; Sheffer et al. 2005.  Deviations: the log form is the default.
 */
void sl_abf_eval_g3(const sl_patch *patch, sl_abf_wheel wheel, const double *alpha, double *g3)
{
    all_wheels(patch, wheel, alpha, NULL, g3);
}

void sl_abf_system_eval_g3(const sl_abf_system *system, sl_abf_wheel wheel, double *g3)
{
    all_wheels(system->patch, wheel, NULL, system->sine, g3);
}
