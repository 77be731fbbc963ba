/* Do triangles of a mesh pass through one another? Plain double arithmetic, by its own definition. */
#ifndef SL_TEST_DATASETS_CROSSING_H
#define SL_TEST_DATASETS_CROSSING_H

#include "mesh/mesh.h"
#include "mesh/triangulate.h"

/* Number of pairs of triangles without a common vertex that cross; -1 when memory is out. Sweeps along x. */
int64_t test_count_crossings(const sl_mesh *mesh, const sl_triangulation *triangulation);

#endif
