/* Facet-graph Laplacians in shared memory. */
#define _GNU_SOURCE
#include "base/memory.h"
#include "bench/bench.h"
#include "bench/mesh_series.h"
#include "mesh/build.h"
#include "mesh/facet_graph.h"
#include "spectral/spectrum.h"

#include <math.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

/* At the start of the shared memory; arrays follow: xyz, colptr, val, row. */
typedef struct header {
    uint64_t magic;
    int64_t n, nnz;
} header;

static const uint64_t MAGIC = 0x4c61706c61636521u;

static size_t total_bytes(int64_t n, int64_t nnz)
{
    return sizeof(header) + (size_t)n * 3 * sizeof(double) + (size_t)(n + 1) * sizeof(int64_t) +
           (size_t)nnz * (sizeof(double) + sizeof(int32_t));
}

static bool write_all(int descriptor, const void *data, size_t bytes)
{
    const char *at = data;
    while (bytes > 0) {
        const ssize_t written = write(descriptor, at, bytes < ((size_t)1 << 28) ? bytes : (size_t)1 << 28);
        if (written <= 0) {
            return false;
        }
        at += written;
        bytes -= (size_t)written;
    }
    return true;
}

static sl_status write_matrix(int descriptor, const bench_mesh *mesh)
{
    sl_status status = SL_OK;
    sl_mesh *half = NULL;
    sl_facet_graph *graph = NULL;
    sl_csc *A = NULL;
    int32_t components = 0;
    int32_t *first = sl_alloc((int64_t)mesh->nf + 1, sizeof *first);
    int32_t *faces = sl_alloc(mesh->nf, sizeof *faces);
    if (first == NULL || faces == NULL) {
        SL_TRY(SL_OUT_OF_MEMORY);
    }
    for (int32_t f = 0; f <= mesh->nf; f++) {
        first[f] = 3 * f;
        faces[f < mesh->nf ? f : 0] = f < mesh->nf ? f : 0;
    }
    const sl_polygons polygons = {mesh->nv, mesh->nf, mesh->xyz, first, mesh->tri};
    SL_TRY(sl_mesh_build(&polygons, &half, NULL, NULL));
    SL_TRY(sl_facet_graph_create(half, faces, half->nf, NULL, &graph));
    SL_TRY(sl_graph_components(&graph->graph, NULL, faces, &components));
    if (components != 1) {
        fprintf(stderr, "the mesh has %d components; the benches take connected ones\n", (int)components);
        SL_TRY(SL_UNSUPPORTED);
    }
    SL_TRY(sl_laplacian_create(&graph->graph, &A));
    const int64_t n = A->ncols, nnz = A->colptr[n];
    const header head = {MAGIC, n, nnz};
    const bool written = write_all(descriptor, &head, sizeof head) &&
                         write_all(descriptor, graph->centroid, (size_t)n * 3 * sizeof(double)) &&
                         write_all(descriptor, A->colptr, (size_t)(n + 1) * sizeof(int64_t)) &&
                         write_all(descriptor, A->val, (size_t)nnz * sizeof(double)) &&
                         write_all(descriptor, A->row, (size_t)nnz * sizeof(int32_t));
    status = written ? SL_OK : SL_IO;
cleanup:
    sl_csc_free(A);
    sl_facet_graph_free(graph);
    sl_mesh_free(half);
    sl_free(first);
    sl_free(faces);
    return status;
}

static bool too_large(const bench_case *which, const bench_mesh *mesh)
{
    int64_t facets = mesh->nf;
    for (int32_t level = 0; level < which->levels && facets <= which->max_facets; level++) {
        facets *= 4;
    }
    return facets > which->max_facets;
}

/* SL_LIMIT, without a message: too large. */
static sl_status make(const bench_case *which, int descriptor)
{
    sl_status status = SL_OK;
    sl_diag diag = sl_diag_none();
    bench_mesh mesh = {0}, finer = {0};
    if (which->path != NULL) {
        SL_TRY(bench_read_mesh(which->path, &mesh, &diag));
    } else {
        SL_TRY(bench_generate_mesh(which->base, &mesh));
    }
    if (too_large(which, &mesh)) {
        SL_TRY(SL_LIMIT);
    }
    for (int32_t level = 0; level < which->levels; level++) {
        SL_TRY(bench_subdivide_mesh(&mesh, &finer));
        bench_mesh_clear(&mesh);
        mesh = finer;
        finer = (bench_mesh){0};
    }
    SL_TRY(write_matrix(descriptor, &mesh));
cleanup:
    if (status != SL_OK && status != SL_LIMIT) {
        fprintf(stderr, "%s: %s %s\n", which->mesh, sl_status_name(status), diag.reason);
    }
    bench_mesh_clear(&mesh);
    return status;
}

int bench_make_matrix(const bench_case *which)
{
    const int descriptor = memfd_create("matrix", 0);
    if (descriptor < 0) {
        perror("memfd_create");
        return BENCH_NO_MATRIX;
    }
    fflush(NULL);
    const pid_t child = fork();
    if (child == 0) {
        _exit((int)make(which, descriptor));
    }
    int how = 1;
    if (child < 0 || waitpid(child, &how, 0) != child || how != 0) {
        close(descriptor);
        return WIFEXITED(how) && WEXITSTATUS(how) == SL_LIMIT ? BENCH_TOO_LARGE : BENCH_NO_MATRIX;
    }
    return descriptor;
}

bool bench_map_matrix(int descriptor, bench_matrix *out)
{
    struct stat info;
    if (fstat(descriptor, &info) != 0 || (size_t)info.st_size < sizeof(header)) {
        return false;
    }
    const size_t bytes = (size_t)info.st_size;
    char *map = mmap(NULL, bytes, PROT_READ, MAP_SHARED | MAP_POPULATE, descriptor, 0);
    if (map == MAP_FAILED) {
        return false;
    }
    header head;
    memcpy(&head, map, sizeof head);
    if (head.magic != MAGIC || total_bytes(head.n, head.nnz) != bytes) {
        munmap(map, bytes);
        return false;
    }
    const int32_t n = (int32_t)head.n;
    char *at = map + sizeof head;
    *out = (bench_matrix){.A = {.nrows = n, .ncols = n}, .xyz = (const double *)(void *)at, .map = map, .bytes = bytes};
    at += (size_t)n * 3 * sizeof(double);
    out->A.colptr = (int64_t *)(void *)at;
    at += ((size_t)n + 1) * sizeof(int64_t);
    out->A.val = (double *)(void *)at;
    at += (size_t)head.nnz * sizeof(double);
    out->A.row = (int32_t *)(void *)at;
    /* A Laplacian's column sums of magnitudes are twice its diagonal. */
    for (int32_t j = 0; j < n; j++) {
        out->norm = fmax(out->norm, 2.0 * out->A.val[out->A.colptr[j]]);
    }
    return true;
}

void bench_unmap_matrix(bench_matrix *matrix)
{
    munmap(matrix->map, matrix->bytes);
}

double bench_shift(const bench_matrix *matrix)
{
    return -0.25 / matrix->A.ncols;
}
