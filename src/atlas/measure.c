/* The columns by which atlases are compared. */
#include "atlas/measure_internal.h"

#include "base/memory.h"
#include "geom/vec3.h"

#include <math.h>

static void view_clear(sl_atlas_view *view)
{
    sl_mesh_free(view->mesh);
    sl_triangulation_free(view->triangulation);
    sl_free(view->xyz);
    sl_free(view->uv);
    sl_free(view->face_chart);
    sl_free(view->chart_first);
}

static sl_status measure_charts(const sl_atlas_view *view, sl_atlas_measure *out)
{
    double sum = 0.0;
    int32_t counted = 0;
    out->worst_chart = -1;
    for (int32_t c = 0; c < view->counted; c++) {
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

static void count_isolated(const sl_atlas_view *view, sl_atlas_measure *out)
{
    for (int32_t f = 0; f < view->mesh->nf; f++) {
        const uint8_t flags = view->mesh->face_flags[f];
        out->degenerate_facets += (flags & SL_FACE_DEGENERATE) != 0;
        out->duplicate_facets += (flags & SL_FACE_DUPLICATE) != 0;
    }
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

/* Surface area by the same triangles that everything else is measured on; a facet that is there twice counts once. */
static double surface_area(const sl_atlas_view *view)
{
    const sl_mesh *m = view->mesh;
    double area = 0.0;
    for (int32_t t = 0; t < view->triangulation->nt; t++) {
        const int32_t *corner = view->triangulation->corner + 3 * (int64_t)t;
        const double *p[3];
        double a[3], b[3], n[3];
        if (sl_view_isolated(view, m->face[corner[0]])) {
            continue;
        }
        for (int k = 0; k < 3; k++) {
            p[k] = m->xyz + 3 * (int64_t)m->origin[corner[k]];
        }
        sl_vec3_sub(p[1], p[0], a);
        sl_vec3_sub(p[2], p[0], b);
        sl_vec3_cross(a, b, n);
        area += 0.5 * sl_vec3_norm(n);
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
    sl_atlas_view view = {.polygons = polygons, .table = table};
    sl_atlas_measure m = {.resolution = resolution};
    sl_status status = SL_OK;
    SL_TRY(check_uvs(polygons, corner_uv, diag));
    SL_TRY(sl_mesh_build(polygons, &view.mesh, NULL, diag));
    SL_TRY(sl_triangulation_create(view.mesh, &view.triangulation));
    SL_TRY(sl_atlas_view_charts(&view, corner_uv));
    SL_TRY(sl_atlas_view_triangles(&view, corner_uv));
    const double area = surface_area(&view);
    m.triangles = view.nt;
    m.charts = view.counted;
    count_isolated(&view, &m);
    m.seam_length = area > 0.0 ? view.seam_length / sqrt(area) : 0.0;
    m.seam_diagonal = view.seam_length > 0.0 ? view.seam_length / sl_mesh_diagonal(view.mesh) : 0.0;
    SL_TRY(sl_distortion_measure(view.nt, view.xyz, view.uv, 1, &m.global));
    SL_TRY(measure_charts(&view, &m));
    SL_TRY(sl_atlas_view_texels(&view, context, &m));
    *out = m;
cleanup:
    view_clear(&view);
    return status;
}
