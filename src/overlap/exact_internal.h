/* The two halves of the exact test.
 * Layer: overlap. Private. */
#ifndef SL_OVERLAP_EXACT_INTERNAL_H
#define SL_OVERLAP_EXACT_INTERNAL_H

#include "base/context.h"

/* n triangles with area, counter-clockwise, 6 doubles each. taken[i] = 1 for those taken out; a pair that overlaps in
 * pair[0], pair[1] (else unchanged). With first_only the sweep ends there. SL_OUT_OF_MEMORY. */
SL_NODISCARD sl_status sl_exact_sweep(int32_t n, const double *triangle, bool first_only, uint8_t *taken,
                                      int32_t pair[2]);

/* Marks (red[i] = 1) each triangle that is taken, or overlaps one that is. SL_OUT_OF_MEMORY. */
SL_NODISCARD sl_status sl_exact_mark(int32_t n, const double *triangle, const uint8_t *taken, const sl_context *context,
                                     uint8_t *red);

#endif
