/* Seams as arcs between their junctions, and the windows of them that may be sewn. */
#include "optimize/optimize_internal.h"

#include "base/memory.h"

#include <math.h>

/* Shares of an arc's length between which it is sewn: between two charts, and from the tip of a dart. */
static const double WINDOW[][2] = {{0.0, 1.0}, {0.0, 0.75},  {0.25, 1.0}, {0.125, 0.875}, {0.0, 0.5},
                                   {0.5, 1.0}, {0.25, 0.75}, {0.0, 0.25}, {0.75, 1.0},    {0.375, 0.625}};
static const double ZIP[] = {1.0, 0.75, 0.5, 0.25, 0.12};
static const int LOOP_STARTS = 4; /* a seam without junctions is opened at so many places in turn */

/* The cut edges at each vertex of the surface. */
typedef struct seam_graph {
    const sl_opt_state *state;
    int32_t *first, *halfedge; /* nv + 1; halfedges leaving a vertex along a seam */
    uint8_t *used;             /* 3 nt */
    int32_t *arc, narc;        /* the arc walked last */
    sl_opt_trial *list;
    int64_t count, capacity;
} seam_graph;

static void seam_graph_clear(seam_graph *g)
{
    sl_free(g->first);
    sl_free(g->halfedge);
    sl_free(g->used);
    sl_free(g->arc);
}

static sl_status seam_graph_init(const sl_opt_state *state, seam_graph *g)
{
    const sl_patch *p = state->surface->patch;
    *g = (seam_graph){.state = state,
                      .first = sl_calloc((int64_t)p->nv + 1, sizeof *g->first),
                      .halfedge = sl_alloc(3 * (int64_t)p->nt, sizeof *g->halfedge),
                      .used = sl_calloc(3 * (int64_t)p->nt, sizeof *g->used),
                      .arc = sl_alloc(3 * (int64_t)p->nt, sizeof *g->arc)};
    if (g->first == NULL || g->halfedge == NULL || g->used == NULL || g->arc == NULL) {
        return SL_OUT_OF_MEMORY;
    }
    for (int32_t c = 0; c < 3 * p->nt; c++) {
        g->first[p->tri[c]] += state->cut[c] != 0;
    }
    int32_t sum = 0;
    for (int32_t v = 0; v < p->nv; v++) {
        sum += g->first[v];
        g->first[v] = sum;
    }
    g->first[p->nv] = sum;
    for (int32_t c = 3 * p->nt; c-- > 0;) {
        if (state->cut[c] != 0) {
            g->halfedge[--g->first[p->tri[c]]] = c;
        }
    }
    return SL_OK;
}

static int32_t degree(const seam_graph *g, int32_t v)
{
    return g->first[v + 1] - g->first[v];
}

/* Where arcs end: tips, junctions, the surface's border, and where the charts or the leave to sew change. */
static bool is_junction(const seam_graph *g, int32_t v)
{
    const sl_opt_state *s = g->state;
    if (degree(g, v) != 2 || s->surface->patch->border[v] != 0) {
        return true;
    }
    const int32_t *h = g->halfedge + g->first[v];
    return s->keep[h[0]] != s->keep[h[1]];
}

static void walk(seam_graph *g, int32_t h)
{
    const sl_patch *p = g->state->surface->patch;
    g->narc = 0;
    while (h >= 0 && g->used[h] == 0) {
        g->used[h] = g->used[p->twin[h]] = 1;
        g->arc[g->narc++] = h;
        const int32_t v = p->tri[sl_corner_next(h)];
        int32_t next = -1;
        for (int32_t k = g->first[v]; k < g->first[v + 1] && !is_junction(g, v); k++) {
            next = g->halfedge[k] != p->twin[h] ? g->halfedge[k] : next;
        }
        h = next;
    }
}

/* Appends the part of the arc between two shares of its length, the arc read from place `start` on. */
static sl_status add_window(seam_graph *g, int32_t start, double from, double to)
{
    const sl_opt_state *s = g->state;
    const double *length = s->surface->length;
    double total = 0.0, at = 0.0;
    for (int32_t k = 0; k < g->narc; k++) {
        total += length[g->arc[k]];
    }
    const sl_status status = sl_reserve((void **)&g->list, &g->capacity, g->count + 1, sizeof *g->list);
    if (status != SL_OK) {
        return status;
    }
    const int32_t a = s->chart_of[g->arc[0] / 3], b = s->chart_of[s->surface->patch->twin[g->arc[0]] / 3];
    sl_opt_trial *trial = &g->list[g->count];
    *trial = (sl_opt_trial){.sew = true, .old = {a, b != a ? b : -1}, .edge = sl_alloc(g->narc, sizeof *trial->edge)};
    if (trial->edge == NULL) {
        return SL_OUT_OF_MEMORY;
    }
    for (int32_t k = 0; k < g->narc; k++) {
        const int32_t h = g->arc[(start + k) % g->narc];
        const double middle = at + 0.5 * length[h];
        if (middle >= from * total && middle <= to * total) {
            trial->edge[trial->nedge++] = h;
        }
        at += length[h];
    }
    if (trial->nedge == 0) {
        sl_opt_trial_clear(trial);
    } else {
        g->count++;
    }
    return SL_OK;
}

static bool is_tip(const seam_graph *g, int32_t v)
{
    return degree(g, v) == 1 && g->state->surface->patch->border[v] == 0;
}

static sl_status add_windows(seam_graph *g, bool loop)
{
    sl_status status = SL_OK;
    const sl_opt_state *s = g->state;
    const sl_patch *p = s->surface->patch;
    const int32_t head = g->arc[0], tail = g->arc[g->narc - 1];
    if (s->keep[head] != 0) {
        return SL_OK;
    }
    if (s->chart_of[head / 3] != s->chart_of[p->twin[head] / 3]) {
        for (int r = 0; r < (loop ? LOOP_STARTS : 1); r++) {
            for (size_t k = loop ? 1 : 0; k < SL_COUNTOF(WINDOW); k++) {
                SL_TRY(add_window(g, (int32_t)((int64_t)r * g->narc / LOOP_STARTS), WINDOW[k][0], WINDOW[k][1]));
            }
        }
        goto cleanup;
    }
    for (size_t k = 0; k < SL_COUNTOF(ZIP); k++) {
        if (is_tip(g, p->tri[head])) {
            SL_TRY(add_window(g, 0, 0.0, ZIP[k]));
        }
        if (is_tip(g, p->tri[sl_corner_next(tail)])) {
            SL_TRY(add_window(g, 0, 1.0 - ZIP[k], 1.0));
        }
    }
cleanup:
    return status;
}

sl_status sl_opt_windows(const sl_opt_state *state, sl_opt_trial **list, int64_t *count)
{
    sl_status status = SL_OK;
    const sl_patch *p = state->surface->patch;
    seam_graph g = {0};
    SL_TRY(seam_graph_init(state, &g));
    for (int pass = 0; pass < 2; pass++) { /* arcs from their ends, then closed ones */
        for (int32_t c = 0; c < 3 * p->nt; c++) {
            if (state->cut[c] != 0 && g.used[c] == 0 && (pass == 1 || is_junction(&g, p->tri[c]))) {
                walk(&g, c);
                SL_TRY(add_windows(&g, pass == 1));
            }
        }
    }
cleanup:
    *list = g.list;
    *count = g.count;
    seam_graph_clear(&g);
    return status;
}
