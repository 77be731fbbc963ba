/* Figure 16: the mesh, its graph, and pictures of both. */
#ifndef SL_EXPERIMENTS_FIGURE16_H
#define SL_EXPERIMENTS_FIGURE16_H

#include "support/claims.h"
#include "support/pictures.h"

/* A small turtle of quads, symmetric about x = 0. Owned by the caller. */
SL_NODISCARD sl_status figure_mesh(sl_mesh **mesh, sl_diag *diag);

/* The facet graph seen through the exact mirror of most axis edges. */
typedef struct symmetric_graph {
    int32_t *image;   /* nf: mirror image of a facet */
    uint8_t *side;    /* nf: 1 = V1, 0 = V2 */
    int32_t pairs;    /* n: facets other than their images, halved */
    int32_t inner;    /* edges of A', both halves together */
    int32_t crossing; /* edges of A'' */
    int32_t off_diagonal, axis_edges, broken;
} symmetric_graph;

SL_NODISCARD sl_status symmetric_graph_create(const sl_mesh *mesh, const sl_context *context, symmetric_graph *g);
void symmetric_graph_clear(symmetric_graph *g);

/* The mesh with its dual graph drawn on it, black or in the colours of the symmetry. */
SL_NODISCARD sl_status draw_graph(exp_run *run, const sl_mesh *mesh, const symmetric_graph *g, bool symmetry,
                                  const char *file);

#endif
