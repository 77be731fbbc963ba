/* Seams as arcs between their junctions, and the windows of them that may be sewn. */
#include "optimize/optimize_internal.h"

#include "base/memory.h"

/* Shares of an arc's length between which it is sewn: between two charts, and from the tip of a dart. */
static const double WINDOW[][2] = {{0.0, 1.0}, {0.0, 0.75},  {0.25, 1.0},  {0.125, 0.875}, {0.0, 0.5},
                                   {0.5, 1.0}, {0.25, 0.75}, {0.0, 0.25},  {0.75, 1.0},    {0.375, 0.625},
                                   {0.0, 0.1}, {0.2, 0.3},   {0.45, 0.55}, {0.7, 0.8},     {0.9, 1.0}};
static const double ZIP[] = {1.0, 0.75, 0.5, 0.25, 0.12};
static const int LOOP_STARTS = 4; /* a seam without junctions is opened at so many places in turn */

/* The cut edges at each vertex of the surface. */
typedef struct seam_graph {
    const sl_opt_state *state;
    int32_t *first, *halfedge; /* nv + 1; halfedges leaving a vertex along a seam */
    uint8_t *used;             /* 3 nt */
} seam_graph;

static void seam_graph_clear(seam_graph *g)
{
    sl_free(g->first);
    sl_free(g->halfedge);
    sl_free(g->used);
}

static sl_status seam_graph_init(const sl_opt_state *state, seam_graph *g)
{
    const sl_patch *p = state->surface->patch;
    *g = (seam_graph){.state = state,
                      .first = sl_calloc((int64_t)p->nv + 1, sizeof *g->first),
                      .halfedge = sl_alloc(3 * (int64_t)p->nt, sizeof *g->halfedge),
                      .used = sl_calloc(3 * (int64_t)p->nt, sizeof *g->used)};
    if (g->first == NULL || g->halfedge == NULL || g->used == NULL) {
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

/* Where arcs end: tips, junctions, the surface's border, and where the leave to sew changes. */
static bool is_junction(const seam_graph *g, int32_t v)
{
    const sl_opt_state *s = g->state;
    if (degree(g, v) != 2 || s->surface->patch->border[v] != 0) {
        return true;
    }
    const int32_t *h = g->halfedge + g->first[v];
    return s->keep[h[0]] != s->keep[h[1]];
}

/* Appends the arc that starts with h. */
static void walk(seam_graph *g, int32_t h, sl_opt_arcs *out)
{
    const sl_patch *p = g->state->surface->patch;
    int32_t n = out->first[out->count];
    while (h >= 0 && g->used[h] == 0) {
        g->used[h] = g->used[p->twin[h]] = 1;
        out->halfedge[n++] = h;
        const int32_t v = p->tri[sl_corner_next(h)];
        int32_t next = -1;
        for (int32_t k = g->first[v]; k < g->first[v + 1] && !is_junction(g, v); k++) {
            next = g->halfedge[k] != p->twin[h] ? g->halfedge[k] : next;
        }
        h = next;
    }
    out->first[++out->count] = n;
}

static bool is_tip(const seam_graph *g, int32_t v)
{
    return degree(g, v) == 1 && g->state->surface->patch->border[v] == 0;
}

void sl_opt_arcs_clear(sl_opt_arcs *arcs)
{
    sl_free(arcs->first);
    sl_free(arcs->halfedge);
    sl_free(arcs->kind);
    *arcs = (sl_opt_arcs){0};
}

sl_status sl_opt_arcs_init(const sl_opt_state *state, sl_opt_arcs *out)
{
    sl_status status = SL_OK;
    const sl_patch *p = state->surface->patch;
    const int64_t edges = 3 * (int64_t)p->nt / 2 + 1;
    seam_graph g = {0};
    *out = (sl_opt_arcs){.first = sl_calloc(edges + 1, sizeof *out->first),
                         .halfedge = sl_alloc(edges, sizeof *out->halfedge),
                         .kind = sl_calloc(edges, sizeof *out->kind)};
    SL_TRY(out->first == NULL || out->halfedge == NULL || out->kind == NULL ? SL_OUT_OF_MEMORY : SL_OK);
    SL_TRY(seam_graph_init(state, &g));
    for (int pass = 0; pass < 2; pass++) { /* arcs from their ends, then closed ones */
        for (int32_t c = 0; c < 3 * p->nt; c++) {
            if (state->cut[c] != 0 && g.used[c] == 0 && (pass == 1 || is_junction(&g, p->tri[c]))) {
                walk(&g, c, out);
                const int32_t *arc = out->halfedge + out->first[out->count - 1];
                const int32_t last = out->halfedge[out->first[out->count] - 1];
                uint8_t kind = pass == 1 ? SL_OPT_ARC_CLOSED : 0;
                kind |= is_tip(&g, p->tri[arc[0]]) ? SL_OPT_ARC_TIP_FIRST : 0;
                kind |= is_tip(&g, p->tri[sl_corner_next(last)]) ? SL_OPT_ARC_TIP_LAST : 0;
                out->kind[out->count - 1] = kind;
            }
        }
    }
cleanup:
    seam_graph_clear(&g);
    if (status != SL_OK) {
        sl_opt_arcs_clear(out);
    }
    return status;
}

/* Windows found so far, and the arc at hand. */
typedef struct window_list {
    const sl_opt_state *state;
    const int32_t *arc;
    int32_t narc;
    sl_opt_trial *list;
    int64_t count, capacity;
} window_list;

/* Appends the part of the arc between two shares of its length, the arc read from place `start` on. */
static sl_status add_window(window_list *w, int32_t start, double from, double to)
{
    const sl_opt_state *s = w->state;
    const double *length = s->surface->length;
    double total = 0.0, at = 0.0;
    for (int32_t k = 0; k < w->narc; k++) {
        total += length[w->arc[k]];
    }
    const sl_status status = sl_reserve((void **)&w->list, &w->capacity, w->count + 1, sizeof *w->list);
    if (status != SL_OK) {
        return status;
    }
    const int32_t a = s->chart_of[w->arc[0] / 3], b = s->chart_of[s->surface->patch->twin[w->arc[0]] / 3];
    sl_opt_trial *trial = &w->list[w->count];
    *trial = (sl_opt_trial){.sew = true, .old = {a, b != a ? b : -1}, .edge = sl_alloc(w->narc, sizeof *trial->edge)};
    if (trial->edge == NULL) {
        return SL_OUT_OF_MEMORY;
    }
    for (int32_t k = 0; k < w->narc; k++) {
        const int32_t h = w->arc[(start + k) % w->narc];
        const double middle = at + 0.5 * length[h];
        if (middle >= from * total && middle <= to * total) {
            trial->edge[trial->nedge++] = h;
        }
        at += length[h];
    }
    if (trial->nedge == 0) {
        sl_opt_trial_clear(trial);
    } else {
        w->count++;
    }
    return SL_OK;
}

static sl_status add_windows(window_list *w, uint8_t kind)
{
    sl_status status = SL_OK;
    const sl_opt_state *s = w->state;
    const int32_t head = w->arc[0];
    const bool closed = (kind & SL_OPT_ARC_CLOSED) != 0;
    if (s->keep[head] != 0) {
        return SL_OK;
    }
    if (s->chart_of[head / 3] != s->chart_of[s->surface->patch->twin[head] / 3]) {
        for (int r = 0; r < (closed ? LOOP_STARTS : 1); r++) {
            for (size_t k = closed ? 1 : 0; k < SL_COUNTOF(WINDOW); k++) {
                SL_TRY(add_window(w, (int32_t)((int64_t)r * w->narc / LOOP_STARTS), WINDOW[k][0], WINDOW[k][1]));
            }
        }
        goto cleanup;
    }
    for (size_t k = 0; k < SL_COUNTOF(ZIP); k++) {
        if ((kind & SL_OPT_ARC_TIP_FIRST) != 0) {
            SL_TRY(add_window(w, 0, 0.0, ZIP[k]));
        }
        if ((kind & SL_OPT_ARC_TIP_LAST) != 0) {
            SL_TRY(add_window(w, 0, 1.0 - ZIP[k], 1.0));
        }
    }
cleanup:
    return status;
}

sl_status sl_opt_windows(const sl_opt_state *state, sl_opt_trial **list, int64_t *count)
{
    sl_status status = SL_OK;
    sl_opt_arcs arcs = {0};
    window_list w = {.state = state};
    SL_TRY(sl_opt_arcs_init(state, &arcs));
    for (int32_t k = 0; k < arcs.count; k++) {
        w.arc = arcs.halfedge + arcs.first[k];
        w.narc = arcs.first[k + 1] - arcs.first[k];
        SL_TRY(add_windows(&w, arcs.kind[k]));
    }
cleanup:
    *list = w.list;
    *count = w.count;
    sl_opt_arcs_clear(&arcs);
    return status;
}
