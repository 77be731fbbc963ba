/* Equal points share a number: welding by exact value.
 * Layer: atlas. */
#ifndef SL_ATLAS_WELD_H
#define SL_ATLAS_WELD_H

#include "base/status.h"

/* id[i] = number of the distinct point that row i of point (n x dim, dim 2 or 3) equals, numbered by first row; -0
 * equals +0, NaN rows all differ. *count distinct points. O(n log n). SL_OUT_OF_MEMORY. */
SL_NODISCARD sl_status sl_weld_points(int64_t n, int32_t dim, const double *point, int32_t *id, int32_t *count);

#endif
