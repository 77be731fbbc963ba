/* Subtrees of the elimination tree that can be worked on side by side; internal to the room.
 * Layer: sparse. */
#ifndef SL_SPARSE_TASKS_H
#define SL_SPARSE_TASKS_H

#include "sparse/cholesky_internal.h"

/* Fills F's tasks, which depend on the tree alone, and codes F's rows below accordingly. SL_OUT_OF_MEMORY. */
SL_NODISCARD sl_status sl_tasks_create(sl_cholesky *F);

void sl_tasks_clear(sl_cholesky *F);

#endif
