/* A bird gliding towards +z, its wings spread and their tips fingered; symmetric about x = 0 to the bit. */
#include "organic.h"
#include "sculpt.h"

static const double side_x[3] = {1.0, 0.0, 0.0}, side_z[3] = {0.0, 0.0, 1.0};

static void add_body(gen_cage *cage)
{
    static const double x[2] = {0.0, 0.95}, y[3] = {-0.85, 0.15, 0.85}, z[5] = {-1.5, -0.6, 0.2, 1.0, 1.8};
    static const gen_station front[] = {
        {{0.0, 0.15, 2.5}, 0.92, 0.92}, {{0.0, 0.40, 3.2}, 0.74, 0.74},  {{0.0, 0.62, 3.9}, 0.80, 0.84},
        {{0.0, 0.62, 4.6}, 0.70, 0.72}, {{0.0, 0.52, 5.05}, 0.36, 0.36}, {{0.0, 0.42, 5.6}, 0.26, 0.24},
        {{0.0, 0.22, 6.1}, 0.12, 0.12},
    };
    static const gen_station back[] = {
        {{0.0, 0.10, -2.4}, 0.86, 0.72}, {{0.0, 0.20, -3.3}, 0.62, 0.40}, {{0.0, 0.25, -4.0}, 0.80, 0.16},
        {{0.0, 0.25, -5.0}, 1.35, 0.12}, {{0.0, 0.22, -6.1}, 1.85, 0.10}, {{0.0, 0.20, -6.5}, 1.60, 0.07},
    };
    static const double ahead[2][3] = {{0.4, -0.4, 1.8}, {0.4, 0.5, 1.8}};
    static const double behind[2][3] = {{0.4, -0.4, -1.5}, {0.4, 0.5, -1.5}};
    gen_cage_box(cage, (const int32_t[]){1, 2, 4}, (const double *const[]){x, y, z});
    gen_grow(cage, ahead, 2, side_x, front, (int32_t)SL_COUNTOF(front));
    gen_grow(cage, behind, 2, side_x, back, (int32_t)SL_COUNTOF(back));
    gen_bump(cage, (const double[]){0.7, 0.9, 4.25}, (const double[]){1.0, 0.3, 0.25}, 0.15);
}

static void add_wing(gen_cage *cage)
{
    static const gen_station wing[] = {
        {{1.6, 0.75, 0.30}, 1.75, 0.30}, {{2.8, 1.10, 0.55}, 1.75, 0.25}, {{4.2, 1.45, 0.75}, 1.70, 0.22},
        {{5.6, 1.55, 0.60}, 1.62, 0.19}, {{7.0, 1.45, 0.10}, 1.55, 0.16}, {{8.2, 1.25, -0.45}, 1.45, 0.14},
    };
    static const double root[4][3] = {{0.95, 0.5, -1.0}, {0.95, 0.5, -0.2}, {0.95, 0.5, 0.6}, {0.95, 0.5, 1.4}};
    static const double tip[4][3] = {{8.2, 1.25, 0.55}, {8.2, 1.25, -0.1}, {8.2, 1.25, -0.8}, {8.2, 1.25, -1.45}};
    static const double reach[4] = {1.75, 1.85, 1.60, 1.20}, sweep[4] = {-0.65, -1.05, -1.45, -1.65};
    gen_grow(cage, root, 4, side_z, wing, (int32_t)SL_COUNTOF(wing));
    for (int k = 0; k < 4; k++) {
        const double *p = tip[k];
        const double far_end[3] = {p[0] + reach[k], p[1] - 0.15, p[2] + sweep[k]};
        const gen_station finger[] = {
            {{p[0] + 0.5 * reach[k], p[1] - 0.06, p[2] + 0.45 * sweep[k]}, 0.36, 0.12},
            {{far_end[0], far_end[1], far_end[2]}, 0.22, 0.08},
        };
        gen_grow(cage, &tip[k], 1, side_z, finger, (int32_t)SL_COUNTOF(finger));
    }
}

sl_status gen_bird(uint64_t seed, int32_t scale, sl_generated **out)
{
    (void)seed; /* nothing random */
    gen_cage cage = {.mirrored = true};
    add_body(&cage);
    add_wing(&cage);
    return gen_finish_mirrored(&cage, 1 + scale, out);
}
