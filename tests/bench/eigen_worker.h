/* One eigensolver run, measured and verified. */
#ifndef BENCH_EIGEN_WORKER_H
#define BENCH_EIGEN_WORKER_H

#include "bench/solvers.h"

/* Runs the task and sends the record; the process's exit code. */
int bench_eigen_work(const bench_task *task, const bench_eigen_solver *solver);

#endif
