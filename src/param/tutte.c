#include "param/tutte.h"

#include "base/memory.h"
#include "geom/vec3.h"
#include "sparse/cholesky.h"

static const double PI = 3.14159265358979323846;

/* Weights and arcs are kept within these shares of their mean: positive, and distinct in doubles. */
static const double MIN_COTANGENT = 0.05, MAX_COTANGENT = 20.0;
static const double MIN_ARC = 1e-3;

/* Cotangent of the angle at corner c, clamped; obtuse and flat corners fall to the lower bound. */
static double clamped_cotangent(const sl_patch *patch, int32_t c)
{
    const double *o = &patch->xyz[3 * (int64_t)patch->tri[c]];
    double a[3], b[3], n[3];
    sl_vec3_sub(&patch->xyz[3 * (int64_t)patch->tri[sl_corner_next(c)]], o, a);
    sl_vec3_sub(&patch->xyz[3 * (int64_t)patch->tri[sl_corner_prev(c)]], o, b);
    sl_vec3_cross(a, b, n);
    const double sine = sl_vec3_norm(n), cosine = sl_vec3_dot(a, b);
    if (!(cosine > MIN_COTANGENT * sine)) {
        return MIN_COTANGENT;
    }
    return cosine < MAX_COTANGENT * sine ? cosine / sine : MAX_COTANGENT;
}

/* Symmetric weight of the interior edge of halfedge h. */
static double edge_weight(const sl_patch *patch, sl_tutte_weights weights, int32_t h)
{
    if (weights == SL_TUTTE_UNIFORM) {
        return 1.0;
    }
    return clamped_cotangent(patch, sl_corner_prev(h)) + clamped_cotangent(patch, sl_corner_prev(patch->twin[h]));
}

static double halfedge_length(const sl_patch *patch, int32_t h)
{
    return sl_vec3_distance(&patch->xyz[3 * (int64_t)patch->tri[h]],
                            &patch->xyz[3 * (int64_t)patch->tri[sl_corner_next(h)]]);
}

/* Border vertices on the unit circle at their arc length, short edges lengthened to a share of the mean. */
static void place_border(const sl_patch *patch, int32_t nb, const int32_t *halfedge, double *uv)
{
    double length = 0.0, total = 0.0;
    for (int32_t b = 0; b < nb; b++) {
        length += halfedge_length(patch, halfedge[b]);
    }
    const double mean = length / nb, shortest = mean > 0.0 ? MIN_ARC * mean : 1.0;
    for (int32_t b = 0; b < nb; b++) {
        total += fmax(shortest, halfedge_length(patch, halfedge[b]));
    }
    double arc = 0.0;
    for (int32_t b = 0; b < nb; b++) {
        const int64_t v = patch->tri[halfedge[b]];
        uv[2 * v] = cos(2.0 * PI * arc / total);
        uv[2 * v + 1] = sin(2.0 * PI * arc / total);
        arc += fmax(shortest, halfedge_length(patch, halfedge[b]));
    }
}

/* The weighted Laplacian of the interior vertices as triplets of its lower triangle, and the border's share X (n x 2,
 * column-major) of the right side. unknown: index of an interior vertex, -1 on the border. Returns the triplets' count.
 */
static int64_t fill_system(const sl_patch *patch, sl_tutte_weights weights, const int32_t *unknown, int32_t n,
                           const double *uv, int32_t *row, int32_t *col, double *val, double *X)
{
    int64_t count = 0;
    for (int32_t h = 0; h < 3 * patch->nt; h++) {
        if (patch->twin[h] < 0) {
            continue;
        }
        const int32_t v = patch->tri[h], w = patch->tri[sl_corner_next(h)], i = unknown[v], j = unknown[w];
        if (i < 0) {
            continue; /* each interior edge comes twice, once from each end */
        }
        const double weight = edge_weight(patch, weights, h);
        row[count] = col[count] = i;
        val[count++] = weight;
        if (j < 0) {
            X[i] += weight * uv[2 * (int64_t)w];
            X[(int64_t)n + i] += weight * uv[2 * (int64_t)w + 1];
        } else if (i > j) {
            row[count] = i;
            col[count] = j;
            val[count++] = -weight;
        }
    }
    return count;
}

/* Interior vertices at the weighted mean of their neighbours. */
static sl_status solve_interior(const sl_patch *patch, sl_tutte_weights weights, int32_t n, const int32_t *unknown,
                                double *uv)
{
    sl_status status = SL_OK;
    sl_csc *A = NULL;
    const int64_t room = 6 * (int64_t)patch->nt;
    int32_t *row = sl_alloc(room, sizeof *row), *col = sl_alloc(room, sizeof *col);
    double *val = sl_alloc(room, sizeof *val), *X = sl_calloc(2 * (int64_t)n, sizeof *X);
    double *xyz = sl_alloc(3 * (int64_t)n, sizeof *xyz);
    if (row == NULL || col == NULL || val == NULL || X == NULL || xyz == NULL) {
        status = SL_OUT_OF_MEMORY;
        goto cleanup;
    }
    const int64_t count = fill_system(patch, weights, unknown, n, uv, row, col, val, X);
    SL_TRY(sl_csc_from_triplets(n, n, count, row, col, val, &A));
    for (int32_t v = 0; v < patch->nv; v++) {
        for (int d = 0; d < 3 && unknown[v] >= 0; d++) {
            xyz[3 * (int64_t)unknown[v] + d] = patch->xyz[3 * (int64_t)v + d];
        }
    }
    sl_cholesky_def def = sl_cholesky_default();
    def.xyz = xyz;
    status = sl_cholesky_solve_once(A, &def, X, 2);
    if (status != SL_OK) {
        status = status == SL_NOT_POSITIVE_DEFINITE ? SL_SINGULAR : status;
        goto cleanup;
    }
    for (int32_t v = 0; v < patch->nv; v++) {
        if (unknown[v] >= 0) {
            uv[2 * (int64_t)v] = X[unknown[v]];
            uv[2 * (int64_t)v + 1] = X[(int64_t)n + unknown[v]];
        }
    }
cleanup:
    sl_csc_free(A);
    sl_free(row);
    sl_free(col);
    sl_free(val);
    sl_free(X);
    sl_free(xyz);
    return status;
}

/* The same area in the plane as in space. */
static void scale_to_area(const sl_patch *patch, double *uv)
{
    double area = 0.0, doubled = 0.0;
    for (int32_t t = 0; t < patch->nt; t++) {
        const double *a = &uv[2 * (int64_t)patch->tri[3 * t]], *b = &uv[2 * (int64_t)patch->tri[3 * t + 1]];
        const double *c = &uv[2 * (int64_t)patch->tri[3 * t + 2]];
        doubled += (b[0] - a[0]) * (c[1] - a[1]) - (c[0] - a[0]) * (b[1] - a[1]);
        area += sl_patch_triangle_area(patch, t);
    }
    if (!(area > 0.0) || !(doubled > 0.0)) {
        return; /* nothing to scale to: the unit circle stands */
    }
    const double scale = sqrt(2.0 * area / doubled);
    for (int64_t i = 0; i < 2 * (int64_t)patch->nv; i++) {
        uv[i] *= scale;
    }
}

sl_status sl_tutte(const sl_patch *patch, sl_tutte_weights weights, const sl_context *context, double *uv)
{
    sl_status status = SL_OK;
    int32_t *first = NULL, *halfedge = NULL, *unknown = NULL;
    double *map = NULL;
    if (!sl_patch_is_disk(patch)) {
        return SL_INFEASIBLE;
    }
    SL_TRY(sl_report_progress(context, "embedding by Tutte", 0.0));
    SL_TRY(sl_patch_border(patch, &first, &halfedge));
    if (first[1] < 3) {
        status = SL_INFEASIBLE; /* a border of two edges encloses no area */
        goto cleanup;
    }
    unknown = sl_alloc(patch->nv, sizeof *unknown);
    map = sl_calloc(2 * (int64_t)patch->nv, sizeof *map);
    if (unknown == NULL || map == NULL) {
        status = SL_OUT_OF_MEMORY;
        goto cleanup;
    }
    int32_t n = 0;
    for (int32_t v = 0; v < patch->nv; v++) {
        unknown[v] = patch->border[v] != 0 ? -1 : n++;
    }
    place_border(patch, first[1], halfedge, map);
    if (n > 0) {
        SL_TRY(solve_interior(patch, weights, n, unknown, map));
    }
    scale_to_area(patch, map);
    SL_TRY(sl_report_progress(context, "embedding by Tutte", 1.0));
    for (int64_t i = 0; i < 2 * (int64_t)patch->nv; i++) {
        uv[i] = map[i];
    }
cleanup:
    sl_free(first);
    sl_free(halfedge);
    sl_free(unknown);
    sl_free(map);
    return status;
}
