#include "graph/csr.h"

#include "base/memory.h"

void sl_graph_clear(sl_graph *graph)
{
    sl_free(graph->first);
    sl_free(graph->adj);
    sl_free(graph->weight);
    *graph = (sl_graph){0};
}

sl_status sl_graph_components(const sl_graph *graph, const int32_t *key, int32_t *label, int32_t *count)
{
    int32_t *stack = sl_alloc(graph->n, sizeof *stack);
    if (stack == NULL) {
        return SL_OUT_OF_MEMORY;
    }
    for (int32_t i = 0; i < graph->n; i++) {
        label[i] = -1;
    }
    int32_t found = 0;
    for (int32_t root = 0; root < graph->n; root++) {
        if (label[root] >= 0) {
            continue;
        }
        int32_t top = 0;
        stack[top++] = root;
        label[root] = found;
        while (top > 0) { /* each node is pushed once */
            const int32_t i = stack[--top];
            for (int32_t p = graph->first[i]; p < graph->first[i + 1]; p++) {
                const int32_t j = graph->adj[p];
                if (label[j] < 0 && (key == NULL || key[j] == key[i])) {
                    label[j] = found;
                    stack[top++] = j;
                }
            }
        }
        found++;
    }
    sl_free(stack);
    *count = found;
    return SL_OK;
}
