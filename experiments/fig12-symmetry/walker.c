#include "walker.h"

#include "boxmodel.h"

enum { ROWS = 4, LEVELS = 2 };

/* The torso at a height: half its width and depth, how far forward it stands, and where the inner grid line runs. */
typedef struct torso_level {
    double y, width, depth, forward, middle;
} torso_level;

static const torso_level torso[ROWS + 1] = {
    {8.0, 2.00, 1.00, 0.00, 0.30},  {9.6, 1.95, 1.30, 0.18, 0.62},   {11.4, 1.45, 1.00, 0.10, 0.60},
    {13.2, 1.85, 1.15, 0.12, 0.66}, {14.6, 1.60, 0.70, -0.15, 0.56},
};

static void add_torso(gen_cage *cage)
{
    static const double x[3] = {0.0, 1.0, 2.0}, y[ROWS + 1] = {0.0, 1.0, 2.0, 3.0, 4.0}, z[3] = {-1.0, 0.0, 1.0};
    gen_cage_box(cage, (const int32_t[]){2, ROWS, 2}, (const double *const[]){x, y, z});
    for (int64_t v = 0; v < cage->nv && !cage->failed; v++) {
        double *p = cage->xyz + 3 * v;
        const torso_level *level = &torso[(int)p[1]];
        p[2] = level->forward + p[2] * level->depth * (p[0] == 2.0 ? 0.75 : 1.0);
        p[0] = p[0] == 0.0 ? 0.0 : p[0] == 2.0 ? level->width : level->middle;
        p[1] = level->y;
    }
}

/* Straight down, round, the same in front and behind, inside and outside. */
static void add_leg(gen_cage *cage)
{
    static const double side_x[3] = {1.0, 0.0, 0.0};
    static const gen_station leg[] = {
        {{1.16, 7.30, 0.0}, 1.00, 1.00}, {{1.16, 6.80, 0.0}, 0.98, 0.98}, {{1.16, 6.30, 0.0}, 0.92, 0.92},
        {{1.16, 5.80, 0.0}, 0.84, 0.84}, {{1.16, 5.30, 0.0}, 0.74, 0.74}, {{1.16, 4.80, 0.0}, 0.72, 0.72},
        {{1.16, 4.30, 0.0}, 0.72, 0.72}, {{1.16, 3.80, 0.0}, 0.72, 0.72}, {{1.16, 3.30, 0.0}, 0.70, 0.70},
        {{1.16, 2.80, 0.0}, 0.66, 0.66}, {{1.16, 2.30, 0.0}, 0.62, 0.62}, {{1.16, 1.80, 0.0}, 0.60, 0.60},
        {{1.16, 1.30, 0.0}, 0.60, 0.60}, {{1.16, 0.90, 0.0}, 0.72, 0.72}, {{1.16, 0.45, 0.0}, 0.86, 0.86},
        {{1.16, 0.00, 0.0}, 0.82, 0.82},
    };
    const int32_t hip[2] = {gen_cage_nearest(cage, 1.15, 8.0, -0.4), gen_cage_nearest(cage, 1.15, 8.0, 0.4)};
    gen_cage_limb(cage, hip, 2, side_x, leg, (int32_t)(sizeof leg / sizeof leg[0]));
}

static void add_arm(gen_cage *cage)
{
    static const double side_z[3] = {0.0, 0.0, 1.0};
    static const gen_station arm[] = {
        {{2.25, 13.5, -0.05}, 0.58, 0.60}, {{3.00, 12.6, -0.10}, 0.50, 0.48}, {{3.80, 11.2, -0.15}, 0.42, 0.40},
        {{4.40, 9.9, 0.05}, 0.40, 0.38},   {{4.90, 8.7, 0.35}, 0.34, 0.30},   {{5.20, 8.0, 0.55}, 0.46, 0.32},
        {{5.40, 7.3, 0.70}, 0.36, 0.24},
    };
    const int32_t shoulder[2] = {gen_cage_nearest(cage, 1.75, 13.9, -0.4), gen_cage_nearest(cage, 1.75, 13.9, 0.4)};
    gen_cage_limb(cage, shoulder, 2, side_z, arm, (int32_t)(sizeof arm / sizeof arm[0]));
}

static void add_head(gen_cage *cage)
{
    static const double side_x[3] = {1.0, 0.0, 0.0};
    static const gen_station head[] = {
        {{0.0, 15.0, -0.08}, 0.56, 0.54}, {{0.0, 15.5, 0.06}, 0.62, 0.66}, {{0.0, 15.9, 0.24}, 0.92, 1.04},
        {{0.0, 16.6, 0.20}, 1.10, 1.20},  {{0.0, 17.4, 0.12}, 1.08, 1.18}, {{0.0, 18.0, 0.06}, 0.60, 0.66},
    };
    static const gen_station nose[] = {{{0.0, 16.5, 1.62}, 0.16, 0.20}};
    const int32_t neck[2] = {gen_cage_nearest(cage, 0.28, 14.6, -0.5), gen_cage_nearest(cage, 0.28, 14.6, 0.2)};
    gen_cage_limb(cage, neck, 2, side_x, head, (int32_t)(sizeof head / sizeof head[0]));
    const int32_t face = gen_cage_nearest(cage, 0.3, 16.3, 1.4);
    gen_cage_limb(cage, &face, 1, side_x, nose, 1);
}

sl_status walker_make(sl_generated **out)
{
    gen_cage cage = {.mirrored = true};
    add_torso(&cage);
    add_leg(&cage);
    add_arm(&cage);
    add_head(&cage);
    return gen_cage_finish(&cage, LEVELS, out);
}
