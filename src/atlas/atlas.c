#include "atlas/atlas.h"

#include "atlas/atlas_internal.h"
#include "base/memory.h"
#include "meshio/meshfile.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

enum { PLACING_RETRIES = 6 };
static const double PAGE_SHRINKAGE = 1.0 - 0x1p-12; /* half a texel of 2048: the margins lose a 4096th */

sl_atlas_def sl_atlas_default(void)
{
    return (sl_atlas_def){
        .segment = sl_segment_default(),
        .pack = sl_pack_default(),
        .optimize = sl_optimize_default(),
        .seams = SL_SEAMS_AUTOMATIC,
        .check_resolution = 4096,
    };
}

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

/* The charts' UVs on the page: in the short decimals that files hold, or as they come (more digits in the file). */
static void place_corners(sl_atlas *atlas, bool quantise)
{
    const sl_mesh *mesh = atlas->mesh;
    const sl_segmentation *seg = atlas->segmentation;
    for (int32_t h = 0; h < mesh->nh; h++) {
        const sl_placement *p = &atlas->placement[seg->face_chart[mesh->face[h]]];
        const double *uv = seg->corner_uv + 2 * (int64_t)h;
        const double c = cos(p->angle), s = sin(p->angle);
        double *out = atlas->corner_uv + 2 * (int64_t)h;
        out[0] = atlas->pack.scale * (c * uv[0] - s * uv[1]) + p->offset[0];
        out[1] = atlas->pack.scale * (s * uv[0] + c * uv[1]) + p->offset[1];
        for (int k = 0; k < 2 && quantise; k++) {
            out[k] = sl_uv_quantise(out[k]);
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

/* Places the charts on the page. */
static sl_status pack_charts(sl_atlas *atlas, const sl_atlas_def *def, const sl_context *context)
{
    const sl_mesh *mesh = atlas->mesh;
    const sl_segmentation *seg = atlas->segmentation;
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
    SL_TRY(sl_pack(input.count, input.chart, &def->pack, context, packed, &atlas->pack));
    spread_placements(seg, packed, atlas->placement);
cleanup:
    sl_free(packed);
    pack_input_clear(&input);
    return status;
}

static sl_warning *push_warning(sl_atlas *atlas, int32_t chart)
{
    sl_warning *grown = sl_realloc(atlas->warning, (int64_t)atlas->nwarning + 1, sizeof *grown);
    if (grown == NULL) {
        return NULL;
    }
    atlas->warning = grown;
    grown[atlas->nwarning].chart = chart;
    return &grown[atlas->nwarning++];
}

/* Facets that stand alone are exempt from the bound, bent ones may exceed it: the worst is named. */
static sl_status warn_of_bent_facets(sl_atlas *atlas, const sl_atlas_def *def)
{
    const sl_segmentation *seg = atlas->segmentation;
    const double bound = def->segment.flatten.max_stretch;
    int32_t worst = -1, count = 0;
    for (int32_t c = 0; c < seg->nchart; c++) {
        const double l2 = seg->chart[c].flat.distortion.l2;
        if (seg->chart[c].flat.verdict == SL_CHART_VALID && l2 > bound) {
            count++;
            worst = worst < 0 || l2 > seg->chart[worst].flat.distortion.l2 ? c : worst;
        }
    }
    sl_warning *w = count > 0 ? push_warning(atlas, worst) : NULL;
    if (w == NULL) {
        return count > 0 ? SL_OUT_OF_MEMORY : SL_OK;
    }
    snprintf(w->text, sizeof w->text,
             "%d facets stand alone and are stretched above the bound %.4g, most of all facet %d (chart %d, L2 %.4g)",
             count, bound, seg->face[seg->chart[worst].first], worst, seg->chart[worst].flat.distortion.l2);
    return SL_OK;
}

/* Symmetries that were asked for and not found, or found and not kept. */
static sl_status warn_of_symmetry(sl_atlas *atlas, const sl_atlas_def *def)
{
    const sl_sharing_info *info = &atlas->segmentation->sharing;
    const bool automatic = def->seams == SL_SEAMS_AUTOMATIC;
    if (automatic && def->segment.symmetry == SL_SYMMETRY_USE_EXACT && info->axes == 0 && info->components == 0) {
        sl_warning *w = push_warning(atlas, -1);
        if (w == NULL) {
            return SL_OUT_OF_MEMORY;
        }
        snprintf(w->text, sizeof w->text, "no exact symmetry was found to share texture by");
    }
    if (info->near_axes > 0) {
        sl_warning *w = push_warning(atlas, -1);
        if (w == NULL) {
            return SL_OUT_OF_MEMORY;
        }
        snprintf(
            w->text, sizeof w->text,
            "copies across %d axes are approximate: a near symmetry, with corners up to %.3g of the diagonal off (%g "
            "allowed)",
            info->near_axes, info->deviation, sl_symmetry_default().near);
    }
    if (info->planes > 0) {
        sl_warning *w = push_warning(atlas, -1);
        if (w == NULL) {
            return SL_OUT_OF_MEMORY;
        }
        snprintf(w->text, sizeof w->text,
                 "%d components are cut at the plane of a near symmetry (mean misfit %.3g of the diagonal); their "
                 "facets do not correspond, so nothing is shared there",
                 info->planes, info->misfit);
    }
    if (info->refused > 0) {
        sl_warning *w = push_warning(atlas, -1);
        if (w == NULL) {
            return SL_OUT_OF_MEMORY;
        }
        snprintf(w->text, sizeof w->text, "%d charts could not copy their mirror image and are laid flat themselves",
                 info->refused);
    }
    return SL_OK;
}

/* Pieces that the search could not cut, or not within its targets. */
static sl_status warn_of_search(sl_atlas *atlas, const sl_atlas_def *def)
{
    const sl_optimize_info info = atlas->optimized;
    if (info.failed > 0) {
        sl_warning *w = push_warning(atlas, -1);
        if (w == NULL) {
            return SL_OUT_OF_MEMORY;
        }
        snprintf(w->text, sizeof w->text,
                 "the search found no valid charts for %d of %d pieces: they are cut by recursion", info.failed,
                 info.pieces);
    }
    if (info.missed > 0) {
        sl_warning *w = push_warning(atlas, -1);
        if (w == NULL) {
            return SL_OUT_OF_MEMORY;
        }
        snprintf(w->text, sizeof w->text, "%d of %d pieces are not within the targets (L2 %.4g, mean s1/s2 %.4g)",
                 info.missed, info.pieces, def->optimize.target_stretch, def->optimize.target_angle);
    }
    return SL_OK;
}

/* A chart that is not what was asked for is named. */
static sl_status warn_of_charts(sl_atlas *atlas, const sl_atlas_def *def)
{
    const sl_segmentation *seg = atlas->segmentation;
    for (int32_t c = 0; c < seg->nchart; c++) {
        const sl_chart *chart = &seg->chart[c];
        if (chart->flat.verdict == SL_CHART_VALID) {
            continue;
        }
        sl_warning *w = push_warning(atlas, c);
        if (w == NULL) {
            return SL_OUT_OF_MEMORY;
        }
        if (chart->flat.verdict == SL_CHART_STRETCHED) {
            snprintf(w->text, sizeof w->text, "chart %d (%d facets, first %d): stretch L2 %.4g is above the bound %.4g",
                     c, chart->count, seg->face[chart->first], chart->flat.distortion.l2,
                     def->segment.flatten.max_stretch);
        } else if (chart->flat.verdict == SL_CHART_SHEARED) {
            snprintf(w->text, sizeof w->text, "chart %d (%d facets, first %d): mean s1/s2 %.4g is above the bound %.4g",
                     c, chart->count, seg->face[chart->first], chart->flat.distortion.angle_mean,
                     def->segment.flatten.max_angle);
        } else {
            snprintf(w->text, sizeof w->text, "chart %d (%d facets, first %d): %s", c, chart->count,
                     seg->face[chart->first], sl_flatten_verdict_name(chart->flat.verdict));
        }
    }
    if (atlas->repair.degenerate_faces > 0) {
        sl_warning *w = push_warning(atlas, -1);
        if (w == NULL) {
            return SL_OUT_OF_MEMORY;
        }
        snprintf(w->text, sizeof w->text, "%d facets without area get one texel each", atlas->repair.degenerate_faces);
    }
    sl_status status = warn_of_symmetry(atlas, def);
    status = status == SL_OK ? warn_of_search(atlas, def) : status;
    return status == SL_OK ? warn_of_bent_facets(atlas, def) : status;
}

/* Charts of the user's own seams must be disks: nothing else can be flattened. */
static sl_status require_disks(const sl_atlas *atlas, sl_diag *diag)
{
    const sl_segmentation *seg = atlas->segmentation;
    for (int32_t c = 0; c < seg->nchart; c++) {
        const sl_chart *chart = &seg->chart[c];
        if (chart->flat.verdict == SL_CHART_NOT_A_DISK) {
            sl_diag_reason(diag,
                           "the seams leave a chart of %d facets (the first is facet %d) with genus %d and %d borders",
                           chart->count, seg->face[chart->first] + 1, chart->topology.genus, chart->topology.loops);
            sl_diag_hint(diag, "add seams until it can be laid flat, or let seamlab cut");
            if (diag != NULL) {
                diag->element = c;
            }
            return SL_INFEASIBLE;
        }
    }
    return SL_OK;
}

/* Where the cap on charts left one that cannot be laid flat there is nothing to deliver. */
static sl_status require_flat(const sl_atlas *atlas, const sl_atlas_def *def, sl_diag *diag)
{
    const sl_segmentation *seg = atlas->segmentation;
    for (int32_t c = 0; c < seg->nchart; c++) {
        const sl_flatten_verdict verdict = seg->chart[c].flat.verdict;
        if (seg->chart[c].capped && verdict != SL_CHART_VALID && verdict != SL_CHART_STRETCHED &&
            verdict != SL_CHART_SHEARED) {
            sl_diag_reason(diag, "with at most %d charts, chart %d (%d facets) cannot be laid flat: %s",
                           def->segment.max_charts, c, seg->chart[c].count, sl_flatten_verdict_name(verdict));
            sl_diag_hint(diag, "raise --max-charts");
            if (diag != NULL) {
                diag->element = c;
            }
            return SL_LIMIT;
        }
    }
    return SL_OK;
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
        place_corners(atlas, quantise);
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
cleanup:
    return status;
}

/* By search, or by recursion alone. */
static sl_status cut_mesh(sl_atlas *atlas, const sl_atlas_def *def, const sl_context *context)
{
    if (!def->best) {
        return sl_segment(atlas->mesh, atlas->triangulation, &def->segment, context, &atlas->segmentation);
    }
    return sl_optimize_segment(atlas->mesh, atlas->triangulation, &def->segment, &def->optimize, context,
                               &atlas->segmentation, &atlas->optimized);
}

sl_status sl_unwrap(const sl_polygons *polygons, const sl_atlas_def *def, const sl_context *context, sl_atlas **out,
                    sl_diag *diag)
{
    *out = NULL;
    sl_atlas *atlas = sl_calloc(1, sizeof *atlas);
    sl_status status = atlas != NULL ? SL_OK : SL_OUT_OF_MEMORY;
    SL_TRY(status);
    SL_TRY(sl_mesh_build(polygons, &atlas->mesh, &atlas->repair, diag));
    SL_TRY(sl_triangulation_create(atlas->mesh, &atlas->triangulation));
    if (def->seams == SL_SEAMS_AUTOMATIC) {
        SL_TRY(cut_mesh(atlas, def, context));
        SL_TRY(require_flat(atlas, def, diag));
    } else {
        SL_TRY(sl_seams_cut(atlas->mesh, def->seams, &def->seam_input, diag));
        SL_TRY(sl_flatten_charts(atlas->mesh, atlas->triangulation, &def->segment, context, &atlas->segmentation));
        SL_TRY(require_disks(atlas, diag));
    }
    status = pack_charts(atlas, def, context);
    if (status == SL_INFEASIBLE) {
        sl_diag_reason(diag, "%d charts and their margins do not fit into %d x %d texels", atlas->segmentation->nchart,
                       def->pack.resolution, def->pack.resolution);
        sl_diag_hint(diag, "raise --resolution or lower --margin");
    }
    SL_TRY(status);
    SL_TRY(sl_atlas_settle(atlas, def, context));
    SL_TRY(warn_of_charts(atlas, def));
    *out = atlas;
    return SL_OK;
cleanup:
    sl_atlas_free(atlas);
    return status;
}

void sl_atlas_free(sl_atlas *atlas)
{
    if (atlas == NULL) {
        return;
    }
    sl_mesh_free(atlas->mesh);
    sl_triangulation_free(atlas->triangulation);
    sl_repair_report_clear(&atlas->repair);
    sl_segmentation_free(atlas->segmentation);
    sl_free(atlas->corner_uv);
    sl_free(atlas->input_corner_uv);
    sl_free(atlas->placement);
    sl_free(atlas->warning);
    sl_free(atlas);
}

sl_status sl_atlas_seams(const sl_mesh *mesh, int32_t **halfedge, int32_t *count)
{
    int32_t n = 0;
    *halfedge = NULL;
    for (int32_t h = 0; h < mesh->nh; h++) {
        n += mesh->sew[h] > h;
    }
    int32_t *list = sl_alloc(n, sizeof *list);
    if (list == NULL) {
        return SL_OUT_OF_MEMORY;
    }
    *count = 0;
    for (int32_t h = 0; h < mesh->nh; h++) {
        if (mesh->sew[h] > h) {
            list[(*count)++] = h;
        }
    }
    *halfedge = list;
    return SL_OK;
}

double sl_atlas_seam_length(const sl_mesh *mesh)
{
    double length = 0.0;
    for (int32_t h = 0; h < mesh->nh; h++) {
        length += mesh->sew[h] > h ? sl_mesh_edge_length(mesh, h) : 0.0;
    }
    return length;
}

double sl_atlas_seam_diagonals(const sl_mesh *mesh)
{
    const double length = sl_atlas_seam_length(mesh);
    return length > 0.0 ? length / sl_mesh_diagonal(mesh) : 0.0; /* a mesh of one point has no diagonal */
}
