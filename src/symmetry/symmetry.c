#include "symmetry/symmetry.h"

#include "base/memory.h"

sl_symmetry_def sl_symmetry_default(void)
{
    return (sl_symmetry_def){
        .exact = 1e-6, .lengths = 1e-3, .near = 1e-2, .most = SL_SYMMETRY_MOST, .corners = (int64_t)1 << 23};
}

void sl_symmetry_free(sl_symmetry *symmetry)
{
    if (symmetry == NULL) {
        return;
    }
    for (int32_t i = 0; i < symmetry->nmap; i++) {
        sl_free(symmetry->map[i].corner);
        sl_free(symmetry->map[i].facet);
    }
    sl_free(symmetry->map);
    sl_free(symmetry->first);
    sl_free(symmetry->face);
    sl_free(symmetry->component);
    sl_free(symmetry->place);
    sl_free(symmetry->corner_first);
    sl_free(symmetry->unit);
    sl_free(symmetry->original);
    sl_free(symmetry);
}

int32_t sl_symmetry_image(const sl_mesh *mesh, const sl_symmetry *symmetry, const sl_symmetry_map *map, int32_t f)
{
    (void)mesh;
    SL_ASSERT(symmetry->component[f] == map->from);
    return map->facet[symmetry->place[f] - symmetry->first[map->from]];
}

int32_t sl_symmetry_image_corner(const sl_mesh *mesh, const sl_symmetry *symmetry, const sl_symmetry_map *map,
                                 int32_t h)
{
    const int32_t f = mesh->face[h];
    SL_ASSERT(symmetry->component[f] == map->from);
    return map->corner[symmetry->corner_first[f] + (h - mesh->face_first[f])];
}

bool sl_symmetry_on_axis(const sl_mesh *mesh, const sl_symmetry *symmetry, const sl_symmetry_map *map, int32_t h)
{
    const int32_t f = mesh->face[h], g = mesh->twin[h] >= 0 ? mesh->face[mesh->twin[h]] : f;
    if (g == f) {
        return false;
    }
    const int32_t image = sl_symmetry_image(mesh, symmetry, map, f);
    const bool inside = symmetry->unit[f] == symmetry->unit[g]; /* the diagonal of a pair */
    return inside ? image == g : symmetry->unit[image] == symmetry->unit[g];
}
