/* Nested dissection of a graph into leaves and separators; internal to the room.
 * Layer: sparse. */
#ifndef SL_SPARSE_DISSECTION_H
#define SL_SPARSE_DISSECTION_H

#include "base/context.h"

/* Neighbours of node i: adj[first[i]] .. adj[first[i + 1] - 1]; symmetric, no loops, no duplicates. */
typedef struct sl_adjacency {
    int32_t n;
    int64_t *first; /* n + 1, owned */
    int32_t *adj;   /* owned */
} sl_adjacency;

void sl_adjacency_clear(sl_adjacency *graph);

/* piece[i] = which leaf or separator node i belongs to, numbered in order of elimination: what a separator separates
 * has smaller numbers than it, and different numbers on its two sides. order: the nodes, piece by piece. xyz: n x 3
 * finite, or NULL for bisection by breadth-first search; nodes at the same point share a piece. context: workers,
 * nullable. SL_OUT_OF_MEMORY. Same bytes for any number of workers. */
SL_NODISCARD sl_status sl_dissect(const sl_adjacency *graph, const double *xyz, const sl_context *context,
                                  int32_t *piece, int32_t *order);

/* The same without looking for nodes that share a point. */
SL_NODISCARD sl_status sl_dissect_points(const sl_adjacency *graph, const double *xyz, const sl_context *context,
                                         int32_t *piece, int32_t *order);

/* The same without points. */
SL_NODISCARD sl_status sl_dissect_graph(const sl_adjacency *graph, int32_t *piece, int32_t *order);

/* Reorders the leaves within `order` by minimum degree, their separators counted. *complete = false when a leaf was too
 * large for that and stays as it is. context: workers, nullable. SL_OUT_OF_MEMORY. Source: George, Liu 1989 (degrees
 * are exact, nodes without neighbours of their own go at once). */
SL_NODISCARD sl_status sl_order_leaves(const sl_adjacency *graph, const int32_t *piece, const sl_context *context,
                                       int32_t *order, bool *complete);

/* A bipartite graph and room for its matching. Left node l is joined to adj[first[l]] .. adj[first[l + 1] - 1]. */
typedef struct sl_bipartite {
    int32_t left_count, right_count;
    const int64_t *first; /* left_count + 1 */
    const int32_t *adj;
    int32_t *left_mate, *right_mate; /* left_count, right_count */
    int32_t *level;                  /* left_count */
    int32_t *stack;                  /* left_count */
    int64_t *next;                   /* left_count */
    bool *left_in, *right_in;        /* result: the nodes of the cover */
} sl_bipartite;

/* The smallest set of nodes that touches every edge; left_in and right_in tell which. O(edges sqrt(nodes)), allocates
 * nothing. Source: Hopcroft, Karp 1973 (matching); Konig 1931 (cover from matching). */
void sl_minimum_vertex_cover(sl_bipartite *graph);

/* The edges of a cut as a bipartite graph over its two shores. */
typedef struct sl_cut {
    int32_t *left, *right; /* n / 2 + 1: nodes of the shores */
    int32_t *right_id;     /* n: where a node stands in right, -1 elsewhere */
    int64_t *first;        /* n / 2 + 2 */
    int32_t *adj;
    int64_t edges;
    sl_bipartite shores;
} sl_cut;

/* Room for cuts of a graph with n nodes into halves of at most n / 2 + 1. SL_OUT_OF_MEMORY. */
SL_NODISCARD sl_status sl_cut_init(sl_cut *cut, const sl_adjacency *graph);
void sl_cut_clear(sl_cut *cut);

/* Does the edge from v on the left side to w cross the cut? */
typedef bool sl_cut_crosses(const void *user, int32_t v, int32_t w);

/* The smallest set of nodes that touches all edges of a cut: shores.left_in and right_in. Of the shores gathered
 * before.
 */
void sl_cut_cover(sl_cut *cut);

/* Gathers the edges that cross, of a left side of nodes node[0 .. count - 1], or begin .. begin + count - 1 where node
 * is NULL; then covers them. Neighbours of v: adj[first[v]] .. adj[first[v + 1] - 1]. In line, so that `crosses` is. */
static inline void sl_cut_find(sl_cut *cut, const int64_t *first, const int32_t *adj, const int32_t *node,
                               int32_t begin, int32_t count, sl_cut_crosses *crosses, const void *user)
{
    cut->edges = 0;
    cut->shores.left_count = cut->shores.right_count = 0;
    for (int32_t k = 0; k < count; k++) {
        const int32_t v = node != NULL ? node[k] : begin + k;
        const int64_t before = cut->edges;
        for (int64_t p = first[v]; p < first[v + 1]; p++) {
            const int32_t w = adj[p];
            if (!crosses(user, v, w)) {
                continue;
            }
            if (cut->right_id[w] == -1) {
                cut->right_id[w] = cut->shores.right_count;
                cut->right[cut->shores.right_count++] = w;
            }
            cut->adj[cut->edges++] = cut->right_id[w];
        }
        if (cut->edges > before) {
            cut->first[cut->shores.left_count] = before;
            cut->left[cut->shores.left_count++] = v;
        }
    }
    sl_cut_cover(cut);
}

#endif
