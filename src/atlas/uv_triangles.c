#include "atlas/uv_triangles.h"

#include "atlas/weld.h"
#include "base/memory.h"
#include "mesh/triangulate.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* A polygon of a chart that copies or is copied. */
typedef struct shared_face {
    int32_t source, chart, face, corners;
    const double *corner; /* its UVs in ascending order */
} shared_face;

static int compare_points(const void *a, const void *b)
{
    const double *p = a, *q = b;
    if (p[0] != q[0]) {
        return p[0] < q[0] ? -1 : 1;
    }
    return (p[1] > q[1]) - (p[1] < q[1]);
}

/* By the place on the page alone: source, corners. */
static int compare_places(const shared_face *f, const shared_face *g)
{
    if (f->source != g->source) {
        return f->source < g->source ? -1 : 1;
    }
    if (f->corners != g->corners) {
        return f->corners < g->corners ? -1 : 1;
    }
    for (int32_t k = 0; k < f->corners; k++) {
        const int side = compare_points(f->corner + 2 * (int64_t)k, g->corner + 2 * (int64_t)k);
        if (side != 0) {
            return side;
        }
    }
    return 0;
}

static int compare_faces(const void *a, const void *b)
{
    const shared_face *f = a, *g = b;
    const int side = compare_places(f, g);
    if (side != 0) {
        return side;
    }
    if (f->chart != g->chart) {
        return f->chart < g->chart ? -1 : 1;
    }
    return (f->face > g->face) - (f->face < g->face);
}

/* In a group of one place: each chart's polygons are left out as far as the source has as many. */
static int32_t omit_group(const shared_face *face, int32_t begin, int32_t end, uint8_t *omitted)
{
    int32_t sources = 0, count = 0;
    for (int32_t i = begin; i < end; i++) {
        sources += face[i].chart == face[i].source;
    }
    for (int32_t i = begin, nth = 0; i < end; i++) {
        nth = i > begin && face[i].chart == face[i - 1].chart ? nth + 1 : 0;
        if (face[i].chart != face[i].source && nth < sources) {
            omitted[face[i].face] = 1;
            count++;
        }
    }
    return count;
}

static sl_status omit_shared(const sl_polygons *p, const double *corner_uv, const sl_sharing_table *table,
                             uint8_t *omitted, int32_t *count)
{
    sl_status status = SL_OK;
    int32_t n = 0;
    shared_face *face = sl_alloc(p->nf, sizeof *face);
    double *sorted = sl_copy(corner_uv, p->face_first[p->nf], 2 * sizeof *sorted);
    if (face == NULL || sorted == NULL) {
        SL_TRY(SL_OUT_OF_MEMORY);
    }
    for (int32_t f = 0; f < p->nf; f++) {
        const int32_t chart = table->face_chart[f], first = p->face_first[f], corners = p->face_first[f + 1] - first;
        const int32_t source = table->copy_of[chart] >= 0 ? table->copy_of[chart] : chart;
        qsort(sorted + 2 * (int64_t)first, (size_t)corners, 2 * sizeof *sorted, compare_points);
        face[n++] = (shared_face){source, chart, f, corners, sorted + 2 * (int64_t)first};
    }
    qsort(face, (size_t)n, sizeof *face, compare_faces);
    *count = 0;
    for (int32_t begin = 0, end; begin < n; begin = end) {
        for (end = begin + 1; end < n && compare_places(&face[begin], &face[end]) == 0; end++) {
        }
        *count += omit_group(face, begin, end, omitted);
    }
cleanup:
    sl_free(face);
    sl_free(sorted);
    return status;
}

static sl_status require_finite(const sl_polygons *p, const double *corner_uv, sl_diag *diag)
{
    for (int32_t f = 0; f < p->nf; f++) {
        for (int64_t c = 2 * (int64_t)p->face_first[f]; c < 2 * (int64_t)p->face_first[f + 1]; c++) {
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

/* One number a distinct UV, and the UVs by number. */
static sl_status weld_corners(const sl_polygons *p, const double *corner_uv, int32_t *number, sl_uv_triangles *out)
{
    const int64_t corners = p->face_first[p->nf];
    const sl_status status = sl_weld_points(corners, 2, corner_uv, number, &out->nv);
    if (status != SL_OK) {
        return status;
    }
    out->uv = sl_alloc(out->nv, 2 * sizeof *out->uv);
    if (out->uv == NULL) {
        return SL_OUT_OF_MEMORY;
    }
    for (int64_t c = 0; c < corners; c++) {
        memcpy(out->uv + 2 * (int64_t)number[c], corner_uv + 2 * c, 2 * sizeof *out->uv);
    }
    return SL_OK;
}

static void choose_window(sl_uv_triangles *out)
{
    double low[2] = {0.0, 0.0}, high[2] = {1.0, 1.0};
    bool inside = true;
    for (int32_t v = 0; v < out->nv; v++) {
        for (int k = 0; k < 2; k++) {
            const double u = out->uv[2 * (int64_t)v + k];
            inside = inside && u >= 0.0 && u <= 1.0;
            low[k] = v == 0 ? u : fmin(low[k], u);
            high[k] = v == 0 ? u : fmax(high[k], u);
        }
    }
    const double half = fmax(0.5 * high[0] - 0.5 * low[0], 0.5 * high[1] - 0.5 * low[1]);
    out->low[0] = inside ? 0.0 : low[0];
    out->low[1] = inside ? 0.0 : low[1];
    out->side = inside || half == 0.0 ? 1.0 : 2.0 * half; /* may be infinite: the window is mapped by halves */
}

void sl_uv_triangles_window(const sl_uv_triangles *t, double *window_uv)
{
    double half = 0.5 * t->side;
    for (int64_t i = 0; i < 2 * (int64_t)t->nv && isinf(half); i++) { /* once, if at all */
        half = 0.0;
        for (int64_t j = 0; j < 2 * (int64_t)t->nv; j++) {
            half = fmax(half, 0.5 * t->uv[j] - 0.5 * t->low[j % 2]);
        }
    }
    const bool whole = t->low[0] == 0.0 && t->low[1] == 0.0 && t->side == 1.0; /* the very numbers, not nearly */
    for (int64_t i = 0; i < 2 * (int64_t)t->nv; i++) {
        window_uv[i] = whole ? t->uv[i] : (0.5 * t->uv[i] - 0.5 * t->low[i % 2]) / half;
    }
}

sl_status sl_uv_triangles_init(const sl_polygons *p, const double *corner_uv, const sl_sharing_table *table,
                               sl_uv_triangles *out, sl_diag *diag)
{
    SL_ASSERT(table == NULL || table->nf == p->nf);
    *out = (sl_uv_triangles){0};
    sl_status status = SL_OK;
    sl_mesh *mesh = NULL;
    sl_triangulation *cut = NULL;
    uint8_t *omitted = NULL;
    int32_t *number = NULL;
    SL_TRY(require_finite(p, corner_uv, diag));
    SL_TRY(sl_mesh_build(p, &mesh, NULL, diag));
    SL_TRY(sl_triangulation_create(mesh, &cut));
    omitted = sl_calloc(p->nf, sizeof *omitted);
    number = sl_alloc(p->face_first[p->nf], sizeof *number);
    out->tri = sl_alloc(cut->nt, 3 * sizeof *out->tri);
    out->face = sl_alloc(cut->nt, sizeof *out->face);
    if (omitted == NULL || number == NULL || out->tri == NULL || out->face == NULL) {
        SL_TRY(SL_OUT_OF_MEMORY);
    }
    if (table != NULL) {
        SL_TRY(omit_shared(p, corner_uv, table, omitted, &out->shared_faces));
    }
    SL_TRY(weld_corners(p, corner_uv, number, out));
    for (int32_t f = 0; f < p->nf; f++) {
        for (int32_t t = cut->first[f]; t < cut->first[f + 1] && !omitted[f]; t++) {
            for (int k = 0; k < 3; k++) {
                out->tri[3 * (int64_t)out->nt + k] = number[sl_input_corner(mesh, cut->corner[3 * (int64_t)t + k])];
            }
            out->face[out->nt++] = f;
        }
    }
    choose_window(out);
cleanup:
    sl_mesh_free(mesh);
    sl_triangulation_free(cut);
    sl_free(omitted);
    sl_free(number);
    return status;
}

void sl_uv_triangles_clear(sl_uv_triangles *t)
{
    sl_free(t->uv);
    sl_free(t->tri);
    sl_free(t->face);
    *t = (sl_uv_triangles){0};
}
