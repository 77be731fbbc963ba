/* An atlas taken apart into charts: facets joined over equal UVs, triangles grouped by chart. */
#include "atlas/measure_internal.h"

#include "atlas/weld.h"
#include "base/memory.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* One polygon edge of one facet, between welded positions a < b, with the welded UVs there. */
typedef struct face_edge {
    int32_t a, b, uv_a, uv_b, face;
    double length;
} face_edge;

static int compare_edges(const void *pa, const void *pb)
{
    const face_edge *a = pa, *b = pb;
    if (a->a != b->a) {
        return a->a < b->a ? -1 : 1;
    }
    if (a->b != b->b) {
        return a->b < b->b ? -1 : 1;
    }
    if (a->uv_a != b->uv_a) {
        return a->uv_a < b->uv_a ? -1 : 1;
    }
    if (a->uv_b != b->uv_b) {
        return a->uv_b < b->uv_b ? -1 : 1;
    }
    return (a->face > b->face) - (a->face < b->face);
}

static int32_t find_root(int32_t *parent, int32_t i)
{
    while (parent[i] != i) {
        parent[i] = parent[parent[i]];
        i = parent[i];
    }
    return i;
}

static void join_faces(const sl_atlas_view *view, int32_t *parent, int32_t f, int32_t g)
{
    if (view->table != NULL && view->table->face_chart[f] != view->table->face_chart[g]) {
        return;
    }
    const int32_t a = find_root(parent, f), b = find_root(parent, g);
    parent[a > b ? a : b] = a < b ? a : b;
}

/* Lists the polygon edges by welded ends; edges of zero length are left out. Returns how many. */
static int64_t list_edges(const sl_atlas_view *view, const int32_t *position, const int32_t *uv, face_edge *edge)
{
    const sl_polygons *p = view->polygons;
    int64_t count = 0;
    for (int32_t f = 0; f < p->nf; f++) {
        const int32_t first = p->face_first[f], end = p->face_first[f + 1];
        for (int32_t c = first; c < end; c++) {
            const int32_t d = c + 1 < end ? c + 1 : first;
            const int32_t i = p->index[c], j = p->index[d];
            if (position[i] == position[j]) {
                continue;
            }
            double q[2][3];
            for (int k = 0; k < 3; k++) {
                q[0][k] = (p->xyz[3 * (int64_t)i + k] - view->mesh->centre[k]) * view->mesh->scale;
                q[1][k] = (p->xyz[3 * (int64_t)j + k] - view->mesh->centre[k]) * view->mesh->scale;
            }
            const double dx = q[0][0] - q[1][0], dy = q[0][1] - q[1][1], dz = q[0][2] - q[1][2];
            const bool ascending = position[i] < position[j];
            edge[count++] = (face_edge){.a = position[ascending ? i : j],
                                        .b = position[ascending ? j : i],
                                        .uv_a = uv[ascending ? c : d],
                                        .uv_b = uv[ascending ? d : c],
                                        .face = f,
                                        .length = sqrt(dx * dx + dy * dy + dz * dz)};
        }
    }
    return count;
}

/* Numbers the charts by first facet, those of isolated facets only after the others. */
static void number_charts(sl_atlas_view *view, int32_t *parent)
{
    const int32_t nf = view->polygons->nf;
    for (int32_t f = 0; f < nf; f++) {
        view->face_chart[f] = -1;
    }
    view->charts = 0;
    for (int pass = 0; pass < 2; pass++) {
        for (int32_t f = 0; f < nf; f++) {
            const int32_t root = find_root(parent, f);
            if (view->face_chart[root] < 0 && (pass == 1 || !sl_view_isolated(view, f))) {
                view->face_chart[root] = view->charts++;
            }
        }
        view->counted = pass == 0 ? view->charts : view->counted;
    }
    for (int32_t f = 0; f < nf; f++) {
        view->face_chart[f] = view->face_chart[find_root(parent, f)];
    }
}

/* Joins the facets along one edge, count entries sorted by their UVs. Is it a seam? Isolated facets may hold others
 * together, but make no seams. */
static bool join_edge(const sl_atlas_view *view, const face_edge *edge, int64_t count, int32_t *parent)
{
    bool seam = false;
    const face_edge *first = NULL;
    for (int64_t k = 0; k < count; k++) {
        const face_edge *e = &edge[k];
        if (k > 0 && e->uv_a == e[-1].uv_a && e->uv_b == e[-1].uv_b) {
            join_faces(view, parent, e[-1].face, e->face);
        }
        if (sl_view_isolated(view, e->face)) {
            continue;
        }
        first = first != NULL ? first : e;
        seam |= e->uv_a != first->uv_a || e->uv_b != first->uv_b ||
                find_root(parent, e->face) != find_root(parent, first->face);
    }
    return seam;
}

sl_status sl_atlas_view_charts(sl_atlas_view *view, const double *corner_uv)
{
    const sl_polygons *p = view->polygons;
    const int64_t corners = p->face_first[p->nf];
    int32_t *position = sl_alloc(p->nv, sizeof *position), *uv = sl_alloc(corners, sizeof *uv);
    int32_t *parent = sl_alloc(p->nf, sizeof *parent), distinct = 0;
    face_edge *edge = sl_alloc(corners, sizeof *edge);
    sl_status status = SL_OUT_OF_MEMORY;
    view->face_chart = sl_alloc(p->nf, sizeof *view->face_chart);
    if (position == NULL || uv == NULL || parent == NULL || edge == NULL || view->face_chart == NULL) {
        goto cleanup;
    }
    SL_TRY(sl_weld_points(p->nv, 3, p->xyz, position, &distinct));
    SL_TRY(sl_weld_points(corners, 2, corner_uv, uv, &distinct));
    const int64_t count = list_edges(view, position, uv, edge);
    qsort(edge, (size_t)count, sizeof *edge, compare_edges);
    for (int32_t f = 0; f < p->nf; f++) {
        parent[f] = f;
    }
    view->seam_length = 0.0;
    for (int64_t begin = 0, end; begin < count; begin = end) {
        for (end = begin + 1; end < count && edge[end].a == edge[begin].a && edge[end].b == edge[begin].b; end++) {
        }
        view->seam_length += join_edge(view, edge + begin, end - begin, parent) ? edge[begin].length : 0.0;
    }
    number_charts(view, parent);
cleanup:
    sl_free(position);
    sl_free(uv);
    sl_free(parent);
    sl_free(edge);
    return status;
}

/* Writes triangle k of the triangulation to slot t. */
static void put_triangle(sl_atlas_view *view, const double *corner_uv, int32_t k, int32_t t)
{
    const sl_mesh *mesh = view->mesh;
    for (int j = 0; j < 3; j++) {
        const int32_t h = view->triangulation->corner[3 * (int64_t)k + j];
        const int64_t c = sl_input_corner(mesh, h);
        memcpy(view->xyz + 9 * (int64_t)t + 3 * j, mesh->xyz + 3 * (int64_t)mesh->origin[h], 3 * sizeof *view->xyz);
        memcpy(view->uv + 6 * (int64_t)t + 2 * j, corner_uv + 2 * c, 2 * sizeof *view->uv);
    }
}

static double signed_area(const double uv[6])
{
    return 0.5 * ((uv[2] - uv[0]) * (uv[5] - uv[1]) - (uv[4] - uv[0]) * (uv[3] - uv[1]));
}

sl_status sl_atlas_view_triangles(sl_atlas_view *view, const double *corner_uv)
{
    const sl_polygons *p = view->polygons;
    sl_status status = SL_OUT_OF_MEMORY;
    int32_t *slot = NULL;
    double *area = sl_calloc(view->charts, sizeof *area);
    view->chart_first = sl_calloc((int64_t)view->charts + 1, sizeof *view->chart_first);
    if (area == NULL || view->chart_first == NULL) {
        goto cleanup;
    }
    for (int32_t f = 0; f < p->nf; f++) {
        const int32_t n = p->face_first[f + 1] - p->face_first[f] - 2;
        view->chart_first[view->face_chart[f] + 1] += n;
        view->nt += n;
    }
    for (int32_t c = 0; c < view->charts; c++) {
        view->chart_first[c + 1] += view->chart_first[c];
    }
    view->xyz = sl_alloc(view->nt, 9 * sizeof *view->xyz);
    view->uv = sl_alloc(view->nt, 6 * sizeof *view->uv);
    slot = sl_copy(view->chart_first, view->charts, sizeof *slot);
    if (view->xyz == NULL || view->uv == NULL || slot == NULL) {
        goto cleanup;
    }
    for (int32_t f = 0; f < p->nf; f++) {
        for (int32_t k = view->triangulation->first[f]; k < view->triangulation->first[f + 1]; k++) {
            const int32_t t = slot[view->face_chart[f]]++;
            put_triangle(view, corner_uv, k, t);
            area[view->face_chart[f]] += signed_area(view->uv + 6 * (int64_t)t);
        }
    }
    for (int32_t c = 0; c < view->charts; c++) {
        for (int32_t t = view->chart_first[c]; area[c] < 0.0 && t < view->chart_first[c + 1]; t++) {
            for (int32_t i = 0; i < 5; i++) { /* swap corners 1 and 2 in both spaces */
                double *x = i < 3 ? view->xyz + 9 * (int64_t)t + 3 + i : view->uv + 6 * (int64_t)t + 2 + (i - 3);
                const int32_t apart = i < 3 ? 3 : 2;
                const double kept = x[0];
                x[0] = x[apart];
                x[apart] = kept;
            }
        }
    }
    status = SL_OK;
cleanup:
    sl_free(area);
    sl_free(slot);
    return status;
}
