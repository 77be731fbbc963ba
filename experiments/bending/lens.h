/* A flat ellipsoid whose facet graph has its proportions.
 * Layer: experiments. */
#ifndef SL_EXPERIMENTS_LENS_H
#define SL_EXPERIMENTS_LENS_H

#include "support/bend.h"

/* Half axes 3 : 1 : 0.45, 66 x 22 x 10 cells. SL_OUT_OF_MEMORY. */
SL_NODISCARD sl_status lens_make(bend_model *out);

#endif
