/* Spectra and Eigen behind the benches' interface. */
#include "base/memory.h"
#include "bench/solvers.h"
#include "bench/spectra.h"

typedef struct spectra {
    bench_spectra_state *state;
    int32_t n;
} spectra;

static void *prepare(const bench_matrix *m, const char *name)
{
    spectra *s = sl_calloc(1, sizeof *s);
    if (s == NULL) {
        return NULL;
    }
    s->n = m->A.ncols;
    s->state = bench_spectra_create(m->A.ncols, m->A.colptr, m->A.row, m->A.val, bench_shift(m), name);
    return s->state != NULL ? s : NULL;
}

static bool solve(void *state, bench_eigen_run *run)
{
    const spectra *s = state;
    /* Restarts less finely than the others: a short basis where bases are cheap, a long one where solves are dear. */
    const int32_t best = s->n < 20000 ? 4 * run->pairs / 3 + 2 : 8 * run->pairs / 3;
    const int32_t basis = bench_basis_size(run, best, s->n);
    run->error = "Spectra failed";
    return bench_spectra_solve(s->state, run->pairs, basis, run->sigma, run->tolerance, run->lambda, &run->solves,
                               &run->nnz);
}

static const double *vector(void *state, int32_t k)
{
    const spectra *s = state;
    return bench_spectra_vectors(s->state) + (int64_t)k * s->n;
}

const bench_eigen_solver bench_spectra[] = {
    {"spectra-cholmod-amd", false, false, prepare, solve, vector},
    {"spectra-cholmod-amd-simplicial", false, false, prepare, solve, vector},
    {"spectra-cholmod-metis", false, false, prepare, solve, vector},
    {"spectra-eigen", false, false, prepare, solve, vector},
    {0},
};

static void *prepare_llt(const bench_matrix *m, const char *name, double sigma)
{
    (void)name;
    return bench_eigen_llt_create(m->A.ncols, m->A.colptr, m->A.row, m->A.val, sigma);
}

/* Eigen orders within its analysis. */
static bool order_llt(void *state)
{
    (void)state;
    return true;
}

static bool analyze_llt(void *state)
{
    return bench_eigen_llt_analyze(state);
}

static bool factor_llt(void *state)
{
    return bench_eigen_llt_factor(state);
}

static bool solve_llt(void *state, double *X, int32_t nrhs)
{
    return bench_eigen_llt_solve(state, X, nrhs);
}

static int64_t nnz_llt(void *state)
{
    return bench_eigen_llt_nnz(state);
}

const bench_cholesky_solver bench_eigen_llt[] = {
    {"eigen-llt", false, false, prepare_llt, order_llt, analyze_llt, factor_llt, solve_llt, nnz_llt},
    {0},
};
