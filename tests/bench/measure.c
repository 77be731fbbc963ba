/* Workers, their clocks, and the medians of what they report. */
#define _GNU_SOURCE
#include "bench/bench.h"

#include <fcntl.h>
#include <malloc.h>
#include <signal.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

enum { REPLY = 200 }; /* the worker's end of the pipe: a descriptor that nothing else has */

/* A line "VmHWM:  1234 kB" of /proc/self/status, in bytes. Unlike ru_maxrss it starts anew with each exec. */
static int64_t memory_field(const char *field)
{
    FILE *file = fopen("/proc/self/status", "r");
    if (file == NULL) {
        return 0;
    }
    char line[256];
    int64_t bytes = 0;
    while (fgets(line, sizeof line, file) != NULL) {
        if (strncmp(line, field, strlen(field)) == 0) {
            bytes = 1024 * strtoll(line + strlen(field), NULL, 10);
        }
    }
    fclose(file);
    return bytes;
}

static double seconds(clockid_t clock)
{
    struct timespec t;
    clock_gettime(clock, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

/* The MPI library that SLEPc brings in tells malloc, as soon as it is loaded, never to give memory back to the system.
 * No solver but SLEPc has it loaded in its own use: the defaults of mallopt(3) again, for all. */
static void reset_malloc(void)
{
    mallopt(M_MMAP_MAX, 65536);
    mallopt(M_MMAP_THRESHOLD, 128 * 1024);
    mallopt(M_TRIM_THRESHOLD, 128 * 1024);
    mallopt(M_TOP_PAD, 128 * 1024);
}

bench_clock bench_start(void)
{
    reset_malloc();
    return (bench_clock){
        .cpu = seconds(CLOCK_PROCESS_CPUTIME_ID), .wall = seconds(CLOCK_MONOTONIC), .resident = memory_field("VmRSS:")};
}

bench_usage bench_since(const bench_clock *start)
{
    return (bench_usage){.cpu = seconds(CLOCK_PROCESS_CPUTIME_ID) - start->cpu,
                         .wall = seconds(CLOCK_MONOTONIC) - start->wall,
                         .peak = memory_field("VmHWM:") - start->resident};
}

void bench_limit_threads(void)
{
    setenv("OPENBLAS_NUM_THREADS", "1", 1);
    setenv("OMP_NUM_THREADS", "1", 1);
}

static void start_worker(const bench_task *task, int reply)
{
    char descriptor[16], pairs[16], basis[16], tolerance[32], timeout[16];
    snprintf(descriptor, sizeof descriptor, "%d", task->descriptor);
    snprintf(pairs, sizeof pairs, "%d", (int)task->pairs);
    snprintf(basis, sizeof basis, "%d", (int)task->basis);
    snprintf(tolerance, sizeof tolerance, "%.17g", task->tolerance);
    snprintf(timeout, sizeof timeout, "%d", (int)task->timeout);
    dup2(reply, REPLY);
    execl("/proc/self/exe", "bench-worker", "--worker", task->solver, descriptor, pairs, basis, tolerance,
          task->signs ? "1" : "0", timeout, (char *)NULL);
    _exit(127);
}

void bench_run_worker(const bench_task *task, bench_record *record)
{
    int ends[2];
    memset(record, 0, sizeof *record);
    snprintf(record->message, sizeof record->message, "did not start");
    if (pipe2(ends, O_CLOEXEC) != 0) {
        return;
    }
    fflush(NULL);
    const pid_t child = fork();
    if (child == 0) {
        start_worker(task, ends[1]);
    }
    close(ends[1]);
    size_t have = 0;
    for (ssize_t got = 1; child > 0 && got > 0 && have<sizeof *record; have += got> 0 ? (size_t)got : 0) {
        got = read(ends[0], (char *)record + have, sizeof *record - have);
    }
    close(ends[0]);
    int how = 0;
    if (child > 0) {
        waitpid(child, &how, 0);
    }
    if (have != sizeof *record) {
        memset(record, 0, sizeof *record);
        snprintf(record->message, sizeof record->message, "%s %d",
                 WIFSIGNALED(how) ? "ended by signal" : "ended with exit code",
                 WIFSIGNALED(how) ? WTERMSIG(how) : WEXITSTATUS(how));
    }
}

bool bench_is_worker(int argc, char **argv, bench_task *task)
{
    if (argc != 9 || strcmp(argv[1], "--worker") != 0) {
        return false;
    }
    *task = (bench_task){.descriptor = atoi(argv[3]),
                         .pairs = atoi(argv[4]),
                         .basis = atoi(argv[5]),
                         .tolerance = strtod(argv[6], NULL),
                         .signs = argv[7][0] == '1',
                         .timeout = atoi(argv[8])};
    snprintf(task->solver, sizeof task->solver, "%s", argv[2]);
    alarm((unsigned)task->timeout);
    return true;
}

int bench_send(const bench_record *record)
{
    const char *at = (const char *)record;
    for (size_t left = sizeof *record; left > 0;) {
        const ssize_t written = write(REPLY, at, left);
        if (written <= 0) {
            return 1;
        }
        at += written;
        left -= (size_t)written;
    }
    return 0;
}

static int ascending(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

bench_summary bench_summarise(const double *value, int32_t count)
{
    double sorted[BENCH_MAX_RUNS];
    if (count == 0) {
        return (bench_summary){0};
    }
    memcpy(sorted, value, (size_t)count * sizeof *sorted);
    qsort(sorted, (size_t)count, sizeof *sorted, ascending);
    return (bench_summary){0.5 * (sorted[(count - 1) / 2] + sorted[count / 2]), sorted[0], sorted[count - 1]};
}
