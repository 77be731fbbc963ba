/* Meshes for the tests of this folder. */
#ifndef SL_TEST_RENDER_SUPPORT_H
#define SL_TEST_RENDER_SUPPORT_H

#include "support/test_support.h"

#include "base/memory.h"
#include "mesh/build.h"
#include "render/render.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* A bumpy torus of n x m quads; closed, curved, no symmetry. */
static inline sl_mesh *torus(int32_t n, int32_t m)
{
    double *xyz = sl_alloc((int64_t)n * m, 3 * sizeof *xyz);
    int32_t *first = sl_alloc((int64_t)n * m + 1, sizeof *first), *index = sl_alloc((int64_t)n * m, 4 * sizeof *index);
    assert_true(xyz != NULL && first != NULL && index != NULL);
    for (int32_t i = 0; i < n * m; i++) {
        const double u = 2.0 * TEST_PI * (i % n) / n, v = 2.0 * TEST_PI * (i / n) / m;
        const double r = 0.4 + 0.05 * sin(3.0 * u + v) + 0.03 * cos(2.0 * v);
        xyz[3 * i] = (1.0 + r * cos(v)) * cos(u);
        xyz[3 * i + 1] = r * sin(v);
        xyz[3 * i + 2] = (1.0 + r * cos(v)) * sin(u);
        const int32_t a = i, b = i / n * n + (i + 1) % n, c = (i / n + 1) % m * n + i % n,
                      d = (i / n + 1) % m * n + (i + 1) % n;
        const int32_t quad[4] = {a, c, d, b};
        memcpy(index + 4 * i, quad, sizeof quad);
        first[i] = 4 * i;
    }
    first[n * m] = 4 * n * m;
    const sl_polygons polygons = {n * m, n * m, xyz, first, index};
    sl_mesh *mesh = NULL;
    assert_int_equal(sl_mesh_build(&polygons, &mesh, NULL, NULL), SL_OK);
    sl_free(xyz);
    sl_free(first);
    sl_free(index);
    return mesh;
}

/* The unit cube. */
static inline sl_mesh *cube(void)
{
    static const int32_t index[24] = {0, 2, 3, 1, 4, 5, 7, 6, 0, 1, 5, 4, 2, 6, 7, 3, 0, 4, 6, 2, 1, 3, 7, 5};
    static const int32_t first[7] = {0, 4, 8, 12, 16, 20, 24};
    double xyz[24];
    for (int v = 0; v < 8; v++) {
        for (int k = 0; k < 3; k++) {
            xyz[3 * v + k] = (v >> k & 1) != 0 ? 1.0 : 0.0;
        }
    }
    const sl_polygons polygons = {8, 6, xyz, first, index};
    sl_mesh *mesh = NULL;
    assert_int_equal(sl_mesh_build(&polygons, &mesh, NULL, NULL), SL_OK);
    return mesh;
}

/* Each facet of the cube on its own square of a 3 x 2 layout with gaps. */
static inline void cube_uv(const sl_mesh *mesh, double *uv)
{
    static const double square[4][2] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
    for (int32_t h = 0; h < mesh->nh; h++) {
        const int32_t f = mesh->face[h], k = h - mesh->face_first[f];
        uv[2 * h] = 0.05 + 0.3 * (f % 3) + 0.25 * square[k][0];
        uv[2 * h + 1] = 0.1 + 0.4 * (f / 3) + 0.25 * square[k][1];
    }
}

static inline bool same_picture(const sl_image *a, const sl_image *b)
{
    return a->width == b->width && a->height == b->height && a->channels == b->channels &&
           memcmp(a->pixels, b->pixels, (size_t)a->width * (size_t)a->height * (size_t)a->channels) == 0;
}

#endif
