/* Straight shapes, bent more and more.
 * Layer: experiments. */
#ifndef SL_EXPERIMENTS_BEND_H
#define SL_EXPERIMENTS_BEND_H

#include "support/run.h"

/* A model in its own principal axes: x along its length, z through its thickness. */
typedef struct bend_model {
    exp_mesh mesh;          /* of a generated one */
    int32_t *first, *index; /* owned, of one that is not generated; else NULL */
    double *rest;           /* nv x 3 */
    double *xyz;            /* nv x 3: bent */
    sl_polygons polygons;   /* with xyz */
    double length;
} bend_model;

/* A generated mesh. SL_BAD_INPUT (no such generator), SL_OUT_OF_MEMORY. */
SL_NODISCARD sl_status bend_load(exp_run *run, const char *name, bend_model *out);

/* Completes a model whose rest, polygons and arrays are there. SL_OUT_OF_MEMORY. */
SL_NODISCARD sl_status bend_begin(bend_model *model);

/* Rolls the model up about the y axis: its length becomes an arc of that many degrees, its thickness stays. */
void bend_by(bend_model *model, double degrees);

void bend_clear(bend_model *model);

/* How well two sides of the facets tell the front (rest z > 0) from the back: share of the area, in [1/2, 1].
 * side: a number a facet, 0 or not. */
double bend_equator(const bend_model *model, const int32_t *side);

#endif
