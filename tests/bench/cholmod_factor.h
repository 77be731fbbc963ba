/* CHOLMOD behind three calls, for the solvers that need a factor. */
#ifndef BENCH_CHOLMOD_FACTOR_H
#define BENCH_CHOLMOD_FACTOR_H

#include <stdbool.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct bench_cholmod bench_cholmod;

/* The lower triangle, borrowed but for the diagonal: A - sigma I is stored at once. how: a name that contains "amd" or
 * "metis" and may contain "simplicial". NULL = failure. Part of preparing: the matrix in CHOLMOD's format. */
bench_cholmod *bench_cholmod_create(int32_t n, const int64_t *colptr, const int32_t *row, const double *val,
                                    double sigma, const char *how);
bool bench_cholmod_order(bench_cholmod *c);
bool bench_cholmod_analyze(bench_cholmod *c); /* with the ordering found */
bool bench_cholmod_factorize(bench_cholmod *c);
int64_t bench_cholmod_nnz(const bench_cholmod *c);

/* y = inv(A - sigma I) x, one right-hand side. */
bool bench_cholmod_apply(bench_cholmod *c, const double *x, double *y);

/* X = inv(A - sigma I) X, column-major. */
bool bench_cholmod_solve(bench_cholmod *c, double *X, int32_t nrhs);

#ifdef __cplusplus
}
#endif

#endif
