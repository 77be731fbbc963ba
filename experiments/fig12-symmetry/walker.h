/* The figure's model: a person whose legs are symmetric in themselves, as those of the paper's are.
 * Layer: experiments. */
#ifndef SL_EXPERIMENTS_WALKER_H
#define SL_EXPERIMENTS_WALKER_H

#include "generators.h"

/* A mirror x, and no other: front and back of body, head and arms differ. Straight legs without toes: each has mirrors
 * of its own, left to right and front to back. Quads. SL_OUT_OF_MEMORY. */
SL_NODISCARD sl_status walker_make(sl_generated **out);

#endif
