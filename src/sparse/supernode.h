/* The supernode partition of an elimination tree; internal to the room.
 * Layer: sparse. */
#ifndef SL_SPARSE_SUPERNODE_H
#define SL_SPARSE_SUPERNODE_H

#include "base/status.h"

/* Supernodes in postorder; owned arrays of length `count` (+ 1 for first). */
typedef struct sl_partition {
    int32_t count;
    int32_t *first;  /* first column, in the order below */
    int32_t *parent; /* supernode, -1 = root */
    int32_t *below;  /* rows of its panel under its own columns */
    int32_t *order;  /* n: order[k] = column of the tree that comes k-th, so that supernodes are contiguous */
} sl_partition;

/* Maximal supernodes of the tree (postordered; column counts as in sl_column_counts), then merged upwards where the
 * zeros stored for it stay few; of the graph of blocks of `block` columns, which is what the zeros are counted in.
 * SL_OUT_OF_MEMORY. Source: Liu, Ng, Peyton 1993; Ashcraft, Grimes 1989 (relaxed
 * amalgamation). Deviation: any child may be merged, not only the last, since columns are reordered afterwards. */
SL_NODISCARD sl_status sl_partition_create(int32_t n, int32_t block, const int32_t *parent, const int32_t *count,
                                           sl_partition *out);

void sl_partition_clear(sl_partition *partition);

#endif
