/* The cut of a vector's signs against the axis. */
#include "base/memory.h"
#include "theorem/theorem_internal.h"

/* Component of the half that a node belongs to, -1 for a fixed node. */
static int32_t component_of(const sl_theorem_graph *graph, const sl_half *half, int32_t node)
{
    const int32_t n = graph->pairs;
    return node < 2 * n ? half->component[node < n ? node : node - n] : -1;
}

void sl_seam_compare(const sl_theorem_graph *graph, const sl_half *half, int32_t component, const uint8_t *side,
                     int32_t *off, int32_t *missing)
{
    const sl_graph *g = &graph->graph;
    *off = *missing = 0;
    for (int32_t i = 0; i < g->n; i++) {
        const int32_t ci = component_of(graph, half, i);
        for (int32_t p = g->first[i]; p < g->first[i + 1]; p++) {
            const int32_t j = g->adj[p], cj = component_of(graph, half, j);
            if (j < i) {
                continue;
            }
            const bool cut = side[i] != side[j];
            const bool image = j == sl_theorem_image(graph, i) && ci == component;
            const bool spoke = (ci == component && cj < 0) || (cj == component && ci < 0);
            if (image) {
                *missing += cut ? 0 : 1;
            } else if (spoke) { /* fixed nodes are in F+: the edges to F-, and no others, are the axis */
                const int32_t fixed = ci < 0 ? i : j;
                *off += cut && side[fixed] == 0 ? 1 : 0;
            } else {
                *off += cut ? 1 : 0;
            }
        }
    }
}

sl_status sl_seam_connected(const sl_theorem_graph *graph, const uint8_t *side, bool *connected)
{
    const int32_t n = sl_theorem_nodes(graph);
    int32_t *key = sl_alloc(n, sizeof *key), *label = sl_alloc(n, sizeof *label), parts = 0;
    sl_status status = key != NULL && label != NULL ? SL_OK : SL_OUT_OF_MEMORY;
    bool both[2] = {false, false};
    for (int32_t i = 0; status == SL_OK && i < n; i++) {
        key[i] = side[i];
        both[side[i] != 0] = true;
    }
    if (status == SL_OK) {
        status = sl_graph_components(&graph->graph, key, label, &parts);
    }
    *connected = status == SL_OK && parts == both[0] + both[1];
    sl_free(key);
    sl_free(label);
    return status;
}
