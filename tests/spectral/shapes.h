/* Meshes made in the test: jittered grids bent into patches, tubes, tori, spheres and spiky bodies. */
#ifndef SL_TEST_SPECTRAL_SHAPES_H
#define SL_TEST_SPECTRAL_SHAPES_H

#include "mesh/build.h"
#include "mesh/facet_graph.h"
#include "mesh/triangulate.h"
#include "support/test_support.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

typedef enum test_facets { TEST_TRIANGLES, TEST_QUADS, TEST_MIXED } test_facets;

/* The mesh of these polygons, whose arrays (malloc) it frees. */
static inline sl_mesh *test_mesh_of(int32_t nv, int32_t nf, double *xyz, int32_t *first, int32_t *index)
{
    const sl_polygons polygons = {nv, nf, xyz, first, index};
    sl_mesh *mesh = NULL;
    sl_diag diag = sl_diag_none();
    assert_int_equal(sl_mesh_build(&polygons, &mesh, NULL, &diag), SL_OK);
    free(xyz);
    free(first);
    free(index);
    return mesh;
}

/* A grid of nu x nv cells; wrapped directions share their first and last line of vertices. */
typedef struct test_grid {
    int32_t nu, nv;
    bool wrap_u, wrap_v;
    test_facets facets;
    double *xyz; /* vertex (i, j) at i * columns + j */
    int32_t rows, columns;
} test_grid;

static inline test_grid test_grid_make(int32_t nu, int32_t nv, bool wrap_u, bool wrap_v, test_facets facets)
{
    test_grid g = {nu, nv, wrap_u, wrap_v, facets, NULL, wrap_u ? nu : nu + 1, wrap_v ? nv : nv + 1};
    g.xyz = malloc(3 * (size_t)(g.rows * g.columns) * sizeof *g.xyz);
    return g;
}

static inline double *test_grid_point(const test_grid *g, int32_t i, int32_t j)
{
    return g->xyz + 3 * ((i % g->rows) * g->columns + j % g->columns);
}

/* The mesh of a grid without the cells where drop[cell] is set (NULL = none); frees the grid. */
static inline sl_mesh *test_grid_mesh(test_grid *g, test_rng *rng, const uint8_t *drop)
{
    int32_t *first = malloc((size_t)(2 * g->nu * g->nv + 1) * sizeof *first);
    int32_t *index = malloc((size_t)(6 * g->nu * g->nv) * sizeof *index), nf = 0, n = 0;
    first[0] = 0;
    for (int32_t i = 0; i < g->nu; i++) {
        for (int32_t j = 0; j < g->nv; j++) {
            if (drop != NULL && drop[i * g->nv + j]) {
                continue;
            }
            int32_t corner[4];
            for (int32_t k = 0; k < 4; k++) {
                const int32_t a = i + (k == 1 || k == 2), b = j + (k >= 2);
                corner[k] = (a % g->rows) * g->columns + b % g->columns;
            }
            const bool split = g->facets == TEST_TRIANGLES || (g->facets == TEST_MIXED && test_index(rng, 2) == 0);
            const int32_t turn = test_index(rng, 2);
            for (int32_t k = 0; k < 4; k++) { /* a b c d, or a b c and a c d along either diagonal */
                index[n++] = corner[(k + turn) % 4];
                if (split && k == 2) {
                    first[++nf] = n;
                    index[n++] = corner[turn];
                    index[n++] = corner[2 + turn];
                }
            }
            first[++nf] = n;
        }
    }
    double *xyz = g->xyz;
    g->xyz = NULL;
    return test_mesh_of(g->rows * g->columns, nf, xyz, first, index);
}

/* A curved patch with random heights. */
static inline sl_mesh *test_patch_mesh(test_rng *rng, int32_t nu, int32_t nv, test_facets facets, const uint8_t *drop)
{
    test_grid g = test_grid_make(nu, nv, false, false, facets);
    for (int32_t i = 0; i < g.rows; i++) {
        for (int32_t j = 0; j < g.columns; j++) {
            double *p = test_grid_point(&g, i, j);
            p[0] = i + test_uniform(rng, -0.3, 0.3);
            p[1] = j + test_uniform(rng, -0.3, 0.3);
            p[2] = 0.4 * sin(0.7 * i) * cos(0.9 * j) + test_uniform(rng, -0.1, 0.1);
        }
    }
    return test_grid_mesh(&g, rng, drop);
}

static inline sl_mesh *test_torus_mesh(test_rng *rng, int32_t nu, int32_t nv, double thick, test_facets facets)
{
    test_grid g = test_grid_make(nu, nv, true, true, facets);
    for (int32_t i = 0; i < nu; i++) {
        for (int32_t j = 0; j < nv; j++) {
            const double u = 2.0 * TEST_PI * (i + test_uniform(rng, -0.2, 0.2)) / nu;
            const double v = 2.0 * TEST_PI * (j + test_uniform(rng, -0.2, 0.2)) / nv;
            double *p = test_grid_point(&g, i, j);
            p[0] = (1.0 + thick * cos(v)) * cos(u);
            p[1] = (1.0 + thick * cos(v)) * sin(u);
            p[2] = thick * sin(v);
        }
    }
    return test_grid_mesh(&g, rng, NULL);
}

/* A tube open at both ends, bent. */
static inline sl_mesh *test_tube_mesh(test_rng *rng, int32_t around, int32_t along, double length, test_facets facets)
{
    test_grid g = test_grid_make(along, around, false, true, facets);
    for (int32_t i = 0; i < g.rows; i++) {
        for (int32_t j = 0; j < around; j++) {
            const double t = length * (i + test_uniform(rng, -0.2, 0.2)) / along;
            const double a = 2.0 * TEST_PI * (j + test_uniform(rng, -0.2, 0.2)) / around;
            double *p = test_grid_point(&g, i, j);
            p[0] = t;
            p[1] = cos(a) + 0.3 * sin(t);
            p[2] = sin(a);
        }
    }
    return test_grid_mesh(&g, rng, NULL);
}

/* A closed box of half extents a, jittered lines of vertices on each edge direction, n[k] cells along axis k. The side
 * of a facet is face_side[f] = 2 k + (positive). */
static inline sl_mesh *test_box_mesh(test_rng *rng, const double a[3], const int32_t n[3], test_facets facets,
                                     int32_t *face_side)
{
    enum { MOST = 16 };
    double line[3][MOST + 1], *xyz = malloc(3 * 6 * (MOST + 1) * (MOST + 1) * sizeof *xyz);
    int32_t name[MOST + 1][MOST + 1][MOST + 1], nv = 0, nf = 0, corners = 0;
    int32_t *first = malloc((12 * MOST * MOST + 1) * sizeof *first), *index = malloc(36 * MOST * MOST * sizeof *index);
    for (int k = 0; k < 3; k++) {
        for (int32_t i = 0; i <= n[k]; i++) {
            const double jitter = i > 0 && i < n[k] ? test_uniform(rng, -0.3, 0.3) : 0.0;
            line[k][i] = a[k] * (2.0 * (i + jitter) / n[k] - 1.0);
        }
    }
    memset(name, -1, sizeof name);
    first[0] = 0;
    for (int32_t side = 0; side < 6; side++) {
        const int k = side / 2, u = (k + 1) % 3, v = (k + 2) % 3;
        for (int32_t cell = 0; cell < n[u] * n[v]; cell++) {
            int32_t quad[4];
            for (int c = 0; c < 4; c++) {
                int32_t at[3];
                const int corner = side % 2 == 1 ? c : 3 - c;
                at[k] = side % 2 == 1 ? n[k] : 0;
                at[u] = cell / n[v] + (corner == 1 || corner == 2);
                at[v] = cell % n[v] + (corner >= 2);
                int32_t *q = &name[at[0]][at[1]][at[2]];
                if (*q < 0) {
                    *q = nv++;
                    for (int d = 0; d < 3; d++) {
                        xyz[3 * *q + d] = line[d][at[d]];
                    }
                }
                quad[c] = *q;
            }
            const bool split = facets == TEST_TRIANGLES || (facets == TEST_MIXED && test_index(rng, 2) == 0);
            const int32_t turn = test_index(rng, 2);
            for (int32_t c = 0; c < 4; c++) {
                index[corners++] = quad[(c + turn) % 4];
                if (split && c == 2) {
                    face_side[nf] = side;
                    first[++nf] = corners;
                    index[corners++] = quad[turn];
                    index[corners++] = quad[2 + turn];
                }
            }
            face_side[nf] = side;
            first[++nf] = corners;
        }
    }
    return test_mesh_of(nv, nf, xyz, first, index);
}

/* A closed body: six bent grids of a cube blown up to radius(direction), spikes[3 k ..] directions of bumps of given
 * height. */
static inline sl_mesh *test_spiky_mesh(test_rng *rng, int32_t n, int32_t nspike, double height, test_facets facets)
{
    const int32_t side = n + 1, total = 6 * side * side;
    double *xyz = malloc(3 * (size_t)total * sizeof *xyz), spike[3 * 16];
    int32_t *name = malloc((size_t)total * sizeof *name), nv = 0;
    for (int32_t k = 0; k < nspike; k++) { /* spread over the sphere, jittered */
        const double z = 1.0 - (2.0 * k + 1.0) / nspike, a = 2.399963 * k + test_uniform(rng, -0.2, 0.2);
        spike[3 * k] = sqrt(1.0 - z * z) * cos(a);
        spike[3 * k + 1] = sqrt(1.0 - z * z) * sin(a);
        spike[3 * k + 2] = z;
    }
    for (int32_t p = 0; p < total; p++) { /* points on the cube, those on its edges shared */
        const int32_t face = p / (side * side), i = p / side % side, j = p % side;
        double c[3];
        c[face / 2] = face % 2 == 0 ? -1.0 : 1.0;
        c[(face / 2 + 1) % 3] = 2.0 * i / n - 1.0;
        c[(face / 2 + 2) % 3] = 2.0 * j / n - 1.0;
        name[p] = -1;
        const bool shared = i == 0 || i == n || j == 0 || j == n;
        for (int32_t q = 0; shared && q < nv && name[p] < 0; q++) {
            const double d = fabs(xyz[3 * q] - c[0]) + fabs(xyz[3 * q + 1] - c[1]) + fabs(xyz[3 * q + 2] - c[2]);
            name[p] = d < 1e-9 ? q : -1;
        }
        if (name[p] < 0) {
            memcpy(xyz + 3 * nv, c, sizeof c);
            name[p] = nv++;
        }
    }
    for (int32_t q = 0; q < nv; q++) {
        double *c = xyz + 3 * q, r = 1.0;
        const double length = sqrt(c[0] * c[0] + c[1] * c[1] + c[2] * c[2]);
        for (int32_t k = 0; k < nspike; k++) {
            const double dot = (c[0] * spike[3 * k] + c[1] * spike[3 * k + 1] + c[2] * spike[3 * k + 2]) / length;
            r += height * exp(-14.0 * (1.0 - dot));
        }
        for (int32_t k = 0; k < 3; k++) {
            c[k] = r * c[k] / length + test_uniform(rng, -0.1, 0.1) / n;
        }
    }
    int32_t *first = malloc((size_t)(12 * n * n + 1) * sizeof *first), nf = 0, corners = 0;
    int32_t *index = malloc((size_t)(36 * n * n) * sizeof *index);
    first[0] = 0;
    for (int32_t cell = 0; cell < 6 * n * n; cell++) {
        const int32_t face = cell / (n * n), base = face * side * side + cell / n % n * side + cell % n;
        const int32_t quad[4] = {base, base + side, base + side + 1, base + 1};
        const bool split = facets == TEST_TRIANGLES || (facets == TEST_MIXED && test_index(rng, 2) == 0);
        const int32_t turn = test_index(rng, 2);
        for (int32_t k = 0; k < 4; k++) {
            const int32_t at = (face % 2 == 0 ? 3 - k : k) + turn;
            index[corners++] = name[quad[at % 4]];
            if (split && k == 2) {
                index[corners] = index[corners - 3];
                index[corners + 1] = index[corners - 1];
                corners += 2;
                first[++nf] = corners - 2;
            }
        }
        first[++nf] = corners;
    }
    free(name);
    return test_mesh_of(nv, nf, xyz, first, index);
}

/* The facet graph of a whole mesh. */
static inline sl_facet_graph *test_whole_graph(const sl_mesh *mesh, const int32_t *partner)
{
    sl_facet_graph *graph = NULL;
    int32_t *all = malloc((size_t)mesh->nf * sizeof *all);
    for (int32_t f = 0; f < mesh->nf; f++) {
        all[f] = f;
    }
    assert_int_equal(sl_facet_graph_create(mesh, all, mesh->nf, partner, &graph), SL_OK);
    free(all);
    return graph;
}

#endif
