/* Dijkstra's search in a corridor along a line. */
#include "optimize/near_path_internal.h"

#include "base/memory.h"
#include "geom/vec3.h"

#include <math.h>

void sl_near_path_clear(sl_near_path *path)
{
    sl_free(path->taken);
    sl_free(path->line);
    sl_free(path->parent);
    sl_free(path->distance);
    sl_free(path->off);
    sl_free(path->settled);
    sl_free(path->touched);
    sl_free(path->heap);
    *path = (sl_near_path){0};
}

sl_status sl_near_path_init(const sl_opt_surface *surface, int32_t most, sl_near_path *out)
{
    const int32_t nv = surface->patch->nv;
    *out = (sl_near_path){.surface = surface,
                          .width = 1.0,
                          .taken = sl_calloc(nv, sizeof *out->taken),
                          .line = sl_alloc(most, sizeof *out->line),
                          .parent = sl_alloc(nv, sizeof *out->parent),
                          .distance = sl_alloc(nv, sizeof *out->distance),
                          .off = sl_alloc(nv, sizeof *out->off),
                          .settled = sl_calloc(nv, sizeof *out->settled),
                          .touched = sl_alloc(nv, sizeof *out->touched)};
    if (out->taken == NULL || out->line == NULL || out->parent == NULL || out->distance == NULL || out->off == NULL ||
        out->settled == NULL || out->touched == NULL) {
        return SL_OUT_OF_MEMORY;
    }
    for (int32_t v = 0; v < nv; v++) {
        out->distance[v] = HUGE_VAL;
        out->off[v] = -1.0;
    }
    return SL_OK;
}

static bool before(const sl_near_heap *a, const sl_near_heap *b)
{
    return a->distance < b->distance || (a->distance == b->distance && a->vertex < b->vertex);
}

static sl_status push(sl_near_path *c, double distance, int32_t vertex)
{
    const sl_status status = sl_reserve((void **)&c->heap, &c->capacity, c->size + 1, sizeof *c->heap);
    if (status != SL_OK) {
        return status;
    }
    const sl_near_heap e = {distance, vertex};
    int64_t k = c->size++;
    while (k > 0 && before(&e, &c->heap[(k - 1) / 2])) {
        c->heap[k] = c->heap[(k - 1) / 2];
        k = (k - 1) / 2;
    }
    c->heap[k] = e;
    return SL_OK;
}

static sl_near_heap pop(sl_near_path *c)
{
    const sl_near_heap top = c->heap[0], last = c->heap[--c->size];
    int64_t k = 0;
    while (2 * k + 1 < c->size) {
        int64_t child = 2 * k + 1;
        child += child + 1 < c->size && before(&c->heap[child + 1], &c->heap[child]);
        if (!before(&c->heap[child], &last)) {
            break;
        }
        c->heap[k] = c->heap[child];
        k = child;
    }
    c->heap[k] = last;
    return top;
}

/* Squared distance of vertex v from the line. */
static double squared_distance(const sl_near_path *c, int32_t v)
{
    const double *xyz = c->surface->patch->xyz, *p = xyz + 3 * (int64_t)v;
    double least = HUGE_VAL;
    for (int32_t k = 0; k + 1 < c->nline; k++) {
        const double *a = xyz + 3 * (int64_t)c->line[k], *b = xyz + 3 * (int64_t)c->line[k + 1];
        double ab[3], ap[3];
        sl_vec3_sub(b, a, ab);
        sl_vec3_sub(p, a, ap);
        const double square = sl_vec3_dot(ab, ab);
        const double s = square > 0.0 ? fmin(fmax(sl_vec3_dot(ab, ap) / square, 0.0), 1.0) : 0.0;
        for (int j = 0; j < 3; j++) {
            ap[j] -= s * ab[j];
        }
        least = fmin(least, sl_vec3_dot(ap, ap));
    }
    return least;
}

/* What the corridor adds to the cost of coming to v, once for each search. */
static double off_line(sl_near_path *c, int32_t v)
{
    if (c->off[v] < 0.0) {
        c->off[v] = squared_distance(c, v) / (c->width * c->width);
        c->touched[c->ntouched++] = v;
    }
    return c->off[v];
}

static sl_status reach(sl_near_path *c, int32_t v, double distance, int32_t halfedge)
{
    c->distance[v] = distance;
    c->parent[v] = halfedge;
    return push(c, distance, v);
}

/* Relaxes the edges that leave v; a border vertex's last spoke is a border edge and leads nowhere. */
static sl_status spread(sl_near_path *c, int32_t v, int32_t goal)
{
    sl_status status = SL_OK;
    const sl_opt_surface *s = c->surface;
    const sl_patch *p = s->patch;
    int32_t h = p->outgoing[v];
    do {
        const int32_t w = p->tri[sl_corner_next(h)];
        const bool open = w == goal || (c->taken[w] == 0 && p->border[w] == 0);
        if (p->twin[h] >= 0 && s->cost[h] < HUGE_VAL && open && c->settled[w] == 0) {
            const double distance = c->distance[v] + s->cost[h] * (1.0 + off_line(c, w));
            if (distance < c->distance[w]) {
                SL_TRY(reach(c, w, distance, h));
            }
        }
        h = p->twin[sl_corner_prev(h)];
    } while (h >= 0 && h != p->outgoing[v]);
cleanup:
    return status;
}

/* Leaves the work as the next search wants it; parents stay, for the caller to follow. */
static void forget(sl_near_path *c)
{
    for (int32_t k = 0; k < c->ntouched; k++) {
        c->distance[c->touched[k]] = HUGE_VAL;
        c->off[c->touched[k]] = -1.0;
        c->settled[c->touched[k]] = 0;
    }
    c->ntouched = 0;
    c->size = 0;
}

sl_status sl_near_path_find(sl_near_path *c, double *cost)
{
    sl_status status = SL_OK;
    const sl_patch *p = c->surface->patch;
    const int32_t start = c->line[0], goal = c->line[c->nline - 1];
    bool found = false;
    *cost = HUGE_VAL;
    (void)off_line(c, start);
    SL_TRY(reach(c, start, 0.0, -1));
    while (c->size > 0 && !found) {
        const int32_t v = pop(c).vertex;
        if (c->settled[v] == 0) {
            c->settled[v] = 1;
            found = v == goal;
            if (!found) {
                SL_TRY(spread(c, v, goal));
            }
        }
    }
    if (found) {
        *cost = 0.0;
        for (int32_t v = goal; v != start; v = p->tri[c->parent[v]]) {
            *cost += c->surface->cost[c->parent[v]];
        }
    }
cleanup:
    forget(c);
    return status;
}
