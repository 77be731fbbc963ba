#include "atlas/repack.h"

#include "atlas/atlas.h"
#include "atlas/repack_internal.h"
#include "atlas/uv_triangles.h"
#include "base/memory.h"
#include "geom/vec3.h"
#include "meshio/meshfile.h"
#include "overlap/exact.h"
#include "pack/clearance.h"

#include <math.h>
#include <string.h>

static const double rounding = 1e-6; /* texels: what a distance may lose when UVs are rounded */

sl_repack_def sl_repack_default(void)
{
    return (sl_repack_def){.pack = sl_pack_default(), .up = SL_UP_AS_IS};
}

/* Everything at hand while charts are packed. */
typedef struct repacking {
    sl_atlas_view view;
    sl_uv_charts charts;
    int32_t count;           /* charts that are no copies */
    int32_t *slot;           /* a chart: its number among those, or that of what it copies */
    sl_pack_chart *chart;    /* count */
    sl_placement *placement; /* count */
    double width, height;    /* of a page [texels] */
} repacking;

static void repacking_clear(repacking *r)
{
    sl_mesh_free(r->view.mesh);
    sl_triangulation_free(r->view.triangulation);
    sl_free(r->view.face_chart);
    sl_uv_charts_clear(&r->charts);
    sl_free(r->slot);
    sl_free(r->chart);
    sl_free(r->placement);
}

static sl_status require_finite(const sl_polygons *p, const double *corner_uv, sl_diag *diag)
{
    for (int32_t f = 0; f < p->nf; f++) {
        for (int64_t i = 2 * (int64_t)p->face_first[f]; i < 2 * (int64_t)p->face_first[f + 1]; i++) {
            if (!isfinite(corner_uv[i])) {
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

static sl_status find_charts(repacking *r, const double *corner_uv, const sl_repack_def *def, sl_diag *diag)
{
    sl_status status = SL_OK;
    SL_TRY(sl_mesh_build(r->view.polygons, &r->view.mesh, NULL, diag));
    SL_TRY(sl_triangulation_create(r->view.mesh, &r->view.triangulation));
    SL_TRY(sl_atlas_view_charts(&r->view, corner_uv));
    SL_TRY(sl_uv_charts_init(&r->view, corner_uv, &r->charts));
    if (def->up != SL_UP_AS_IS) {
        sl_uv_charts_stand_up(&r->view, (int32_t)def->up - (int32_t)SL_UP_X, &r->charts);
    }
    r->slot = sl_alloc(r->charts.count, sizeof *r->slot);
    r->chart = sl_alloc(r->charts.count, sizeof *r->chart);
    r->placement = sl_calloc(r->charts.count, sizeof *r->placement);
    SL_TRY(r->slot != NULL && r->chart != NULL && r->placement != NULL ? SL_OK : SL_OUT_OF_MEMORY);
    for (int32_t c = 0; c < r->charts.count; c++) { /* a chart's source comes before it */
        const int32_t source = r->charts.copy_of[c];
        r->slot[c] = source >= 0 ? r->slot[source] : r->count;
        if (source < 0) {
            r->chart[r->count++] = r->charts.chart[c];
        }
    }
cleanup:
    return status;
}

/* Length in the plane a unit of length in space: the root of the areas' ratio. Copies take part as they come. */
static double uv_a_unit(const repacking *r)
{
    const sl_triangulation *t = r->view.triangulation;
    const sl_mesh *m = r->view.mesh;
    double flat = 0.0, space = 0.0;
    for (int32_t k = 0; k < t->nt; k++) {
        const double *p[3];
        double a[3], b[3], n[3];
        for (int i = 0; i < 3; i++) {
            p[i] = m->xyz + 3 * (int64_t)m->origin[t->corner[3 * (int64_t)k + i]];
        }
        sl_vec3_sub(p[1], p[0], a);
        sl_vec3_sub(p[2], p[0], b);
        sl_vec3_cross(a, b, n);
        space += 0.5 * sl_vec3_norm(n) / (m->scale * m->scale);
    }
    for (int32_t c = 0; c < r->charts.count; c++) {
        const sl_pack_chart *chart = &r->charts.chart[c];
        for (int32_t k = 0; k < chart->nt; k++) {
            const double *a = chart->uv + 2 * (int64_t)chart->tri[3 * (int64_t)k];
            const double *b = chart->uv + 2 * (int64_t)chart->tri[3 * (int64_t)k + 1];
            const double *d = chart->uv + 2 * (int64_t)chart->tri[3 * (int64_t)k + 2];
            flat += 0.5 * fabs((b[0] - a[0]) * (d[1] - a[1]) - (d[0] - a[0]) * (b[1] - a[1]));
        }
    }
    return space > 0.0 ? sqrt(flat / space) : 0.0;
}

/* Where a point of a chart went, in pages. */
static void move_point(const repacking *r, const sl_repacked *out, const sl_placement *at, const double *uv,
                       double to[2])
{
    const double c = cos(at->angle), s = sin(at->angle), scale = out->pack.scale;
    to[0] = sl_uv_quantise(scale * (c * uv[0] - s * uv[1]) + at->offset[0]);
    to[1] = sl_uv_quantise((scale * (s * uv[0] + c * uv[1]) + at->offset[1]) * (r->width / r->height));
}

static sl_status place_corners(const repacking *r, sl_repacked *out)
{
    const sl_polygons *p = r->view.polygons;
    out->corner_uv = sl_alloc(p->face_first[p->nf], 2 * sizeof *out->corner_uv);
    out->page = sl_alloc(r->charts.count, sizeof *out->page);
    if (out->corner_uv == NULL || out->page == NULL) {
        return SL_OUT_OF_MEMORY;
    }
    for (int32_t c = 0; c < r->charts.count; c++) {
        const sl_placement *at = &r->placement[r->slot[c]];
        out->page[c] = at->page;
        for (int32_t i = r->charts.first[c]; i < r->charts.first[c + 1]; i++) {
            double *to = out->corner_uv + 2 * (int64_t)r->charts.corner[i];
            move_point(r, out, at, r->charts.uv + 2 * (int64_t)i, to);
            to[0] = sl_uv_quantise(to[0] + sl_page_tile(at->page, 0));
            to[1] = sl_uv_quantise(to[1] + sl_page_tile(at->page, 1));
        }
    }
    return SL_OK;
}

/* The table of what was found, for the output's own measures and its sidecar. */
static sl_status hand_out_table(repacking *r, sl_repacked *out)
{
    const int32_t nf = r->view.polygons->nf;
    out->table = (sl_sharing_table){nf, r->charts.count, sl_copy(r->view.face_chart, nf, sizeof *out->table.face_chart),
                                    sl_copy(r->charts.copy_of, r->charts.count, sizeof *out->table.copy_of)};
    out->charts = r->charts.count;
    out->copies = r->charts.count - r->count;
    return out->table.face_chart != NULL && out->table.copy_of != NULL ? SL_OK : SL_OUT_OF_MEMORY;
}

/* The charts' UVs become those written. */
static void take_written(repacking *r, const sl_repacked *out)
{
    for (int64_t i = 0; i < r->charts.first[r->charts.count]; i++) {
        memcpy(r->charts.uv + 2 * i, out->corner_uv + 2 * (int64_t)r->charts.corner[i], 2 * sizeof *r->charts.uv);
    }
}

/* The least distance between charts on one page. Changes the charts' UVs into texels. */
static sl_status check_margins(repacking *r, double margin, sl_repacked *out)
{
    sl_status status = SL_OK;
    sl_pack_chart *page = sl_alloc(r->count, sizeof *page);
    SL_TRY(page != NULL ? SL_OK : SL_OUT_OF_MEMORY);
    for (int64_t i = 0; i < r->charts.first[r->charts.count]; i++) {
        r->charts.uv[2 * i] *= r->width;
        r->charts.uv[2 * i + 1] *= r->height;
    }
    out->clearance = margin;
    for (int32_t p = 0; p < out->pack.pages && margin > 0.0; p++) {
        int32_t n = 0;
        double least;
        for (int32_t k = 0; k < r->count; k++) {
            if (r->placement[k].page == p) {
                page[n++] = r->chart[k];
            }
        }
        SL_TRY(sl_pack_clearance(n, page, margin, &least));
        out->clearance = fmin(out->clearance, least);
    }
cleanup:
    sl_free(page);
    return status;
}

/* Triangles that overlap, over all charts and chart by chart. */
static sl_status check_overlaps(const repacking *r, const sl_context *context, sl_repacked *out, sl_diag *diag)
{
    sl_status status = SL_OK;
    sl_uv_triangles all = {0};
    sl_exact_overlap exact;
    uint8_t *red = sl_alloc(r->view.triangulation->nt, sizeof *red);
    SL_TRY(red != NULL ? SL_OK : SL_OUT_OF_MEMORY);
    SL_TRY(sl_uv_triangles_init(r->view.polygons, out->corner_uv, &out->table, &all, diag));
    SL_TRY(sl_overlap_exact(all.uv, all.nt, all.tri, context, red, &exact));
    out->red = exact.red;
    for (int32_t k = 0; k < r->count && out->red > 0; k++) {
        SL_TRY(sl_overlap_exact(r->chart[k].uv, r->chart[k].nt, r->chart[k].tri, context, red, &exact));
        out->red_inside += exact.red;
    }
cleanup:
    sl_uv_triangles_clear(&all);
    sl_free(red);
    return status;
}

sl_status sl_repack(const sl_polygons *polygons, const double *corner_uv, const sl_sharing_table *table,
                    const sl_repack_def *def, const sl_context *context, sl_repacked *out, sl_diag *diag)
{
    SL_ASSERT(table == NULL || table->nf == polygons->nf);
    repacking r = {.view = {.polygons = polygons, .table = table},
                   .width = def->pack.resolution,
                   .height = def->pack.height > 0 ? def->pack.height : def->pack.resolution};
    sl_pack_def pack = def->pack;
    sl_status status = SL_OK;
    *out = (sl_repacked){0};
    SL_TRY(require_finite(polygons, corner_uv, diag));
    SL_TRY(find_charts(&r, corner_uv, def, diag));
    const double unit = uv_a_unit(&r);
    pack.density = unit > 0.0 ? def->pack.density / unit : 0.0;
    status = sl_pack(r.count, r.chart, &pack, context, r.placement, &out->pack);
    if (status == SL_INFEASIBLE) {
        sl_diag_reason(diag, "%d charts and their margins do not fit into %d pages of %g x %g texels%s", r.count,
                       pack.pages > 0 ? pack.pages : 1, r.width, r.height,
                       pack.density > 0.0 ? " at that density" : "");
        sl_diag_hint(diag, "raise --resolution or --pages, or lower --margin or --density");
    }
    SL_TRY(status);
    out->texels_a_unit = out->pack.scale * r.width * unit;
    SL_TRY(place_corners(&r, out));
    SL_TRY(hand_out_table(&r, out));
    take_written(&r, out);
    SL_TRY(check_overlaps(&r, context, out, diag));
    SL_TRY(check_margins(&r, def->pack.margin, out));
    out->passed = out->red == out->red_inside && out->clearance >= def->pack.margin - rounding;
cleanup:
    repacking_clear(&r);
    return status;
}

void sl_repacked_clear(sl_repacked *repacked)
{
    sl_free(repacked->corner_uv);
    sl_free(repacked->page);
    sl_sharing_table_clear(&repacked->table);
    *repacked = (sl_repacked){0};
}
