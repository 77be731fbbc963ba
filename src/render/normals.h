/* Normals for smooth shading.
 * Layer: render. */
#ifndef SL_RENDER_NORMALS_H
#define SL_RENDER_NORMALS_H

#include "mesh/mesh.h"

/* A unit normal per corner (3 nh floats): the mean of the facets around the vertex weighted by their angle there, taken
 * between creases, edges whose facets' normals differ by more than crease_degrees. Seams do not split; borders do.
 * Corners of facets without area get a zero normal when no neighbour has one. SL_OUT_OF_MEMORY. O(corners).
 * Source: Thuermer and Wuethrich 1998, "Computing vertex normals from polygonal facets". */
SL_NODISCARD sl_status sl_corner_normals(const sl_mesh *mesh, double crease_degrees, float *normal);

#endif
