/* tests/bench/abf: ABF++ angles and reconstruction of one disk chart, in CPU time. See README.md. */
#include "bench/mesh_series.h"

#include "base/memory.h"
#include "mesh/patch.h"
#include "param/abf_chart.h"
#include "param/constraints.h"

#include <cblas.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

enum { DEFAULT_RUNS = 5 };

static const double SHARE_KEPT = 0.1; /* of the generated surface's half height: the rest is cut away below */

/* Blender 3.4.1 and geogram 1.10 on one thread on this kind of machine, angles and reconstruction, by chart size. */
static const struct {
    int32_t triangles;
    double blender, geogram;
} peer[] = {{2900, 0.05, 0.05}, {5000, 0.12, 0.12}, {10000, 0.29, 0.24}, {22700, 4.4, 2.45},
            {35000, 2.2, 1.53}, {43000, 2.2, 2.10}, {51700, 6.5, 6.36}};

typedef struct times {
    double angles, layout;
    sl_abf_info info;
} times;

enum { DRAGS = 12 };
static const double DRAG = 5.0 * 3.14159265358979323846 / 180.0; /* the paper's mouse */

static double cpu_seconds(void)
{
    struct timespec t;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

/* The upper part of the generated closed surface, a disk; its facets alone. */
static void keep_upper_part(bench_mesh *mesh)
{
    int32_t kept = 0;
    for (int32_t f = 0; f < mesh->nf; f++) {
        double z = 0.0;
        for (int k = 0; k < 3; k++) {
            z += mesh->xyz[3 * (int64_t)mesh->tri[3 * f + k] + 2] / 3.0;
        }
        if (z > SHARE_KEPT) {
            memmove(&mesh->tri[3 * kept], &mesh->tri[3 * f], 3 * sizeof *mesh->tri);
            kept++;
        }
    }
    mesh->nf = kept;
}

static void drop_unused_vertices(bench_mesh *mesh)
{
    int32_t *name = sl_alloc(mesh->nv, sizeof *name), n = 0;
    if (name == NULL) {
        return;
    }
    for (int32_t v = 0; v < mesh->nv; v++) {
        name[v] = -1;
    }
    for (int64_t c = 0; c < 3 * (int64_t)mesh->nf; c++) {
        name[mesh->tri[c]] = 0;
    }
    for (int32_t v = 0; v < mesh->nv; v++) {
        if (name[v] == 0) {
            memmove(&mesh->xyz[3 * (int64_t)n], &mesh->xyz[3 * (int64_t)v], 3 * sizeof *mesh->xyz);
            name[v] = n++;
        }
    }
    for (int64_t c = 0; c < 3 * (int64_t)mesh->nf; c++) {
        mesh->tri[c] = name[mesh->tri[c]];
    }
    mesh->nv = n;
    sl_free(name);
}

static sl_status run_once(const sl_patch *patch, double *uv, times *out)
{
    sl_status status = SL_OK;
    sl_abf *solver = NULL;
    const sl_abf_def def = sl_abf_default();
    const double start = cpu_seconds();
    SL_TRY(sl_abf_create(patch, &def, &solver));
    SL_TRY(sl_abf_step(solver, def.max_iterations, NULL));
    const double solved = cpu_seconds();
    SL_TRY(sl_abf_reconstruct(patch, sl_abf_angles(solver), NULL, uv));
    out->angles = solved - start;
    out->layout = cpu_seconds() - solved;
    out->info = *sl_abf_info_of(solver);
cleanup:
    sl_abf_free(solver);
    return status;
}

/* The least time of a drag of a border angle by five degrees: two Newton steps and reconstruction. */
static sl_status drag_border_angle(const sl_patch *patch, double *least)
{
    sl_status status = SL_OK;
    sl_sector_table table = {0};
    sl_abf_chart *chart = NULL;
    sl_abf_def def = sl_abf_default();
    int32_t v = 0;
    while (patch->border[v] == 0 || patch->twin[sl_corner_prev(patch->outgoing[v])] < 0) { /* two triangles at least */
        v++;
    }
    const sl_constraint angle = {SL_CONSTRAINT_ANGLE, 1, &v, 2.5};
    *least = INFINITY;
    SL_TRY(sl_constraints_compile(patch, 1, &angle, NULL, &table, NULL));
    def.sectors = &table.view;
    SL_TRY(sl_abf_chart_create(patch, &def, NULL, &chart));
    for (int i = 0; i < DRAGS; i++) {
        table.theta[table.view.count - 1] -= DRAG;
        const double start = cpu_seconds();
        SL_TRY(sl_abf_chart_move(chart, table.theta, NULL));
        *least = fmin(*least, cpu_seconds() - start);
    }
cleanup:
    sl_abf_chart_free(chart);
    sl_sectors_clear(&table);
    return status;
}

static sl_status bench_chart(const char *name, const bench_mesh *mesh, int32_t runs)
{
    sl_status status = SL_OK;
    sl_patch *patch = NULL;
    double *uv = NULL;
    times best = {INFINITY, INFINITY, {0}};
    SL_TRY(sl_patch_from_triangles(mesh->nv, mesh->xyz, mesh->nf, mesh->tri, &patch));
    if (!sl_patch_is_disk(patch)) {
        printf("%-22s is not a disk\n", name);
        goto cleanup;
    }
    uv = sl_alloc(2 * (int64_t)patch->nv, sizeof *uv);
    SL_TRY(uv != NULL ? SL_OK : SL_OUT_OF_MEMORY);
    for (int32_t r = 0; r < runs; r++) {
        times t;
        SL_TRY(run_once(patch, uv, &t));
        best = t.angles + t.layout < best.angles + best.layout ? t : best;
    }
    double drag;
    SL_TRY(drag_border_angle(patch, &drag));
    printf("%-22s %8d %4d %9.1e %9.4f %9.4f %9.4f %9.4f", name, patch->nt, best.info.iterations, best.info.gradient,
           best.angles, best.layout, best.angles + best.layout, drag);
    for (size_t i = 0; i < SL_COUNTOF(peer); i++) {
        if (abs(peer[i].triangles - patch->nt) <= patch->nt / 10) {
            printf(" %9.2f %9.2f", peer[i].blender, peer[i].geogram);
        }
    }
    printf("\n");
cleanup:
    sl_patch_free(patch);
    sl_free(uv);
    return status;
}

static sl_status bench_file(const char *path, int32_t runs)
{
    sl_status status = SL_OK;
    sl_diag diag = sl_diag_none();
    bench_mesh mesh = {0};
    const char *name = strrchr(path, '/');
    SL_TRY(bench_read_mesh(path, &mesh, &diag));
    SL_TRY(bench_chart(name != NULL ? name + 1 : path, &mesh, runs));
cleanup:
    if (status != SL_OK) {
        fprintf(stderr, "%s: %s %s\n", path, sl_status_name(status), diag.reason);
    }
    bench_mesh_clear(&mesh);
    return status;
}

static sl_status bench_generated(int32_t triangles, int32_t runs)
{
    sl_status status = SL_OK;
    bench_mesh mesh = {0};
    SL_TRY(bench_generate_mesh(2 * triangles, &mesh));
    keep_upper_part(&mesh);
    drop_unused_vertices(&mesh);
    SL_TRY(bench_chart("generated", &mesh, runs));
cleanup:
    bench_mesh_clear(&mesh);
    return status;
}

/* For other programs: the generated chart of about that many triangles as OBJ. */
static sl_status write_generated(int32_t triangles, const char *path)
{
    sl_status status = SL_OK;
    bench_mesh mesh = {0};
    FILE *file = NULL;
    SL_TRY(bench_generate_mesh(2 * triangles, &mesh));
    keep_upper_part(&mesh);
    drop_unused_vertices(&mesh);
    file = fopen(path, "w");
    SL_TRY(file != NULL ? SL_OK : SL_IO);
    for (int32_t v = 0; v < mesh.nv; v++) {
        const double *x = &mesh.xyz[3 * (int64_t)v];
        fprintf(file, "v %.17g %.17g %.17g\n", x[0], x[1], x[2]);
    }
    for (int32_t f = 0; f < mesh.nf; f++) {
        const int32_t *t = &mesh.tri[3 * (int64_t)f];
        fprintf(file, "f %d %d %d\n", t[0] + 1, t[1] + 1, t[2] + 1);
    }
    status = fclose(file) == 0 ? SL_OK : SL_IO;
cleanup:
    bench_mesh_clear(&mesh);
    return status;
}

/* abf [RUNS [MESH...]]: charts in files, or else the generated series. abf write TRIANGLES FILE: one of the series. */
int main(int argc, char **argv)
{
    static const int32_t size[] = {3000, 10000, 22000, 50000, 100000};
    const int32_t runs = argc > 1 && atoi(argv[1]) > 0 ? atoi(argv[1]) : DEFAULT_RUNS;
    sl_status status = SL_OK;
    openblas_set_num_threads(1);
    if (argc == 4 && strcmp(argv[1], "write") == 0) {
        return write_generated(atoi(argv[2]), argv[3]) == SL_OK ? 0 : 1;
    }
    printf("%-22s %8s %4s %9s %9s %9s %9s %9s %9s %9s\n", "chart", "tris", "it", "|g|", "angles", "layout", "sum",
           "drag", "blender", "geogram");
    for (int i = 2; i < argc && status == SL_OK; i++) {
        status = bench_file(argv[i], runs);
    }
    for (size_t i = 0; i < SL_COUNTOF(size) && argc <= 2 && status == SL_OK; i++) {
        status = bench_generated(size[i], runs);
    }
    return status == SL_OK ? 0 : 1;
}
