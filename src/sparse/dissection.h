/* Nested dissection of a graph into leaves and separators; internal to the room.
 * Layer: sparse. */
#ifndef SL_SPARSE_DISSECTION_H
#define SL_SPARSE_DISSECTION_H

#include "base/status.h"

/* Neighbours of node i: adj[first[i]] .. adj[first[i + 1] - 1]; symmetric, no loops, no duplicates. */
typedef struct sl_adjacency {
    int32_t n;
    int64_t *first; /* n + 1, owned */
    int32_t *adj;   /* owned */
} sl_adjacency;

void sl_adjacency_clear(sl_adjacency *graph);

/* piece[i] = which leaf or separator node i belongs to, numbered in order of elimination: what a separator separates
 * has smaller numbers than it, and different numbers on its two sides. order: the nodes, piece by piece. xyz: n x 3
 * finite, or NULL for bisection by breadth-first search; nodes at the same point share a piece. SL_OUT_OF_MEMORY.
 * Deterministic. */
SL_NODISCARD sl_status sl_dissect(const sl_adjacency *graph, const double *xyz, int32_t *piece, int32_t *order);

/* The same without looking for nodes that share a point. */
SL_NODISCARD sl_status sl_dissect_points(const sl_adjacency *graph, const double *xyz, int32_t *piece, int32_t *order);

/* The same without points. */
SL_NODISCARD sl_status sl_dissect_graph(const sl_adjacency *graph, int32_t *piece, int32_t *order);

/* Reorders the leaves within `order` by minimum degree, their separators counted. *complete = false when a leaf was too
 * large for that and stays as it is. SL_OUT_OF_MEMORY. Source: George, Liu 1989 (degrees are exact, nodes without
 * neighbours of their own go at once). */
SL_NODISCARD sl_status sl_order_leaves(const sl_adjacency *graph, const int32_t *piece, int32_t *order, bool *complete);

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

#endif
