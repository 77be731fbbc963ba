#include "support/turning.h"

#include "geom/vec3.h"

#include <math.h>

double exp_seam_turning(const sl_mesh *mesh)
{
    int32_t *degree = sl_calloc(mesh->nv, sizeof *degree), *ends = sl_alloc(2 * (int64_t)mesh->nv, sizeof *ends);
    double sum = 0.0;
    int32_t corners = 0;
    if (degree == NULL || ends == NULL) {
        sl_free(degree);
        sl_free(ends);
        return NAN;
    }
    for (int32_t h = 0; h < mesh->nh; h++) {
        const int32_t v = mesh->origin[h], w = sl_target(mesh, h);
        if (mesh->sew[h] > h) {
            for (int k = 0; k < 2; k++) {
                const int32_t at = k == 0 ? v : w, other = k == 0 ? w : v;
                if (degree[at] < 2) {
                    ends[2 * (int64_t)at + degree[at]] = other;
                }
                degree[at]++;
            }
        }
    }
    for (int32_t v = 0; v < mesh->nv; v++) {
        if (degree[v] == 2) {
            double in[3], out[3], normal[3];
            sl_vec3_sub(mesh->xyz + 3 * (int64_t)v, mesh->xyz + 3 * (int64_t)ends[2 * (int64_t)v], in);
            sl_vec3_sub(mesh->xyz + 3 * (int64_t)ends[2 * (int64_t)v + 1], mesh->xyz + 3 * (int64_t)v, out);
            sl_vec3_cross(in, out, normal);
            sum += atan2(sl_vec3_norm(normal), sl_vec3_dot(in, out));
            corners++;
        }
    }
    sl_free(degree);
    sl_free(ends);
    return corners > 0 ? sum / corners * 180.0 / acos(-1.0) : 0.0;
}
