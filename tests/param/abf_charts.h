/* Small curved charts for the tests of flattening: no symmetry, shuffled vertices, several interior vertices. */
#ifndef SL_TEST_ABF_CHARTS_H
#define SL_TEST_ABF_CHARTS_H

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "mesh/patch.h"
#include "support/test_support.h"

typedef void chart_map(double u, double v, double parameter, double xyz[3]);

/* parameter: steepness. Three bumps off the middle. */
static inline void chart_bumps(double u, double v, double parameter, double xyz[3])
{
    xyz[0] = u;
    xyz[1] = 1.3 * v;
    xyz[2] =
        parameter * (0.31 * sin(3.1 * u + 0.4) * cos(2.3 * v) + 0.17 * exp(-9.0 * (u * u + (v - 0.3) * (v - 0.3))));
}

/* parameter: polar angle at distance 1 from the pole of a unit sphere; pi/2 = hemisphere. */
static inline void chart_cap(double u, double v, double parameter, double xyz[3])
{
    const double rho = sqrt(u * u + v * v), scale = rho > 0.0 ? sin(parameter * rho) / rho : parameter;
    xyz[0] = u * scale;
    xyz[1] = v * scale;
    xyz[2] = cos(parameter * rho);
}

/* parameter: slope; its apex is a vertex of the hexagonal chart. */
static inline void chart_cone(double u, double v, double parameter, double xyz[3])
{
    xyz[0] = u;
    xyz[1] = v;
    xyz[2] = parameter * sqrt(u * u + v * v);
}

/* An oblique plane. */
static inline void chart_plane(double u, double v, double parameter, double xyz[3])
{
    xyz[0] = 0.36 * u - 0.8 * v + parameter;
    xyz[1] = 0.48 * u + 0.6 * v;
    xyz[2] = 0.8 * u;
}

static inline sl_patch *chart_make(int32_t nv, const double *xyz, int32_t nt, const int32_t *tri)
{
    sl_patch *patch = NULL;
    assert_int_equal(sl_patch_from_triangles(nv, xyz, nt, tri, &patch), SL_OK);
    return patch;
}

/* Renames the vertices at random. */
static inline void chart_shuffle(int32_t nv, double *xyz, int32_t nt, int32_t *tri, test_rng *rng)
{
    int32_t *name = malloc((size_t)nv * sizeof *name);
    double *copy = malloc(3 * (size_t)nv * sizeof *copy);
    memcpy(copy, xyz, 3 * (size_t)nv * sizeof *copy);
    for (int32_t i = 0; i < nv; i++) {
        const int32_t j = test_index(rng, i + 1);
        name[i] = name[j];
        name[j] = i;
    }
    for (int32_t i = 0; i < nv; i++) {
        memcpy(&xyz[3 * name[i]], &copy[3 * i], 3 * sizeof *xyz);
    }
    for (int32_t c = 0; c < 3 * nt; c++) {
        tri[c] = name[tri[c]];
    }
    free(name);
    free(copy);
}

/* A hexagon of `rings` rings around a centre at (0, 0), radius 1, every inner vertex but the centre displaced by up to
 * `jitter` edge lengths; the map takes it into space. 3 r (r + 1) + 1 vertices, 6 r^2 triangles. */
static inline sl_patch *chart_hexagon(int32_t rings, double jitter, chart_map *map, double parameter, uint64_t seed)
{
    test_rng rng = test_rng_seed(seed);
    const int32_t width = 2 * rings + 1, nv = 3 * rings * (rings + 1) + 1;
    int32_t *index = malloc((size_t)(width * width) * sizeof *index),
            *tri = malloc(18 * (size_t)(rings * rings) * sizeof *tri);
    double *xyz = malloc(3 * (size_t)nv * sizeof *xyz);
    int32_t n = 0, nt = 0;
    for (int32_t i = 0; i < width * width; i++) {
        const int32_t q = i % width - rings, r = i / width - rings;
        const bool inside = abs(q + r) <= rings;
        index[i] = inside ? n : -1;
        if (inside) {
            const double size = q == 0 && r == 0 ? 0.0 : jitter / rings;
            const double u = (q + 0.5 * r) / rings + test_uniform(&rng, -size, size);
            const double v = sqrt(0.75) * r / rings + test_uniform(&rng, -size, size);
            map(u, v, parameter, &xyz[3 * n++]);
        }
    }
    for (int32_t i = 0; i + width + 1 < width * width; i++) {
        const int32_t a = index[i], b = index[i + 1], c = index[i + width], d = index[i + width + 1];
        if (i % width == width - 1) {
            continue;
        }
        if (a >= 0 && b >= 0 && c >= 0) {
            memcpy(&tri[3 * nt++], (int32_t[]){a, b, c}, 3 * sizeof *tri);
        }
        if (b >= 0 && d >= 0 && c >= 0) {
            memcpy(&tri[3 * nt++], (int32_t[]){b, d, c}, 3 * sizeof *tri);
        }
    }
    assert_int_equal(n, nv);
    assert_int_equal(nt, 6 * rings * rings);
    chart_shuffle(nv, xyz, nt, tri, &rng);
    sl_patch *patch = chart_make(nv, xyz, nt, tri);
    free(index);
    free(tri);
    free(xyz);
    return patch;
}

/* An m x n grid over [-1/2, 1/2]^2, jittered, each cell split along a random diagonal. */
static inline sl_patch *chart_grid(int32_t m, int32_t n, double jitter, chart_map *map, double parameter, uint64_t seed)
{
    test_rng rng = test_rng_seed(seed);
    const int32_t nv = (m + 1) * (n + 1);
    int32_t nt = 0, *tri = malloc(6 * (size_t)(m * n) * sizeof *tri);
    double *xyz = malloc(3 * (size_t)nv * sizeof *xyz);
    for (int32_t i = 0; i < nv; i++) {
        const double u = (i % (m + 1) + test_uniform(&rng, -jitter, jitter)) / m - 0.5;
        const double v = (double)(i / (m + 1)) / n + test_uniform(&rng, -jitter, jitter) / n - 0.5;
        map(u, v, parameter, &xyz[3 * i]);
    }
    for (int32_t i = 0; i < m * n; i++) {
        const int32_t a = i / m * (m + 1) + i % m, b = a + 1, c = a + m + 1, d = c + 1;
        const bool flip = test_index(&rng, 2) == 1;
        memcpy(&tri[3 * nt++], (int32_t[]){a, b, flip ? c : d}, 3 * sizeof *tri);
        memcpy(&tri[3 * nt++], (int32_t[]){flip ? b : a, d, c}, 3 * sizeof *tri);
    }
    chart_shuffle(nv, xyz, nt, tri, &rng);
    sl_patch *patch = chart_make(nv, xyz, nt, tri);
    free(tri);
    free(xyz);
    return patch;
}

/* Angle at corner k of three points, signed by their orientation. */
static inline double chart_angle(const double *a, const double *b, const double *c)
{
    const double x = b[0] - a[0], y = b[1] - a[1], z = c[0] - a[0], w = c[1] - a[1];
    return atan2(x * w - y * z, x * z + y * w);
}

/* Corner angles of a layout, negative in flipped triangles. */
static inline void chart_uv_angles(const sl_patch *patch, const double *uv, double *alpha)
{
    for (int32_t c = 0; c < 3 * patch->nt; c++) {
        const int32_t *v = patch->tri;
        alpha[c] = chart_angle(&uv[2 * v[c]], &uv[2 * v[sl_corner_next(c)]], &uv[2 * v[sl_corner_prev(c)]]);
    }
}

static inline double chart_area(const sl_patch *patch)
{
    double area = 0.0;
    for (int32_t t = 0; t < patch->nt; t++) {
        area += sl_patch_triangle_area(patch, t);
    }
    return area;
}

static inline double chart_uv_area(const sl_patch *patch, const double *uv)
{
    double area = 0.0;
    for (int32_t t = 0; t < patch->nt; t++) {
        const double *a = &uv[2 * patch->tri[3 * t]], *b = &uv[2 * patch->tri[3 * t + 1]],
                     *c = &uv[2 * patch->tri[3 * t + 2]];
        area += ((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])) / 2.0;
    }
    return area;
}

/* Largest |a[i] - b[i]|; NaN counts as infinite. */
static inline double chart_max_diff(const double *a, const double *b, int64_t n)
{
    double worst = 0.0;
    for (int64_t i = 0; i < n; i++) {
        const double d = fabs(a[i] - b[i]);
        worst = d <= worst ? worst : isnan(d) ? INFINITY : d;
    }
    return worst;
}

static inline int32_t chart_interior(const sl_patch *patch)
{
    int32_t count = 0;
    for (int32_t v = 0; v < patch->nv; v++) {
        count += patch->border[v] == 0;
    }
    return count;
}

/* Turns by a fixed rotation, moves, scales. */
static inline void chart_move(sl_patch *patch, double scale, const double shift[3])
{
    static const double turn[9] = {2.0 / 3, -1.0 / 3, 2.0 / 3, 2.0 / 3, 2.0 / 3, -1.0 / 3, -1.0 / 3, 2.0 / 3, 2.0 / 3};
    for (int32_t v = 0; v < patch->nv; v++) {
        double *x = &patch->xyz[3 * v], y[3];
        for (int k = 0; k < 3; k++) {
            y[k] = scale * (turn[3 * k] * x[0] + turn[3 * k + 1] * x[1] + turn[3 * k + 2] * x[2]) + shift[k];
        }
        memcpy(x, y, sizeof y);
    }
}

/* Cancels at the n-th call. */
static inline bool chart_cancel_after(void *user, const char *stage, double fraction)
{
    (void)stage;
    assert_true(fraction >= 0.0 && fraction <= 1.0);
    int *left = user;
    return (*left)-- > 0;
}

#endif
