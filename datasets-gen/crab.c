/* A crab facing +z: four walking legs, a claw, an eye on a stalk and an antenna a side, all out of one closed surface;
 * symmetric about x = 0 to the bit. */
#include "organic.h"
#include "sculpt.h"

#include <math.h>

static const double pi = 3.14159265358979323846;
static const double side_y[3] = {0.0, 1.0, 0.0}, side_z[3] = {0.0, 0.0, 1.0}, side_x[3] = {1.0, 0.0, 0.0};

enum { LEGS = 4, LEG_STATIONS = 5 };

/* A shield, wide and low, rounded in plan and domed. */
static void add_shell(gen_cage *cage)
{
    static const double x[4] = {0.0, 0.35, 1.45, 2.60}, y[3] = {0.0, 0.62, 1.15};
    static const double z[6] = {-1.75, -1.10, -0.40, 0.30, 1.00, 1.75};
    gen_cage_box(cage, (const int32_t[]){3, 2, 5}, (const double *const[]){x, y, z});
    for (int64_t v = 0; v < cage->nv && !cage->failed; v++) {
        double *p = cage->xyz + 3 * v;
        const double u = p[0] / 2.6, w = p[2] / 1.75, h = p[1];
        p[0] *= (h == 0.62 ? 1.12 : h == 0.0 ? 0.98 : 1.0) * sqrt(1.0 - 0.32 * w * w);
        p[2] *= (h == 0.0 ? 0.90 : 1.0) * (1.15 - 0.30 * u * u);
        p[1] = 1.25 + h +
               (h > 1.0    ? 0.55 * (1.0 - u * u) * (1.0 - 0.6 * w * w)
                : h == 0.0 ? -0.2 * (1.0 - u * u)
                           : 0.0);
    }
}

static void add_legs(gen_cage *cage)
{
    static const double cell[LEGS] = {-1.30, -0.72, -0.05, 0.62}, heading[LEGS] = {-38.0, -16.0, 6.0, 26.0};
    static const double reach[LEG_STATIONS] = {0.85, 1.75, 2.35, 3.25, 3.95};
    static const double height[LEG_STATIONS] = {1.72, 2.75, 2.60, 1.15, 0.02};
    static const double girth[LEG_STATIONS] = {0.40, 0.40, 0.42, 0.28, 0.08};
    for (int leg = 0; leg < LEGS; leg++) {
        const double angle = heading[leg] * pi / 180.0, size = leg == 0 ? 0.86 : 1.0;
        const double at[1][3] = {{2.7, 1.55, cell[leg]}};
        gen_station station[LEG_STATIONS];
        for (int k = 0; k < LEG_STATIONS; k++) {
            station[k] = (gen_station){
                {2.45 + size * reach[k] * cos(angle), height[k], 1.1 * cell[leg] + size * reach[k] * sin(angle)},
                girth[k],
                1.15 * girth[k]};
        }
        gen_grow(cage, at, 1, side_z, station, LEG_STATIONS);
    }
}

static void add_claw(gen_cage *cage)
{
    static const gen_station arm[] = {
        {{3.00, 1.75, 1.75}, 0.38, 0.42}, {{3.55, 1.80, 2.45}, 0.46, 0.50}, {{3.50, 1.85, 3.10}, 0.36, 0.36},
        {{3.25, 1.90, 3.60}, 0.70, 0.74}, {{2.85, 1.95, 4.40}, 0.90, 0.86}, {{2.42, 2.00, 5.10}, 0.44, 0.34},
        {{1.85, 2.00, 5.75}, 0.16, 0.12},
    };
    static const gen_station finger[] = {
        {{1.90, 1.95, 4.55}, 0.36, 0.30}, {{1.55, 1.97, 5.05}, 0.28, 0.22}, {{1.45, 2.0, 5.55}, 0.12, 0.10}};
    static const double shoulder[1][3] = {{2.4, 1.6, 1.25}}, palm[1][3] = {{2.5, 1.95, 3.9}};
    gen_grow(cage, shoulder, 1, side_y, arm, (int32_t)SL_COUNTOF(arm));
    gen_grow(cage, palm, 1, side_y, finger, (int32_t)SL_COUNTOF(finger));
}

static void add_feelers(gen_cage *cage)
{
    static const gen_station stalk[] = {
        {{0.80, 2.60, 2.10}, 0.20, 0.20}, {{0.84, 3.05, 2.15}, 0.38, 0.38}, {{0.86, 3.40, 2.16}, 0.34, 0.34}};
    static const gen_station antenna[] = {
        {{0.55, 1.65, 2.45}, 0.12, 0.12}, {{0.70, 2.10, 3.10}, 0.10, 0.10}, {{1.05, 2.75, 3.60}, 0.09, 0.09},
        {{1.60, 3.60, 3.85}, 0.07, 0.07}, {{2.35, 4.40, 3.75}, 0.05, 0.05},
    };
    static const double eye[1][3] = {{0.9, 2.2, 1.95}}, lip[1][3] = {{0.9, 1.5, 1.85}};
    gen_grow(cage, eye, 1, side_x, stalk, (int32_t)SL_COUNTOF(stalk));
    gen_grow(cage, lip, 1, side_x, antenna, (int32_t)SL_COUNTOF(antenna));
}

sl_status gen_crab(uint64_t seed, int32_t scale, sl_generated **out)
{
    (void)seed; /* nothing random */
    gen_cage cage = {.mirrored = true};
    add_shell(&cage);
    add_legs(&cage);
    add_claw(&cage);
    add_feelers(&cage);
    return gen_finish_mirrored(&cage, 1 + scale, out);
}
