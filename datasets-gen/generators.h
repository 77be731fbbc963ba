/* Meshes made on the spot: known shapes, the same bytes for the same seed.
 * Layer: datasets-gen (may include meshio and below). */
#ifndef SL_GENERATORS_H
#define SL_GENERATORS_H

#include "mesh/build.h"

/* A symmetry known from how the model was made: x -> M x + t carries it onto itself. */
typedef struct sl_planted {
    char name[32];     /* "mirror x", "rotation 72" */
    bool mirror;       /* a reflection in a plane (not an inversion in a point) */
    bool exact;        /* false: of the connectivity only (positions were perturbed) */
    double matrix[12]; /* 3 x 4, row-major: M | t */
    int32_t *vertex;   /* nv: image of a vertex */
    int32_t *face;     /* nf: image of a facet */
} sl_planted;

/* A symmetry of the surface only, about: no map of vertices and facets does it. */
typedef struct sl_near_planted {
    char name[32];
    double matrix[12]; /* 3 x 4, row-major: M | t */
} sl_near_planted;

/* A polygon mesh; all arrays owned. */
typedef struct sl_generated {
    int32_t nv, nf;
    double *xyz;         /* nv x 3 */
    int32_t *face_first; /* nf + 1 */
    int32_t *index;      /* face_first[nf] */
    int32_t nplanted;    /* symmetries known (generators of the group and all mirrors; the identity is not listed) */
    sl_planted *planted;
    bool more_mirrors; /* the group has more mirrors than listed: products of those with the rotations */
    int32_t nnear;
    sl_near_planted *near;
} sl_generated;

/* seed: random details (bumps, spikes); scale: 1 = the usual size, each further one about four times the facets.
 * SL_OUT_OF_MEMORY. Deterministic. */
typedef sl_status sl_generate_fn(uint64_t seed, int32_t scale, sl_generated **out);

typedef struct sl_generator {
    const char *name; /* "hand" */
    const char *what; /* one line for a list */
    sl_generate_fn *make;
    /* what the author knows, at every scale and seed */
    int32_t genus;      /* summed over the components */
    int32_t components; /* connected parts */
    int32_t borders;    /* border loops */
} sl_generator;

/* All generators, in a fixed order; borrowed. */
const sl_generator *sl_generators(int32_t *count);

/* The generator of that name, NULL = none. */
const sl_generator *sl_generator_find(const char *name);

/* The mesh as the builder takes it, borrowed. */
void sl_generated_polygons(const sl_generated *mesh, sl_polygons *polygons);

void sl_generated_free(sl_generated *mesh); /* NULL is a no-op */

#endif
