/* A polygon mesh under construction.
 * Layer: datasets-gen. */
#ifndef SL_GENERATORS_BUILDER_H
#define SL_GENERATORS_BUILDER_H

#include "generators.h"

typedef struct gen_builder {
    double *xyz;
    int32_t *first, *index; /* first[nf] = corners so far */
    int64_t nv, nf, nc;     /* vertices, facets, corners */
    int64_t xyz_capacity, first_capacity, index_capacity;
    bool failed; /* out of memory; further calls do nothing */
} gen_builder;

/* Number of the new vertex. */
int32_t gen_vertex(gen_builder *b, double x, double y, double z);

/* A facet of n corners. */
void gen_facet(gen_builder *b, int32_t n, const int32_t *corner);
void gen_triangle(gen_builder *b, int32_t i, int32_t j, int32_t k);
void gen_quad(gen_builder *b, int32_t i, int32_t j, int32_t k, int32_t l);

/* Hands the arrays over and empties the builder. SL_OUT_OF_MEMORY if any call failed. */
SL_NODISCARD sl_status gen_finish(gen_builder *b, sl_generated **out);

void gen_clear(gen_builder *b);

/* The generators, one a file. */
sl_generate_fn gen_sphere, gen_torus, gen_box, gen_hand, gen_body, gen_spiky;

#endif
