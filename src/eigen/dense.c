#include "base/memory.h"
#include "eigen/lanczos_internal.h"

#include <cblas.h>
#include <string.h>

sl_status sl_dense_eigen(int32_t n, double *A, double *lambda, double *V)
{
    if (n == 0) {
        return SL_OK;
    }
    lapack_int found = 0;
    lapack_int *support = sl_alloc(2 * (int64_t)n, sizeof *support);
    if (support == NULL) {
        return SL_OUT_OF_MEMORY;
    }
    const lapack_int info =
        LAPACKE_dsyevr(LAPACK_COL_MAJOR, 'V', 'A', 'L', n, A, n, 0.0, 0.0, 0, 0, 0.0, &found, lambda, V, n, support);
    sl_free(support);
    if (info == LAPACK_WORK_MEMORY_ERROR) {
        return SL_OUT_OF_MEMORY;
    }
    return info == 0 && found == n ? SL_OK : SL_INTERNAL;
}

/* Lower triangle of A + 2 ||A|| N N': the null space N goes to the far end of the spectrum. */
static void fill_dense(const sl_lanczos *s, double *D)
{
    const int32_t n = s->n;
    memset(D, 0, (size_t)n * (size_t)n * sizeof *D);
    for (int32_t j = 0; j < n; j++) {
        for (int64_t p = s->A->colptr[j]; p < s->A->colptr[j + 1]; p++) {
            D[(int64_t)j * n + s->A->row[p]] = s->A->val[p];
        }
    }
    if (s->null_count > 0) {
        cblas_dsyrk(CblasColMajor, CblasLower, CblasNoTrans, n, s->null_count, 2.0 * s->norm, s->Q, n, 1.0, D, n);
    }
}

sl_status sl_lanczos_solve_dense(sl_lanczos *s)
{
    const int64_t n = s->n;
    double *D = NULL, *V = NULL, *lambda = NULL;
    int64_t entries = 0;
    sl_status status = SL_OK;
    SL_TRY(sl_mul_size(n, n, &entries));
    D = sl_alloc(entries, sizeof *D);
    V = sl_alloc(entries, sizeof *V);
    lambda = sl_alloc(n, sizeof *lambda);
    SL_TRY(D != NULL && V != NULL && lambda != NULL ? SL_OK : SL_OUT_OF_MEMORY);
    fill_dense(s, D);
    SL_TRY(sl_dense_eigen(s->n, D, lambda, V));
    memcpy(s->X, s->Q, (size_t)n * (size_t)s->null_count * sizeof *s->X);
    memset(s->lambda, 0, (size_t)s->null_count * sizeof *s->lambda);
    memcpy(s->X + n * s->null_count, V, (size_t)n * (size_t)s->wanted * sizeof *s->X);
    memcpy(s->lambda + s->null_count, lambda, (size_t)s->wanted * sizeof *s->lambda);
    s->finished = true;
    s->info.dense = true;
    sl_lanczos_finish_pairs(s);
cleanup:
    sl_free(D);
    sl_free(V);
    sl_free(lambda);
    return status;
}
