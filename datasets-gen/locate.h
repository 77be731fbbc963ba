/* Vertices by their position.
 * Layer: datasets-gen. */
#ifndef SL_GENERATORS_LOCATE_H
#define SL_GENERATORS_LOCATE_H

#include "base/status.h"

/* A vertex by its coordinate along a direction in which hardly any two vertices of a model coincide. */
typedef struct gen_located {
    double along;
    int32_t vertex;
} gen_located;

/* Points sorted along that direction; xyz is borrowed. */
typedef struct gen_locator {
    const double *xyz;
    int32_t nv;
    double tolerance;   /* largest difference in any coordinate, in the mesh's units */
    gen_located *order; /* nv, owned */
} gen_locator;

/* tolerance: a share of the largest extent of the points. SL_OUT_OF_MEMORY. O(nv log nv). */
SL_NODISCARD sl_status gen_locator_init(gen_locator *locator, const double *xyz, int32_t nv, double tolerance);

/* The point at p, within the tolerance; of several the one of lowest number; -1 = none. O(log nv). */
int32_t gen_locate(const gen_locator *locator, const double p[3]);

void gen_locator_clear(gen_locator *locator);

#endif
