/* tests/bench/cholesky: our sparse Cholesky against the libraries', phase by phase. See README.md. */
#include "base/memory.h"
#include "base/rng.h"
#include "bench/solvers.h"

#include <math.h>
#include <string.h>
#include <unistd.h>

enum { MAX_SOLVERS = 12, MAX_CASES = 64, RIGHT_SIDES = 64 };
enum { ORDER, ANALYZE, FACTOR, SOLVE };

static const double RESIDUAL = 1e-13; /* ||A x - b|| <= RESIDUAL ||A||_1 ||x|| */

typedef struct entry {
    const bench_cholesky_solver *solver;
    bool ok;
    int32_t runs;
    double phase[BENCH_MAX_PHASES][BENCH_MAX_RUNS]; /* CPU s */
    double wall[BENCH_MAX_PHASES][BENCH_MAX_RUNS];
    double work[BENCH_MAX_RUNS]; /* factor + solve, CPU s */
    double all[BENCH_MAX_RUNS];  /* all four */
    double peak[BENCH_MAX_RUNS];
    bench_record last;
} entry;

static const bench_cholesky_solver *const all_solvers[] = {
    bench_ours_cholesky,
#ifdef HAVE_CHOLMOD
    bench_cholmod_solvers,
#endif
#ifdef HAVE_SPECTRA
    bench_eigen_llt,
#endif
};

/* The residual of one right-hand side; b is made anew, so that no copy of all of them counts as memory. */
static void right_side(int32_t n, int32_t k, double *b)
{
    sl_rng rng = sl_rng_seed(77u + (uint64_t)k);
    for (int32_t i = 0; i < n; i++) {
        b[i] = sl_rng_uniform(&rng) - 0.5;
    }
}

static double residual(const bench_matrix *m, double sigma, const double *x, int32_t k, double *b, double *Ax)
{
    const int32_t n = m->A.ncols;
    double r = 0.0, size = 0.0;
    right_side(n, k, b);
    sl_csc_multiply_symmetric(&m->A, x, 1, Ax);
    for (int32_t i = 0; i < n; i++) {
        const double d = Ax[i] - sigma * x[i] - b[i];
        r += d * d;
        size += x[i] * x[i];
    }
    return sqrt(r / size) / m->norm;
}

static const char *measure(const bench_matrix *m, const bench_cholesky_solver *solver, bench_record *record)
{
    const int32_t n = m->A.ncols;
    const double sigma = bench_shift(m);
    double *X = sl_alloc((int64_t)n * RIGHT_SIDES, sizeof *X);
    void *state = solver->prepare(m, solver->name, sigma);
    if (X == NULL || state == NULL) {
        return "could not be prepared";
    }
    for (int32_t k = 0; k < RIGHT_SIDES; k++) {
        right_side(n, k, X + (int64_t)k * n);
    }
    bool (*const phase[])(void *) = {solver->order, solver->analyze, solver->factor};
    for (int p = 0; p < SOLVE; p++) {
        const bench_clock start = bench_start();
        if (!phase[p](state)) {
            return "failed";
        }
        record->phase[p] = bench_since(&start);
        record->phase[p].peak += start.resident;
    }
    record->nnz = solver->nnz(state);
    const bench_clock start = bench_start();
    const bool solved = solver->solve(state, X, RIGHT_SIDES);
    record->phase[SOLVE] = bench_since(&start);
    record->phase[SOLVE].peak += start.resident;
    double *b = sl_alloc(n, sizeof *b), *Ax = sl_alloc(n, sizeof *Ax);
    if (!solved || b == NULL || Ax == NULL) {
        return "no solution";
    }
    for (int32_t k = 0; k < RIGHT_SIDES; k += 21) {
        record->residual = fmax(record->residual, residual(m, sigma, X + (int64_t)k * n, k, b, Ax));
    }
    record->ok = record->residual <= RESIDUAL;
    return record->ok ? "" : "residual too large";
}

static int work(const bench_task *task)
{
    static bench_record record;
    bench_matrix matrix;
    const char *message = "no such solver";
    if (!bench_map_matrix(task->descriptor, &matrix)) {
        message = "no matrix";
    } else {
        record.n = matrix.A.ncols;
        for (size_t s = 0; s < SL_COUNTOF(all_solvers); s++) {
            for (const bench_cholesky_solver *at = all_solvers[s]; at->name != NULL; at++) {
                if (strcmp(at->name, task->solver) == 0) {
                    const bench_clock start = bench_start();
                    message = measure(&matrix, at, &record);
                    record.total = bench_since(&start);
                    /* The right-hand sides and the matrix are everybody's; what comes on top is the solver's. */
                    record.total.peak = record.phase[SOLVE].peak - start.resident -
                                        (int64_t)record.n * RIGHT_SIDES * (int64_t)sizeof(double);
                }
            }
        }
    }
    snprintf(record.message, sizeof record.message, "%s", message);
    return bench_send(&record);
}

static void run_once(const bench_options *options, entry *e, int descriptor)
{
    bench_task task = {.descriptor = descriptor, .pairs = 1, .timeout = options->timeout};
    snprintf(task.solver, sizeof task.solver, "%s", e->solver->name);
    bench_run_worker(&task, &e->last);
    e->ok = e->last.ok;
    const int32_t r = e->runs++;
    for (int p = 0; p < BENCH_MAX_PHASES; p++) {
        e->phase[p][r] = e->last.phase[p].cpu;
        e->wall[p][r] = e->last.phase[p].wall;
    }
    e->work[r] = e->phase[FACTOR][r] + e->phase[SOLVE][r];
    e->all[r] = e->work[r] + e->phase[ORDER][r] + e->phase[ANALYZE][r];
    e->peak[r] = (double)e->last.total.peak;
}

static double median(const double *value, const entry *e)
{
    return bench_summarise(value, e->runs).median;
}

static void print_entry(const entry *e, const bench_case *which, FILE *csv)
{
    if (!e->ok) {
        printf("%-26s %s\n", e->solver->name, e->last.message);
        return;
    }
    const bench_summary w = bench_summarise(e->work, e->runs);
    printf("%-26s %9.3f %9.3f %9.3f %9.3f %9.3f %8.3f .. %7.3f %9.3f %9.1f %8.2f %9.1e\n", e->solver->name,
           median(e->phase[ORDER], e), median(e->phase[ANALYZE], e), median(e->phase[FACTOR], e),
           median(e->phase[SOLVE], e), w.median, w.least, w.most,
           median(e->wall[FACTOR], e) + median(e->wall[SOLVE], e), median(e->peak, e) / 1e6, (double)e->last.nnz / 1e6,
           e->last.residual);
    if (csv != NULL) {
        fprintf(csv, "%s,%d,%s,%d,%.6g,%.6g,%.6g,%.6g,%.6g,%.6g,%.6g,%.6g,%.0f,%lld,%.3g\n", which->mesh,
                (int)e->last.n, e->solver->name, (int)e->runs, median(e->phase[ORDER], e), median(e->phase[ANALYZE], e),
                median(e->phase[FACTOR], e), median(e->phase[SOLVE], e), w.median, w.least, w.most, median(e->all, e),
                median(e->peak, e), (long long)e->last.nnz, e->last.residual);
        fflush(csv);
    }
}

static const entry *best_library(const entry *entries, int32_t count, size_t offset)
{
    const entry *best = NULL;
    for (int32_t i = 0; i < count; i++) {
        const entry *e = &entries[i];
        if (e->ok && !e->solver->ours &&
            (best == NULL || median((const double *)(const void *)((const char *)e + offset), e) <
                                 median((const double *)(const void *)((const char *)best + offset), best))) {
            best = e;
        }
    }
    return best;
}

/* The best library's runs over ours, run by run; the value stands at `offset` in an entry. */
static void print_ratio(const char *what, const entry *entries, int32_t count, size_t offset)
{
    const entry *library = best_library(entries, count, offset);
    if (library == NULL || !entries[0].solver->ours || !entries[0].ok) {
        return;
    }
    const double *theirs = (const double *)(const void *)((const char *)library + offset);
    const double *mine = (const double *)(const void *)((const char *)entries + offset);
    double ratio[BENCH_MAX_RUNS];
    for (int32_t r = 0; r < library->runs; r++) {
        ratio[r] = theirs[r] / fmax(mine[r], 1e-9);
    }
    const bench_summary s = bench_summarise(ratio, library->runs);
    printf("  %-26s ratio %6.2f  (%.2f .. %.2f)  %s\n", what, s.median, s.least, s.most, library->solver->name);
}

static void run_case(const bench_options *options, const bench_case *which, int descriptor, FILE *csv)
{
    static entry entries[MAX_SOLVERS];
    int32_t count = 0;
    memset(entries, 0, sizeof entries);
    for (size_t s = 0; s < SL_COUNTOF(all_solvers); s++) {
        for (const bench_cholesky_solver *at = all_solvers[s]; at->name != NULL && count < MAX_SOLVERS; at++) {
            if (options->only != NULL ? bench_wanted(options, at->name) : !at->optional) {
                entries[count++].solver = at;
            }
        }
    }
    for (int32_t run = 0; run < options->runs; run++) {
        for (int32_t i = 0; i < count; i++) {
            if (run == 0 || entries[i].ok) {
                run_once(options, &entries[i], descriptor);
            }
        }
    }
    printf("\n%s, %d facets, %d right-hand sides; CPU s\n", which->mesh, (int)entries[0].last.n, (int)RIGHT_SIDES);
    printf("%-26s %9s %9s %9s %9s %9s %19s %9s %9s %8s %9s\n", "solver", "order", "analyze", "factor", "solve",
           "fac+sol", "min .. max", "wall", "peak MB", "nnz(L) M", "residual");
    for (int32_t i = 0; i < count; i++) {
        print_entry(&entries[i], which, csv);
    }
    print_ratio("factor + solve", entries, count, offsetof(entry, work));
    print_ratio("factor", entries, count, offsetof(entry, phase) + FACTOR * sizeof entries[0].phase[0]);
    print_ratio("solve", entries, count, offsetof(entry, phase) + SOLVE * sizeof entries[0].phase[0]);
    print_ratio("order to solve", entries, count, offsetof(entry, all));
    print_ratio("memory", entries, count, offsetof(entry, peak));
    fflush(stdout);
}

int main(int argc, char **argv)
{
    static bench_case cases[MAX_CASES];
    bench_task task;
    bench_options options;
    if (bench_is_worker(argc, argv, &task)) {
        return work(&task);
    }
    if (!bench_parse_options(argc, argv, "tests/bench/cholesky", &options)) {
        return 2;
    }
    bench_limit_threads();
    FILE *csv = options.csv != NULL ? fopen(options.csv, "w") : NULL;
    if (options.csv != NULL && csv == NULL) {
        perror(options.csv);
        return 1;
    }
    if (csv != NULL) {
        fprintf(csv, "mesh,n,solver,runs,order,analyze,factor,solve,work,work_min,work_max,all,peak,nnz,residual\n");
    }
    const int32_t count = bench_list_cases(&options, cases, MAX_CASES);
    for (int32_t c = 0; c < count; c++) {
        const int descriptor = bench_make_matrix(&cases[c]);
        if (descriptor >= 0) {
            run_case(&options, &cases[c], descriptor, csv);
            close(descriptor);
        }
    }
    if (csv != NULL) {
        fclose(csv);
    }
    return 0;
}
