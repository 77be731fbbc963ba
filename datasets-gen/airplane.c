/* An airliner flying towards +z: swept wings with winglets, an engine under each, a tail with fin and tailplanes;
 * symmetric about x = 0 to the bit. */
#include "organic.h"
#include "sculpt.h"

static const double side_x[3] = {1.0, 0.0, 0.0}, side_z[3] = {0.0, 0.0, 1.0};

static void add_fuselage(gen_cage *cage)
{
    static const double x[2] = {0.0, 0.75}, y[3] = {-0.75, 0.0, 0.75}, z[4] = {-1.2, -0.3, 0.7, 1.8};
    static const gen_station front[] = {
        {{0.0, 0.00, 4.2}, 1.03, 1.03},  {{0.0, 0.00, 6.4}, 1.00, 1.00},   {{0.0, -0.08, 7.4}, 0.80, 0.80},
        {{0.0, -0.20, 8.1}, 0.48, 0.44}, {{0.0, -0.25, 8.35}, 0.22, 0.20},
    };
    static const gen_station back[] = {
        {{0.0, 0.02, -3.4}, 1.03, 1.03}, {{0.0, 0.12, -5.0}, 0.90, 0.90}, {{0.0, 0.30, -6.5}, 0.60, 0.62},
        {{0.0, 0.45, -7.6}, 0.34, 0.36}, {{0.0, 0.52, -8.2}, 0.16, 0.18},
    };
    static const double ahead[2][3] = {{0.4, -0.4, 1.8}, {0.4, 0.4, 1.8}};
    static const double behind[2][3] = {{0.4, -0.4, -1.2}, {0.4, 0.4, -1.2}};
    gen_cage_box(cage, (const int32_t[]){1, 2, 3}, (const double *const[]){x, y, z});
    const int64_t middle = cage->nv;
    gen_grow(cage, ahead, 2, side_x, front, (int32_t)SL_COUNTOF(front));
    gen_grow(cage, behind, 2, side_x, back, (int32_t)SL_COUNTOF(back));
    for (int64_t v = 0; v < middle && !cage->failed; v++) { /* eight corners on a circle */
        double *p = cage->xyz + 3 * v;
        p[0] *= p[1] == 0.0 ? 1.03 / 0.75 : 1.0;
        p[1] *= p[0] == 0.0 ? 1.03 / 0.75 : 1.0;
    }
}

static void add_wing(gen_cage *cage)
{
    static const gen_station wing[] = {
        {{1.45, -0.48, 0.20}, 1.72, 0.26},  {{2.45, -0.40, -0.25}, 1.42, 0.20}, {{3.15, -0.34, -0.60}, 1.24, 0.18},
        {{5.30, -0.14, -1.75}, 0.92, 0.13}, {{7.40, 0.08, -2.85}, 0.62, 0.10},  {{7.75, 0.30, -3.15}, 0.52, 0.09},
        {{7.95, 0.95, -3.65}, 0.30, 0.06},
    };
    static const double root[3][3] = {{0.9, -0.4, -0.75}, {0.9, -0.4, 0.2}, {0.9, -0.4, 1.25}};
    gen_grow(cage, root, 3, side_z, wing, (int32_t)SL_COUNTOF(wing));
}

/* A pylon from the wing's underside to a drum, which grows an intake and a nozzle. */
static void add_engine(gen_cage *cage)
{
    static const double below[1][3] = {{2.8, -0.55, -0.43}},
                        front[3][3] = {{2.8, -1.3, 1.2}, {2.8, -1.3, 1.75}, {2.8, -1.3, 1.85}};
    static const double back[2][3] = {{2.8, -1.3, -0.1}, {2.8, -1.3, -0.8}};
    gen_push(cage, below, 1, (const double[]){0.0, -0.30, 0.25}, (const double[]){0.22, 0.0, 0.75});
    gen_push(cage, (const double[][3]){{2.8, -0.85, -0.18}}, 1, (const double[]){0.0, -0.08, 0.75},
             (const double[]){5.0, 1.0, 2.5});
    gen_push(cage, (const double[][3]){{2.8, -0.93, 0.57}}, 1, (const double[]){0.0, -0.90, 0.0},
             (const double[]){1.0, 1.0, 1.0});
    gen_push(cage, front, 1, (const double[]){0.0, 0.0, 0.50}, (const double[]){1.22, 1.12, 0.0});
    gen_push(cage, front + 1, 1, (const double[]){0.0, 0.0, 0.12}, (const double[]){0.84, 0.84, 1.0});
    gen_push(cage, front + 2, 1, (const double[]){0.0, 0.0, -0.45}, (const double[]){0.72, 0.72, 1.0});
    gen_push(cage, back, 1, (const double[]){0.0, 0.02, -0.70}, (const double[]){0.72, 0.66, 0.0});
    gen_push(cage, back + 1, 1, (const double[]){0.0, 0.02, -0.45}, (const double[]){0.45, 0.45, 1.0});
}

static void add_tail(gen_cage *cage)
{
    static const gen_station tailplane[] = {
        {{0.85, 0.62, -6.05}, 0.82, 0.14}, {{1.90, 0.74, -6.70}, 0.66, 0.10}, {{2.95, 0.86, -7.40}, 0.42, 0.07}};
    static const double flank[1][3] = {{0.7, 0.45, -5.75}};
    gen_push(cage, (const double[][3]){{0.3, 0.95, -5.75}}, 1, (const double[]){0.0, 0.25, -0.15},
             (const double[]){0.24, 1.0, 0.95});
    gen_push(cage, (const double[][3]){{0.08, 1.2, -5.90}}, 1, (const double[]){0.0, 1.20, -1.00},
             (const double[]){0.75, 0.6, 0.78});
    gen_push(cage, (const double[][3]){{0.06, 2.4, -6.90}}, 1, (const double[]){0.0, 1.25, -0.95},
             (const double[]){0.75, 0.4, 0.75});
    gen_grow(cage, flank, 1, side_z, tailplane, (int32_t)SL_COUNTOF(tailplane));
}

sl_status gen_airplane(uint64_t seed, int32_t scale, sl_generated **out)
{
    (void)seed; /* nothing random */
    gen_cage cage = {.mirrored = true};
    add_fuselage(&cage);
    add_wing(&cage);
    add_engine(&cage);
    add_tail(&cage);
    return gen_finish_mirrored(&cage, 1 + scale, out);
}
