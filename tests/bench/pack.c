/* tests/bench/pack: atlases of any tool packed anew; fill before and after, CPU time. See README.md. */
#define _POSIX_C_SOURCE 200809L
#include "atlas/repack.h"
#include "base/memory.h"
#include "meshio/meshfile.h"

#include <cblas.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

enum { RESOLUTION = 2048, MARGIN = 4 };

typedef struct totals {
    int32_t files, emptier;
    double before, after, seconds;
} totals;

static double cpu_seconds(void)
{
    struct timespec t;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

/* Fill by the definition of the comparison tables: covered texels of the UVs' bounding square. */
static sl_status bench_file(const char *path, const sl_repack_def *def, totals *sum)
{
    sl_status status = SL_OK;
    sl_diag diag = sl_diag_none();
    sl_meshfile *file = NULL;
    sl_polygons polygons;
    sl_atlas_measure before, after;
    sl_repacked repacked = {0};
    const char *name = strrchr(path, '/');
    SL_TRY(sl_meshfile_read(path, &file, &diag));
    SL_TRY(file->corner_uv != NULL ? SL_OK : SL_BAD_INPUT);
    sl_meshfile_polygons(file, &polygons);
    SL_TRY(sl_measure_atlas(&polygons, file->corner_uv, RESOLUTION, NULL, &before, &diag));
    const double start = cpu_seconds();
    SL_TRY(sl_repack(&polygons, file->corner_uv, NULL, def, NULL, &repacked, &diag));
    const double seconds = cpu_seconds() - start;
    SL_TRY(sl_measure_shared(&polygons, repacked.corner_uv, &repacked.table, RESOLUTION, NULL, &after, &diag));
    printf("%-30s %6d %7.4f %7.4f %8.2f %6d  %s\n", name != NULL ? name + 1 : path, repacked.charts, before.fill,
           after.fill, seconds, repacked.pack.attempts, repacked.passed ? "certified" : "FAILED");
    fflush(stdout);
    sum->files++;
    sum->emptier += after.fill < before.fill;
    sum->before += before.fill;
    sum->after += after.fill;
    sum->seconds += seconds;
cleanup:
    if (status != SL_OK) {
        fprintf(stderr, "%s: %s %s\n", path, sl_status_name(status), diag.reason);
    }
    sl_repacked_clear(&repacked);
    sl_meshfile_free(file);
    return status;
}

/* pack EFFORT FILE...: on one thread, at 2048 x 2048 texels with a margin of 4. */
int main(int argc, char **argv)
{
    sl_repack_def def = sl_repack_default();
    totals sum = {0};
    sl_status status = SL_OK;
    if (argc < 3) {
        fprintf(stderr, "usage: pack EFFORT FILE...\n");
        return 2;
    }
    openblas_set_num_threads(1);
    def.pack.effort = atoi(argv[1]) < 0 ? 0 : atoi(argv[1]) > 12 ? 12 : atoi(argv[1]);
    def.pack.resolution = RESOLUTION;
    def.pack.margin = MARGIN;
    printf("effort %d, %d x %d texels, margin %d\n%-30s %6s %7s %7s %8s %6s\n", def.pack.effort, RESOLUTION, RESOLUTION,
           MARGIN, "atlas", "charts", "before", "after", "CPU s", "tries");
    for (int i = 2; i < argc && status == SL_OK; i++) {
        status = bench_file(argv[i], &def, &sum);
    }
    if (status == SL_OK) {
        printf("%-30s %6s %7.4f %7.4f %8.2f   emptier than before: %d\n", "mean", "", sum.before / sum.files,
               sum.after / sum.files, sum.seconds / sum.files, sum.emptier);
    }
    return status == SL_OK ? 0 : 1;
}
