/* The C side of what only C++ can call. */
#ifndef BENCH_SPECTRA_H
#define BENCH_SPECTRA_H

#include <stdbool.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct bench_spectra_state bench_spectra_state;

/* how: as in bench_cholmod_create, with "cholmod" in it; else Eigen's SimplicialLLT. NULL = failure. */
bench_spectra_state *bench_spectra_create(int32_t n, const int64_t *colptr, const int32_t *row, const double *val,
                                          double sigma, const char *how);
bool bench_spectra_solve(bench_spectra_state *state, int32_t pairs, int32_t basis, double sigma, double tolerance,
                         double *lambda, int32_t *solves, int64_t *nnz);
const double *bench_spectra_vectors(const bench_spectra_state *state);

typedef struct bench_eigen_llt_state bench_eigen_llt_state;

bench_eigen_llt_state *bench_eigen_llt_create(int32_t n, const int64_t *colptr, const int32_t *row, const double *val,
                                              double sigma);
bool bench_eigen_llt_analyze(bench_eigen_llt_state *state);
bool bench_eigen_llt_factor(bench_eigen_llt_state *state);
bool bench_eigen_llt_solve(bench_eigen_llt_state *state, double *X, int32_t nrhs);
int64_t bench_eigen_llt_nnz(const bench_eigen_llt_state *state);

#ifdef __cplusplus
}
#endif

#endif
