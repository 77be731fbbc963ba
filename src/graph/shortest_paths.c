#include "base/memory.h"
#include "graph/csr.h"

#include <math.h>

/* Binary heap of nodes by (distance, node number), each at most once; place[i] = where node i stands. */
typedef struct node_heap {
    int32_t *node, *place; /* n each; place -1 = not in the heap */
    int32_t size;
    const double *distance;
} node_heap;

static bool nearer(const node_heap *heap, int32_t i, int32_t j)
{
    const double di = heap->distance[i], dj = heap->distance[j];
    return di < dj || (di == dj && i < j);
}

static void heap_set(node_heap *heap, int32_t k, int32_t node)
{
    heap->node[k] = node;
    heap->place[node] = k;
}

static void sift_up(node_heap *heap, int32_t k)
{
    const int32_t node = heap->node[k];
    while (k > 0 && nearer(heap, node, heap->node[(k - 1) / 2])) {
        heap_set(heap, k, heap->node[(k - 1) / 2]);
        k = (k - 1) / 2;
    }
    heap_set(heap, k, node);
}

static void sift_down(node_heap *heap, int32_t k)
{
    const int32_t node = heap->node[k];
    while (k < heap->size / 2) {
        int32_t child = 2 * k + 1;
        if (child + 1 < heap->size && nearer(heap, heap->node[child + 1], heap->node[child])) {
            child++;
        }
        if (!nearer(heap, heap->node[child], node)) {
            break;
        }
        heap_set(heap, k, heap->node[child]);
        k = child;
    }
    heap_set(heap, k, node);
}

/* Node i came nearer: inserts it, or moves it up. */
static void heap_improve(node_heap *heap, int32_t i)
{
    if (heap->place[i] < 0) {
        heap_set(heap, heap->size++, i);
    }
    sift_up(heap, heap->place[i]);
}

static int32_t heap_pop(node_heap *heap)
{
    const int32_t top = heap->node[0], last = heap->node[--heap->size];
    heap->place[top] = -1;
    if (heap->size > 0) {
        heap->node[0] = last;
        sift_down(heap, 0);
    }
    return top;
}

typedef struct path_tree {
    double *distance;
    int32_t *parent, *parent_entry; /* parent_entry may be NULL */
} path_tree;

static void start_from(path_tree *tree, node_heap *heap, int32_t i, double distance)
{
    SL_ASSERT(distance >= 0.0);
    if (distance < tree->distance[i]) {
        tree->distance[i] = distance;
        heap_improve(heap, i);
    }
}

/* A settled node is never improved: weights are not negative, and rounding is monotone. */
static void relax_row(const sl_graph *graph, path_tree *tree, node_heap *heap, int32_t i)
{
    for (int32_t p = graph->first[i]; p < graph->first[i + 1]; p++) {
        const int32_t j = graph->adj[p];
        const double weight = graph->weight != NULL ? graph->weight[p] : 1.0;
        SL_ASSERT(weight >= 0.0);
        const double through = tree->distance[i] + weight;
        if (through < tree->distance[j]) {
            tree->distance[j] = through;
            tree->parent[j] = i;
            if (tree->parent_entry != NULL) {
                tree->parent_entry[j] = p;
            }
            heap_improve(heap, j);
        }
    }
}

static void clear_tree(path_tree *tree, int32_t *place, int32_t n)
{
    for (int32_t i = 0; i < n; i++) {
        tree->distance[i] = HUGE_VAL;
        tree->parent[i] = -1;
        place[i] = -1;
        if (tree->parent_entry != NULL) {
            tree->parent_entry[i] = -1;
        }
    }
}

sl_status sl_graph_shortest_paths(const sl_graph *graph, const int32_t *source, int32_t nsources, const double *start,
                                  int32_t target, double *distance, int32_t *parent, int32_t *parent_entry)
{
    sl_status status = SL_OK;
    node_heap heap = {sl_alloc(graph->n, sizeof(int32_t)), sl_alloc(graph->n, sizeof(int32_t)), 0, distance};
    path_tree tree = {distance, parent, parent_entry};
    if (heap.node == NULL || heap.place == NULL) {
        SL_TRY(SL_OUT_OF_MEMORY);
    }
    clear_tree(&tree, heap.place, graph->n);
    for (int32_t k = 0; k < nsources; k++) {
        start_from(&tree, &heap, source[k], start != NULL ? start[k] : 0.0);
    }
    while (heap.size > 0) { /* each node is popped once */
        const int32_t i = heap_pop(&heap);
        if (i == target) {
            break;
        }
        relax_row(graph, &tree, &heap, i);
    }
cleanup:
    sl_free(heap.place);
    sl_free(heap.node);
    return status;
}
