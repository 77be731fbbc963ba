/* Several components that are copies of one another: a toy car on four wheels, the links of a chain. */
#include "base/memory.h"
#include "boxmodel.h"
#include "grid.h"
#include "models.h"
#include "plant.h"

#include <math.h>

static const double pi = 3.14159265358979323846;

/* One link: a tube around a stadium in the xy-plane. */
static const double link_straight = 0.9, link_bend = 0.5, link_wire = 0.17, link_pitch = 1.48;

enum { BEND_STEPS = 14, STRAIGHT_STEPS = 8, LINK_STEPS = 2 * (BEND_STEPS + STRAIGHT_STEPS) };

/* u around the wire, v along it: the right bend upwards, the top, the left bend, the bottom. */
static void link_point(const void *data, double u, double v, double p[3])
{
    (void)data;
    const double unit = v * LINK_STEPS;
    const int part = unit <= BEND_STEPS ? 0 : unit <= LINK_STEPS / 2 ? 1 : unit <= LINK_STEPS / 2 + BEND_STEPS ? 2 : 3;
    const double bend = (unit - part / 2 * (LINK_STEPS / 2)) / BEND_STEPS, half = 0.5 * link_straight;
    const double straight = (unit - part / 2 * (LINK_STEPS / 2) - BEND_STEPS) / STRAIGHT_STEPS;
    const double sign = part < 2 ? 1.0 : -1.0; /* the right half, then the left one turned by 180 degrees */
    const double angle = part % 2 == 0 ? pi * (bend - 0.5) : 0.5 * pi;
    const double middle = sign * (part % 2 == 0 ? half : half - straight * link_straight);
    const double r = link_bend + link_wire * cos(2.0 * pi * u);
    p[0] = middle + sign * r * cos(angle);
    p[1] = sign * r * sin(angle);
    p[2] = -link_wire * sin(2.0 * pi * u);
}

enum { LINKS = 5 };

sl_status gen_chain(uint64_t seed, int32_t scale, sl_generated **out)
{
    (void)seed; /* nothing random */
    gen_builder one = {0}, b = {0};
    sl_generated *link = NULL;
    gen_grid(&one, gen_refined(12, scale), gen_refined(LINK_STEPS, scale), link_point, NULL);
    gen_weld(&one, gen_weld_tolerance);
    sl_status status = gen_finish(&one, &link);
    for (int k = 0; k < LINKS && status == SL_OK; k++) {
        const double shift = (k - 0.5 * (LINKS - 1)) * link_pitch;
        const double flat[12] = {1.0, 0.0, 0.0, shift, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0};
        const double upright[12] = {1.0, 0.0, 0.0, shift, 0.0, 0.0, -1.0, 0.0, 0.0, 1.0, 0.0, 0.0};
        gen_append(&b, link, k % 2 == 0 ? flat : upright);
    }
    sl_generated_free(link);
    *out = NULL;
    if (status != SL_OK) {
        gen_clear(&b);
        return status;
    }
    status = gen_finish(&b, out);
    return status != SL_OK ? status : gen_planted(gen_plant_mirrors(*out, "xyz", true), out);
}

/* A wheel about the x axis: u around, v over the tyre's profile; the hub caps are polygons. */
static void wheel_point(const void *data, double u, double v, double p[3])
{
    static const double profile[9][2] = {/* x, radius */
                                         {-0.20, 0.20}, {-0.20, 0.42}, {-0.26, 0.50}, {-0.24, 0.66}, {0.0, 0.74},
                                         {0.24, 0.66},  {0.26, 0.50},  {0.20, 0.42},  {0.20, 0.20}};
    (void)data;
    const double at = 8.0 * v;
    const int k = at >= 8.0 ? 7 : (int)at;
    const double r = profile[k][1] + (at - k) * (profile[k + 1][1] - profile[k][1]);
    p[0] = profile[k][0] + (at - k) * (profile[k + 1][0] - profile[k][0]);
    p[1] = r * cos(2.0 * pi * u);
    p[2] = r * sin(2.0 * pi * u);
}

static sl_status make_wheel(int32_t scale, sl_generated **out)
{
    const int32_t around = gen_refined(24, scale), along = gen_refined(8, scale);
    gen_builder b = {0};
    gen_grid(&b, around, along, wheel_point, NULL);
    int32_t *corner = sl_alloc(around, sizeof *corner);
    b.failed |= corner == NULL;
    for (int end = 0; end < 2 && corner != NULL; end++) {
        for (int32_t k = 0; k < around; k++) {
            corner[k] = end == 0 ? (around - 1 - k) * (along + 1) : k * (along + 1) + along;
        }
        gen_facet(&b, around, corner);
    }
    sl_free(corner);
    gen_weld(&b, gen_weld_tolerance);
    return gen_finish(&b, out);
}

/* Extrudes the cage's roof quads and moves them up to y, shrunk about x = 0 and z = middle. */
static void lift_roof(gen_cage *cage, const int32_t *roof, int32_t count, double y, double narrow, double shorten,
                      double middle)
{
    gen_cage_extrude(cage, roof, count);
    uint8_t *moved = cage->failed ? NULL : sl_calloc(cage->nv, 1);
    cage->failed |= moved == NULL;
    for (int32_t i = 0; i < 4 * count && moved != NULL; i++) {
        const int32_t v = cage->quad[4 * (int64_t)roof[i / 4] + i % 4];
        double *p = cage->xyz + 3 * (int64_t)v;
        if (moved[v] == 0) {
            p[0] *= narrow;
            p[1] = y;
            p[2] = middle + shorten * (p[2] - middle);
            moved[v] = 1;
        }
    }
    sl_free(moved);
}

/* Half of the body, facing +z: a box of 2 x 2 x 8 blocks, the cabin drawn up from its middle. */
static sl_status make_car_body(int32_t scale, sl_generated **out)
{
    static const double x[] = {0.0, 0.6, 1.2}, y[] = {0.0, 0.5, 0.9};
    static const double z[] = {-2.5, -2.2, -1.5, -0.8, 0.0, 0.8, 1.3, 2.3, 2.6};
    gen_cage cage = {.mirrored = true};
    gen_cage_box(&cage, (const int32_t[]){2, 2, 8}, (const double *const[]){x, y, z});
    for (int64_t v = 0; v < cage.nv && !cage.failed; v++) {
        double *p = cage.xyz + 3 * v;
        p[1] -= p[1] == 0.9 && p[2] > 1.5 ? 0.16 : 0.0; /* the bonnet falls forward */
        p[0] *= fabs(p[2]) > 2.4 ? 0.9 : 1.0;
        p[1] += p[1] == 0.0 && fabs(p[2]) > 2.4 ? 0.10 : 0.0;
    }
    int32_t roof[6];
    for (int k = 0; k < 6 && !cage.failed; k++) {
        roof[k] = gen_cage_nearest(&cage, k % 2 == 0 ? 0.3 : 0.9, 0.9, (double[]){-1.15, -0.4, 0.4}[k / 2]);
    }
    if (!cage.failed) {
        lift_roof(&cage, roof, 6, 1.0, 0.95, 0.97, -0.4);
        lift_roof(&cage, roof, 6, 1.65, 0.88, 0.74, -0.6);
        lift_roof(&cage, roof, 6, 1.78, 0.86, 0.86, -0.6);
    }
    return gen_cage_finish(&cage, 1 + scale, out);
}

sl_status gen_wagon(uint64_t seed, int32_t scale, sl_generated **out)
{
    (void)seed;
    sl_generated *body = NULL, *wheel = NULL;
    gen_builder b = {0};
    sl_status status = SL_OK;
    *out = NULL;
    SL_TRY(make_car_body(scale, &body));
    SL_TRY(make_wheel(scale, &wheel));
    gen_append(&b, body, (const double[]){1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0});
    for (int k = 0; k < 4; k++) {
        const double side = k % 2 == 0 ? 1.55 : -1.55, along = k < 2 ? 1.55 : -1.5;
        gen_append(&b, wheel, (const double[]){1.0, 0.0, 0.0, side, 0.0, 1.0, 0.0, 0.1, 0.0, 0.0, 1.0, along});
    }
    SL_TRY(gen_finish(&b, out));
    status = gen_planted(gen_plant_mirrors(*out, "x", true), out);
cleanup:
    gen_clear(&b);
    sl_generated_free(body);
    sl_generated_free(wheel);
    return status;
}
