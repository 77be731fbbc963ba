/* What must hold for every segmentation, judged without the room's own code. */
#ifndef SL_TEST_SEGMENT_CHECKS_H
#define SL_TEST_SEGMENT_CHECKS_H

#include "base/memory.h"
#include "geom/predicates.h"
#include "geom/vec3.h"
#include "segment/segment_internal.h"
#include "spectral/shapes.h"

static inline sl_triangulation *test_triangulate(const sl_mesh *mesh)
{
    sl_triangulation *t = NULL;
    assert_int_equal(sl_triangulation_create(mesh, &t), SL_OK);
    return t;
}

static inline void test_check_pointers(const sl_mesh *m)
{
    for (int32_t h = 0; h < m->nh; h++) {
        assert_true(m->twin[h] < 0 || (m->twin[m->twin[h]] == h && m->twin[h] != h));
        assert_true(m->sew[h] < 0 || (m->sew[m->sew[h]] == h && m->sew[h] != h));
        assert_true(m->twin[h] < 0 || m->sew[h] < 0);
    }
}

/* Every facet in exactly one chart; charts ascending, connected over twins, apart from one another. */
static inline void test_check_partition(const sl_mesh *m, const sl_segmentation *s)
{
    int32_t next = 0, *root = malloc((size_t)m->nf * sizeof *root), *parts = calloc((size_t)s->nchart, sizeof *parts);
    for (int32_t c = 0; c < s->nchart; c++) {
        assert_int_equal(s->chart[c].first, next);
        assert_true(s->chart[c].count > 0);
        for (int32_t k = 0; k < s->chart[c].count; k++, next++) {
            assert_true(k == 0 || s->face[next] > s->face[next - 1]);
            assert_int_equal(s->face_chart[s->face[next]], c);
        }
        assert_true(c == 0 || s->face[s->chart[c].first] > s->face[s->chart[c - 1].first]);
    }
    assert_int_equal(next, m->nf);
    for (int32_t f = 0; f < m->nf; f++) {
        root[f] = f;
    }
    for (bool changed = true; changed;) {
        changed = false;
        for (int32_t h = 0; h < m->nh; h++) {
            const int32_t f = m->face[h], g = m->twin[h] >= 0 ? m->face[m->twin[h]] : f;
            assert_int_equal(s->face_chart[f], s->face_chart[g]);
            if (root[g] < root[f]) {
                root[f] = root[g];
                changed = true;
            }
        }
    }
    for (int32_t f = 0; f < m->nf; f++) {
        parts[s->face_chart[f]] += root[f] == f;
    }
    for (int32_t c = 0; c < s->nchart; c++) {
        assert_int_equal(parts[c], 1);
    }
    free(root);
    free(parts);
}

/* Sander's L2 of one chart and its flips, from the metric tensor: no singular values as the measures use them. */
static inline double test_chart_stretch(const sl_mesh *m, const sl_triangulation *t, const sl_segmentation *s,
                                        int32_t c, int32_t *flips)
{
    double sum = 0.0, area_3d = 0.0, area_uv = 0.0;
    *flips = 0;
    for (int32_t k = 0; k < s->chart[c].count; k++) {
        const int32_t f = s->face[s->chart[c].first + k];
        for (int32_t i = t->first[f]; i < t->first[f + 1]; i++) {
            const int32_t *corner = t->corner + 3 * i;
            const double *p[3], *q[3];
            for (int32_t j = 0; j < 3; j++) {
                p[j] = m->xyz + 3 * m->origin[corner[j]];
                q[j] = s->corner_uv + 2 * corner[j];
            }
            const int turn = sl_orient2d(q[0], q[1], q[2]);
            *flips += (s->chart[c].mirrored ? -turn : turn) <= 0;
            double a[3], b[3], n[3];
            sl_vec3_sub(p[1], p[0], a);
            sl_vec3_sub(p[2], p[0], b);
            sl_vec3_cross(a, b, n);
            const double u1 = q[1][0] - q[0][0], v1 = q[1][1] - q[0][1], u2 = q[2][0] - q[0][0], v2 = q[2][1] - q[0][1];
            const double det = u1 * v2 - u2 * v1, area = 0.5 * sl_vec3_norm(n);
            double du = 0.0, dv = 0.0; /* squared lengths of the derivatives of the map from UV to 3D */
            for (int32_t j = 0; j < 3; j++) {
                const double x = (a[j] * v2 - b[j] * v1) / det, y = (b[j] * u1 - a[j] * u2) / det;
                du += x * x;
                dv += y * y;
            }
            sum += area * 0.5 * (du + dv);
            area_3d += area;
            area_uv += 0.5 * fabs(det);
        }
    }
    return sqrt(sum / area_3d * area_uv / area_3d);
}

/* Twins agree on the UVs of their edge. */
static inline void test_check_glued(const sl_mesh *m, const sl_segmentation *s)
{
    for (int32_t h = 0; h < m->nh; h++) {
        const int32_t o = m->twin[h] >= 0 ? sl_next(m, m->twin[h]) : h;
        assert_true(s->corner_uv[2 * h] == s->corner_uv[2 * o] && s->corner_uv[2 * h + 1] == s->corner_uv[2 * o + 1]);
    }
}

/* All of it. Returns the number of charts that are not valid. */
static inline int32_t test_check_segmentation(const sl_mesh *m, const sl_triangulation *t, const sl_segmentation *s,
                                              double max_stretch)
{
    int32_t invalid = 0;
    test_check_pointers(m);
    test_check_partition(m, s);
    test_check_glued(m, s);
    for (int32_t c = 0; c < s->nchart; c++) {
        const sl_chart *chart = &s->chart[c];
        sl_topology topology;
        assert_int_equal(sl_mesh_topology(m, s->face + chart->first, chart->count, &topology), SL_OK);
        assert_memory_equal(&topology, &chart->topology, sizeof topology);
        if (chart->flat.verdict != SL_CHART_VALID) {
            invalid++;
            assert_true(chart->capped || chart->count == 1);
            continue;
        }
        int32_t flips = 0;
        const double l2 = test_chart_stretch(m, t, s, c, &flips);
        assert_true(topology.genus == 0 && topology.loops == 1);
        assert_int_equal(flips, 0);
        assert_true(test_near(l2, chart->flat.distortion.l2, 1e-6 * l2));
        assert_true(chart->count == 1 || l2 <= max_stretch * (1.0 + 1e-9));
    }
    for (int32_t k = 0; k < s->nsplit; k++) {
        assert_true(s->split[k].parts >= 2 && s->split[k].facets >= s->split[k].parts);
        assert_true((s->split[k].vector < 0) == (s->split[k].candidates == 0));
    }
    return invalid;
}

#endif
