#include "atlas/measure.h"

#include "atlas/weld.h"
#include "base/memory.h"
#include "mesh/triangulate.h"
#include "overlap/coverage.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* One polygon edge of one facet, between welded positions a < b, with the welded UVs there. */
typedef struct face_edge {
    int32_t a, b, uv_a, uv_b, face;
    double length;
} face_edge;

/* The atlas taken apart: triangles grouped by chart. */
typedef struct atlas_view {
    const sl_polygons *polygons;
    const sl_sharing_table *table; /* nullable */
    sl_mesh *mesh;                 /* for the repair's reorientation and the normalisation */
    sl_triangulation *triangulation;
    int32_t nt;
    double *xyz;         /* 9 nt, normalised */
    double *uv;          /* 6 nt, bounding square moved to [0, 1]^2 */
    int32_t *face_chart; /* nf */
    int32_t charts;
    int32_t *chart_first; /* charts + 1: triangle range of a chart */
    double seam_length;   /* normalised units */
} atlas_view;

static void view_clear(atlas_view *view)
{
    sl_mesh_free(view->mesh);
    sl_triangulation_free(view->triangulation);
    sl_free(view->xyz);
    sl_free(view->uv);
    sl_free(view->face_chart);
    sl_free(view->chart_first);
}

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

static void join_faces(const atlas_view *view, int32_t *parent, int32_t f, int32_t g)
{
    if (view->table != NULL && view->table->face_chart[f] != view->table->face_chart[g]) {
        return;
    }
    const int32_t a = find_root(parent, f), b = find_root(parent, g);
    parent[a > b ? a : b] = a < b ? a : b;
}

/* Lists the polygon edges by welded ends; edges of zero length are left out. Returns how many. */
static int64_t list_edges(const atlas_view *view, const int32_t *position, const int32_t *uv, face_edge *edge)
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

/* Joins facets over edges of equal UVs; adds up the others' lengths. */
static sl_status find_charts(atlas_view *view, const double *corner_uv)
{
    const sl_polygons *p = view->polygons;
    const int64_t corners = p->face_first[p->nf];
    int32_t *position = sl_alloc(p->nv, sizeof *position), *uv = sl_alloc(corners, sizeof *uv);
    int32_t *parent = sl_alloc(p->nf, sizeof *parent), distinct = 0;
    face_edge *edge = sl_alloc(corners, sizeof *edge);
    sl_status status = SL_OUT_OF_MEMORY;
    if (position == NULL || uv == NULL || parent == NULL || edge == NULL) {
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
        bool seam = false;
        for (end = begin + 1; end < count && edge[end].a == edge[begin].a && edge[end].b == edge[begin].b; end++) {
            if (edge[end].uv_a == edge[end - 1].uv_a && edge[end].uv_b == edge[end - 1].uv_b) {
                join_faces(view, parent, edge[end - 1].face, edge[end].face);
            }
            seam |= edge[end].uv_a != edge[begin].uv_a || edge[end].uv_b != edge[begin].uv_b ||
                    find_root(parent, edge[end].face) != find_root(parent, edge[begin].face);
        }
        view->seam_length += seam ? edge[begin].length : 0.0;
    }
    view->charts = 0;
    for (int32_t f = 0; f < p->nf; f++) { /* a root is the first facet of its chart */
        const int32_t root = find_root(parent, f);
        view->face_chart[f] = root == f ? view->charts++ : view->face_chart[root];
    }
cleanup:
    sl_free(position);
    sl_free(uv);
    sl_free(parent);
    sl_free(edge);
    return status;
}

/* Writes triangle k of the triangulation to slot t. */
static void put_triangle(atlas_view *view, const double *corner_uv, int32_t k, int32_t t)
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

/* Triangles grouped by chart, facet order inside a chart, all turned so that a chart's main orientation is positive. */
static sl_status group_triangles(atlas_view *view, const double *corner_uv)
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

/* Moves the UVs' bounding square to [0, 1]^2. */
static void fit_bounding_square(atlas_view *view)
{
    double lo[2] = {HUGE_VAL, HUGE_VAL}, hi[2] = {-HUGE_VAL, -HUGE_VAL};
    for (int64_t i = 0; i < 3 * (int64_t)view->nt; i++) {
        for (int k = 0; k < 2; k++) {
            lo[k] = fmin(lo[k], view->uv[2 * i + k]);
            hi[k] = fmax(hi[k], view->uv[2 * i + k]);
        }
    }
    const double side = fmax(hi[0] - lo[0], hi[1] - lo[1]);
    for (int64_t i = 0; i < 3 * (int64_t)view->nt && side > 0.0; i++) {
        for (int k = 0; k < 2; k++) {
            view->uv[2 * i + k] = (view->uv[2 * i + k] - lo[k]) / side;
        }
    }
}

/* Texel box of a chart, one texel wider than its UVs. */
static void texel_box(const atlas_view *view, int32_t chart, int32_t resolution, int32_t lo[2], int32_t hi[2])
{
    double a[2] = {1.0, 1.0}, b[2] = {0.0, 0.0};
    for (int64_t i = 3 * (int64_t)view->chart_first[chart]; i < 3 * (int64_t)view->chart_first[chart + 1]; i++) {
        for (int k = 0; k < 2; k++) {
            a[k] = fmin(a[k], view->uv[2 * i + k]);
            b[k] = fmax(b[k], view->uv[2 * i + k]);
        }
    }
    for (int k = 0; k < 2; k++) {
        lo[k] = (int32_t)fmax(0.0, floor(a[k] * resolution) - 1.0);
        hi[k] = (int32_t)fmin(resolution - 1.0, ceil(b[k] * resolution) + 1.0);
    }
}

/* What is known of a texel. */
enum { SEEN = 1, INSIDE = 2, ACROSS = 4, SHARED = 8 };

/* The texels as charts are laid on them one after another. */
typedef struct texel_map {
    int32_t side;
    uint8_t *seen;    /* side^2 */
    int32_t *owner;   /* side^2: chart of the table that came first; NULL without a table */
    sl_coverage *own; /* the chart at hand, emptied again over its box */
} texel_map;

static void texel_map_clear(texel_map *map)
{
    sl_free(map->seen);
    sl_free(map->owner);
    sl_coverage_free(map->own);
}

static sl_status texel_map_create(texel_map *map, bool owners)
{
    const int64_t texels = (int64_t)map->side * map->side;
    map->seen = sl_calloc(texels, sizeof *map->seen);
    map->owner = owners ? sl_alloc(texels, sizeof *map->owner) : NULL;
    if (map->seen == NULL || (owners && map->owner == NULL)) {
        return SL_OUT_OF_MEMORY;
    }
    return sl_coverage_create(map->side, map->side, &map->own);
}

/* The chart of the table that a chart found belongs to, and what that copies; both -1 without a table. */
static void table_entry(const atlas_view *view, const int32_t *first_face, int32_t chart, int32_t *label,
                        int32_t *source)
{
    *label = view->table != NULL ? view->table->face_chart[first_face[chart]] : -1;
    *source = *label >= 0 ? view->table->copy_of[*label] : -1;
}

/* Adds the chart just drawn into map->own. label, source: see table_entry. */
static void add_chart(const atlas_view *view, int32_t chart, int32_t label, int32_t source, texel_map *map)
{
    int32_t lo[2], hi[2];
    texel_box(view, chart, map->side, lo, hi);
    for (int32_t y = lo[1]; y <= hi[1]; y++) {
        for (int32_t x = lo[0]; x <= hi[0]; x++) {
            const int64_t i = (int64_t)y * map->side + x;
            if (map->own->count[i] == 0) {
                continue;
            }
            const bool met = map->seen[i] != 0, meant = met && source >= 0 && map->owner[i] == source;
            if (map->owner != NULL && !met) {
                map->owner[i] = label;
            }
            map->seen[i] |= (uint8_t)((map->own->count[i] > 1 ? INSIDE : 0) | (met && !meant ? ACROSS : 0) |
                                      (meant ? SHARED : 0) | SEEN);
            map->own->count[i] = 0;
        }
    }
}

static void sum_texels(const texel_map *map, sl_atlas_measure *out)
{
    int64_t covered = 0, inside = 0, across = 0, shared = 0;
    const int64_t n = (int64_t)map->side * map->side;
    for (int64_t i = 0; i < n; i++) {
        covered += (map->seen[i] & SEEN) != 0;
        inside += (map->seen[i] & INSIDE) != 0;
        across += (map->seen[i] & ACROSS) != 0;
        shared += (map->seen[i] & SHARED) != 0;
    }
    out->fill = (double)covered / (double)n;
    out->overlap_inside = covered > 0 ? (double)inside / (double)covered : 0.0;
    out->overlap_across = covered > 0 ? (double)across / (double)covered : 0.0;
    out->shared = covered > 0 ? (double)shared / (double)covered : 0.0;
}

/* The first facet of each chart; owned by the caller. */
static int32_t *first_faces(const atlas_view *view)
{
    int32_t *first = sl_alloc(view->charts, sizeof *first);
    for (int32_t f = view->polygons->nf - 1; first != NULL && f >= 0; f--) {
        first[view->face_chart[f]] = f;
    }
    return first;
}

/* Counts texels chart by chart, copies after the charts they copy. */
static sl_status count_overlaps(const atlas_view *view, const sl_context *context, sl_atlas_measure *out)
{
    texel_map map = {.side = out->resolution};
    int32_t largest = 0, *tri = NULL, *first_face = first_faces(view);
    sl_status status = SL_OUT_OF_MEMORY;
    for (int32_t c = 0; c < view->charts; c++) {
        const int32_t count = view->chart_first[c + 1] - view->chart_first[c];
        largest = count > largest ? count : largest;
    }
    tri = sl_alloc(3 * (int64_t)largest, sizeof *tri);
    if (first_face == NULL || tri == NULL) {
        goto cleanup;
    }
    for (int32_t i = 0; i < 3 * largest; i++) {
        tri[i] = i;
    }
    SL_TRY(texel_map_create(&map, view->table != NULL));
    for (int copies = 0; copies < 2; copies++) {
        for (int32_t c = 0; c < view->charts; c++) {
            int32_t label, source;
            table_entry(view, first_face, c, &label, &source);
            if ((source >= 0) == (copies == 1)) {
                SL_TRY(sl_coverage_add(map.own, view->uv + 6 * (int64_t)view->chart_first[c],
                                       view->chart_first[c + 1] - view->chart_first[c], tri, context));
                add_chart(view, c, label, source, &map);
                out->copies += copies;
            }
        }
    }
    sum_texels(&map, out);
cleanup:
    texel_map_clear(&map);
    sl_free(first_face);
    sl_free(tri);
    return status;
}

static sl_status measure_charts(const atlas_view *view, sl_atlas_measure *out)
{
    double sum = 0.0;
    int32_t counted = 0;
    out->worst_chart = -1;
    for (int32_t c = 0; c < view->charts; c++) {
        const int64_t first = view->chart_first[c];
        const int32_t count = view->chart_first[c + 1] - view->chart_first[c];
        sl_distortion d;
        const sl_status status = sl_distortion_measure(count, view->xyz + 9 * first, view->uv + 6 * first, 1, &d);
        if (status != SL_OK) {
            return status;
        }
        out->charts10 += count <= 10;
        if (d.measured == 0) { /* degenerate in 3D: no stretch to speak of */
            continue;
        }
        sum += d.l2;
        counted++;
        if (out->worst_chart < 0 || d.l2 > out->chart_l2_worst) {
            out->worst_chart = c;
            out->chart_l2_worst = d.l2;
        }
    }
    out->chart_l2_mean = counted > 0 ? sum / counted : 1.0;
    return SL_OK;
}

static sl_status check_uvs(const sl_polygons *polygons, const double *corner_uv, sl_diag *diag)
{
    for (int32_t f = 0; f < polygons->nf; f++) {
        for (int64_t c = 2 * (int64_t)polygons->face_first[f]; c < 2 * (int64_t)polygons->face_first[f + 1]; c++) {
            if (!isfinite(corner_uv[c])) {
                sl_diag_reason(diag, "facet %d has a corner without a finite UV", f + 1);
                sl_diag_hint(diag, "unwrap the mesh first");
                if (diag != NULL) {
                    diag->element = f;
                }
                return SL_BAD_INPUT;
            }
        }
    }
    return SL_OK;
}

/* Surface area by the same triangles that everything else is measured on. */
static double surface_area(const atlas_view *view)
{
    double area = 0.0;
    for (int64_t t = 0; t < view->nt; t++) {
        const double *x = view->xyz + 9 * t;
        double e[3], g[3], n[3];
        for (int k = 0; k < 3; k++) {
            e[k] = x[3 + k] - x[k];
            g[k] = x[6 + k] - x[k];
        }
        n[0] = e[1] * g[2] - e[2] * g[1];
        n[1] = e[2] * g[0] - e[0] * g[2];
        n[2] = e[0] * g[1] - e[1] * g[0];
        area += 0.5 * sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
    }
    return area;
}

void sl_sharing_table_clear(sl_sharing_table *table)
{
    sl_free(table->face_chart);
    sl_free(table->copy_of);
    *table = (sl_sharing_table){0};
}

sl_status sl_measure_atlas(const sl_polygons *polygons, const double *corner_uv, int32_t resolution,
                           const sl_context *context, sl_atlas_measure *out, sl_diag *diag)
{
    return sl_measure_shared(polygons, corner_uv, NULL, resolution, context, out, diag);
}

sl_status sl_measure_shared(const sl_polygons *polygons, const double *corner_uv, const sl_sharing_table *table,
                            int32_t resolution, const sl_context *context, sl_atlas_measure *out, sl_diag *diag)
{
    SL_ASSERT(resolution > 0);
    SL_ASSERT(table == NULL || table->nf == polygons->nf);
    atlas_view view = {.polygons = polygons, .table = table};
    sl_atlas_measure m = {.resolution = resolution};
    sl_status status = SL_OK;
    SL_TRY(check_uvs(polygons, corner_uv, diag));
    SL_TRY(sl_mesh_build(polygons, &view.mesh, NULL, diag));
    SL_TRY(sl_triangulation_create(view.mesh, &view.triangulation));
    view.face_chart = sl_alloc(polygons->nf, sizeof *view.face_chart);
    if (view.face_chart == NULL) {
        status = SL_OUT_OF_MEMORY;
        goto cleanup;
    }
    SL_TRY(find_charts(&view, corner_uv));
    SL_TRY(group_triangles(&view, corner_uv));
    const double area = surface_area(&view);
    m.triangles = view.nt;
    m.charts = view.charts;
    m.seam_length = area > 0.0 ? view.seam_length / sqrt(area) : 0.0;
    m.seam_diagonal = view.seam_length > 0.0 ? view.seam_length / sl_mesh_diagonal(view.mesh) : 0.0;
    SL_TRY(sl_distortion_measure(view.nt, view.xyz, view.uv, 1, &m.global));
    SL_TRY(measure_charts(&view, &m));
    fit_bounding_square(&view);
    SL_TRY(count_overlaps(&view, context, &m));
    *out = m;
cleanup:
    view_clear(&view);
    return status;
}
