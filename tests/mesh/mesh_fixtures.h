/* Polygon soups for the tests of meshes: grids glued into bands, tori, Moebius strips and Klein bottles, random dirt.
 */
#ifndef SL_TEST_MESH_FIXTURES_H
#define SL_TEST_MESH_FIXTURES_H

#include <math.h>

#include "mesh/build.h"
#include "support/test_support.h"

enum { SOUP_VERTICES = 1600, SOUP_FACES = 3200, SOUP_CORNERS = 9600 };

typedef struct soup {
    int32_t nv, nf;
    double xyz[3 * SOUP_VERTICES];
    int32_t first[SOUP_FACES + 1];
    int32_t index[SOUP_CORNERS];
} soup;

static inline sl_polygons soup_polygons(const soup *s)
{
    return (sl_polygons){s->nv, s->nf, s->xyz, s->first, s->index};
}

static inline void soup_clear(soup *s)
{
    s->nv = s->nf = 0;
    s->first[0] = 0;
}

static inline int32_t soup_vertex(soup *s, double x, double y, double z)
{
    s->xyz[3 * s->nv] = x;
    s->xyz[3 * s->nv + 1] = y;
    s->xyz[3 * s->nv + 2] = z;
    return s->nv++;
}

static inline void soup_face(soup *s, int32_t degree, const int32_t *corner)
{
    for (int32_t k = 0; k < degree; k++) {
        s->index[s->first[s->nf] + k] = corner[k];
    }
    s->first[s->nf + 1] = s->first[s->nf] + degree;
    s->nf++;
}

static inline void soup_random_vertices(soup *s, test_rng *rng, int32_t n)
{
    for (int32_t v = 0; v < n; v++) {
        soup_vertex(s, test_uniform(rng, -3.0, 5.0), test_uniform(rng, 1.0, 2.0), test_uniform(rng, -7.0, -1.0));
    }
}

typedef enum soup_surface { SOUP_SHEET, SOUP_BAND, SOUP_TORUS, SOUP_MOEBIUS, SOUP_KLEIN } soup_surface;

/* Vertex (i, j) of an n x m grid of quads after gluing; rows of m + 1 vertices, or m where j wraps. */
static inline int32_t soup_grid_vertex(soup_surface kind, int32_t n, int32_t m, int32_t i, int32_t j)
{
    const bool wraps_j = kind == SOUP_TORUS || kind == SOUP_KLEIN, twisted = kind == SOUP_MOEBIUS || kind == SOUP_KLEIN;
    const int32_t row = wraps_j ? m : m + 1;
    if (i == n && kind != SOUP_SHEET) {
        i = 0;
        j = twisted ? m - j : j;
    }
    return i * row + (wraps_j ? j % m : j);
}

/* An n x m grid of quads glued into a surface; vertices lie on a bumpy torus (so all facets have area and none is
 * flat); share of the quads in [0, 1] cut into two triangles by a random diagonal. */
static inline void soup_grid(soup *s, test_rng *rng, soup_surface kind, int32_t n, int32_t m, double cut_share)
{
    soup_clear(s);
    const bool wraps_j = kind == SOUP_TORUS || kind == SOUP_KLEIN;
    const int32_t rows = kind == SOUP_SHEET ? n + 1 : n, row = wraps_j ? m : m + 1;
    for (int32_t i = 0; i < rows; i++) {
        for (int32_t j = 0; j < row; j++) {
            const double u = 2.0 * TEST_PI * i / (kind == SOUP_SHEET ? 1.5 * n : n);
            const double v = 2.0 * TEST_PI * j / (wraps_j ? m : 1.5 * m), r = 1.0 + test_uniform(rng, 0.0, 0.02);
            soup_vertex(s, (3.0 + r * cos(v)) * cos(u), (3.0 + r * cos(v)) * sin(u), r * sin(v));
        }
    }
    for (int32_t i = 0; i < n; i++) {
        for (int32_t j = 0; j < m; j++) {
            const int32_t q[4] = {soup_grid_vertex(kind, n, m, i, j), soup_grid_vertex(kind, n, m, i + 1, j),
                                  soup_grid_vertex(kind, n, m, i + 1, j + 1), soup_grid_vertex(kind, n, m, i, j + 1)};
            if (test_uniform(rng, 0.0, 1.0) >= cut_share) {
                soup_face(s, 4, q);
                continue;
            }
            const int32_t d = test_index(rng, 2);
            soup_face(s, 3, (int32_t[]){q[d], q[d + 1], q[d + 2]});
            soup_face(s, 3, (int32_t[]){q[d], q[d + 2], q[(d + 3) % 4]});
        }
    }
}

/* Reverses each facet with the given probability and starts each at a random corner. */
static inline void soup_scramble(soup *s, test_rng *rng, double reverse_share)
{
    for (int32_t f = 0; f < s->nf; f++) {
        const int32_t d = s->first[f + 1] - s->first[f], shift = test_index(rng, d);
        const bool reverse = test_uniform(rng, 0.0, 1.0) < reverse_share;
        int32_t corner[64];
        for (int32_t k = 0; k < d; k++) {
            corner[k] = s->index[s->first[f] + (reverse ? d - 1 - (k + shift) % d : (k + shift) % d)];
        }
        for (int32_t k = 0; k < d; k++) {
            s->index[s->first[f] + k] = corner[k];
        }
    }
}

/* Random polygons of 3 to 5 corners on few vertices: non-manifold edges, bowties, duplicates, repeated corners. Small
 * integer coordinates, so that zero areas are exact and do occur. */
static inline void soup_random(soup *s, test_rng *rng, int32_t nv, int32_t nf)
{
    soup_clear(s);
    for (int32_t v = 0; v < nv; v++) {
        soup_vertex(s, test_index(rng, 9), test_index(rng, 9), test_index(rng, 3));
    }
    for (int32_t f = 0; f < nf; f++) {
        int32_t corner[5];
        const int32_t d = test_index(rng, 4) > 0 ? 3 : 3 + test_index(rng, 3);
        for (int32_t k = 0; k < d; k++) {
            corner[k] = test_index(rng, nv);
            for (int32_t j = 0; j < k && test_index(rng, 16) > 0; j++) {
                if (corner[j] == corner[k]) {
                    corner[k] = test_index(rng, nv);
                    j = -1;
                }
            }
        }
        if (f > 0 && test_index(rng, 8) == 0) {
            const int32_t g = test_index(rng, f), n = s->first[g + 1] - s->first[g];
            for (int32_t k = 0; k < n; k++) {
                corner[k] = s->index[s->first[g] + n - 1 - k];
            }
            soup_face(s, n, corner);
        } else {
            soup_face(s, d, corner);
        }
    }
}

/* Builds what must be buildable. */
static inline sl_mesh *soup_build(const soup *s, sl_repair_report *report)
{
    const sl_polygons p = soup_polygons(s);
    sl_mesh *mesh = NULL;
    sl_diag diag = sl_diag_none();
    assert_int_equal(sl_mesh_build(&p, &mesh, report, &diag), SL_OK);
    return mesh;
}

#endif
