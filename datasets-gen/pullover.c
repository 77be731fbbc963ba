/* A pullover held up by its shoulders, open at waist, cuffs and collar, its front to +z; a loop of edges at x = 0 runs
 * down the front where a zipper would be. Symmetric about x = 0 to the bit. */
#include "organic.h"
#include "sculpt.h"

static const double side_x[3] = {1.0, 0.0, 0.0}, side_z[3] = {0.0, 0.0, 1.0};

enum { ROWS = 5 };

/* The body's grid: at each height the half width and half depth; shoulders slope, front and back are rounded. */
static void add_body(gen_cage *cage)
{
    static const double x[4] = {0.0, 0.25, 1.1, 2.0}, y[ROWS + 1] = {0.0, 1.0, 2.0, 3.0, 4.0, 5.0},
                        z[3] = {-1.0, 0.0, 1.0};
    static const double height[ROWS + 1] = {1.1, 2.4, 3.7, 4.9, 6.2, 7.35};
    static const double width[ROWS + 1] = {2.15, 2.20, 2.15, 2.20, 2.35, 2.15};
    static const double depth[ROWS + 1] = {1.25, 1.28, 1.22, 1.22, 1.12, 0.62};
    gen_cage_box(cage, (const int32_t[]){3, ROWS, 2}, (const double *const[]){x, y, z});
    for (int64_t v = 0; v < cage->nv && !cage->failed; v++) {
        double *p = cage->xyz + 3 * v;
        const int row = (int)p[1];
        const double across = p[0] / 2.0;
        p[0] *= width[row] / 2.0 * (p[2] == 0.0 ? 1.08 : 1.0);
        p[1] = height[row] - (row == ROWS ? 0.65 * across * across : 0.0);
        p[2] *= depth[row] * (1.0 - 0.38 * across * across);
    }
}

static void add_sleeve(gen_cage *cage)
{
    static const gen_station sleeve[] = {
        {{2.90, 6.00, 0.00}, 1.20, 1.00}, {{3.75, 5.00, 0.02}, 1.15, 0.88}, {{4.55, 3.85, 0.05}, 1.08, 0.82},
        {{5.25, 2.75, 0.12}, 1.02, 0.78}, {{5.70, 2.02, 0.18}, 1.04, 0.80}, {{5.82, 1.80, 0.20}, 0.72, 0.54},
        {{6.15, 1.22, 0.25}, 0.72, 0.54},
    };
    static const double shoulder[2][3] = {{2.3, 6.5, -0.4}, {2.3, 6.5, 0.4}};
    static const double cuff[2][3] = {{6.2, 1.2, -0.1}, {6.2, 1.2, 0.6}};
    gen_grow(cage, shoulder, 2, side_z, sleeve, (int32_t)SL_COUNTOF(sleeve));
    gen_open(cage, cuff, 2);
}

static void add_collar(gen_cage *cage)
{
    static const gen_station collar[] = {
        {{0.0, 7.50, 0.00}, 1.12, 0.66}, {{0.0, 7.85, 0.00}, 1.08, 0.74}, {{0.0, 8.35, 0.02}, 1.12, 0.82}};
    static const double neck[4][3] = {{0.1, 7.3, -0.3}, {0.1, 7.3, 0.3}, {0.6, 7.3, -0.3}, {0.6, 7.3, 0.3}};
    static const double rim[4][3] = {{0.1, 8.4, -0.3}, {0.1, 8.4, 0.3}, {0.6, 8.4, -0.3}, {0.6, 8.4, 0.3}};
    gen_grow(cage, neck, 4, side_x, collar, (int32_t)SL_COUNTOF(collar));
    gen_open(cage, rim, 4);
}

/* A hem that turns in to a ribbed band. */
static void add_waistband(gen_cage *cage)
{
    static const double side[6][2] = {{0.1, -0.6}, {0.1, 0.6}, {0.7, -0.6}, {0.7, 0.6}, {1.6, -0.4}, {1.6, 0.4}};
    static const double level[4] = {1.1, 0.62, 0.42, -0.2}, girth[3] = {1.02, 0.90, 1.0};
    double at[4][6][3];
    for (int k = 0; k < 4; k++) {
        for (int i = 0; i < 6; i++) {
            at[k][i][0] = side[i][0];
            at[k][i][1] = level[k];
            at[k][i][2] = side[i][1];
        }
    }
    for (int k = 0; k < 3; k++) {
        gen_push(cage, (const double(*)[3])at[k], 6, (const double[]){0.0, level[k + 1] - level[k], 0.0},
                 (const double[]){girth[k], 1.0, girth[k]});
    }
    gen_open(cage, (const double(*)[3])at[3], 6);
}

sl_status gen_pullover(uint64_t seed, int32_t scale, sl_generated **out)
{
    (void)seed; /* nothing random */
    gen_cage cage = {.mirrored = true};
    add_body(&cage);
    add_sleeve(&cage);
    add_collar(&cage);
    add_waistband(&cage);
    for (int64_t v = 0; v < cage.nv && !cage.failed; v++) { /* the zipper lies in a groove */
        double *p = cage.xyz + 3 * v;
        p[2] -= p[0] == 0.0 && p[2] > 0.0 ? 0.10 : 0.0;
    }
    return gen_finish_mirrored(&cage, 1 + scale, out);
}
