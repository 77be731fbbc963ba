#include "base/memory.h"
#include "boxmodel.h"
#include "geom/vec3.h"

#include <stdlib.h>
#include <string.h>

/* An undirected edge and the quads beside it. */
typedef struct smooth_edge {
    int32_t a, b;
    int32_t quad[2]; /* second -1 = border */
} smooth_edge;

/* What a vertex gathers from its surroundings. */
typedef struct smooth_vertex {
    double quads[3], edges[3], border[3]; /* sums of face points, edge midpoints, border neighbours */
    int32_t quad_count, edge_count, border_count;
} smooth_vertex;

typedef struct smooth_work {
    gen_cage *cage;
    int32_t ne;
    int32_t *edge_of; /* 4 nq: edge of a halfedge */
    smooth_edge *edge;
    smooth_vertex *vertex;
    double *quad_point, *edge_point; /* 3 nq, 3 ne */
} smooth_work;

typedef struct keyed_halfedge {
    uint64_t key;
    int32_t half;
} keyed_halfedge;

static int compare_keys(const void *a, const void *b)
{
    const keyed_halfedge *x = a, *y = b;
    if (x->key != y->key) {
        return x->key < y->key ? -1 : 1;
    }
    return x->half < y->half ? -1 : x->half > y->half;
}

static sl_status find_edges(smooth_work *w)
{
    const int64_t nh = 4 * w->cage->nq;
    keyed_halfedge *order = sl_alloc(nh, sizeof *order);
    if (order == NULL) {
        return SL_OUT_OF_MEMORY;
    }
    for (int32_t h = 0; h < nh; h++) {
        const int32_t a = w->cage->quad[h], b = w->cage->quad[h % 4 == 3 ? h - 3 : h + 1];
        const uint64_t low = (uint64_t)(a < b ? a : b), high = (uint64_t)(a < b ? b : a);
        order[h] = (keyed_halfedge){low << 32 | high, h};
    }
    qsort(order, (size_t)nh, sizeof *order, compare_keys);
    for (int64_t i = 0; i < nh; i++) {
        if (i == 0 || order[i].key != order[i - 1].key) {
            w->edge[w->ne++] = (smooth_edge){
                (int32_t)(order[i].key >> 32), (int32_t)(order[i].key & 0xffffffffu), {order[i].half / 4, -1}};
        } else {
            w->edge[w->ne - 1].quad[1] = order[i].half / 4;
        }
        w->edge_of[order[i].half] = w->ne - 1;
    }
    sl_free(order);
    return SL_OK;
}

static const double *position(const smooth_work *w, int32_t v)
{
    return w->cage->xyz + 3 * (int64_t)v;
}

/* Face points: F = mean of the corners. */
static void quad_points(smooth_work *w)
{
    for (int64_t q = 0; q < w->cage->nq; q++) {
        double *point = w->quad_point + 3 * q;
        memset(point, 0, 3 * sizeof *point);
        for (int k = 0; k < 4; k++) {
            sl_vec3_add(point, position(w, w->cage->quad[4 * q + k]), point);
        }
        for (int k = 0; k < 3; k++) {
            point[k] *= 0.25;
        }
        for (int k = 0; k < 4; k++) {
            smooth_vertex *v = &w->vertex[w->cage->quad[4 * q + k]];
            sl_vec3_add(v->quads, point, v->quads);
            v->quad_count++;
        }
    }
}

static void gather_edge(smooth_vertex *v, const double midpoint[3], const double *neighbour, int32_t copies,
                        bool border)
{
    for (int k = 0; k < 3; k++) {
        v->edges[k] += copies * midpoint[k];
        v->border[k] += border ? neighbour[k] : 0.0;
    }
    v->edge_count += copies;
    v->border_count += border;
}

/* Edge points: E = (a + b + F1 + F2) / 4, at a border (a + b) / 2. Across the mirror plane F2 is F1's image. */
static void edge_points(smooth_work *w)
{
    for (int32_t e = 0; e < w->ne; e++) {
        const smooth_edge *edge = &w->edge[e];
        const double *a = position(w, edge->a), *b = position(w, edge->b);
        const double *f1 = w->quad_point + 3 * (int64_t)edge->quad[0];
        const double *f2 = edge->quad[1] >= 0 ? w->quad_point + 3 * (int64_t)edge->quad[1] : f1;
        const bool joined = edge->quad[1] < 0 && w->cage->mirrored && a[0] == 0.0 && b[0] == 0.0;
        const bool border = edge->quad[1] < 0 && !joined;
        double *point = w->edge_point + 3 * (int64_t)e, midpoint[3];
        for (int k = 0; k < 3; k++) {
            midpoint[k] = 0.5 * (a[k] + b[k]);
            point[k] = border ? midpoint[k] : 0.5 * midpoint[k] + 0.25 * (f1[k] + f2[k]);
        }
        if (joined) {
            point[0] = 0.0;
        }
        /* an edge off the plane stands for its mirror image as well */
        const int32_t copies = joined ? 1 : 2;
        gather_edge(&w->vertex[edge->a], midpoint, b, copies, border);
        gather_edge(&w->vertex[edge->b], midpoint, a, copies, border);
    }
}

/* Vertex points: (Q + 2 R + (n - 3) S) / n of n edges; at a border (6 S + its two border neighbours) / 8. Every edge
 * was counted twice, those in the mirror plane once: right as it is for a vertex in the plane, and a factor of two that
 * cancels in R (and is taken out of n) elsewhere. */
static void vertex_points(smooth_work *w)
{
    for (int32_t i = 0; i < w->cage->nv; i++) {
        const smooth_vertex *v = &w->vertex[i];
        double *p = w->cage->xyz + 3 * (int64_t)i;
        const bool in_plane = w->cage->mirrored && p[0] == 0.0;
        const double n = in_plane ? v->edge_count : 0.5 * v->edge_count;
        for (int k = 0; k < 3; k++) {
            if (v->border_count > 0) {
                p[k] = 0.75 * p[k] + 0.25 * v->border[k] / v->border_count;
            } else {
                p[k] = (v->quads[k] / v->quad_count + 2.0 * v->edges[k] / v->edge_count + (n - 3.0) * p[k]) / n;
            }
        }
        if (in_plane) {
            p[0] = 0.0;
        }
    }
}

/* Old vertices, then face points, then edge points. A quad per corner: corner, edge after it, face, edge before it. */
static sl_status assemble(smooth_work *w)
{
    gen_cage *c = w->cage;
    const int64_t nv = c->nv + c->nq + w->ne, nq = 4 * c->nq;
    if (nv > INT32_MAX / 3 || nq > INT32_MAX / 4) {
        return SL_OUT_OF_MEMORY;
    }
    int32_t *quad = sl_alloc(4 * nq, sizeof *quad);
    if (quad == NULL || sl_reserve((void **)&c->xyz, &c->xyz_capacity, 3 * nv, sizeof *c->xyz) != SL_OK) {
        sl_free(quad);
        return SL_OUT_OF_MEMORY;
    }
    memcpy(c->xyz + 3 * c->nv, w->quad_point, 3 * (size_t)c->nq * sizeof *c->xyz);
    memcpy(c->xyz + 3 * (c->nv + c->nq), w->edge_point, 3 * (size_t)w->ne * sizeof *c->xyz);
    for (int64_t h = 0; h < nq; h++) {
        const int64_t before = h % 4 == 0 ? h + 3 : h - 1;
        quad[4 * h] = c->quad[h];
        quad[4 * h + 1] = (int32_t)(c->nv + c->nq + w->edge_of[h]);
        quad[4 * h + 2] = (int32_t)(c->nv + h / 4);
        quad[4 * h + 3] = (int32_t)(c->nv + c->nq + w->edge_of[before]);
    }
    sl_free(c->quad);
    c->quad = quad;
    c->quad_capacity = 4 * nq;
    c->nv = nv;
    c->nq = nq;
    return SL_OK;
}

void gen_cage_smooth(gen_cage *cage)
{
    sl_status status = SL_OK;
    smooth_work w = {.cage = cage};
    if (cage->failed || cage->nq > INT32_MAX / 16) {
        cage->failed = true;
        return;
    }
    w.edge = sl_alloc(4 * cage->nq, sizeof *w.edge);
    w.edge_of = sl_alloc(4 * cage->nq, sizeof *w.edge_of);
    w.vertex = sl_calloc(cage->nv, sizeof *w.vertex);
    w.quad_point = sl_alloc(3 * cage->nq, sizeof *w.quad_point);
    w.edge_point = sl_alloc(12 * cage->nq, sizeof *w.edge_point);
    if (w.edge == NULL || w.edge_of == NULL || w.vertex == NULL || w.quad_point == NULL || w.edge_point == NULL) {
        SL_TRY(SL_OUT_OF_MEMORY);
    }
    SL_TRY(find_edges(&w));
    quad_points(&w);
    edge_points(&w);
    vertex_points(&w);
    SL_TRY(assemble(&w));
cleanup:
    cage->failed |= status != SL_OK;
    sl_free(w.edge);
    sl_free(w.edge_of);
    sl_free(w.vertex);
    sl_free(w.quad_point);
    sl_free(w.edge_point);
}
