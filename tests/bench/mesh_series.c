/* Meshes for the benches. */
#include "bench/mesh_series.h"

#include "base/memory.h"
#include "base/rng.h"
#include "mesh/mesh.h"
#include "meshio/meshfile.h"

#include <math.h>

static const double PI = 3.14159265358979323846;

void bench_mesh_clear(bench_mesh *mesh)
{
    sl_free(mesh->xyz);
    sl_free(mesh->tri);
    *mesh = (bench_mesh){0};
}

static sl_status allocate(int64_t nv, int64_t nf, bench_mesh *out)
{
    *out = (bench_mesh){0};
    if (nv > INT32_MAX || 3 * nf > INT32_MAX) {
        return SL_OUT_OF_MEMORY;
    }
    *out = (bench_mesh){(int32_t)nv, (int32_t)nf, sl_alloc(3 * nv, sizeof(double)), sl_alloc(3 * nf, sizeof(int32_t))};
    if (out->xyz == NULL || out->tri == NULL) {
        bench_mesh_clear(out);
        return SL_OUT_OF_MEMORY;
    }
    return SL_OK;
}

/* Distance from the axis at colatitude t. */
static double profile(double t)
{
    return sin(t) * (1.0 + 0.45 * sin(5.0 * t + 0.4));
}

static void place(double t, double phi, double *x)
{
    const double p[3] = {profile(t) * cos(phi), profile(t) * sin(phi), 1.6 * cos(t)};
    const double bump =
        1.0 + 0.08 * sin(5.0 * p[0] + 1.0) * sin(6.0 * p[1] + 2.0) + 0.05 * sin(7.0 * p[2] + 3.0 * p[0]);
    for (int k = 0; k < 3; k++) {
        x[k] = bump * p[k];
    }
}

static int32_t ring_size(int32_t rings, int32_t i, double step)
{
    const double m = 2.0 * PI * profile(PI * (i + 0.5) / rings) / step;
    return m < 3.0 ? 3 : (int32_t)m;
}

static int32_t add_triangle(bench_mesh *mesh, int32_t at, int32_t a, int32_t b, int32_t c)
{
    mesh->tri[3 * at] = a;
    mesh->tri[3 * at + 1] = b;
    mesh->tri[3 * at + 2] = c;
    return at + 1;
}

/* The band between a ring of m vertices from a on and one of k from b on; next vertex by the smaller angle. */
static int32_t add_band(bench_mesh *mesh, int32_t at, int32_t a, int32_t m, int32_t b, int32_t k)
{
    int32_t i = 0, j = 0;
    while (i < m || j < k) {
        if (j == k || (i < m && (int64_t)(i + 1) * k <= (int64_t)(j + 1) * m)) {
            at = add_triangle(mesh, at, a + i % m, b + j % k, a + (i + 1) % m);
            i++;
        } else {
            at = add_triangle(mesh, at, a + i % m, b + j % k, b + (j + 1) % k);
            j++;
        }
    }
    return at;
}

sl_status bench_generate_mesh(int32_t nf, bench_mesh *out)
{
    sl_status status = SL_OK;
    const double step = sqrt(2.0 * 1.6 * PI * 4.0 / nf); /* area about 2 pi 1.6 x 2, two facets a vertex */
    const int32_t rings = (int32_t)(PI * 1.6 / step) + 3;
    int64_t nv = 2, facets = 0;
    for (int32_t i = 0; i < rings; i++) {
        nv += ring_size(rings, i, step);
        facets += 2 * ring_size(rings, i, step);
    }
    SL_TRY(allocate(nv, facets, out));
    sl_rng rng = sl_rng_seed(20181);
    int32_t v = 0, at = 0, before = 0;
    for (int32_t i = 0; i < rings; i++) {
        const int32_t m = ring_size(rings, i, step);
        const double turn = 2.0 * PI * sl_rng_uniform(&rng) / m;
        for (int32_t k = 0; k < m; k++) {
            const double shift_t = 0.4 * (sl_rng_uniform(&rng) - 0.5), shift_phi = 0.4 * (sl_rng_uniform(&rng) - 0.5);
            place(PI * (i + 0.5 + shift_t) / rings, turn + 2.0 * PI * (k + shift_phi) / m, out->xyz + 3 * (v + k));
        }
        if (i > 0) {
            at = add_band(out, at, v - before, before, v, m);
        }
        v += m;
        before = m;
    }
    place(0.0, 0.0, out->xyz + 3 * v);
    place(PI, 0.0, out->xyz + 3 * (v + 1));
    const int32_t first = ring_size(rings, 0, step);
    for (int32_t k = 0; k < first; k++) {
        at = add_triangle(out, at, v, k, (k + 1) % first);
    }
    for (int32_t k = 0; k < before; k++) {
        at = add_triangle(out, at, v - before + (k + 1) % before, v - before + k, v + 1);
    }
    SL_ASSERT(at == out->nf);
cleanup:
    return status;
}

sl_status bench_read_mesh(const char *path, bench_mesh *out, sl_diag *diag)
{
    sl_status status = SL_OK;
    sl_meshfile *file = NULL;
    *out = (bench_mesh){0};
    SL_TRY(sl_meshfile_read(path, &file, diag));
    SL_TRY(allocate(file->nv, (int64_t)file->face_first[file->nf] - 2 * (int64_t)file->nf, out));
    for (int64_t k = 0; k < 3 * (int64_t)file->nv; k++) {
        out->xyz[k] = file->xyz[k];
    }
    int32_t at = 0;
    for (int32_t f = 0; f < file->nf; f++) {
        for (int32_t c = file->face_first[f] + 1; c + 1 < file->face_first[f + 1]; c++) {
            at = add_triangle(out, at, file->index[file->face_first[f]], file->index[c], file->index[c + 1]);
        }
    }
cleanup:
    sl_meshfile_free(file);
    return status;
}

/* The vertex on the edge of h. */
static void place_middle(const sl_mesh *mesh, int32_t h, double *x)
{
    const double *a = mesh->xyz + 3 * (int64_t)mesh->origin[h], *b = mesh->xyz + 3 * (int64_t)sl_target(mesh, h);
    const double length = sl_mesh_edge_length(mesh, h);
    double m[3];
    for (int k = 0; k < 3; k++) {
        m[k] = 0.5 * (a[k] + b[k]);
    }
    for (int k = 0; k < 3; k++) {
        x[k] = m[k] + 0.1 * length * sin(31.0 * m[(k + 1) % 3] + 17.0 * m[(k + 2) % 3] + 1.3 * k);
    }
}

sl_status bench_subdivide_mesh(const bench_mesh *mesh, bench_mesh *out)
{
    sl_status status = SL_OK;
    sl_mesh *half = NULL;
    int32_t *first = NULL, *middle = NULL;
    *out = (bench_mesh){0};
    first = sl_alloc((int64_t)mesh->nf + 1, sizeof *first);
    middle = sl_alloc(3 * (int64_t)mesh->nf, sizeof *middle);
    if (first == NULL || middle == NULL) {
        SL_TRY(SL_OUT_OF_MEMORY);
    }
    for (int32_t f = 0; f <= mesh->nf; f++) {
        first[f] = 3 * f;
    }
    const sl_polygons polygons = {mesh->nv, mesh->nf, mesh->xyz, first, mesh->tri};
    SL_TRY(sl_mesh_build(&polygons, &half, NULL, NULL));
    int32_t edges = 0;
    for (int32_t h = 0; h < half->nh; h++) {
        middle[h] = half->twin[h] >= 0 && half->twin[h] < h ? middle[half->twin[h]] : half->nv + edges++;
    }
    SL_TRY(allocate((int64_t)half->nv + edges, 4 * (int64_t)half->nf, out));
    for (int64_t k = 0; k < 3 * (int64_t)half->nv; k++) {
        out->xyz[k] = half->xyz[k];
    }
    int32_t at = 0;
    for (int32_t f = 0; f < half->nf; f++) {
        const int32_t h = 3 * f;
        for (int k = 0; k < 3; k++) {
            place_middle(half, h + k, out->xyz + 3 * (int64_t)middle[h + k]);
            at = add_triangle(out, at, half->origin[h + k], middle[h + k], middle[h + (k + 2) % 3]);
        }
        at = add_triangle(out, at, middle[h], middle[h + 1], middle[h + 2]);
    }
cleanup:
    sl_mesh_free(half);
    sl_free(first);
    sl_free(middle);
    return status;
}
