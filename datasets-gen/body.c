/* A person standing with arms held away from the body, facing +z; symmetric about x = 0 to the bit. */
#include "boxmodel.h"
#include "builder.h"
#include "plant.h"

#include <math.h>

static const double side_x[3] = {1.0, 0.0, 0.0}, side_z[3] = {0.0, 0.0, 1.0};

enum { TORSO_ROWS = 5 };

/* The torso: at each height the half width, the half depth and how far forward. */
typedef struct torso_level {
    double y, width, depth, forward, middle; /* middle: x of the inner grid line */
} torso_level;

static const torso_level torso[TORSO_ROWS + 1] = {
    {8.50, 1.66, 0.95, 0.00, 0.16},  {9.70, 1.88, 1.20, -0.06, 0.55}, {11.20, 1.38, 0.92, 0.06, 0.60},
    {12.70, 1.76, 1.12, 0.10, 0.65}, {13.60, 1.90, 1.12, 0.02, 0.65}, {14.75, 1.66, 0.72, -0.12, 0.55},
};

static void add_torso(gen_cage *cage)
{
    static const double x[3] = {0.0, 1.0, 2.0}, z[3] = {-1.0, 0.0, 1.0};
    double y[TORSO_ROWS + 1];
    for (int k = 0; k <= TORSO_ROWS; k++) {
        y[k] = k;
    }
    gen_cage_box(cage, (const int32_t[]){2, TORSO_ROWS, 2}, (const double *const[]){x, y, z});
    for (int64_t v = 0; v < cage->nv && !cage->failed; v++) {
        double *p = cage->xyz + 3 * v;
        const torso_level *level = &torso[(int)p[1]];
        const bool edge = p[0] == 2.0;
        p[2] = level->forward + p[2] * level->depth * (edge ? 0.72 : 1.0);
        p[0] = p[0] == 0.0 ? 0.0 : edge ? level->width : level->middle;
        p[1] = level->y - (edge && level == &torso[TORSO_ROWS] ? 0.45 : 0.0); /* sloping shoulders */
    }
}

static void add_leg(gen_cage *cage)
{
    static const gen_station leg[] = {
        {{0.96, 7.40, 0.00}, 0.94, 1.12},  {{1.00, 6.00, 0.02}, 0.80, 0.94},  {{1.04, 4.60, 0.02}, 0.58, 0.68},
        {{1.08, 3.50, -0.10}, 0.62, 0.74}, {{1.12, 1.90, -0.12}, 0.40, 0.46}, {{1.14, 0.95, -0.12}, 0.42, 0.50},
        {{1.14, 0.00, -0.16}, 0.54, 0.70},
    };
    static const gen_station foot[] = {
        {{1.20, 0.40, 0.75}, 0.64, 0.46},
        {{1.30, 0.27, 1.50}, 0.78, 0.34},
        {{1.34, 0.20, 2.10}, 0.62, 0.24},
    };
    const int32_t hip[2] = {gen_cage_nearest(cage, 1.0, 8.5, -0.4), gen_cage_nearest(cage, 1.0, 8.5, 0.4)};
    gen_cage_limb(cage, hip, 2, side_x, leg, (int32_t)SL_COUNTOF(leg));
    const int32_t instep = gen_cage_nearest(cage, 1.14, 0.45, 0.45);
    gen_cage_limb(cage, &instep, 1, side_x, foot, (int32_t)SL_COUNTOF(foot));
}

static void add_arm(gen_cage *cage)
{
    static const gen_station arm[] = {
        {{2.25, 13.70, -0.08}, 0.62, 0.70}, {{2.90, 12.90, -0.10}, 0.56, 0.56}, {{3.95, 11.20, -0.12}, 0.44, 0.42},
        {{4.58, 10.10, -0.02}, 0.44, 0.42}, {{5.20, 8.95, 0.12}, 0.30, 0.26},   {{5.48, 8.45, 0.18}, 0.46, 0.27},
        {{5.80, 7.85, 0.24}, 0.56, 0.28},   {{6.10, 7.20, 0.28}, 0.50, 0.24},   {{6.32, 6.70, 0.30}, 0.30, 0.16},
    };
    static const gen_station thumb[] = {
        {{5.62, 8.00, 0.92}, 0.21, 0.24},
        {{5.76, 7.66, 1.08}, 0.18, 0.20},
        {{5.86, 7.40, 1.14}, 0.10, 0.11},
    };
    const int32_t shoulder[2] = {gen_cage_nearest(cage, 1.75, 13.95, -0.4), gen_cage_nearest(cage, 1.75, 13.95, 0.3)};
    gen_cage_limb(cage, shoulder, 2, side_z, arm, (int32_t)SL_COUNTOF(arm));
    const int32_t base = gen_cage_nearest(cage, 5.64, 8.15, 0.65);
    gen_cage_limb(cage, &base, 1, (const double[]){0.8, 0.4, 0.0}, thumb, (int32_t)SL_COUNTOF(thumb));
}

static void add_head(gen_cage *cage)
{
    static const gen_station head[] = {
        {{0.0, 15.15, -0.05}, 0.56, 0.56}, {{0.0, 15.65, 0.08}, 0.60, 0.66}, {{0.0, 15.98, 0.22}, 0.86, 1.02},
        {{0.0, 16.60, 0.18}, 1.02, 1.18},  {{0.0, 17.30, 0.12}, 1.08, 1.22}, {{0.0, 17.95, 0.08}, 0.92, 1.05},
        {{0.0, 18.25, 0.06}, 0.50, 0.58},
    };
    static const gen_station nose[] = {{{0.0, 16.90, 1.24}, 0.20, 0.26}, {{0.0, 16.78, 1.42}, 0.15, 0.15}};
    const int32_t neck[2] = {gen_cage_nearest(cage, 0.3, 14.8, -0.45), gen_cage_nearest(cage, 0.3, 14.8, 0.3)};
    gen_cage_limb(cage, neck, 2, side_x, head, (int32_t)SL_COUNTOF(head));
    const int32_t face = gen_cage_nearest(cage, 0.35, 16.95, 1.2);
    gen_cage_limb(cage, &face, 1, side_x, nose, (int32_t)SL_COUNTOF(nose));
}

sl_status gen_body(uint64_t seed, int32_t scale, sl_generated **out)
{
    (void)seed; /* nothing random */
    gen_cage cage = {.mirrored = true};
    add_torso(&cage);
    if (!cage.failed) {
        add_leg(&cage);
        add_arm(&cage);
        add_head(&cage);
    }
    const sl_status status = gen_cage_finish(&cage, 1 + scale, out);
    return status != SL_OK ? status : gen_planted(gen_plant_mirror(*out, "mirror x", 1.0, 0.0, 0.0, true), out);
}
