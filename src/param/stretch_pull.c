/* Pins: springs that bring vertices to places of their own. */
#include "param/stretch_internal.h"

#include <math.h>

/* Stiffness, a unit of area: a map of energy 4 holds a pin back by about 1e-6 of the chart's size. */
static const double PULL = 1e6;

static bool is_on_line(const sl_stretch_def *def, int32_t vertex)
{
    for (int32_t l = 0; l < def->line_count; l++) {
        for (int32_t i = 0; i < def->line[l].count; i++) {
            if (def->line[l].vertex[i] == vertex) {
                return true;
            }
        }
    }
    return false;
}

bool sl_stretch_pull_is_valid(const sl_stretch_def *def, int32_t nv)
{
    for (int32_t i = 0; i < def->pin_count; i++) {
        const sl_pin *pin = &def->pin[i];
        if (pin->vertex < 0 || pin->vertex >= nv || !isfinite(pin->uv[0]) || !isfinite(pin->uv[1])) {
            return false;
        }
        if ((def->fixed != NULL && def->fixed[pin->vertex] != 0) || is_on_line(def, pin->vertex)) {
            return false;
        }
        for (int32_t j = 0; j < i; j++) {
            if (def->pin[j].vertex == pin->vertex) {
                return false;
            }
        }
    }
    return true;
}

static double squared_distance(const sl_pin *pin, const double *uv)
{
    const double x = uv[2 * (int64_t)pin->vertex] - pin->uv[0], y = uv[2 * (int64_t)pin->vertex + 1] - pin->uv[1];
    return x * x + y * y;
}

double sl_stretch_pull_energy(const sl_stretch_def *def, double area, const double *uv)
{
    double sum = 0.0;
    for (int32_t i = 0; i < def->pin_count; i++) {
        sum += squared_distance(&def->pin[i], uv);
    }
    return 0.5 * PULL / area * sum;
}

double sl_stretch_pull_distance(const sl_stretch_def *def, const double *uv)
{
    double most = 0.0;
    for (int32_t i = 0; i < def->pin_count; i++) {
        most = fmax(most, sqrt(squared_distance(&def->pin[i], uv)));
    }
    return most;
}

void sl_stretch_pull_assemble(const sl_stretch_def *def, double area, const sl_stretch_freedom *freedom,
                              const double *uv, sl_stretch_system *system, double *gradient, double *force)
{
    sl_csc *H = system->H;
    for (int32_t i = 0; i < def->pin_count; i++) {
        for (int k = 0; k < 2; k++) {
            const int64_t at = 2 * (int64_t)def->pin[i].vertex + k;
            const int32_t unknown = freedom->unknown != NULL ? freedom->unknown[at] : (int32_t)at;
            const double pull = PULL / area * (uv[at] - def->pin[i].uv[k]);
            gradient[at] += pull;
            force[at] += pull;
            H->val[H->colptr[unknown]] += PULL / area;
        }
    }
}
