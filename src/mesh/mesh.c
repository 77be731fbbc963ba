#include "mesh/mesh.h"

#include <math.h>

#include "base/memory.h"
#include "geom/vec3.h"

sl_status sl_mesh_copy(const sl_mesh *mesh, sl_mesh **out)
{
    sl_mesh *m = sl_calloc(1, sizeof *m);
    if (m == NULL) {
        return SL_OUT_OF_MEMORY;
    }
    *m = *mesh;
    m->xyz = sl_copy(mesh->xyz, 3 * (int64_t)mesh->nv, sizeof *m->xyz);
    m->face_first = sl_copy(mesh->face_first, (int64_t)mesh->nf + 1, sizeof *m->face_first);
    m->origin = sl_copy(mesh->origin, mesh->nh, sizeof *m->origin);
    m->face = sl_copy(mesh->face, mesh->nh, sizeof *m->face);
    m->twin = sl_copy(mesh->twin, mesh->nh, sizeof *m->twin);
    m->sew = sl_copy(mesh->sew, mesh->nh, sizeof *m->sew);
    m->input_vertex = sl_copy(mesh->input_vertex, mesh->nv, sizeof *m->input_vertex);
    m->face_flags = sl_copy(mesh->face_flags, mesh->nf, sizeof *m->face_flags);
    if (m->xyz == NULL || m->face_first == NULL || m->origin == NULL || m->face == NULL || m->twin == NULL ||
        m->sew == NULL || m->input_vertex == NULL || m->face_flags == NULL) {
        sl_mesh_free(m);
        return SL_OUT_OF_MEMORY;
    }
    *out = m;
    return SL_OK;
}

void sl_mesh_free(sl_mesh *mesh)
{
    if (mesh == NULL) {
        return;
    }
    sl_free(mesh->xyz);
    sl_free(mesh->face_first);
    sl_free(mesh->origin);
    sl_free(mesh->face);
    sl_free(mesh->twin);
    sl_free(mesh->sew);
    sl_free(mesh->input_vertex);
    sl_free(mesh->face_flags);
    sl_free(mesh);
}

void sl_mesh_cut_edge(sl_mesh *mesh, int32_t h)
{
    const int32_t t = mesh->twin[h];
    if (t >= 0) {
        mesh->twin[h] = mesh->twin[t] = -1;
        mesh->sew[h] = t;
        mesh->sew[t] = h;
    }
}

void sl_mesh_sew_edge(sl_mesh *mesh, int32_t h)
{
    const int32_t t = mesh->sew[h];
    if (t >= 0) {
        mesh->sew[h] = mesh->sew[t] = -1;
        mesh->twin[h] = t;
        mesh->twin[t] = h;
    }
}

void sl_mesh_face_vector_area(const sl_mesh *mesh, int32_t f, double n[3])
{
    const int32_t first = mesh->face_first[f], end = mesh->face_first[f + 1];
    /* Relative to the first corner: the error then scales with the facet, not with its place. */
    const double *p = mesh->xyz + 3 * (int64_t)mesh->origin[first];
    double a[3], b[3], c[3];
    n[0] = n[1] = n[2] = 0.0;
    sl_vec3_sub(mesh->xyz + 3 * (int64_t)mesh->origin[first + 1], p, a);
    for (int32_t h = first + 2; h < end; h++) {
        sl_vec3_sub(mesh->xyz + 3 * (int64_t)mesh->origin[h], p, b);
        sl_vec3_cross(a, b, c);
        for (int k = 0; k < 3; k++) {
            n[k] += 0.5 * c[k];
            a[k] = b[k];
        }
    }
}

double sl_mesh_face_area(const sl_mesh *mesh, int32_t f)
{
    double n[3];
    sl_mesh_face_vector_area(mesh, f, n);
    return sl_vec3_norm(n);
}

void sl_mesh_face_centroid(const sl_mesh *mesh, int32_t f, double c[3])
{
    const int32_t first = mesh->face_first[f], end = mesh->face_first[f + 1];
    c[0] = c[1] = c[2] = 0.0;
    for (int32_t h = first; h < end; h++) {
        sl_vec3_add(c, mesh->xyz + 3 * (int64_t)mesh->origin[h], c);
    }
    for (int k = 0; k < 3; k++) {
        c[k] /= (double)(end - first);
    }
}

double sl_mesh_edge_length(const sl_mesh *mesh, int32_t h)
{
    return sl_vec3_distance(mesh->xyz + 3 * (int64_t)mesh->origin[h], mesh->xyz + 3 * (int64_t)sl_target(mesh, h));
}

double sl_mesh_diagonal(const sl_mesh *mesh)
{
    if (mesh->nv == 0) {
        return 0.0;
    }
    double lo[3], hi[3];
    for (int k = 0; k < 3; k++) {
        lo[k] = hi[k] = mesh->xyz[k];
    }
    for (int64_t i = 3; i < 3 * (int64_t)mesh->nv; i++) {
        lo[i % 3] = fmin(lo[i % 3], mesh->xyz[i]);
        hi[i % 3] = fmax(hi[i % 3], mesh->xyz[i]);
    }
    return sl_vec3_distance(lo, hi);
}
