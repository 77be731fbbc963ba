/* The mesh with the chart's UVs. */
#include "base/memory.h"
#include "cli/abf_trace.h"

#include <math.h>
#include <string.h>

/* Into the unit square, unless pins say where the chart lies. */
static void place(const abf_trace *t, double *uv)
{
    const int32_t nv = t->pick->patch->nv;
    double lo[2] = {HUGE_VAL, HUGE_VAL}, size = 0.0;
    if (t->constraints->pins > 0) {
        return;
    }
    for (int64_t i = 0; i < 2 * (int64_t)nv; i++) {
        lo[i % 2] = fmin(lo[i % 2], uv[i]);
    }
    for (int64_t i = 0; i < 2 * (int64_t)nv; i++) {
        size = fmax(size, uv[i] - lo[i % 2]);
    }
    for (int64_t i = 0; i < 2 * (int64_t)nv && size > 0.0; i++) {
        uv[i] = (uv[i] - lo[i % 2]) / size;
    }
}

sl_status abf_mesh_write(const abf_trace *t, const char *path, sl_diag *diag)
{
    sl_status status = SL_OUT_OF_MEMORY;
    const abf_pick *pick = t->pick;
    const sl_patch *patch = pick->patch;
    const sl_mesh *mesh = pick->atlas != NULL ? pick->atlas->mesh : pick->mesh;
    const double *last = abf_trace_last(t)->uv;
    const int64_t corners = pick->file->face_first[pick->file->nf];
    double *corner_uv = sl_alloc(2 * corners, sizeof *corner_uv);
    double *uv = last != NULL ? sl_copy(last, 2 * (int64_t)patch->nv, sizeof *uv) : NULL;
    if (last == NULL || abf_trace_last(t)->flipped > 0) {
        sl_diag_reason(diag, last == NULL ? "these angles cannot be laid out: nothing is written"
                                          : "the layout has flipped triangles and is not written");
        status = SL_CHECK_FAILED;
        goto cleanup;
    }
    SL_TRY(corner_uv != NULL && uv != NULL ? SL_OK : SL_OUT_OF_MEMORY);
    place(t, uv);
    for (int64_t i = 0; i < 2 * corners; i++) {
        corner_uv[i] = NAN;
    }
    for (int32_t c = 0; c < 3 * patch->nt; c++) {
        const int64_t input = sl_input_corner(mesh, patch->corner[c]);
        memcpy(&corner_uv[2 * input], &uv[2 * (int64_t)patch->tri[c]], 2 * sizeof *uv);
    }
    status = sl_meshfile_write(path, pick->file, corner_uv, diag);
cleanup:
    sl_free(corner_uv);
    sl_free(uv);
    return status;
}
