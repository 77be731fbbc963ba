/* Charts that are final are relaxed to the end: during the recursion the minimisation of stretch stops at the bound. */
#include "segment/segment_internal.h"

#include "base/memory.h"

#include <math.h>
#include <string.h>

/* UVs of the patch's vertices from the chart's corners, and back. */
static void gather(const sl_patch *patch, const double *corner_uv, double *uv)
{
    for (int32_t c = 0; c < 3 * patch->nt; c++) {
        memcpy(uv + 2 * (int64_t)patch->tri[c], corner_uv + 2 * (int64_t)patch->corner[c], 2 * sizeof *uv);
    }
}

static void scatter(const sl_patch *patch, const double *uv, double *corner_uv)
{
    for (int32_t c = 0; c < 3 * patch->nt; c++) {
        memcpy(corner_uv + 2 * (int64_t)patch->corner[c], uv + 2 * (int64_t)patch->tri[c], 2 * sizeof *uv);
    }
}

/* Makes the chart's area its area in space. */
static void scale_to_space(const sl_patch *patch, double *uv)
{
    double space = 0.0, plane = 0.0;
    for (int32_t t = 0; t < patch->nt; t++) {
        const double *a = uv + 2 * (int64_t)patch->tri[3 * t], *b = uv + 2 * (int64_t)patch->tri[3 * t + 1],
                     *c = uv + 2 * (int64_t)patch->tri[3 * t + 2];
        space += sl_patch_triangle_area(patch, t);
        plane += 0.5 * ((b[0] - a[0]) * (c[1] - a[1]) - (c[0] - a[0]) * (b[1] - a[1]));
    }
    const double scale = plane > 0.0 ? sqrt(space / plane) : 1.0;
    for (int64_t k = 0; k < 2 * (int64_t)patch->nv; k++) {
        uv[k] *= scale;
    }
}

/* Minimises, and takes the result where it is embedded and stretches less. */
static sl_status relax(const sl_patch *patch, const sl_flatten_def *def, const sl_context *context, double *uv,
                       sl_chart_job *job)
{
    sl_status status = SL_OK;
    int32_t *border = NULL, nb = 0;
    sl_stretch_def stretch = def->stretch;
    sl_stretch_info info;
    sl_certificate certificate;
    sl_distortion distortion;
    stretch.simple_border = true;
    status = sl_stretch_minimise(patch, &stretch, context, uv, &info);
    if (status == SL_BAD_INPUT || status == SL_SINGULAR || status == SL_NOT_POSITIVE_DEFINITE) {
        return SL_OK; /* no better map: the one at hand is valid */
    }
    SL_TRY(status);
    scale_to_space(patch, uv);
    SL_TRY(sl_patch_border_pairs(patch, &border, &nb));
    SL_TRY(sl_certify_embedding(uv, patch->nt, patch->tri, nb, border, &certificate));
    SL_TRY(sl_distortion_measure_indexed(patch->nt, patch->tri, patch->xyz, uv, &distortion));
    if (certificate.embedded && distortion.l2 < job->flat.distortion.l2 && distortion.angle_mean <= def->max_angle) {
        scatter(patch, uv, job->corner_uv);
        info.iterations += job->flat.stretch.iterations;
        info.energy_before = job->flat.stretch.energy_before;
        job->flat.stretch = info;
        job->flat.certificate = certificate;
        job->flat.distortion = distortion;
    }
cleanup:
    sl_free(border);
    return status;
}

void sl_chart_job_polish(const sl_recursion *r, sl_chart_job *job)
{
    sl_status status = SL_OK;
    sl_piece *piece = NULL;
    sl_patch *patch = NULL;
    double *uv = NULL;
    if (job->settled || job->flat.verdict != SL_CHART_VALID || !job->flat.stretch_minimised) {
        return;
    }
    SL_TRY(sl_piece_create(r->mesh, r->triangulation, job->face, job->count, &piece));
    SL_TRY(sl_piece_patch(piece, &patch));
    uv = sl_alloc(2 * (int64_t)patch->nv, sizeof *uv);
    if (uv == NULL) {
        SL_TRY(SL_OUT_OF_MEMORY);
    }
    gather(patch, job->corner_uv, uv);
    SL_TRY(relax(patch, &r->def->flatten, r->context, uv, job));
cleanup:
    sl_free(uv);
    sl_patch_free(patch);
    sl_piece_free(piece);
    job->status = status;
}
