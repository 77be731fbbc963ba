/* A dog standing, its head forward (+z) and its tail up; symmetric about x = 0 to the bit. */
#include "organic.h"
#include "sculpt.h"

static const double side_x[3] = {1.0, 0.0, 0.0}, side_z[3] = {0.0, 0.0, 1.0};

/* Middle of the trunk; forward from there chest, neck, head and muzzle, backward loins, rump and tail. */
static void add_trunk(gen_cage *cage)
{
    static const double x[3] = {0.0, 0.55, 1.0}, y[3] = {4.45, 5.2, 6.0}, z[2] = {-0.9, 0.2};
    static const gen_station front[] = {
        {{0.0, 5.05, 1.3}, 1.18, 1.25}, {{0.0, 5.05, 2.5}, 1.22, 1.42},  {{0.0, 5.45, 3.4}, 0.98, 1.25},
        {{0.0, 6.65, 4.2}, 0.70, 0.82}, {{0.0, 7.65, 4.75}, 0.86, 0.90}, {{0.0, 7.95, 5.5}, 0.92, 0.92},
        {{0.0, 7.62, 6.1}, 0.58, 0.58}, {{0.0, 7.48, 7.2}, 0.48, 0.46},  {{0.0, 7.45, 7.6}, 0.26, 0.24},
    };
    static const gen_station back[] = {
        {{0.0, 5.20, -2.0}, 1.04, 1.04}, {{0.0, 5.25, -3.0}, 1.10, 1.18}, {{0.0, 5.45, -3.8}, 0.80, 0.90},
        {{0.0, 5.85, -4.3}, 0.30, 0.32}, {{0.0, 6.75, -5.0}, 0.24, 0.26}, {{0.0, 8.00, -5.3}, 0.19, 0.20},
        {{0.0, 8.60, -5.0}, 0.10, 0.12},
    };
    static const double ahead[4][3] = {{0.2, 4.8, 0.2}, {0.8, 4.8, 0.2}, {0.2, 5.6, 0.2}, {0.8, 5.6, 0.2}};
    static const double behind[4][3] = {{0.2, 4.8, -0.9}, {0.8, 4.8, -0.9}, {0.2, 5.6, -0.9}, {0.8, 5.6, -0.9}};
    gen_cage_box(cage, (const int32_t[]){2, 2, 1}, (const double *const[]){x, y, z});
    gen_grow(cage, ahead, 4, side_x, front, (int32_t)SL_COUNTOF(front));
    gen_grow(cage, behind, 4, side_x, back, (int32_t)SL_COUNTOF(back));
}

static void add_legs(gen_cage *cage)
{
    static const gen_station fore[] = {
        {{0.92, 3.55, 2.35}, 0.80, 0.64}, {{0.92, 2.75, 2.15}, 0.58, 0.50}, {{0.92, 1.75, 2.25}, 0.40, 0.38},
        {{0.92, 0.85, 2.30}, 0.36, 0.36}, {{0.94, 0.40, 2.40}, 0.48, 0.46}, {{0.94, 0.02, 2.45}, 0.50, 0.48},
    };
    static const gen_station hind[] = {
        {{0.86, 4.05, -2.70}, 1.25, 0.82}, {{0.92, 3.15, -2.60}, 0.92, 0.66}, {{0.94, 2.35, -2.95}, 0.46, 0.42},
        {{0.94, 1.70, -3.45}, 0.38, 0.36}, {{0.94, 0.85, -3.40}, 0.36, 0.36}, {{0.94, 0.40, -3.30}, 0.46, 0.46},
        {{0.94, 0.02, -3.25}, 0.50, 0.48},
    };
    static const double fore_at[1][3] = {{0.75, 3.8, 1.9}}, hind_at[1][3] = {{0.75, 4.2, -2.4}};
    static const double fore_toes[1][3] = {{0.94, 0.2, 2.9}}, hind_toes[1][3] = {{0.94, 0.2, -2.8}};
    gen_grow(cage, fore_at, 1, side_z, fore, (int32_t)SL_COUNTOF(fore));
    gen_grow(cage, hind_at, 1, side_z, hind, (int32_t)SL_COUNTOF(hind));
    gen_push(cage, fore_toes, 1, (const double[]){0.0, -0.06, 0.42}, (const double[]){0.95, 0.75, 1.0});
    gen_push(cage, hind_toes, 1, (const double[]){0.0, -0.06, 0.42}, (const double[]){0.95, 0.75, 1.0});
}

static void add_ears(gen_cage *cage)
{
    static const gen_station ear[] = {
        {{0.62, 8.75, 5.0}, 0.30, 0.22},
        {{0.98, 8.85, 5.0}, 0.36, 0.20},
        {{1.30, 8.10, 5.05}, 0.42, 0.16},
        {{1.28, 7.20, 5.1}, 0.18, 0.10},
    };
    static const double at[1][3] = {{0.6, 8.6, 5.1}};
    gen_grow(cage, at, 1, side_z, ear, (int32_t)SL_COUNTOF(ear));
}

sl_status gen_quadruped(uint64_t seed, int32_t scale, sl_generated **out)
{
    (void)seed; /* nothing random */
    gen_cage cage = {.mirrored = true};
    add_trunk(&cage);
    add_legs(&cage);
    add_ears(&cage);
    gen_bump(&cage, (const double[]){0.6, 8.15, 5.85}, (const double[]){1.0, 0.55, 0.55}, 0.15);
    return gen_finish_mirrored(&cage, 1 + scale, out);
}
