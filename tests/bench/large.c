/* What the best atlas of a large mesh costs, by stage.
 *
 *     large_bench MESH...
 *
 * On one thread, symmetry off, the default targets: facets, CPU seconds, peak memory, charts, seam length over the
 * diagonal of the box, L2, mean s1/s2, and the seconds of every stage that reports its progress, the reading not
 * counted. */
#include "atlas/atlas.h"
#include "atlas/measure.h"
#include "meshio/meshfile.h"

#include <stdio.h>
#include <string.h>
#include <sys/resource.h>
#include <time.h>

void openblas_set_num_threads(int count);

enum { RESOLUTION = 2048, MOST_STAGES = 32 };

typedef struct stages {
    const char *name[MOST_STAGES];
    double seconds[MOST_STAGES];
    int count, at; /* at: the one that runs */
    double since;
} stages;

static double cpu_seconds(void)
{
    struct timespec t;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

/* The time since the last report belongs to the stage that made it. */
static bool on_progress(void *user, const char *stage, double fraction)
{
    stages *s = user;
    const double now = cpu_seconds();
    int k = 0;
    (void)fraction;
    s->seconds[s->at] += now - s->since;
    s->since = now;
    while (k < s->count && strcmp(s->name[k], stage) != 0) {
        k++;
    }
    if (k == s->count && k < MOST_STAGES) {
        s->name[s->count++] = stage;
    }
    s->at = k < MOST_STAGES ? k : MOST_STAGES - 1;
    return true;
}

static void print_row(const char *path, const sl_polygons *polygons, double seconds, const sl_atlas *atlas,
                      const sl_atlas_measure *m, const stages *s)
{
    struct rusage usage;
    const char *name = strrchr(path, '/');
    getrusage(RUSAGE_SELF, &usage);
    printf("%-24s %8d facets %7.1f s %5.2f GB  %d charts seams %.3f L2 %.4f angle %.3f fill %.2f %s\n",
           name != NULL ? name + 1 : path, polygons->nf, seconds, (double)usage.ru_maxrss / 0x1p20, m->charts,
           m->seam_length, m->global.l2, m->global.angle_mean, m->fill, atlas->check.passed ? "proven" : "NOT PROVEN");
    for (int k = 0; k < s->count; k++) {
        printf("    %-16s %7.2f s\n", s->name[k], s->seconds[k]);
    }
    fflush(stdout);
}

static sl_status run(const char *path)
{
    sl_status status = SL_OK;
    sl_diag diag = sl_diag_none();
    sl_meshfile *file = NULL;
    sl_polygons polygons;
    sl_atlas *atlas = NULL;
    sl_atlas_measure m;
    sl_atlas_def def = sl_atlas_default();
    stages s = {.name = {"start"}, .count = 1};
    const sl_context context = {.progress = on_progress, .progress_user = &s};
    def.best = true;
    def.optimize = sl_optimize_default();
    def.segment.symmetry = SL_SYMMETRY_USE_OFF;
    SL_TRY(sl_meshfile_read(path, &file, &diag));
    sl_meshfile_polygons(file, &polygons);
    const double start = s.since = cpu_seconds();
    SL_TRY(sl_unwrap(&polygons, &def, &context, &atlas, &diag));
    (void)on_progress(&s, "start", 1.0);
    const double seconds = cpu_seconds() - start;
    SL_TRY(sl_measure_atlas(&polygons, atlas->input_corner_uv, RESOLUTION, NULL, &m, &diag));
    print_row(path, &polygons, seconds, atlas, &m, &s);
cleanup:
    if (status != SL_OK) {
        fprintf(stderr, "%s: %s %s\n", path, sl_status_name(status), diag.reason);
    }
    sl_atlas_free(atlas);
    sl_meshfile_free(file);
    return status;
}

int main(int argc, char **argv)
{
    int failed = argc < 2;
    openblas_set_num_threads(1);
    for (int a = 1; a < argc; a++) {
        failed |= run(argv[a]) != SL_OK;
    }
    return failed;
}
