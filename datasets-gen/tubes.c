/* Tubes along a path with a formula: a pipe bent to a U, a coil spring. */
#include "base/memory.h"
#include "grid.h"
#include "models.h"
#include "plant.h"

#include <math.h>

static const double pi = 3.14159265358979323846;

/* Legs from y = 0 down, half a turn between them. */
static const double bend_radius = 1.0, leg_length = 1.7, pipe_radius = 0.36;

/* u around, v along: from the end of one leg to the end of the other. */
static void pipe_point(const void *data, double u, double v, double p[3])
{
    (void)data;
    const double arc = pi * bend_radius, s = (v - 0.5) * (arc + 2.0 * leg_length);
    const double bend = fmax(-0.5 * arc, fmin(0.5 * arc, s)), angle = bend / bend_radius, rest = s - bend;
    const double r = pipe_radius * (1.0 + 0.22 * exp(-8.0 * (leg_length - fabs(rest)))); /* flared ends */
    const double out = r * cos(2.0 * pi * u), side = r * sin(2.0 * pi * u);
    p[0] = (bend_radius + out) * sin(angle);
    p[1] = (bend_radius + out) * cos(angle) - fabs(rest);
    p[2] = side;
}

sl_status gen_tube(uint64_t seed, int32_t scale, sl_generated **out)
{
    (void)seed; /* nothing random */
    gen_builder b = {0};
    gen_grid(&b, gen_refined(28, scale), gen_refined(96, scale), pipe_point, NULL);
    gen_weld(&b, gen_weld_tolerance);
    const sl_status status = gen_finish(&b, out);
    return status != SL_OK ? status : gen_planted(gen_plant_mirrors(*out, "xz", true), out);
}

static const double coil_radius = 1.0, coil_turns = 4.5, coil_pitch = 0.62, wire_radius = 0.17;

/* u around, v along. The frame is the helix's own, so that half a turn about x carries the coil onto itself. */
static void coil_point(const void *data, double u, double v, double p[3])
{
    (void)data;
    const double t = 2.0 * pi * coil_turns * (v - 0.5), rise = coil_pitch / (2.0 * pi);
    const double length = sqrt(coil_radius * coil_radius + rise * rise);
    const double c = cos(t), s = sin(t), inward = wire_radius * cos(2.0 * pi * u);
    const double across = wire_radius * sin(2.0 * pi * u) / length;
    p[0] = (coil_radius - inward) * c - across * s * rise;
    p[1] = rise * t - across * coil_radius;
    p[2] = (coil_radius - inward) * s + across * c * rise;
}

sl_status gen_spring(uint64_t seed, int32_t scale, sl_generated **out)
{
    (void)seed;
    const int32_t around = gen_refined(16, scale), along = gen_refined(56 * 4, scale);
    gen_builder b = {0};
    gen_grid(&b, around, along, coil_point, NULL);
    int32_t *cap[2] = {sl_alloc(around, sizeof **cap), sl_alloc(around, sizeof **cap)};
    if (cap[0] != NULL && cap[1] != NULL) {
        for (int32_t k = 0; k < around; k++) {
            cap[0][k] = (around - 1 - k) * (along + 1);
            cap[1][k] = k * (along + 1) + along;
        }
        gen_facet(&b, around, cap[0]);
        gen_facet(&b, around, cap[1]);
    } else {
        b.failed = true;
    }
    sl_free(cap[0]);
    sl_free(cap[1]);
    gen_weld(&b, gen_weld_tolerance);
    const sl_status status = gen_finish(&b, out);
    return status != SL_OK
               ? status
               : gen_planted(gen_plant_rotation(*out, "rotation x 1/2", (double[]){1.0, 0.0, 0.0}, pi, true), out);
}
