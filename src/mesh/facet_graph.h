/* The dual graph of the facets, the paper's G = (F*, E*), Sec. 3.3.
 * Layer: mesh. */
#ifndef SL_MESH_FACET_GRAPH_H
#define SL_MESH_FACET_GRAPH_H

#include "graph/csr.h"
#include "mesh/mesh.h"

/* Nodes are facets, or pairs of triangles taken as the quad they came from. The edge behind entry p of the graph's
 * adjacency is halfedge[p] (leaving the node's own facet). Facets that share two edges are joined twice; loops (a facet
 * glued to itself, the diagonal of a pair) are dropped. */
typedef struct sl_facet_graph {
    sl_graph graph;    /* n nodes; weight NULL: the paper's graph is unweighted */
    int32_t *halfedge; /* graph.first[n]: mesh halfedge crossed */
    int32_t *node;     /* nfaces: node of faces[i] */
    double *centroid;  /* n x 3 */
} sl_facet_graph;

/* The graph of faces[0 .. nfaces - 1] over twin pointers inside the set. partner may be NULL (no pairing); a pair
 * counts only when both its facets are in the set and glued. Node order = order of the first facet. SL_OUT_OF_MEMORY.
 * O(corners). */
SL_NODISCARD sl_status sl_facet_graph_create(const sl_mesh *mesh, const int32_t *faces, int32_t nfaces,
                                             const int32_t *partner, sl_facet_graph **out);

void sl_facet_graph_free(sl_facet_graph *graph); /* NULL is a no-op */

#define SL_PAIR_AUTO_FRACTION 0.9 /* `auto` pairs triangles where at least this share finds a partner */

/* Pairs triangles back into quads: a matching of the edges between triangles, weighted by the shape of the quad they
 * would form (planar, right angles), as heavy as message passing finds it, then improved along augmenting paths while
 * that pairs more triangles. partner[f] = facet paired with f, or -1; length nf. *paired_fraction = share of the
 * triangles in pairs that look like a quad mesh: well shaped, three of four corners regular (four edges, or on the
 * border). Triangulated quad meshes have 0.93 and more, others 0.88 and less: `--pair auto` pairs when it is at least
 * 0.9. Facets that are no triangles stay alone. SL_OUT_OF_MEMORY. Deterministic. O(nh log nh), 200 rounds over nh at
 * most. */
SL_NODISCARD sl_status sl_pair_triangles(const sl_mesh *mesh, int32_t *partner, double *paired_fraction);

#endif
