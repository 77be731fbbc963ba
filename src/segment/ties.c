/* Ways of equal length: which one is taken must not hang on how vertices are numbered, nor on rounding. */
#include "segment/segment_internal.h"

#include "base/memory.h"

#include <math.h>

/* By how much an edge at the centre costs more than the farthest one: far above what rounding, a translation by a
 * thousand diagonals or another scale does to a length, far below what anybody sees in one. */
static const double LEAN = 0x1p-20;

static void centre_of(const sl_mesh *mesh, double centre[3])
{
    double total = 0.0;
    centre[0] = centre[1] = centre[2] = 0.0;
    for (int32_t f = 0; f < mesh->nf; f++) {
        double c[3];
        const double area = sl_mesh_face_area(mesh, f);
        sl_mesh_face_centroid(mesh, f, c);
        for (int k = 0; k < 3; k++) {
            centre[k] += area * c[k];
        }
        total += area;
    }
    for (int k = 0; k < 3; k++) {
        centre[k] = total > 0.0 ? centre[k] / total : 0.0;
    }
}

sl_status sl_lean_weights(const sl_mesh *mesh, const double *weight, double **out)
{
    double centre[3], farthest = 0.0;
    double *lean = sl_alloc(mesh->nh, sizeof *lean);
    *out = lean;
    if (lean == NULL) {
        return SL_OUT_OF_MEMORY;
    }
    centre_of(mesh, centre);
    for (int32_t h = 0; h < mesh->nh; h++) { /* a sum of two does not depend on their order: both halfedges alike */
        const double *a = mesh->xyz + 3 * (int64_t)mesh->origin[h];
        const double *b = mesh->xyz + 3 * (int64_t)mesh->origin[sl_next(mesh, h)];
        lean[h] = 0.0;
        for (int k = 0; k < 3; k++) {
            const double gap = 0.5 * (a[k] + b[k]) - centre[k];
            lean[h] += gap * gap;
        }
        farthest = fmax(farthest, lean[h]);
    }
    for (int32_t h = 0; h < mesh->nh; h++) {
        const double share = farthest > 0.0 ? lean[h] / farthest : 1.0;
        lean[h] = (weight != NULL ? weight[h] : 1.0) * (1.0 + LEAN * (1.0 - share));
    }
    return SL_OK;
}
