/* One eigensolver run, measured and verified. */
#include "bench/eigen_worker.h"

#include "base/memory.h"

#include <math.h>
#include <string.h>

static double dot(int32_t n, const double *a, const double *b)
{
    double sum = 0.0;
    for (int32_t i = 0; i < n; i++) {
        sum += a[i] * b[i];
    }
    return sum;
}

/* Residuals and orthogonality, recomputed from what the solver left. */
static bool verify(const bench_matrix *m, const bench_eigen_solver *solver, void *state, bench_record *record)
{
    const int32_t n = m->A.ncols;
    const double *v[BENCH_MAX_PAIRS];
    double *Av = sl_alloc(n, sizeof *Av);
    for (int32_t k = 0; k < record->count; k++) {
        v[k] = solver->vector(state, k);
        if (Av == NULL || v[k] == NULL) {
            sl_free(Av);
            return false;
        }
        const double lambda = record->lambda[k], norm = sqrt(dot(n, v[k], v[k]));
        sl_csc_multiply_symmetric(&m->A, v[k], 1, Av);
        for (int32_t i = 0; i < n; i++) {
            Av[i] -= lambda * v[k][i];
        }
        const double residual = sqrt(dot(n, Av, Av)) / norm;
        record->residual = fmax(record->residual, residual / m->norm);
        if (k > 0) {
            record->relative = fmax(record->relative, residual / lambda);
        }
        for (int32_t j = 0; j <= k; j++) {
            record->orthogonality = fmax(record->orthogonality, fabs(dot(n, v[j], v[k]) - (j == k ? 1.0 : 0.0)));
        }
        record->ok = record->ok && isfinite(residual) && isfinite(lambda);
    }
    sl_free(Av);
    return true;
}

static void fail(bench_record *record, const char *why)
{
    record->ok = false;
    snprintf(record->message, sizeof record->message, "%s", why);
}

int bench_eigen_work(const bench_task *task, const bench_eigen_solver *solver)
{
    static bench_record record;
    bench_matrix matrix;
    if (!bench_map_matrix(task->descriptor, &matrix)) {
        fail(&record, "no matrix");
        return bench_send(&record);
    }
    record.n = matrix.A.ncols;
    record.count = task->pairs < record.n ? task->pairs : record.n;
    void *state = solver->prepare(&matrix, solver->name);
    if (state == NULL) {
        fail(&record, "could not be prepared");
        return bench_send(&record);
    }
    bench_eigen_run run = {.pairs = record.count,
                           .basis = task->basis,
                           .tolerance = task->tolerance,
                           .sigma = bench_shift(&matrix),
                           .signs = task->signs,
                           .lambda = record.lambda,
                           .error = "failed"};
    const bench_clock start = bench_start();
    record.ok = solver->solve(state, &run);
    record.total = bench_since(&start);
    record.solves = run.solves;
    record.nnz = run.nnz;
    record.certified = run.certified;
    if (!record.ok) {
        fail(&record, run.error);
    } else if (!verify(&matrix, solver, state, &record)) {
        fail(&record, "no memory to verify");
    }
    return bench_send(&record);
}
