/* Graphs with a mirror. */
#include "theorem/graph.h"

#include "base/memory.h"
#include "theorem/theorem_internal.h"

#include <stdlib.h>
#include <string.h>

void sl_theorem_graph_free(sl_theorem_graph *graph)
{
    if (graph == NULL) {
        return;
    }
    sl_graph_clear(&graph->graph);
    sl_free(graph->second);
    sl_free(graph->label);
    sl_free(graph);
}

static sl_status check_edges(int32_t pairs, int32_t fixed, const int32_t *edge, int64_t edges)
{
    const int64_t nodes = 2 * (int64_t)pairs + fixed;
    if (pairs < 0 || fixed < 0 || nodes < 1 || nodes > INT32_MAX - 1 || edges < 0 || edges > INT32_MAX / 2) {
        return SL_BAD_INPUT;
    }
    for (int64_t e = 0; e < edges; e++) {
        const int32_t a = edge[2 * e], b = edge[2 * e + 1];
        if (a < 0 || b < 0 || a >= nodes || b >= nodes || a == b) {
            return SL_BAD_INPUT;
        }
    }
    return SL_OK;
}

/* Rows by counting; neighbours in the order of the edges. */
static sl_status fill_rows(int32_t n, const int32_t *edge, int64_t edges, sl_graph *graph)
{
    graph->n = n;
    graph->first = sl_calloc((int64_t)n + 1, sizeof *graph->first);
    graph->adj = sl_alloc(2 * edges, sizeof *graph->adj);
    if (graph->first == NULL || graph->adj == NULL) {
        return SL_OUT_OF_MEMORY;
    }
    for (int64_t k = 0; k < 2 * edges; k++) {
        graph->first[edge[k]]++;
    }
    int32_t sum = 0;
    for (int32_t i = 0; i <= n; i++) { /* first[i] = end of row i: filling from the back turns it into its begin */
        sum += i < n ? graph->first[i] : 0;
        graph->first[i] = sum;
    }
    for (int64_t e = edges - 1; e >= 0; e--) {
        const int32_t a = edge[2 * e], b = edge[2 * e + 1];
        graph->adj[--graph->first[a]] = b;
        graph->adj[--graph->first[b]] = a;
    }
    return SL_OK;
}

sl_status sl_theorem_graph_create(int32_t pairs, int32_t fixed, const int32_t *edge, int64_t edges,
                                  sl_theorem_graph **out)
{
    sl_theorem_graph *g = NULL;
    sl_status status = SL_OK;
    *out = NULL;
    SL_TRY(check_edges(pairs, fixed, edge, edges));
    g = sl_calloc(1, sizeof *g);
    SL_TRY(g != NULL ? SL_OK : SL_OUT_OF_MEMORY);
    g->pairs = pairs;
    g->fixed = fixed;
    SL_TRY(fill_rows(sl_theorem_nodes(g), edge, edges, &g->graph));
    *out = g;
    g = NULL;
cleanup:
    sl_theorem_graph_free(g);
    return status;
}

static bool is_involution(int32_t n, const int32_t *image)
{
    for (int32_t i = 0; i < n; i++) {
        if (image[i] < 0 || image[i] >= n || image[image[i]] != i) {
            return false;
        }
    }
    return true;
}

/* New numbers: pairs by their smaller node, then fixed nodes. Returns the number of pairs. */
static int32_t number_nodes(int32_t n, const int32_t *mirror, int32_t *to, int32_t *label)
{
    int32_t pairs = 0, fixed = 0;
    for (int32_t i = 0; i < n; i++) {
        pairs += mirror[i] > i ? 1 : 0;
    }
    int32_t next = 0;
    for (int32_t i = 0; i < n; i++) {
        if (mirror[i] > i) {
            to[i] = next;
            to[mirror[i]] = next + pairs;
            next++;
        } else if (mirror[i] == i) {
            to[i] = 2 * pairs + fixed++;
        }
    }
    for (int32_t i = 0; i < n; i++) {
        label[to[i]] = i;
    }
    return pairs;
}

/* The graph's edges, once each, in the new numbers. Returns their number, -1 where there is a loop. */
static int64_t list_edges(const sl_graph *graph, const int32_t *to, int32_t *edge)
{
    int64_t edges = 0;
    for (int32_t i = 0; i < graph->n; i++) {
        for (int32_t p = graph->first[i]; p < graph->first[i + 1]; p++) {
            if (graph->adj[p] == i) {
                return -1;
            }
            if (graph->adj[p] > i) {
                edge[2 * edges] = to[i];
                edge[2 * edges + 1] = to[graph->adj[p]];
                edges++;
            }
        }
    }
    return edges;
}

sl_status sl_theorem_graph_from_mirror(const sl_graph *graph, const int32_t *mirror, const int32_t *second,
                                       sl_theorem_graph **out)
{
    const int32_t n = graph->n;
    sl_theorem_graph *g = NULL;
    sl_status status = SL_OK;
    *out = NULL;
    int32_t *to = sl_alloc(n, sizeof *to), *label = sl_alloc(n, sizeof *label);
    int32_t *edge = sl_alloc(graph->first[n], sizeof *edge);
    SL_TRY(to != NULL && label != NULL && edge != NULL ? SL_OK : SL_OUT_OF_MEMORY);
    SL_TRY(is_involution(n, mirror) && (second == NULL || is_involution(n, second)) ? SL_OK : SL_BAD_INPUT);
    const int32_t pairs = number_nodes(n, mirror, to, label);
    const int64_t edges = list_edges(graph, to, edge);
    SL_TRY(edges >= 0 ? SL_OK : SL_BAD_INPUT);
    SL_TRY(sl_theorem_graph_create(pairs, n - 2 * pairs, edge, edges, &g));
    if (second != NULL) {
        g->second = sl_alloc(n, sizeof *g->second);
        SL_TRY(g->second != NULL ? SL_OK : SL_OUT_OF_MEMORY);
        for (int32_t i = 0; i < n; i++) {
            g->second[to[i]] = to[second[i]];
        }
    }
    g->label = label;
    label = NULL;
    *out = g;
    g = NULL;
cleanup:
    sl_theorem_graph_free(g);
    sl_free(to);
    sl_free(label);
    sl_free(edge);
    return status;
}

static int ascending(const void *a, const void *b)
{
    const int32_t x = *(const int32_t *)a, y = *(const int32_t *)b;
    return (x > y) - (x < y);
}

static int32_t image_of(const sl_theorem_graph *graph, const int32_t *image, int32_t node)
{
    return image != NULL ? image[node] : sl_theorem_image(graph, node);
}

sl_status sl_theorem_graph_check(const sl_theorem_graph *graph, const int32_t *image, int32_t *at)
{
    const sl_graph *g = &graph->graph;
    int32_t widest = 0;
    *at = -1;
    for (int32_t i = 0; i < g->n; i++) {
        const int32_t degree = g->first[i + 1] - g->first[i];
        widest = degree > widest ? degree : widest;
    }
    int32_t *carried = sl_alloc(2 * (int64_t)widest, sizeof *carried);
    if (carried == NULL) {
        return SL_OUT_OF_MEMORY;
    }
    int32_t *there = carried + widest;
    for (int32_t i = 0; i < g->n && *at < 0; i++) {
        const int32_t j = image_of(graph, image, i);
        const int32_t degree = g->first[i + 1] - g->first[i];
        if (degree != g->first[j + 1] - g->first[j]) {
            *at = i;
            break;
        }
        for (int32_t k = 0; k < degree; k++) {
            carried[k] = image_of(graph, image, g->adj[g->first[i] + k]);
            there[k] = g->adj[g->first[j] + k];
        }
        qsort(carried, (size_t)degree, sizeof *carried, ascending);
        qsort(there, (size_t)degree, sizeof *there, ascending);
        *at = memcmp(carried, there, (size_t)degree * sizeof *there) != 0 ? i : -1;
    }
    sl_free(carried);
    return SL_OK;
}
