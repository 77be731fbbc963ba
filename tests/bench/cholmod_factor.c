/* CHOLMOD, the reference factorisation. Its Supernodal module is GPL: it is used here, in a bench that is not
 * installed, and never by the library or the program. */
#include "bench/cholmod_factor.h"

#include "base/memory.h"
#include "bench/solvers.h"

#include <string.h>
#include <suitesparse/cholmod.h>

/* Right-hand sides at a time: of 4, 8, 16, 32 and 64 the fastest, and in less memory than 64. */
enum { BATCH = 32 };

struct bench_cholmod {
    cholmod_common common;
    cholmod_sparse A;
    cholmod_factor *L;
    cholmod_dense *Y, *E; /* workspace that CHOLMOD keeps between solves */
    cholmod_dense *x;
    int *perm;
    bool metis;
};

bench_cholmod *bench_cholmod_create(int32_t n, const int64_t *colptr, const int32_t *row, const double *val,
                                    double sigma, const char *how)
{
    bench_cholmod *c = sl_calloc(1, sizeof *c);
    int *p = sl_alloc((int64_t)n + 1, sizeof *p);
    double *x = sl_copy(val, colptr[n], sizeof *x);
    int *i = sl_copy(row, colptr[n], sizeof *i);
    if (c == NULL || p == NULL || x == NULL || i == NULL) {
        return NULL;
    }
    for (int32_t j = 0; j <= n; j++) {
        p[j] = (int)colptr[j];
    }
    for (int32_t j = 0; j < n; j++) {
        x[p[j]] -= sigma;
    }
    cholmod_start(&c->common);
    c->common.print = 0;
    c->metis = strstr(how, "metis") != NULL;
    c->common.supernodal = strstr(how, "simplicial") != NULL ? CHOLMOD_SIMPLICIAL : CHOLMOD_SUPERNODAL;
    c->common.final_ll = strstr(how, "simplicial") == NULL;
    c->A = (cholmod_sparse){.nrow = (size_t)n,
                            .ncol = (size_t)n,
                            .nzmax = (size_t)colptr[n],
                            .p = p,
                            .i = i,
                            .x = x,
                            .stype = -1,
                            .itype = CHOLMOD_INT,
                            .xtype = CHOLMOD_REAL,
                            .dtype = CHOLMOD_DOUBLE,
                            .sorted = 1,
                            .packed = 1};
    return c;
}

bool bench_cholmod_order(bench_cholmod *c)
{
    c->perm = sl_alloc((int64_t)c->A.nrow, sizeof *c->perm);
    if (c->perm == NULL) {
        return false;
    }
    /* Postordering is the analysis's; METIS as cholmod_analyze calls it. */
    return (c->metis ? cholmod_metis(&c->A, NULL, 0, 0, c->perm, &c->common)
                     : cholmod_amd(&c->A, NULL, 0, c->perm, &c->common)) != 0;
}

bool bench_cholmod_analyze(bench_cholmod *c)
{
    c->common.nmethods = 1;
    c->common.method[0].ordering = CHOLMOD_GIVEN;
    c->common.postorder = 1;
    c->L = cholmod_analyze_p(&c->A, c->perm, NULL, 0, &c->common);
    return c->L != NULL;
}

bool bench_cholmod_factorize(bench_cholmod *c)
{
    return cholmod_factorize(&c->A, c->L, &c->common) != 0 && c->common.status == CHOLMOD_OK;
}

int64_t bench_cholmod_nnz(const bench_cholmod *c)
{
    return c->L->is_super != 0 ? (int64_t)c->L->xsize : (int64_t)c->L->nzmax;
}

static cholmod_dense dense(const bench_cholmod *c, double *X, int32_t nrhs)
{
    return (cholmod_dense){.nrow = c->A.nrow,
                           .ncol = (size_t)nrhs,
                           .nzmax = c->A.nrow * (size_t)nrhs,
                           .d = c->A.nrow,
                           .x = X,
                           .xtype = CHOLMOD_REAL,
                           .dtype = CHOLMOD_DOUBLE};
}

/* C->x = inv(A - sigma I) B. */
static bool solve_into_x(bench_cholmod *c, cholmod_dense *B)
{
    return cholmod_solve2(CHOLMOD_A, c->L, B, NULL, &c->x, NULL, &c->Y, &c->E, &c->common) != 0;
}

bool bench_cholmod_solve(bench_cholmod *c, double *X, int32_t nrhs)
{
    for (int32_t k = 0; k < nrhs; k += BATCH) {
        const int32_t width = nrhs - k < BATCH ? nrhs - k : BATCH;
        double *part = X + (int64_t)k * (int64_t)c->A.nrow;
        cholmod_dense B = dense(c, part, width);
        if (!solve_into_x(c, &B)) {
            return false;
        }
        memcpy(part, c->x->x, c->A.nrow * (size_t)width * sizeof *X);
    }
    return true;
}

bool bench_cholmod_apply(bench_cholmod *c, const double *x, double *y)
{
    cholmod_dense B = dense(c, NULL, 1);
    memcpy(&B.x, &x, sizeof x); /* CHOLMOD only reads it, but takes no const */
    if (!solve_into_x(c, &B)) {
        return false;
    }
    memcpy(y, c->x->x, c->A.nrow * sizeof *y);
    return true;
}

static void *prepare(const bench_matrix *m, const char *name, double sigma)
{
    return bench_cholmod_create(m->A.ncols, m->A.colptr, m->A.row, m->A.val, sigma, name);
}

static bool order(void *state)
{
    return bench_cholmod_order(state);
}

static bool analyze(void *state)
{
    return bench_cholmod_analyze(state);
}

static bool factor(void *state)
{
    return bench_cholmod_factorize(state);
}

static bool solve(void *state, double *X, int32_t nrhs)
{
    return bench_cholmod_solve(state, X, nrhs);
}

static int64_t nnz(void *state)
{
    return bench_cholmod_nnz(state);
}

const bench_cholesky_solver bench_cholmod_solvers[] = {
    {"cholmod-amd", false, false, prepare, order, analyze, factor, solve, nnz},
    {"cholmod-metis", false, false, prepare, order, analyze, factor, solve, nnz},
    {"cholmod-amd-simplicial", false, false, prepare, order, analyze, factor, solve, nnz},
    {0},
};
