#include "crossing.h"

#include "base/memory.h"
#include "geom/vec3.h"

#include <math.h>
#include <stdlib.h>

typedef struct box {
    double lo[3], hi[3];
    int32_t triangle;
} box;

static int compare_boxes(const void *a, const void *b)
{
    const box *x = a, *y = b;
    return x->lo[0] < y->lo[0] ? -1 : x->lo[0] > y->lo[0] ? 1 : x->triangle - y->triangle;
}

static const double *point(const sl_mesh *m, const sl_triangulation *t, int32_t triangle, int k)
{
    return m->xyz + 3 * (int64_t)m->origin[t->corner[3 * triangle + k]];
}

/* Six times the signed volume of a tetrahedron. */
static double volume(const double *a, const double *b, const double *c, const double *d)
{
    double u[3], v[3], w[3], n[3];
    sl_vec3_sub(b, a, u);
    sl_vec3_sub(c, a, v);
    sl_vec3_sub(d, a, w);
    sl_vec3_cross(u, v, n);
    return sl_vec3_dot(n, w);
}

/* Rounding of a volume where coordinates are at most 1: coplanar neighbours do not pierce one another. */
static const double rounding = 64 * 0x1p-52;

/* Does the open segment pq pass through the inside of triangle abc? */
static bool pierces(const double *p, const double *q, const double *a, const double *b, const double *c)
{
    const double above = volume(a, b, c, p), below = volume(a, b, c, q);
    if (!((above > rounding && below < -rounding) || (above < -rounding && below > rounding))) {
        return false;
    }
    const double ab = volume(p, q, a, b), bc = volume(p, q, b, c), ca = volume(p, q, c, a);
    return (ab > 0.0 && bc > 0.0 && ca > 0.0) || (ab < 0.0 && bc < 0.0 && ca < 0.0);
}

static bool cross(const sl_mesh *m, const sl_triangulation *t, int32_t s, int32_t r)
{
    for (int k = 0; k < 3; k++) {
        if (pierces(point(m, t, s, k), point(m, t, s, (k + 1) % 3), point(m, t, r, 0), point(m, t, r, 1),
                    point(m, t, r, 2)) ||
            pierces(point(m, t, r, k), point(m, t, r, (k + 1) % 3), point(m, t, s, 0), point(m, t, s, 1),
                    point(m, t, s, 2))) {
            return true;
        }
    }
    return false;
}

static bool share_vertex(const sl_mesh *m, const sl_triangulation *t, int32_t s, int32_t r)
{
    for (int k = 0; k < 9; k++) {
        if (m->origin[t->corner[3 * s + k / 3]] == m->origin[t->corner[3 * r + k % 3]]) {
            return true;
        }
    }
    return false;
}

static void fill_box(const sl_mesh *m, const sl_triangulation *t, int32_t i, box *b)
{
    b->triangle = i;
    for (int axis = 0; axis < 3; axis++) {
        b->lo[axis] = fmin(fmin(point(m, t, i, 0)[axis], point(m, t, i, 1)[axis]), point(m, t, i, 2)[axis]);
        b->hi[axis] = fmax(fmax(point(m, t, i, 0)[axis], point(m, t, i, 1)[axis]), point(m, t, i, 2)[axis]);
    }
}

int64_t test_count_crossings(const sl_mesh *mesh, const sl_triangulation *triangulation)
{
    int64_t found = 0;
    box *boxes = sl_alloc(triangulation->nt, sizeof *boxes);
    if (boxes == NULL) {
        return -1;
    }
    for (int32_t i = 0; i < triangulation->nt; i++) {
        fill_box(mesh, triangulation, i, &boxes[i]);
    }
    qsort(boxes, (size_t)triangulation->nt, sizeof *boxes, compare_boxes);
    for (int32_t i = 0; i < triangulation->nt; i++) {
        for (int32_t k = i + 1; k < triangulation->nt && boxes[k].lo[0] <= boxes[i].hi[0]; k++) {
            const box *a = &boxes[i], *b = &boxes[k];
            if (a->lo[1] <= b->hi[1] && b->lo[1] <= a->hi[1] && a->lo[2] <= b->hi[2] && b->lo[2] <= a->hi[2] &&
                !share_vertex(mesh, triangulation, a->triangle, b->triangle)) {
                found += cross(mesh, triangulation, a->triangle, b->triangle);
            }
        }
    }
    sl_free(boxes);
    return found;
}
