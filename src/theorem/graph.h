/* Graphs with a mirror: n pairs of nodes and m nodes that are their own images.
 * Layer: theorem (may include spectral, symmetry, mesh, eigen, graph, sparse, base).
 *
 *     node i < n        half 1 (the paper's V^1)      image i + n
 *     node n <= i < 2n  half 2 (V^2)                  image i - n
 *     node i >= 2n      fixed                         image i
 *
 *         | A'   A''  B |      A'   adjacency within either half
 *     A = | A''  A'   B |      A''  between the halves; its diagonal is the axis, edges {f, image of f}
 *         | B'   B'   C |      B, C of the fixed nodes (the appendix has m = 0)
 *
 * Parallel edges count as often as they occur; there are no loops. */
#ifndef SL_THEOREM_GRAPH_H
#define SL_THEOREM_GRAPH_H

#include "graph/csr.h"

typedef struct sl_theorem_graph {
    int32_t pairs, fixed; /* n, m */
    sl_graph graph;       /* 2 n + m nodes; weight NULL */
    int32_t *second;      /* another involution of the nodes, 2 n + m; NULL = none known */
    int32_t *label;       /* what a node was called where it came from; NULL = its own number */
} sl_theorem_graph;

static inline int32_t sl_theorem_nodes(const sl_theorem_graph *graph)
{
    return 2 * graph->pairs + graph->fixed;
}

/* The mirror. */
static inline int32_t sl_theorem_image(const sl_theorem_graph *graph, int32_t node)
{
    const int32_t n = graph->pairs;
    return node < n ? node + n : node < 2 * n ? node - n : node;
}

/* From edges (two node numbers each). Whether the mirror carries edges to edges is not asked here: that is statement
 * 0's business. SL_BAD_INPUT (a number out of range, a loop, sizes below 0 or no node), SL_OUT_OF_MEMORY. */
SL_NODISCARD sl_status sl_theorem_graph_create(int32_t pairs, int32_t fixed, const int32_t *edge, int64_t edges,
                                               sl_theorem_graph **out);

/* A graph renumbered by an involution of its nodes, copied: pairs in the order of their smaller node, then the fixed
 * nodes; label = the old numbers. second: another involution of the same nodes, or NULL. SL_BAD_INPUT (mirror or second
 * is no involution, or the graph has loops), SL_OUT_OF_MEMORY. */
SL_NODISCARD sl_status sl_theorem_graph_from_mirror(const sl_graph *graph, const int32_t *mirror, const int32_t *second,
                                                    sl_theorem_graph **out);

void sl_theorem_graph_free(sl_theorem_graph *graph); /* NULL is a no-op */

/* Does the involution `image` (NULL: the graph's mirror) carry edges to edges, parallel ones as often? *at: the first
 * node whose neighbours do not go to the neighbours of its image, -1 = none. SL_OUT_OF_MEMORY. */
SL_NODISCARD sl_status sl_theorem_graph_check(const sl_theorem_graph *graph, const int32_t *image, int32_t *at);

/* A text file, to be replayed:
 *
 *     seamlab-theorem-graph 1
 *     pairs N
 *     fixed M
 *     edges E
 *     A B            E lines, node numbers as above
 *     second         optional: then 2 N + M lines, the image of each node under another involution
 *     ...
 *     end
 *
 * Blank lines and lines that begin with '#' are skipped. SL_BAD_INPUT (with file and line), SL_IO, SL_OUT_OF_MEMORY. */
SL_NODISCARD sl_status sl_theorem_graph_read(const char *path, sl_theorem_graph **out, sl_diag *diag);

/* comment (nullable): one line. SL_IO, SL_OUT_OF_MEMORY. */
SL_NODISCARD sl_status sl_theorem_graph_write(const char *path, const sl_theorem_graph *graph, const char *comment,
                                              sl_diag *diag);

#endif
