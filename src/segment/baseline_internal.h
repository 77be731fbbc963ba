/* Cuts that do not come from eigenvectors of the facet graph, to compare with.
 * Layer: segment (private). */
#ifndef SL_SEGMENT_BASELINE_INTERNAL_H
#define SL_SEGMENT_BASELINE_INTERNAL_H

#include "mesh/facet_graph.h"
#include "segment/segment_internal.h"

/* Chooses a cut by def->method, which is not spectral. choice->found = false (and nothing owned): the method has none
 * (every facet lies on the same side of every plane). graph: the facet graph of the whole piece, connected.
 * SL_OUT_OF_MEMORY, SL_CANCELLED, SL_INTERNAL, SL_LIMIT. */
SL_NODISCARD sl_status sl_choose_baseline(const sl_piece *piece, const sl_facet_graph *graph, const sl_segment_def *def,
                                          const sl_context *context, sl_choice *choice);

/* The cuts of the methods; label: a number a node, count of them and all but `side` filled into choice. See each. */
SL_NODISCARD sl_status sl_fiedler_labels(const sl_facet_graph *graph, const sl_segment_def *def,
                                         const sl_context *context, int32_t *label, sl_choice *choice);
SL_NODISCARD sl_status sl_random_labels(const sl_piece *piece, const sl_facet_graph *graph, const sl_segment_def *def,
                                        int32_t *label, sl_choice *choice);
SL_NODISCARD sl_status sl_isocharts_labels(const sl_piece *piece, const sl_facet_graph *graph,
                                           const sl_segment_def *def, const sl_context *context, int32_t *label,
                                           sl_choice *choice);
SL_NODISCARD sl_status sl_embedding_labels(const sl_piece *piece, const sl_facet_graph *graph,
                                           const sl_segment_def *def, const sl_context *context, int32_t *label,
                                           sl_choice *choice);

/* Adds to area (n) the area, and to vector (3 n, nullable) the vector area, of the triangles of every node. */
void sl_node_areas(const sl_piece *piece, const sl_facet_graph *graph, double *area, double *vector);

/* Mean and covariance of a surface, each point of it counted alike. */
typedef struct sl_principal_axes {
    double centre[3];
    double variance[3]; /* ascending */
    double axis[3][3];  /* rows: unit vectors, their largest component positive */
} sl_principal_axes;

/* Exact integrals over the triangles. All 0 (axes those of the coordinates) without area. Cannot fail. O(triangles). */
void sl_principal_axes_compute(const sl_mesh *mesh, const sl_triangulation *triangulation, sl_principal_axes *axes);

/* Side of every node of the graph: 1 on and above the plane through the centre across the shortest axis along which
 * the surface has extent and that parts the nodes; *axis = 0, 1 or 2 (shortest to longest), -1 = none. side: n. */
void sl_pca_sides(const sl_principal_axes *axes, const sl_facet_graph *graph, int32_t *side, int32_t *axis);

#endif
