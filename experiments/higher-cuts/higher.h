/* What the paper says of higher eigenvectors without a number: redundant, decorrelated, principal directions.
 * Layer: experiments. */
#ifndef SL_EXPERIMENTS_HIGHER_H
#define SL_EXPERIMENTS_HIGHER_H

#include "support/main.h"
#include "support/spectrum.h"

enum { HIGHER_VECTORS = 30, HIGHER_DISKS = 12 };

/* One eigenvector against those below it. */
typedef struct higher_vector {
    bool passes;
    double function; /* largest share of its variance that is a function of one lower vector (correlation ratio) */
    int32_t of;      /* that lower vector */
    double along;    /* share of its seam that lies along seams of lower vectors that pass, within one facet */
    double chance;   /* the same share of all edges */
    double cosine;   /* largest |cosine| with a lower vector */
} higher_vector;

/* vector: spectrum->count - 1, of vectors 1 .. . SL_OUT_OF_MEMORY. */
SL_NODISCARD sl_status higher_measure(const exp_spectrum *s, higher_vector *vector);

/* Geodesic disks about facets drawn from the seed: over the inner half of each, the smaller share of the variance of
 * the two flat coordinates (least squares conformal) that its first two vectors that pass explain linearly.
 * share: HIGHER_DISKS, *count of them: those that are disks with two such vectors. SL_OUT_OF_MEMORY, SL_INTERNAL. */
SL_NODISCARD sl_status higher_disks(exp_run *run, const exp_spectrum *s, uint64_t seed, double *share, int32_t *count);

#endif
