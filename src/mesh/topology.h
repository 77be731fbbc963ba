/* Components, border loops, Euler characteristic and genus of a set of facets over the uncut edges.
 * Layer: mesh. */
#ifndef SL_MESH_TOPOLOGY_H
#define SL_MESH_TOPOLOGY_H

#include "mesh/mesh.h"

/* label[f] = component number of facet f over twin pointers (seams separate), numbered by first facet; *count of them.
 * label: nf. SL_OUT_OF_MEMORY. O(nh). */
SL_NODISCARD sl_status sl_mesh_components(const sl_mesh *mesh, int32_t *label, int32_t *count);

/* Topology of one connected set of facets. */
typedef struct sl_topology {
    int32_t vertices, edges, faces; /* vertices counted once per fan: a vertex that a seam passes twice counts twice */
    int32_t euler;                  /* V - E + F */
    int32_t loops;                  /* border loops */
    int32_t genus;                  /* (2 - loops - euler) / 2 */
} sl_topology;

/* Topology of the connected facets faces[0 .. nfaces - 1], with every edge whose twin is outside the set or cut taken
 * as border. A disk has genus 0 and one loop. SL_OUT_OF_MEMORY. O(corners of the set) time and memory. */
SL_NODISCARD sl_status sl_mesh_topology(const sl_mesh *mesh, const int32_t *faces, int32_t nfaces, sl_topology *out);

#endif
