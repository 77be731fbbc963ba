/* What ABF++ would give on a large chart, by what it gives on a coarse mesh of it: how a conformal map stretches
 * depends on the chart's shape, hardly on its triangles. */
#include "base/memory.h"
#include "param/distortion.h"
#include "param/flatten_internal.h"
#include "param/stretch_levels_internal.h"

#include <math.h>

static const int32_t LARGE = 8000;       /* triangles: below this ABF++ itself costs no more */
static const double COARSE_SHARE = 0.35; /* triangles of a level, of those of the finer one */
static const int32_t COARSE = 800;       /* no level has fewer */

sl_status sl_flatten_foresee(const sl_patch *patch, const sl_abf_def *def, const sl_context *context, double *l2)
{
    sl_status status = SL_OK;
    sl_levels levels = {0};
    sl_patch *coarse = NULL;
    int32_t *vertex = NULL;
    double *uv = NULL;
    sl_abf_info info;
    sl_distortion distortion;
    *l2 = 1.0;
    if (patch->nt < LARGE) {
        return SL_OK;
    }
    SL_TRY(sl_levels_create(patch, COARSE_SHARE, COARSE, &levels));
    if (levels.count == 0) {
        goto cleanup;
    }
    SL_TRY(sl_level_patch(patch, &levels.level[levels.count - 1], &coarse, &vertex));
    uv = sl_alloc(coarse->nv, 2 * sizeof *uv);
    if (uv == NULL) {
        SL_TRY(SL_OUT_OF_MEMORY);
    }
    status = sl_abf_flatten(coarse, def, context, uv, &info);
    if (status == SL_SINGULAR || status == SL_INFEASIBLE || status == SL_BAD_INPUT) {
        status = SL_OK;
        goto cleanup;
    }
    SL_TRY(status);
    SL_TRY(sl_distortion_measure_indexed(coarse->nt, coarse->tri, coarse->xyz, uv, &distortion));
    *l2 = info.converged && distortion.flipped == 0 ? distortion.l2 : 1.0;
cleanup:
    sl_free(uv);
    sl_free(vertex);
    sl_patch_free(coarse);
    sl_levels_clear(&levels);
    return status;
}
