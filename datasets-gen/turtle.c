/* A sea turtle facing +z: a domed shell with a rim, four flippers, a head and a small tail; symmetric about x = 0 to
 * the bit. */
#include "organic.h"
#include "sculpt.h"

#include <math.h>

static const double side_x[3] = {1.0, 0.0, 0.0}, side_z[3] = {0.0, 0.0, 1.0};

/* The shell's grid, rounded in plan: flat below, a rim, a dome above. */
static void add_shell(gen_cage *cage)
{
    static const double x[4] = {0.0, 0.55, 1.45, 2.35}, y[3] = {0.0, 0.5, 0.8},
                        z[6] = {-2.7, -1.9, -0.8, 0.7, 1.8, 2.5};
    gen_cage_box(cage, (const int32_t[]){3, 2, 5}, (const double *const[]){x, y, z});
    for (int64_t v = 0; v < cage->nv && !cage->failed; v++) {
        double *p = cage->xyz + 3 * v;
        const double u = p[0] / 2.35, w = p[2] / 2.6, h = p[1];
        const double plan = h == 0.8 ? 1.12 : h == 0.5 ? 1.0 : 0.94;
        p[0] *= plan * sqrt(1.0 - 0.42 * w * w);
        p[2] *= plan * (1.12 - 0.26 * u * u);
        p[1] = h == 0.8 ? 0.75 + 1.15 * (1.0 - u * u) * (1.0 - 0.8 * w * w) : h == 0.0 ? -0.15 * (1.0 - u * u) : h;
    }
}

static void add_flippers(gen_cage *cage)
{
    static const gen_station fore[] = {
        {{2.75, 0.28, 1.80}, 0.62, 0.34},  {{3.55, 0.34, 2.05}, 0.74, 0.26},   {{4.60, 0.20, 1.75}, 0.76, 0.20},
        {{5.60, -0.05, 0.85}, 0.66, 0.15}, {{6.25, -0.25, -0.30}, 0.30, 0.10},
    };
    static const gen_station hind[] = {
        {{2.15, 0.22, -2.35}, 0.42, 0.28},
        {{2.65, 0.18, -2.95}, 0.56, 0.20},
        {{3.05, 0.08, -3.60}, 0.52, 0.15},
        {{3.25, 0.02, -4.10}, 0.24, 0.10},
    };
    static const double front_at[1][3] = {{2.1, 0.25, 1.3}}, back_at[1][3] = {{1.8, 0.25, -2.1}};
    gen_grow(cage, front_at, 1, side_z, fore, (int32_t)SL_COUNTOF(fore));
    gen_grow(cage, back_at, 1, (const double[]){0.8, 0.0, 0.6}, hind, (int32_t)SL_COUNTOF(hind));
}

static void add_head_and_tail(gen_cage *cage)
{
    static const gen_station head[] = {
        {{0.0, 0.16, 3.20}, 0.50, 0.38}, {{0.0, 0.36, 3.80}, 0.54, 0.46}, {{0.0, 0.62, 4.35}, 0.78, 0.66},
        {{0.0, 0.66, 4.95}, 0.74, 0.64}, {{0.0, 0.54, 5.40}, 0.46, 0.40}, {{0.0, 0.40, 5.62}, 0.20, 0.18},
    };
    static const gen_station tail[] = {{{0.0, 0.18, -3.25}, 0.26, 0.20}, {{0.0, 0.12, -3.80}, 0.10, 0.09}};
    static const double front[1][3] = {{0.25, 0.25, 2.7}}, back[1][3] = {{0.25, 0.25, -2.9}};
    gen_grow(cage, front, 1, side_x, head, (int32_t)SL_COUNTOF(head));
    gen_grow(cage, back, 1, side_x, tail, (int32_t)SL_COUNTOF(tail));
    gen_bump(cage, (const double[]){0.6, 0.85, 4.65}, (const double[]){1.0, 0.5, 0.5}, 0.16);
}

sl_status gen_turtle(uint64_t seed, int32_t scale, sl_generated **out)
{
    (void)seed; /* nothing random */
    gen_cage cage = {.mirrored = true};
    add_shell(&cage);
    add_flippers(&cage);
    add_head_and_tail(&cage);
    return gen_finish_mirrored(&cage, 1 + scale, out);
}
