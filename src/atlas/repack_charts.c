#include "atlas/repack_internal.h"

#include "atlas/weld.h"
#include "base/memory.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const double half_pi = 1.5707963267948966;
static const double level = 1e-9; /* of the length that all slopes of a chart would add up to: less is no direction */

/* A chart's triangles as sorted numbers of welded UVs: equal lists are equal charts. */
typedef struct chart_key {
    int32_t chart, count;
    const int32_t *id; /* 3 count */
} chart_key;

static int compare_triangles(const void *pa, const void *pb)
{
    return memcmp(pa, pb, 3 * sizeof(int32_t)); /* any total order will do */
}

static int compare_keys(const void *pa, const void *pb)
{
    const chart_key *a = pa, *b = pb;
    if (a->count != b->count) {
        return a->count < b->count ? -1 : 1;
    }
    const int order = memcmp(a->id, b->id, 3 * (size_t)a->count * sizeof *a->id);
    return order != 0 ? order : (a->chart > b->chart) - (a->chart < b->chart);
}

static void sort_three(int32_t id[3])
{
    for (int k = 0; k < 3; k++) {
        const int i = k == 1 ? 1 : 0;
        if (id[i] > id[i + 1]) {
            const int32_t kept = id[i];
            id[i] = id[i + 1];
            id[i + 1] = kept;
        }
    }
}

/* Finds charts that lie exactly on earlier ones, mirrored or not. */
static sl_status find_copies(sl_uv_charts *c)
{
    int64_t corners = c->first[c->count], triangles = 0;
    int32_t distinct = 0;
    sl_status status = SL_OK;
    int32_t *number = sl_alloc(corners, sizeof *number), *id = NULL;
    chart_key *key = sl_alloc(c->count, sizeof *key);
    for (int32_t k = 0; k < c->count; k++) {
        triangles += c->chart[k].nt;
    }
    id = sl_alloc(3 * triangles, sizeof *id);
    SL_TRY(number != NULL && key != NULL && id != NULL ? SL_OK : SL_OUT_OF_MEMORY);
    SL_TRY(sl_weld_points(corners, 2, c->uv, number, &distinct));
    for (int32_t k = 0; k < c->count; k++) {
        int32_t *own = id + (c->chart[k].tri - c->tri);
        key[k] = (chart_key){k, c->chart[k].nt, own};
        for (int32_t t = 0; t < c->chart[k].nt; t++) {
            for (int i = 0; i < 3; i++) {
                own[3 * t + i] = number[c->first[k] + c->chart[k].tri[3 * t + i]];
            }
            sort_three(own + 3 * t);
        }
        qsort(own, (size_t)c->chart[k].nt, 3 * sizeof *own, compare_triangles);
    }
    qsort(key, (size_t)c->count, sizeof *key, compare_keys);
    for (int32_t k = 0; k < c->count; k++) {
        const bool same = k > 0 && key[k].count == key[k - 1].count &&
                          memcmp(key[k].id, key[k - 1].id, 3 * (size_t)key[k].count * sizeof *id) == 0;
        const int32_t before = same ? key[k - 1].chart : -1;
        c->copy_of[key[k].chart] = !same ? -1 : c->copy_of[before] >= 0 ? c->copy_of[before] : before;
    }
cleanup:
    sl_free(number);
    sl_free(id);
    sl_free(key);
    return status;
}

static sl_status allocate(const sl_atlas_view *view, sl_uv_charts *c)
{
    const sl_polygons *p = view->polygons;
    c->count = view->charts;
    c->chart = sl_calloc(c->count, sizeof *c->chart);
    c->copy_of = sl_alloc(c->count, sizeof *c->copy_of);
    c->first = sl_calloc((int64_t)c->count + 1, sizeof *c->first);
    c->corner = sl_alloc(p->face_first[p->nf], sizeof *c->corner);
    c->uv = sl_alloc(p->face_first[p->nf], 2 * sizeof *c->uv);
    c->tri = sl_alloc(view->triangulation->nt, 3 * sizeof *c->tri);
    return c->chart != NULL && c->copy_of != NULL && c->first != NULL && c->corner != NULL && c->uv != NULL &&
                   c->tri != NULL
               ? SL_OK
               : SL_OUT_OF_MEMORY;
}

/* Counts corners and triangles of each chart and lays out their arrays. */
static void lay_out(const sl_atlas_view *view, sl_uv_charts *c)
{
    const sl_polygons *p = view->polygons;
    int64_t triangles = 0;
    for (int32_t f = 0; f < p->nf; f++) {
        sl_pack_chart *chart = &c->chart[view->face_chart[f]];
        chart->nv += p->face_first[f + 1] - p->face_first[f];
        chart->nt += view->triangulation->first[f + 1] - view->triangulation->first[f];
    }
    for (int32_t k = 0; k < c->count; k++) {
        c->first[k + 1] = c->first[k] + c->chart[k].nv;
        c->chart[k].uv = c->uv + 2 * (int64_t)c->first[k];
        c->chart[k].tri = c->tri + 3 * triangles;
        triangles += c->chart[k].nt;
        c->chart[k].nv = c->chart[k].nt = 0;
    }
}

sl_status sl_uv_charts_init(const sl_atlas_view *view, const double *corner_uv, sl_uv_charts *c)
{
    const sl_polygons *p = view->polygons;
    sl_status status = SL_OK;
    *c = (sl_uv_charts){0};
    SL_TRY(allocate(view, c));
    lay_out(view, c);
    for (int32_t f = 0; f < p->nf; f++) {
        const int32_t k = view->face_chart[f], degree = p->face_first[f + 1] - p->face_first[f];
        sl_pack_chart *chart = &c->chart[k];
        int32_t *tri = c->tri + (chart->tri - c->tri);
        for (int32_t t = view->triangulation->first[f]; t < view->triangulation->first[f + 1]; t++, chart->nt++) {
            for (int i = 0; i < 3; i++) {
                const int32_t corner = sl_input_corner(view->mesh, view->triangulation->corner[3 * (int64_t)t + i]);
                tri[3 * (int64_t)chart->nt + i] = chart->nv + corner - p->face_first[f];
            }
        }
        for (int32_t i = 0; i < degree; i++) {
            const int64_t at = c->first[k] + chart->nv++, corner = p->face_first[f] + i;
            c->corner[at] = (int32_t)corner;
            memcpy(c->uv + 2 * at, corner_uv + 2 * corner, 2 * sizeof *c->uv);
        }
    }
    SL_TRY(find_copies(c));
cleanup:
    return status;
}

void sl_uv_charts_clear(sl_uv_charts *c)
{
    sl_free(c->chart);
    sl_free(c->copy_of);
    sl_free(c->first);
    sl_free(c->corner);
    sl_free(c->uv);
    sl_free(c->tri);
    *c = (sl_uv_charts){0};
}

/* Twice the triangle's UV area times the slope of its height: solves slope . d1 = h1, slope . d2 = h2 by Cramer. */
static void add_slope(const double *uv[3], const double height[3], double sum[2], double *length)
{
    const double d1[2] = {uv[1][0] - uv[0][0], uv[1][1] - uv[0][1]}, h1 = height[1] - height[0];
    const double d2[2] = {uv[2][0] - uv[0][0], uv[2][1] - uv[0][1]}, h2 = height[2] - height[0];
    const double sign = d1[0] * d2[1] - d1[1] * d2[0] < 0.0 ? -1.0 : 1.0;
    const double slope[2] = {sign * (h1 * d2[1] - h2 * d1[1]), sign * (h2 * d1[0] - h1 * d2[0])};
    sum[0] += slope[0];
    sum[1] += slope[1];
    *length += hypot(d1[0], d1[1]) * hypot(d2[0], d2[1]);
}

void sl_uv_charts_stand_up(const sl_atlas_view *view, int32_t axis, sl_uv_charts *c)
{
    const sl_polygons *p = view->polygons;
    for (int32_t k = 0; k < c->count; k++) {
        double sum[2] = {0.0, 0.0}, length = 0.0;
        for (int32_t t = 0; t < c->chart[k].nt; t++) {
            const double *uv[3];
            double height[3];
            for (int i = 0; i < 3; i++) {
                const int32_t point = c->chart[k].tri[3 * (int64_t)t + i];
                const int32_t vertex = p->index[c->corner[c->first[k] + point]];
                uv[i] = c->chart[k].uv + 2 * (int64_t)point;
                height[i] = (p->xyz[3 * (int64_t)vertex + axis] - view->mesh->centre[axis]) * view->mesh->scale;
            }
            add_slope(uv, height, sum, &length);
        }
        c->chart[k].upright = hypot(sum[0], sum[1]) > level * length ? half_pi - atan2(sum[1], sum[0]) : 0.0;
    }
}
