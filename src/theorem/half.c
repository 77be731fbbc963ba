/* The half of a mirrored graph as a signed graph: components, and which of them one choice of halves sets right. */
#include "base/memory.h"
#include "theorem/theorem_internal.h"

void sl_half_clear(sl_half *half)
{
    sl_free(half->first);
    sl_free(half->other);
    sl_free(half->sign);
    sl_free(half->axis);
    sl_free(half->spokes);
    sl_free(half->component);
    sl_free(half->turn);
    sl_free(half->balanced);
    sl_free(half->part);
    *half = (sl_half){0};
}

static sl_status allocate(const sl_theorem_graph *graph, sl_half *h)
{
    const int32_t n = graph->pairs;
    *h = (sl_half){.n = n, .diagonal = true};
    h->first = sl_calloc((int64_t)n + 1, sizeof *h->first);
    h->other = sl_alloc(graph->graph.first[n], sizeof *h->other);
    h->sign = sl_alloc(graph->graph.first[n], sizeof *h->sign);
    h->axis = sl_calloc(n, sizeof *h->axis);
    h->spokes = sl_calloc(n, sizeof *h->spokes);
    h->component = sl_alloc(n, sizeof *h->component);
    h->turn = sl_calloc(n, sizeof *h->turn);
    h->balanced = sl_alloc(n, sizeof *h->balanced);
    h->part = sl_alloc(sl_theorem_nodes(graph), sizeof *h->part);
    const bool ok = h->first != NULL && h->other != NULL && h->sign != NULL && h->axis != NULL && h->spokes != NULL &&
                    h->component != NULL && h->turn != NULL && h->balanced != NULL && h->part != NULL;
    return ok ? SL_OK : SL_OUT_OF_MEMORY;
}

/* Rows from the neighbours of half 1. */
static void fill_rows(const sl_theorem_graph *graph, sl_half *h)
{
    const sl_graph *g = &graph->graph;
    int32_t end = 0;
    for (int32_t i = 0; i < h->n; i++) {
        h->first[i] = end;
        for (int32_t p = g->first[i]; p < g->first[i + 1]; p++) {
            const int32_t j = g->adj[p];
            if (j >= 2 * h->n) {
                h->spokes[i]++;
            } else if (j == i + h->n) {
                h->axis[i]++;
            } else {
                h->other[end] = j < h->n ? j : j - h->n;
                h->sign[end++] = j < h->n ? 1 : -1;
                h->diagonal = h->diagonal && j < h->n;
            }
        }
    }
    h->first[h->n] = end;
}

/* One component from `root`: every pair reached gets the sign its first path gives it; an edge that contradicts two
 * signs makes the component unbalanced. */
static void spread(sl_half *h, int32_t root, int32_t *stack)
{
    const int32_t c = h->components++;
    int32_t top = 0;
    h->balanced[c] = true;
    h->component[root] = c;
    h->turn[root] = 1;
    stack[top++] = root;
    while (top > 0) { /* each pair is pushed once */
        const int32_t i = stack[--top];
        for (int32_t p = h->first[i]; p < h->first[i + 1]; p++) {
            const int32_t j = h->other[p];
            const int8_t wanted = (int8_t)(h->turn[i] * h->sign[p]);
            if (h->turn[j] == 0) {
                h->component[j] = c;
                h->turn[j] = wanted;
                stack[top++] = j;
            } else if (h->turn[j] != wanted) {
                h->balanced[c] = false;
            }
        }
    }
}

sl_status sl_half_create(const sl_theorem_graph *graph, sl_half *out)
{
    sl_status status = SL_OK;
    int32_t *stack = sl_alloc(graph->pairs, sizeof *stack);
    SL_TRY(allocate(graph, out));
    SL_TRY(stack != NULL ? SL_OK : SL_OUT_OF_MEMORY);
    fill_rows(graph, out);
    for (int32_t i = 0; i < out->n; i++) {
        if (out->turn[i] == 0) {
            spread(out, i, stack);
        }
    }
    SL_TRY(sl_graph_components(&graph->graph, NULL, out->part, &out->graph_parts));
cleanup:
    sl_free(stack);
    if (status != SL_OK) {
        sl_half_clear(out);
    }
    return status;
}
