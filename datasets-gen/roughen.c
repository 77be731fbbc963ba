#include "roughen.h"

#include "base/memory.h"
#include "geom/vec3.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const double least_cosine = 0.92; /* of an angle, at most: 23 degrees at least */
static const double most_fold = 0.80;    /* cosine between the normals of the two triangles, at least */

void gen_split_quads(gen_builder *b, sl_rng *rng)
{
    gen_builder split = {0};
    for (int64_t f = 0; f < b->nf && !b->failed; f++) {
        const int32_t *c = b->index + b->first[f];
        if (b->first[f + 1] - b->first[f] == 3) {
            gen_triangle(&split, c[0], c[1], c[2]);
        } else {
            const int k = (int)(sl_rng_bits(rng) >> 63);
            gen_triangle(&split, c[k], c[k + 1], c[k + 2]);
            gen_triangle(&split, c[k], c[k + 2], c[(k + 3) % 4]);
        }
    }
    split.xyz = b->xyz;
    split.nv = b->nv;
    split.xyz_capacity = b->xyz_capacity;
    split.failed |= b->failed;
    b->xyz = NULL;
    gen_clear(b);
    *b = split;
}

/* An edge with its two corners: those opposite to it. */
typedef struct flip_edge {
    uint64_t key;   /* low vertex << 32 | high vertex */
    uint64_t order; /* random */
    int32_t corner; /* opposite to it, of the first of its triangles */
    int32_t other;  /* of the second; -1 = not met yet */
} flip_edge;

static int compare_edges(const void *a, const void *b)
{
    const flip_edge *x = a, *y = b;
    return x->key < y->key ? -1 : x->key > y->key ? 1 : x->corner < y->corner ? -1 : x->corner > y->corner;
}

static int compare_orders(const void *a, const void *b)
{
    const flip_edge *x = a, *y = b;
    return x->order < y->order ? -1 : x->order > y->order ? 1 : x->corner < y->corner ? -1 : x->corner > y->corner;
}

static int32_t next_corner(int32_t c)
{
    return c % 3 == 2 ? c - 2 : c + 1;
}

static uint64_t edge_key(int32_t a, int32_t b)
{
    return a < b ? (uint64_t)a << 32 | (uint32_t)b : (uint64_t)b << 32 | (uint32_t)a;
}

/* Edges by key, each once. Returns how many. */
static int64_t list_edges(const gen_builder *b, sl_rng *rng, flip_edge *edge)
{
    int64_t count = 0;
    for (int32_t c = 0; c < b->nc; c++) {
        const int32_t from = b->index[next_corner(c)], to = b->index[next_corner(next_corner(c))];
        edge[c] = (flip_edge){edge_key(from, to), 0, c, -1};
    }
    qsort(edge, (size_t)b->nc, sizeof *edge, compare_edges);
    for (int64_t i = 0; i < b->nc; i++) {
        if (count > 0 && edge[count - 1].key == edge[i].key) {
            edge[count - 1].other = edge[i].corner;
        } else {
            edge[count] = edge[i];
            edge[count++].order = sl_rng_bits(rng);
        }
    }
    return count;
}

/* Normal of triangle pqr into n, unit; false when an angle is too small. */
static bool well_shaped(const double *p, const double *q, const double *r, double n[3])
{
    double e[3][3], length[3];
    sl_vec3_sub(q, p, e[0]);
    sl_vec3_sub(r, q, e[1]);
    sl_vec3_sub(p, r, e[2]);
    for (int k = 0; k < 3; k++) {
        length[k] = sl_vec3_norm(e[k]);
    }
    for (int k = 0; k < 3; k++) {
        const double cosine = -sl_vec3_dot(e[k], e[(k + 1) % 3]) / (length[k] * length[(k + 1) % 3]);
        if (!(cosine < least_cosine)) {
            return false;
        }
    }
    sl_vec3_cross(e[0], e[1], n);
    const double norm = sl_vec3_norm(n);
    for (int k = 0; k < 3; k++) {
        n[k] /= norm;
    }
    return true;
}

/* Would the edge c d be a good one in place of a b? */
static bool may_flip(const gen_builder *b, int32_t a, int32_t e, int32_t c, int32_t d)
{
    const double *pa = b->xyz + 3 * (int64_t)a, *pe = b->xyz + 3 * (int64_t)e;
    const double *pc = b->xyz + 3 * (int64_t)c, *pd = b->xyz + 3 * (int64_t)d;
    double n[2][3], old[3];
    return well_shaped(pc, pd, pe, n[0]) && well_shaped(pd, pc, pa, n[1]) && sl_vec3_dot(n[0], n[1]) > most_fold &&
           well_shaped(pa, pe, pc, old) && sl_vec3_dot(n[0], old) > 0.5;
}

static bool has_key(const uint64_t *key, int64_t count, uint64_t wanted)
{
    int64_t low = 0, high = count;
    while (low < high) {
        const int64_t middle = low + (high - low) / 2;
        if (key[middle] < wanted) {
            low = middle + 1;
        } else {
            high = middle;
        }
    }
    return low < count && key[low] == wanted;
}

/* Turns edges whose four vertices no earlier turn of this pass has touched. */
static void flip_pass(gen_builder *b, const flip_edge *edge, int64_t count, const uint64_t *key, uint8_t *touched)
{
    for (int64_t i = 0; i < count; i++) {
        const int32_t s = edge[i].corner, t = edge[i].other;
        if (t < 0) {
            continue;
        }
        /* triangle s: c, a, e; triangle t: d, e, a */
        const int32_t c = b->index[s], a = b->index[next_corner(s)], e = b->index[next_corner(next_corner(s))];
        const int32_t d = b->index[t];
        if (touched[a] != 0 || touched[e] != 0 || touched[c] != 0 || touched[d] != 0 ||
            has_key(key, count, edge_key(c, d)) || !may_flip(b, a, e, c, d)) {
            continue;
        }
        touched[a] = touched[e] = touched[c] = touched[d] = 1;
        memcpy(b->index + s / 3 * 3, (int32_t[]){c, d, e}, 3 * sizeof *b->index);
        memcpy(b->index + t / 3 * 3, (int32_t[]){d, c, a}, 3 * sizeof *b->index);
    }
}

void gen_flip_edges(gen_builder *b, sl_rng *rng, int32_t passes)
{
    flip_edge *edge = b->failed ? NULL : sl_alloc(b->nc, sizeof *edge);
    uint64_t *key = sl_alloc(b->nc, sizeof *key);
    uint8_t *touched = sl_alloc(b->nv, 1);
    if (edge == NULL || key == NULL || touched == NULL) {
        b->failed = true;
    }
    for (int32_t pass = 0; pass < passes && !b->failed; pass++) {
        const int64_t count = list_edges(b, rng, edge);
        for (int64_t i = 0; i < count; i++) {
            key[i] = edge[i].key;
        }
        qsort(edge, (size_t)count, sizeof *edge, compare_orders);
        memset(touched, 0, (size_t)b->nv);
        flip_pass(b, edge, count, key, touched);
    }
    sl_free(edge);
    sl_free(key);
    sl_free(touched);
}

/* What a vertex gathers: the sum of its facets' vector areas, of its edges' lengths, and their number. */
typedef struct rough_vertex {
    double normal[3], length, edges;
} rough_vertex;

static void gather(const gen_builder *b, rough_vertex *vertex)
{
    for (int64_t f = 0; f < b->nf; f++) {
        const int32_t first = b->first[f], end = b->first[f + 1];
        for (int32_t c = first; c < end; c++) {
            const int32_t v = b->index[c], w = b->index[c + 1 < end ? c + 1 : first];
            const int32_t x = b->index[c > first ? c - 1 : end - 1];
            double p[3], q[3], n[3];
            sl_vec3_sub(b->xyz + 3 * (int64_t)w, b->xyz + 3 * (int64_t)v, p);
            sl_vec3_sub(b->xyz + 3 * (int64_t)x, b->xyz + 3 * (int64_t)v, q);
            sl_vec3_cross(p, q, n);
            sl_vec3_add(vertex[v].normal, n, vertex[v].normal);
            vertex[v].length += sl_vec3_norm(p);
            vertex[v].edges += 1.0;
        }
    }
}

void gen_add_noise(gen_builder *b, sl_rng *rng, double amount)
{
    rough_vertex *vertex = b->failed ? NULL : sl_calloc(b->nv, sizeof *vertex);
    if (vertex == NULL) {
        b->failed = true;
        return;
    }
    gather(b, vertex);
    for (int64_t v = 0; v < b->nv; v++) {
        const double norm = sl_vec3_norm(vertex[v].normal);
        const double reach = amount * vertex[v].length / fmax(vertex[v].edges, 1.0);
        double offset[3], along = 0.0;
        for (int k = 0; k < 3; k++) {
            offset[k] = 2.0 * sl_rng_uniform(rng) - 1.0;
            along += norm > 0.0 ? offset[k] * vertex[v].normal[k] / norm : 0.0;
        }
        const double lift = (2.0 * sl_rng_uniform(rng) - 1.0) - 0.5 * along; /* in place of the share of `offset` */
        for (int k = 0; k < 3; k++) {
            b->xyz[3 * v + k] += reach * (0.5 * offset[k] + (norm > 0.0 ? lift * vertex[v].normal[k] / norm : 0.0));
        }
    }
    sl_free(vertex);
}
