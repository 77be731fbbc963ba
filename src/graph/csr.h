/* Undirected graphs in compressed rows.
 * Layer: graph (may include base only). */
#ifndef SL_GRAPH_CSR_H
#define SL_GRAPH_CSR_H

#include "base/status.h"

/* Neighbours of node i are adj[first[i] .. first[i + 1] - 1]; every edge stands in both rows (parallel edges as often
 * as they occur). weight is NULL or as long as adj. */
typedef struct sl_graph {
    int32_t n;
    int32_t *first; /* n + 1 */
    int32_t *adj;   /* first[n] */
    double *weight; /* NULL = 1 each */
} sl_graph;

void sl_graph_clear(sl_graph *graph); /* frees the arrays, zeroes the struct */

/* Components of the subgraph whose edges join nodes of equal key (key NULL = all edges): label[i], numbered by first
 * node; *count. label: n. SL_OUT_OF_MEMORY. O(n + edges). */
SL_NODISCARD sl_status sl_graph_components(const sl_graph *graph, const int32_t *key, int32_t *label, int32_t *count);

/* Dijkstra from several sources at distance 0 (or start[k] >= 0, nullable; of a source named twice the smaller counts).
 * distance[i] = HUGE_VAL and parent[i] = -1 when not reached; the parent of a source is -1 unless a path from another
 * source is shorter than its start. parent_entry (nullable, n) = entry of adj that leads from the parent to i. Stops
 * early once `target` (>= 0) is settled: distances up to the target's are final, larger ones are upper bounds; -1 =
 * settle all. Ties by smaller node number. Weights must be >= 0 (HUGE_VAL = no way). SL_OUT_OF_MEMORY.
 * O((n + edges) log n). Source: Dijkstra 1959, "A note on two problems in connexion with graphs". */
SL_NODISCARD sl_status sl_graph_shortest_paths(const sl_graph *graph, const int32_t *source, int32_t nsources,
                                               const double *start, int32_t target, double *distance, int32_t *parent,
                                               int32_t *parent_entry);

/* Minimum cut between the nodes with seed[i] > 0 and those with seed[i] < 0 (0 = free); capacities are the weights,
 * equal in both directions, >= 0, HUGE_VAL = never cut if that can be helped. side[i] = 1 (positive side) or 0; *value
 * = capacity cut. Among minimum cuts the one with the smallest positive side; an arc counts as full once 2^-40 of its
 * capacity or less is left. SL_OUT_OF_MEMORY. Dinic's algorithm, O(n^2 edges) at worst; ends
 * after at most n phases whatever the rounding. Source: Dinic 1970, "Algorithm for solution of a problem of maximum
 * flow in networks with power estimation". */
SL_NODISCARD sl_status sl_graph_min_cut(const sl_graph *graph, const int8_t *seed, uint8_t *side, double *value);

#endif
