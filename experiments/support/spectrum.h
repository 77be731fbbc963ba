/* A mesh with the spectrum of its facet graph and the cuts that it proposes.
 * Layer: experiments. */
#ifndef SL_EXPERIMENTS_SPECTRUM_H
#define SL_EXPERIMENTS_SPECTRUM_H

#include "support/run.h"

/* Of the largest component. */
typedef struct exp_spectrum {
    sl_mesh *mesh; /* all of it */
    sl_triangulation *triangulation;
    int32_t face_count, *faces; /* of the component */
    sl_facet_graph *graph;
    sl_spectrum *spectrum;
    sl_cut_candidate *candidate; /* spectrum->count - 1: of vectors 1 .. */
} exp_spectrum;

/* polygons: borrowed until this returns. vectors: pairs wanted, clipped to the facets. SL_BAD_INPUT, SL_OUT_OF_MEMORY,
 * SL_INTERNAL. Freed by exp_spectrum_clear, also after failure. */
SL_NODISCARD sl_status exp_spectrum_make(exp_run *run, const sl_polygons *polygons, int32_t vectors, exp_spectrum *out);
void exp_spectrum_clear(exp_spectrum *s);

/* Vector k as a value a facet of the mesh, NaN outside the component. value: nf. */
void exp_spectrum_values(const exp_spectrum *s, int32_t k, double *value);

/* The halfedges on the positive side of the edges between the signs of vector k. edge: room for nh; returns how many.
 * side: graph's n, filled. */
int32_t exp_spectrum_seam(const exp_spectrum *s, int32_t k, uint8_t *side, int32_t *edge);

#endif
