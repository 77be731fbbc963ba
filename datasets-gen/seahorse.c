/* A seahorse upright, facing +z, with bony rings, a fin on its back and its tail in a spiral; symmetric about x = 0 to
 * the bit. */
#include "organic.h"
#include "sculpt.h"

#include <math.h>

static const double pi = 3.14159265358979323846;
static const double side_x[3] = {1.0, 0.0, 0.0};

enum { TAIL_STATIONS = 24, STRAIGHT = 7 };

static void add_trunk(gen_cage *cage)
{
    static const double x[2] = {0.0, 0.95}, y[2] = {7.2, 7.7}, z[3] = {-0.6, 0.5, 1.6};
    static const gen_station up[] = {
        {{0.0, 8.10, 0.40}, 0.98, 1.25},  {{0.0, 8.55, 0.25}, 1.10, 1.30},  {{0.0, 9.10, 0.05}, 0.86, 1.00},
        {{0.0, 9.60, -0.10}, 0.92, 1.00}, {{0.0, 10.2, -0.15}, 0.72, 0.80}, {{0.0, 10.8, 0.00}, 0.72, 0.80},
        {{0.0, 11.4, 0.35}, 0.80, 0.95},  {{0.0, 11.75, 1.05}, 0.88, 1.05}, {{0.0, 11.5, 1.75}, 0.66, 0.75},
        {{0.0, 11.2, 2.30}, 0.36, 0.40},  {{0.0, 10.95, 2.95}, 0.32, 0.34}, {{0.0, 10.72, 3.50}, 0.34, 0.36},
        {{0.0, 10.62, 3.75}, 0.22, 0.24},
    };
    static const double top[2][3] = {{0.4, 7.7, 0.0}, {0.4, 7.7, 1.0}};
    gen_cage_box(cage, (const int32_t[]){1, 1, 2}, (const double *const[]){x, y, z});
    gen_grow(cage, top, 2, side_x, up, (int32_t)SL_COUNTOF(up));
}

/* Down from the belly, then forward and inward on a spiral; every other station a ring. */
static void add_tail(gen_cage *cage)
{
    static const double bottom[2][3] = {{0.4, 7.2, 0.0}, {0.4, 7.2, 1.0}};
    gen_station station[TAIL_STATIONS];
    double p[2] = {7.2, 0.45}, pitch = -0.60 * pi;
    for (int k = 0; k < TAIL_STATIONS; k++) {
        const double t = (double)(k + 1) / TAIL_STATIONS, ring = k % 2 == 0 ? 1.10 : 0.92;
        const double step = k < STRAIGHT ? 0.56 : 0.56 * exp(-1.05 * (k - STRAIGHT) / (TAIL_STATIONS - STRAIGHT));
        const double w = (0.17 + 0.90 * pow(1.0 - t, 1.6)) * ring;
        pitch += k < STRAIGHT ? 0.015 * pi : 0.130 * pi;
        p[0] += step * sin(pitch);
        p[1] += step * cos(pitch);
        station[k] = (gen_station){{0.0, p[0], p[1]}, w, w * (k < 4 ? 1.30 - 0.06 * k : 1.05)};
    }
    gen_grow(cage, bottom, 2, side_x, station, TAIL_STATIONS);
}

static void add_details(gen_cage *cage)
{
    static const gen_station crown[] = {{{0.0, 12.75, 0.55}, 0.24, 0.36}, {{0.0, 13.2, 0.45}, 0.34, 0.42}};
    static const gen_station fin[] = {
        {{0.0, 8.85, -1.45}, 0.13, 1.05}, {{0.0, 8.95, -2.05}, 0.09, 1.25}, {{0.0, 8.95, -2.45}, 0.07, 1.00}};
    static const double head[1][3] = {{0.3, 12.5, 0.7}};
    static const double back[3][3] = {{0.3, 8.35, -1.0}, {0.3, 8.85, -1.0}, {0.3, 9.4, -0.9}};
    gen_grow(cage, head, 1, side_x, crown, (int32_t)SL_COUNTOF(crown));
    gen_grow(cage, back, 3, side_x, fin, (int32_t)SL_COUNTOF(fin));
    gen_bump(cage, (const double[]){0.8, 11.9, 1.4}, (const double[]){1.0, 0.2, 0.2}, 0.2);
}

sl_status gen_seahorse(uint64_t seed, int32_t scale, sl_generated **out)
{
    (void)seed; /* nothing random */
    gen_cage cage = {.mirrored = true};
    add_trunk(&cage);
    add_tail(&cage);
    add_details(&cage);
    return gen_finish_mirrored(&cage, 1 + scale, out);
}
