/* A low-polygon girl in a skirt, as a game would have her: quads, triangles where a quad is bent, hexagons where two
 * are flat; symmetric about x = 0 to the bit. */
#include "organic.h"
#include "plant.h"
#include "retile.h"
#include "sculpt.h"

static const double side_x[3] = {1.0, 0.0, 0.0}, side_z[3] = {0.0, 0.0, 1.0};

enum { TORSO_ROWS = 3 };

static void add_torso(gen_cage *cage)
{
    static const double x[3] = {0.0, 1.0, 2.0}, y[TORSO_ROWS + 1] = {0.0, 1.0, 2.0, 3.0}, z[3] = {-1.0, 0.0, 1.0};
    static const double height[TORSO_ROWS + 1] = {5.05, 5.75, 6.65, 7.35};
    static const double width[TORSO_ROWS + 1] = {0.86, 0.66, 0.90, 0.84},
                                           middle[TORSO_ROWS + 1] = {0.30, 0.30, 0.38, 0.32};
    static const double depth[TORSO_ROWS + 1] = {0.60, 0.48, 0.64, 0.40};
    gen_cage_box(cage, (const int32_t[]){2, TORSO_ROWS, 2}, (const double *const[]){x, y, z});
    for (int64_t v = 0; v < cage->nv && !cage->failed; v++) {
        double *p = cage->xyz + 3 * v;
        const int row = (int)p[1];
        const bool edge = p[0] == 2.0;
        p[1] = height[row] - (edge && row == TORSO_ROWS ? 0.20 : 0.0);
        p[2] *= depth[row] * (edge ? 0.62 : 1.0) * (row == 2 && p[2] < 0.0 ? 0.85 : 1.0);
        p[0] = p[0] == 0.0 ? 0.0 : edge ? width[row] : middle[row];
    }
}

/* Flares to the hem, turns in under it, and goes up to where the legs begin. */
static void add_skirt(gen_cage *cage)
{
    static const double low[4][3] = {{0.15, 5.05, -0.3}, {0.15, 5.05, 0.3}, {0.6, 5.05, -0.2}, {0.6, 5.05, 0.2}};
    static const struct {
        double down, wide, deep;
    } turn[4] = {{-0.85, 1.30, 1.45}, {-1.15, 1.36, 1.40}, {-0.03, 0.88, 0.88}, {0.95, 0.62, 0.66}};
    double level = 5.05;
    for (int k = 0; k < 4; k++) {
        const double at[4][3] = {{low[0][0], level, low[0][2]},
                                 {low[1][0], level, low[1][2]},
                                 {low[2][0], level, low[2][2]},
                                 {low[3][0], level, low[3][2]}};
        gen_push(cage, at, 4, (const double[]){0.0, turn[k].down, 0.0},
                 (const double[]){turn[k].wide, 0.0, turn[k].deep});
        level += turn[k].down;
    }
}

static void add_leg(gen_cage *cage)
{
    static const gen_station leg[] = {
        {{0.54, 3.20, 0.00}, 0.42, 0.40},  {{0.54, 2.15, 0.03}, 0.32, 0.32},  {{0.54, 1.60, -0.04}, 0.36, 0.34},
        {{0.54, 0.85, -0.04}, 0.26, 0.24}, {{0.54, 0.80, -0.04}, 0.36, 0.33}, {{0.54, 0.42, -0.04}, 0.38, 0.36},
        {{0.54, 0.00, -0.04}, 0.42, 0.40},
    };
    static const double hip[2][3] = {{0.55, 3.97, -0.2}, {0.55, 3.97, 0.2}}, toe[1][3] = {{0.54, 0.2, 0.3}};
    gen_grow(cage, hip, 2, side_x, leg, (int32_t)SL_COUNTOF(leg));
    gen_push(cage, toe, 1, (const double[]){0.02, -0.03, 0.42}, (const double[]){1.05, 0.85, 0.4});
    gen_push(cage, (const double[][3]){{0.56, 0.18, 0.75}}, 1, (const double[]){0.0, -0.05, 0.16},
             (const double[]){0.62, 0.70, 1.0});
}

static void add_arm(gen_cage *cage)
{
    static const gen_station arm[] = {
        {{1.12, 6.85, 0.0}, 0.44, 0.42},  {{1.48, 6.42, 0.0}, 0.52, 0.48},  {{1.51, 6.38, 0.0}, 0.34, 0.30},
        {{2.02, 5.68, 0.0}, 0.28, 0.26},  {{2.50, 4.98, 0.1}, 0.20, 0.16},  {{2.64, 4.74, 0.14}, 0.32, 0.18},
        {{2.82, 4.40, 0.18}, 0.32, 0.18}, {{2.98, 4.08, 0.20}, 0.18, 0.10},
    };
    static const gen_station thumb[] = {{{2.50, 4.55, 0.46}, 0.11, 0.11}, {{2.54, 4.32, 0.56}, 0.07, 0.07}};
    static const double shoulder[2][3] = {{0.9, 6.9, -0.2}, {0.9, 6.9, 0.2}}, palm[1][3] = {{2.7, 4.58, 0.40}};
    gen_grow(cage, shoulder, 2, side_z, arm, (int32_t)SL_COUNTOF(arm));
    gen_grow(cage, palm, 1, side_x, thumb, (int32_t)SL_COUNTOF(thumb));
}

static void add_head(gen_cage *cage)
{
    static const gen_station head[] = {
        {{0.0, 7.52, 0.00}, 0.36, 0.34},  {{0.0, 7.80, 0.04}, 0.32, 0.32}, {{0.0, 7.95, 0.14}, 0.66, 0.70},
        {{0.0, 8.45, 0.10}, 0.98, 0.98},  {{0.0, 9.10, 0.04}, 1.06, 1.06}, {{0.0, 9.70, 0.00}, 0.86, 0.90},
        {{0.0, 9.98, -0.02}, 0.42, 0.44},
    };
    static const double neck[2][3] = {{0.15, 7.35, -0.2}, {0.15, 7.35, 0.2}}, face[1][3] = {{0.3, 8.78, 0.95}};
    gen_grow(cage, neck, 2, side_x, head, (int32_t)SL_COUNTOF(head));
    gen_push(cage, face, 1, (const double[]){0.0, -0.10, 0.10}, (const double[]){0.22, 0.40, 0.5});
}

/* The back of the head, its sides from the ears on and all above the brow, as a shell; then two tails. */
static void add_hair(gen_cage *cage)
{
    static const double shell[14][3] = {
        {0.3, 8.2, -0.7}, {0.3, 8.8, -0.9},  {0.3, 9.4, -0.85},  {0.25, 9.85, -0.6}, {0.7, 8.2, -0.3},
        {0.9, 8.8, -0.4}, {0.85, 9.4, -0.4}, {0.6, 9.85, -0.3},  {0.85, 9.4, 0.45},  {0.6, 9.85, 0.3},
        {0.3, 9.4, 0.9},  {0.25, 9.85, 0.6}, {0.15, 9.98, -0.2}, {0.15, 9.98, 0.2},
    };
    static const gen_station tail[] = {
        {{1.30, 9.05, -0.45}, 0.24, 0.24}, {{1.62, 8.75, -0.50}, 0.46, 0.46}, {{1.80, 8.10, -0.50}, 0.50, 0.50},
        {{1.78, 7.45, -0.42}, 0.36, 0.36}, {{1.68, 7.00, -0.34}, 0.10, 0.10},
    };
    gen_push(cage, shell, 14, (const double[]){0.0, 0.02, -0.02}, (const double[]){1.14, 1.12, 1.14});
    gen_grow(cage, (const double[][3]){{1.0, 8.9, -0.45}}, 1, side_z, tail, (int32_t)SL_COUNTOF(tail));
}

sl_status gen_character(uint64_t seed, int32_t scale, sl_generated **out)
{
    (void)seed; /* nothing random */
    gen_cage cage = {.mirrored = true};
    sl_generated *quads = NULL;
    add_torso(&cage);
    add_skirt(&cage);
    add_leg(&cage);
    add_arm(&cage);
    add_head(&cage);
    add_hair(&cage);
    *out = NULL;
    sl_status status = gen_cage_finish(&cage, scale - 1, &quads);
    if (status == SL_OK) {
        status = gen_retile(quads, out);
    }
    return status != SL_OK ? status : gen_planted(gen_plant_mirror(*out, "mirror x", 1.0, 0.0, 0.0, true), out);
}
