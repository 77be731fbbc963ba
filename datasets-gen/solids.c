/* Boxes whose spectra have repeated eigenvalues: a cube, a slab and a beam of square section. */
#include "grid.h"
#include "models.h"
#include "plant.h"

typedef struct box_side {
    int axis;
    double end;       /* -1 or 1 */
    const double *at; /* half extents */
} box_side;

static void side_point(const void *data, double u, double v, double p[3])
{
    const box_side *side = data;
    const int axis = side->axis, s = (axis + 1) % 3, t = (axis + 2) % 3;
    p[axis] = side->end * side->at[axis];
    p[s] = (2.0 * (side->end > 0.0 ? u : v) - 1.0) * side->at[s];
    p[t] = (2.0 * (side->end > 0.0 ? v : u) - 1.0) * side->at[t];
}

/* A box of n[0] x n[1] x n[2] square facets a side, in units of the longest. */
static sl_status make_box(const int32_t base[3], int32_t scale, sl_generated **out)
{
    gen_builder b = {0};
    int32_t n[3];
    double at[3], longest = 0.0;
    for (int k = 0; k < 3; k++) {
        n[k] = gen_refined(base[k], scale);
        at[k] = base[k];
        longest = at[k] > longest ? at[k] : longest;
    }
    for (int k = 0; k < 3; k++) {
        at[k] /= longest;
    }
    for (int k = 0; k < 6; k++) {
        const box_side side = {k / 2, k % 2 == 0 ? -1.0 : 1.0, at};
        const int s = (side.axis + 1) % 3, t = (side.axis + 2) % 3;
        gen_grid(&b, n[k % 2 == 0 ? t : s], n[k % 2 == 0 ? s : t], side_point, &side);
    }
    gen_weld(&b, gen_weld_tolerance);
    return gen_finish(&b, out);
}

sl_status gen_cube(uint64_t seed, int32_t scale, sl_generated **out)
{
    (void)seed; /* nothing random */
    const sl_status status = make_box((const int32_t[]){8, 8, 8}, scale, out);
    return status != SL_OK ? status : gen_planted(gen_plant_cube(*out, true), out);
}

sl_status gen_slab(uint64_t seed, int32_t scale, sl_generated **out)
{
    (void)seed;
    const sl_status status = make_box((const int32_t[]){8, 8, 4}, scale, out);
    return status != SL_OK ? status : gen_planted(gen_plant_prism(*out, true), out);
}

sl_status gen_beam(uint64_t seed, int32_t scale, sl_generated **out)
{
    (void)seed;
    const sl_status status = make_box((const int32_t[]){4, 4, 12}, scale, out);
    return status != SL_OK ? status : gen_planted(gen_plant_prism(*out, true), out);
}
