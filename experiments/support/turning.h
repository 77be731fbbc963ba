/* How jagged seams are.
 * Layer: experiments. */
#ifndef SL_EXPERIMENTS_TURNING_H
#define SL_EXPERIMENTS_TURNING_H

#include "seamlab.h"

/* Mean angle, in degrees, by which the seams turn at a vertex that two of their edges meet; 0 without any; NaN where
 * memory runs out, which breaks every claim about it. */
double exp_seam_turning(const sl_mesh *mesh);

#endif
