/* Meshes with symmetries known from how they are made. */
#ifndef SL_TEST_SYMMETRY_MODELS_H
#define SL_TEST_SYMMETRY_MODELS_H

#include <math.h>
#include <string.h>

#include "base/memory.h"
#include "mesh/build.h"
#include "support/test_support.h"

enum { MODEL_VERTICES = 40000, MODEL_CORNERS = 160000 };

typedef struct model {
    int32_t nv, nf;
    double *xyz;
    int32_t *first, *index;
} model;

static inline model model_new(void)
{
    model m = {0};
    m.xyz = sl_alloc(3 * MODEL_VERTICES, sizeof *m.xyz);
    m.first = sl_calloc(MODEL_CORNERS, sizeof *m.first);
    m.index = sl_alloc(MODEL_CORNERS, sizeof *m.index);
    assert_true(m.xyz != NULL && m.first != NULL && m.index != NULL);
    return m;
}

static inline void model_free(model *m)
{
    sl_free(m->xyz);
    sl_free(m->first);
    sl_free(m->index);
}

static inline int32_t model_vertex(model *m, double x, double y, double z)
{
    assert_true(m->nv < MODEL_VERTICES);
    m->xyz[3 * m->nv] = x;
    m->xyz[3 * m->nv + 1] = y;
    m->xyz[3 * m->nv + 2] = z;
    return m->nv++;
}

static inline void model_face(model *m, int32_t degree, const int32_t *corner)
{
    assert_true(m->first[m->nf] + degree <= MODEL_CORNERS);
    memcpy(m->index + m->first[m->nf], corner, (size_t)degree * sizeof *corner);
    m->first[m->nf + 1] = m->first[m->nf] + degree;
    m->nf++;
}

static inline void model_quad(model *m, int32_t a, int32_t b, int32_t c, int32_t d)
{
    model_face(m, 4, (const int32_t[4]){a, b, c, d});
}

static inline void model_triangle(model *m, int32_t a, int32_t b, int32_t c)
{
    model_face(m, 3, (const int32_t[3]){a, b, c});
}

static inline sl_mesh *model_build(const model *m)
{
    const sl_polygons polygons = {m->nv, m->nf, m->xyz, m->first, m->index};
    sl_mesh *mesh = NULL;
    assert_int_equal(sl_mesh_build(&polygons, &mesh, NULL, NULL), SL_OK);
    return mesh;
}

/* The first nf facets and nv vertices once more, moved by T; reversed: corners the other way round. */
static inline void model_repeat(model *m, int32_t nf, int32_t nv, const double T[12], bool reverse)
{
    const int32_t shift = m->nv;
    for (int32_t v = 0; v < nv; v++) {
        const double *x = &m->xyz[3 * v];
        double p[3];
        for (int k = 0; k < 3; k++) {
            p[k] = T[4 * k] * x[0] + T[4 * k + 1] * x[1] + T[4 * k + 2] * x[2] + T[4 * k + 3];
        }
        model_vertex(m, p[0], p[1], p[2]);
    }
    for (int32_t f = 0; f < nf; f++) {
        int32_t corner[16];
        const int32_t n = m->first[f + 1] - m->first[f];
        for (int32_t k = 0; k < n; k++) {
            corner[reverse ? n - 1 - k : k] = m->index[m->first[f] + k] + shift;
        }
        model_face(m, n, corner);
    }
}

/* A random rotation (a reflection where `reflect`), and a translation. */
static inline void model_random_isometry(test_rng *rng, bool reflect, double T[12])
{
    double q[4], norm = 0.0;
    for (int k = 0; k < 4; k++) {
        q[k] = test_uniform(rng, -1.0, 1.0);
        norm += q[k] * q[k];
    }
    for (int k = 0; k < 4; k++) {
        q[k] /= sqrt(norm);
    }
    const double w = q[0], x = q[1], y = q[2], z = q[3], s = reflect ? -1.0 : 1.0;
    const double R[9] = {1 - 2 * (y * y + z * z), 2 * (x * y - w * z),     2 * (x * z + w * y),
                         2 * (x * y + w * z),     1 - 2 * (x * x + z * z), 2 * (y * z - w * x),
                         2 * (x * z - w * y),     2 * (y * z + w * x),     1 - 2 * (x * x + y * y)};
    for (int i = 0; i < 3; i++) {
        for (int j = 0; j < 3; j++) {
            T[4 * i + j] = s * R[3 * i + j];
        }
        T[4 * i + 3] = test_uniform(rng, -5.0, 5.0);
    }
}

static inline void model_move(model *m, const double T[12])
{
    for (int32_t v = 0; v < m->nv; v++) {
        double *x = &m->xyz[3 * v], p[3];
        for (int k = 0; k < 3; k++) {
            p[k] = T[4 * k] * x[0] + T[4 * k + 1] * x[1] + T[4 * k + 2] * x[2] + T[4 * k + 3];
        }
        memcpy(x, p, sizeof p);
    }
}

static inline void model_perturb(model *m, test_rng *rng, double size)
{
    for (int32_t i = 0; i < 3 * m->nv; i++) {
        m->xyz[i] += test_uniform(rng, -size, size);
    }
}

static inline void model_shuffle(test_rng *rng, int32_t *order, int32_t n)
{
    for (int32_t i = 0; i < n; i++) {
        const int32_t j = test_index(rng, i + 1);
        order[i] = order[j];
        order[j] = i;
    }
}

/* Vertices, facets and first corners in random order. facet, vertex (nullable): new numbers. Facets stay in groups of
 * `group` neighbours. */
static inline void model_relabel(model *m, test_rng *rng, int32_t group, int32_t *facet, int32_t *vertex)
{
    model n = model_new();
    int32_t *order = sl_alloc(m->nf / group + 1, sizeof *order), *number = sl_alloc(m->nv, sizeof *number);
    assert_true(order != NULL && number != NULL);
    model_shuffle(rng, number, m->nv);
    model_shuffle(rng, order, m->nf / group);
    n.nv = m->nv;
    for (int32_t v = 0; v < m->nv; v++) {
        memcpy(&n.xyz[3 * number[v]], &m->xyz[3 * v], 3 * sizeof *n.xyz);
        if (vertex != NULL) {
            vertex[v] = number[v];
        }
    }
    for (int32_t i = 0; i < m->nf; i++) {
        const int32_t f = order[i / group] * group + i % group, d = m->first[f + 1] - m->first[f];
        const int32_t turn = test_index(rng, d);
        int32_t corner[16];
        for (int32_t k = 0; k < d; k++) {
            corner[k] = number[m->index[m->first[f] + (k + turn) % d]];
        }
        if (facet != NULL) {
            facet[f] = n.nf;
        }
        model_face(&n, d, corner);
    }
    model_free(m);
    *m = n;
    sl_free(order);
    sl_free(number);
}

/* A torus of n by k quads. */
static inline void model_torus(model *m, int32_t n, int32_t k)
{
    const int32_t base = m->nv;
    for (int32_t i = 0; i < n; i++) {
        for (int32_t j = 0; j < k; j++) {
            const double a = 2 * TEST_PI * i / n, b = 2 * TEST_PI * j / k, r = 2.0 + 0.7 * cos(b);
            model_vertex(m, r * cos(a), r * sin(a), 0.7 * sin(b));
        }
    }
    for (int32_t i = 0; i < n; i++) {
        for (int32_t j = 0; j < k; j++) {
            const int32_t i1 = (i + 1) % n, j1 = (j + 1) % k;
            model_quad(m, base + i * k + j, base + i1 * k + j, base + i1 * k + j1, base + i * k + j1);
        }
    }
}

static inline int32_t model_lattice(model *m, const int32_t size[3], int32_t *grid, const int32_t at[3])
{
    int32_t *v = &grid[(at[0] * (size[1] + 1) + at[1]) * (size[2] + 1) + at[2]];
    if (*v < 0) {
        *v = model_vertex(m, at[0] - 0.5 * size[0], at[1] - 0.5 * size[1], at[2] - 0.5 * size[2]);
    }
    return *v;
}

/* The surface of a box of unit cubes. */
static inline void model_box(model *m, int32_t nx, int32_t ny, int32_t nz)
{
    const int32_t size[3] = {nx, ny, nz}, cells = (nx + 1) * (ny + 1) * (nz + 1);
    int32_t *grid = sl_alloc(cells, sizeof *grid);
    assert_non_null(grid);
    for (int32_t i = 0; i < cells; i++) {
        grid[i] = -1;
    }
    for (int axis = 0; axis < 3; axis++) {
        const int u = (axis + 1) % 3, v = (axis + 2) % 3;
        for (int side = 0; side < 2; side++) {
            for (int32_t i = 0; i < size[u]; i++) {
                for (int32_t j = 0; j < size[v]; j++) {
                    int32_t corner[4];
                    for (int c = 0; c < 4; c++) {
                        int32_t at[3];
                        at[axis] = side * size[axis];
                        at[u] = i + (c == 1 || c == 2);
                        at[v] = j + (c >= 2);
                        corner[side == 1 ? c : 3 - c] = model_lattice(m, size, grid, at);
                    }
                    model_face(m, 4, corner);
                }
            }
        }
    }
    sl_free(grid);
}

/* Vertex halfway between a and b, on the unit sphere; shared by both directions. */
static inline int32_t model_middle(model *m, int32_t *known, int32_t n, int32_t a, int32_t b)
{
    int32_t *v = &known[a < b ? a * n + b : b * n + a];
    if (*v < 0) {
        double p[3], norm = 0.0;
        for (int k = 0; k < 3; k++) {
            p[k] = m->xyz[3 * a + k] + m->xyz[3 * b + k];
            norm += p[k] * p[k];
        }
        norm = sqrt(norm);
        *v = model_vertex(m, p[0] / norm, p[1] / norm, p[2] / norm);
    }
    return *v;
}

/* An icosahedron, each face cut into four `levels` times, on the unit sphere. */
static inline void model_icosphere(model *m, int32_t levels)
{
    static const int32_t tri[20][3] = {{0, 11, 5}, {0, 5, 1},  {0, 1, 7},   {0, 7, 10}, {0, 10, 11},
                                       {1, 5, 9},  {5, 11, 4}, {11, 10, 2}, {10, 7, 6}, {7, 1, 8},
                                       {3, 9, 4},  {3, 4, 2},  {3, 2, 6},   {3, 6, 8},  {3, 8, 9},
                                       {4, 9, 5},  {2, 4, 11}, {6, 2, 10},  {8, 6, 7},  {9, 8, 1}};
    const double t = (1.0 + sqrt(5.0)) / 2.0, s = sqrt(1.0 + t * t);
    const double p[12][3] = {{-1, t, 0},  {1, t, 0},  {-1, -t, 0}, {1, -t, 0}, {0, -1, t},  {0, 1, t},
                             {0, -1, -t}, {0, 1, -t}, {t, 0, -1},  {t, 0, 1},  {-t, 0, -1}, {-t, 0, 1}};
    for (int v = 0; v < 12; v++) {
        model_vertex(m, p[v][0] / s, p[v][1] / s, p[v][2] / s);
    }
    for (int f = 0; f < 20; f++) {
        model_triangle(m, tri[f][0], tri[f][1], tri[f][2]);
    }
    for (int32_t level = 0; level < levels; level++) {
        const int32_t n = m->nv, nf = m->nf;
        int32_t *known = sl_alloc((int64_t)n * n, sizeof *known);
        model finer = model_new();
        assert_non_null(known);
        memset(known, 0xff, (size_t)n * (size_t)n * sizeof *known);
        for (int32_t f = 0; f < nf; f++) {
            int32_t v[3], e[3];
            for (int k = 0; k < 3; k++) {
                v[k] = m->index[3 * f + k];
            }
            for (int k = 0; k < 3; k++) {
                e[k] = model_middle(m, known, n, v[k], v[(k + 1) % 3]);
            }
            model_triangle(&finer, v[0], e[0], e[2]);
            model_triangle(&finer, e[0], v[1], e[1]);
            model_triangle(&finer, e[2], e[1], v[2]);
            model_triangle(&finer, e[0], e[1], e[2]);
        }
        memcpy(finer.xyz, m->xyz, 3 * (size_t)m->nv * sizeof *m->xyz);
        finer.nv = m->nv;
        model_free(m);
        *m = finer;
        sl_free(known);
    }
}

/* A curved sheet of quads, triangles and merged facets, symmetric under x -> -x: columns 0 .. n - 1 lie at x > 0, rows
 * 0 .. k - 1; the plane runs along the edges left of column 0, or through an extra column of quads (straddle). Random
 * heights, random merging, the same on both sides. quads: nothing but quads. mirror: nv, image of each vertex. */
static inline void model_planted(model *m, test_rng *rng, int32_t n, int32_t k, bool straddle, bool quads,
                                 int32_t *mirror)
{
    int32_t *right = sl_alloc((int64_t)(n + 1) * (k + 1), sizeof *right);
    int32_t *left = sl_alloc((int64_t)(n + 1) * (k + 1), sizeof *left);
    assert_true(right != NULL && left != NULL);
    for (int32_t i = 0; i <= n; i++) {
        for (int32_t j = 0; j <= k; j++) {
            const int32_t at = i * (k + 1) + j;
            const double x = i == 0 && !straddle ? 0.0 : i + 0.5 + test_uniform(rng, -0.2, 0.2);
            const double y = j + test_uniform(rng, -0.2, 0.2), z = test_uniform(rng, -0.3, 0.3) + 0.1 * x * y;
            right[at] = left[at] = model_vertex(m, x, y, z);
            if (i > 0 || straddle) {
                left[at] = model_vertex(m, -x, y, z);
            }
            mirror[right[at]] = left[at];
            mirror[left[at]] = right[at];
        }
    }
    for (int32_t i = 0; i < n; i++) {
        for (int32_t j = 0; j < k; j++) {
            const int32_t how = quads ? 0 : test_index(rng, 3),
                          at[4] = {i * (k + 1) + j, (i + 1) * (k + 1) + j, (i + 1) * (k + 1) + j + 1,
                                   i * (k + 1) + j + 1};
            for (int side = 0; side < 2; side++) {
                const int32_t *v = side == 0 ? right : left;
                const int32_t c[4] = {v[at[0]], v[at[1]], v[at[2]], v[at[3]]};
                const bool flip = side == 1;
                if (how == 0) {
                    model_quad(m, c[0], c[flip ? 3 : 1], c[2], c[flip ? 1 : 3]);
                } else {
                    const int32_t o = how - 1; /* diagonal from corner o */
                    model_triangle(m, c[o], c[flip ? o + 2 : o + 1], c[flip ? o + 1 : o + 2]);
                    model_triangle(m, c[o], c[flip ? (o + 3) % 4 : o + 2], c[flip ? o + 2 : (o + 3) % 4]);
                }
            }
        }
    }
    for (int32_t j = 0; j < k && straddle; j++) {
        model_quad(m, left[j], right[j], right[j + 1], left[j + 1]);
    }
    sl_free(right);
    sl_free(left);
}

#endif
