/* Distances along a surface by fast marching. */
#include "segment/geodesic_internal.h"

#include "base/memory.h"
#include "geom/vec3.h"

#include <math.h>

#define PASSES 4          /* sweeps after the march, at most; two settle almost every surface */
#define SETTLED_RTOL 1e-3 /* a pass that lowers no distance by more is the last */

void sl_geodesics_clear(sl_geodesics *g)
{
    sl_free(g->tri);
    sl_free(g->first);
    sl_free(g->incident);
    sl_free(g->length);
    sl_free(g->heap);
    sl_free(g->place);
    sl_free(g->order);
    *g = (sl_geodesics){0};
}

static void list_incident(sl_geodesics *g)
{
    const int32_t nv = g->mesh->nv;
    for (int32_t c = 0; c < 3 * g->nt; c++) {
        g->first[g->tri[c] + 1]++;
    }
    for (int32_t v = 0; v < nv; v++) {
        g->first[v + 1] += g->first[v];
        g->place[v] = g->first[v];
    }
    for (int32_t c = 0; c < 3 * g->nt; c++) {
        g->incident[g->place[g->tri[c]]++] = c;
    }
}

/* length[3 t + k] = of the edge across from corner k of triangle t. */
static void measure_edges(sl_geodesics *g)
{
    for (int32_t t = 0; t < g->nt; t++) {
        for (int32_t k = 0; k < 3; k++) {
            const int32_t a = g->tri[3 * t + (k + 1) % 3], b = g->tri[3 * t + (k + 2) % 3];
            double d[3];
            sl_vec3_sub(g->mesh->xyz + 3 * (int64_t)a, g->mesh->xyz + 3 * (int64_t)b, d);
            g->length[3 * t + k] = sl_vec3_norm(d);
        }
    }
}

sl_status sl_geodesics_create(const sl_mesh *mesh, const sl_triangulation *triangulation, sl_geodesics *out)
{
    const int64_t nv = mesh->nv, nt = triangulation->nt;
    sl_geodesics g = {.mesh = mesh, .nt = triangulation->nt};
    g.tri = sl_alloc(3 * nt, sizeof *g.tri);
    g.first = sl_calloc(nv + 1, sizeof *g.first);
    g.incident = sl_alloc(3 * nt, sizeof *g.incident);
    g.length = sl_alloc(3 * nt, sizeof *g.length);
    g.heap = sl_alloc(nv, sizeof *g.heap);
    g.place = sl_alloc(nv, sizeof *g.place);
    g.order = sl_alloc(nv, sizeof *g.order);
    *out = (sl_geodesics){0};
    if (g.tri == NULL || g.first == NULL || g.incident == NULL || g.length == NULL || g.heap == NULL ||
        g.place == NULL || g.order == NULL) {
        sl_geodesics_clear(&g);
        return SL_OUT_OF_MEMORY;
    }
    for (int64_t c = 0; c < 3 * nt; c++) {
        g.tri[c] = mesh->origin[triangulation->corner[c]];
    }
    list_incident(&g);
    measure_edges(&g);
    *out = g;
    return SL_OK;
}

/* Moves vertex v to its place in the queue, upwards only: distances fall. */
static void sift_up(sl_geodesics *g, const double *distance, int32_t v)
{
    int32_t at = g->place[v];
    while (at > 0 && distance[v] < distance[g->heap[(at - 1) / 2]]) {
        g->heap[at] = g->heap[(at - 1) / 2];
        g->place[g->heap[at]] = at;
        at = (at - 1) / 2;
    }
    g->heap[at] = v;
    g->place[v] = at;
}

static int32_t pop(sl_geodesics *g, const double *distance)
{
    const int32_t top = g->heap[0], last = g->heap[--g->queued];
    int32_t at = 0;
    for (int32_t child = 1; child < g->queued; child = 2 * at + 1) {
        child += child + 1 < g->queued && distance[g->heap[child + 1]] < distance[g->heap[child]];
        if (distance[g->heap[child]] >= distance[last]) {
            break;
        }
        g->heap[at] = g->heap[child];
        g->place[g->heap[at]] = at;
        at = child;
    }
    if (g->queued > 0) {
        g->heap[at] = last;
        g->place[last] = at;
    }
    return top;
}

static int32_t next_corner(int32_t c)
{
    return c % 3 == 2 ? c - 2 : c + 1;
}

/* What its triangle makes of the distance of the vertex x at corner c: at most `best`. Where the front enters through
 * the edge ab across, the source is unfolded into the plane of the triangle: a at the origin, b at (e, 0), x above, the
 * source below the edge. */
static double through_triangle(const sl_geodesics *g, const double *distance, int32_t c, double best)
{
    const int32_t ca = next_corner(c), cb = next_corner(ca);
    const double da = distance[g->tri[ca]], db = distance[g->tri[cb]];
    if (da >= best && db >= best) {
        return best;
    }
    const double e = g->length[c], ax = g->length[cb], bx = g->length[ca];
    best = fmin(best, fmin(da + ax, db + bx));
    if (!(da + db < HUGE_VAL) || !(e > 0.0) || fabs(da - db) > e || da + db < e) {
        return best;
    }
    const double px = (ax * ax - bx * bx + e * e) / (2.0 * e), py = sqrt(fmax(ax * ax - px * px, 0.0));
    const double sx = (da * da - db * db + e * e) / (2.0 * e), sy = sqrt(fmax(da * da - sx * sx, 0.0));
    const double cross = sx * (py + sy) + (px - sx) * sy; /* where the line meets the edge, times py + sy */
    if (!(py + sy > 0.0) || cross < 0.0 || cross > e * (py + sy)) {
        return best;
    }
    return fmin(best, sqrt((px - sx) * (px - sx) + (py + sy) * (py + sy)));
}

static double best_distance(const sl_geodesics *g, const double *distance, int32_t x)
{
    double best = distance[x];
    for (int32_t p = g->first[x]; p < g->first[x + 1]; p++) {
        best = through_triangle(g, distance, g->incident[p], best);
    }
    return best;
}

/* Takes the nearest vertex after the other, and tells those around it. */
static void march(sl_geodesics *g, int32_t source, double *distance)
{
    enum { UNSEEN = -1, SETTLED = -2 };
    for (int32_t v = 0; v < g->mesh->nv; v++) {
        distance[v] = HUGE_VAL;
        g->place[v] = UNSEEN;
    }
    distance[source] = 0.0;
    g->heap[0] = source;
    g->place[source] = 0;
    g->queued = 1;
    g->settled = 0;
    while (g->queued > 0) {
        const int32_t v = pop(g, distance);
        g->place[v] = SETTLED;
        g->order[g->settled++] = v;
        for (int32_t p = g->first[v]; p < g->first[v + 1]; p++) {
            int32_t c = next_corner(g->incident[p]);
            for (int32_t k = 0; k < 2; k++, c = next_corner(c)) {
                const int32_t x = g->tri[c];
                if (g->place[x] == SETTLED || x == v) {
                    continue;
                }
                const double d = through_triangle(g, distance, c, distance[x]);
                if (d < distance[x]) {
                    distance[x] = d;
                    g->place[x] = g->place[x] == UNSEEN ? g->queued++ : g->place[x];
                    sift_up(g, distance, x);
                }
            }
        }
    }
}

/**
 * Distances from one vertex along the surface.
 *
 * Fast marching with an unfolded source: exact where the surface between source and vertex is developable and the
 * triangles are met in the order of their distances; across obtuse triangles they may not be, and sweeps in the order
 * of the march mend what that did.
 *
 * @param[in,out] g         workspace
 * @param[in]     source    vertex
 * @param[out]    distance  nv, HUGE_VAL where there is no way
 *
 * No allocation, cannot fail. O(nv log nv + triangles).
 * Source: Kimmel, Sethian 1998, "Computing geodesic paths on manifolds"; the update by an unfolded source: Novotni,
 * Klein 2002, "Computing geodesic distances on triangular meshes".  Deviations: sweeps in place of splitting obtuse
 * triangles.
 */
void sl_geodesics_from(sl_geodesics *g, int32_t source, double *distance)
{
    march(g, source, distance);
    bool changed = true;
    for (int pass = 0; pass < PASSES && changed; pass++) {
        changed = false;
        for (int32_t k = 1; k < g->settled; k++) {
            const int32_t x = g->order[k];
            const double d = best_distance(g, distance, x);
            changed |= d < distance[x] * (1.0 - SETTLED_RTOL);
            distance[x] = d;
        }
    }
}
