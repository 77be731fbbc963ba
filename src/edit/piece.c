/* The pieces a state is made of: charts, maps, slots, wishes. */
#include "edit/session_internal.h"

#include "base/memory.h"
#include "overlap/exact.h"

#include <math.h>
#include <string.h>

static const double thin =
    1e-5; /* triangles of 2 area <= thin longest^2 say nothing about stretch, as in distortion.h */

void sl_edit_chart_release(sl_edit_chart *chart)
{
    if (chart == NULL || --chart->refs > 0) {
        return;
    }
    sl_free(chart->face);
    sl_free(chart->uv);
    sl_free(chart->red);
    sl_free(chart->stretch);
    sl_free(chart);
}

void sl_edit_map_release(sl_edit_map *map)
{
    if (map != NULL && --map->refs == 0) {
        sl_free(map->from);
        sl_free(map);
    }
}

void sl_edit_slot_clear(sl_edit_slot *slot)
{
    sl_edit_chart_release(slot->chart);
    sl_edit_map_release(slot->map);
    *slot = (sl_edit_slot){.copy_of = -1};
}

sl_edit_slot sl_edit_slot_share(const sl_edit_slot *slot)
{
    if (slot->chart != NULL) {
        slot->chart->refs++;
    }
    if (slot->map != NULL) {
        slot->map->refs++;
    }
    return *slot;
}

void sl_edit_wish_release(sl_edit_wish *wish)
{
    if (wish != NULL && --wish->refs == 0) {
        sl_free(wish->corner);
        sl_free(wish->fan);
        sl_free(wish);
    }
}

void sl_edit_wishes_release(sl_edit_wishes *wishes)
{
    if (wishes == NULL || --wishes->refs > 0) {
        return;
    }
    for (int32_t i = 0; i < wishes->count; i++) {
        sl_edit_wish_release(wishes->wish[i]);
    }
    sl_free(wishes->wish);
    sl_free(wishes);
}

sl_status sl_edit_wishes_edit(const sl_edit_wishes *from, int32_t without, sl_edit_wish *with, sl_edit_wishes **out)
{
    const int32_t n = from != NULL ? from->count : 0;
    sl_edit_wishes *list = sl_calloc(1, sizeof *list);
    sl_edit_wish **wish = sl_alloc((int64_t)n + 1, sizeof *wish);
    if (list == NULL || wish == NULL) {
        sl_free(list);
        sl_free(wish);
        sl_edit_wish_release(with);
        return SL_OUT_OF_MEMORY;
    }
    *list = (sl_edit_wishes){.refs = 1, .wish = wish};
    for (int32_t i = 0; i < n; i++) {
        if (i != without) {
            from->wish[i]->refs++;
            wish[list->count++] = from->wish[i];
        }
    }
    if (with != NULL) {
        wish[list->count++] = with;
    }
    *out = list;
    return SL_OK;
}

void sl_edit_slot_place(const sl_edit_slot *slot, double *uv)
{
    const double c = slot->scale * cos(slot->angle), s = slot->scale * sin(slot->angle);
    for (int32_t i = 0; i < slot->chart->ncorner; i++) {
        const double *p = slot->chart->uv + 2 * (int64_t)i;
        uv[2 * (int64_t)i] = c * p[0] - s * p[1] + slot->offset[0];
        uv[2 * (int64_t)i + 1] = s * p[0] + c * p[1] + slot->offset[1];
    }
}

/* Twice the area of a triangle of a patch, its longest edge squared, and the squared L2 stretch of its map; infinite
 * where the map has collapsed. k: scale applied to uv. */
static double triangle_stretch(const sl_patch *patch, const double *uv, double k, int32_t t, double *area, bool *counts)
{
    const double *x[3], *u[3];
    for (int i = 0; i < 3; i++) {
        x[i] = patch->xyz + 3 * (int64_t)patch->tri[3 * t + i];
        u[i] = uv + 2 * (int64_t)patch->tri[3 * t + i];
    }
    double d[3] = {0}, e1[3], e2[3];
    for (int i = 0; i < 3; i++) {
        e1[i] = x[1][i] - x[0][i];
        e2[i] = x[2][i] - x[0][i];
        d[0] += e1[i] * e1[i];
        d[1] += e2[i] * e2[i];
        d[2] += e1[i] * e2[i];
    }
    const double longest = fmax(fmax(d[0], d[1]), d[0] + d[1] - 2.0 * d[2]);
    const double twice = sqrt(fmax(0.0, d[0] * d[1] - d[2] * d[2]));
    *area = 0.5 * twice;
    *counts = twice > thin * longest;
    if (!*counts) {
        return 0.0;
    }
    const double a = sqrt(d[0]), b = d[2] / a, c = twice / a;
    double frobenius = 0.0, column[2][2];
    for (int i = 0; i < 2; i++) {
        column[0][i] = k * (u[1][i] - u[0][i]) / a;
        column[1][i] = (k * (u[2][i] - u[0][i]) - column[0][i] * b) / c;
        frobenius += column[0][i] * column[0][i] + column[1][i] * column[1][i];
    }
    const double det = column[0][0] * column[1][1] - column[0][1] * column[1][0];
    return det != 0.0 ? frobenius / (2.0 * det * det) : INFINITY;
}

/* L2 stretch of each facet; corner_mark holds nothing of ours, face_mark the position of a facet in the chart. */
static void measure_stretch(const sl_session *s, const sl_patch *patch, const double *uv, sl_edit_chart *chart,
                            double *area)
{
    const sl_distortion *d = &chart->flat.distortion;
    const double k = d->area_uv > 0.0 && d->area_3d > 0.0 ? sqrt(d->area_3d / d->area_uv) : 1.0;
    for (int32_t i = 0; i < chart->nface; i++) {
        chart->stretch[i] = area[i] = 0.0;
    }
    for (int32_t t = 0; t < patch->nt; t++) {
        const int32_t i = s->face_mark[patch->facet[t]];
        double a;
        bool counts;
        const double q = triangle_stretch(patch, uv, k, t, &a, &counts);
        if (counts) {
            chart->stretch[i] += a * q;
            area[i] += a;
        }
    }
    for (int32_t i = 0; i < chart->nface; i++) {
        chart->stretch[i] = area[i] > 0.0 ? sqrt(chart->stretch[i] / area[i]) : 1.0;
    }
}

/* Border of a patch as vertex pairs. *pair owned by the caller. */
static sl_status border_pairs(const sl_patch *patch, int32_t **pair, int32_t *count)
{
    int32_t n = 0;
    for (int32_t c = 0; c < 3 * patch->nt; c++) {
        n += patch->twin[c] < 0;
    }
    *pair = sl_alloc(n, 2 * sizeof **pair);
    *count = 0;
    for (int32_t c = 0; c < 3 * patch->nt && *pair != NULL; c++) {
        if (patch->twin[c] < 0) {
            (*pair)[2 * *count] = patch->tri[c];
            (*pair)[2 * *count + 1] = patch->tri[sl_corner_next(c)];
            (*count)++;
        }
    }
    return *pair != NULL ? SL_OK : SL_OUT_OF_MEMORY;
}

/* Certificate and distortion; where there is no proof of an embedding, the facets that overlap. */
static sl_status measure_layout(const sl_session *s, const sl_patch *patch, const double *uv, sl_edit_chart *chart,
                                const sl_context *context)
{
    sl_status status = SL_OK;
    int32_t *pair = NULL, pairs = 0;
    uint8_t *red = NULL;
    sl_exact_overlap exact;
    SL_TRY(sl_distortion_measure_indexed(patch->nt, patch->tri, patch->xyz, uv, &chart->flat.distortion));
    if (chart->nface == 1 && (s->mesh->face_flags[chart->face[0]] & SL_FACE_DEGENERATE) != 0) {
        chart->flat.certificate = (sl_certificate){.embedded = true, .first_edge = {-1, -1}};
        return SL_OK; /* no area, nothing to overlap */
    }
    SL_TRY(border_pairs(patch, &pair, &pairs));
    SL_TRY(sl_certify_embedding(uv, patch->nt, patch->tri, pairs, pair, &chart->flat.certificate));
    if (!chart->flat.certificate.embedded) {
        red = sl_calloc(patch->nt, 1);
        SL_TRY(red != NULL ? SL_OK : SL_OUT_OF_MEMORY);
        SL_TRY(sl_overlap_exact(uv, patch->nt, patch->tri, context, red, &exact));
        for (int32_t t = 0; t < patch->nt; t++) {
            chart->red[s->face_mark[patch->facet[t]]] |= red[t];
        }
        for (int32_t i = 0; i < chart->nface; i++) {
            chart->nred += chart->red[i];
        }
    }
cleanup:
    sl_free(pair);
    sl_free(red);
    return status;
}

static sl_status allocate_chart(const sl_session *s, const int32_t *faces, int32_t nfaces, sl_edit_chart **out)
{
    sl_edit_chart *chart = sl_calloc(1, sizeof *chart);
    *out = chart;
    if (chart == NULL) {
        return SL_OUT_OF_MEMORY;
    }
    chart->refs = 1;
    chart->nface = nfaces;
    for (int32_t i = 0; i < nfaces; i++) {
        chart->ncorner += sl_degree(s->mesh, faces[i]);
    }
    chart->face = sl_copy(faces, nfaces, sizeof *faces);
    chart->uv = sl_calloc(chart->ncorner, 2 * sizeof *chart->uv);
    chart->red = sl_calloc(nfaces, 1);
    chart->stretch = sl_calloc(nfaces, sizeof *chart->stretch);
    return chart->face != NULL && chart->uv != NULL && chart->red != NULL && chart->stretch != NULL ? SL_OK
                                                                                                    : SL_OUT_OF_MEMORY;
}

static void scatter_uv(const sl_session *s, const sl_patch *patch, const double *uv, const int32_t *first,
                       sl_edit_chart *chart)
{
    const sl_mesh *mesh = s->mesh;
    for (int32_t c = 0; c < 3 * patch->nt; c++) {
        const int32_t h = patch->corner[c], f = mesh->face[h];
        const int64_t at = (int64_t)first[s->face_mark[f]] + (h - mesh->face_first[f]);
        memcpy(chart->uv + 2 * at, uv + 2 * (int64_t)patch->tri[c], 2 * sizeof *uv);
    }
}

sl_status sl_edit_chart_create(sl_session *s, const sl_patch *patch, const int32_t *faces, int32_t nfaces,
                               const double *uv, bool mirrored, const sl_flatten_result *flat,
                               const sl_context *context, sl_edit_chart **out)
{
    sl_status status = SL_OK;
    sl_edit_chart *chart = NULL;
    int32_t *first = sl_alloc(nfaces, sizeof *first);
    double *area = sl_alloc(nfaces, sizeof *area), *upright = sl_copy(uv, patch->nv, 2 * sizeof *uv);
    *out = NULL;
    SL_TRY(first != NULL && area != NULL && upright != NULL ? SL_OK : SL_OUT_OF_MEMORY);
    SL_TRY(allocate_chart(s, faces, nfaces, &chart));
    chart->flat = *flat;
    for (int32_t i = 0, corners = 0; i < nfaces; corners += sl_degree(s->mesh, faces[i]), i++) {
        first[i] = corners;
        s->face_mark[faces[i]] = i;
    }
    for (int32_t v = 0; v < patch->nv && mirrored; v++) {
        upright[2 * (int64_t)v] = -upright[2 * (int64_t)v];
    }
    scatter_uv(s, patch, uv, first, chart);
    status = measure_layout(s, patch, upright, chart, context);
    if (status == SL_OK) {
        measure_stretch(s, patch, upright, chart, area);
    }
    for (int32_t i = 0; i < nfaces; i++) {
        s->face_mark[faces[i]] = -1;
    }
    SL_TRY(status);
    *out = chart;
    chart = NULL;
cleanup:
    sl_edit_chart_release(chart);
    sl_free(first);
    sl_free(area);
    sl_free(upright);
    return status;
}
