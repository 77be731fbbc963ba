/* Edge lists with their mirror images. */
#include "base/memory.h"
#include "theorem/theorem_internal.h"

void sl_edges_add(sl_edges *edges, int32_t a, int32_t b)
{
    void *array = edges->end;
    if (edges->status == SL_OK) {
        edges->status = sl_reserve(&array, &edges->capacity, 2 * (edges->count + 1), sizeof *edges->end);
        edges->end = array;
    }
    if (edges->status == SL_OK) {
        edges->end[2 * edges->count] = a;
        edges->end[2 * edges->count + 1] = b;
        edges->count++;
    }
}

void sl_edges_within(sl_edges *edges, int32_t i, int32_t j)
{
    sl_edges_add(edges, i, j);
    sl_edges_add(edges, i + edges->pairs, j + edges->pairs);
}

void sl_edges_across(sl_edges *edges, int32_t i, int32_t j)
{
    sl_edges_add(edges, i, j + edges->pairs);
    if (i != j) {
        sl_edges_add(edges, j, i + edges->pairs);
    }
}

void sl_edges_spoke(sl_edges *edges, int32_t i, int32_t k)
{
    sl_edges_add(edges, i, 2 * edges->pairs + k);
    sl_edges_add(edges, i + edges->pairs, 2 * edges->pairs + k);
}

void sl_edges_fixed(sl_edges *edges, int32_t k, int32_t l)
{
    sl_edges_add(edges, 2 * edges->pairs + k, 2 * edges->pairs + l);
}

sl_status sl_edges_finish(sl_edges *edges, sl_theorem_graph **out)
{
    sl_status status = edges->status;
    *out = NULL;
    if (status == SL_OK) {
        status = sl_theorem_graph_create(edges->pairs, edges->fixed, edges->end, edges->count, out);
    }
    sl_free(edges->end);
    *edges = (sl_edges){0};
    return status;
}
