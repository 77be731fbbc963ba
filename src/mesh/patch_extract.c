#include "base/memory.h"
#include "mesh/edge_groups_internal.h"
#include "mesh/face_map_internal.h"
#include "mesh/patch_internal.h"

/* The polygons of the set and how their triangles' corners stand to them. Polygon corner k of the i-th facet has the
 * number first[i] + k. */
typedef struct extraction {
    const sl_mesh *mesh;
    const sl_triangulation *triangulation;
    const int32_t *faces;
    int32_t nfaces;
    int32_t *first;       /* nfaces + 1 */
    int32_t *edge_corner; /* first[nfaces]: patch corner whose halfedge is the polygon's edge */
    sl_face_map map;
    sl_patch *patch;
} extraction;

static int32_t number_of(const extraction *x, int32_t i, int32_t h)
{
    return x->first[i] + (h - x->mesh->face_first[x->faces[i]]);
}

static sl_status start(extraction *x)
{
    sl_status status = SL_OK;
    int64_t nt = 0;
    x->first = sl_alloc((int64_t)x->nfaces + 1, sizeof *x->first);
    SL_TRY(x->first != NULL ? SL_OK : SL_OUT_OF_MEMORY);
    x->first[0] = 0;
    for (int32_t i = 0; i < x->nfaces; i++) {
        const int32_t d = sl_degree(x->mesh, x->faces[i]);
        x->first[i + 1] = x->first[i] + d;
        nt += d - 2;
    }
    x->edge_corner = sl_alloc(x->first[x->nfaces], sizeof *x->edge_corner);
    SL_TRY(x->edge_corner != NULL ? SL_OK : SL_OUT_OF_MEMORY);
    SL_TRY(sl_face_map_init(x->mesh->nf, x->faces, x->nfaces, &x->map));
    SL_TRY(sl_patch_allocate(nt, &x->patch));
cleanup:
    return status;
}

/* Copies the triangles and notes which of their halfedges are edges of the polygons; returns how many are not. */
static int32_t copy_triangles(extraction *x)
{
    sl_patch *p = x->patch;
    int32_t c = 0, diagonals = 0;
    for (int32_t i = 0; i < x->nfaces; i++) {
        const int32_t f = x->faces[i], *first = x->triangulation->first;
        for (int32_t q = 3 * first[f]; q < 3 * first[f + 1]; q++, c++) {
            const int32_t h = x->triangulation->corner[q], to = x->triangulation->corner[sl_corner_next(q)];
            p->corner[c] = h;
            p->tri[c] = x->mesh->origin[h];
            p->facet[c / 3] = f;
            if (to == sl_next(x->mesh, h)) {
                x->edge_corner[number_of(x, i, h)] = c;
            } else {
                diagonals++;
            }
        }
    }
    return diagonals;
}

static void glue_polygons(extraction *x)
{
    const sl_mesh *m = x->mesh;
    for (int32_t i = 0; i < x->nfaces; i++) {
        const int32_t f = x->faces[i];
        for (int32_t h = m->face_first[f]; h < m->face_first[f + 1]; h++) {
            const int32_t t = m->twin[h], j = t >= 0 ? sl_face_map_find(&x->map, m->face[t]) : -1;
            if (j >= 0) {
                x->patch->twin[x->edge_corner[number_of(x, i, h)]] = x->edge_corner[number_of(x, j, t)];
            }
        }
    }
}

/* Glues the triangles of a polygon along its diagonals. */
static sl_status glue_diagonals(extraction *x, int32_t count)
{
    sl_status status = SL_OK;
    sl_patch *p = x->patch;
    sl_edge_groups groups = {0};
    int32_t *from = sl_alloc(count, sizeof *from), *to = sl_alloc(count, sizeof *to), n = 0;
    int32_t *corner = sl_alloc(count, sizeof *corner);
    SL_TRY(from != NULL && to != NULL && corner != NULL ? SL_OK : SL_OUT_OF_MEMORY);
    for (int32_t c = 0; c < 3 * p->nt; c++) {
        const int32_t h = p->corner[c], end = p->corner[sl_corner_next(c)];
        if (end != sl_next(x->mesh, h)) {
            const int32_t i = sl_face_map_find(&x->map, p->facet[c / 3]);
            from[n] = number_of(x, i, h);
            to[n] = number_of(x, i, end);
            corner[n++] = c;
        }
    }
    SL_TRY(sl_edge_groups_init(x->first[x->nfaces], n, from, to, &groups));
    sl_edge_cursor cursor = {0};
    sl_edge_group group;
    while (sl_edge_groups_next(&groups, &cursor, &group)) {
        SL_ASSERT(group.count == 2);
        const int32_t a = corner[sl_edge_group_halfedge(&group, 0)], b = corner[sl_edge_group_halfedge(&group, 1)];
        p->twin[a] = b;
        p->twin[b] = a;
    }
cleanup:
    sl_edge_groups_clear(&groups);
    sl_free(from);
    sl_free(to);
    sl_free(corner);
    return status;
}

sl_status sl_patch_extract(const sl_mesh *mesh, const sl_triangulation *triangulation, const int32_t *faces,
                           int32_t nfaces, sl_patch **out)
{
    sl_status status = SL_OK;
    extraction x = {.mesh = mesh, .triangulation = triangulation, .faces = faces, .nfaces = nfaces};
    SL_TRY(start(&x));
    const int32_t diagonals = copy_triangles(&x);
    glue_polygons(&x);
    if (diagonals > 0) {
        SL_TRY(glue_diagonals(&x, diagonals));
    }
    SL_TRY(sl_patch_finish(x.patch, mesh->xyz));
    *out = x.patch;
    x.patch = NULL;
cleanup:
    sl_free(x.first);
    sl_free(x.edge_corner);
    sl_face_map_clear(&x.map);
    sl_patch_free(x.patch);
    return status;
}
