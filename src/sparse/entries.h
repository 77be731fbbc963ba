/* Where the entries of A go in the panels; internal to the room.
 * Layer: sparse. */
#ifndef SL_SPARSE_ENTRIES_H
#define SL_SPARSE_ENTRIES_H

#include "sparse/cholesky_internal.h"

/* Fills F's entry_first, entry_from and entry_to from its supernodes. A: the matrix of G's blocks of F->block unknowns;
 * place: by block of A, its place in the order of elimination; owner: by that place, the supernode; next: supernodes,
 * workspace. */
void sl_map_entries(sl_cholesky *F, const sl_csc *A, const sl_csc *G, const int32_t *place, const int32_t *owner,
                    int64_t *next);

#endif
