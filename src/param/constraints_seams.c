/* Right angles where seams meet between charts. */
#include <math.h>

#include "geom/vec3.h"
#include "param/constraints.h"

static const double pi = 3.14159265358979323846;

enum { FEWEST = 2, MOST = 4 };

/* Angle and triangles of a chart at one of its border vertices. */
static double measure(const sl_patch *patch, int32_t vertex, int32_t *triangles)
{
    const double *p = &patch->xyz[3 * (int64_t)vertex];
    double sum = 0.0;
    *triangles = 0;
    for (int32_t c = patch->outgoing[vertex]; c >= 0; c = sl_corner_rotate(patch, c)) {
        double a[3], b[3], normal[3];
        sl_vec3_sub(&patch->xyz[3 * (int64_t)patch->tri[sl_corner_next(c)]], p, a);
        sl_vec3_sub(&patch->xyz[3 * (int64_t)patch->tri[sl_corner_prev(c)]], p, b);
        sl_vec3_cross(a, b, normal);
        sum += atan2(sl_vec3_norm(normal), sl_vec3_dot(a, b));
        ++*triangles;
    }
    return sum;
}

static sl_status check_vertex(const sl_patch *patch, int32_t vertex, int32_t chart, sl_diag *diag)
{
    if (vertex >= 0 && vertex < patch->nv && patch->border[vertex] != 0) {
        return SL_OK;
    }
    sl_diag_reason(diag, "chart %d of those around the point has no border vertex %d", chart + 1, vertex);
    return SL_BAD_INPUT;
}

sl_status sl_constraints_cross_seams(int32_t count, const sl_patch *const *patch, const int32_t *vertex,
                                     sl_constraint *item, sl_diag *diag)
{
    int32_t triangles[MOST], widest = 0;
    double angle[MOST];
    if (count < FEWEST || count > MOST) {
        sl_diag_reason(diag, "%d charts around a point cannot make right angles; two, three and four can", count);
        return SL_INFEASIBLE;
    }
    for (int32_t k = 0; k < count; k++) {
        const sl_status status = check_vertex(patch[k], vertex[k], k, diag);
        if (status != SL_OK) {
            return status;
        }
        angle[k] = measure(patch[k], vertex[k], &triangles[k]);
        widest = angle[k] > angle[widest] ? k : widest;
    }
    for (int32_t k = 0; k < count; k++) {
        const bool straight = count == 2 || (count == 3 && k == widest);
        if (straight && triangles[k] < 2) {
            sl_diag_reason(diag, "one triangle of chart %d cannot be straight at vertex %d", k + 1, vertex[k]);
            sl_diag_hint(diag, "refine the mesh there");
            return SL_INFEASIBLE;
        }
        item[k] = (sl_constraint){SL_CONSTRAINT_ANGLE, 1, &vertex[k], straight ? pi : 0.5 * pi};
    }
    return SL_OK;
}
