/* ARPACK's symmetric shift-invert mode on CHOLMOD's factor. */
#include "base/memory.h"
#include "bench/cholmod_factor.h"
#include "bench/solvers.h"

#include <string.h>

/* The Fortran interface: text arguments pass their lengths last. */
void dsaupd_(int *ido, const char *bmat, const int *n, const char *which, const int *nev, const double *tol,
             double *resid, const int *ncv, double *v, const int *ldv, int *iparam, int *ipntr, double *workd,
             double *workl, const int *lworkl, int *info, size_t bmat_length, size_t which_length);
void dseupd_(const int *rvec, const char *howmny, int *select, double *d, double *z, const int *ldz,
             const double *sigma, const char *bmat, const int *n, const char *which, const int *nev, const double *tol,
             double *resid, const int *ncv, double *v, const int *ldv, int *iparam, int *ipntr, double *workd,
             double *workl, const int *lworkl, int *info, size_t howmny_length, size_t bmat_length,
             size_t which_length);

typedef struct arpack {
    bench_cholmod *factor;
    int n;
    double *v;
    int position[BENCH_MAX_PAIRS]; /* column of the k-th smallest */
} arpack;

static void *prepare(const bench_matrix *m, const char *name)
{
    arpack *a = sl_calloc(1, sizeof *a);
    if (a == NULL) {
        return NULL;
    }
    a->n = m->A.ncols;
    a->factor = bench_cholmod_create(a->n, m->A.colptr, m->A.row, m->A.val, bench_shift(m), name);
    return a->factor != NULL ? a : NULL;
}

static bool iterate(arpack *a, bench_eigen_run *run, int ncv, double *resid, double *workd, double *workl, int lworkl)
{
    int ido = 0, info = 0, iparam[11] = {1, 0, 1000, 1, 0, 0, 3}, ipntr[11], select[3 * BENCH_MAX_PAIRS + 3];
    const int nev = run->pairs, rvec = 1;
    for (;;) {
        dsaupd_(&ido, "I", &a->n, "LM", &nev, &run->tolerance, resid, &ncv, a->v, &a->n, iparam, ipntr, workd, workl,
                &lworkl, &info, 1, 2);
        if (ido != -1 && ido != 1) {
            break;
        }
        if (!bench_cholmod_apply(a->factor, workd + ipntr[0] - 1, workd + ipntr[1] - 1)) {
            return false;
        }
    }
    run->solves = iparam[8];
    if (info != 0 || iparam[4] < nev) {
        return false;
    }
    dseupd_(&rvec, "A", select, run->lambda, a->v, &a->n, &run->sigma, "I", &a->n, "LM", &nev, &run->tolerance, resid,
            &ncv, a->v, &a->n, iparam, ipntr, workd, workl, &lworkl, &info, 1, 1, 2);
    return info == 0;
}

/* dseupd's order depends on the mode: ascending here, whatever it was. */
static void sort_pairs(arpack *a, double *lambda, int pairs)
{
    for (int k = 0; k < pairs; k++) {
        int at = k;
        const double value = lambda[k];
        for (; at > 0 && lambda[at - 1] > value; at--) {
            lambda[at] = lambda[at - 1];
            a->position[at] = a->position[at - 1];
        }
        lambda[at] = value;
        a->position[at] = k;
    }
}

static bool solve(void *state, bench_eigen_run *run)
{
    arpack *a = state;
    run->error = "CHOLMOD failed";
    if (!bench_cholmod_order(a->factor) || !bench_cholmod_analyze(a->factor) || !bench_cholmod_factorize(a->factor)) {
        return false;
    }
    run->nnz = bench_cholmod_nnz(a->factor);
    const int ncv = bench_basis_size(run, 2 * run->pairs + 2, a->n), lworkl = ncv * (ncv + 8);
    a->v = sl_alloc((int64_t)a->n * ncv, sizeof *a->v);
    double *resid = sl_alloc(a->n, sizeof *resid), *workd = sl_alloc(3 * (int64_t)a->n, sizeof *workd);
    double *workl = sl_alloc(lworkl, sizeof *workl);
    if (a->v == NULL || resid == NULL || workd == NULL || workl == NULL) {
        run->error = "out of memory";
        return false;
    }
    run->error = "ARPACK did not converge";
    const bool ok = iterate(a, run, ncv, resid, workd, workl, lworkl);
    sort_pairs(a, run->lambda, run->pairs);
    return ok;
}

static const double *vector(void *state, int32_t k)
{
    const arpack *a = state;
    return a->v + (int64_t)a->position[k] * a->n;
}

const bench_eigen_solver bench_arpack[] = {
    {"arpack-amd", false, false, prepare, solve, vector},
    {"arpack-metis", false, false, prepare, solve, vector},
    {"arpack-amd-simplicial", false, false, prepare, solve, vector},
    {0},
};
