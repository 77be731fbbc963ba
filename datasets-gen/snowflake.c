/* A snowflake: triangles of a hexagonal lattice, as a thin plate. Six arms, twelve mirrors and the flat one. */
#include "grid.h"
#include "models.h"
#include "plant.h"

#include <math.h>
#include <stdlib.h>

static const double pi = 3.14159265358979323846, row = 0.86602540378443864676; /* height of a triangle */

enum { REACH = 16 }; /* lattice steps from the middle to beyond the tips */

/* Is the lattice triangle around this point part of the flake? The point is turned and mirrored into the twelfth
 * between an arm's axis and 30 degrees first. */
static bool inside(double x, double y)
{
    /* the bounds are no sums of the lattice's own coordinates, so that no triangle lies on one */
    static const double at[3] = {3.0, 6.0, 9.0}, length[3] = {4.2, 3.2, 2.2}; /* the branches */
    const double r = sqrt(x * x + y * y), sixth = pi / 3.0;
    double angle = atan2(y, x);
    angle = fabs(angle - sixth * floor(angle / sixth + 0.5));
    const double along = r * cos(angle), off = r * sin(angle);
    if (along < 12.9 && off < row) {
        return true; /* the arm */
    }
    if (along + off / sqrt(3.0) < 2.2) {
        return true; /* the middle */
    }
    for (int k = 0; k < 3; k++) {
        const double ahead = 0.5 * (along - at[k]) + row * off, aside = row * (along - at[k]) - 0.5 * off;
        if (fabs(aside) < row && ahead > 0.1 && ahead < length[k]) {
            return true;
        }
    }
    return false;
}

/* Half the plate's thickness: thinner towards the tips. */
static double thickness(double x, double y)
{
    return 0.85 - 0.035 * sqrt(x * x + y * y);
}

/* Point i, j of the lattice, `fine` steps to a unit. */
static void lattice(int32_t i, int32_t j, int32_t fine, double p[2])
{
    p[0] = (i + 0.5 * j) / fine;
    p[1] = row * j / fine;
}

static bool inside_triangle(int32_t i, int32_t j, bool up, int32_t fine)
{
    double a[2], b[2], c[2];
    /* the middle of the unit triangle that holds this small one */
    lattice(i, j, fine, a);
    lattice(up ? i + 1 : i + 1, up ? j : j + 1, fine, b);
    lattice(i, j + 1, fine, c);
    if (!up) {
        lattice(i + 1, j, fine, a);
    }
    const double x = (a[0] + b[0] + c[0]) / 3.0, y = (a[1] + b[1] + c[1]) / 3.0;
    const double v = y / row, u = x - 0.5 * v, s = u - floor(u), t = v - floor(v);
    const double third = s + t < 1.0 ? 1.0 / 3.0 : 2.0 / 3.0;
    const double cu = floor(u) + third, cv = floor(v) + third;
    return inside(cu + 0.5 * cv, row * cv);
}

static void add_corner(gen_builder *b, int32_t i, int32_t j, int32_t fine, double side)
{
    double p[2];
    lattice(i, j, fine, p);
    gen_vertex(b, p[0], p[1], side * thickness(p[0], p[1]));
}

static void add_triangle(gen_builder *b, const int32_t at[3][2], int32_t fine)
{
    const int32_t first = (int32_t)b->nv;
    for (int k = 0; k < 3; k++) {
        add_corner(b, at[k][0], at[k][1], fine, 1.0);
        add_corner(b, at[k][0], at[k][1], fine, -1.0);
    }
    gen_triangle(b, first, first + 2, first + 4);
    gen_triangle(b, first + 1, first + 5, first + 3);
}

/* The wall over the side p -> q of the outline, the flake on its left. */
static void add_wall(gen_builder *b, const int32_t p[2], const int32_t q[2], int32_t fine, int32_t high)
{
    for (int32_t k = 0; k < high; k++) {
        const double lo = 2.0 * k / high - 1.0, hi = 2.0 * (k + 1) / high - 1.0;
        const int32_t first = (int32_t)b->nv;
        add_corner(b, p[0], p[1], fine, lo);
        add_corner(b, q[0], q[1], fine, lo);
        add_corner(b, q[0], q[1], fine, hi);
        add_corner(b, p[0], p[1], fine, hi);
        gen_quad(b, first, first + 1, first + 2, first + 3);
    }
}

/* One lattice triangle: its two faces, and walls where its neighbours are missing. */
static void add_cell(gen_builder *b, int32_t i, int32_t j, bool up, int32_t fine, int32_t high)
{
    const int32_t at[3][2] = {{up ? i : i + 1, j}, {i + 1, up ? j : j + 1}, {i, j + 1}};
    /* neighbours across the sides 0-1, 1-2, 2-0 */
    const int32_t next[3][2] = {{up ? i : i + 1, up ? j - 1 : j}, {i, up ? j : j + 1}, {up ? i - 1 : i, j}};
    if (!inside_triangle(i, j, up, fine)) {
        return;
    }
    add_triangle(b, at, fine);
    for (int k = 0; k < 3; k++) {
        if (!inside_triangle(next[k][0], next[k][1], !up, fine)) {
            add_wall(b, at[k], at[(k + 1) % 3], fine, high);
        }
    }
}

sl_status gen_snowflake(uint64_t seed, int32_t scale, sl_generated **out)
{
    (void)seed; /* nothing random */
    const int32_t fine = gen_refined(2, scale), high = gen_refined(3, scale), reach = REACH * fine;
    gen_builder b = {0};
    for (int32_t j = -reach; j < reach && !b.failed; j++) {
        for (int32_t i = -reach; i < reach && !b.failed; i++) {
            add_cell(&b, i, j, true, fine, high);
            add_cell(&b, i, j, false, fine, high);
        }
    }
    gen_weld(&b, gen_weld_tolerance);
    sl_status status = gen_finish(&b, out);
    if (status == SL_OK) {
        status = gen_plant_dihedral(*out, 2, 6, 0.0, true);
        status = gen_planted(status == SL_OK ? gen_plant_mirrors(*out, "z", true) : status, out);
    }
    return status;
}
