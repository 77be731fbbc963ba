/* A left hand, palm to the front (+z), fingers up (+y), thumb to the left (-x), closed at the wrist. */
#include "boxmodel.h"
#include "builder.h"

#include <math.h>

static const double pi = 3.14159265358979323846;

enum { PALM_COLUMNS = 7, PALM_ROWS = 3, FINGERS = 4, PHALANX_STATIONS = 7 };

/* A finger: where it leaves the palm, how long and thick, its spread to the right and its bend at each joint. */
typedef struct finger {
    double x, y, z;
    double length, radius;
    double spread, bend; /* degrees */
} finger;

static const finger fingers[FINGERS] = {
    {-3.10, 8.6, 0.10, 7.3, 0.98, -11.0, 7.0},
    {-1.05, 9.1, 0.00, 8.2, 1.02, -2.5, 5.0},
    {1.05, 8.8, 0.05, 7.5, 0.96, 5.5, 8.0},
    {3.05, 7.8, 0.20, 5.8, 0.84, 15.0, 10.0},
};

/* Share of the length and of the radius at each station: base, middle of a phalanx, joint, ... tip. */
static const double station_at[PHALANX_STATIONS] = {0.10, 0.30, 0.44, 0.58, 0.71, 0.88, 1.0};
static const double station_radius[PHALANX_STATIONS] = {1.06, 0.97, 1.08, 0.92, 1.00, 0.90, 0.55};

/* The palm's grid before it is bent: fingers and the webs between them. */
static void palm(gen_cage *cage)
{
    static const double x[PALM_COLUMNS + 1] = {-4.05, -2.25, -1.95, -0.15, 0.15, 1.95, 2.25, 3.9};
    static const double y[PALM_ROWS + 1] = {0.0, 2.9, 5.6, 8.2}, z[3] = {-1.0, 0.0, 1.0};
    gen_cage_box(cage, (const int32_t[]){PALM_COLUMNS, PALM_ROWS, 2}, (const double *const[]){x, y, z});
    for (int64_t v = 0; v < cage->nv && !cage->failed; v++) {
        double *p = cage->xyz + 3 * v;
        const double side = p[0] / 4.0, height = p[1] / 8.2;
        p[2] *= (1.62 - 0.45 * height) * (1.0 - 0.30 * side * side); /* thick at the heel, thin at the edges */
        p[2] += 0.35 * side * side;                                  /* hollow of the palm */
        p[1] += height * (0.55 * (1.0 - side * side) - 0.55 * fmax(side, 0.0)); /* arc of the knuckles */
        p[0] *= 0.80 + 0.20 * height;
    }
}

static void add_finger(gen_cage *cage, const finger *f)
{
    const int32_t region[2] = {gen_cage_nearest(cage, f->x, f->y, f->z - 0.5),
                               gen_cage_nearest(cage, f->x, f->y, f->z + 0.5)};
    gen_station station[PHALANX_STATIONS];
    double p[3] = {f->x, f->y - 0.2, f->z}, done = 0.0, bend = 0.0;
    for (int k = 0; k < PHALANX_STATIONS; k++) {
        const double step = (station_at[k] - done) * f->length, spread = f->spread * pi / 180.0;
        if (k == 0 || station_at[k - 1] == 0.44 || station_at[k - 1] == 0.71) {
            bend += f->bend * pi / 180.0;
        }
        p[0] += step * sin(spread) * cos(bend);
        p[1] += step * cos(spread) * cos(bend);
        p[2] += step * sin(bend);
        done = station_at[k];
        station[k] = (gen_station){{p[0], p[1], p[2]},
                                   1.16 * f->radius * station_radius[k] * (1.0 - 0.16 * done),
                                   1.16 * f->radius * station_radius[k] * (1.0 - 0.24 * done)};
    }
    gen_cage_limb(cage, region, 2, (const double[]){1.0, 0.0, 0.0}, station, PHALANX_STATIONS);
}

static void add_thumb(gen_cage *cage)
{
    static const gen_station station[] = {
        {{-4.35, 3.35, 0.75}, 1.45, 2.10}, {{-5.30, 4.55, 1.15}, 1.28, 1.52}, {{-6.10, 5.80, 1.40}, 1.12, 1.20},
        {{-6.70, 6.85, 1.55}, 1.14, 1.28}, {{-7.20, 7.85, 1.60}, 0.98, 1.12}, {{-7.60, 8.90, 1.55}, 0.86, 1.00},
        {{-7.80, 9.60, 1.45}, 0.48, 0.56},
    };
    int32_t region[4];
    for (int k = 0; k < 4; k++) {
        region[k] = gen_cage_nearest(cage, -3.6, k < 2 ? 1.4 : 4.2, k % 2 == 0 ? -0.4 : 1.0);
    }
    gen_cage_limb(cage, region, 4, (const double[]){0.0, 0.0, 1.0}, station, (int32_t)SL_COUNTOF(station));
}

static void add_wrist(gen_cage *cage)
{
    static const gen_station station[] = {
        {{0.0, -1.3, 0.15}, 3.05, 1.75},
        {{0.0, -3.4, 0.05}, 2.90, 1.75},
        {{0.0, -5.4, 0.00}, 3.05, 1.95},
    };
    int32_t region[2 * PALM_COLUMNS];
    static const double x[PALM_COLUMNS] = {-2.5, -1.7, -0.85, 0.0, 0.85, 1.7, 2.5};
    for (int32_t k = 0; k < 2 * PALM_COLUMNS; k++) {
        region[k] = gen_cage_nearest(cage, x[k / 2], 0.0, k % 2 == 0 ? -0.6 : 0.9);
    }
    gen_cage_limb(cage, region, 2 * PALM_COLUMNS, (const double[]){1.0, 0.0, 0.0}, station,
                  (int32_t)SL_COUNTOF(station));
}

sl_status gen_hand(uint64_t seed, int32_t scale, sl_generated **out)
{
    (void)seed; /* nothing random */
    gen_cage cage = {0};
    palm(&cage);
    for (int k = 0; k < FINGERS && !cage.failed; k++) {
        add_finger(&cage, &fingers[k]);
    }
    if (!cage.failed) {
        add_thumb(&cage);
        add_wrist(&cage);
    }
    return gen_cage_finish(&cage, 1 + scale, out);
}
