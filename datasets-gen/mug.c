/* A mug: walls inside and out, a handle that makes its hole. */
#include "base/memory.h"
#include "boxmodel.h"
#include "models.h"
#include "plant.h"

#include <math.h>
#include <string.h>

static const double pi = 3.14159265358979323846;

enum { SIDES = 8, RINGS = 12, HANDLE_FROM = 3, HANDLE_TO = 5, HANDLE_STEPS = 5 };

/* The profile: from the middle of the foot up the outside, over the rim and down the inside. The handle springs from
 * the walls above rings HANDLE_FROM and HANDLE_TO. */
static const double profile[RINGS][2] = {
    {0.78, 0.00}, {0.98, 0.02}, {1.04, 0.14}, {1.06, 0.55}, {1.06, 0.95}, {1.06, 1.75},
    {1.06, 2.10}, {1.05, 2.46}, {0.93, 2.46}, {0.90, 1.60}, {0.90, 0.40}, {0.62, 0.22},
};

static void add_vertex(gen_cage *c, double x, double y, double z)
{
    if (sl_reserve((void **)&c->xyz, &c->xyz_capacity, 3 * (c->nv + 1), sizeof *c->xyz) != SL_OK) {
        c->failed = true;
        return;
    }
    memcpy(c->xyz + 3 * c->nv++, (double[]){x, y, z}, 3 * sizeof *c->xyz);
}

static void add_quad(gen_cage *c, int32_t i, int32_t j, int32_t k, int32_t l)
{
    if (sl_reserve((void **)&c->quad, &c->quad_capacity, 4 * (c->nq + 1), sizeof *c->quad) != SL_OK) {
        c->failed = true;
        return;
    }
    memcpy(c->quad + 4 * c->nq++, (int32_t[]){i, j, k, l}, 4 * sizeof *c->quad);
}

static int32_t ring_vertex(int32_t ring, int32_t side)
{
    return ring * SIDES + side % SIDES;
}

/* Side 0 faces +x and is symmetric about z = 0. */
static void add_walls(gen_cage *c)
{
    for (int32_t i = 0; i < RINGS; i++) {
        for (int32_t k = 0; k < SIDES; k++) {
            const double angle = 2.0 * pi * (k - 0.5) / SIDES, r = profile[i][0];
            add_vertex(c, r * cos(angle), profile[i][1], -r * sin(angle));
        }
    }
    for (int32_t i = 0; i + 1 < RINGS; i++) {
        for (int32_t k = 0; k < SIDES; k++) {
            if (k != 0 || (i != HANDLE_FROM && i != HANDLE_TO)) {
                add_quad(c, ring_vertex(i, k), ring_vertex(i, k + 1), ring_vertex(i + 1, k + 1), ring_vertex(i + 1, k));
            }
        }
    }
}

/* The two floors: an octagon each, as three quads in a row. */
static void add_floors(gen_cage *c)
{
    static const int32_t row[3][4] = {{7, 0, 1, 2}, {6, 7, 2, 3}, {5, 6, 3, 4}};
    const int32_t last = (RINGS - 1) * SIDES;
    for (int k = 0; k < 3; k++) {
        add_quad(c, row[k][3], row[k][2], row[k][1], row[k][0]);
        add_quad(c, last + row[k][0], last + row[k][1], last + row[k][2], last + row[k][3]);
    }
}

/* A loop of square cross-sections from the lower gap in the wall to the upper one. */
static void add_handle(gen_cage *c)
{
    static const double path[HANDLE_STEPS][3] = {/* x, y, slope of the section from the vertical */
                                                 {1.42, 0.62, 0.25},
                                                 {1.80, 0.86, 0.90},
                                                 {1.94, 1.36, 1.5707963},
                                                 {1.82, 1.88, 2.25},
                                                 {1.42, 2.06, 2.95}};
    const double thick = 0.15, wide = 0.26;
    int32_t ring[HANDLE_STEPS + 2][4];
    memcpy(ring[0],
           (int32_t[]){ring_vertex(HANDLE_FROM, 0), ring_vertex(HANDLE_FROM, 1), ring_vertex(HANDLE_FROM + 1, 1),
                       ring_vertex(HANDLE_FROM + 1, 0)},
           sizeof ring[0]);
    for (int s = 0; s < HANDLE_STEPS; s++) {
        for (int k = 0; k < 4; k++) { /* outer pair first, then the inner one */
            const double side = k == 0 || k == 3 ? wide : -wide, in = k < 2 ? -thick : thick;
            ring[s + 1][k] = (int32_t)c->nv;
            add_vertex(c, path[s][0] - in * sin(path[s][2]), path[s][1] + in * cos(path[s][2]), side);
        }
    }
    memcpy(ring[HANDLE_STEPS + 1],
           (int32_t[]){ring_vertex(HANDLE_TO + 1, 0), ring_vertex(HANDLE_TO + 1, 1), ring_vertex(HANDLE_TO, 1),
                       ring_vertex(HANDLE_TO, 0)},
           sizeof ring[0]);
    for (int s = 0; s <= HANDLE_STEPS; s++) {
        for (int k = 0; k < 4; k++) {
            add_quad(c, ring[s][k], ring[s][(k + 1) % 4], ring[s + 1][(k + 1) % 4], ring[s + 1][k]);
        }
    }
}

sl_status gen_mug(uint64_t seed, int32_t scale, sl_generated **out)
{
    (void)seed; /* nothing random */
    gen_cage cage = {0};
    add_walls(&cage);
    add_floors(&cage);
    add_handle(&cage);
    const sl_status status = gen_cage_finish(&cage, 1 + scale, out);
    return status != SL_OK ? status : gen_planted(gen_plant_mirrors(*out, "z", true), out);
}
