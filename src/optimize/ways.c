/* Cheapest ways along edges that pay for turning, so that they run straight and follow edge loops. */
#include "optimize/ways_internal.h"

#include "base/memory.h"
#include "geom/vec3.h"

#include <math.h>
#include <string.h>

static const double TURN = 0.35; /* price of a right angle, in the cost of the shorter edge beside it */

typedef struct sl_opt_way_entry {
    double distance;
    int32_t halfedge;
} entry;

void sl_opt_ways_clear(sl_opt_ways *w)
{
    sl_free(w->taken);
    sl_free(w->angle);
    sl_free(w->distance);
    sl_free(w->parent);
    sl_free(w->settled);
    sl_free(w->touched);
    sl_free(w->heap);
    *w = (sl_opt_ways){0};
}

static void measure_angles(const sl_opt_surface *s, double *angle)
{
    for (int32_t t = 0; t < s->patch->nt; t++) {
        const double *r = s->rest + 3 * (int64_t)t;
        angle[3 * t] = atan2(r[2], r[1]);
        angle[3 * t + 1] = atan2(r[2], r[0] - r[1]);
        angle[3 * t + 2] = fmax(acos(-1.0) - angle[3 * t] - angle[3 * t + 1], 0.0);
    }
}

sl_status sl_opt_ways_init(const sl_opt_state *state, sl_opt_ways *w)
{
    const sl_opt_surface *s = state->surface;
    const int64_t nh = 3 * (int64_t)s->patch->nt;
    *w = (sl_opt_ways){.state = state,
                       .taken = sl_calloc(s->patch->nv, sizeof *w->taken),
                       .angle = sl_alloc(nh, sizeof *w->angle),
                       .distance = sl_alloc(nh, sizeof *w->distance),
                       .parent = sl_alloc(nh, sizeof *w->parent),
                       .settled = sl_calloc(nh, sizeof *w->settled),
                       .touched = sl_alloc(nh, sizeof *w->touched),
                       .turn = s->weight != NULL ? TURN : 0.0,
                       .least = HUGE_VAL};
    if (w->taken == NULL || w->angle == NULL || w->distance == NULL || w->parent == NULL || w->settled == NULL ||
        w->touched == NULL) {
        return SL_OUT_OF_MEMORY;
    }
    measure_angles(s, w->angle);
    for (int32_t h = 0; h < nh; h++) {
        w->distance[h] = HUGE_VAL;
        w->least = s->length[h] > 0.0 ? fmin(w->least, s->cost[h] / s->length[h]) : w->least;
        if (s->patch->twin[h] < 0 || state->cut[h] != 0) {
            w->taken[s->patch->tri[h]] = w->taken[s->patch->tri[sl_corner_next(h)]] = 1;
        }
    }
    return SL_OK;
}

static bool before(const entry *a, const entry *b)
{
    return a->distance < b->distance || (a->distance == b->distance && a->halfedge < b->halfedge);
}

static sl_status push(sl_opt_ways *w, double distance, int32_t halfedge)
{
    const sl_status status = sl_reserve((void **)&w->heap, &w->capacity, w->size + 1, sizeof *w->heap);
    if (status != SL_OK) {
        return status;
    }
    const entry e = {distance, halfedge};
    int64_t k = w->size++;
    while (k > 0 && before(&e, &w->heap[(k - 1) / 2])) {
        w->heap[k] = w->heap[(k - 1) / 2];
        k = (k - 1) / 2;
    }
    w->heap[k] = e;
    return SL_OK;
}

static entry pop(sl_opt_ways *w)
{
    const entry top = w->heap[0], last = w->heap[--w->size];
    int64_t k = 0;
    while (2 * k + 1 < w->size) {
        int64_t child = 2 * k + 1;
        child += child + 1 < w->size && before(&w->heap[child + 1], &w->heap[child]);
        if (!before(&w->heap[child], &last)) {
            break;
        }
        w->heap[k] = w->heap[child];
        k = child;
    }
    w->heap[k] = last;
    return top;
}

/* What going on from h to g costs beside g: the angles on both sides of the way, as shares of what is around the
 * vertex, say how far it turns in the surface, whatever the surface does there. */
static double turn_cost(const sl_opt_ways *w, int32_t h, double beside, double around, int32_t g)
{
    const double *cost = w->state->surface->cost;
    const double turn = around > 0.0 ? acos(-1.0) * (2.0 * beside / around - 1.0) : 0.0;
    return w->turn * fmin(cost[h], cost[g]) * (1.0 - cos(turn));
}

/* The angle around the vertex where h ends, which must lie inside the surface. */
static double angle_around(const sl_opt_ways *w, int32_t h)
{
    const int32_t *twin = w->state->surface->patch->twin, first = twin[h];
    double sum = 0.0;
    int32_t g = first;
    do {
        sum += w->angle[g];
        g = twin[sl_corner_prev(g)];
    } while (g != first);
    return sum;
}

double sl_opt_way_cost(const sl_opt_ways *w, const int32_t *way, int32_t n)
{
    const int32_t *twin = w->state->surface->patch->twin;
    double sum = 0.0;
    for (int32_t k = 0; k < n; k++) {
        sum += w->state->surface->cost[way[k]];
        if (k > 0) {
            double beside = 0.0;
            for (int32_t g = twin[way[k - 1]]; g != way[k]; g = twin[sl_corner_prev(g)]) {
                beside += w->angle[g];
            }
            sum += turn_cost(w, way[k - 1], beside, angle_around(w, way[k - 1]), way[k]);
        }
    }
    return sum;
}

/* A search at hand. */
typedef struct quest {
    sl_opt_ways *ways;
    const int32_t *old, nold;
    int32_t goal, chart[2];
    double bound, reach;
} quest;

static bool is_within(const quest *q, int32_t h)
{
    const int32_t c = q->ways->state->chart_of[h / 3];
    return c == q->chart[0] || c == q->chart[1];
}

/* Does v lie near the way that is to be replaced? */
static bool is_near(const quest *q, int32_t v)
{
    const sl_patch *p = q->ways->state->surface->patch;
    for (int32_t k = 0; k < q->nold; k++) {
        const int32_t u = p->tri[q->old[k]];
        if (sl_vec3_distance(p->xyz + 3 * (int64_t)u, p->xyz + 3 * (int64_t)v) <= q->reach) {
            return true;
        }
    }
    return v == q->goal;
}

/* May the way use h, at the distance given to its end? */
static bool is_open(const quest *q, int32_t h, double distance)
{
    const sl_opt_ways *w = q->ways;
    const sl_patch *p = w->state->surface->patch;
    if (p->twin[h] < 0 || w->settled[h] != 0 || !(distance < w->distance[h])) {
        return false;
    }
    const int32_t v = p->tri[sl_corner_next(h)];
    if ((w->taken[v] != 0 && v != q->goal) || !is_within(q, h) || !is_within(q, p->twin[h])) {
        return false;
    }
    const double left = sl_vec3_distance(p->xyz + 3 * (int64_t)v, p->xyz + 3 * (int64_t)q->goal);
    return distance + w->least * left < q->bound && is_near(q, v);
}

static sl_status relax(const quest *q, int32_t h, double distance, int32_t parent)
{
    sl_opt_ways *w = q->ways;
    if (!is_open(q, h, distance)) {
        return SL_OK;
    }
    if (w->distance[h] == HUGE_VAL) {
        w->touched[w->ntouched++] = h;
    }
    w->distance[h] = distance;
    w->parent[h] = parent;
    return push(w, distance, h);
}

/* A border vertex's last spoke is a border edge and leads nowhere. */
static sl_status leave(const quest *q, int32_t start)
{
    sl_status status = SL_OK;
    const sl_opt_surface *s = q->ways->state->surface;
    int32_t h = s->patch->outgoing[start];
    do {
        SL_TRY(relax(q, h, s->cost[h], -1));
        h = s->patch->twin[sl_corner_prev(h)];
    } while (h >= 0 && h != s->patch->outgoing[start]);
cleanup:
    return status;
}

/* Every way on from h but back; its end is no vertex that is taken, and so inside. */
static sl_status spread(const quest *q, int32_t h)
{
    sl_status status = SL_OK;
    const sl_opt_ways *w = q->ways;
    const sl_opt_surface *s = w->state->surface;
    const int32_t *twin = s->patch->twin, back = twin[h];
    const double around = angle_around(w, h);
    double beside = w->angle[back];
    for (int32_t g = twin[sl_corner_prev(back)]; g != back; g = twin[sl_corner_prev(g)]) {
        SL_TRY(relax(q, g, w->distance[h] + s->cost[g] + turn_cost(w, h, beside, around, g), h));
        beside += w->angle[g];
    }
cleanup:
    return status;
}

static void trace(const sl_opt_ways *w, int32_t last, int32_t *way, int32_t *n)
{
    *n = 0;
    for (int32_t h = last; h >= 0; h = w->parent[h]) {
        way[(*n)++] = h;
    }
    for (int32_t k = 0; k < *n / 2; k++) {
        const int32_t h = way[k];
        way[k] = way[*n - 1 - k];
        way[*n - 1 - k] = h;
    }
}

sl_status sl_opt_way_find(sl_opt_ways *w, const int32_t *old, int32_t nold, double reach, const int32_t chart[2],
                          double bound, int32_t *way, int32_t *n)
{
    sl_status status = SL_OK;
    const int32_t *tri = w->state->surface->patch->tri, goal = tri[sl_corner_next(old[nold - 1])];
    const quest q = {.ways = w,
                     .old = old,
                     .nold = nold,
                     .goal = goal,
                     .chart = {chart[0], chart[1]},
                     .bound = bound,
                     .reach = reach};
    w->size = 0;
    *n = 0;
    SL_TRY(leave(&q, tri[old[0]]));
    while (w->size > 0 && *n == 0) {
        const int32_t h = pop(w).halfedge;
        if (w->settled[h] == 0) {
            w->settled[h] = 1;
            if (tri[sl_corner_next(h)] == goal) {
                trace(w, h, way, n);
            } else {
                SL_TRY(spread(&q, h));
            }
        }
    }
cleanup:
    for (int32_t k = 0; k < w->ntouched; k++) {
        w->distance[w->touched[k]] = HUGE_VAL;
        w->settled[w->touched[k]] = 0;
    }
    w->ntouched = 0;
    return status;
}
