/* The makers of the families; internal to the room.
 * Layer: theorem. */
#ifndef SL_THEOREM_FAMILIES_INTERNAL_H
#define SL_THEOREM_FAMILIES_INTERNAL_H

#include "theorem/families.h"
#include "theorem/theorem_internal.h"

/* Whole number in [0, count), count > 0. */
static inline int32_t sl_rng_index(sl_rng *rng, int32_t count)
{
    return (int32_t)(sl_rng_uniform(rng) * count);
}

/* families_plane.c */
sl_theorem_make sl_make_planar, sl_make_strip, sl_make_grid, sl_make_turned;
/* families_random.c */
sl_theorem_make sl_make_tree, sl_make_sparse, sl_make_fixed, sl_make_lobes, sl_make_crossed, sl_make_switched;
/* families_group.c */
sl_theorem_make sl_make_commuting, sl_make_dihedral;

#endif
