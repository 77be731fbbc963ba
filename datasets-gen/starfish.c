/* A starfish on the ground, one arm to +z: five-fold, with five mirrors; that of x = 0 holds to the bit. */
#include "organic.h"
#include "plant.h"
#include "sculpt.h"

#include <math.h>

static const double pi = 3.14159265358979323846;

enum { ARMS = 5, ARM_STATIONS = 7, RING = 11 };

static const double half_width = 1.15, root = 2.1, valley = 2.12, height = 0.95;

/* Corner k of the ring around the body's half, from +z by +x to -z: an arm's midline, its flank, the valley, the next
 * arm's flank by turns. (x, z). */
static void ring_corner(int k, double p[2])
{
    const double arm = 2.0 * pi * ((k + 1) / 4) / ARMS, middle = arm + pi / ARMS;
    const double across = k % 4 == 1 ? half_width : k % 4 == 3 ? -half_width : 0.0;
    p[0] = k % 4 == 2 ? valley * sin(middle) : root * sin(arm) + across * cos(arm);
    p[1] = k % 4 == 2 ? valley * cos(middle) : root * cos(arm) - across * sin(arm);
    if (k == 0 || k == RING - 1) {
        p[0] = 0.0;
    }
}

static void add_body(gen_cage *cage)
{
    int32_t above[RING], below[RING];
    const int32_t top = gen_cage_vertex(cage, (double[]){0.0, 1.75 * height, 0.0});
    const int32_t bottom = gen_cage_vertex(cage, (double[]){0.0, -height, 0.0});
    for (int k = 0; k < RING; k++) {
        double p[2];
        ring_corner(k, p);
        above[k] = gen_cage_vertex(cage, (double[]){p[0], height, p[1]});
        below[k] = gen_cage_vertex(cage, (double[]){p[0], -height, p[1]});
    }
    for (int k = 0; k + 1 < RING; k++) {
        gen_cage_quad(cage, (int32_t[]){above[k + 1], above[k], below[k], below[k + 1]});
        if (k % 2 == 0) {
            gen_cage_quad(cage, (int32_t[]){top, above[k], above[k + 1], above[k + 2]});
            gen_cage_quad(cage, (int32_t[]){bottom, below[k + 2], below[k + 1], below[k]});
        }
    }
}

static void add_arm(gen_cage *cage, int arm)
{
    static const double along[ARM_STATIONS] = {2.7, 3.5, 4.3, 5.2, 6.1, 6.8, 7.15};
    static const double width[ARM_STATIONS] = {1.55, 1.40, 1.20, 1.00, 0.78, 0.54, 0.30};
    const double angle = 2.0 * pi * arm / ARMS, d[2] = {arm == 0 ? 0.0 : sin(angle), cos(angle)};
    const double side[3] = {cos(angle), 0.0, -d[0]};
    const double left = arm == 0 ? 0.5 : -0.5; /* of the first arm only the half x >= 0 is there */
    const double at[2][3] = {{root * d[0] + 0.5 * side[0], 0.0, root * d[1] + 0.5 * side[2]},
                             {root * d[0] + left * side[0], 0.0, root * d[1] + left * side[2]}};
    gen_station station[ARM_STATIONS];
    for (int k = 0; k < ARM_STATIONS; k++) {
        station[k] = (gen_station){{along[k] * d[0], 0.0, along[k] * d[1]}, width[k], 0.76 * width[k]};
    }
    gen_grow(cage, at, 2, side, station, ARM_STATIONS);
}

sl_status gen_starfish(uint64_t seed, int32_t scale, sl_generated **out)
{
    (void)seed; /* nothing random */
    gen_cage cage = {.mirrored = true};
    add_body(&cage);
    for (int arm = 0; 2 * arm < ARMS; arm++) {
        add_arm(&cage, arm);
    }
    for (int64_t v = 0; v < cage.nv && !cage.failed; v++) {
        cage.xyz[3 * v + 1] *= cage.xyz[3 * v + 1] < 0.0 ? 0.35 : 1.0; /* flat where it lies on the ground */
    }
    const sl_status status = gen_cage_finish(&cage, 1 + scale, out);
    return status != SL_OK ? status : gen_planted(gen_plant_dihedral(*out, 1, ARMS, 0.0, true), out);
}
