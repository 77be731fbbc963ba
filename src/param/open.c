#include "param/open.h"

#include "overlap/certificate.h"

#include <math.h>
#include <string.h>

static const double EDGE_LIMIT = 0.125; /* no vertex moves further, per shorter border edge at it */

/* Angle of triangle corner c under uv. */
static double corner_angle(const sl_patch *p, const double *uv, int32_t c)
{
    const double *o = uv + 2 * (int64_t)p->tri[c];
    const double *a = uv + 2 * (int64_t)p->tri[sl_corner_next(c)], *b = uv + 2 * (int64_t)p->tri[sl_corner_prev(c)];
    const double x[2] = {a[0] - o[0], a[1] - o[1]}, y[2] = {b[0] - o[0], b[1] - o[1]};
    return atan2(x[0] * y[1] - x[1] * y[0], x[0] * y[0] + x[1] * y[1]);
}

void sl_open_border(const sl_patch *patch, int32_t nb, const int32_t *border, const double *uv, double share,
                    double least, double *angle, double *out)
{
    memset(angle, 0, (size_t)patch->nv * sizeof *angle);
    for (int32_t c = 0; c < 3 * patch->nt; c++) {
        angle[patch->tri[c]] += corner_angle(patch, uv, c);
    }
    memcpy(out, uv, 2 * (size_t)patch->nv * sizeof *out);
    for (int32_t b = 0; b < nb; b++) { /* the one before b ends where b begins */
        const int32_t v = border[2 * (int64_t)b], before = b > 0 ? b - 1 : nb - 1;
        const double *here = uv + 2 * (int64_t)v, *next = uv + 2 * (int64_t)border[2 * (int64_t)b + 1];
        const double *last = uv + 2 * (int64_t)border[2 * (int64_t)before];
        const double x = next[0] - here[0], y = next[1] - here[1], length = hypot(x, y);
        const double edge = fmin(length, hypot(last[0] - here[0], last[1] - here[1]));
        const double shift = fmin(fmax(share * edge, least), EDGE_LIMIT * edge);
        const double c = cos(0.5 * angle[v]), s = sin(0.5 * angle[v]);
        if (length > 0.0) {
            out[2 * (int64_t)v] += shift * (c * x - s * y) / length;
            out[2 * (int64_t)v + 1] += shift * (s * x + c * y) / length;
        }
    }
}

sl_status sl_border_survives(int32_t nv, int32_t nb, const int32_t *border, const double *uv, double step,
                             double *rounded, bool *survives)
{
    sl_certificate certificate;
    for (int64_t i = 0; i < 2 * (int64_t)nv; i++) {
        rounded[i] = step > 0.0 ? rint((uv[i] - uv[i % 2]) / step) : 0.0;
    }
    const sl_status status = sl_certify_embedding(rounded, 0, NULL, nb, border, &certificate);
    *survives = status == SL_OK && certificate.border_crossings == 0;
    return status;
}
