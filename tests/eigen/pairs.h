/* Solving for pairs and checking that they are sound. */
#ifndef SL_TEST_EIGEN_PAIRS_H
#define SL_TEST_EIGEN_PAIRS_H

#include "eigen/lanczos.h"
#include "graphs.h"

#include <cblas.h>

static inline int one_blas_thread(void **state)
{
    (void)state;
    openblas_set_num_threads(1);
    return 0;
}

typedef struct pairs {
    int32_t n, count;
    double *lambda, *vectors, *residual;
    sl_lanczos_info info;
} pairs;

static inline pairs pairs_of(const sl_csc *A, const sl_lanczos_def *def)
{
    const int32_t n = A->ncols, count = def->count < n ? def->count : n;
    pairs p = {.n = n, .count = count};
    p.lambda = sl_alloc(count, sizeof *p.lambda);
    p.vectors = sl_alloc((int64_t)n * count, sizeof *p.vectors);
    p.residual = sl_alloc(count, sizeof *p.residual);
    assert_true(p.lambda && p.vectors && p.residual);
    assert_int_equal(sl_lanczos_solve(A, def, NULL, p.lambda, p.vectors, p.residual, &p.info), SL_OK);
    return p;
}

static inline void pairs_clear(pairs *p)
{
    sl_free(p->lambda);
    sl_free(p->vectors);
    sl_free(p->residual);
}

static inline double norm1(const sl_csc *A)
{
    double *sum = sl_calloc(A->ncols, sizeof *sum), norm = 0.0;
    assert_non_null(sum);
    for (int32_t j = 0; j < A->ncols; j++) {
        for (int64_t p = A->colptr[j]; p < A->colptr[j + 1]; p++) {
            sum[j] += fabs(A->val[p]);
            sum[A->row[p]] += A->row[p] != j ? fabs(A->val[p]) : 0.0;
        }
    }
    for (int32_t j = 0; j < A->ncols; j++) {
        norm = fmax(norm, sum[j]);
    }
    sl_free(sum);
    return norm;
}

static inline void assert_sign_rule(const double *x, int32_t n)
{
    double largest = 0.0;
    for (int32_t i = 0; i < n; i++) {
        largest = fmax(largest, fabs(x[i]));
    }
    int32_t first = 0;
    while (fabs(x[first]) < (1.0 - 1e-8) * largest) {
        first++;
    }
    assert_true(x[first] > 0.0);
}

static inline void assert_orthonormal(const pairs *p, double tolerance)
{
    for (int32_t k = 0; k < p->count; k++) {
        for (int32_t j = 0; j <= k; j++) {
            double dot = 0.0;
            for (int32_t i = 0; i < p->n; i++) {
                dot += p->vectors[(int64_t)p->n * k + i] * p->vectors[(int64_t)p->n * j + i];
            }
            assert_true(test_near(dot, j == k ? 1.0 : 0.0, tolerance));
        }
    }
}

/* Ascending, of the residuals reported and within the tolerance. */
static inline void assert_residuals(const sl_csc *A, const pairs *p, double tolerance)
{
    const int32_t n = p->n;
    const double norm = norm1(A);
    double *Y = sl_alloc(n, sizeof *Y), worst = 0.0;
    assert_non_null(Y);
    for (int32_t k = 0; k < p->count; k++) {
        const double *x = p->vectors + (int64_t)n * k;
        double squares = 0.0;
        sl_csc_multiply_symmetric(A, x, 1, Y);
        for (int32_t i = 0; i < n; i++) {
            squares += (Y[i] - p->lambda[k] * x[i]) * (Y[i] - p->lambda[k] * x[i]);
        }
        const double residual = sqrt(squares) / (norm > 0.0 ? norm : 1.0);
        assert_true(residual <= tolerance);
        assert_true(test_near(p->residual[k], residual, 1e-14));
        assert_true(k == 0 || p->lambda[k] >= p->lambda[k - 1]);
        assert_sign_rule(x, n);
        worst = fmax(worst, residual);
    }
    assert_true(p->info.converged);
    assert_int_equal(p->info.converged_count, p->count);
    assert_true(test_near(p->info.max_residual, worst, 1e-14));
    sl_free(Y);
}

static inline void assert_sound(const sl_csc *A, const pairs *p, double tolerance)
{
    assert_orthonormal(p, 1e-12);
    assert_residuals(A, p, tolerance);
}

static inline double *constant_vector(int32_t n)
{
    double *x = sl_alloc(n, sizeof *x);
    assert_non_null(x);
    for (int32_t i = 0; i < n; i++) {
        x[i] = 1.0 / sqrt(n);
    }
    return x;
}

#endif
