#include "base/memory.h"
#include "param/flatten_internal.h"
#include "param/open.h"

#include <math.h>
#include <string.h>

static const double OPENING = 0x1p-13; /* how far a border vertex moves inwards, per shorter border edge there */
static const double GRID = 0x1p-34;    /* rounding a border must survive, per extent of the chart */

static double extent_of(int32_t nv, const double *uv)
{
    double reach = 0.0;
    for (int64_t i = 0; i < 2 * (int64_t)nv; i++) {
        reach = fmax(reach, fabs(uv[i] - uv[i % 2]));
    }
    return reach;
}

sl_status sl_flatten_certify(const sl_patch *patch, int32_t nb, const int32_t *border, double *uv, sl_certificate *out)
{
    double *opened = NULL, *work = NULL;
    bool survives;
    sl_certificate trial;
    sl_status status = SL_OK;
    SL_TRY(sl_certify_embedding(uv, patch->nt, patch->tri, nb, border, out));
    if (out->flipped > 0 || out->degenerate > 0) {
        goto cleanup;
    }
    opened = sl_alloc(patch->nv, 2 * sizeof *opened);
    work = sl_alloc(patch->nv, 2 * sizeof *work);
    if (opened == NULL || work == NULL) {
        SL_TRY(SL_OUT_OF_MEMORY);
    }
    const double step = GRID * extent_of(patch->nv, uv);
    SL_TRY(sl_border_survives(patch->nv, nb, border, uv, step, work, &survives));
    if (survives && out->embedded) {
        goto cleanup;
    }
    sl_open_border(patch, nb, border, uv, OPENING, 0.0, work, opened);
    SL_TRY(sl_certify_embedding(opened, patch->nt, patch->tri, nb, border, &trial));
    SL_TRY(sl_border_survives(patch->nv, nb, border, opened, step, work, &survives));
    if (trial.embedded && survives) {
        memcpy(uv, opened, 2 * (size_t)patch->nv * sizeof *uv);
        *out = trial;
    }
cleanup:
    sl_free(opened);
    sl_free(work);
    return status;
}
