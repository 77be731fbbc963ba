/* Making a disk of a chart with several border loops by cutting shortest paths between them. */
#include "segment/segment_internal.h"

#include "base/memory.h"
#include "graph/csr.h"

#include <math.h>

void sl_cut_list_clear(sl_cut_list *list)
{
    sl_free(list->halfedge);
    *list = (sl_cut_list){0};
}

void sl_sew_list(sl_mesh *mesh, const sl_cut_list *list)
{
    for (int32_t k = 0; k < list->count; k++) {
        sl_mesh_sew_edge(mesh, list->halfedge[k]);
    }
}

/* The graph of the chart's vertices over its interior edges, and one more node, the goal, next to every border vertex:
 * its edges cost nothing where the loop is still to be reached and are closed (infinite) where it is joined. */
typedef struct loop_graph {
    sl_graph graph;
    int32_t *halfedge; /* behind an entry of graph.adj; -1 = an edge of the goal */
    int32_t *vertex;   /* nh: vertex of a corner */
    int32_t *loop;     /* vertices: border loop, -1 = interior */
    int32_t nv, nloops;
    int32_t *source; /* vertices that are joined already */
    int32_t nsources;
    double *distance;
    int32_t *parent, *entry;
} loop_graph;

static void loop_graph_clear(loop_graph *g)
{
    sl_graph_clear(&g->graph);
    sl_free(g->halfedge);
    sl_free(g->vertex);
    sl_free(g->loop);
    sl_free(g->source);
    sl_free(g->distance);
    sl_free(g->parent);
    sl_free(g->entry);
}

int32_t sl_next_on_border(const sl_mesh *mesh, int32_t h)
{
    h = sl_next(mesh, h);
    while (mesh->twin[h] >= 0) {
        h = sl_next(mesh, mesh->twin[h]);
    }
    return h;
}

static void label_loops(const sl_mesh *mesh, loop_graph *g)
{
    for (int32_t v = 0; v < g->nv; v++) {
        g->loop[v] = -1;
    }
    g->nloops = 0;
    for (int32_t h = 0; h < mesh->nh; h++) {
        if (mesh->twin[h] >= 0 || g->loop[g->vertex[h]] >= 0) {
            continue;
        }
        int32_t k = h;
        do {
            g->loop[g->vertex[k]] = g->nloops;
            k = sl_next_on_border(mesh, k);
        } while (k != h);
        g->nloops++;
    }
}

/* Entry positions: first counted, then filled. */
static void add_entry(loop_graph *g, int32_t *fill, int32_t from, int32_t to, int32_t halfedge, double weight)
{
    const int32_t p = fill[from]++;
    g->graph.adj[p] = to;
    g->graph.weight[p] = weight;
    g->halfedge[p] = halfedge;
}

static void fill_graph(const sl_mesh *mesh, const double *weight, loop_graph *g, int32_t *fill)
{
    for (int32_t h = 0; h < mesh->nh; h++) {
        if (h < mesh->twin[h]) {
            const int32_t a = g->vertex[h], b = g->vertex[sl_next(mesh, h)];
            const double length = sl_mesh_edge_length(mesh, h) * (weight != NULL ? weight[h] : 1.0);
            add_entry(g, fill, a, b, h, length);
            add_entry(g, fill, b, a, h, length);
        }
    }
    for (int32_t v = 0; v < g->nv; v++) {
        if (g->loop[v] >= 0) {
            add_entry(g, fill, v, g->nv, -1, 0.0);
            add_entry(g, fill, g->nv, v, -1, 0.0);
        }
    }
}

static sl_status build_graph(const sl_mesh *mesh, const double *weight, loop_graph *g)
{
    const int32_t n = g->nv + 1;
    int32_t *fill = sl_calloc((int64_t)n + 1, sizeof *fill);
    int64_t entries = 2 * (int64_t)g->nv;
    g->graph.n = n;
    g->graph.first = sl_calloc((int64_t)n + 1, sizeof *g->graph.first);
    entries += mesh->nh;
    g->graph.adj = sl_alloc(entries, sizeof *g->graph.adj);
    g->graph.weight = sl_alloc(entries, sizeof *g->graph.weight);
    g->halfedge = sl_alloc(entries, sizeof *g->halfedge);
    if (fill == NULL || g->graph.first == NULL || g->graph.adj == NULL || g->graph.weight == NULL ||
        g->halfedge == NULL) {
        sl_free(fill);
        return SL_OUT_OF_MEMORY;
    }
    int32_t *first = g->graph.first;
    for (int32_t h = 0; h < mesh->nh; h++) {
        if (h < mesh->twin[h]) {
            first[g->vertex[h] + 1]++;
            first[g->vertex[sl_next(mesh, h)] + 1]++;
        }
    }
    for (int32_t v = 0; v < g->nv; v++) {
        first[v + 1] += g->loop[v] >= 0 ? 1 : 0;
        first[n] += g->loop[v] >= 0 ? 1 : 0;
    }
    for (int32_t v = 0; v < n; v++) {
        first[v + 1] += first[v];
        fill[v] = first[v];
    }
    fill_graph(mesh, weight, g, fill);
    sl_free(fill);
    return SL_OK;
}

static sl_status loop_graph_create(const sl_mesh *mesh, const double *weight, loop_graph *g)
{
    *g = (loop_graph){.vertex = sl_alloc(mesh->nh, sizeof *g->vertex)};
    if (g->vertex == NULL) {
        return SL_OUT_OF_MEMORY;
    }
    const sl_status status = sl_corner_fans(mesh, false, g->vertex, &g->nv);
    if (status != SL_OK) {
        return status;
    }
    const int64_t n = (int64_t)g->nv + 1;
    g->loop = sl_alloc(n, sizeof *g->loop);
    g->source = sl_alloc(n, sizeof *g->source);
    g->distance = sl_alloc(n, sizeof *g->distance);
    g->parent = sl_alloc(n, sizeof *g->parent);
    g->entry = sl_alloc(n, sizeof *g->entry);
    if (g->loop == NULL || g->source == NULL || g->distance == NULL || g->parent == NULL || g->entry == NULL) {
        return SL_OUT_OF_MEMORY;
    }
    label_loops(mesh, g);
    return build_graph(mesh, weight, g);
}

/* Makes a loop's vertices sources and closes its way to the goal. */
static void join_loop(loop_graph *g, int32_t loop)
{
    for (int32_t p = g->graph.first[g->nv]; p < g->graph.first[g->nv + 1]; p++) {
        const int32_t v = g->graph.adj[p];
        if (g->loop[v] == loop) {
            g->source[g->nsources++] = v;
            g->graph.weight[p] = HUGE_VAL;
            for (int32_t q = g->graph.first[v]; q < g->graph.first[v + 1]; q++) {
                g->graph.weight[q] = g->graph.adj[q] == g->nv ? HUGE_VAL : g->graph.weight[q];
            }
        }
    }
}

/* Cuts the path just found and makes its vertices sources. */
static void cut_path(sl_mesh *mesh, loop_graph *g, int32_t end, sl_cut_list *list)
{
    for (int32_t v = end; g->parent[v] >= 0; v = g->parent[v]) {
        const int32_t h = g->halfedge[g->entry[v]];
        sl_mesh_cut_edge(mesh, h);
        list->halfedge[list->count++] = h;
        if (v != end) {
            g->source[g->nsources++] = v;
        }
    }
}

sl_status sl_join_loops(sl_mesh *mesh, const double *weight, sl_cut_list *list)
{
    sl_status status = SL_OK;
    loop_graph g = {0};
    double *leaning = NULL;
    *list = (sl_cut_list){sl_alloc(mesh->nh, sizeof *list->halfedge), 0};
    SL_TRY(sl_lean_weights(mesh, weight, &leaning));
    SL_TRY(loop_graph_create(mesh, leaning, &g));
    if (list->halfedge == NULL) {
        SL_TRY(SL_OUT_OF_MEMORY);
    }
    if (g.nloops > 0) {
        join_loop(&g, 0);
    }
    for (int32_t k = 1; k < g.nloops; k++) {
        SL_TRY(sl_graph_shortest_paths(&g.graph, g.source, g.nsources, NULL, g.nv, g.distance, g.parent, g.entry));
        const int32_t end = g.parent[g.nv];
        if (end < 0) {
            SL_TRY(SL_INTERNAL); /* a connected mesh has a path */
        }
        cut_path(mesh, &g, end, list);
        join_loop(&g, g.loop[end]);
    }
cleanup:
    loop_graph_clear(&g);
    sl_free(leaning);
    if (status != SL_OK) {
        sl_sew_list(mesh, list);
        sl_cut_list_clear(list);
    }
    return status;
}
