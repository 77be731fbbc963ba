#include "pack/pack_internal.h"

#include <math.h>

/* A chart's bounding box once turned and scaled. */
typedef struct turned_box {
    double lo[2], hi[2];
} turned_box;

static void turn(const sl_profile *profile, double scale, const double *uv, double out[2])
{
    out[0] = scale * (profile->cosine * uv[0] - profile->sine * uv[1]);
    out[1] = scale * (profile->sine * uv[0] + profile->cosine * uv[1]);
}

static turned_box bounding_box(const sl_pack_chart *chart, const sl_profile *profile, double scale)
{
    turned_box box = {{HUGE_VAL, HUGE_VAL}, {-HUGE_VAL, -HUGE_VAL}};
    for (int32_t v = 0; v < chart->nv; v++) {
        double p[2];
        turn(profile, scale, chart->uv + 2 * (int64_t)v, p);
        for (int k = 0; k < 2; k++) {
            box.lo[k] = fmin(box.lo[k], p[k]);
            box.hi[k] = fmax(box.hi[k], p[k]);
        }
    }
    return box;
}

/* Lets segment ab count in every column it comes within `grow` of. */
static void cover_segment(sl_profile *profile, const double a[2], const double b[2], double grow, double cell)
{
    const double *left = a[0] <= b[0] ? a : b, *right = a[0] <= b[0] ? b : a;
    const int32_t first = (int32_t)fmax(0.0, floor((left[0] - grow) / cell));
    const int32_t last = (int32_t)fmin(profile->columns - 1.0, floor((right[0] + grow) / cell));
    const double run = right[0] - left[0], slope = run > 0.0 ? (right[1] - left[1]) / run : 0.0;
    for (int32_t j = first; j <= last; j++) {
        const double x0 = fmax(left[0], j * cell - grow), x1 = fmin(right[0], (j + 1) * cell + grow);
        double y0 = left[1] + slope * (x0 - left[0]), y1 = left[1] + slope * (x1 - left[0]);
        if (run <= 0.0) {
            y0 = left[1];
            y1 = right[1];
        }
        profile->low[j] = fmin(profile->low[j], fmin(y0, y1) - grow);
        profile->high[j] = fmax(profile->high[j], fmax(y0, y1) + grow);
    }
}

bool sl_profile_make(const sl_pack_chart *chart, double angle, double scale, double grow, double cell, int32_t capacity,
                     sl_profile *out)
{
    out->cosine = cos(angle);
    out->sine = sin(angle);
    const turned_box box = bounding_box(chart, out, scale);
    const double width = box.hi[0] - box.lo[0] + 2.0 * grow;
    if (!(width <= capacity * cell)) {
        return false;
    }
    out->columns = (int32_t)fmax(1.0, fmin(capacity, ceil(width / cell)));
    out->height = box.hi[1] - box.lo[1] + 2.0 * grow;
    out->origin[0] = grow - box.lo[0];
    out->origin[1] = grow - box.lo[1];
    for (int32_t j = 0; j < out->columns; j++) {
        out->low[j] = HUGE_VAL;
        out->high[j] = -HUGE_VAL;
    }
    for (int32_t t = 0; t < chart->nt; t++) {
        double p[3][2];
        for (int k = 0; k < 3; k++) {
            turn(out, scale, chart->uv + 2 * (int64_t)chart->tri[3 * (int64_t)t + k], p[k]);
            p[k][0] += out->origin[0];
            p[k][1] += out->origin[1];
        }
        for (int k = 0; k < 3; k++) {
            cover_segment(out, p[k], p[(k + 1) % 3], grow, cell);
        }
    }
    for (int32_t j = 0; j < out->columns; j++) { /* a column that rounding left empty is taken whole */
        if (!(out->low[j] <= out->high[j])) {
            out->low[j] = 0.0;
            out->high[j] = out->height;
        }
    }
    return true;
}
