/* Charts that leave much of a square page empty are cut across, where that costs less than the texels are worth. */
#include "optimize/optimize_internal.h"

#include "base/memory.h"
#include "graph/csr.h"

#include <math.h>
#include <string.h>

enum { DIRECTIONS = 16, MOST_SAMPLES = 24, LEAST_SAMPLES = 6, MOST_CUTS = 4 };
static const double WORK = 4e5;        /* vertices times samples, about, that a round may cost */
static const double NESTED = 0.7;      /* of what a chart leaves of its rectangle stays empty once all are packed */
static const double LEAST_SHARE = 0.1; /* of the area: smaller charts fill gaps */

/* Cosines and sines of 0, 1/32 .. 15/32 of a half turn. */
static const double TURN[DIRECTIONS][2] = {{1, 0},
                                           {0.99518472667219693, 0.098017140329560604},
                                           {0.98078528040323043, 0.19509032201612825},
                                           {0.95694033573220882, 0.29028467725446233},
                                           {0.92387953251128674, 0.38268343236508978},
                                           {0.88192126434835505, 0.47139673682599764},
                                           {0.83146961230254524, 0.55557023301960218},
                                           {0.77301045336273699, 0.63439328416364549},
                                           {0.70710678118654757, 0.70710678118654746},
                                           {0.63439328416364549, 0.77301045336273699},
                                           {0.55557023301960229, 0.83146961230254524},
                                           {0.47139673682599781, 0.88192126434835494},
                                           {0.38268343236508984, 0.92387953251128674},
                                           {0.29028467725446233, 0.95694033573220894},
                                           {0.19509032201612833, 0.98078528040323043},
                                           {0.09801714032956077, 0.99518472667219682}};

/* Extents of a chart or of a part of one in those directions, and at right angles to them. */
typedef struct extents {
    double low[2][DIRECTIONS], high[2][DIRECTIONS];
} extents;

static extents extents_none(void)
{
    extents e;
    for (int k = 0; k < DIRECTIONS; k++) {
        e.low[0][k] = e.low[1][k] = HUGE_VAL;
        e.high[0][k] = e.high[1][k] = -HUGE_VAL;
    }
    return e;
}

static void extents_add(extents *e, const double *uv)
{
    for (int k = 0; k < DIRECTIONS; k++) {
        const double x = TURN[k][0] * uv[0] + TURN[k][1] * uv[1], y = TURN[k][0] * uv[1] - TURN[k][1] * uv[0];
        e->low[0][k] = x < e->low[0][k] ? x : e->low[0][k];
        e->low[1][k] = y < e->low[1][k] ? y : e->low[1][k];
        e->high[0][k] = x > e->high[0][k] ? x : e->high[0][k];
        e->high[1][k] = y > e->high[1][k] ? y : e->high[1][k];
    }
}

/* What a chart takes of a page: about the area it keeps others from, and the least square about it. */
typedef struct footprint {
    double area, square;
} footprint;

static footprint footprint_of(const extents *e, double area)
{
    footprint f = {HUGE_VAL, HUGE_VAL};
    for (int k = 0; k < DIRECTIONS; k++) {
        const double a = e->high[0][k] - e->low[0][k], b = e->high[1][k] - e->low[1][k];
        f.area = fmin(f.area, a * b);
        f.square = fmin(f.square, fmax(a, b) * fmax(a, b));
    }
    f.area = area + NESTED * (f.area - area);
    return f;
}

/* A chart's border, and the ways across it. */
typedef struct crossing {
    const sl_opt_state *state;
    const sl_patch *patch;
    const double *uv;
    double scale;      /* of its UVs, at which all charts are packed */
    sl_graph graph;    /* vertices over the edges that may be cut */
    int32_t *halfedge; /* behind an entry */
    double *weight;    /* of the entries; in the graph those from the border lead nowhere */
    int32_t *border, nborder;
    int32_t sample[MOST_SAMPLES], nsamples; /* places in `border` */
    double *distance;
    int32_t *parent, *entry;
} crossing;

static void crossing_clear(crossing *x)
{
    sl_graph_clear(&x->graph);
    sl_free(x->halfedge);
    sl_free(x->weight);
    sl_free(x->border);
    sl_free(x->distance);
    sl_free(x->parent);
    sl_free(x->entry);
}

/* The border in order; a disk has one loop. */
static void walk_border(crossing *x)
{
    const sl_patch *p = x->patch;
    int32_t start = 0;
    while (start < p->nv && p->border[start] == 0) {
        start++;
    }
    for (int32_t v = start; v < p->nv && x->nborder < p->nv;) {
        x->border[x->nborder++] = v;
        v = p->tri[sl_corner_next(p->outgoing[v])];
        if (v == start) {
            break;
        }
    }
}

static void choose_samples(crossing *x)
{
    const double wanted = fmin(fmax(WORK / x->patch->nv, LEAST_SAMPLES), MOST_SAMPLES);
    double perimeter = 0.0, at = 0.0;
    for (int pass = 0; pass < 2; pass++) {
        for (int32_t k = 0; k < x->nborder; k++) {
            const double *a = x->uv + 2 * (int64_t)x->border[k];
            const double *b = x->uv + 2 * (int64_t)x->border[(k + 1) % x->nborder];
            const double length = hypot(b[0] - a[0], b[1] - a[1]);
            if (pass == 0) {
                perimeter += length;
            } else {
                if (x->nsamples < (int32_t)wanted && at * wanted >= perimeter * x->nsamples) {
                    x->sample[x->nsamples++] = k;
                }
                at += length;
            }
        }
    }
}

static sl_status crossing_init(const sl_opt_state *state, int32_t c, crossing *x)
{
    sl_status status = SL_OK;
    const sl_opt_chart *chart = &state->chart[c];
    const sl_patch *p = chart->patch;
    *x = (crossing){.state = state, .patch = p, .uv = chart->uv, .scale = sl_opt_best_scale(&chart->sums)};
    SL_TRY(sl_opt_chart_graph(state->surface, p, &x->graph, &x->halfedge));
    x->weight = sl_copy(x->graph.weight, x->graph.first[p->nv], sizeof *x->weight);
    x->border = sl_alloc(p->nv, sizeof *x->border);
    x->distance = sl_alloc(p->nv, sizeof *x->distance);
    x->parent = sl_alloc(p->nv, sizeof *x->parent);
    x->entry = sl_alloc(p->nv, sizeof *x->entry);
    if (x->weight == NULL || x->border == NULL || x->distance == NULL || x->parent == NULL || x->entry == NULL) {
        SL_TRY(SL_OUT_OF_MEMORY);
    }
    walk_border(x);
    choose_samples(x);
    for (int32_t v = 0; v < p->nv; v++) {
        for (int32_t k = x->graph.first[v]; p->border[v] != 0 && k < x->graph.first[v + 1]; k++) {
            x->graph.weight[k] = HUGE_VAL;
        }
    }
cleanup:
    return status;
}

/* Ways from one sample across the chart. */
static sl_status find_ways(crossing *x, int32_t from)
{
    const int32_t v = x->border[from], first = x->graph.first[v], n = x->graph.first[v + 1] - first;
    memcpy(x->graph.weight + first, x->weight + first, (size_t)n * sizeof *x->weight);
    const sl_status status = sl_graph_shortest_paths(&x->graph, &v, 1, NULL, -1, x->distance, x->parent, x->entry);
    for (int32_t k = first; k < first + n; k++) {
        x->graph.weight[k] = HUGE_VAL;
    }
    return status;
}

static void scaled(const crossing *x, int32_t v, double out[2])
{
    out[0] = x->scale * x->uv[2 * (int64_t)v];
    out[1] = x->scale * x->uv[2 * (int64_t)v + 1];
}

/* Twice the area under a border polygon's edge. */
static double area_under(const double a[2], const double b[2])
{
    return a[0] * b[1] - b[0] * a[1];
}

/* The footprints of the two parts between border places i and j > i, with the way from j back to i, of the last
 * find_ways. */
static void split_footprints(const crossing *x, int32_t i, int32_t j, footprint part[2])
{
    extents e[2] = {extents_none(), extents_none()};
    double area[2] = {0.0, 0.0}, a[2], b[2];
    for (int32_t k = 0; k < x->nborder; k++) {
        const int side = k >= i && k < j ? 0 : 1;
        scaled(x, x->border[k], a);
        scaled(x, x->border[(k + 1) % x->nborder], b);
        extents_add(&e[side], a);
        extents_add(&e[side], b);
        area[side] += 0.5 * area_under(a, b);
    }
    for (int32_t v = x->border[j]; x->parent[v] >= 0; v = x->parent[v]) {
        scaled(x, v, a);
        scaled(x, x->parent[v], b);
        extents_add(&e[0], a);
        extents_add(&e[1], a);
        area[0] += 0.5 * area_under(a, b);
        area[1] -= 0.5 * area_under(a, b);
    }
    part[0] = footprint_of(&e[0], area[0]);
    part[1] = footprint_of(&e[1], area[1]);
}

static footprint whole_footprint(const sl_opt_chart *chart)
{
    extents e = extents_none();
    const double scale = sl_opt_best_scale(&chart->sums);
    for (int32_t v = 0; v < chart->patch->nv; v++) {
        const double at[2] = {scale * chart->uv[2 * (int64_t)v], scale * chart->uv[2 * (int64_t)v + 1]};
        if (chart->patch->border[v] != 0) {
            extents_add(&e, at);
        }
    }
    return footprint_of(&e, scale * scale * chart->sums.plane);
}

/* All charts but one: what they take of the page. */
static footprint others(const footprint *chart, int64_t n, int64_t but)
{
    footprint sum = {0.0, 0.0};
    for (int64_t k = 0; k < n; k++) {
        sum.area += k == but ? 0.0 : chart[k].area;
        sum.square = k == but ? sum.square : fmax(sum.square, chart[k].square);
    }
    return sum;
}

/* The best cut so far. */
typedef struct compaction {
    const sl_opt_state *state;
    footprint *chart;
    double page; /* as it is, over the surface's area */
    double most; /* gain of the best */
    sl_opt_trial trial;
} compaction;

static sl_status take_way(compaction *all, const crossing *x, int32_t c, int32_t end, double gain)
{
    sl_opt_trial *t = &all->trial;
    int32_t *edge = sl_alloc(x->patch->nv, sizeof *edge);
    if (edge == NULL) {
        return SL_OUT_OF_MEMORY;
    }
    sl_opt_trial_clear(t);
    *t = (sl_opt_trial){.old = {c, -1}, .nto = 2, .edge = edge};
    for (int32_t v = end; x->parent[v] >= 0; v = x->parent[v]) {
        edge[t->nedge++] = x->patch->corner[x->halfedge[x->entry[v]]];
    }
    all->most = gain;
    return SL_OK;
}

/* Tries the ways between all samples of a chart. */
static sl_status try_chart(compaction *all, int32_t c)
{
    sl_status status = SL_OK;
    crossing x = {0};
    const sl_opt_state *s = all->state;
    const footprint rest = others(all->chart, s->nchart, c);
    SL_TRY(crossing_init(s, c, &x));
    for (int32_t i = 0; i + 1 < x.nsamples; i++) {
        SL_TRY(find_ways(&x, x.sample[i]));
        for (int32_t j = i + 1; j < x.nsamples; j++) {
            const int32_t end = x.border[x.sample[j]];
            const double price = s->def->seam_cost * x.distance[end] / s->surface->unit + s->def->chart_cost;
            if (x.parent[end] < 0 || price + all->most >= s->def->empty_cost * all->page) {
                continue;
            }
            footprint part[2];
            split_footprints(&x, x.sample[i], x.sample[j], part);
            const double page =
                fmax(rest.area + part[0].area + part[1].area, fmax(rest.square, fmax(part[0].square, part[1].square)));
            const double gain = s->def->empty_cost * (all->page - page / s->surface->total) - price;
            if (gain > all->most) {
                SL_TRY(take_way(all, &x, c, end, gain));
            }
        }
    }
cleanup:
    crossing_clear(&x);
    return status;
}

/* One cut, of the chart where it gains most; *done = none gains. */
static sl_status compact_once(sl_opt_state *state, bool *done)
{
    sl_status status = SL_OK;
    compaction all = {.state = state, .chart = sl_alloc(state->nchart, sizeof *all.chart)};
    *done = true;
    SL_TRY(all.chart == NULL ? SL_OUT_OF_MEMORY : SL_OK);
    for (int64_t c = 0; c < state->nchart; c++) {
        all.chart[c] = whole_footprint(&state->chart[c]);
    }
    const footprint now = others(all.chart, state->nchart, -1);
    all.page = fmax(now.area, now.square) / state->surface->total;
    for (int32_t c = 0; c < state->nchart; c++) {
        if (state->chart[c].sums.space >= LEAST_SHARE * state->surface->total) {
            SL_TRY(try_chart(&all, c));
        }
    }
    if (all.trial.nedge > 0) {
        SL_TRY(sl_opt_trial_make(state, &all.trial));
        if (all.trial.valid && all.trial.nto == 2) {
            for (int32_t k = 0; k < 2; k++) {
                sl_opt_chart *part = &all.trial.to[k];
                sl_opt_measure(state->surface, part->patch, part->uv, &part->sums, NULL);
            }
            SL_TRY(sl_opt_apply(state, &all.trial));
            state->info.cuts++;
            *done = false;
        }
    }
cleanup:
    sl_opt_trial_clear(&all.trial);
    sl_free(all.chart);
    return status;
}

sl_status sl_opt_compact(sl_opt_state *state)
{
    sl_status status = SL_OK;
    bool done = !(state->def->empty_cost > 0.0) || state->machined; /* its seams belong on its creases */
    for (int k = 0; k < MOST_CUTS && !done; k++) {
        SL_TRY(compact_once(state, &done));
    }
cleanup:
    return status;
}
