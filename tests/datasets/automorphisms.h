/* How many automorphisms a polygon mesh has: each halfedge is tried as the image of the first, by its own definition.
 */
#ifndef SL_TEST_DATASETS_AUTOMORPHISMS_H
#define SL_TEST_DATASETS_AUTOMORPHISMS_H

#include "mesh/mesh.h"

/* Those that keep the orientation (the identity among them), and those that reverse it. Connected meshes; stops at
 * `most` of either. -1 when memory is out. A try ends at the first difference. */
void test_count_automorphisms(const sl_mesh *mesh, int32_t most, int32_t *keeping, int32_t *reversing);

#endif
