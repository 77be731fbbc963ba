/* Nearest points on a set of triangles: a tree of boxes.
 * Layer: symmetry, private. */
#ifndef SL_SYMMETRY_NEAREST_H
#define SL_SYMMETRY_NEAREST_H

#include "base/status.h"

typedef struct sl_nearest sl_nearest; /* opaque */

/* xyz: points, borrowed; vertex: 3 nt indices into them, borrowed; nt >= 1. SL_OUT_OF_MEMORY. Deterministic.
 * O(nt log nt) expected. */
SL_NODISCARD sl_status sl_nearest_create(const double *xyz, const int32_t *vertex, int32_t nt, sl_nearest **out);
void sl_nearest_free(sl_nearest *tree); /* NULL is a no-op */

/* The triangle nearest to p (of equally near ones any, the same each time), its nearest point, and the distance. */
int32_t sl_nearest_find(const sl_nearest *tree, const double p[3], double point[3], double *distance);

#endif
