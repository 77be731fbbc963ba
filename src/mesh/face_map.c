#include "mesh/face_map_internal.h"

#include "base/memory.h"

enum {
    DIRECT_RATIO = 8, /* a list of at least 1/8 of the mesh is looked up directly */
};

static sl_status init_direct(int32_t nf, const int32_t *faces, int32_t nfaces, sl_face_map *out)
{
    out->position = sl_alloc(nf, sizeof *out->position);
    if (out->position == NULL) {
        return SL_OUT_OF_MEMORY;
    }
    for (int32_t f = 0; f < nf; f++) {
        out->position[f] = -1;
    }
    for (int32_t i = 0; i < nfaces; i++) {
        out->position[faces[i]] = i;
    }
    return SL_OK;
}

sl_status sl_face_map_init(int32_t nf, const int32_t *faces, int32_t nfaces, sl_face_map *out)
{
    *out = (sl_face_map){0};
    if (nf <= DIRECT_RATIO * (int64_t)nfaces) {
        return init_direct(nf, faces, nfaces, out);
    }
    int64_t size = 4;
    while (size < 2 * (int64_t)nfaces) {
        size *= 2;
    }
    out->mask = (uint32_t)(size - 1);
    out->facet = sl_alloc(size, sizeof *out->facet);
    out->position = sl_alloc(size, sizeof *out->position);
    if (out->facet == NULL || out->position == NULL) {
        sl_face_map_clear(out);
        return SL_OUT_OF_MEMORY;
    }
    for (int64_t s = 0; s < size; s++) {
        out->facet[s] = -1;
    }
    for (int32_t i = 0; i < nfaces; i++) {
        uint32_t at = sl_face_map_hash(faces[i]) & out->mask;
        while (out->facet[at] >= 0) {
            at = (at + 1) & out->mask;
        }
        out->facet[at] = faces[i];
        out->position[at] = i;
    }
    return SL_OK;
}

void sl_face_map_clear(sl_face_map *map)
{
    sl_free(map->position);
    sl_free(map->facet);
    *map = (sl_face_map){0};
}
