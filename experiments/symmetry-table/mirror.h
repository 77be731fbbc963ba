/* What is known of one planted mirror of one model.
 * Layer: experiments. */
#ifndef SL_EXPERIMENTS_MIRROR_H
#define SL_EXPERIMENTS_MIRROR_H

#include "generators.h"
#include "seamlab.h"

enum { RULES = 3, VECTORS = 60, USUAL_VECTORS = 30 };

extern const char *const rule_name[RULES];

/* Of a model, for all its mirrors. */
typedef struct model {
    const sl_generated *generated;
    sl_mesh *mesh; /* whole */
    sl_triangulation *triangulation;
    int32_t components;
    sl_symmetry *symmetry;   /* every automorphism */
    sl_facet_graph *graph;   /* of the facets, no pairs */
    sl_spectrum *spectrum;   /* VECTORS pairs; NULL where there are several components */
    sl_mesh *shared_mesh;    /* cut by the settings of `--preset fast` */
    sl_segmentation *shared; /* and what they made */
    int32_t *cut[RULES];     /* nf: part of a facet after the first cut of each rule, no smoothing; NULL likewise */
} model;

SL_NODISCARD sl_status model_create(const sl_generated *generated, const sl_context *context, model *out);
void model_clear(model *m);

typedef struct mirror_facts {
    bool found, used;
    bool among_usual; /* the lowest antisymmetric vector is one of the first 30 */
    bool passes;      /* the connectivity filter */
    bool exact_seam;  /* its seam is the axis, edge for edge, where signs are decided */
    bool chosen[RULES];
    int32_t fixed;     /* facets that are their own images */
    int32_t index;     /* of that vector, 0 = the constant one; -1 = not among VECTORS, or several components */
    int32_t undecided; /* facets whose entry of it is too small for its sign to be decided */
    double lambda;
} mirror_facts;

SL_NODISCARD sl_status mirror_measure(const model *m, const sl_planted *planted, mirror_facts *out);

/* Exact mirrors found: reflections, each component by itself. */
int32_t count_exact_mirrors(const model *m);

#endif
