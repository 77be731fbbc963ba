/* Candidate cuts of a chart: darts from where the stretch gathers to the border, and chords on through it. */
#include "optimize/optimize_internal.h"

#include "base/memory.h"
#include "graph/csr.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { PEAKS = 3, TIPS = 8, CHORDS = 3, BISECTIONS = 2 };
static const double FINE = 0.03, COARSE = 0.06; /* widths of the diffusion over sqrt(area of the surface) */
static const int MOST_ROUNDS = 200;             /* of the diffusion */
static const double TIP_SPACING = 0.06;         /* between tips, over sqrt(area of the surface) */
static const double CHORD_REACH = 0.2;          /* of the border's length between the ends of a chord */

/* A chart and what its candidates need. */
typedef struct dart_field {
    const sl_opt_state *state;
    const sl_patch *patch;
    sl_graph graph;    /* vertices over the edges that may be cut */
    int32_t *halfedge; /* behind an entry */
    double *distance;  /* to the border */
    int32_t *parent, *entry;
    int32_t *source, nsources; /* border vertices */
    double *along;             /* nv: place of a border vertex along the border */
    double perimeter;
    double *share; /* nt x 2: of the losses */
    double *mass, *area, *field, *work;
    int32_t tip[TIPS], ntips;
} dart_field;

static void field_clear(dart_field *d)
{
    sl_graph_clear(&d->graph);
    sl_free(d->halfedge);
    sl_free(d->distance);
    sl_free(d->parent);
    sl_free(d->entry);
    sl_free(d->source);
    sl_free(d->along);
    sl_free(d->share);
    sl_free(d->mass);
    sl_free(d->area);
    sl_free(d->field);
    sl_free(d->work);
}

static sl_status field_allocate(dart_field *d)
{
    const int64_t nv = d->patch->nv, nt = d->patch->nt;
    d->distance = sl_alloc(nv, sizeof *d->distance);
    d->parent = sl_alloc(nv, sizeof *d->parent);
    d->entry = sl_alloc(nv, sizeof *d->entry);
    d->source = sl_alloc(nv, sizeof *d->source);
    d->along = sl_alloc(nv, sizeof *d->along);
    d->share = sl_alloc(2 * nt, sizeof *d->share);
    d->mass = sl_alloc(nv, sizeof *d->mass);
    d->area = sl_alloc(nv, sizeof *d->area);
    d->field = sl_alloc(nv, sizeof *d->field);
    d->work = sl_alloc(nv, sizeof *d->work);
    const bool ok = d->distance != NULL && d->parent != NULL && d->entry != NULL && d->source != NULL &&
                    d->along != NULL && d->share != NULL && d->mass != NULL && d->area != NULL && d->field != NULL &&
                    d->work != NULL;
    return ok ? SL_OK : SL_OUT_OF_MEMORY;
}

/* May halfedge c of the patch be cut? */
static bool may_cut(const sl_opt_surface *surface, const sl_patch *p, int32_t c)
{
    return p->twin[c] >= 0 && surface->cost[p->corner[c]] < HUGE_VAL;
}

/* Rows in the order of the corners, so that nothing need be sorted. */
sl_status sl_opt_chart_graph(const sl_opt_surface *surface, const sl_patch *p, sl_graph *graph, int32_t **halfedge)
{
    const int64_t nv = p->nv, nt = p->nt;
    int32_t *first = sl_calloc(nv + 1, sizeof *first);
    *graph = (sl_graph){.n = p->nv, .first = first};
    graph->adj = sl_alloc(3 * nt, sizeof *graph->adj);
    graph->weight = sl_alloc(3 * nt, sizeof *graph->weight);
    *halfedge = sl_alloc(3 * nt, sizeof **halfedge);
    if (first == NULL || graph->adj == NULL || graph->weight == NULL || *halfedge == NULL) {
        return SL_OUT_OF_MEMORY;
    }
    for (int32_t c = 0; c < 3 * p->nt; c++) {
        first[p->tri[c]] += may_cut(surface, p, c);
    }
    int32_t sum = 0;
    for (int32_t v = 0; v < p->nv; v++) {
        sum += first[v];
        first[v] = sum;
    }
    first[p->nv] = sum;
    for (int32_t c = 3 * p->nt; c-- > 0;) {
        if (may_cut(surface, p, c)) {
            const int32_t at = --first[p->tri[c]];
            graph->adj[at] = p->tri[sl_corner_next(c)];
            graph->weight[at] = surface->cost[p->corner[c]];
            (*halfedge)[at] = c;
        }
    }
    return SL_OK;
}

/* Walks the border; a disk has one loop. */
static void list_border(dart_field *d)
{
    const sl_patch *p = d->patch;
    int32_t start = 0;
    while (start < p->nv && p->border[start] == 0) {
        start++;
    }
    for (int32_t v = start; v < p->nv && d->nsources < p->nv;) {
        const int32_t h = p->outgoing[v];
        d->source[d->nsources++] = v;
        d->along[v] = d->perimeter;
        d->perimeter += d->state->surface->length[p->corner[h]];
        v = p->tri[sl_corner_next(h)];
        if (v == start) {
            break;
        }
    }
}

static void smooth_once(const dart_field *d, double *x)
{
    const sl_patch *p = d->patch;
    for (int32_t v = 0; v < p->nv; v++) {
        d->work[v] = x[v];
    }
    for (int32_t c = 0; c < 3 * p->nt; c++) { /* each neighbour of an inner vertex is the end of one leaving halfedge */
        d->work[p->tri[c]] += x[p->tri[sl_corner_next(c)]];
    }
    for (int32_t v = 0; v < p->nv; v++) {
        x[v] = 0.0;
    }
    for (int32_t c = 0; c < 3 * p->nt; c++) {
        x[p->tri[c]] += 1.0;
    }
    for (int32_t v = 0; v < p->nv; v++) {
        x[v] = d->work[v] / (x[v] + 1.0);
    }
}

/* field = loss a unit of area, both diffused. */
static void diffuse(dart_field *d, int rounds)
{
    const sl_patch *p = d->patch;
    const sl_opt_state *s = d->state;
    memset(d->mass, 0, (size_t)p->nv * sizeof *d->mass);
    memset(d->area, 0, (size_t)p->nv * sizeof *d->area);
    for (int32_t c = 0; c < 3 * p->nt; c++) {
        const int32_t t = c / 3;
        d->mass[p->tri[c]] += s->cost[0] * d->share[2 * t] + s->cost[1] * d->share[2 * t + 1];
        d->area[p->tri[c]] += s->surface->area[p->facet[t]];
    }
    for (int k = 0; k < rounds; k++) {
        smooth_once(d, d->mass);
        smooth_once(d, d->area);
    }
    for (int32_t v = 0; v < p->nv; v++) {
        d->field[v] = d->area[v] > 0.0 ? d->mass[v] / d->area[v] : 0.0;
    }
}

static bool is_peak(const dart_field *d, int32_t v)
{
    const sl_patch *p = d->patch;
    if (p->border[v] != 0 || d->parent[v] < 0) {
        return false;
    }
    int32_t h = p->outgoing[v];
    do {
        const int32_t u = p->tri[sl_corner_next(h)];
        if (d->field[u] > d->field[v] || (d->field[u] == d->field[v] && u < v)) {
            return false;
        }
        h = p->twin[sl_corner_prev(h)];
    } while (h != p->outgoing[v]);
    return true;
}

static bool is_near_tip(const dart_field *d, int32_t v)
{
    const double reach = TIP_SPACING * d->state->surface->unit;
    for (int32_t k = 0; k < d->ntips; k++) {
        double sum = 0.0;
        for (int j = 0; j < 3; j++) {
            const double x = d->patch->xyz[3 * (int64_t)v + j] - d->patch->xyz[3 * (int64_t)d->tip[k] + j];
            sum += x * x;
        }
        if (sum < reach * reach) {
            return true;
        }
    }
    return false;
}

/* The highest peaks that keep their distance, or with `deep` the vertices where the loss times the distance from the
 * border is largest, peaks or not; until there are `most` tips. */
static void choose_tips(dart_field *d, bool deep, int32_t most)
{
    while (d->ntips < most) {
        int32_t best = -1;
        double value = 0.0;
        for (int32_t v = 0; v < d->patch->nv; v++) {
            const bool inner = d->patch->border[v] == 0 && d->parent[v] >= 0;
            const double x = inner ? d->field[v] * (deep ? d->distance[v] : 1.0) : 0.0;
            if (x > value && (deep || is_peak(d, v)) && !is_near_tip(d, v)) {
                best = v;
                value = x;
            }
        }
        if (best < 0) {
            break;
        }
        d->tip[d->ntips++] = best;
    }
}

static int rounds_for(const dart_field *d, double scale, double edge)
{
    const double width = edge > 0.0 ? scale * d->state->surface->unit / edge : 0.0;
    return (int)fmin(fmax(width * width, 2.0), MOST_ROUNDS);
}

static void find_tips(dart_field *d)
{
    double area = 0.0;
    for (int32_t t = 0; t < d->patch->nt; t++) {
        area += d->state->surface->area[d->patch->facet[t]];
    }
    const double edge = sqrt(2.0 * area / d->patch->nt);
    diffuse(d, rounds_for(d, FINE, edge));
    choose_tips(d, false, PEAKS);
    diffuse(d, rounds_for(d, COARSE, edge));
    choose_tips(d, true, TIPS);
}

static sl_status field_init(const sl_opt_state *state, int32_t c, dart_field *d)
{
    sl_status status = SL_OK;
    sl_opt_sums sums;
    *d = (dart_field){.state = state, .patch = state->chart[c].patch};
    SL_TRY(field_allocate(d));
    SL_TRY(sl_opt_chart_graph(state->surface, d->patch, &d->graph, &d->halfedge));
    list_border(d);
    sl_opt_measure(state->surface, d->patch, state->chart[c].uv, &sums, d->share);
    SL_TRY(sl_graph_shortest_paths(&d->graph, d->source, d->nsources, NULL, -1, d->distance, d->parent, d->entry));
    find_tips(d);
cleanup:
    return status;
}

/* Appends the edges from v back to the source of the paths. Returns the last vertex. */
static int32_t append_path(const dart_field *d, const int32_t *parent, const int32_t *entry, int32_t v,
                           sl_opt_trial *trial)
{
    for (; parent[v] >= 0; v = parent[v]) {
        trial->edge[trial->nedge++] = d->patch->corner[d->halfedge[entry[v]]];
    }
    return v;
}

/* Nothing leads on from the border, nor from the dart. */
static void close_ways(dart_field *d, int32_t tip)
{
    const int32_t *first = d->graph.first;
    for (int32_t k = 0; k < d->nsources; k++) {
        for (int32_t p = first[d->source[k]]; p < first[d->source[k] + 1]; p++) {
            d->graph.weight[p] = HUGE_VAL;
        }
    }
    for (int32_t v = d->parent[tip]; v >= 0; v = d->parent[v]) {
        for (int32_t p = first[v]; p < first[v + 1]; p++) {
            d->graph.weight[p] = HUGE_VAL;
        }
    }
}

/* The way on from the tip to a part of the border far from where the dart ends. */
static sl_status add_chord(dart_field *d, int32_t tip, int32_t end, sl_opt_trial *trial)
{
    sl_status status = SL_OK;
    const int32_t nv = d->patch->nv;
    int32_t best = -1;
    double *distance = sl_alloc(nv, sizeof *distance);
    int32_t *parent = sl_alloc(nv, sizeof *parent), *entry = sl_alloc(nv, sizeof *entry);
    double *saved = sl_copy(d->graph.weight, d->graph.first[nv], sizeof *saved);
    SL_TRY(distance == NULL || parent == NULL || entry == NULL || saved == NULL ? SL_OUT_OF_MEMORY : SL_OK);
    close_ways(d, tip);
    SL_TRY(sl_graph_shortest_paths(&d->graph, &tip, 1, NULL, -1, distance, parent, entry));
    for (int32_t k = 0; k < d->nsources; k++) {
        const int32_t v = d->source[k];
        const double gap = fabs(d->along[v] - d->along[end]), reach = CHORD_REACH * d->perimeter;
        if (fmin(gap, d->perimeter - gap) >= reach && parent[v] >= 0 && (best < 0 || distance[v] < distance[best])) {
            best = v;
        }
    }
    if (best >= 0) {
        (void)append_path(d, parent, entry, best, trial);
    } else {
        trial->nedge = 0;
    }
cleanup:
    if (saved != NULL) {
        memcpy(d->graph.weight, saved, (size_t)d->graph.first[nv] * sizeof *saved);
    }
    sl_free(saved);
    sl_free(distance);
    sl_free(parent);
    sl_free(entry);
    return status;
}

static sl_status add_dart(dart_field *d, int32_t c, int32_t tip, bool chord, sl_opt_trial *list, int32_t *count)
{
    sl_opt_trial *trial = &list[*count];
    *trial = (sl_opt_trial){
        .old = {c, -1}, .nto = chord ? 2 : 1, .edge = sl_alloc(2 * (int64_t)d->patch->nv, sizeof *trial->edge)};
    if (trial->edge == NULL) {
        return SL_OUT_OF_MEMORY;
    }
    (*count)++;
    const int32_t end = append_path(d, d->parent, d->entry, tip, trial);
    return chord ? add_chord(d, tip, end, trial) : SL_OK;
}

sl_status sl_opt_candidates(const sl_opt_state *state, int32_t c, sl_opt_trial **list, int32_t *count)
{
    sl_status status = SL_OK;
    dart_field d = {0};
    *count = 0;
    *list = sl_calloc(TIPS + CHORDS + BISECTIONS, sizeof **list);
    SL_TRY(*list == NULL ? SL_OUT_OF_MEMORY : SL_OK);
    SL_TRY(field_init(state, c, &d));
    for (int32_t k = 0; k < d.ntips; k++) {
        SL_TRY(add_dart(&d, c, d.tip[k], false, *list, count));
    }
    for (int32_t k = 0; k < d.ntips && k < CHORDS; k++) {
        SL_TRY(add_dart(&d, c, d.tip[k], true, *list, count));
    }
    SL_TRY(sl_opt_bisections(state, c, *list, count));
cleanup:
    field_clear(&d);
    return status;
}
