/* Branching tubes by box modelling: a fork of two prongs, a tree. */
#include "base/rng.h"
#include "boxmodel.h"
#include "geom/vec3.h"
#include "models.h"
#include "plant.h"

#include <math.h>

static const double side_x[3] = {1.0, 0.0, 0.0}, side_z[3] = {0.0, 0.0, 1.0};

sl_status gen_fork(uint64_t seed, int32_t scale, sl_generated **out)
{
    static const double x[] = {0.0, 0.55}, y[] = {0.0, 0.5, 1.0}, z[] = {-0.5, 0.0, 0.5};
    static const gen_station stem[] = {
        {{0.0, -0.8, 0.0}, 0.62, 0.62},
        {{0.0, -2.0, 0.0}, 0.62, 0.62},
        {{0.0, -3.2, 0.0}, 0.62, 0.62},
        {{0.0, -3.5, 0.0}, 0.58, 0.58},
    };
    static const gen_station prong[] = {
        {{1.10, 0.85, 0.0}, 0.56, 0.56}, {{1.60, 1.55, 0.0}, 0.54, 0.54}, {{2.00, 2.50, 0.0}, 0.52, 0.52},
        {{2.15, 3.60, 0.0}, 0.50, 0.50}, {{2.17, 3.90, 0.0}, 0.46, 0.46},
    };
    (void)seed; /* nothing random */
    gen_cage cage = {.mirrored = true};
    gen_cage_box(&cage, (const int32_t[]){1, 2, 2}, (const double *const[]){x, y, z});
    if (!cage.failed) {
        const int32_t below[2] = {gen_cage_nearest(&cage, 0.27, 0.0, -0.25), gen_cage_nearest(&cage, 0.27, 0.0, 0.25)};
        int32_t beside[4];
        gen_cage_limb(&cage, below, 2, side_x, stem, (int32_t)SL_COUNTOF(stem));
        for (int k = 0; k < 4; k++) {
            beside[k] = gen_cage_nearest(&cage, 0.55, k < 2 ? 0.25 : 0.75, k % 2 == 0 ? -0.25 : 0.25);
        }
        gen_cage_limb(&cage, beside, 4, side_z, prong, (int32_t)SL_COUNTOF(prong));
    }
    const sl_status status = gen_cage_finish(&cage, 1 + scale, out);
    return status != SL_OK ? status : gen_planted(gen_plant_mirrors(*out, "xz", true), out);
}

/* A branch: where it starts, where it points, its radius; what it grows on with. */
typedef struct branch {
    double base[3], direction[3];
    double length, radius;
    int32_t stations;
    int32_t quad; /* at its end */
} branch;

enum { MOST_STATIONS = 8, BOUGHS = 4 };

static double between(sl_rng *rng, double lo, double hi)
{
    return lo + (hi - lo) * sl_rng_uniform(rng);
}

/* Extrudes the region along the branch, bending up a little; the end is set into *tip. */
static void grow(gen_cage *cage, const int32_t *region, int32_t count, const branch *b, double tip[3])
{
    gen_station station[MOST_STATIONS];
    for (int s = 0; s < b->stations; s++) {
        const double t = (s + 1.0) / b->stations;
        for (int k = 0; k < 3; k++) {
            station[s].centre[k] = b->base[k] + b->length * (t * b->direction[k] + (k == 1 ? 0.18 * t * t : 0.0));
        }
        station[s].width = station[s].depth = b->radius * (1.0 - 0.42 * t);
    }
    const double side[3] = {-b->direction[2], 0.0, b->direction[0]}; /* level, square to the branch */
    const double level = sl_vec3_norm(side);
    gen_cage_limb(cage, region, count, level > 0.1 ? side : side_x, station, b->stations);
    for (int k = 0; k < 3; k++) {
        tip[k] = station[b->stations - 1].centre[k];
    }
}

static void aim(double turn, double rise, double direction[3])
{
    direction[0] = cos(rise) * cos(turn);
    direction[1] = sin(rise);
    direction[2] = cos(rise) * sin(turn);
}

/* A bough from one of the four quads on top of the trunk; subdivided later, its end splits into two twigs. */
static void add_bough(gen_cage *cage, sl_rng *rng, int which, double top, double tip[3], branch *b)
{
    const double turn = (which + 0.5) * 1.5707963 + between(rng, -0.15, 0.15);
    const int32_t quad = gen_cage_nearest(cage, 0.3 * cos(turn), top, 0.3 * sin(turn));
    aim(turn, between(rng, 0.45, 0.80), b->direction);
    for (int k = 0; k < 3; k++) {
        b->base[k] = (k == 1 ? top : 0.0) + (k == 1 ? 0.0 : 0.25 * b->direction[k]);
    }
    b->length = between(rng, 1.7, 2.5);
    b->radius = between(rng, 0.38, 0.48);
    b->quad = quad;
    b->stations = 3 + which; /* each another number, so that the connectivity has no symmetry either */
    grow(cage, &quad, 1, b, tip);
}

/* Sum over two of the four quads that bough's end quad has become, of their distance along `across`. */
static double pair_offset(const gen_cage *cage, const int32_t pair[2], const double across[3])
{
    double sum = 0.0;
    for (int i = 0; i < 8; i++) {
        sum += sl_vec3_dot(cage->xyz + 3 * (int64_t)cage->quad[4 * (int64_t)pair[i / 4] + i % 4], across);
    }
    return sum;
}

/* Of the four quads from one subdivided quad, the two neighbours that lie farthest along `across`. */
static void outer_pair(const gen_cage *cage, int32_t quad, const double across[3], int32_t pair[2])
{
    double most = -HUGE_VAL;
    for (int k = 0; k < 4; k++) {
        const int32_t here[2] = {4 * quad + k, 4 * quad + (k + 1) % 4};
        const double offset = pair_offset(cage, here, across);
        if (offset > most) {
            most = offset;
            pair[0] = here[0];
            pair[1] = here[1];
        }
    }
}

/* Two twigs from the four quads at a bough's end, each from two. */
static void add_twigs(gen_cage *cage, sl_rng *rng, const branch *bough, const double tip[3])
{
    const double turn = atan2(bough->direction[2], bough->direction[0]), rise = asin(bough->direction[1]);
    const double aside[3] = {-sin(turn), 0.0, cos(turn)};
    int32_t pair[2][2];
    outer_pair(cage, bough->quad, aside, pair[0]);
    for (int k = 0; k < 2; k++) { /* the two others */
        pair[1][k] = 4 * bough->quad + (pair[0][k] - 4 * bough->quad + 2) % 4;
    }
    for (int k = 0; k < 2 && !cage->failed; k++) {
        const double sign = k == 0 ? 1.0 : -1.0;
        branch b = {.stations = 3 + k};
        double end[3];
        b.length = between(rng, 0.9, 1.6); /* one draw a statement: their order must not be the compiler's choice */
        b.radius = between(rng, 0.15, 0.19);
        const double apart = between(rng, 0.30, 0.52), up = between(rng, -0.15, 0.20);
        aim(turn + sign * apart, rise + up, b.direction);
        for (int i = 0; i < 3; i++) {
            b.base[i] = tip[i] + 0.08 * bough->direction[i] + 0.12 * sign * aside[i];
        }
        grow(cage, pair[k], 2, &b, end);
    }
}

sl_status gen_tree(uint64_t seed, int32_t scale, sl_generated **out)
{
    static const double at[] = {-0.5, 0.0, 0.5}, y[] = {0.0, 0.6};
    static const gen_station trunk[] = {
        {{0.02, 1.2, 0.03}, 0.56, 0.52}, {{0.05, 2.0, 0.0}, 0.55, 0.56}, {{0.0, 2.7, 0.0}, 0.66, 0.66}};
    gen_cage cage = {0};
    sl_rng rng = sl_rng_seed(seed);
    branch bough[BOUGHS];
    double tip[BOUGHS][3];
    int32_t top[4];
    gen_cage_box(&cage, (const int32_t[]){2, 1, 2}, (const double *const[]){at, y, at});
    for (int64_t v = 0; v < cage.nv && !cage.failed; v++) { /* the foot is wider */
        cage.xyz[3 * v] *= cage.xyz[3 * v + 1] == 0.0 ? 2.1 : 1.3;
        cage.xyz[3 * v + 2] *= cage.xyz[3 * v + 1] == 0.0 ? 1.9 : 1.3;
    }
    for (int k = 0; k < 4 && !cage.failed; k++) {
        top[k] = gen_cage_nearest(&cage, k % 2 == 0 ? -0.3 : 0.3, 0.6, k < 2 ? -0.3 : 0.3);
    }
    gen_cage_limb(&cage, top, cage.failed ? 0 : 4, side_x, trunk, (int32_t)SL_COUNTOF(trunk));
    for (int k = 0; k < BOUGHS && !cage.failed; k++) {
        add_bough(&cage, &rng, k, 2.7, tip[k], &bough[k]);
    }
    gen_cage_smooth(&cage);
    for (int k = 0; k < BOUGHS && !cage.failed; k++) {
        add_twigs(&cage, &rng, &bough[k], tip[k]);
    }
    return gen_cage_finish(&cage, scale, out);
}
