/* Constraints for a chart, made as a user would: along edges. */
#include "support/sheet.h"

#include <math.h>

static const double bend_cost = 2.0; /* a right angle makes an edge half as long again */

enum { MOST = (int)SL_COUNTOF(((exp_wish *)0)->item) };

void exp_wish_drop(exp_wish *wish)
{
    sl_free((void *)wish->item[--wish->count].vertex);
}

void exp_wish_clear(exp_wish *wish)
{
    while (wish->count > 0) {
        exp_wish_drop(wish);
    }
}

/* Copies the vertices into a new constraint. */
static sl_status add(exp_wish *wish, sl_constraint_kind kind, const int32_t *vertex, int32_t count, double angle)
{
    if (wish->count == MOST) {
        return SL_LIMIT;
    }
    int32_t *own = sl_copy(vertex, count, sizeof *own);
    if (own == NULL) {
        return SL_OUT_OF_MEMORY;
    }
    wish->item[wish->count++] = (sl_constraint){kind, count, own, angle};
    return SL_OK;
}

sl_status exp_wish_angle(exp_wish *wish, int32_t v, double angle)
{
    return add(wish, angle > 0.0 ? SL_CONSTRAINT_ANGLE : SL_CONSTRAINT_RIGHT, &v, 1, angle);
}

/* The search goes over directed edges, so that it knows the turn at each vertex: a line can only be straightened where
 * it leaves two triangles at least on either side. */
typedef struct search {
    const exp_sheet *sheet;
    int32_t a, b;
    bool cross;
    uint8_t *taken; /* nv: on another line */
    sl_graph graph; /* nodes: halfedges of the patch */
} search;

/* May a line run along halfedge c? */
static bool passable(const search *s, int32_t c)
{
    const sl_patch *p = s->sheet->patch;
    const int32_t from = p->tri[c], to = p->tri[sl_corner_next(c)];
    if (p->twin[c] < 0 || !exp_sheet_is_edge(s->sheet, c) || (p->border[from] && from != s->a) ||
        (p->border[to] && to != s->b)) {
        return false;
    }
    if (s->taken[from] && s->taken[to]) {
        return false;
    }
    return s->cross || ((!s->taken[to] || to == s->b) && (!s->taken[from] || from == s->a));
}

static double halfedge_length(const sl_patch *p, int32_t c)
{
    const double *x = &p->xyz[3 * (int64_t)p->tri[c]], *y = &p->xyz[3 * (int64_t)p->tri[sl_corner_next(c)]];
    return sqrt((x[0] - y[0]) * (x[0] - y[0]) + (x[1] - y[1]) * (x[1] - y[1]) + (x[2] - y[2]) * (x[2] - y[2]));
}

/* The edges that may follow c, with their lengths, longer where the line would bend; counts only where next is NULL. */
static int32_t followers(const search *s, int32_t c, int32_t *next, double *weight)
{
    const sl_patch *p = s->sheet->patch;
    const int32_t end = p->tri[sl_corner_next(c)];
    int32_t valence = 0, count = 0, turn = 0;
    if (!passable(s, c) || p->border[end]) {
        return 0;
    }
    int32_t d = p->twin[c];
    do {
        d = p->twin[sl_corner_prev(d)];
        valence++;
    } while (d != p->twin[c]);
    for (d = p->twin[sl_corner_prev(d)], turn = 1; turn < valence; d = p->twin[sl_corner_prev(d)], turn++) {
        if (turn >= 2 && valence - turn >= 2 && passable(s, d)) {
            if (next != NULL) {
                next[count] = d;
                weight[count] = halfedge_length(p, d) * (1.0 + bend_cost * fabs((double)turn / valence - 0.5));
            }
            count++;
        }
    }
    return count;
}

static sl_status build_search(search *s)
{
    const int32_t n = 3 * s->sheet->patch->nt;
    sl_graph *g = &s->graph;
    g->n = n;
    g->first = sl_calloc((int64_t)n + 1, sizeof *g->first);
    if (g->first == NULL) {
        return SL_OUT_OF_MEMORY;
    }
    for (int32_t c = 0; c < n; c++) {
        g->first[c + 1] = g->first[c] + followers(s, c, NULL, NULL);
    }
    g->adj = sl_alloc(g->first[n], sizeof *g->adj);
    g->weight = sl_alloc(g->first[n], sizeof *g->weight);
    if (g->adj == NULL || g->weight == NULL) {
        return SL_OUT_OF_MEMORY;
    }
    for (int32_t c = 0; c < n; c++) {
        followers(s, c, &g->adj[g->first[c]], &g->weight[g->first[c]]);
    }
    return SL_OK;
}

/* The last edge of the shortest way to b; -1 = there is none. */
static sl_status run_search(const search *s, double *distance, int32_t *parent, int32_t *last)
{
    const sl_patch *p = s->sheet->patch;
    int32_t source[64], sources = 0;
    double start[64];
    *last = -1;
    for (int32_t c = 0; c < 3 * p->nt && sources < 64; c++) {
        if (p->tri[c] == s->a && passable(s, c)) {
            start[sources] = halfedge_length(p, c);
            source[sources++] = c;
        }
    }
    if (sources == 0) {
        return SL_OK;
    }
    const sl_status status = sl_graph_shortest_paths(&s->graph, source, sources, start, -1, distance, parent, NULL);
    for (int32_t c = 0; status == SL_OK && c < 3 * p->nt; c++) {
        if (p->tri[sl_corner_next(c)] == s->b && distance[c] < HUGE_VAL &&
            (*last < 0 || distance[c] < distance[*last])) {
            *last = c;
        }
    }
    return status;
}

sl_status exp_wish_path(const exp_sheet *sheet, int32_t a, int32_t b, bool cross, exp_wish *wish)
{
    const sl_patch *p = sheet->patch;
    sl_status status = SL_OK;
    search s = {.sheet = sheet, .a = a, .b = b, .cross = cross};
    double *distance = sl_alloc(3 * (int64_t)p->nt, sizeof *distance);
    int32_t *parent = sl_alloc(3 * (int64_t)p->nt, sizeof *parent), *path = sl_alloc(3 * (int64_t)p->nt, sizeof *path);
    int32_t last, count = 0;
    s.taken = sl_calloc(p->nv, sizeof *s.taken);
    SL_TRY(distance != NULL && parent != NULL && path != NULL && s.taken != NULL ? SL_OK : SL_OUT_OF_MEMORY);
    for (int32_t k = 0; k < wish->count; k++) {
        for (int32_t i = 0; i < wish->item[k].count; i++) {
            s.taken[wish->item[k].vertex[i]] = 1;
        }
    }
    SL_TRY(build_search(&s));
    SL_TRY(run_search(&s, distance, parent, &last));
    SL_TRY(last >= 0 ? SL_OK : SL_INFEASIBLE);
    path[count++] = b;
    for (int32_t c = last; c >= 0 && count < 3 * p->nt; c = parent[c]) {
        path[count++] = p->tri[c];
    }
    SL_TRY(count >= 3 ? SL_OK : SL_INFEASIBLE);
    SL_TRY(add(wish, SL_CONSTRAINT_STRAIGHT, path, count, 0.0));
cleanup:
    sl_graph_clear(&s.graph);
    sl_free(s.taken);
    sl_free(distance);
    sl_free(parent);
    sl_free(path);
    return status;
}

/* The mesh halfedge that leaves patch vertex v into the chart, between two facets of it and not along the border; -1 =
 * none or several. */
static int32_t inward_edge(const exp_sheet *sheet, int32_t v)
{
    const sl_patch *p = sheet->patch;
    int32_t found = -1;
    for (int32_t c = 0; c < 3 * p->nt; c++) {
        if (p->tri[c] != v || p->twin[c] < 0 || !exp_sheet_is_edge(sheet, c)) {
            continue;
        }
        if (found >= 0) {
            return -1;
        }
        found = c;
    }
    return found;
}

static int32_t polygon_edges(const exp_sheet *sheet, int32_t v)
{
    return sheet->graph.first[v + 1] - sheet->graph.first[v];
}

/* The polygon edge of the patch that goes straight on from c at its end, a vertex inside with four edges; -1 = none. */
static int32_t straight_on(const exp_sheet *sheet, int32_t c)
{
    const sl_patch *p = sheet->patch;
    int32_t edges = 0;
    int32_t d = p->twin[c]; /* leaves the end vertex, back along the edge; turn round it past two polygon edges */
    for (int32_t turn = 0; turn < 64; turn++) {
        d = p->twin[sl_corner_prev(d)];
        if (d < 0) {
            return -1;
        }
        edges += exp_sheet_is_edge(sheet, d);
        if (edges == 2) {
            return d;
        }
    }
    return -1;
}

bool exp_wish_loop(const exp_sheet *sheet, int32_t v, exp_wish *wish, sl_status *status)
{
    const sl_patch *p = sheet->patch;
    int32_t *path = sl_alloc(p->nv, sizeof *path), count = 0;
    int32_t c = inward_edge(sheet, v);
    bool ends = false;
    *status = path != NULL ? SL_OK : SL_OUT_OF_MEMORY;
    if (path != NULL && c >= 0) {
        path[count++] = v;
    }
    while (path != NULL && c >= 0 && count < p->nv && !ends) {
        const int32_t end = p->tri[sl_corner_next(c)];
        path[count++] = end;
        ends = p->border[end];
        c = !ends && polygon_edges(sheet, end) == 4 ? straight_on(sheet, c) : -1;
    }
    if (*status == SL_OK && ends && count >= 3) {
        *status = add(wish, SL_CONSTRAINT_STRAIGHT, path, count, 0.0);
    }
    sl_free(path);
    return *status == SL_OK && ends && count >= 3;
}
