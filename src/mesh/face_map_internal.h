/* Where a facet stands in a list of facets, in memory that grows with the list, not with the mesh.
 * Layer: mesh, private. */
#ifndef SL_MESH_FACE_MAP_INTERNAL_H
#define SL_MESH_FACE_MAP_INTERNAL_H

#include "mesh/mesh.h"

typedef struct sl_face_map {
    int32_t *position; /* direct: by facet; else by slot of an open-addressing table */
    int32_t *facet;    /* facet in a slot, -1 = free; NULL = direct */
    uint32_t mask;
} sl_face_map;

/* faces[0 .. nfaces - 1]: different facets in [0, nf). SL_OUT_OF_MEMORY. O(nfaces). */
SL_NODISCARD sl_status sl_face_map_init(int32_t nf, const int32_t *faces, int32_t nfaces, sl_face_map *out);

void sl_face_map_clear(sl_face_map *map);

static inline uint32_t sl_face_map_hash(int32_t f)
{
    const uint32_t x = (uint32_t)f * 0x9e3779b9u;
    return x ^ (x >> 15);
}

/* Position of facet f in the list, -1 when it is not there. */
static inline int32_t sl_face_map_find(const sl_face_map *map, int32_t f)
{
    if (map->facet == NULL) {
        return map->position[f];
    }
    uint32_t at = sl_face_map_hash(f) & map->mask;
    while (map->facet[at] >= 0 && map->facet[at] != f) {
        at = (at + 1) & map->mask;
    }
    return map->facet[at] == f ? map->position[at] : -1;
}

#endif
