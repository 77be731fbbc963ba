/* What the two benches share: matrices in shared memory, workers that are measured, medians.
 * A worker is this same executable, started anew for each run, so that every solver begins with the same small memory
 * and the matrix already mapped; the clock and the peak count from there. */
#ifndef BENCH_BENCH_H
#define BENCH_BENCH_H

#include "sparse/csc.h"

#include <stdio.h>

enum { BENCH_MAX_PAIRS = 1000, BENCH_MAX_PHASES = 4, BENCH_MAX_RUNS = 100, BENCH_MAX_MESHES = 16 };

/* Command line. */
typedef struct bench_options {
    int64_t min_facets; /* of the generated series; default 0 */
    int64_t max_facets; /* default 300000 */
    int32_t runs;       /* default 3 */
    int32_t pairs;      /* default 30 */
    int32_t basis;      /* columns of the libraries' bases; 0 = the default, see README.md */
    bool signs;         /* also at ||L v - lambda v|| <= 2e-3 lambda */
    bool all;           /* drop no solver that fell far behind at the size before */
    int32_t timeout;    /* seconds a worker may take; default 1800 */
    const char *csv;    /* NULL = none */
    const char *only;   /* comma-separated solver names; NULL = all */
    const char *mesh[BENCH_MAX_MESHES];
    int32_t meshes;
    bool generated; /* the generated series: default when no mesh is given */
} bench_options;

/* False after a message when the command line makes no sense. */
bool bench_parse_options(int argc, char **argv, const char *name, bench_options *options);

/* True when name is in options->only. */
bool bench_wanted(const bench_options *options, const char *name);

/* One matrix of a series: a facet-graph Laplacian and the facets' centroids. */
typedef struct bench_case {
    const char *mesh; /* "generated" or the file's name; borrowed */
    const char *path; /* NULL = generated */
    int32_t base;     /* generated: facets wished for before subdividing */
    int32_t levels;   /* 1-to-4 subdivisions */
    int64_t max_facets;
} bench_case;

/* The matrices asked for, at most capacity; of a mesh given the sizes are known only once it is read. Returns their
 * number. */
int32_t bench_list_cases(const bench_options *options, bench_case *cases, int32_t capacity);

enum { BENCH_NO_MATRIX = -1, BENCH_TOO_LARGE = -2 };

/* Builds the matrix in a process of its own. A descriptor of shared memory that workers inherit; BENCH_TOO_LARGE when
 * it has over max_facets, BENCH_NO_MATRIX after a message. */
int bench_make_matrix(const bench_case *which);

/* A matrix in shared memory. */
typedef struct bench_matrix {
    sl_csc A;          /* D - A, lower triangle; borrowed from the mapping */
    const double *xyz; /* n x 3 */
    double norm;       /* ||A||_1 */
    void *map;
    size_t bytes;
} bench_matrix;

/* Maps the matrix, reads all of it. False when the descriptor holds none. */
bool bench_map_matrix(int descriptor, bench_matrix *out);
void bench_unmap_matrix(bench_matrix *matrix);

/* The shift of every shift-invert run and the matrix of the Cholesky bench: A - sigma I with sigma = -1 / (4 n), which
 * lies below 0 by less than the first gap of a closed surface. */
double bench_shift(const bench_matrix *matrix);

typedef struct bench_usage {
    double cpu, wall; /* seconds; user and system time of all threads */
    int64_t peak;     /* bytes above the start, the highest since then */
} bench_usage;

typedef struct bench_clock {
    double cpu, wall;
    int64_t resident;
} bench_clock;

bench_clock bench_start(void);
bench_usage bench_since(const bench_clock *start);

/* What a worker sends back. */
typedef struct bench_record {
    bool ok;
    bool certified;
    char message[120]; /* why not ok */
    bench_usage total;
    bench_usage phase[BENCH_MAX_PHASES];
    int32_t n, count, solves;
    int64_t nnz;          /* of the factor */
    double residual;      /* largest ||A v - lambda v|| / ||A||_1, or of a linear system */
    double relative;      /* largest ||A v - lambda v|| / lambda over lambda > 0 */
    double orthogonality; /* largest |v_i' v_j - delta_ij| */
    double lambda[BENCH_MAX_PAIRS];
} bench_record;

/* What a worker is told. */
typedef struct bench_task {
    char solver[40];
    int descriptor;
    int32_t pairs, basis;
    double tolerance; /* the solver's own */
    bool signs;
    int32_t timeout;
} bench_task;

/* One thread for every BLAS of the workers started from now on. */
void bench_limit_threads(void);

/* Runs the task in a fresh process and waits. record->ok is false when it crashed, ran too long or failed. */
void bench_run_worker(const bench_task *task, bench_record *record);

/* In main: true when this process is a worker; task is filled in. */
bool bench_is_worker(int argc, char **argv, bench_task *task);

/* Sends the record to the process that started this one. */
int bench_send(const bench_record *record);

typedef struct bench_summary {
    double median, least, most;
} bench_summary;

bench_summary bench_summarise(const double *value, int32_t count);

#endif
