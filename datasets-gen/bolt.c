/* A bolt with a hexagonal head and ring-shaped threads; its two ends are polygons of many corners. */
#include "base/memory.h"
#include "grid.h"
#include "models.h"
#include "plant.h"

#include <math.h>

static const double pi = 3.14159265358979323846;
static const double shaft = 0.42, head = 0.78, head_height = 0.5, neck = 0.7;

enum { THREADS = 14, PER_THREAD = 4, HEAD_STEPS = 5, NECK_STEPS = 6, UNDER_STEPS = 3 };

/* From a hexagon of inner radius `head` (share 1) to a circle (share 0). */
static double hexagon(double turn, double r, double share)
{
    const double sixth = pi / 3.0, angle = 2.0 * pi * turn;
    const double from_middle = angle - sixth * floor(angle / sixth + 0.5);
    return r * (1.0 - share + share / cos(from_middle));
}

/* Station i along the outline from the end of the thread to the head's top. */
static void station(int32_t i, double *r, double *y, double *share)
{
    const int32_t threads = THREADS * PER_THREAD;
    *share = 0.0;
    if (i <= threads) {
        const double wave = 0.5 - 0.5 * cos(2.0 * pi * i / PER_THREAD);
        *y = -0.13 * (threads - i) / PER_THREAD - neck;
        *r = shaft * (1.0 - 0.16 * (i == threads ? 0.0 : 1.0 - wave)) - (i == 0 ? 0.06 : 0.0);
    } else if (i <= threads + NECK_STEPS) {
        *y = -neck * (threads + NECK_STEPS - i) / NECK_STEPS;
        *r = shaft;
    } else if (i <= threads + NECK_STEPS + UNDER_STEPS) {
        *share = (double)(i - threads - NECK_STEPS) / UNDER_STEPS;
        *y = 0.0;
        *r = shaft + (head - shaft) * *share;
    } else {
        const double up = (double)(i - threads - NECK_STEPS - UNDER_STEPS) / HEAD_STEPS;
        *share = up > 0.9 ? 0.0 : 1.0;
        *y = head_height * up;
        *r = head * (up > 0.9 ? 0.9 : 1.0);
    }
}

static void bolt_point(const void *data, double u, double v, double p[3])
{
    (void)data;
    const int32_t stations = THREADS * PER_THREAD + NECK_STEPS + UNDER_STEPS + HEAD_STEPS;
    const double at = v * stations;
    const int32_t i = at >= stations ? stations - 1 : (int32_t)(at + 1e-6);
    const double c = at - i < 1e-6 ? 0.0 : at - i; /* flat sides stay flat to the bit */
    double r[2], y[2], share[2];
    station(i, &r[0], &y[0], &share[0]);
    station(i + 1, &r[1], &y[1], &share[1]);
    const double here = (1.0 - c) * hexagon(u, r[0], share[0]) + c * hexagon(u, r[1], share[1]);
    p[0] = here * cos(2.0 * pi * u);
    p[1] = (1.0 - c) * y[0] + c * y[1];
    p[2] = -here * sin(2.0 * pi * u);
}

sl_status gen_bolt(uint64_t seed, int32_t scale, sl_generated **out)
{
    (void)seed; /* nothing random */
    const int32_t around = gen_refined(36, scale);
    const int32_t along = gen_refined(THREADS * PER_THREAD + NECK_STEPS + UNDER_STEPS + HEAD_STEPS, scale);
    gen_builder b = {0};
    gen_grid(&b, around, along, bolt_point, NULL);
    int32_t *cap = sl_alloc(around, sizeof *cap);
    b.failed |= cap == NULL;
    for (int end = 0; end < 2 && cap != NULL; end++) {
        for (int32_t k = 0; k < around; k++) {
            cap[k] = end == 0 ? (around - 1 - k) * (along + 1) : k * (along + 1) + along;
        }
        gen_facet(&b, around, cap);
    }
    sl_free(cap);
    gen_weld(&b, gen_weld_tolerance);
    const sl_status status = gen_finish(&b, out);
    return status != SL_OK ? status : gen_planted(gen_plant_dihedral(*out, 1, 6, 0.0, true), out);
}
