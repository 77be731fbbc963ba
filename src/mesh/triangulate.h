/* The virtual triangulation: each polygon's triangles, the mesh itself untouched.
 * Layer: mesh. */
#ifndef SL_MESH_TRIANGULATE_H
#define SL_MESH_TRIANGULATE_H

#include "mesh/mesh.h"

/* Triangles of facet f are t = first[f] .. first[f + 1] - 1 with corners corner[3 t + k], halfedges of the facet in its
 * orientation. A facet of d corners has d - 2 triangles. */
typedef struct sl_triangulation {
    int32_t nt;
    int32_t *first;  /* nf + 1 */
    int32_t *corner; /* 3 nt */
} sl_triangulation;

/* Fan from the facet's first input corner where that fan has no flipped or degenerate triangle against the facet's
 * vector area (what most programs do too); otherwise ear clipping in the facet's plane. Deterministic.
 * SL_OUT_OF_MEMORY. O(corners), O(d^2) for a concave facet of d corners. */
SL_NODISCARD sl_status sl_triangulation_create(const sl_mesh *mesh, sl_triangulation **out);

void sl_triangulation_free(sl_triangulation *triangulation); /* NULL is a no-op */

#endif
