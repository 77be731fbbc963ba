/* What the tests of the baselines share: rotated meshes, whole pieces, energies from the definition. */
#ifndef SL_TEST_SEGMENT_BASELINES_H
#define SL_TEST_SEGMENT_BASELINES_H

#include "segment/baseline_internal.h"
#include "segment/checks.h"
#include "segment/vsa_internal.h"

/* A random rotation; rows are orthonormal, the determinant is 1. */
static inline void test_rotation(test_rng *rng, double R[3][3])
{
    double q[4], length = 0.0;
    for (int k = 0; k < 4; k++) {
        q[k] = test_uniform(rng, -1.0, 1.0) + (k == 0 ? 0.1 : 0.0);
        length += q[k] * q[k];
    }
    for (int k = 0; k < 4; k++) {
        q[k] /= sqrt(length);
    }
    const double w = q[0], x = q[1], y = q[2], z = q[3];
    const double m[3][3] = {{1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)},
                            {2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)},
                            {2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)}};
    memcpy(R, m, sizeof m);
}

/* x -> R x + shift for every vertex. */
static inline void test_move(sl_mesh *mesh, double R[3][3], const double shift[3])
{
    for (int32_t v = 0; v < mesh->nv; v++) {
        double *p = mesh->xyz + 3 * v;
        const double x[3] = {sl_vec3_dot(R[0], p), sl_vec3_dot(R[1], p), sl_vec3_dot(R[2], p)};
        sl_vec3_add(x, shift, p);
    }
}

static inline sl_piece *test_whole_piece(const sl_mesh *mesh, const sl_triangulation *t)
{
    int32_t *all = malloc((size_t)mesh->nf * sizeof *all);
    sl_piece *piece = NULL;
    for (int32_t f = 0; f < mesh->nf; f++) {
        all[f] = f;
    }
    assert_int_equal(sl_piece_create(mesh, t, all, mesh->nf, &piece), SL_OK);
    free(all);
    return piece;
}

/* A mesh as VSA sees it, a node a facet, with areas from this file's own sums. */
typedef struct test_surface {
    sl_facet_graph *graph;
    double *area, *vector;
    sl_vsa_surface vsa;
} test_surface;

static inline void test_triangle(const sl_mesh *m, const sl_triangulation *t, int32_t i, double normal[3], double *area)
{
    const double *p[3];
    double a[3], b[3];
    for (int k = 0; k < 3; k++) {
        p[k] = m->xyz + 3 * m->origin[t->corner[3 * i + k]];
    }
    sl_vec3_sub(p[2], p[1], a);
    sl_vec3_sub(p[0], p[1], b);
    sl_vec3_cross(a, b, normal);
    const double length = sl_vec3_norm(normal);
    *area = 0.5 * length;
    for (int k = 0; k < 3; k++) {
        normal[k] /= length;
    }
}

static inline test_surface test_surface_of(const sl_mesh *m, const sl_triangulation *t)
{
    test_surface s = {.graph = test_whole_graph(m, NULL),
                      .area = calloc((size_t)m->nf, sizeof(double)),
                      .vector = calloc(3 * (size_t)m->nf, sizeof(double))};
    for (int32_t f = 0; f < m->nf; f++) {
        for (int32_t i = t->first[f]; i < t->first[f + 1]; i++) {
            double normal[3], area;
            test_triangle(m, t, i, normal, &area);
            s.area[f] += area;
            for (int k = 0; k < 3; k++) {
                s.vector[3 * f + k] += area * normal[k];
            }
        }
    }
    s.vsa = (sl_vsa_surface){&s.graph->graph, s.area, s.vector};
    return s;
}

static inline void test_surface_clear(test_surface *s)
{
    sl_facet_graph_free(s->graph);
    free(s->area);
    free(s->vector);
}

/* Sum over the triangles of regions a and b (b may be -1) of area |n - N|^2, N their mean normal. */
static inline double test_region_energy(const sl_mesh *m, const sl_triangulation *t, const int32_t *region, int32_t a,
                                        int32_t b)
{
    double mean[3] = {0.0, 0.0, 0.0}, energy = 0.0;
    for (int pass = 0; pass < 2; pass++) {
        for (int32_t f = 0; f < m->nf; f++) {
            for (int32_t i = t->first[f]; (region[f] == a || region[f] == b) && i < t->first[f + 1]; i++) {
                double normal[3], d[3], area;
                test_triangle(m, t, i, normal, &area);
                sl_vec3_sub(normal, mean, d);
                energy += pass == 1 ? area * sl_vec3_dot(d, d) : 0.0;
                for (int k = 0; k < 3 && pass == 0; k++) {
                    mean[k] += area * normal[k];
                }
            }
        }
        const double length = sl_vec3_norm(mean);
        for (int k = 0; k < 3; k++) {
            mean[k] /= length;
        }
    }
    return energy;
}

static inline double test_energy(const sl_mesh *m, const sl_triangulation *t, const int32_t *region, int32_t count)
{
    double energy = 0.0;
    for (int32_t r = 0; r < count; r++) {
        energy += test_region_energy(m, t, region, r, -1);
    }
    return energy;
}

static inline bool test_regions_touch(const sl_mesh *m, const int32_t *region, int32_t a, int32_t b)
{
    for (int32_t h = 0; h < m->nh; h++) {
        if (m->twin[h] >= 0 && region[m->face[h]] == a && region[m->face[m->twin[h]]] == b) {
            return true;
        }
    }
    return false;
}

/* Every number is used, and every region hangs together. */
static inline void test_check_regions(const sl_mesh *m, const int32_t *region, int32_t count)
{
    int32_t *root = malloc((size_t)m->nf * sizeof *root), *parts = calloc(count > 0 ? (size_t)count : 1, sizeof *parts);
    for (int32_t f = 0; f < m->nf; f++) {
        assert_in_range(region[f], 0, count - 1);
        root[f] = f;
    }
    for (bool changed = true; changed;) {
        changed = false;
        for (int32_t h = 0; h < m->nh; h++) {
            const int32_t f = m->face[h], g = m->twin[h] >= 0 ? m->face[m->twin[h]] : f;
            if (region[f] == region[g] && root[g] < root[f]) {
                root[f] = root[g];
                changed = true;
            }
        }
    }
    for (int32_t f = 0; f < m->nf; f++) {
        parts[region[f]] += root[f] == f;
    }
    for (int32_t r = 0; r < count; r++) {
        assert_int_equal(parts[r], 1);
    }
    free(root);
    free(parts);
}

/* Bodies of several kinds, by number. */
static inline sl_mesh *test_body(test_rng *rng, int kind)
{
    switch (kind % 4) {
    case 0:
        return test_spiky_mesh(rng, 7, 0, 0.0, TEST_TRIANGLES);
    case 1:
        return test_spiky_mesh(rng, 8, 5, 1.2, TEST_MIXED);
    case 2:
        return test_torus_mesh(rng, 24, 12, 0.4, TEST_QUADS); /* its quads are not plane */
    default:
        return test_tube_mesh(rng, 12, 18, 5.0, TEST_MIXED);
    }
}

#endif
