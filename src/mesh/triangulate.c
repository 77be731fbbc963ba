#include "mesh/triangulate.h"

#include <math.h>

#include "base/memory.h"
#include "geom/vec3.h"
#include "mesh/ear_clip_internal.h"

/* A triangle of the fan is degenerate when its height is below this share of its longest side. */
static const double flat_height = 0x1p-46;

static const double *corner_xyz(const sl_mesh *m, int32_t h)
{
    return m->xyz + 3 * (int64_t)m->origin[h];
}

/* Does the fan from the first corner turn the facet's way everywhere? n: the facet's vector area. */
static bool fan_is_good(const sl_mesh *m, int32_t f, const double n[3])
{
    const int32_t first = m->face_first[f], end = m->face_first[f + 1];
    const double length = sl_vec3_norm(n);
    for (int32_t h = first + 1; h + 1 < end; h++) {
        double a[3], b[3], c[3], t[3];
        sl_vec3_sub(corner_xyz(m, h), corner_xyz(m, first), a);
        sl_vec3_sub(corner_xyz(m, h + 1), corner_xyz(m, first), b);
        sl_vec3_sub(b, a, c);
        sl_vec3_cross(a, b, t);
        const double side = fmax(sl_vec3_dot(a, a), fmax(sl_vec3_dot(b, b), sl_vec3_dot(c, c)));
        if (!(sl_vec3_dot(t, n) > flat_height * side * length)) {
            return false;
        }
    }
    return true;
}

/* The facet's corners in its own plane, largest coordinate 1. n: its vector area, not 0. */
static void project(const sl_mesh *m, int32_t f, const double n[3], double *xy)
{
    const int32_t first = m->face_first[f], d = sl_degree(m, f);
    const double length = sl_vec3_norm(n), unit[3] = {n[0] / length, n[1] / length, n[2] / length};
    int thin = 0; /* the axis least along the normal */
    for (int k = 1; k < 3; k++) {
        thin = fabs(unit[k]) < fabs(unit[thin]) ? k : thin;
    }
    double axis[3] = {0.0, 0.0, 0.0}, u[3], v[3], reach = 0.0;
    axis[thin] = 1.0;
    sl_vec3_cross(axis, unit, u);
    sl_vec3_cross(unit, u, v);
    const double u_length = sl_vec3_norm(u);
    for (int32_t k = 0; k < d; k++) {
        double p[3];
        sl_vec3_sub(corner_xyz(m, first + k), corner_xyz(m, first), p);
        xy[2 * k] = sl_vec3_dot(p, u) / u_length;
        xy[2 * k + 1] = sl_vec3_dot(p, v) / u_length;
        reach = fmax(reach, fmax(fabs(xy[2 * k]), fabs(xy[2 * k + 1])));
    }
    for (int32_t k = 0; k < 2 * d && reach > 0.0; k++) {
        xy[k] /= reach;
        xy[k] = fabs(xy[k]) < 0x1p-200 ? 0.0 : xy[k]; /* keeps the exact predicate clear of underflow */
    }
}

static void triangulate_facet(const sl_mesh *m, int32_t f, sl_ear_clipper *clipper, int32_t *corner)
{
    const int32_t first = m->face_first[f], d = sl_degree(m, f);
    double n[3];
    sl_mesh_face_vector_area(m, f, n);
    if (d == 3 || sl_vec3_norm(n) == 0.0 || fan_is_good(m, f, n)) {
        for (int32_t k = 1; k + 1 < d; k++) {
            *corner++ = first;
            *corner++ = first + k;
            *corner++ = first + k + 1;
        }
        return;
    }
    project(m, f, n, clipper->xy);
    sl_ear_clip(clipper, d, corner);
    for (int32_t k = 0; k < 3 * (d - 2); k++) {
        corner[k] += first;
    }
}

sl_status sl_triangulation_create(const sl_mesh *mesh, sl_triangulation **out)
{
    sl_status status = SL_OK;
    sl_ear_clipper clipper = {0};
    int32_t degree = 3;
    for (int32_t f = 0; f < mesh->nf; f++) {
        degree = sl_degree(mesh, f) > degree ? sl_degree(mesh, f) : degree;
    }
    const int64_t nt = (int64_t)mesh->nh - 2 * (int64_t)mesh->nf;
    sl_triangulation *t = sl_calloc(1, sizeof *t);
    SL_TRY(t != NULL && 3 * nt <= INT32_MAX ? SL_OK : SL_OUT_OF_MEMORY);
    t->nt = (int32_t)nt;
    t->first = sl_alloc((int64_t)mesh->nf + 1, sizeof *t->first);
    t->corner = sl_alloc(3 * nt, sizeof *t->corner);
    SL_TRY(t->first != NULL && t->corner != NULL ? SL_OK : SL_OUT_OF_MEMORY);
    SL_TRY(sl_ear_clipper_init(degree, &clipper));
    t->first[0] = 0;
    for (int32_t f = 0; f < mesh->nf; f++) {
        t->first[f + 1] = t->first[f] + sl_degree(mesh, f) - 2;
        triangulate_facet(mesh, f, &clipper, t->corner + 3 * (int64_t)t->first[f]);
    }
    *out = t;
    t = NULL;
cleanup:
    sl_triangulation_free(t);
    sl_ear_clipper_clear(&clipper);
    return status;
}

void sl_triangulation_free(sl_triangulation *triangulation)
{
    if (triangulation == NULL) {
        return;
    }
    sl_free(triangulation->first);
    sl_free(triangulation->corner);
    sl_free(triangulation);
}
