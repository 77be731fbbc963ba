#include "base/memory.h"
#include "sparse/front.h"

/* L and the signs, when this is the first factorisation. */
static sl_status make_room(sl_cholesky *F)
{
    if (F->L == NULL) {
        F->L = sl_alloc(F->panel[F->supernodes], sizeof *F->L);
    }
    if (F->sign == NULL && F->kind == SL_FACTOR_LDLT) {
        F->sign = sl_alloc(F->n, sizeof *F->sign);
    }
    return F->L != NULL && (F->sign != NULL || F->kind != SL_FACTOR_LDLT) ? SL_OK : SL_OUT_OF_MEMORY;
}

sl_status sl_cholesky_reserve(sl_cholesky *F)
{
    sl_status status = SL_OK;
    SL_TRY(make_room(F));
    if (F->space.updates == NULL) {
        SL_TRY(sl_front_space_init(F, F->max_update, &F->space));
    }
cleanup:
    return status;
}

sl_status sl_cholesky_factor_shifted(sl_cholesky *F, const sl_csc *A, double sigma, const sl_context *context,
                                     int32_t *bad_column)
{
    double diagonal;
    sl_status status = SL_OK;
    SL_TRY(sl_check_values(F, A, sigma, NULL, &diagonal));
    SL_TRY(make_room(F));
    sl_front_job job = {.F = F,
                        .A = A,
                        .sigma = sigma,
                        .stage = "factor",
                        .pivoting = {F->pivot_rtol * diagonal, 0.0},
                        .L = F->L,
                        .sign = F->sign,
                        .space = F->space.updates != NULL ? &F->space : NULL,
                        .bad = -1};
    SL_TRY(sl_factor_fronts(&job, context));
    if (job.bad != -1) {
        if (bad_column != NULL) {
            *bad_column = F->perm[job.bad];
        }
        status = F->kind == SL_FACTOR_LDLT ? SL_SINGULAR : SL_NOT_POSITIVE_DEFINITE;
    }
cleanup:
    return status;
}

sl_status sl_cholesky_factor(sl_cholesky *F, const sl_csc *A, int32_t *bad_column)
{
    return sl_cholesky_factor_shifted(F, A, 0.0, NULL, bad_column);
}
