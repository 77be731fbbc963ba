/* Plates with holes: a flat one with four, and two square to one another with two each. */
#include "models.h"
#include "panel.h"
#include "plant.h"

/* A flat parallelogram: corner and two sides. */
typedef struct flat {
    double corner[3], a[3], b[3];
} flat;

static void flat_point(const void *data, double u, double v, double p[3])
{
    const flat *f = data;
    for (int k = 0; k < 3; k++) {
        p[k] = f->corner[k] + u * f->a[k] + v * f->b[k];
    }
}

/* Four panels of sides 2 x 1.6, 0.5 thick, and the plate's rim. */
sl_status gen_plate(uint64_t seed, int32_t scale, sl_generated **out)
{
    (void)seed; /* nothing random */
    const double w = 2.0, d = 1.6, t = 0.5;
    const int32_t side = gen_refined(10, scale), thick = gen_refined(3, scale);
    gen_builder b = {0};
    for (int k = 0; k < 4; k++) {
        const gen_panel panel = {
            .middle = {k % 2 == 0 ? -0.5 * w : 0.5 * w, -0.5 * t, k / 2 == 0 ? -0.5 * d : 0.5 * d},
            .half = {{0.0, 0.0, 0.5 * d}, {0.5 * w, 0.0, 0.0}},
            .depth = {0.0, t, 0.0},
            .hole = 0.45,
            .side = side,
            .rings = gen_refined(4, scale),
            .wall = thick,
        };
        gen_panel_into(&b, &panel);
    }
    const flat rim[4] = {
        {{-w, -0.5 * t, d}, {2.0 * w, 0.0, 0.0}, {0.0, t, 0.0}},
        {{w, -0.5 * t, -d}, {-2.0 * w, 0.0, 0.0}, {0.0, t, 0.0}},
        {{w, -0.5 * t, d}, {0.0, 0.0, -2.0 * d}, {0.0, t, 0.0}},
        {{-w, -0.5 * t, -d}, {0.0, 0.0, 2.0 * d}, {0.0, t, 0.0}},
    };
    for (int k = 0; k < 4; k++) {
        gen_grid(&b, 2 * side, thick, flat_point, &rim[k]);
    }
    gen_weld(&b, gen_weld_tolerance);
    const sl_status status = gen_finish(&b, out);
    return status != SL_OK ? status : gen_planted(gen_plant_mirrors(*out, "xyz", true), out);
}

/* One leg of the angle: along (0, 1, 0) or (0, 0, 1) from the corner block; the other direction is its depth. */
static void add_leg(gen_builder *b, bool upright, int32_t side, int32_t thick, int32_t rings)
{
    const double w = 1.5, t = 0.4; /* square panels, the leg's thickness */
    for (int k = 0; k < 2; k++) {
        gen_panel panel = {.middle = {(k - 0.5) * w, 0.0, 0.0},
                           .half = {{0.5 * w, 0.0, 0.0}, {0.0, 0.0, 0.0}},
                           .depth = {0.0, 0.0, 0.0},
                           .hole = 0.38,
                           .side = side,
                           .rings = rings,
                           .wall = thick};
        panel.middle[upright ? 1 : 2] = t + 0.5 * w;
        panel.half[1][upright ? 1 : 2] = 0.5 * w;
        panel.depth[upright ? 2 : 1] = t;
        if (!upright) { /* keep the frame right-handed */
            panel.half[0][0] = -0.5 * w;
        }
        gen_panel_into(b, &panel);
    }
    const double end = t + w;
    if (upright) {
        gen_grid(b, 2 * side, thick, flat_point, &(flat){{-w, end, t}, {2.0 * w, 0.0, 0.0}, {0.0, 0.0, -t}});
        gen_grid(b, side, thick, flat_point, &(flat){{w, t, 0.0}, {0.0, w, 0.0}, {0.0, 0.0, t}});
        gen_grid(b, thick, side, flat_point, &(flat){{-w, t, 0.0}, {0.0, 0.0, t}, {0.0, w, 0.0}});
        gen_grid(b, thick, 2 * side, flat_point, &(flat){{-w, 0.0, 0.0}, {0.0, t, 0.0}, {2.0 * w, 0.0, 0.0}});
    } else {
        gen_grid(b, 2 * side, thick, flat_point, &(flat){{-w, 0.0, end}, {2.0 * w, 0.0, 0.0}, {0.0, t, 0.0}});
        gen_grid(b, thick, side, flat_point, &(flat){{w, 0.0, t}, {0.0, t, 0.0}, {0.0, 0.0, w}});
        gen_grid(b, side, thick, flat_point, &(flat){{-w, 0.0, t}, {0.0, 0.0, w}, {0.0, t, 0.0}});
        gen_grid(b, 2 * side, thick, flat_point, &(flat){{-w, 0.0, 0.0}, {2.0 * w, 0.0, 0.0}, {0.0, 0.0, t}});
    }
}

/* An angle bracket; the block where the legs meet has its two ends here. Symmetric about x = 0 and about y = z. */
sl_status gen_bracket(uint64_t seed, int32_t scale, sl_generated **out)
{
    (void)seed;
    const double w = 1.5, t = 0.4;
    const int32_t side = gen_refined(9, scale), thick = gen_refined(3, scale), rings = gen_refined(4, scale);
    gen_builder b = {0};
    add_leg(&b, false, side, thick, rings);
    add_leg(&b, true, side, thick, rings);
    gen_grid(&b, thick, thick, flat_point, &(flat){{w, 0.0, 0.0}, {0.0, t, 0.0}, {0.0, 0.0, t}});
    gen_grid(&b, thick, thick, flat_point, &(flat){{-w, 0.0, 0.0}, {0.0, 0.0, t}, {0.0, t, 0.0}});
    gen_weld(&b, gen_weld_tolerance);
    sl_status status = gen_finish(&b, out);
    if (status == SL_OK) {
        status = gen_plant_mirrors(*out, "x", true);
        if (status == SL_OK) {
            status = gen_plant_mirror(*out, "mirror y -z", 0.0, 1.0, -1.0, true);
        }
        status = gen_planted(status, out);
    }
    return status;
}
