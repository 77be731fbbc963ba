/* How far a chart is from an isometry, as sums over its triangles. */
#include "optimize/optimize_internal.h"

#include <math.h>

double sl_opt_stretch(const sl_opt_sums *sums)
{
    return sqrt(sums->inverse * sums->plane) - sums->space;
}

/* I = |J|^2 and d = det J of triangle t of the patch. */
static void invariants(const sl_opt_surface *surface, const sl_patch *patch, const double *uv, int32_t t, double *I,
                       double *d)
{
    const double *rest = surface->rest + 3 * (int64_t)patch->facet[t];
    const double *a = uv + 2 * (int64_t)patch->tri[3 * t], *b = uv + 2 * (int64_t)patch->tri[3 * t + 1];
    const double *c = uv + 2 * (int64_t)patch->tri[3 * t + 2];
    const double inv1 = 1.0 / rest[0], inv2 = 1.0 / rest[2];
    const double j00 = (b[0] - a[0]) * inv1, j10 = (b[1] - a[1]) * inv1;
    const double j01 = (c[0] - a[0] - rest[1] * j00) * inv2, j11 = (c[1] - a[1] - rest[1] * j10) * inv2;
    *I = j00 * j00 + j01 * j01 + j10 * j10 + j11 * j11;
    *d = j00 * j11 - j01 * j10;
}

/* s1/s2 - 1 from I / d = s1/s2 + s2/s1. */
static double shear_of(double I, double d)
{
    const double m = I / d;
    return m > 2.0 ? 0.5 * (m + sqrt((m - 2.0) * (m + 2.0))) - 1.0 : 0.0;
}

void sl_opt_measure(const sl_opt_surface *surface, const sl_patch *patch, const double *uv, sl_opt_sums *sums,
                    double *density)
{
    *sums = (sl_opt_sums){0};
    for (int32_t t = 0; t < patch->nt; t++) {
        if (surface->measured[patch->facet[t]] == 0) {
            continue;
        }
        const double area = surface->area[patch->facet[t]];
        double I, d;
        invariants(surface, patch, uv, t, &I, &d);
        sums->space += area;
        sums->plane += d > 0.0 ? area * d : 0.0;
        sums->inverse += d > 0.0 ? area * 0.5 * I / (d * d) : HUGE_VAL;
        sums->shear += d > 0.0 ? area * shear_of(I, d) : HUGE_VAL;
    }
    if (density == NULL) {
        return;
    }
    /* sqrt(I a) = (I k + a / k) / 2 with k = sqrt(a / I): each triangle's part is not negative */
    const double k = sums->inverse > 0.0 ? sqrt(sums->plane / sums->inverse) : 1.0;
    for (int32_t t = 0; t < patch->nt; t++) {
        density[2 * t] = density[2 * t + 1] = 0.0;
        if (surface->measured[patch->facet[t]] != 0) {
            const double area = surface->area[patch->facet[t]];
            double I, d;
            invariants(surface, patch, uv, t, &I, &d);
            density[2 * t] = area * (0.5 * (0.5 * I / (d * d) * k + d / k) - 1.0);
            density[2 * t + 1] = area * shear_of(I, d);
        }
    }
}

double sl_opt_best_scale(const sl_opt_sums *sums)
{
    return sums->plane > 0.0 && sums->inverse > 0.0 ? pow(sums->inverse / sums->plane, 0.25) : 1.0;
}
