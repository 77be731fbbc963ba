#include "param/lscm.h"

#include "base/memory.h"
#include "param/abf_internal.h"
#include "param/reconstruct_internal.h"

sl_status sl_lscm(const sl_patch *patch, const sl_context *context, double *uv)
{
    double *beta = sl_alloc(3 * (int64_t)patch->nt, sizeof *beta);
    if (beta == NULL) {
        return SL_OUT_OF_MEMORY;
    }
    sl_corner_angles(patch, beta);
    const sl_status status = sl_conformal_layout(patch, beta, context, uv);
    sl_free(beta);
    return status;
}
