/* Charts onto pages, and the UVs that come of it as they are written. */
#include "atlas/atlas_internal.h"

#include "base/memory.h"
#include "geom/vec3.h"
#include "meshio/meshfile.h"

#include <math.h>
#include <string.h>

enum { PLACING_RETRIES = 6 };
static const double PAGE_SHRINKAGE = 1.0 - 0x1p-12; /* half a texel of 2048: the margins lose a 4096th */

/* Charts as the packer wants them, copies left out: UVs by corner, triangles by position in the chart. */
typedef struct pack_input {
    int32_t count;
    sl_pack_chart *chart; /* count, into the arrays below */
    double *uv;           /* 2 nh */
    int32_t *tri;         /* 3 nt */
} pack_input;

static void pack_input_clear(pack_input *input)
{
    sl_free(input->chart);
    sl_free(input->uv);
    sl_free(input->tri);
}

static sl_status pack_input_init(const sl_atlas *atlas, pack_input *input)
{
    const sl_mesh *mesh = atlas->mesh;
    const sl_segmentation *seg = atlas->segmentation;
    input->chart = sl_calloc(seg->nchart, sizeof *input->chart);
    input->uv = sl_alloc(mesh->nh, 2 * sizeof *input->uv);
    input->tri = sl_alloc(atlas->triangulation->nt, 3 * sizeof *input->tri);
    if (input->chart == NULL || input->uv == NULL || input->tri == NULL) {
        return SL_OUT_OF_MEMORY;
    }
    int64_t corners = 0, triangles = 0;
    for (int32_t c = 0; c < seg->nchart; c++) {
        if (seg->chart[c].copy_of >= 0) {
            continue;
        }
        sl_pack_chart *chart = &input->chart[input->count++];
        chart->uv = input->uv + 2 * corners;
        chart->tri = input->tri + 3 * triangles;
        for (int32_t i = seg->chart[c].first; i < seg->chart[c].first + seg->chart[c].count; i++) {
            const int32_t f = seg->face[i], first = mesh->face_first[f], degree = sl_degree(mesh, f);
            memcpy(input->uv + 2 * corners, seg->corner_uv + 2 * (int64_t)first,
                   2 * (size_t)degree * sizeof *input->uv);
            for (int32_t k = 3 * atlas->triangulation->first[f]; k < 3 * atlas->triangulation->first[f + 1]; k++) {
                input->tri[3 * triangles + (k - 3 * atlas->triangulation->first[f])] =
                    chart->nv + atlas->triangulation->corner[k] - first;
            }
            triangles += atlas->triangulation->first[f + 1] - atlas->triangulation->first[f];
            chart->nt += atlas->triangulation->first[f + 1] - atlas->triangulation->first[f];
            chart->nv += degree;
            corners += degree;
        }
    }
    return SL_OK;
}

static double page_height(const sl_pack_def *pack)
{
    return pack->height > 0 ? pack->height : pack->resolution;
}

/* Length in the charts' frames a unit of length in space, in the mean over what is no copy. */
static double uv_a_unit(const sl_atlas *atlas)
{
    const sl_mesh *m = atlas->mesh;
    const sl_segmentation *seg = atlas->segmentation;
    double flat = 0.0, space = 0.0;
    for (int32_t t = 0; t < atlas->triangulation->nt; t++) {
        const int32_t *corner = atlas->triangulation->corner + 3 * (int64_t)t;
        const double *p[3], *q[3];
        double a[3], b[3], n[3];
        if (seg->chart[seg->face_chart[m->face[corner[0]]]].copy_of >= 0) {
            continue;
        }
        for (int i = 0; i < 3; i++) {
            p[i] = m->xyz + 3 * (int64_t)m->origin[corner[i]];
            q[i] = seg->corner_uv + 2 * (int64_t)corner[i];
        }
        sl_vec3_sub(p[1], p[0], a);
        sl_vec3_sub(p[2], p[0], b);
        sl_vec3_cross(a, b, n);
        space += 0.5 * sl_vec3_norm(n) / (m->scale * m->scale);
        flat += 0.5 * fabs((q[1][0] - q[0][0]) * (q[2][1] - q[0][1]) - (q[2][0] - q[0][0]) * (q[1][1] - q[0][1]));
    }
    return space > 0.0 ? sqrt(flat / space) : 0.0;
}

/* The charts' UVs on their pages: in the short decimals that files hold, or as they come (more digits in the file). */
static void place_corners(sl_atlas *atlas, const sl_pack_def *pack, bool quantise)
{
    const sl_mesh *mesh = atlas->mesh;
    const sl_segmentation *seg = atlas->segmentation;
    const double widths_a_height = pack->resolution / page_height(pack);
    for (int32_t h = 0; h < mesh->nh; h++) {
        const sl_placement *p = &atlas->placement[seg->face_chart[mesh->face[h]]];
        const double *uv = seg->corner_uv + 2 * (int64_t)h;
        const double c = cos(p->angle), s = sin(p->angle);
        double *out = atlas->corner_uv + 2 * (int64_t)h;
        out[0] = atlas->pack.scale * (c * uv[0] - s * uv[1]) + p->offset[0];
        out[1] = (atlas->pack.scale * (s * uv[0] + c * uv[1]) + p->offset[1]) * widths_a_height;
        for (int k = 0; k < 2; k++) {
            out[k] = (quantise ? sl_uv_quantise(out[k]) : out[k]) + sl_page_tile(p->page, k);
            out[k] = quantise ? sl_uv_quantise(out[k]) : out[k];
        }
        memcpy(atlas->input_corner_uv + 2 * (int64_t)sl_input_corner(mesh, h), out, 2 * sizeof *out);
    }
}

/* From the packer's list to one placement a chart: a copy lies where its source lies. */
static void spread_placements(const sl_segmentation *seg, const sl_placement *packed, sl_placement *placement)
{
    int32_t n = 0;
    for (int32_t c = 0; c < seg->nchart; c++) {
        if (seg->chart[c].copy_of < 0) {
            placement[c] = packed[n++];
        }
    }
    for (int32_t c = 0; c < seg->nchart; c++) {
        placement[c] = placement[sl_chart_shown(seg, c)];
    }
}

static void explain_no_room(const sl_atlas *atlas, const sl_pack_def *pack, sl_diag *diag)
{
    sl_diag_reason(diag, "%d charts and their margins do not fit into %d page%s of %d x %g texels%s",
                   atlas->segmentation->nchart, pack->pages > 0 ? pack->pages : 1, pack->pages > 1 ? "s" : "",
                   pack->resolution, page_height(pack), pack->density > 0.0 ? " at that density" : "");
    sl_diag_hint(diag, "raise --resolution or --pages, or lower --margin or --density");
}

sl_status sl_atlas_pack(sl_atlas *atlas, const sl_atlas_def *def, const sl_context *context, sl_diag *diag)
{
    const sl_mesh *mesh = atlas->mesh;
    const sl_segmentation *seg = atlas->segmentation;
    const double unit = uv_a_unit(atlas);
    sl_pack_def pack = def->pack;
    pack_input input = {0};
    sl_status status = SL_OK;
    sl_placement *packed = sl_calloc(seg->nchart, sizeof *packed);
    atlas->placement = sl_calloc(seg->nchart, sizeof *atlas->placement);
    atlas->corner_uv = sl_alloc(mesh->nh, 2 * sizeof *atlas->corner_uv);
    atlas->input_corner_uv = sl_alloc(mesh->nh, 2 * sizeof *atlas->input_corner_uv);
    if (packed == NULL || atlas->placement == NULL || atlas->corner_uv == NULL || atlas->input_corner_uv == NULL) {
        status = SL_OUT_OF_MEMORY;
        goto cleanup;
    }
    SL_TRY(pack_input_init(atlas, &input));
    pack.density = unit > 0.0 ? def->pack.density / unit : 0.0;
    status = sl_pack(input.count, input.chart, &pack, context, packed, &atlas->pack);
    if (status == SL_INFEASIBLE) {
        explain_no_room(atlas, &def->pack, diag);
    }
    SL_TRY(status);
    spread_placements(seg, packed, atlas->placement);
cleanup:
    sl_free(packed);
    pack_input_clear(&input);
    return status;
}

static bool only_texels_meet(const sl_atlas_check *check)
{
    return !check->passed && check->flipped == 0 && check->degenerate == 0 && check->uncertified_charts == 0 &&
           check->unlike == 0 && check->proven;
}

/* Writes the UVs and judges them; in the rare cases that need it, with all digits (triangles smaller than the quantum)
 * or on a page a little smaller (slivers that only the rounding of a texel count turns over, seen at its centres). */
sl_status sl_atlas_settle(sl_atlas *atlas, const sl_atlas_def *def, const sl_context *context)
{
    sl_status status = SL_OK;
    bool quantise = true;
    for (int32_t attempt = 0; attempt <= PLACING_RETRIES; attempt++) {
        place_corners(atlas, &def->pack, quantise);
        SL_TRY(sl_atlas_clear_borders(atlas, context));
        SL_TRY(sl_atlas_verify(atlas, def, context));
        if (atlas->check.passed || (!quantise && !only_texels_meet(&atlas->check))) {
            break;
        }
        if (!only_texels_meet(&atlas->check)) {
            quantise = false;
            continue;
        }
        atlas->pack.scale *= PAGE_SHRINKAGE;
        atlas->pack.fill *= PAGE_SHRINKAGE * PAGE_SHRINKAGE;
        for (int32_t c = 0; c < atlas->segmentation->nchart; c++) {
            atlas->placement[c].offset[0] *= PAGE_SHRINKAGE;
            atlas->placement[c].offset[1] *= PAGE_SHRINKAGE;
        }
    }
    atlas->texels_a_unit = atlas->pack.scale * def->pack.resolution * uv_a_unit(atlas);
cleanup:
    return status;
}
