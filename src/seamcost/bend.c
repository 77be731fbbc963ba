/* How a surface bends: dihedral angles of edges, and the turn of the normals around a vertex. */
#include "seamcost/seamcost_internal.h"

#include "base/memory.h"
#include "geom/vec3.h"

/* Steps of diffusion at most: finer meshes are smoothed over less than the reach, which their curvature, a quantity
 * that does not depend on the resolution, stands. */
#define MAX_STEPS 64

/* Signed angle between two facets' vector areas over the edge of h, which runs counter-clockwise around the first. */
static double signed_angle(const sl_mesh *mesh, int32_t h, const double a[3], const double b[3])
{
    double along[3], axis[3];
    sl_vec3_cross(a, b, axis);
    sl_vec3_sub(mesh->xyz + 3 * (int64_t)sl_target(mesh, h), mesh->xyz + 3 * (int64_t)mesh->origin[h], along);
    const double sine = sl_vec3_norm(axis), cosine = sl_vec3_dot(a, b);
    return sine == 0.0 && cosine == 0.0 ? 0.0 : atan2(sl_vec3_dot(axis, along) < 0.0 ? -sine : sine, cosine);
}

/* Vector area scaled to 1 (products of tiny ones would underflow), or 0. */
static void unit_normal(const sl_mesh *mesh, int32_t f, double n[3])
{
    sl_mesh_face_vector_area(mesh, f, n);
    const double length = sl_vec3_norm(n);
    for (int k = 0; k < 3; k++) {
        n[k] = length > 0.0 ? n[k] / length : 0.0;
    }
}

double sl_seam_dihedral(const sl_mesh *mesh, int32_t h)
{
    const int32_t t = sl_opposite(mesh, h);
    if (t < 0) {
        return 0.0;
    }
    /* The lower halfedge decides, so that both give the same bits. */
    const int32_t low = h < t ? h : t, high = h < t ? t : h;
    double a[3], b[3];
    unit_normal(mesh, mesh->face[low], a);
    unit_normal(mesh, mesh->face[high], b);
    return signed_angle(mesh, low, a, b);
}

sl_status sl_seam_dihedrals(const sl_mesh *mesh, double *angle)
{
    double *normal = sl_alloc(3 * (int64_t)mesh->nf, sizeof *normal);
    if (normal == NULL) {
        return SL_OUT_OF_MEMORY;
    }
    for (int32_t f = 0; f < mesh->nf; f++) {
        unit_normal(mesh, f, normal + 3 * (int64_t)f);
    }
    for (int32_t h = 0; h < mesh->nh; h++) {
        const int32_t t = sl_opposite(mesh, h);
        if (t < 0) {
            angle[h] = 0.0;
        } else if (h < t) {
            angle[h] = angle[t] =
                signed_angle(mesh, h, normal + 3 * (int64_t)mesh->face[h], normal + 3 * (int64_t)mesh->face[t]);
        }
    }
    sl_free(normal);
    return SL_OK;
}

/* An edge that things spread along. */
typedef struct link {
    int32_t from, to;
    double share; /* of the difference that passes in a step */
} link;

typedef struct spread {
    link *link;
    int32_t count;
    double mean_length;
    double (*value)[2]; /* nv: bend times length, area */
    double (*flow)[2];
} spread;

/* Each edge once, with its length; half its bend and a share of the area to each end. */
static void gather(const sl_mesh *mesh, const double *dihedral, spread *s, int32_t *degree)
{
    double sum = 0.0;
    for (int32_t h = 0; h < mesh->nh; h++) {
        const int32_t t = sl_opposite(mesh, h), a = mesh->origin[h], b = sl_target(mesh, h);
        if (h < t && a != b) {
            const double length = sl_mesh_edge_length(mesh, h);
            s->link[s->count++] = (link){a, b, length};
            s->value[a][0] += 0.5 * length * dihedral[h];
            s->value[b][0] += 0.5 * length * dihedral[h];
            degree[a]++;
            degree[b]++;
            sum += length;
        }
    }
    s->mean_length = s->count > 0 ? sum / s->count : 0.0;
    for (int32_t f = 0; f < mesh->nf; f++) {
        const double area = sl_mesh_face_area(mesh, f) / sl_degree(mesh, f);
        for (int32_t h = mesh->face_first[f]; h < mesh->face_first[f + 1]; h++) {
            s->value[mesh->origin[h]][1] += area;
        }
    }
}

/* Shares of a half over the larger degree keep the step stable and what is spread conserved; edges longer than the
 * reach pass less. */
static void set_shares(spread *s, const int32_t *degree, double reach)
{
    for (int32_t k = 0; k < s->count; k++) {
        link *l = &s->link[k];
        const int32_t d = degree[l->from] > degree[l->to] ? degree[l->from] : degree[l->to];
        const double far = l->share > reach ? reach / l->share : 1.0;
        l->share = 0.5 * far * far / d;
    }
}

static void diffuse(spread *s, int32_t nv)
{
    for (int32_t v = 0; v < nv; v++) {
        s->flow[v][0] = s->flow[v][1] = 0.0;
    }
    for (int32_t k = 0; k < s->count; k++) {
        const link *l = &s->link[k];
        for (int j = 0; j < 2; j++) {
            const double passed = l->share * (s->value[l->from][j] - s->value[l->to][j]);
            s->flow[l->from][j] -= passed;
            s->flow[l->to][j] += passed;
        }
    }
    for (int32_t v = 0; v < nv; v++) {
        s->value[v][0] += s->flow[v][0];
        s->value[v][1] += s->flow[v][1];
    }
}

/* A step spreads over half a squared edge length in the mean. */
static int32_t steps_to(double reach, double length)
{
    const double steps = length > 0.0 ? ceil(2.0 * (reach / length) * (reach / length)) : 0.0;
    return steps < MAX_STEPS ? (int32_t)steps : MAX_STEPS;
}

sl_status sl_seam_turns(const sl_mesh *mesh, const double *dihedral, double reach, double *turn)
{
    sl_status status = SL_OK;
    spread s = {.link = sl_alloc(mesh->nh / 2 + 1, sizeof *s.link),
                .value = sl_calloc(mesh->nv, sizeof *s.value),
                .flow = sl_alloc(mesh->nv, sizeof *s.flow)};
    int32_t *degree = sl_calloc(mesh->nv, sizeof *degree);
    SL_TRY(s.link != NULL && s.value != NULL && s.flow != NULL && degree != NULL ? SL_OK : SL_OUT_OF_MEMORY);
    gather(mesh, dihedral, &s, degree);
    set_shares(&s, degree, reach);
    const int32_t steps = steps_to(reach, s.mean_length);
    for (int32_t k = 0; k < steps; k++) {
        diffuse(&s, mesh->nv);
    }
    for (int32_t v = 0; v < mesh->nv; v++) {
        turn[v] = s.value[v][1] > 0.0 ? 2.0 * reach * s.value[v][0] / s.value[v][1] : 0.0;
    }
cleanup:
    sl_free(s.link);
    sl_free(s.value);
    sl_free(s.flow);
    sl_free(degree);
    return status;
}
