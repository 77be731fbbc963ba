/* A rowing boat, its bow towards +z: an odd number of facets across, so that the mirror plane x = 0 runs through the
 * middles of the facets along the keel. */
#include "base/memory.h"
#include "grid.h"
#include "models.h"
#include "plant.h"

#include <math.h>

static const double pi = 3.14159265358979323846, board = 0.085; /* thickness of the hull */

typedef struct hull {
    bool inner;
} hull;

/* u across from one gunwale to the other, v from stern to bow. */
static void hull_point(const void *data, double u, double v, double p[3])
{
    const hull *h = data;
    const double in = h->inner ? board : 0.0, length = 4.6;
    const double along = h->inner ? 0.035 + 0.93 * v : v; /* 0 stern, 1 bow */
    const double front = fmax(0.0, (along - 0.42) / 0.58), back = fmax(0.0, (0.42 - along) / 0.42);
    const double wide = 0.86 * (1.0 - pow(front, 2.4)) * (1.0 - 0.24 * back * back) + 0.055;
    const double keel = 0.34 * front * front * front + 0.10 * back * back;
    const double rail = 0.78 + 0.34 * front * front + 0.10 * back * back;
    const double phi = (u - 0.5) * pi, s = sin(phi), c = cos(phi);
    /* the sections are between a half ellipse and a box */
    const double flat = pow(fabs(s), 0.8) * (s < 0.0 ? -1.0 : 1.0), deep = pow(fmax(c, 0.0), 0.72);
    p[0] = flat * fmax(wide - in, 0.2 * wide);
    p[1] = rail - deep * (rail - keel - in);
    p[2] = length * (along - 0.5) + 0.25 * front * front * (p[1] - keel); /* the stem rakes forward */
}

/* The inner side faces the other way. */
static void turned_point(const void *data, double u, double v, double p[3])
{
    hull_point(data, v, u, p);
}

/* A transom or stem of the outer or inner hull, as one polygon. */
static void add_end(gen_builder *b, int32_t across, double v, bool inner, bool reversed, int32_t *corner)
{
    const hull h = {inner};
    double p[3];
    for (int32_t k = 0; k <= across; k++) {
        hull_point(&h, (double)k / across, v, p);
        corner[reversed ? across - k : k] = gen_vertex(b, p[0], p[1], p[2]);
    }
    gen_facet(b, across + 1, corner);
}

/* The rim between outer and inner hull at one gunwale (u = 0 or 1), and the small decks at its two ends. */
static void rim_point(const void *data, double u, double v, double p[3])
{
    const double *side = data;
    const hull outer = {false}, inner = {true};
    double a[3], b[3];
    const double in = side[0] > 0.5 ? u : 1.0 - u;
    hull_point(&outer, side[0], v, a);
    hull_point(&inner, side[0], v, b);
    for (int k = 0; k < 3; k++) {
        p[k] = (1.0 - in) * a[k] + in * b[k];
    }
}

static void deck_point(const void *data, double u, double v, double p[3])
{
    const double *end = data;
    const hull outer = {false}, inner = {true};
    double a[2][3], b[2][3];
    for (int k = 0; k < 2; k++) {
        hull_point(&outer, k, end[0], a[k]);
        hull_point(&inner, k, end[0], b[k]);
    }
    const double in = end[0] > 0.5 ? v : 1.0 - v;
    for (int k = 0; k < 3; k++) {
        const double far_rail = a[0][k] + u * (a[1][k] - a[0][k]), near_rail = b[0][k] + u * (b[1][k] - b[0][k]);
        p[k] = near_rail + (1.0 - in) * (far_rail - near_rail);
    }
}

sl_status gen_boat(uint64_t seed, int32_t scale, sl_generated **out)
{
    static const double side[2] = {0.0, 1.0};
    static const hull outer = {false}, inner = {true};
    (void)seed; /* nothing random */
    const int32_t across = 2 * gen_refined(12, scale) + 1, along = gen_refined(56, scale), rim = gen_refined(1, scale);
    gen_builder b = {0};
    int32_t *corner = sl_alloc(across + 1, sizeof *corner);
    b.failed = corner == NULL;
    if (!b.failed) {
        gen_grid(&b, across, along, hull_point, &outer);
        gen_grid(&b, along, across, turned_point, &inner);
        for (int k = 0; k < 2; k++) {
            gen_grid(&b, rim, along, rim_point, &side[k]);
            gen_grid(&b, 1, rim, deck_point, &side[k]);
            add_end(&b, across, k, false, k == 0, corner);
            add_end(&b, across, k, true, k == 1, corner);
        }
    }
    sl_free(corner);
    gen_weld(&b, gen_weld_tolerance);
    const sl_status status = gen_finish(&b, out);
    return status != SL_OK ? status : gen_planted(gen_plant_mirrors(*out, "x", true), out);
}
