/* The extend-add of the multifrontal method: a child's update matrix goes into its parent's panel and update matrix;
 * internal to the room.
 * Layer: sparse. */
#ifndef SL_SPARSE_EXTEND_ADD_H
#define SL_SPARSE_EXTEND_ADD_H

#include "sparse/cholesky_internal.h"

/* Fills F->relative from F's rows below, which hold their true numbers yet. */
void sl_match_rows(sl_cholesky *F);

/* Adds those columns of the update matrix U (packed) of s that its parent owns to the parent's panel, */
void sl_extend_panel(const sl_cholesky *F, int32_t s, const double *U, double *panel);

/* and the others to the parent's update matrix, which does not overlap U. */
void sl_extend_update(const sl_cholesky *F, int32_t s, const double *U, double *update);

#endif
