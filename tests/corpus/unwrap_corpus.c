/* Unwraps whole meshes and judges the results by other code than the pipeline's own check:
 *
 *     every facet in exactly one chart; no flipped triangle (measure, after the repair's reorientation); no texel hit
 *     twice at 4096^2 (measure, chart by chart); the worst chart within the stretch asked for, or named by a warning;
 *     the same bytes for every number of threads given, UVs and sidecar, and again as read back from the file
 *
 *     unwrap_corpus [--generated] [--threads 1,2] [--runs N] [--symmetry off|auto|both] [--preset fast|best]
 *                   [FOLDER|FILE ...]
 *
 * Every mesh twice (--symmetry both, the default): without sharing, no overlap at all; with what symmetry allows, none
 * that the sidecar, as read back, does not declare.
 *
 * A line a mesh; the last line is "N passed, N failed". */
#define _POSIX_C_SOURCE 200809L
#include "atlas/measure.h"
#include "atlas/sidecar.h"
#include "base/memory.h"
#include "generators.h"
#include "meshio/meshfile.h"

#include <cblas.h>
#include <dirent.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

enum { MAX_THREAD_COUNTS = 8, MAX_MESHES = 512, OVERLAP_RESOLUTION = 4096 };

typedef struct corpus_options {
    int32_t threads[MAX_THREAD_COUNTS], thread_counts, runs;
    bool off, automatic, best;
    char scratch[512];
} corpus_options;

/* What is compared between runs. */
typedef struct run_result {
    double *uv;
    char *sidecar;
    int32_t charts;
    double seconds;
} run_result;

static double cpu_seconds(void)
{
    struct timespec t;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

/* Writes why into text and returns false. */
static bool bad(char *text, size_t size, const char *format, ...) SL_PRINTF(3, 4);

static bool bad(char *text, size_t size, const char *format, ...)
{
    va_list args;
    va_start(args, format);
    vsnprintf(text, size, format, args);
    va_end(args);
    return false;
}

/* Every facet in exactly one chart, chart lists and labels agree. */
static bool charts_partition_facets(const sl_atlas *atlas, char *why, size_t size)
{
    const sl_segmentation *seg = atlas->segmentation;
    int64_t listed = 0;
    for (int32_t c = 0; c < seg->nchart; c++) {
        for (int32_t i = seg->chart[c].first; i < seg->chart[c].first + seg->chart[c].count; i++) {
            listed++;
            if (seg->face_chart[seg->face[i]] != c || (i > seg->chart[c].first && seg->face[i - 1] >= seg->face[i])) {
                return bad(why, size, "facet %d is not where chart %d lists it", seg->face[i], c);
            }
        }
    }
    return listed == atlas->mesh->nf || bad(why, size, "%lld facets in charts", (long long)listed);
}

/* A chart above the bound must be named by a warning. */
static bool stretch_within_bound(const sl_atlas *atlas, double bound, char *why, size_t size)
{
    for (int32_t c = 0; c < atlas->segmentation->nchart; c++) {
        bool warned = false;
        for (int32_t k = 0; k < atlas->nwarning; k++) {
            warned |= atlas->warning[k].chart == c;
        }
        const double l2 = atlas->segmentation->chart[c].flat.distortion.l2;
        if (!warned && atlas->segmentation->chart[c].count > 1 && !(l2 <= bound)) {
            return bad(why, size, "chart %d has L2 %g and no warning", c, l2);
        }
    }
    return true;
}

/* What the sidecar says of sharing, by way of a file. */
static sl_status reread_sharing(const corpus_options *o, const sl_atlas *atlas, const sl_atlas_def *def,
                                sl_sharing_table *table, sl_diag *diag)
{
    char path[600];
    snprintf(path, sizeof path, "%s/out.atlas.json", o->scratch);
    sl_status status = sl_sidecar_write(path, atlas, def, diag);
    if (status == SL_OK) {
        status = sl_sidecar_read(path, atlas->mesh->nf, table, diag);
    }
    unlink(path);
    return status;
}

static bool measures_well(const corpus_options *o, const sl_polygons *polygons, const sl_atlas *atlas,
                          const sl_atlas_def *def, const sl_context *context, sl_atlas_measure *m, char *why,
                          size_t size)
{
    sl_diag diag = sl_diag_none();
    sl_sharing_table table = {0};
    sl_status status = SL_OK;
    const bool shares = def->segment.symmetry != SL_SYMMETRY_USE_OFF;
    if (shares) {
        status = reread_sharing(o, atlas, def, &table, &diag);
    }
    if (status == SL_OK) {
        status = sl_measure_shared(polygons, atlas->input_corner_uv, shares ? &table : NULL, OVERLAP_RESOLUTION,
                                   context, m, &diag);
    }
    sl_sharing_table_clear(&table);
    if (status != SL_OK) {
        return bad(why, size, "measure: %s %s", sl_status_name(status), diag.reason);
    }
    if (m->global.flipped > 0 || m->overlap_inside > 0.0 || m->overlap_across > 0.0) {
        return bad(why, size, "%d flipped, overlap %g inside, %g across", m->global.flipped, m->overlap_inside,
                   m->overlap_across);
    }
    if (m->copies != atlas->segmentation->sharing.copies || (m->copies > 0) != (m->shared > 0.0)) {
        return bad(why, size, "%d copies measured, %d made", m->copies, atlas->segmentation->sharing.copies);
    }
    return true;
}

/* judged: look at the result closely; a later run need only give the same bytes. */
static bool unwrap_once(const corpus_options *o, const sl_polygons *polygons, sl_symmetry_use symmetry, int32_t threads,
                        bool judged, run_result *result, char *why, size_t size)
{
    sl_atlas_def def = sl_atlas_default();
    sl_diag diag = sl_diag_none();
    sl_thread_pool *pool = NULL;
    sl_atlas *atlas = NULL;
    sl_atlas_measure m = {0};
    bool good = false;
    def.segment.symmetry = symmetry;
    def.best = o->best;
    if (sl_thread_pool_create(threads, &pool) != SL_OK) {
        return bad(why, size, "no threads");
    }
    const sl_context context = {.executor = sl_thread_pool_executor(pool)};
    const double start = cpu_seconds();
    sl_status status = sl_unwrap(polygons, &def, &context, &atlas, &diag);
    result->seconds = cpu_seconds() - start;
    if (status != SL_OK) {
        bad(why, size, "%s: %s", sl_status_name(status), diag.reason);
    } else if (!atlas->check.passed) {
        bad(why, size, "own check: %d flipped, %d degenerate, %d uncertified, %lld texels", atlas->check.flipped,
            atlas->check.degenerate, atlas->check.uncertified_charts, (long long)atlas->check.overlapping_texels);
    } else if (!judged || (charts_partition_facets(atlas, why, size) &&
                           stretch_within_bound(atlas, def.segment.flatten.max_stretch, why, size) &&
                           measures_well(o, polygons, atlas, &def, &context, &m, why, size))) {
        result->charts = atlas->segmentation->nchart;
        result->uv = sl_copy(atlas->input_corner_uv, atlas->mesh->nh, 2 * sizeof *result->uv);
        status = sl_sidecar_text(atlas, &def, &result->sidecar);
        good = result->uv != NULL && status == SL_OK;
        snprintf(why, size, "%4d charts  seams %6.2f  L2 %.3f worst %.3f  fill %.3f  %5.1f s  saved %.3f%s", m.charts,
                 m.seam_diagonal, m.chart_l2_mean, m.chart_l2_worst, m.fill, result->seconds,
                 atlas->segmentation->sharing.area, atlas->nwarning > 0 ? "  (warned)" : "");
    }
    sl_atlas_free(atlas);
    sl_thread_pool_free(pool);
    return good;
}

/* Written and read back, the UVs are the same doubles. */
static bool survives_the_file(const corpus_options *o, const sl_meshfile *file, const double *uv, char *why,
                              size_t size)
{
    char path[600];
    sl_diag diag = sl_diag_none();
    sl_meshfile *back = NULL;
    snprintf(path, sizeof path, "%s/out.%s", o->scratch, file->format == SL_FORMAT_PLY ? "ply" : "obj");
    bool good = sl_meshfile_write(path, file, uv, &diag) == SL_OK && sl_meshfile_read(path, &back, &diag) == SL_OK &&
                back->nf == file->nf && back->corner_uv != NULL &&
                memcmp(back->corner_uv, uv, 2 * (size_t)file->face_first[file->nf] * sizeof *uv) == 0;
    unlink(path);
    sl_meshfile_free(back);
    return good || bad(why, size, "UVs did not survive %s: %s", path, diag.reason);
}

static bool check_use(const corpus_options *o, const char *name, const sl_polygons *polygons, const sl_meshfile *file,
                      sl_symmetry_use symmetry)
{
    char why[256] = "", later[256];
    run_result first = {0};
    bool good = unwrap_once(o, polygons, symmetry, o->threads[0], true, &first, why, sizeof why);
    for (int32_t r = 1; good && r < o->runs * o->thread_counts; r++) {
        run_result again = {0};
        good = unwrap_once(o, polygons, symmetry, o->threads[r % o->thread_counts], false, &again, later, sizeof later);
        if (!good) {
            bad(why, sizeof why, "%s", later);
        } else if (memcmp(first.uv, again.uv, 2 * (size_t)polygons->face_first[polygons->nf] * sizeof *first.uv) != 0 ||
                   strcmp(first.sidecar, again.sidecar) != 0) {
            good = bad(why, sizeof why, "other bytes with %d threads", o->threads[r % o->thread_counts]);
        }
        sl_free(again.uv);
        sl_free(again.sidecar);
    }
    good = good && (file == NULL || survives_the_file(o, file, first.uv, why, sizeof why));
    printf("%-7s %-16s %-4s %8d facets  %s\n", good ? "ok" : "FAILED", name,
           symmetry == SL_SYMMETRY_USE_OFF ? "off" : "auto", polygons->nf, why);
    fflush(stdout);
    sl_free(first.uv);
    sl_free(first.sidecar);
    return good;
}

static bool check_mesh(const corpus_options *o, const char *name, const sl_polygons *polygons, const sl_meshfile *file)
{
    const bool off = !o->off || check_use(o, name, polygons, file, SL_SYMMETRY_USE_OFF);
    const bool automatic = !o->automatic || check_use(o, name, polygons, file, SL_SYMMETRY_USE_AUTO);
    return off && automatic;
}

static bool check_file(const corpus_options *o, const char *path)
{
    const char *slash = strrchr(path, '/');
    sl_diag diag = sl_diag_none();
    sl_meshfile *file = NULL;
    sl_polygons polygons;
    if (sl_meshfile_read(path, &file, &diag) != SL_OK) {
        printf("FAILED  %s: %s\n", path, diag.reason);
        return false;
    }
    sl_meshfile_polygons(file, &polygons);
    const bool good = check_mesh(o, slash != NULL ? slash + 1 : path, &polygons, file);
    sl_meshfile_free(file);
    return good;
}

static bool check_generator(const corpus_options *o, const sl_generator *generator)
{
    sl_generated *mesh = NULL;
    sl_polygons polygons;
    if (generator->make(1, 1, &mesh) != SL_OK) {
        printf("FAILED  %s: not generated\n", generator->name);
        return false;
    }
    sl_generated_polygons(mesh, &polygons);
    const bool good = check_mesh(o, generator->name, &polygons, NULL);
    sl_generated_free(mesh);
    return good;
}

static int compare_names(const void *a, const void *b)
{
    return strcmp(*(char *const *)a, *(char *const *)b);
}

static bool is_mesh_name(const char *name)
{
    const char *dot = strrchr(name, '.');
    return dot != NULL && (strcmp(dot, ".obj") == 0 || strcmp(dot, ".ply") == 0 || strcmp(dot, ".off") == 0);
}

/* The mesh files of a folder by name, or the file itself. Returns how many; names are owned by the caller. */
static int32_t list_meshes(const char *path, char **names)
{
    int32_t count = 0;
    DIR *dir = opendir(path);
    if (dir == NULL) {
        names[count++] = strdup(path);
        return count;
    }
    for (struct dirent *e = readdir(dir); e != NULL && count < MAX_MESHES; e = readdir(dir)) {
        if (is_mesh_name(e->d_name)) {
            char full[1024];
            snprintf(full, sizeof full, "%s/%.255s", path, e->d_name);
            names[count++] = strdup(full);
        }
    }
    closedir(dir);
    qsort(names, (size_t)count, sizeof *names, compare_names);
    return count;
}

static void parse_threads(corpus_options *o, const char *text)
{
    o->thread_counts = 0;
    for (const char *p = text; p != NULL && *p != '\0' && o->thread_counts < MAX_THREAD_COUNTS;) {
        const int n = atoi(p);
        o->threads[o->thread_counts++] = n > 0 ? n : 1;
        p = strchr(p, ',');
        p = p != NULL ? p + 1 : NULL;
    }
}

int main(int argc, char **argv)
{
    corpus_options o = {.threads = {1}, .thread_counts = 1, .runs = 1, .off = true, .automatic = true};
    int32_t passed = 0, failed = 0;
    bool generated = false;
    const char *base = getenv("TMPDIR");
    openblas_set_num_threads(1);
    snprintf(o.scratch, sizeof o.scratch, "%.400s/seamlab-corpus-XXXXXX", base != NULL ? base : "/tmp");
    if (mkdtemp(o.scratch) == NULL) {
        printf("no scratch folder %s\n0 passed, 1 failed\n", o.scratch);
        return 1;
    }
    for (int a = 1; a < argc; a++) {
        if (strcmp(argv[a], "--generated") == 0) {
            generated = true;
        } else if (strcmp(argv[a], "--threads") == 0 && a + 1 < argc) {
            parse_threads(&o, argv[++a]);
        } else if (strcmp(argv[a], "--runs") == 0 && a + 1 < argc) {
            o.runs = atoi(argv[++a]);
        } else if (strcmp(argv[a], "--preset") == 0 && a + 1 < argc) {
            o.best = strcmp(argv[++a], "best") == 0;
        } else if (strcmp(argv[a], "--symmetry") == 0 && a + 1 < argc) {
            o.off = strcmp(argv[++a], "auto") != 0;
            o.automatic = strcmp(argv[a], "off") != 0;
        }
    }
    int32_t generators = 0;
    const sl_generator *generator = sl_generators(&generators);
    for (int32_t k = 0; generated && k < generators; k++) {
        const bool good = check_generator(&o, &generator[k]);
        passed += good;
        failed += !good;
    }
    for (int a = 1; a < argc; a++) {
        if (strcmp(argv[a], "--threads") == 0 || strcmp(argv[a], "--runs") == 0 || strcmp(argv[a], "--symmetry") == 0 ||
            strcmp(argv[a], "--preset") == 0) {
            a++;
            continue;
        }
        if (argv[a][0] == '-') {
            continue;
        }
        char *names[MAX_MESHES];
        const int32_t count = list_meshes(argv[a], names);
        for (int32_t k = 0; k < count; k++) {
            const bool good = check_file(&o, names[k]);
            passed += good;
            failed += !good;
            free(names[k]);
        }
    }
    rmdir(o.scratch);
    printf("%d passed, %d failed\n", passed, failed);
    return failed == 0 ? 0 : 1;
}
