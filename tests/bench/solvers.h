/* One interface to every solver the benches compare. */
#ifndef BENCH_SOLVERS_H
#define BENCH_SOLVERS_H

#include "bench/bench.h"

/* What an eigensolver is asked for and reports. */
typedef struct bench_eigen_run {
    int32_t pairs;
    int32_t basis;    /* columns a library may use; 0 = the default */
    double tolerance; /* its own */
    double sigma;     /* below the spectrum */
    bool signs;
    double *lambda; /* pairs, ascending after solve */
    int32_t solves;
    int64_t nnz;
    bool certified;
    const char *error; /* why solve failed */
} bench_eigen_run;

/* prepare: before the clock: libraries initialised, the matrix in the library's own format (NULL = failure).
 * solve: on the clock, all of it. vector(state, k): afterwards, the k-th eigenvector where the solver left it.
 * The process ends without cleaning up. */
typedef struct bench_eigen_solver {
    const char *name;
    bool optional; /* runs only when named */
    bool ours;
    void *(*prepare)(const bench_matrix *matrix, const char *name);
    bool (*solve)(void *state, bench_eigen_run *run);
    const double *(*vector)(void *state, int32_t k);
} bench_eigen_solver;

/* Columns of a library's basis: what was asked for, else its own `best`. */
static inline int32_t bench_basis_size(const bench_eigen_run *run, int32_t best, int32_t n)
{
    const int32_t basis = run->basis > run->pairs ? run->basis : best;
    return basis < n ? basis : n;
}

/* Each phase of a sparse Cholesky solver; false = failed. */
typedef struct bench_cholesky_solver {
    const char *name;
    bool optional;
    bool ours;
    void *(*prepare)(const bench_matrix *matrix, const char *name, double sigma);
    bool (*order)(void *state);
    bool (*analyze)(void *state);
    bool (*factor)(void *state);
    bool (*solve)(void *state, double *X, int32_t nrhs); /* in place or into X */
    int64_t (*nnz)(void *state);
} bench_cholesky_solver;

/* Ended by an entry without a name. */
extern const bench_eigen_solver bench_ours_eigen[], bench_arpack[], bench_spectra[], bench_slepc[];
extern const bench_cholesky_solver bench_ours_cholesky[], bench_cholmod_solvers[], bench_eigen_llt[];

#endif
