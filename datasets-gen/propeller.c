/* A ship's propeller: three twisted blades on a hub. Turns, but no mirror. */
#include "base/memory.h"
#include "boxmodel.h"
#include "models.h"
#include "plant.h"

#include <math.h>
#include <string.h>

static const double pi = 3.14159265358979323846;

enum { SIDES = 6, LEVELS = 4, BLADES = 3, BLADE_STATIONS = 6 };

static const double level_z[LEVELS] = {-0.62, -0.34, 0.34, 0.62}, level_radius[LEVELS] = {0.52, 0.62, 0.58, 0.42};

/* Hub: rings of six vertices, the ends three quads around a middle vertex each. */
static void add_hub(gen_cage *c)
{
    c->xyz_capacity = 3 * (LEVELS * SIDES + 2);
    c->quad_capacity = 4 * ((LEVELS - 1) * SIDES + 6);
    c->xyz = sl_alloc(c->xyz_capacity, sizeof *c->xyz);
    c->quad = sl_alloc(c->quad_capacity, sizeof *c->quad);
    if (c->xyz == NULL || c->quad == NULL) {
        c->failed = true;
        return;
    }
    for (int k = 0; k < LEVELS * SIDES; k++) {
        const double angle = 2.0 * pi * (k % SIDES - 0.5) / SIDES, r = level_radius[k / SIDES];
        const double p[3] = {r * cos(angle), r * sin(angle), level_z[k / SIDES]};
        memcpy(c->xyz + 3 * c->nv++, p, sizeof p);
    }
    memcpy(c->xyz + 3 * c->nv++, (double[]){0.0, 0.0, level_z[0]}, 3 * sizeof *c->xyz);
    memcpy(c->xyz + 3 * c->nv++, (double[]){0.0, 0.0, level_z[LEVELS - 1] + 0.5}, 3 * sizeof *c->xyz); /* a cone */
    for (int32_t i = 0; i + 1 < LEVELS; i++) {
        for (int32_t k = 0; k < SIDES; k++) {
            const int32_t a = i * SIDES + k, b = i * SIDES + (k + 1) % SIDES;
            memcpy(c->quad + 4 * c->nq++, (int32_t[]){a, b, b + SIDES, a + SIDES}, 4 * sizeof *c->quad);
        }
    }
    for (int32_t k = 0; k < SIDES; k += 2) {
        const int32_t top = (LEVELS - 1) * SIDES, i = (k + 1) % SIDES, j = (k + 2) % SIDES;
        memcpy(c->quad + 4 * c->nq++, (int32_t[]){LEVELS * SIDES, j, i, k}, 4 * sizeof *c->quad);
        memcpy(c->quad + 4 * c->nq++, (int32_t[]){LEVELS * SIDES + 1, top + k, top + i, top + j}, 4 * sizeof *c->quad);
    }
}

/* Blade k grows from side 2 k of the hub's middle ring; each cross-section is turned further about the blade's axis. */
static void add_blade(gen_cage *c, int k)
{
    static const double reach[BLADE_STATIONS] = {0.78, 1.10, 1.60, 2.10, 2.50, 2.72};
    static const double width[BLADE_STATIONS] = {0.42, 0.66, 0.98, 1.06, 0.80, 0.36};
    static const double thick[BLADE_STATIONS] = {0.26, 0.18, 0.13, 0.10, 0.08, 0.06};
    const double turn = 2.0 * pi * k / BLADES, out[2] = {cos(turn), sin(turn)};
    const int32_t quad = SIDES + 2 * k; /* of the middle ring */
    for (int s = 0; s < BLADE_STATIONS; s++) {
        const double pitch = 0.95 - 0.11 * s, sweep = 0.02 * s * s; /* blades lean back */
        const gen_station station = {
            {reach[s] * out[0] + sweep * out[1], reach[s] * out[1] - sweep * out[0], 0.0}, width[s], thick[s]};
        const double side[3] = {-out[1] * sin(pitch), out[0] * sin(pitch), cos(pitch)};
        gen_cage_limb(c, &quad, 1, side, &station, 1);
    }
}

sl_status gen_propeller(uint64_t seed, int32_t scale, sl_generated **out)
{
    (void)seed; /* nothing random */
    gen_cage cage = {0};
    add_hub(&cage);
    for (int k = 0; k < BLADES && !cage.failed; k++) {
        add_blade(&cage, k);
    }
    const sl_status status = gen_cage_finish(&cage, 2 + scale, out);
    const double axis[3] = {0.0, 0.0, 1.0};
    return status != SL_OK ? status
                           : gen_planted(gen_plant_rotation(*out, "rotation z 1/3", axis, 2.0 * pi / 3.0, true), out);
}
