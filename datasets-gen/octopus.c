/* An octopus: a bulging head with two eyes on eight arms in four curls; symmetric about x = 0 to the bit. */
#include "organic.h"
#include "sculpt.h"

#include <math.h>

static const double pi = 3.14159265358979323846;

enum { ARM_STATIONS = 8, HALF_ARMS = 4 };

/* How an arm lies: where it leaves the base, from +z; turned sideways along its length, its tip raised, both over the
 * whole arm. Degrees. */
typedef struct arm_pose {
    double from, yaw, raise;
    double length;
} arm_pose;

static const arm_pose pose[HALF_ARMS] = {
    {31.0, 0.0, 290.0, 7.6}, {68.0, -120.0, 0.0, 7.2}, {112.0, 150.0, 0.0, 7.4}, {149.0, 0.0, 250.0, 7.0}};

/* An octagonal base whose eight sides carry the arms, and the mantle above it. */
static void add_head(gen_cage *cage)
{
    /* a narrow strip along the mirror plane keeps the foremost arms apart */
    static const double x[3] = {0.0, 0.25, 1.0}, y[2] = {0.5, 1.75}, z[3] = {-1.0, 0.0, 1.0};
    static const gen_station mantle[] = {
        {{0.0, 2.55, 0.00}, 1.45, 1.45},  {{0.0, 3.45, -0.08}, 1.70, 1.75}, {{0.0, 4.70, -0.60}, 2.45, 2.40},
        {{0.0, 6.20, -1.40}, 2.70, 2.45}, {{0.0, 7.40, -2.10}, 1.95, 1.75}, {{0.0, 7.95, -2.45}, 1.00, 0.90},
    };
    static const double top[4][3] = {{0.12, 1.75, 0.5}, {0.12, 1.75, -0.5}, {0.8, 1.75, 0.5}, {0.8, 1.75, -0.5}};
    gen_cage_box(cage, (const int32_t[]){2, 1, 2}, (const double *const[]){x, y, z});
    const int64_t base = cage->nv;
    gen_grow(cage, top, 4, (const double[]){1.0, 0.0, 0.0}, mantle, (int32_t)SL_COUNTOF(mantle));
    for (int64_t v = 0; v < base && !cage->failed; v++) {
        double *p = cage->xyz + 3 * v;
        const double angle = atan2(p[0], p[2]), r = p[1] > 1.0 ? 1.55 : 1.75;
        if (p[0] != 0.0 || p[2] != 0.0) {
            p[0] = p[0] == 0.0 ? 0.0 : r * sin(angle);
            p[2] = r * cos(angle);
        }
    }
    gen_bump(cage, (const double[]){1.2, 3.35, 0.6}, (const double[]){1.0, 0.3, 0.8}, 0.45);
}

static void add_arm(gen_cage *cage, const arm_pose *how)
{
    const double angle = how->from * pi / 180.0;
    gen_station station[ARM_STATIONS];
    const double at[1][3] = {{1.6 * sin(angle), 1.1, 1.6 * cos(angle)}};
    const bool sideways = how->yaw != 0.0;
    const double side[3] = {sideways ? 0.0 : cos(angle), sideways ? 1.0 : 0.0, sideways ? 0.0 : -sin(angle)};
    double p[3] = {1.55 * sin(angle), 1.0, 1.55 * cos(angle)};
    for (int k = 0; k < ARM_STATIONS; k++) {
        const double t = (k + 0.5) / ARM_STATIONS, done = (double)(k + 1) / ARM_STATIONS;
        const double curl = fmax(0.0, (t - 0.35) / 0.65), step = how->length / ARM_STATIONS * (1.25 - 0.5 * t);
        const double yaw = angle + how->yaw * t * t * pi / 180.0;
        const double pitch = how->raise * curl * curl * pi / 180.0;
        const double radius = 0.95 * (1.0 - 0.84 * done);
        p[0] += step * cos(pitch) * sin(yaw);
        p[2] += step * cos(pitch) * cos(yaw);
        p[1] = pitch > 0.0 ? p[1] + step * sin(pitch) : fmax(1.0 - 1.1 * done, 0.0) * 0.55 + 0.62 * radius;
        station[k] = (gen_station){{p[0], p[1], p[2]}, radius, radius};
    }
    gen_grow(cage, at, 1, side, station, ARM_STATIONS);
}

sl_status gen_octopus(uint64_t seed, int32_t scale, sl_generated **out)
{
    (void)seed; /* nothing random */
    gen_cage cage = {.mirrored = true};
    add_head(&cage);
    for (int k = 0; k < HALF_ARMS; k++) {
        add_arm(&cage, &pose[k]);
    }
    return gen_finish_mirrored(&cage, 1 + scale, out);
}
