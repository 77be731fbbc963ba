#include "atlas/atlas.h"

#include "atlas/atlas_internal.h"
#include "base/memory.h"
#include "base/text.h"

#include <math.h>
#include <stdio.h>

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
             "%d facet%s that stand%s alone: stretched above the bound %.4g, most of all facet %d (chart %d, L2 %.4g)",
             count, sl_plural(count), count == 1 ? "s" : "", bound, seg->face[seg->chart[worst].first], worst,
             seg->chart[worst].flat.distortion.l2);
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
            "copies across %d ax%s are approximate: a near symmetry, with corners up to %.3g of the diagonal off (%g "
            "allowed)",
            info->near_axes, info->near_axes == 1 ? "is" : "es", info->deviation, sl_symmetry_default().near);
    }
    if (info->planes > 0) {
        sl_warning *w = push_warning(atlas, -1);
        if (w == NULL) {
            return SL_OUT_OF_MEMORY;
        }
        snprintf(w->text, sizeof w->text,
                 "%d component%s cut at the plane of a near symmetry (mean misfit %.3g of the diagonal); the facets "
                 "beside it do not correspond, so nothing is shared there",
                 info->planes, info->planes == 1 ? " is" : "s are", info->misfit);
    }
    if (info->refused > 0) {
        sl_warning *w = push_warning(atlas, -1);
        if (w == NULL) {
            return SL_OUT_OF_MEMORY;
        }
        snprintf(w->text, sizeof w->text,
                 "%d chart%s could not be copied from the mirror image and had to be laid flat", info->refused,
                 sl_plural(info->refused));
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
                 "the search found no valid charts for %d of %d piece%s, cut by recursion instead", info.failed,
                 info.pieces, sl_plural(info.pieces));
    }
    if (info.missed > 0) {
        sl_warning *w = push_warning(atlas, -1);
        if (w == NULL) {
            return SL_OUT_OF_MEMORY;
        }
        snprintf(w->text, sizeof w->text, "%d of %d piece%s not within the targets (L2 %.4g, mean s1/s2 %.4g)",
                 info.missed, info.pieces, sl_plural(info.pieces), def->optimize.target_stretch,
                 def->optimize.target_angle);
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
            snprintf(w->text, sizeof w->text,
                     "chart %d (%d facet%s, first %d): stretch L2 %.4g is above the bound %.4g", c, chart->count,
                     sl_plural(chart->count), seg->face[chart->first], chart->flat.distortion.l2,
                     def->segment.flatten.max_stretch);
        } else if (chart->flat.verdict == SL_CHART_SHEARED) {
            snprintf(w->text, sizeof w->text,
                     "chart %d (%d facet%s, first %d): mean s1/s2 %.4g is above the bound %.4g", c, chart->count,
                     sl_plural(chart->count), seg->face[chart->first], chart->flat.distortion.angle_mean,
                     def->segment.flatten.max_angle);
        } else {
            snprintf(w->text, sizeof w->text, "chart %d (%d facet%s, first %d): %s", c, chart->count,
                     sl_plural(chart->count), seg->face[chart->first], sl_flatten_verdict_name(chart->flat.verdict));
        }
    }
    if (atlas->repair.degenerate_faces > 0) {
        sl_warning *w = push_warning(atlas, -1);
        if (w == NULL) {
            return SL_OUT_OF_MEMORY;
        }
        snprintf(w->text, sizeof w->text, "%d facet%s without area: one texel each", atlas->repair.degenerate_faces,
                 sl_plural(atlas->repair.degenerate_faces));
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
    SL_TRY(sl_atlas_pack(atlas, def, context, diag));
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
