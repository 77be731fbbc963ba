/* A snake coiled on the ground, its head raised over the coil; no symmetry. */
#include "geom/vec3.h"
#include "organic.h"
#include "sculpt.h"

#include <math.h>

static const double pi = 3.14159265358979323846;

enum { COILED = 31, RAISED = 7, HEAD = 5, STATIONS = COILED + RAISED + HEAD };

/* Half thickness at a share of the body: thin tail, thick middle, slender neck. */
static double thickness(double t)
{
    return 0.12 + 0.80 * sin(0.5 * pi * fmin(1.0, t / 0.45)) - 0.34 * fmax(0.0, (t - 0.50) / 0.50);
}

/* The tail lies outside, the coil winds inward and up a little, the neck rises and turns its head to +z. */
static void path(gen_station station[STATIONS])
{
    static const double head_step[HEAD] = {0.50, 0.55, 0.60, 0.55, 0.35};
    static const double head_high[HEAD] = {0.60, 0.68, 0.60, 0.44, 0.24},
                        head_wide[HEAD] = {0.80, 1.12, 1.00, 0.72, 0.38};
    double heading = 0.0, p[3] = {0.0, 0.0, 0.0};
    for (int k = 0; k < STATIONS; k++) {
        const double w = thickness(fmin(1.0, (k + 1.0) / (COILED + RAISED)));
        double wide = w, high = w;
        if (k < COILED) {
            const double t = (double)k / (COILED - 1), turn = 4.2 * pi * t - 0.35 * pi;
            const double r = 4.9 - 3.05 * t + 0.9 * (1.0 - t) * (1.0 - t);
            p[0] = r * sin(turn);
            p[1] = 0.68 * w + 1.15 * fmax(0.0, t - 0.40);
            p[2] = r * cos(turn);
            heading = turn + 0.5 * pi;
        } else {
            const double t = fmin(1.0, (k - COILED + 1.0) / RAISED);
            const double pitch = 1.25 * sin(pi * fmin(1.0, 1.1 * t)) - 0.22 * t;
            const double step = k < COILED + RAISED ? 0.76 : head_step[k - COILED - RAISED];
            p[0] += step * cos(pitch) * sin(heading - 1.05 * t);
            p[1] += step * sin(pitch);
            p[2] += step * cos(pitch) * cos(heading - 1.05 * t);
            wide = k < COILED + RAISED ? w : head_wide[k - COILED - RAISED];
            high = k < COILED + RAISED ? w : head_high[k - COILED - RAISED];
        }
        station[k] = (gen_station){{p[0], p[1], p[2]}, high, wide};
    }
}

static void add_eyes(gen_cage *cage, const gen_station *brow)
{
    double ahead[3], right[3];
    sl_vec3_sub(brow[1].centre, brow[0].centre, ahead);
    sl_vec3_cross(ahead, (const double[]){0.0, 1.0, 0.0}, right);
    const double norm = sl_vec3_norm(right);
    for (int side = -1; side <= 1; side += 2) {
        double at[3], out[3];
        for (int k = 0; k < 3; k++) {
            out[k] = side * right[k] / norm + (k == 1 ? 0.8 : 0.0);
            at[k] = 0.5 * (brow[0].centre[k] + brow[1].centre[k]) + 0.6 * out[k];
        }
        gen_bump(cage, at, out, 0.17);
    }
}

sl_status gen_snake(uint64_t seed, int32_t scale, sl_generated **out)
{
    (void)seed; /* nothing random */
    static const double at[3] = {-0.06, 0.0, 0.06}, ends[2] = {-0.25, -0.05};
    static const double front[4][3] = {{-0.03, -0.03, 0.0}, {0.03, -0.03, 0.0}, {-0.03, 0.03, 0.0}, {0.03, 0.03, 0.0}};
    gen_cage cage = {0};
    gen_station station[STATIONS];
    int32_t region[4];
    path(station);
    gen_cage_box(&cage, (const int32_t[]){2, 2, 1}, (const double *const[]){at, at, ends});
    const int32_t found = gen_pick(&cage, front, 4, region);
    double ahead[3];
    sl_vec3_sub(station[1].centre, station[0].centre, ahead);
    const double turn = atan2(ahead[0], ahead[2]);
    for (int64_t v = 0; v < cage.nv && !cage.failed; v++) { /* the box stands where the tail ends, facing along it */
        double *p = cage.xyz + 3 * v;
        const double x = p[0], z = p[2];
        p[0] = station[0].centre[0] + cos(turn) * x + sin(turn) * z;
        p[1] += station[0].centre[1];
        p[2] = station[0].centre[2] - sin(turn) * x + cos(turn) * z;
    }
    if (!cage.failed) {
        gen_cage_limb(&cage, region, found, (const double[]){0.0, 1.0, 0.0}, station, STATIONS);
        add_eyes(&cage, &station[STATIONS - 4]);
    }
    return gen_cage_finish(&cage, 1 + scale, out);
}
