/* A spur gear with a bore. The teeth's flat sides are polygons of many corners. */
#include "base/memory.h"
#include "grid.h"
#include "models.h"
#include "plant.h"

#include <math.h>

static const double pi = 3.14159265358979323846;
static const double bore = 0.34, rim = 0.72, root = 0.92, tip = 1.16, half_width = 0.16, web = 0.09;

enum { TEETH = 16, STEPS = 8 }; /* steps around for each tooth and its gap */

/* Radius of the outline at t in [0, 1) of a tooth's pitch: gap, flank, tip, flank, gap. */
static double outline(double t)
{
    const double from_middle = fabs(t - 0.5), flat = 0.125, foot = 0.25;
    return from_middle <= flat   ? tip
           : from_middle >= foot ? root
                                 : tip + (root - tip) * (from_middle - flat) / (foot - flat);
}

/* Half the thickness at radius r: a web between hub and rim is thinner. */
static double half_thickness(double r)
{
    const double hub = 0.48, slope = 0.05;
    const double in = fmin(r - hub, rim - r) / slope;
    return half_width - web * fmax(0.0, fmin(1.0, in));
}

static const double radii[] = {0.34, 0.41, 0.48, 0.53, 0.60, 0.67, 0.72, 0.82, 0.92};

static double radius_at(double v)
{
    const double s = v * ((double)SL_COUNTOF(radii) - 1.0);
    const size_t k = s >= (double)SL_COUNTOF(radii) - 1.0 ? SL_COUNTOF(radii) - 2 : (size_t)s;
    return radii[k] + (s - (double)k) * (radii[k + 1] - radii[k]);
}

static void polar(double r, double turn, double height, double p[3])
{
    p[0] = r * cos(2.0 * pi * turn);
    p[1] = r * sin(2.0 * pi * turn);
    p[2] = height;
}

static void top_point(const void *data, double u, double v, double p[3])
{
    (void)data;
    const double r = radius_at(1.0 - v);
    polar(r, u, half_thickness(r), p);
}

static void bottom_point(const void *data, double u, double v, double p[3])
{
    (void)data;
    const double r = radius_at(v);
    polar(r, u, -half_thickness(r), p);
}

static void bore_point(const void *data, double u, double v, double p[3])
{
    (void)data;
    polar(bore, u, half_width * (1.0 - 2.0 * v), p);
}

static void outer_point(const void *data, double u, double v, double p[3])
{
    (void)data;
    const double t = u * TEETH;
    polar(outline(t - floor(t)), u, half_width * (2.0 * v - 1.0), p);
}

/* The flat side of tooth k: along the root circle and back along the outline. */
static void add_tooth_side(gen_builder *b, int32_t steps, int32_t k, bool top, int32_t *corner)
{
    const int32_t from = steps / 4, to = steps - from;
    int32_t n = 0;
    double p[3];
    for (int32_t i = from; i <= to; i++) {
        polar(root, (k + (double)i / steps) / TEETH, top ? half_width : -half_width, p);
        corner[n++] = gen_vertex(b, p[0], p[1], p[2]);
    }
    for (int32_t i = to - 1; i > from; i--) {
        const double t = (double)i / steps;
        polar(outline(t), (k + t) / TEETH, top ? half_width : -half_width, p);
        corner[n++] = gen_vertex(b, p[0], p[1], p[2]);
    }
    for (int32_t i = 0; top && i < n / 2; i++) { /* outward: the root circle last */
        const int32_t swap = corner[i];
        corner[i] = corner[n - 1 - i];
        corner[n - 1 - i] = swap;
    }
    gen_facet(b, n, corner);
}

sl_status gen_gear(uint64_t seed, int32_t scale, sl_generated **out)
{
    (void)seed; /* nothing random */
    const int32_t steps = gen_refined(STEPS, scale), around = TEETH * steps;
    const int32_t rings = gen_refined((int32_t)SL_COUNTOF(radii) - 1, scale), wide = gen_refined(4, scale);
    gen_builder b = {0};
    int32_t *corner = sl_alloc(2 * steps, sizeof *corner);
    b.failed = corner == NULL;
    if (!b.failed) {
        gen_grid(&b, around, rings, top_point, NULL);
        gen_grid(&b, around, rings, bottom_point, NULL);
        gen_grid(&b, around, wide, bore_point, NULL);
        gen_grid(&b, around, wide, outer_point, NULL);
        for (int32_t k = 0; k < 2 * TEETH; k++) {
            add_tooth_side(&b, steps, k / 2, k % 2 == 0, corner);
        }
    }
    sl_free(corner);
    gen_weld(&b, gen_weld_tolerance);
    sl_status status = gen_finish(&b, out);
    if (status == SL_OK) {
        status = gen_plant_mirrors(*out, "z", true);
        status = gen_planted(status == SL_OK ? gen_plant_dihedral(*out, 2, TEETH, 0.0, true) : status, out);
    }
    return status;
}
