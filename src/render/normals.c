#include "render/normals.h"
#include "base/memory.h"
#include "geom/vec3.h"

#include <math.h>

static const double degree = 0.017453292519943295;

typedef struct crease_test {
    const sl_mesh *mesh;
    const double *facet; /* 3 nf, unit or zero */
    double cosine;
} crease_test;

/* Halfedge of the neighbouring facet that leaves the same vertex: across h (backwards) or across prev(h). -1 at a
 * border or a crease. */
static int32_t step(const crease_test *c, int32_t h, bool forward)
{
    const sl_mesh *m = c->mesh;
    const int32_t edge = forward ? sl_prev(m, h) : h;
    const int32_t other = sl_opposite(m, edge);
    if (other < 0) {
        return -1;
    }
    const double cosine = sl_vec3_dot(c->facet + 3 * (int64_t)m->face[h], c->facet + 3 * (int64_t)m->face[other]);
    return cosine < c->cosine ? -1 : forward ? other : sl_next(m, other);
}

static double corner_angle(const sl_mesh *m, int32_t h)
{
    double a[3], b[3], n[3];
    const double *at = m->xyz + 3 * (int64_t)m->origin[h];
    sl_vec3_sub(m->xyz + 3 * (int64_t)sl_target(m, h), at, a);
    sl_vec3_sub(m->xyz + 3 * (int64_t)m->origin[sl_prev(m, h)], at, b);
    sl_vec3_cross(a, b, n);
    const double angle = atan2(sl_vec3_norm(n), sl_vec3_dot(a, b));
    return isfinite(angle) ? angle : 0.0;
}

/* First corner of the run between creases that holds h; h itself when the run goes all round. */
static int32_t first_of_run(const crease_test *c, int32_t h)
{
    int32_t at = h;
    for (int32_t n = 0; n < c->mesh->nh; n++) {
        const int32_t before = step(c, at, false);
        if (before < 0 || before == h) {
            break;
        }
        at = before;
    }
    return step(c, at, false) < 0 ? at : h;
}

static void smooth_run(const crease_test *c, int32_t start, float *normal, uint8_t *done)
{
    double sum[3] = {0.0, 0.0, 0.0};
    int32_t h = start;
    int32_t count = 0;
    do {
        const double angle = corner_angle(c->mesh, h);
        const double *n = c->facet + 3 * (int64_t)c->mesh->face[h];
        for (int k = 0; k < 3; k++) {
            sum[k] += angle * n[k];
        }
        count++;
        h = step(c, h, true);
    } while (h >= 0 && h != start && count < c->mesh->nh);
    const double length = sl_vec3_norm(sum), scale = length > 0.0 ? 1.0 / length : 0.0;
    h = start;
    for (int32_t i = 0; i < count; i++) {
        for (int k = 0; k < 3; k++) {
            normal[3 * (int64_t)h + k] = (float)(scale * sum[k]);
        }
        done[h] = 1;
        h = step(c, h, true);
    }
}

sl_status sl_corner_normals(const sl_mesh *mesh, double crease_degrees, float *normal)
{
    sl_status status = SL_OK;
    double *facet = sl_alloc(mesh->nf, 3 * sizeof *facet);
    uint8_t *done = sl_calloc(mesh->nh, sizeof *done);
    if (facet == NULL || done == NULL) {
        status = SL_OUT_OF_MEMORY;
        goto cleanup;
    }
    for (int32_t f = 0; f < mesh->nf; f++) {
        double *n = facet + 3 * (int64_t)f;
        sl_mesh_face_vector_area(mesh, f, n);
        const double length = sl_vec3_norm(n);
        for (int k = 0; k < 3; k++) {
            n[k] = length > 0.0 ? n[k] / length : 0.0;
        }
    }
    const crease_test test = {mesh, facet, cos(crease_degrees * degree)};
    for (int32_t h = 0; h < mesh->nh; h++) {
        if (done[h] == 0) {
            smooth_run(&test, first_of_run(&test, h), normal, done);
        }
    }
cleanup:
    sl_free(facet);
    sl_free(done);
    return status;
}
