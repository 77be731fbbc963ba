/* From cells back to the facets and corners of the mesh. */
#include "symmetry/symmetry_internal.h"

#include "base/memory.h"

typedef struct exporter {
    const sl_mesh *mesh;
    const sl_cells *cells;
    const int32_t *image;
    int32_t base, order;
} exporter;

/* Mesh corner of the boundary of the image cell that corner h goes to. */
static int32_t image_corner(const exporter *e, int32_t h)
{
    return e->cells->halfedge[e->image[e->cells->at[h] - e->base]];
}

/* The corner of facet g at the corner `to` of g's cell: another where the diagonal starts. */
static int32_t corner_in(const exporter *e, int32_t g, int32_t to)
{
    if (e->mesh->face[to] == g || e->cells->diagonal == NULL || e->cells->diagonal[g] < 0) {
        return to;
    }
    const int32_t d = e->cells->diagonal[g];
    return e->cells->at[d] == e->cells->at[to] ? d : to;
}

static int32_t partner_of(const exporter *e, int32_t f)
{
    return e->mesh->face[e->mesh->twin[e->cells->diagonal[f]]];
}

/* Facets of the pair of f and of the image pair that share an axis edge of an involution: the facet of the image pair
 * that f then goes to, or -1. */
static int32_t across_axis(const exporter *e, int32_t f, int32_t g)
{
    const int32_t pair[2] = {f, partner_of(e, f)}, other = partner_of(e, g);
    int32_t lowest = INT32_MAX, image = -1;
    for (int k = 0; k < 2 && e->order == 2 && g != f && other != f; k++) {
        for (int32_t h = e->mesh->face_first[pair[k]]; h < e->mesh->face_first[pair[k] + 1]; h++) {
            const int32_t t = e->mesh->twin[h], there = t >= 0 ? e->mesh->face[t] : -1;
            if ((there == g || there == other) && (h < t ? h : t) < lowest) {
                lowest = h < t ? h : t;
                image = k == 0 ? there : (there == g ? other : g);
            }
        }
    }
    return image;
}

static int32_t image_facet(const exporter *e, int32_t f)
{
    const sl_mesh *m = e->mesh;
    if (e->cells->diagonal == NULL || e->cells->diagonal[f] < 0) {
        return m->face[image_corner(e, m->face_first[f])];
    }
    const int32_t apex = image_corner(e, sl_prev(m, e->cells->diagonal[f])), g = m->face[apex];
    if (e->cells->diagonal[g] == sl_next(m, apex)) {
        return g; /* an apex again: diagonal to diagonal */
    }
    const int32_t axis = across_axis(e, f, g);
    if (axis >= 0) {
        return axis;
    }
    const int32_t other = partner_of(e, g);
    const bool lower = f < partner_of(e, f);
    return lower == (g < other) ? g : other;
}

sl_status sl_symmetry_export(const sl_mesh *mesh, const sl_symmetry *parts, const sl_cells *cells, const int32_t *image,
                             sl_symmetry_map *map)
{
    const int32_t begin = parts->first[map->from], end = parts->first[map->from + 1], last = parts->face[end - 1];
    map->count = end - begin;
    map->corners = parts->corner_first[last] + sl_degree(mesh, last);
    map->corner = sl_alloc(map->corners, sizeof *map->corner);
    map->facet = sl_alloc(map->count, sizeof *map->facet);
    if (map->corner == NULL || map->facet == NULL) {
        return SL_OUT_OF_MEMORY;
    }
    const exporter e = {mesh, cells, image, sl_cells_base(cells, map->from), map->order};
    int32_t *out = map->corner;
    for (int32_t i = begin; i < end; i++) {
        const int32_t f = parts->face[i], g = image_facet(&e, f);
        map->facet[i - begin] = g;
        for (int32_t h = mesh->face_first[f]; h < mesh->face_first[f + 1]; h++) {
            *out++ = corner_in(&e, g, image_corner(&e, h));
        }
    }
    return SL_OK;
}
