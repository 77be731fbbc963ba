/* seamlab's own solvers behind the benches' interface. */
#include "base/context.h"
#include "base/memory.h"
#include "bench/solvers.h"
#include "eigen/lanczos.h"
#include "sparse/cholesky.h"

#include <math.h>
#include <string.h>

typedef struct ours {
    const bench_matrix *matrix;
    sl_context context;
    double *vectors, *null_space;
    sl_lanczos_info info;
    sl_csc shifted;
    int32_t *perm;
    sl_cholesky *factor;
} ours;

static void *prepare_eigen(const bench_matrix *matrix, const char *name)
{
    sl_thread_pool *pool = NULL;
    ours *o = sl_calloc(1, sizeof *o);
    if (o == NULL) {
        return NULL;
    }
    o->matrix = matrix;
    if (strcmp(name, "ours-2") == 0) {
        if (sl_thread_pool_create(2, &pool) != SL_OK) {
            return NULL;
        }
        o->context.executor = sl_thread_pool_executor(pool);
    }
    return o;
}

static bool solve_eigen(void *state, bench_eigen_run *run)
{
    ours *o = state;
    const int32_t n = o->matrix->A.ncols;
    o->vectors = sl_alloc((int64_t)n * run->pairs, sizeof *o->vectors);
    o->null_space = sl_alloc(n, sizeof *o->null_space);
    if (o->vectors == NULL || o->null_space == NULL) {
        run->error = "out of memory";
        return false;
    }
    for (int32_t i = 0; i < n; i++) {
        o->null_space[i] = 1.0 / sqrt(n);
    }
    sl_lanczos_def def = sl_lanczos_default();
    def.count = run->pairs;
    if (run->signs) {
        def.mode = SL_LANCZOS_SIGNS;
        def.sign_tolerance = run->tolerance;
    } else {
        def.tolerance = run->tolerance;
    }
    def.null_space = o->null_space;
    def.null_count = 1;
    def.xyz = o->matrix->xyz;
    const sl_status status =
        sl_lanczos_solve(&o->matrix->A, &def, &o->context, run->lambda, o->vectors, NULL, &o->info);
    run->solves = o->info.solves;
    run->certified = o->info.certified;
    run->error = status != SL_OK ? sl_status_name(status) : "not converged";
    return status == SL_OK && o->info.converged;
}

static const double *vector(void *state, int32_t k)
{
    const ours *o = state;
    return o->vectors + (int64_t)k * o->matrix->A.ncols;
}

const bench_eigen_solver bench_ours_eigen[] = {
    {"ours", false, true, prepare_eigen, solve_eigen, vector},
    {"ours-2", true, true, prepare_eigen, solve_eigen, vector},
    {0},
};

static void *prepare_cholesky(const bench_matrix *matrix, const char *name, double sigma)
{
    (void)name;
    const int32_t n = matrix->A.ncols;
    ours *o = sl_calloc(1, sizeof *o);
    if (o == NULL) {
        return NULL;
    }
    o->matrix = matrix;
    o->shifted = matrix->A;
    o->shifted.val = sl_copy(matrix->A.val, matrix->A.colptr[n], sizeof(double));
    if (o->shifted.val == NULL) {
        return NULL;
    }
    for (int32_t j = 0; j < n; j++) {
        o->shifted.val[o->shifted.colptr[j]] -= sigma;
    }
    return o;
}

static bool order(void *state)
{
    ours *o = state;
    o->perm = sl_alloc(o->matrix->A.ncols, sizeof *o->perm);
    return o->perm != NULL && sl_order(&o->shifted, SL_ORDER_AUTO, o->matrix->xyz, o->perm) == SL_OK;
}

static bool analyze(void *state)
{
    ours *o = state;
    sl_cholesky_def def = sl_cholesky_default();
    def.perm = o->perm;
    return sl_cholesky_analyze(&o->shifted, &def, &o->factor) == SL_OK;
}

static bool factor(void *state)
{
    ours *o = state;
    return sl_cholesky_factor(o->factor, &o->shifted, NULL) == SL_OK;
}

static bool solve(void *state, double *X, int32_t nrhs)
{
    ours *o = state;
    double *work = sl_alloc(sl_cholesky_work_size(o->factor, nrhs), sizeof *work);
    if (work == NULL) {
        return false;
    }
    sl_cholesky_solve(o->factor, X, nrhs, work);
    sl_free(work);
    return true;
}

static int64_t nnz(void *state)
{
    return sl_cholesky_nnz(((const ours *)state)->factor);
}

const bench_cholesky_solver bench_ours_cholesky[] = {
    {"ours", false, true, prepare_cholesky, order, analyze, factor, solve, nnz},
    {0},
};
