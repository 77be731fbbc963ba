/* The shortest way along a chart's edges. */
#include "base/memory.h"
#include "cli/abf_pick.h"
#include "geom/vec3.h"
#include "graph/csr.h"

#include <math.h>

/* Every edge once from either end: halfedges, and border edges backwards. Without adj the neighbours are counted. */
static void list_edges(const sl_patch *p, sl_graph *graph, int32_t *fill)
{
    for (int32_t h = 0; h < 3 * p->nt; h++) {
        const int32_t end[2] = {p->tri[h], p->tri[sl_corner_next(h)]};
        for (int k = 0; k < (p->twin[h] < 0 ? 2 : 1); k++) {
            const int32_t at = fill[end[k]]++;
            if (graph->adj != NULL) {
                graph->adj[at] = end[1 - k];
                graph->weight[at] = sl_vec3_distance(&p->xyz[3 * (int64_t)end[0]], &p->xyz[3 * (int64_t)end[1]]);
            }
        }
    }
}

static sl_status build_graph(const sl_patch *p, sl_graph *graph)
{
    int32_t *fill = sl_calloc(p->nv, sizeof *fill);
    sl_status status = SL_OUT_OF_MEMORY;
    *graph = (sl_graph){.n = p->nv, .first = sl_alloc((int64_t)p->nv + 1, sizeof *graph->first)};
    if (fill == NULL || graph->first == NULL) {
        goto cleanup;
    }
    list_edges(p, graph, fill);
    graph->first[0] = 0;
    for (int32_t v = 0; v < p->nv; v++) {
        graph->first[v + 1] = graph->first[v] + fill[v];
        fill[v] = graph->first[v];
    }
    graph->adj = sl_alloc(graph->first[p->nv], sizeof *graph->adj);
    graph->weight = sl_alloc(graph->first[p->nv], sizeof *graph->weight);
    if (graph->adj != NULL && graph->weight != NULL) {
        list_edges(p, graph, fill);
        status = SL_OK;
    }
cleanup:
    sl_free(fill);
    return status;
}

sl_status abf_shortest_path(const sl_patch *patch, int32_t from, int32_t to, int32_t *vertex, int32_t *count)
{
    sl_graph graph = {0};
    double *distance = sl_alloc(patch->nv, sizeof *distance);
    int32_t *parent = sl_alloc(patch->nv, sizeof *parent);
    sl_status status = SL_OK;
    *count = 0;
    SL_TRY(distance != NULL && parent != NULL ? SL_OK : SL_OUT_OF_MEMORY);
    SL_TRY(build_graph(patch, &graph));
    SL_TRY(sl_graph_shortest_paths(&graph, &to, 1, NULL, from, distance, parent, NULL)); /* backwards */
    for (int32_t v = from; v >= 0 && *count < patch->nv; v = parent[v]) {
        vertex[(*count)++] = v;
    }
cleanup:
    sl_graph_clear(&graph);
    sl_free(distance);
    sl_free(parent);
    return status;
}
