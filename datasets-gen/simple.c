/* Shapes with a formula: sphere, torus, box. */
#include "base/memory.h"
#include "builder.h"
#include "grid.h"
#include "plant.h"

#include <math.h>

static const double pi = 3.14159265358979323846;

/* Of n meridians: the turns about y and the mirrors through it, and the mirror y -> -y. */
static sl_status plant_round(int32_t n, sl_generated **out)
{
    sl_status status = gen_plant_mirror(*out, "mirror y", 0.0, 1.0, 0.0, true);
    if (status == SL_OK) {
        status = gen_plant_dihedral(*out, 1, n, 0.0, true);
    }
    return gen_planted(status, out);
}

sl_status gen_sphere(uint64_t seed, int32_t scale, sl_generated **out)
{
    (void)seed; /* nothing random */
    const int32_t rings = gen_refined(36, scale), sectors = 2 * rings;
    gen_builder b = {0};
    const int32_t south = gen_vertex(&b, 0.0, -1.0, 0.0);
    for (int32_t i = 1; i < rings; i++) {
        const double theta = pi * i / rings;
        for (int32_t j = 0; j < sectors; j++) {
            const double phi = 2.0 * pi * j / sectors;
            gen_vertex(&b, sin(theta) * cos(phi), -cos(theta), -sin(theta) * sin(phi));
        }
    }
    const int32_t north = gen_vertex(&b, 0.0, 1.0, 0.0);
    for (int32_t j = 0; j < sectors; j++) {
        const int32_t k = (j + 1) % sectors, last = 1 + (rings - 2) * sectors;
        gen_triangle(&b, south, 1 + k, 1 + j);
        for (int32_t i = 0; i + 2 < rings; i++) {
            gen_quad(&b, 1 + i * sectors + j, 1 + i * sectors + k, 1 + (i + 1) * sectors + k,
                     1 + (i + 1) * sectors + j);
        }
        gen_triangle(&b, last + j, last + k, north);
    }
    const sl_status status = gen_finish(&b, out);
    return status != SL_OK ? status : plant_round(sectors, out);
}

sl_status gen_torus(uint64_t seed, int32_t scale, sl_generated **out)
{
    (void)seed;
    const int32_t m = gen_refined(72, scale), n = gen_refined(36, scale);
    const double major = 1.0, minor = 0.38;
    gen_builder b = {0};
    for (int32_t i = 0; i < m; i++) {
        for (int32_t j = 0; j < n; j++) {
            const double u = 2.0 * pi * i / m, v = 2.0 * pi * j / n, r = major + minor * cos(v);
            gen_vertex(&b, r * cos(u), minor * sin(v), -r * sin(u));
        }
    }
    for (int32_t i = 0; i < m; i++) {
        for (int32_t j = 0; j < n; j++) {
            const int32_t i1 = (i + 1) % m, j1 = (j + 1) % n;
            gen_quad(&b, i * n + j, i1 * n + j, i1 * n + j1, i * n + j1);
        }
    }
    const sl_status status = gen_finish(&b, out);
    return status != SL_OK ? status : plant_round(m, out);
}

/* Vertex of the box surface at grid point p, made when first met. */
static int32_t box_vertex(gen_builder *b, int32_t *made, const int32_t n[3], const int32_t p[3])
{
    const int64_t slot = p[0] + (int64_t)(n[0] + 1) * (p[1] + (int64_t)(n[1] + 1) * p[2]);
    if (made[slot] < 0) {
        made[slot] = gen_vertex(b, ((double)p[0] / n[0] - 0.5) * 1.3, ((double)p[1] / n[1] - 0.5) * 0.8,
                                (double)p[2] / n[2] - 0.5);
    }
    return made[slot];
}

/* One side of the box: axis is the normal, at its far end or its near one. */
static void box_side(gen_builder *b, int32_t *made, const int32_t n[3], int axis, bool far_end)
{
    const int u = (axis + 1) % 3, v = (axis + 2) % 3;
    for (int32_t i = 0; i < n[u]; i++) {
        for (int32_t j = 0; j < n[v]; j++) {
            int32_t corner[4];
            for (int k = 0; k < 4; k++) {
                int32_t p[3];
                p[axis] = far_end ? n[axis] : 0;
                p[u] = i + (k == 1 || k == 2);
                p[v] = j + (k == 2 || k == 3);
                corner[far_end ? k : 3 - k] = box_vertex(b, made, n, p);
            }
            gen_facet(b, 4, corner);
        }
    }
}

sl_status gen_box(uint64_t seed, int32_t scale, sl_generated **out)
{
    (void)seed;
    const int32_t n[3] = {gen_refined(26, scale), gen_refined(16, scale), gen_refined(20, scale)};
    const int64_t slots = (int64_t)(n[0] + 1) * (n[1] + 1) * (n[2] + 1);
    gen_builder b = {0};
    int32_t *made = sl_alloc(slots, sizeof *made);
    *out = NULL;
    if (made == NULL) {
        return SL_OUT_OF_MEMORY;
    }
    for (int64_t k = 0; k < slots; k++) {
        made[k] = -1;
    }
    for (int axis = 0; axis < 3; axis++) {
        box_side(&b, made, n, axis, false);
        box_side(&b, made, n, axis, true);
    }
    sl_free(made);
    sl_status status = gen_finish(&b, out);
    if (status == SL_OK) {
        status = gen_plant_mirrors(*out, "xyz", true);
    }
    return gen_planted(status, out);
}
