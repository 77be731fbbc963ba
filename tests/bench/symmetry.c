/* tests/bench/symmetry: the search for symmetries against the eigensolve of the same mesh, in CPU time. See README.md.
 */
#include "bench/mesh_series.h"

#include "base/memory.h"
#include "mesh/build.h"
#include "spectral/spectrum.h"
#include "symmetry/symmetry.h"

#include <cblas.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

enum { PAIRS = 30, RUNS = 3 };

static const double TWO_PI = 6.28318530717958647692;
static const double MAJOR = 2.0, MINOR = 0.7;
static const double NOISE = 1e-3;

typedef sl_status make_fn(int32_t facets, bench_mesh *out);

static double cpu_seconds(void)
{
    struct timespec t;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static sl_status allocate(int32_t nv, int32_t nf, bench_mesh *out)
{
    out->nv = nv;
    out->nf = nf;
    out->xyz = sl_alloc(3 * (int64_t)nv, sizeof *out->xyz);
    out->tri = sl_alloc(3 * (int64_t)nf, sizeof *out->tri);
    return out->xyz != NULL && out->tri != NULL ? SL_OK : SL_OUT_OF_MEMORY;
}

/* A regular torus: n by n / 2 quads, each cut the same way. */
static sl_status make_torus(int32_t facets, bench_mesh *out)
{
    const int32_t n = (int32_t)sqrt((double)facets), m = n / 2 > 3 ? n / 2 : 3;
    const sl_status status = allocate(n * m, 2 * n * m, out);
    for (int32_t i = 0; i < n && status == SL_OK; i++) {
        for (int32_t j = 0; j < m; j++) {
            const double a = TWO_PI * i / n, b = TWO_PI * j / m, r = MAJOR + MINOR * cos(b);
            const double p[3] = {r * cos(a), r * sin(a), MINOR * sin(b)};
            const int32_t v = i * m + j, right = (i + 1) % n * m + j, up = i * m + (j + 1) % m;
            const int32_t across = (i + 1) % n * m + (j + 1) % m;
            const int32_t corner[6] = {v, right, across, v, across, up};
            memcpy(&out->xyz[3 * v], p, sizeof p);
            memcpy(&out->tri[6 * v], corner, sizeof corner);
        }
    }
    return status;
}

/* The same with its vertices moved at random: the connectivity is as regular, the geometry has no symmetry. */
static sl_status make_noisy_torus(int32_t facets, bench_mesh *out)
{
    const sl_status status = make_torus(facets, out);
    uint32_t state = 1;
    for (int32_t i = 0; i < 3 * out->nv && status == SL_OK; i++) {
        state = state * 1664525u + 1013904223u;
        out->xyz[i] += NOISE * (state >> 8) * 0x1p-24;
    }
    return status;
}

/* Vertex s of the 4 r around the ring r steps from a pole; the rings of the lower half follow those of the upper. */
static int32_t ring_vertex(int32_t n, int32_t ring, int32_t s)
{
    const int32_t r = ring <= n ? ring : 2 * n - ring; /* steps from the nearer pole */
    if (r == 0) {
        return ring == 0 ? 0 : 4 * n * n + 1;
    }
    const int32_t above = ring <= n ? 1 + 2 * r * (r - 1) : 4 * n * n + 1 - 2 * r * (r + 1);
    return above + s % (4 * r);
}

static void place_ring(int32_t n, int32_t ring, double *xyz)
{
    static const double axis[5][2] = {{1, 0}, {0, 1}, {-1, 0}, {0, -1}, {1, 0}};
    const int32_t r = ring <= n ? ring : 2 * n - ring;
    for (int32_t s = 0; s < 4 * r || s == 0; s++) {
        const int32_t quarter = r > 0 ? s / r : 0, step = r > 0 ? s % r : 0;
        double p[3] = {0.0, 0.0, n - ring};
        for (int k = 0; k < 2; k++) {
            p[k] = axis[quarter][k] * (r - step) + axis[quarter + 1][k] * step;
        }
        const double norm = sqrt(p[0] * p[0] + p[1] * p[1] + p[2] * p[2]);
        for (int k = 0; k < 3; k++) {
            xyz[3 * ring_vertex(n, ring, s) + k] = p[k] / norm;
        }
    }
}

/* Triangles of quarter q between the ring r steps from a pole and the one nearer to it; returns the end. */
static int32_t *fill_quarter(int32_t n, int32_t ring, int32_t q, int32_t *tri)
{
    const bool upper = ring <= n;
    const int32_t r = upper ? ring : 2 * n - ring, inner = upper ? ring - 1 : ring + 1;
    for (int32_t s = 0; s < r; s++) {
        const int32_t a = ring_vertex(n, ring, q * r + s), b = ring_vertex(n, ring, q * r + s + 1);
        const int32_t c = ring_vertex(n, inner, q * (r - 1) + s), d = ring_vertex(n, inner, q * (r - 1) + s + 1);
        const int32_t corner[6] = {a, upper ? b : c, upper ? c : b, b, upper ? d : c, upper ? c : d};
        memcpy(tri, corner, (s + 1 < r ? 6 : 3) * sizeof *tri);
        tri += s + 1 < r ? 6 : 3;
    }
    return tri;
}

/* An octahedron whose faces are cut into n^2 triangles, on the unit sphere: 48 symmetries. */
static sl_status make_sphere(int32_t facets, bench_mesh *out)
{
    const int32_t n = (int32_t)sqrt(facets / 8.0);
    const sl_status status = allocate(4 * n * n + 2, 8 * n * n, out);
    int32_t *tri = out->tri;
    for (int32_t ring = 0; ring <= 2 * n && status == SL_OK; ring++) {
        place_ring(n, ring, out->xyz);
        for (int32_t q = 0; q < 4 && ring > 0 && ring < 2 * n; q++) {
            tri = fill_quarter(n, ring, q, tri);
            if (ring == n) { /* the equator has triangles on both sides */
                for (int32_t s = 0; s < n; s++) {
                    const int32_t a = ring_vertex(n, n, q * n + s), b = ring_vertex(n, n, q * n + s + 1);
                    const int32_t c = ring_vertex(n, n + 1, q * (n - 1) + s);
                    const int32_t d = ring_vertex(n, n + 1, q * (n - 1) + s + 1);
                    const int32_t corner[6] = {a, c, b, b, c, d};
                    memcpy(tri, corner, (s + 1 < n ? 6 : 3) * sizeof *tri);
                    tri += s + 1 < n ? 6 : 3;
                }
            }
        }
    }
    return status;
}

static sl_status build(const bench_mesh *soup, sl_mesh **mesh)
{
    int32_t *first = sl_alloc((int64_t)soup->nf + 1, sizeof *first);
    if (first == NULL) {
        return SL_OUT_OF_MEMORY;
    }
    for (int32_t f = 0; f <= soup->nf; f++) {
        first[f] = 3 * f;
    }
    const sl_polygons polygons = {soup->nv, soup->nf, soup->xyz, first, soup->tri};
    const sl_status status = sl_mesh_build(&polygons, mesh, NULL, NULL);
    sl_free(first);
    return status;
}

/* Least CPU time of RUNS searches. */
static sl_status time_search(const sl_mesh *mesh, double *seconds, int32_t *maps, int32_t *exact, bool *truncated)
{
    const sl_symmetry_def def = sl_symmetry_default();
    *seconds = HUGE_VAL;
    for (int run = 0; run < RUNS; run++) {
        sl_symmetry *found = NULL;
        const double start = cpu_seconds();
        const sl_status status = sl_symmetry_find(mesh, NULL, &def, NULL, &found);
        *seconds = fmin(*seconds, cpu_seconds() - start);
        if (status != SL_OK) {
            return status;
        }
        *maps = found->nmap;
        *truncated = found->truncated;
        *exact = 0;
        for (int32_t i = 0; i < found->nmap; i++) {
            *exact += found->map[i].kind == SL_SYMMETRY_EXACT;
        }
        sl_symmetry_free(found);
    }
    return SL_OK;
}

static sl_status time_eigensolve(const sl_mesh *mesh, bool signs, double *seconds)
{
    sl_status status = SL_OK;
    sl_facet_graph *graph = NULL;
    sl_spectrum *spectrum = NULL;
    int32_t *face = sl_alloc(mesh->nf, sizeof *face);
    if (face == NULL) {
        return SL_OUT_OF_MEMORY;
    }
    for (int32_t f = 0; f < mesh->nf; f++) {
        face[f] = f;
    }
    SL_TRY(sl_facet_graph_create(mesh, face, mesh->nf, NULL, &graph));
    const double start = cpu_seconds();
    SL_TRY(signs ? sl_spectrum_compute_signs(graph, PAIRS, NULL, &spectrum)
                 : sl_spectrum_compute(graph, PAIRS, NULL, &spectrum));
    *seconds = cpu_seconds() - start;
cleanup:
    sl_spectrum_free(spectrum);
    sl_facet_graph_free(graph);
    sl_free(face);
    return status;
}

static sl_status run_shape(const char *name, make_fn *make, int32_t facets, bool solve)
{
    sl_status status = SL_OK;
    bench_mesh soup = {0};
    sl_mesh *mesh = NULL;
    double search = 0.0, signs = NAN, pairs = NAN;
    int32_t maps = 0, exact = 0;
    bool truncated = false;
    SL_TRY(make(facets, &soup));
    SL_TRY(build(&soup, &mesh));
    bench_mesh_clear(&soup);
    SL_TRY(time_search(mesh, &search, &maps, &exact, &truncated));
    if (solve) {
        SL_TRY(time_eigensolve(mesh, true, &signs));
        SL_TRY(time_eigensolve(mesh, false, &pairs));
    }
    printf("%-12s %8d  %4d%c %5d  %8.3f  %8.3f %6.3f  %8.3f %6.3f\n", name, mesh->nf, maps, truncated ? '+' : ' ',
           exact, search, pairs, search / pairs, signs, search / signs);
    fflush(stdout);
cleanup:
    bench_mesh_clear(&soup);
    sl_mesh_free(mesh);
    return status;
}

int main(int argc, char **argv)
{
    static const struct {
        const char *name;
        make_fn *make;
    } shapes[] = {{"torus", make_torus},
                  {"noisy torus", make_noisy_torus},
                  {"sphere", make_sphere},
                  {"organic", bench_generate_mesh}};
    int64_t facets = 1000000;
    bool solve = true;
    const char *only = NULL;
    for (int i = 1; i < argc; i++) {
        if (strcmp(argv[i], "--facets") == 0 && i + 1 < argc) {
            facets = strtoll(argv[++i], NULL, 10);
        } else if (strcmp(argv[i], "--only") == 0 && i + 1 < argc) {
            only = argv[++i];
        } else if (strcmp(argv[i], "--search-only") == 0) {
            solve = false;
        } else {
            facets = 0;
        }
    }
    if (facets < 100 || facets > 100000000) {
        fprintf(stderr, "usage: symmetry [--facets N] [--only SHAPE] [--search-only]\n");
        return 3;
    }
    openblas_set_num_threads(1);
    printf("mesh           facets  maps  exact  search s   pairs s  ratio   signs s  ratio\n");
    for (size_t i = 0; i < SL_COUNTOF(shapes); i++) {
        if (only != NULL && strcmp(only, shapes[i].name) != 0) {
            continue;
        }
        const sl_status status = run_shape(shapes[i].name, shapes[i].make, (int32_t)facets, solve);
        if (status != SL_OK) {
            fprintf(stderr, "%s: %s\n", shapes[i].name, sl_status_name(status));
            return 1;
        }
    }
    return 0;
}
