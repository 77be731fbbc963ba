/* Cages from blocks: the surface of a union of grid cells.
 * Layer: datasets-gen. */
#ifndef SL_GENERATORS_VOXELS_H
#define SL_GENERATORS_VOXELS_H

#include "boxmodel.h"

/* Cells (i, j, k) of an n[0] x n[1] x n[2] grid whose character in `layer[k]` at [j * n[0] + i] is '#'; 'o' is a cell
 * that is empty but takes the sides it shares with '#' away, so that the surface has a border there. Cell (i, j, k)
 * spans one unit around (i - (n[0] - 1) / 2, ...): the grid's middle is the origin. Cells must meet in whole sides (no
 * two '#' that share only an edge or a corner). The cage must be empty. */
void gen_cage_voxels(gen_cage *cage, const int32_t n[3], const char *const *layer);

/* Takes the steps out of a closed cage, `times` times over: x and y of each vertex go half of the way to the mean of
 * its neighbours; z stays. */
void gen_cage_relax_flat(gen_cage *cage, int32_t times);

#endif
