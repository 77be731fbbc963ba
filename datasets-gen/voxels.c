#include "voxels.h"

#include "base/memory.h"

#include <string.h>

typedef struct voxel_work {
    gen_cage *cage;
    const int32_t *n;
    const char *const *layer;
    int32_t *made; /* vertex at each grid point, -1 = none yet */
} voxel_work;

static char cell(const voxel_work *w, const int32_t at[3])
{
    for (int axis = 0; axis < 3; axis++) {
        if (at[axis] < 0 || at[axis] >= w->n[axis]) {
            return '.';
        }
    }
    return w->layer[at[2]][at[1] * w->n[0] + at[0]];
}

static int32_t grid_vertex(voxel_work *w, const int32_t at[3])
{
    gen_cage *c = w->cage;
    int32_t *slot = &w->made[at[0] + (w->n[0] + 1) * (at[1] + (w->n[1] + 1) * at[2])];
    if (*slot < 0 && sl_reserve((void **)&c->xyz, &c->xyz_capacity, 3 * (c->nv + 1), sizeof *c->xyz) == SL_OK) {
        for (int axis = 0; axis < 3; axis++) {
            c->xyz[3 * c->nv + axis] = at[axis] - 0.5 * w->n[axis];
        }
        *slot = (int32_t)c->nv++;
    }
    c->failed |= *slot < 0;
    return *slot;
}

static void add_side(voxel_work *w, const int32_t at[3], int axis, bool far_side)
{
    gen_cage *c = w->cage;
    const int u = (axis + 1) % 3, v = (axis + 2) % 3;
    int32_t corner[4];
    for (int k = 0; k < 4; k++) {
        int32_t p[3] = {at[0], at[1], at[2]};
        p[axis] += far_side;
        p[u] += k == 1 || k == 2;
        p[v] += k == 2 || k == 3;
        corner[far_side ? k : 3 - k] = grid_vertex(w, p);
    }
    if (c->failed || sl_reserve((void **)&c->quad, &c->quad_capacity, 4 * (c->nq + 1), sizeof *c->quad) != SL_OK) {
        c->failed = true;
        return;
    }
    memcpy(c->quad + 4 * c->nq++, corner, sizeof corner);
}

static void add_cell(voxel_work *w, const int32_t at[3])
{
    for (int side = 0; side < 6; side++) {
        int32_t next[3] = {at[0], at[1], at[2]};
        next[side / 2] += side % 2 == 1 ? 1 : -1;
        if (cell(w, next) == '.') {
            add_side(w, at, side / 2, side % 2 == 1);
        }
    }
}

void gen_cage_voxels(gen_cage *cage, const int32_t n[3], const char *const *layer)
{
    const int64_t points = (int64_t)(n[0] + 1) * (n[1] + 1) * (n[2] + 1);
    voxel_work w = {cage, n, layer, cage->failed ? NULL : sl_alloc(points, sizeof *w.made)};
    int32_t at[3];
    if (w.made == NULL) {
        cage->failed = true;
        return;
    }
    memset(w.made, -1, (size_t)points * sizeof *w.made);
    for (at[2] = 0; at[2] < n[2]; at[2]++) {
        for (at[1] = 0; at[1] < n[1]; at[1]++) {
            for (at[0] = 0; at[0] < n[0]; at[0]++) {
                if (cell(&w, at) == '#') {
                    add_cell(&w, at);
                }
            }
        }
    }
    sl_free(w.made);
}

void gen_cage_relax_flat(gen_cage *cage, int32_t times)
{
    double *sum = cage->failed ? NULL : sl_alloc(3 * cage->nv, sizeof *sum); /* of x, of y, how many */
    cage->failed |= sum == NULL;
    for (int32_t i = 0; i < times && !cage->failed; i++) {
        memset(sum, 0, 3 * (size_t)cage->nv * sizeof *sum);
        for (int64_t h = 0; h < 4 * cage->nq; h++) { /* a closed cage: each edge twice, once from each end */
            const int64_t a = cage->quad[h], b = cage->quad[h % 4 == 3 ? h - 3 : h + 1];
            sum[3 * a] += cage->xyz[3 * b];
            sum[3 * a + 1] += cage->xyz[3 * b + 1];
            sum[3 * a + 2] += 1.0;
        }
        for (int64_t v = 0; v < cage->nv; v++) {
            for (int k = 0; k < 2; k++) {
                cage->xyz[3 * v + k] = 0.5 * (cage->xyz[3 * v + k] + sum[3 * v + k] / sum[3 * v + 2]);
            }
        }
    }
    sl_free(sum);
}
