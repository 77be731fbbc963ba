/* Our atlases beside the peers': charts, seams, distortion and CPU time at the distortion that each peer reached.
 *
 *     atlas MESHES ATLASES.csv OUT.csv [mesh...]
 *
 * MESHES: folder of the eight small meshes; ATLASES.csv: the peers' rows. OUT.csv gets ours in the same columns, `tool`
 * naming the row that set the targets. Seams weigh their length alone, no symmetry is used and nothing protected, as
 * for the peers. */
#include "atlas/atlas.h"
#include "atlas/measure.h"
#include "base/memory.h"
#include "meshio/meshfile.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <time.h>

enum { RESOLUTION = 2048, MOST_ROWS = 256, TARGETS = 6, MESHES = 8 };
enum { PROTOTYPE_ROW = 4, DEFAULT = 5 };     /* of the targets */
static const double PROTOTYPE_EFFORT = 60.0; /* it took minutes */
static const char *const MESH[MESHES] = {"cow",         "spot",    "suzanne",    "homer",
                                         "cheburashka", "fandisk", "rocker-arm", "hand"};
static const char *const TARGET[TARGETS] = {"uvatlas", "fine", "xatlas-l2", "xatlas-both", "prototype", "default"};
static const char *const STAGE[SL_OPTIMIZE_STAGES] = {"coarsen", "start", "guess",      "cut",
                                                      "balance", "sew",   "straighten", "carry"};

/* One row of the peers, as far as it is compared. */
typedef struct peer {
    char tool[32], mesh[32];
    double charts, seam, angle, l2, user;
} peer;

/* Rows of the prototype (quality.md): charts, seam, L2, angle. */
static const double PROTOTYPE[MESHES][4] = {{1, 3.61, 1.050, 1.20}, {1, 2.86, 1.046, 1.20}, {4, 3.57, 1.024, 1.20},
                                            {3, 4.39, 1.052, 1.20}, {1, 2.70, 1.052, 1.20}, {1, 2.01, 1.029, 1.15},
                                            {1, 3.60, 1.015, 1.10}, {1, 3.66, 1.020, 1.11}};

/* What a run is compared with, and the targets it is given. */
typedef struct task {
    double charts, seam, l2, angle;
    double target_stretch, target_angle;
} task;

static double cpu_seconds(void)
{
    struct timespec t;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static int read_peers(const char *path, peer *row)
{
    FILE *file = fopen(path, "r");
    char line[1024];
    int n = 0;
    while (file != NULL && n < MOST_ROWS && fgets(line, sizeof line, file) != NULL) {
        peer *p = &row[n];
        n += sscanf(line, "%31[^,],%31[^,],%*d,%lf,%*f,%*d,%lf,%*d,%lf,%*d,%*d,%*f,%*f,%lf,%*f,%*f,%lf", p->tool,
                    p->mesh, &p->user, &p->charts, &p->seam, &p->angle, &p->l2) == 7;
    }
    if (file != NULL) {
        fclose(file);
    }
    return n;
}

static bool find_task(const peer *row, int nrows, int mesh, int target, task *out)
{
    const char *tool = target == 0 ? "uvatlas" : "xatlas";
    if (target == 4) {
        const double *p = PROTOTYPE[mesh];
        *out = (task){p[0], p[1], p[2], p[3], p[2], p[3]};
        return true;
    }
    if (target == DEFAULT) { /* compared with nothing: what the program does without options */
        const sl_optimize_def def = sl_optimize_default();
        *out = (task){1, 1, 1, 1, def.target_stretch, def.target_angle};
        return true;
    }
    for (int k = 0; k < nrows; k++) {
        if (strcmp(row[k].tool, tool) == 0 && strcmp(row[k].mesh, MESH[mesh]) == 0) {
            *out = (task){row[k].charts,
                          row[k].seam,
                          row[k].l2,
                          row[k].angle,
                          target == 1 ? 1.02 : row[k].l2,
                          target == 3 ? row[k].angle : 1.2};
            return true;
        }
    }
    return false;
}

/* Facets that repeat another's corners are left out, as for the peers. */
static sl_status drop_duplicates(const sl_polygons *in, int32_t *face_first, int32_t *index, sl_polygons *out)
{
    sl_status status = SL_OK;
    sl_mesh *mesh = NULL;
    sl_repair_report report = {0};
    int32_t n = 0, corners = 0, next = 0;
    SL_TRY(sl_mesh_build(in, &mesh, &report, NULL));
    face_first[0] = 0;
    for (int32_t f = 0; f < in->nf; f++) {
        if (next < report.duplicate_faces && report.duplicate[next] == f) {
            next++;
            continue;
        }
        for (int32_t c = in->face_first[f]; c < in->face_first[f + 1]; c++) {
            index[corners++] = in->index[c];
        }
        face_first[++n] = corners;
    }
    *out = (sl_polygons){in->nv, n, in->xyz, face_first, index};
cleanup:
    sl_mesh_free(mesh);
    sl_repair_report_clear(&report);
    return status;
}

static void print_row(FILE *csv, const char *target, const char *mesh, double seconds, const sl_atlas_measure *m)
{
    struct rusage usage;
    getrusage(RUSAGE_SELF, &usage);
    fprintf(csv, "ours-%s,%s,0,%.2f,%ld,%d,%d,%d,%.3f,%d,%d,%.5f,%.5f,%.4f,%.3f,%.3g,%.4f,%.4g,%.4f,%.4g,%.4f\n",
            target, mesh, seconds, usage.ru_maxrss / 1024, m->triangles, m->charts, m->charts10, m->seam_length,
            m->global.flipped, m->global.degenerate, m->overlap_inside, m->overlap_across, m->global.angle_mean,
            m->global.angle_p95, m->global.angle_max, m->global.l2, m->global.linf, m->global.area_mean,
            m->global.area_max, m->fill);
    fflush(csv);
}

static sl_status run(const sl_polygons *polygons, const task *t, int mesh, int target, FILE *csv)
{
    sl_status status = SL_OK;
    sl_atlas *atlas = NULL;
    sl_atlas_measure m;
    sl_atlas_def def = sl_atlas_default();
    def.best = true;
    def.optimize = sl_optimize_default();
    def.optimize.target_stretch = t->target_stretch;
    def.optimize.target_angle = t->target_angle;
    if (target != DEFAULT) {
        def.optimize.protect = SL_PROTECT_NONE;
        def.optimize.weights = sl_seam_cost_none();
        def.optimize.empty_cost = 0.0; /* charts and seams alone are compared */
        def.optimize.effort = target == PROTOTYPE_ROW ? PROTOTYPE_EFFORT : def.optimize.effort;
        def.segment.symmetry = SL_SYMMETRY_USE_OFF;
    }
    const double start = cpu_seconds();
    SL_TRY(sl_unwrap(polygons, &def, NULL, &atlas, NULL));
    const double seconds = cpu_seconds() - start;
    SL_TRY(sl_measure_atlas(polygons, atlas->input_corner_uv, RESOLUTION, NULL, &m, NULL));
    print_row(csv, TARGET[target], MESH[mesh], seconds, &m);
    printf("%-11s %-11s %3d/%6.3f/%.4f/%.3f  %3.0f/%6.3f/%.4f/%.3f  charts %.2f seam %.2f  %6.2f s fill %.2f %s%s%s\n",
           TARGET[target], MESH[mesh], m.charts, m.seam_length, m.global.l2, m.global.angle_mean, t->charts, t->seam,
           t->l2, t->angle, m.charts / t->charts, m.seam_length / t->seam, seconds, m.fill,
           atlas->check.passed ? "proven" : "NOT PROVEN", m.global.l2 > t->target_stretch + 1e-4 ? " L2 MISSED" : "",
           m.global.angle_mean > t->target_angle + 1e-3 ? " ANGLE MISSED" : "");
    double rest = seconds;
    printf("    seconds:");
    for (int k = 0; k < SL_OPTIMIZE_STAGES; k++) {
        printf(" %s %.2f", STAGE[k], atlas->optimized.seconds[k]);
        rest -= atlas->optimized.seconds[k];
    }
    printf(" repair, pack, check %.2f\n", rest);
    fflush(stdout);
cleanup:
    sl_atlas_free(atlas);
    return status;
}

static sl_status run_mesh(const char *folder, int mesh, const peer *row, int nrows, FILE *csv)
{
    sl_status status = SL_OK;
    char path[4096];
    sl_diag diag = sl_diag_none();
    sl_meshfile *file = NULL;
    sl_polygons all, polygons;
    int32_t *face_first = NULL, *index = NULL;
    snprintf(path, sizeof path, "%s/%s.obj", folder, MESH[mesh]);
    SL_TRY(sl_meshfile_read(path, &file, &diag));
    sl_meshfile_polygons(file, &all);
    face_first = sl_alloc((int64_t)all.nf + 1, sizeof *face_first);
    index = sl_alloc(all.face_first[all.nf], sizeof *index);
    SL_TRY(face_first == NULL || index == NULL ? SL_OUT_OF_MEMORY : SL_OK);
    SL_TRY(drop_duplicates(&all, face_first, index, &polygons));
    const char *only = getenv("ATLAS_TARGET");
    for (int target = 0; target < TARGETS; target++) {
        task t;
        if ((only == NULL || strstr(only, TARGET[target]) != NULL) && find_task(row, nrows, mesh, target, &t)) {
            SL_TRY(run(&polygons, &t, mesh, target, csv));
        }
    }
cleanup:
    sl_meshfile_free(file);
    sl_free(face_first);
    sl_free(index);
    return status;
}

int main(int argc, char **argv)
{
    static peer row[MOST_ROWS];
    FILE *csv = argc > 3 ? fopen(argv[3], "w") : NULL;
    if (csv == NULL) {
        fprintf(stderr, "usage: atlas MESHES ATLASES.csv OUT.csv [mesh...]\n");
        return 2;
    }
    const int nrows = read_peers(argv[2], row);
    fprintf(csv, "tool,mesh,rc,user,rssMB,tri,charts,charts10,seamLen,flip,deg,ovIn,ovX,angMean,ang95,angMax,L2,Linf,"
                 "areaMean,areaMax,pack\n");
    int code = 0;
    for (int mesh = 0; mesh < MESHES; mesh++) {
        bool wanted = argc == 4;
        for (int a = 4; a < argc; a++) {
            wanted = wanted || strcmp(argv[a], MESH[mesh]) == 0;
        }
        const sl_status status = wanted ? run_mesh(argv[1], mesh, row, nrows, csv) : SL_OK;
        if (status != SL_OK) {
            fprintf(stderr, "%s: %s\n", MESH[mesh], sl_status_name(status));
            code = 1;
        }
    }
    fclose(csv);
    return code;
}
