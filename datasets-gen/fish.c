/* A fish with its fins spread, its head to +z; symmetric about x = 0 to the bit. */
#include "organic.h"
#include "sculpt.h"

static const double side_x[3] = {1.0, 0.0, 0.0}, side_y[3] = {0.0, 1.0, 0.0};

static void add_body(gen_cage *cage)
{
    static const double x[2] = {0.0, 1.0}, y[4] = {-1.5, -0.55, 0.55, 1.6}, z[2] = {-0.5, 0.6};
    static const gen_station front[] = {
        {{0.0, 0.02, 1.5}, 1.25, 1.95},  {{0.0, 0.00, 2.6}, 1.15, 1.70},   {{0.0, -0.08, 3.6}, 0.92, 1.25},
        {{0.0, -0.15, 4.4}, 0.62, 0.75}, {{0.0, -0.18, 4.75}, 0.35, 0.38},
    };
    static const gen_station back[] = {
        {{0.0, 0.02, -1.6}, 0.98, 1.65}, {{0.0, 0.05, -2.8}, 0.70, 1.15}, {{0.0, 0.06, -3.9}, 0.42, 0.68},
        {{0.0, 0.06, -4.6}, 0.30, 0.55}, {{0.0, 0.06, -5.2}, 0.20, 1.05}, {{0.0, 0.06, -5.8}, 0.14, 1.75},
    };
    static const double ahead[3][3] = {{0.5, -1.0, 0.6}, {0.5, 0.0, 0.6}, {0.5, 1.0, 0.6}};
    static const double behind[3][3] = {{0.5, -1.0, -0.5}, {0.5, 0.0, -0.5}, {0.5, 1.0, -0.5}};
    gen_cage_box(cage, (const int32_t[]){1, 3, 1}, (const double *const[]){x, y, z});
    gen_grow(cage, ahead, 3, side_x, front, (int32_t)SL_COUNTOF(front));
    gen_grow(cage, behind, 3, side_x, back, (int32_t)SL_COUNTOF(back));
}

static void add_fins(gen_cage *cage)
{
    static const gen_station lobe_up[] = {{{0.0, 1.45, -6.6}, 0.10, 0.62}, {{0.0, 2.25, -7.5}, 0.08, 0.40}};
    static const gen_station lobe_down[] = {{{0.0, -1.3, -6.6}, 0.10, 0.62}, {{0.0, -2.1, -7.5}, 0.08, 0.40}};
    static const double up[1][3] = {{0.05, 1.1, -5.8}}, down[1][3] = {{0.05, -1.0, -5.8}};
    static const gen_station pectoral[] = {
        {{1.45, -0.75, 1.75}, 0.34, 0.14},
        {{1.95, -1.05, 1.15}, 0.62, 0.12},
        {{2.55, -1.45, 0.40}, 0.74, 0.10},
        {{2.95, -1.75, -0.25}, 0.50, 0.08},
    };
    static const double cheek[1][3] = {{1.1, -0.85, 2.0}};
    static const double back_ridge[3][3] = {{0.4, 1.9, 1.0}, {0.4, 1.9, 0.0}, {0.4, 1.7, -1.1}};
    static const double vent[1][3] = {{0.3, -1.3, -2.2}};
    gen_grow(cage, up, 1, side_x, lobe_up, (int32_t)SL_COUNTOF(lobe_up));
    gen_grow(cage, down, 1, side_x, lobe_down, (int32_t)SL_COUNTOF(lobe_down));
    gen_grow(cage, cheek, 1, side_y, pectoral, (int32_t)SL_COUNTOF(pectoral));
    gen_push(cage, back_ridge, 3, (const double[]){0.0, 0.35, -0.1}, (const double[]){0.18, 0.8, 0.95});
    gen_push(cage, (const double[][3]){{0.1, 2.1, 1.0}, {0.1, 2.1, 0.0}, {0.1, 2.0, -1.1}}, 3,
             (const double[]){0.0, 0.95, -0.75}, (const double[]){0.7, 0.6, 0.9});
    gen_push(cage, vent, 1, (const double[]){0.0, -0.25, -0.1}, (const double[]){0.25, 0.8, 0.9});
    gen_push(cage, (const double[][3]){{0.08, -1.5, -2.3}}, 1, (const double[]){0.0, -0.75, -0.6},
             (const double[]){0.7, 0.6, 0.8});
}

sl_status gen_fish(uint64_t seed, int32_t scale, sl_generated **out)
{
    (void)seed; /* nothing random */
    gen_cage cage = {.mirrored = true};
    add_body(&cage);
    add_fins(&cage);
    gen_bump(&cage, (const double[]){0.95, 0.35, 3.1}, (const double[]){1.0, 0.35, 0.45}, 0.26);
    return gen_finish_mirrored(&cage, 1 + scale, out);
}
