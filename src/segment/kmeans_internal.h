/* Clustering of weighted points by k-means.
 * Layer: segment (private). */
#ifndef SL_SEGMENT_KMEANS_INTERNAL_H
#define SL_SEGMENT_KMEANS_INTERNAL_H

#include "base/context.h"

/* What is to be clustered; borrowed. */
typedef struct sl_kmeans_points {
    int32_t n, dims;
    const double *x;      /* n x dims, a row a point */
    const double *weight; /* n, >= 0, not all 0 */
} sl_kmeans_points;

typedef struct sl_kmeans_def {
    int32_t clusters; /* >= 1; points that coincide may leave fewer */
    int32_t starts;   /* seedings tried; the best result is kept; default 8 */
    uint64_t seed;    /* of the random numbers; default 1 */
} sl_kmeans_def;

sl_kmeans_def sl_kmeans_default(int32_t clusters);

/* label: n, numbered from 0 without gaps; *count clusters, none empty; *energy = sum of weight |x - centre|^2.
 * SL_OUT_OF_MEMORY, SL_CANCELLED. */
SL_NODISCARD sl_status sl_kmeans(const sl_kmeans_points *points, const sl_kmeans_def *def, const sl_context *context,
                                 int32_t *label, int32_t *count, double *energy);

#endif
