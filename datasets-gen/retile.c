#include "retile.h"

#include "base/memory.h"
#include "builder.h"
#include "geom/vec3.h"

#include <math.h>
#include <stdlib.h>

/* Cosines: of the bend at which a quad is split, and of the one up to which two quads are joined. */
static const double split_cosine = 0.966, join_cosine = 0.9998;

typedef struct half_edge {
    uint64_t key; /* its two vertices, the smaller first */
    int32_t half; /* 4 f + k */
} half_edge;

typedef struct tiling {
    const sl_generated *mesh;
    int32_t half;      /* facets of the half modelled */
    int32_t *opposite; /* 4 half: the halfedge across, -1 = none in this half */
    int32_t *partner;  /* half: halfedge to the facet it is joined with, -1 = alone, -2 = taken by another */
} tiling;

static int compare_edges(const void *a, const void *b)
{
    const half_edge *x = a, *y = b;
    if (x->key != y->key) {
        return x->key < y->key ? -1 : 1;
    }
    return x->half < y->half ? -1 : x->half > y->half;
}

static int32_t vertex_of(const tiling *t, int32_t f, int k)
{
    return t->mesh->index[4 * (int64_t)f + (k & 3)];
}

static sl_status find_opposites(tiling *t)
{
    const int64_t n = 4 * (int64_t)t->half;
    half_edge *edge = sl_alloc(n, sizeof *edge);
    if (edge == NULL) {
        return SL_OUT_OF_MEMORY;
    }
    for (int32_t h = 0; h < n; h++) {
        const int32_t a = vertex_of(t, h / 4, h % 4), b = vertex_of(t, h / 4, h % 4 + 1);
        edge[h] = (half_edge){(uint64_t)(a < b ? a : b) << 32 | (uint64_t)(a < b ? b : a), h};
        t->opposite[h] = -1;
    }
    qsort(edge, (size_t)n, sizeof *edge, compare_edges);
    for (int64_t i = 1; i < n; i++) {
        if (edge[i].key == edge[i - 1].key) {
            t->opposite[edge[i].half] = edge[i - 1].half;
            t->opposite[edge[i - 1].half] = edge[i].half;
        }
    }
    sl_free(edge);
    return SL_OK;
}

/* Unit normal of the triangle at corners i, j, k of a facet. */
static void normal_of(const tiling *t, int32_t f, int i, int j, int k, double normal[3])
{
    const double *p = t->mesh->xyz + 3 * (int64_t)vertex_of(t, f, i);
    double u[3], v[3];
    sl_vec3_sub(t->mesh->xyz + 3 * (int64_t)vertex_of(t, f, j), p, u);
    sl_vec3_sub(t->mesh->xyz + 3 * (int64_t)vertex_of(t, f, k), p, v);
    sl_vec3_cross(u, v, normal);
    const double norm = sl_vec3_norm(normal);
    for (int axis = 0; axis < 3; axis++) {
        normal[axis] = norm > 0.0 ? normal[axis] / norm : 0.0;
    }
}

/* Which corner the shorter diagonal starts from, 0 or 1. */
static int diagonal_of(const tiling *t, int32_t f)
{
    double length[2];
    for (int k = 0; k < 2; k++) {
        length[k] = sl_vec3_distance(t->mesh->xyz + 3 * (int64_t)vertex_of(t, f, k),
                                     t->mesh->xyz + 3 * (int64_t)vertex_of(t, f, k + 2));
    }
    return length[1] < length[0];
}

/* Cosine of the bend of a quad along that diagonal. */
static double bend_of(const tiling *t, int32_t f)
{
    const int d = diagonal_of(t, f);
    double a[3], b[3];
    normal_of(t, f, d, d + 1, d + 2, a);
    normal_of(t, f, d, d + 2, d + 3, b);
    return sl_vec3_dot(a, b);
}

/* May f and the facet across its side k become one? Flat each and together, and with six different corners. */
static bool joins(const tiling *t, int32_t f, int k)
{
    const int32_t h = t->opposite[4 * f + k], g = h < 0 ? -1 : h / 4;
    double a[3], b[3];
    if (g <= f || t->partner[g] != -1 || bend_of(t, f) < join_cosine || bend_of(t, g) < join_cosine) {
        return false;
    }
    for (int i = 2; i < 4; i++) {
        for (int j = 2; j < 4; j++) {
            if (vertex_of(t, f, k + i) == vertex_of(t, g, h % 4 + j)) {
                return false;
            }
        }
    }
    normal_of(t, f, 0, 1, 2, a);
    normal_of(t, g, 0, 1, 2, b);
    return sl_vec3_dot(a, b) >= join_cosine;
}

static void find_partners(tiling *t)
{
    for (int32_t f = 0; f < t->half; f++) {
        t->partner[f] = -1;
    }
    for (int32_t f = 0; f < t->half; f++) {
        for (int k = 0; k < 4 && t->partner[f] == -1; k++) {
            if (joins(t, f, k)) {
                t->partner[f] = 4 * f + k;
                t->partner[t->opposite[4 * f + k] / 4] = -2;
            }
        }
    }
}

/* A facet given by corners of the half modelled, or its image, from the same corner on: corner k of f is corner -k
 * (mod 4) of its image. */
static void add_facet(const tiling *t, gen_builder *b, bool image, int32_t n, const int32_t *halfedge)
{
    int32_t corner[6];
    for (int32_t i = 0; i < n; i++) {
        const int32_t h = halfedge[image ? (n - i) % n : i];
        corner[i] = image ? vertex_of(t, t->half + h / 4, 4 - h % 4) : vertex_of(t, h / 4, h % 4);
    }
    gen_facet(b, n, corner);
}

static void add_tiles(const tiling *t, gen_builder *b, bool image)
{
    for (int32_t f = 0; f < t->half; f++) {
        const int32_t h = 4 * f;
        if (t->partner[f] >= 0) {
            const int32_t k = t->partner[f] % 4, o = t->opposite[t->partner[f]], g = o - o % 4;
            add_facet(t, b, image, 6,
                      (int32_t[]){h + (k + 1) % 4, h + (k + 2) % 4, h + (k + 3) % 4, g + (o + 1) % 4, g + (o + 2) % 4,
                                  g + (o + 3) % 4});
        } else if (t->partner[f] == -1 && bend_of(t, f) < split_cosine) {
            const int32_t d = diagonal_of(t, f);
            add_facet(t, b, image, 3, (int32_t[]){h + d, h + d + 1, h + d + 2});
            add_facet(t, b, image, 3, (int32_t[]){h + d, h + d + 2, h + (d + 3) % 4});
        } else if (t->partner[f] == -1) {
            add_facet(t, b, image, 4, (int32_t[]){h, h + 1, h + 2, h + 3});
        }
    }
}

sl_status gen_retile(sl_generated *quads, sl_generated **out)
{
    sl_status status = SL_OK;
    gen_builder b = {0};
    tiling t = {.mesh = quads, .half = quads->nf / 2};
    *out = NULL;
    t.opposite = sl_alloc(4 * (int64_t)t.half, sizeof *t.opposite);
    t.partner = sl_alloc(t.half, sizeof *t.partner);
    if (t.opposite == NULL || t.partner == NULL) {
        SL_TRY(SL_OUT_OF_MEMORY);
    }
    SL_TRY(find_opposites(&t));
    find_partners(&t);
    for (int64_t v = 0; v < quads->nv; v++) {
        gen_vertex(&b, quads->xyz[3 * v], quads->xyz[3 * v + 1], quads->xyz[3 * v + 2]);
    }
    add_tiles(&t, &b, false);
    add_tiles(&t, &b, true);
    SL_TRY(gen_finish(&b, out));
cleanup:
    gen_clear(&b);
    sl_free(t.opposite);
    sl_free(t.partner);
    sl_generated_free(quads);
    return status;
}
