/* Seams of a coarse surface carried over to the fine one: shortest paths near the coarse arcs. */
#include "optimize/decimate_internal.h"

#include "base/memory.h"

#include <math.h>
#include <string.h>

enum { CLOSED_PARTS = 3 }; /* paths that a closed arc becomes */

typedef struct heap_entry {
    double distance;
    int32_t vertex;
} heap_entry;

typedef struct carrying {
    const sl_opt_state *coarse;
    const int32_t *vertex;
    sl_opt_state *fine;
    uint8_t *taken;   /* fine nv: vertices on seams, and ends of arcs */
    double *distance; /* fine nv */
    int32_t *parent;  /* fine nv: halfedge that leads to the vertex */
    uint8_t *settled; /* fine nv */
    int32_t *touched; /* vertices reached */
    int32_t ntouched;
    heap_entry *heap;
    int64_t size, capacity;
    int32_t *line, nline; /* coarse part at hand, as fine vertices */
    double width;         /* of the corridor: the mean edge of the part */
} carrying;

static void clear(carrying *c)
{
    sl_free(c->taken);
    sl_free(c->distance);
    sl_free(c->parent);
    sl_free(c->settled);
    sl_free(c->touched);
    sl_free(c->heap);
    sl_free(c->line);
}

static sl_status init(const sl_opt_state *coarse, const int32_t *vertex, sl_opt_state *fine, carrying *c)
{
    const int32_t nv = fine->surface->patch->nv;
    *c = (carrying){.coarse = coarse,
                    .vertex = vertex,
                    .fine = fine,
                    .taken = sl_calloc(nv, sizeof *c->taken),
                    .distance = sl_alloc(nv, sizeof *c->distance),
                    .parent = sl_alloc(nv, sizeof *c->parent),
                    .settled = sl_calloc(nv, sizeof *c->settled),
                    .touched = sl_alloc(nv, sizeof *c->touched),
                    .line = sl_alloc(3 * (int64_t)coarse->surface->patch->nt + 2, sizeof *c->line)};
    if (c->taken == NULL || c->distance == NULL || c->parent == NULL || c->settled == NULL || c->touched == NULL ||
        c->line == NULL) {
        return SL_OUT_OF_MEMORY;
    }
    for (int32_t v = 0; v < nv; v++) {
        c->distance[v] = HUGE_VAL;
    }
    return SL_OK;
}

static bool before(const heap_entry *a, const heap_entry *b)
{
    return a->distance < b->distance || (a->distance == b->distance && a->vertex < b->vertex);
}

static sl_status push(carrying *c, double distance, int32_t vertex)
{
    const sl_status status = sl_reserve((void **)&c->heap, &c->capacity, c->size + 1, sizeof *c->heap);
    if (status != SL_OK) {
        return status;
    }
    const heap_entry e = {distance, vertex};
    int64_t k = c->size++;
    while (k > 0 && before(&e, &c->heap[(k - 1) / 2])) {
        c->heap[k] = c->heap[(k - 1) / 2];
        k = (k - 1) / 2;
    }
    c->heap[k] = e;
    return SL_OK;
}

static heap_entry pop(carrying *c)
{
    const heap_entry top = c->heap[0], last = c->heap[--c->size];
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

/* Squared distance of fine vertex v from the coarse part. */
static double squared_distance(const carrying *c, int32_t v)
{
    const double *xyz = c->fine->surface->patch->xyz, *p = xyz + 3 * (int64_t)v;
    double least = HUGE_VAL;
    for (int32_t k = 0; k + 1 < c->nline; k++) {
        const double *a = xyz + 3 * (int64_t)c->line[k], *b = xyz + 3 * (int64_t)c->line[k + 1];
        double ab = 0.0, ap = 0.0, sum = 0.0;
        for (int j = 0; j < 3; j++) {
            ab += (b[j] - a[j]) * (b[j] - a[j]);
            ap += (b[j] - a[j]) * (p[j] - a[j]);
        }
        const double s = ab > 0.0 ? fmin(fmax(ap / ab, 0.0), 1.0) : 0.0;
        for (int j = 0; j < 3; j++) {
            const double x = p[j] - a[j] - s * (b[j] - a[j]);
            sum += x * x;
        }
        least = fmin(least, sum);
    }
    return least;
}

static sl_status reach(carrying *c, int32_t v, double distance, int32_t halfedge)
{
    if (c->distance[v] == HUGE_VAL) {
        c->touched[c->ntouched++] = v;
    }
    c->distance[v] = distance;
    c->parent[v] = halfedge;
    return push(c, distance, v);
}

/* Relaxes the edges that leave v; a border vertex's last spoke is a border edge and leads nowhere. */
static sl_status spread(carrying *c, int32_t v, int32_t goal)
{
    sl_status status = SL_OK;
    const sl_opt_surface *s = c->fine->surface;
    const sl_patch *p = s->patch;
    int32_t h = p->outgoing[v];
    do {
        const int32_t w = p->tri[sl_corner_next(h)];
        const bool open = w == goal || (c->taken[w] == 0 && p->border[w] == 0);
        if (p->twin[h] >= 0 && s->cost[h] < HUGE_VAL && open && c->settled[w] == 0) {
            const double off = squared_distance(c, w) / (c->width * c->width);
            const double distance = c->distance[v] + s->cost[h] * (1.0 + off);
            if (distance < c->distance[w]) {
                SL_TRY(reach(c, w, distance, h));
            }
        }
        h = p->twin[sl_corner_prev(h)];
    } while (h >= 0 && h != p->outgoing[v]);
cleanup:
    return status;
}

/* Cuts the shortest path from the first to the last vertex of the line. */
static sl_status cut_path(carrying *c, bool *found)
{
    sl_status status = SL_OK;
    const sl_patch *p = c->fine->surface->patch;
    const int32_t start = c->line[0], goal = c->line[c->nline - 1];
    c->size = 0;
    *found = false;
    SL_TRY(reach(c, start, 0.0, -1));
    while (c->size > 0 && !*found) {
        const int32_t v = pop(c).vertex;
        if (c->settled[v] == 0) {
            c->settled[v] = 1;
            *found = v == goal;
            if (!*found) {
                SL_TRY(spread(c, v, goal));
            }
        }
    }
    for (int32_t v = goal; *found && v != start;) {
        const int32_t h = c->parent[v];
        c->fine->cut[h] = c->fine->cut[p->twin[h]] = 1;
        c->taken[v] = 1;
        v = p->tri[h];
    }
    for (int32_t k = 0; k < c->ntouched; k++) {
        c->distance[c->touched[k]] = HUGE_VAL;
        c->settled[c->touched[k]] = 0;
    }
    c->ntouched = 0;
cleanup:
    return status;
}

static int32_t fine_vertex(const carrying *c, int32_t corner)
{
    const sl_opt_surface *s = c->coarse->surface;
    return c->vertex[s->mesh->input_vertex[s->mesh->origin[s->patch->corner[corner]]]];
}

/* The part of an arc from its halfedge `from` to `to` (not included) as a line of fine vertices. */
static void load_line(carrying *c, const int32_t *arc, int32_t from, int32_t to)
{
    double length = 0.0;
    c->nline = 0;
    for (int32_t k = from; k < to; k++) {
        c->line[c->nline++] = fine_vertex(c, arc[k]);
        length += c->coarse->surface->length[arc[k]] / c->coarse->surface->unit * c->fine->surface->unit;
    }
    c->line[c->nline++] = fine_vertex(c, sl_corner_next(arc[to - 1]));
    c->width = to > from && length > 0.0 ? length / (to - from) : 1.0;
}

/* Arcs that come back to where they start become several paths. */
static int32_t parts_of(const carrying *c, const int32_t *arc, int32_t n)
{
    const bool closed = fine_vertex(c, arc[0]) == fine_vertex(c, sl_corner_next(arc[n - 1]));
    return closed ? (n < CLOSED_PARTS ? n : CLOSED_PARTS) : 1;
}

static sl_status cut_arcs(carrying *c, const sl_opt_arcs *arcs, bool *carried)
{
    sl_status status = SL_OK;
    for (int pass = 0; pass < 2; pass++) { /* the ends first: no path may run through them */
        for (int32_t k = 0; k < arcs->count && *carried; k++) {
            const int32_t *arc = arcs->halfedge + arcs->first[k];
            const int32_t n = arcs->first[k + 1] - arcs->first[k], parts = parts_of(c, arc, n);
            for (int32_t j = 0; j < parts && *carried; j++) {
                load_line(c, arc, (int32_t)((int64_t)j * n / parts), (int32_t)((int64_t)(j + 1) * n / parts));
                if (pass == 0) {
                    c->taken[c->line[0]] = c->taken[c->line[c->nline - 1]] = 1;
                } else {
                    SL_TRY(cut_path(c, carried));
                }
            }
        }
    }
cleanup:
    return status;
}

/* Charts of the fine surface between its seams, not laid flat yet. */
static sl_status make_charts(sl_opt_state *fine, bool *disks)
{
    sl_status status = SL_OK;
    const sl_patch *p = fine->surface->patch;
    int32_t *local = sl_alloc(p->nt, sizeof *local), *list = sl_alloc(p->nt, sizeof *list), n = 0;
    SL_TRY(local == NULL || list == NULL ? SL_OUT_OF_MEMORY : SL_OK);
    memset(local, 0xff, (size_t)p->nt * sizeof *local);
    memset(fine->chart_of, 0xff, (size_t)p->nt * sizeof *fine->chart_of);
    for (int32_t t = 0; t < p->nt; t++) {
        if (fine->chart_of[t] >= 0) {
            continue;
        }
        const int32_t start = n;
        fine->chart_of[t] = (int32_t)fine->nchart;
        list[n++] = t;
        for (int32_t at = start; at < n; at++) {
            for (int32_t h = 3 * list[at]; h < 3 * list[at] + 3; h++) {
                const int32_t g = p->twin[h] >= 0 && fine->cut[h] == 0 ? p->twin[h] / 3 : -1;
                if (g >= 0 && fine->chart_of[g] < 0) {
                    fine->chart_of[g] = (int32_t)fine->nchart;
                    list[n++] = g;
                }
            }
        }
        SL_TRY(sl_reserve((void **)&fine->chart, &fine->capacity, fine->nchart + 1, sizeof *fine->chart));
        sl_opt_chart *chart = &fine->chart[fine->nchart++];
        *chart = (sl_opt_chart){.stamp = fine->next_stamp++};
        SL_TRY(sl_opt_extract(fine->surface, fine->cut, list + start, n - start, local, &chart->patch));
        chart->uv = sl_calloc(2 * (int64_t)chart->patch->nv, sizeof *chart->uv);
        SL_TRY(chart->uv == NULL ? SL_OUT_OF_MEMORY : SL_OK);
        *disks = *disks && sl_patch_is_disk(chart->patch);
    }
cleanup:
    sl_free(local);
    sl_free(list);
    return status;
}

void sl_opt_uncut(sl_opt_state *fine)
{
    const sl_patch *p = fine->surface->patch;
    for (int64_t k = 0; k < fine->nchart; k++) {
        sl_opt_chart_clear(&fine->chart[k]);
    }
    fine->nchart = 0;
    memset(fine->cut, 0, 3 * (size_t)p->nt * sizeof *fine->cut);
    memset(fine->chart_of, 0xff, (size_t)p->nt * sizeof *fine->chart_of);
}

sl_status sl_opt_carry(const sl_opt_state *coarse, const int32_t *vertex, sl_opt_state *fine, bool *carried)
{
    sl_status status = SL_OK;
    sl_opt_arcs arcs = {0};
    carrying c = {0};
    *carried = true;
    SL_TRY(init(coarse, vertex, fine, &c));
    SL_TRY(sl_opt_arcs_init(coarse, &arcs));
    SL_TRY(cut_arcs(&c, &arcs, carried));
    if (*carried) {
        SL_TRY(make_charts(fine, carried));
        *carried = *carried && fine->nchart == coarse->nchart;
    }
    if (*carried) {
        fine->w = coarse->w;
        SL_TRY(sl_opt_unfold(fine, carried));
    }
cleanup:
    if (status != SL_OK || !*carried) {
        sl_opt_uncut(fine);
    }
    clear(&c);
    sl_opt_arcs_clear(&arcs);
    return status;
}
